//! Generators: steps that make ground from nothing, here on the processor or on a device.

use std::fmt::Debug;

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Fault, LayerName};

use crate::engine::Engine;
use crate::finest;
use crate::job::Job;
use crate::on_device::OnDevice;
use crate::step::{Outcome, Step};

/// A step that makes one layer from nothing but the size of the ground and a seed.
pub trait Generator: Debug + Send + Sync {
    /// Heights in metres for every cell, a function of the domain's grid and the seed alone.
    ///
    /// # Errors
    /// [`Error::Run`] where the method cannot work on such a grid.
    fn fill(&self, domain: &Domain, seed: u64) -> Result<Field, Error>;

    /// The same heights as work for a device; `None` where the CPU makes them.
    fn on_device(&self, domain: &Domain, seed: u64) -> Option<OnDevice> {
        let _ = (domain, seed);
        None
    }

    /// Heights in metres from what a device made of [`Generator::on_device`].
    fn finish(&self, domain: &Domain, made: Vec<f32>) -> Field {
        Field::from_values(domain.size, made)
    }

    /// The layer that it writes.
    fn target(&self) -> &LayerName;

    /// A seed of its own that replaces the landscape's.
    fn own_seed(&self) -> Option<u64> {
        None
    }

    /// What the method counts: faults, octaves, levels.
    fn iterations(&self) -> u64 {
        1
    }

    /// Faults that concern several parameters at once, told at the line of one of them.
    fn contradictions(&self) -> Vec<Fault> {
        Vec::new()
    }
}

impl<T: Generator> Step for T {
    fn reads(&self) -> Vec<String> {
        Vec::new()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.target().0.clone(), "m")]
    }

    fn faults(&self) -> Vec<Fault> {
        self.contradictions()
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let seed = self.own_seed().unwrap_or(job.seed);
        let finest = finest::domain(&landscape.domain);
        let (field, notes) = heights(self, finest.as_ref().unwrap_or(&landscape.domain), seed, &job.engine)?;
        let field = if finest.is_some() { finest::means(&field, landscape.domain.size) } else { field };
        landscape.insert(&self.target().0, "m", field);
        Ok(Outcome { iterations: self.iterations(), notes, ..Outcome::default() })
    }
}

/// Heights made where the engine says, and what there is to say about it.
fn heights(
    generator: &impl Generator,
    domain: &Domain,
    seed: u64,
    engine: &Engine,
) -> Result<(Field, Vec<String>), Error> {
    let (Engine::Device(device) | Engine::DeviceElseCpu(device)) = engine else {
        return Ok((generator.fill(domain, seed)?, Vec::new()));
    };
    let Some(work) = generator.on_device(domain, seed) else {
        return Ok((generator.fill(domain, seed)?, Vec::new()));
    };
    let instead = |reason: String| {
        let note = format!("the device could not make this ground, so the CPU did: {reason}");
        Ok((generator.fill(domain, seed)?, vec![note]))
    };
    if let Some(reason) = work.too_large_for(&**device) {
        return instead(reason);
    }
    match (work.run(&**device), engine) {
        (Ok(made), _) => Ok((generator.finish(domain, made), Vec::new())),
        (Err(error), Engine::DeviceElseCpu(_)) => instead(error.to_string()),
        (Err(error), _) => Err(error),
    }
}

//! Generators: steps that make ground from nothing, here on the processor or on a device.

use std::collections::BTreeSet;
use std::fmt::Debug;
use std::ops::Range;

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_core::parameter::{Fault, LayerName};

use crate::engine::Engine;
use crate::finest;
use crate::job::Job;
use crate::on_device::OnDevice;
use crate::ranks::agreed;
use crate::step::{Outcome, Step};
use crate::stored::{StoredLandscape, StoredPlane};

/// A step that makes one layer from nothing but the size of the ground and a seed.
pub trait Generator: Debug + Send + Sync {
    /// Heights in metres for every cell, a function of the domain's grid and the seed alone.
    ///
    /// # Errors
    /// [`Error::Run`] where the method cannot work on such a grid.
    fn fill(&self, domain: &Domain, seed: u64) -> Result<Field, Error>;

    /// Heights of some rows alone, to the bit those of [`Generator::fill`]; `None` from a method that needs all of them.
    fn fill_rows(&self, domain: &Domain, seed: u64, rows: Range<usize>) -> Option<Field> {
        let _ = (domain, seed, rows);
        None
    }

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

    fn scratch_per_cell(&self, _: &BTreeSet<String>) -> Result<u64, String> {
        let one = Domain::new(Size { columns: 1, rows: 1 }, 1.0);
        let by_rows = self.fill_rows(&one, 0, 0..1).map(|_| 0);
        by_rows.ok_or_else(|| "it generates the whole landscape at once".to_owned())
    }

    fn run_on_disk(&self, landscape: &mut StoredLandscape<'_>, job: &Job<'_>) -> Result<Outcome, Error> {
        let (seed, name) = (self.own_seed().unwrap_or(job.seed), &self.target().0);
        let mut layer = landscape.plane(name)?;
        let filled = fill_own_rows(self, (landscape, seed), &mut layer, job);
        agreed(&*landscape.ranks, filled)?;
        landscape.insert(name, "m", layer);
        Ok(Outcome { iterations: self.iterations(), ..Outcome::default() })
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

/// Makes the own rows of a plane, some at a time.
fn fill_own_rows(
    generator: &impl Generator,
    (landscape, seed): (&StoredLandscape<'_>, u64),
    layer: &mut StoredPlane,
    job: &Job<'_>,
) -> Result<(), Error> {
    let (domain, own) = (&landscape.domain, layer.own());
    // A row as it is made, and as bytes.
    let run = (landscape.memory / (16 * domain.size.columns as u64)).clamp(1, 1 << 10) as usize;
    for first in own.clone().step_by(run) {
        let rows = first..(first + run).min(own.end);
        let whole = || {
            let name = &generator.target().0;
            Error::Run(format!("`{name}` is generated as a whole, and not by rows"))
        };
        let field = generator.fill_rows(domain, seed, rows.clone()).ok_or_else(whole)?;
        layer.set_rows(rows, field.values())?;
        if job.watcher.cancelled() {
            return Err(Error::Interrupted(format!("interrupted in row {first} of {}", domain.size.rows)));
        }
    }
    Ok(())
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

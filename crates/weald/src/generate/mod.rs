//! Generators: ground from nothing, one file a method.
//!
//! A generator fills the whole grid, no-data cells as well, so that its random numbers do not depend on the
//! mask. Positions are those of cell centres, in metres from the north-western corner of the landscape.

pub mod basin;
pub mod cone;
pub mod constant;
pub mod diamond_square;
pub mod fault;
pub mod fbm;
pub mod hash;
pub mod minstd;
pub mod noise;
pub mod octaves;
pub mod on_device;
pub mod plane;
pub mod relief;
pub mod ridged;
pub mod warp;

use std::fmt::Debug;

use crate::domain::Domain;
use crate::engine::program::Program;
use crate::engine::{Engine, Job};
use crate::error::Error;
use crate::grid::{Field, Size};
use crate::landscape::Landscape;
use crate::recipe::parameter::LayerName;
use crate::step::{Outcome, Step};
use on_device::OnDevice;

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

    /// Faults that concern several parameters at once, each a sentence for the user.
    fn contradictions(&self) -> Vec<String> {
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

    fn faults(&self) -> Vec<String> {
        self.contradictions()
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let seed = self.own_seed().unwrap_or(job.seed);
        let (field, notes) = heights(self, &landscape.domain, seed, &job.engine)?;
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

/// The programs of all generators that a device can run, for tests of the shaders.
pub fn programs() -> Vec<Program> {
    let domain = Domain::new(Size { columns: 5, rows: 4 }, 1.0);
    let made = [
        fbm::Fbm::default().on_device(&domain, 1),
        ridged::Ridged::default().on_device(&domain, 1),
        warp::Warp::default().on_device(&domain, 1),
        fault::Fault::default().on_device(&domain, 1),
        diamond_square::DiamondSquare::default().on_device(&domain, 1),
    ];
    made.into_iter().flatten().map(|work| work.program).collect()
}

/// Distance in metres of a cell's centre from a point given in metres from the western and the northern edge;
/// the middle of the landscape stands in for what is not given.
fn distance_from(domain: &Domain, center: [Option<f64>; 2]) -> impl Fn(usize, usize) -> f64 + use<> {
    let cell = domain.cell;
    let middle = [domain.size.columns, domain.size.rows].map(|cells| cells as f64 * cell / 2.0);
    let [center_x, center_y] = [0, 1].map(|axis| center[axis].unwrap_or(middle[axis]));
    move |x, y| {
        let [dx, dy] = [(x as f64 + 0.5) * cell - center_x, (y as f64 + 0.5) * cell - center_y];
        (dx * dx + dy * dy).sqrt()
    }
}

//! The two models with the keys of a recipe filled in, run or timed.

use pulp::Arch;

use super::{Boundary, Filled, Hydraulic, Model, Transport, UptakeLaw};
use crate::engine::world::World;
use crate::engine::{Engine, Job};
use crate::erode::han::{self, Han, HanConstants, Law};
use crate::erode::links::Links;
use crate::erode::mei::{self, Mei, MeiConstants};
use crate::erode::simulation::{Record, Simulation};
use crate::erode::working::{Kept, Working};
use crate::error::Error;
use crate::landscape::Landscape;
use crate::stencil::chain::Process;
use crate::stencil::rows::Rows;
use crate::step::Outcome;

impl Hydraulic {
    pub(super) fn run_han(
        &self,
        landscape: &mut Landscape,
        job: &Job<'_>,
        filled: &Filled,
        working: &Working,
    ) -> Result<Outcome, Error> {
        let simulation = Simulation {
            process: &self.han(filled, working),
            plane_names: &["change", "water", "sediment", "flux_east", "flux_south"],
            iterations: u64::from(self.iterations),
            weather: &|step| self.sky(filled, step),
            record: Some(Record { steps: self.last_cycle(filled), means: han::MEAN_FLUXES }),
        };
        let start = working.state(han::plane::COUNT, han::plane::DEPTH);
        let finished = simulation.run(start, job)?;
        Ok(working.store(landscape, &self.layer.0, &finished, self.kept()))
    }

    pub(super) fn run_mei(
        &self,
        landscape: &mut Landscape,
        job: &Job<'_>,
        filled: &Filled,
        working: &Working,
    ) -> Result<Outcome, Error> {
        let simulation = Simulation {
            process: &self.mei(filled, working),
            plane_names: &[
                "change",
                "water",
                "sediment",
                "flow_east",
                "flow_west",
                "flow_south",
                "flow_north",
            ],
            iterations: u64::from(self.iterations),
            weather: &|step| self.sky(filled, step),
            record: Some(Record { steps: self.last_cycle(filled), means: mei::MEAN_FLUXES }),
        };
        let start = working.state(mei::plane::COUNT, mei::plane::DEPTH);
        let finished = simulation.run(start, job)?;
        Ok(working.store(landscape, &self.layer.0, &finished, self.kept()))
    }

    fn han(&self, filled: &Filled, working: &Working) -> Han {
        Han {
            constants: HanConstants {
                flow_rate: filled.flow_rate,
                capacity: filled.capacity,
                erosion: filled.erosion,
                deposit_ratio: self.deposit_ratio as f32,
                epsilon: filled.epsilon,
                velocity_epsilon: filled.velocity_epsilon,
                limiter: self.limiter,
                law: if self.law == UptakeLaw::Velocity { Law::Velocity } else { Law::Dissolution },
            },
            links: Links::new(working.size, working.mask.is_some()),
            open: self.boundary == Boundary::Open,
            advection: self.advection(),
            slide: self.slide(),
            arch: Arch::new(),
        }
    }

    fn mei(&self, filled: &Filled, working: &Working) -> Mei {
        Mei {
            constants: MeiConstants {
                flow_rate: filled.flow_rate,
                capacity: filled.capacity,
                erosion: filled.erosion,
                deposition: self.deposition as f32,
                deposit_ratio: self.deposit_ratio as f32,
                epsilon: filled.epsilon,
                velocity_epsilon: filled.velocity_epsilon,
                limiter: self.limiter,
            },
            links: Links::new(working.size, working.mask.is_some()),
            open: self.boundary == Boundary::Open,
            advection: self.advection(),
            slide: self.slide(),
            arch: Arch::new(),
        }
    }

    fn kept(&self) -> Kept {
        Kept { iterations: u64::from(self.iterations), conserving: self.transport == Transport::Upwind }
    }

    /// Seconds that `iterations` steps take on a landscape, set-up and mean fluxes left out: for benchmarks.
    ///
    /// # Errors
    /// [`Error::Run`] where the landscape lacks the layer.
    pub fn seconds(&self, landscape: &Landscape, engine: Engine) -> Result<f64, Error> {
        let filled = self.filled(landscape.domain.cell);
        let working = Working::new(landscape, &self.layer.0, self.boundary == Boundary::Open)?;
        let weather: Vec<_> = (0..u64::from(self.iterations)).map(|step| self.sky(&filled, step)).collect();
        Ok(match self.model {
            Model::Han => {
                let start = working.state(han::plane::COUNT, han::plane::DEPTH);
                seconds_of(&self.han(&filled, &working), start, &weather, engine)
            }
            Model::Mei => {
                let start = working.state(mei::plane::COUNT, mei::plane::DEPTH);
                seconds_of(&self.mei(&filled, &working), start, &weather, engine)
            }
        })
    }
}

fn seconds_of<P: Process>(process: &P, start: Rows, weather: &[P::Weather], engine: Engine) -> f64 {
    let mut world = World::new(process, start, engine);
    let begun = std::time::Instant::now();
    world.advance(weather);
    begun.elapsed().as_secs_f64()
}

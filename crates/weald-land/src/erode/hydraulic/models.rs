//! The three models with the keys of a recipe filled in, run or timed.

use pulp::Arch;

use super::defaults::ResolvedKeys;
use super::keys::{Boundary, HanKeys, Hydraulic, MeiKeys, Model, UptakeLaw};
use crate::erode::edits::Edits;
use crate::erode::extent::Extent;
use crate::erode::finished::Finished;
use crate::erode::han::{self, Han, HanConstants};
use crate::erode::links::Links;
use crate::erode::mei::{self, Mei, MeiConstants};
use crate::erode::setting::Setting;
use crate::erode::simulation::{Record, Simulation};
use crate::erode::springs;
use crate::erode::springs::Forcing;
use crate::erode::working::{RunResult, WorkingGrid};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_engine::machine::{Means, Snapshot};
use weald_engine::machine_of_engine;
use weald_engine::program::Program;
use weald_engine::stencil::chain::Process;
use weald_engine::stencil::rows::Rows;
use weald_engine::step::Outcome;
use weald_engine::{Engine, Job};

/// Planes with which the states of mei and of stava begin.
pub(super) const MEI_PLANES: &[&str] =
    &["change", "water", "sediment", "flow_east", "flow_west", "flow_south", "flow_north"];

/// A model as the recipe asks for it: its process and what a simulation has to know of its state.
pub(super) struct SelectedModel<P> {
    pub(super) process: P,
    pub(super) plane_names: Vec<String>,
    pub(super) means: Means<'static>,
    /// Constant planes behind those of every model.
    pub(super) constants: Vec<Vec<f32>>,
    /// What a person changes between the steps.
    pub(super) edits: Option<Edits>,
}

impl<P: Process> SelectedModel<P> {
    pub(super) fn start(&self, working: &WorkingGrid) -> Rows {
        working.water_state(self.process.state_planes(), &self.constants)
    }
}

/// Names of planes as a simulation wants them.
pub(super) fn named(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

impl Hydraulic {
    /// The landscape in working units, such that strokes can change it where it is `editable`.
    pub(super) fn working(&self, landscape: &Landscape, editable: bool) -> Result<WorkingGrid, Error> {
        let open = self.boundary == Boundary::Open;
        let region = self.region.as_ref().map(|region| region.0.as_str());
        // Strokes count their places from the corner of the landscape.
        let extent = Extent { open, region, cropped: !editable };
        let mut working = WorkingGrid::within(landscape, &self.layer.0, &extent)?;
        if let Some(water) = &self.initial_water {
            working.set_water(landscape, &water.0)?;
        }
        if let Some(keys) = self.model.stava() {
            let deposit = keys.deposit_of(landscape)?;
            working.set_stack(landscape, keys.column(landscape), deposit)?;
        }
        if editable {
            working.set_changing_mask();
        }
        Ok(working)
    }

    /// Runs the model on a landscape in working units.
    pub(super) fn run_model(
        &self,
        landscape: &mut Landscape,
        job: &Job<'_>,
        filled: &ResolvedKeys,
        working: &WorkingGrid,
    ) -> Result<Outcome, Error> {
        let numbers = (filled, working);
        let finished = match &self.model {
            Model::Han(keys) => self.simulate(&self.han(keys, numbers), job, filled, (working, landscape)),
            Model::Mei(keys) => self.simulate(&self.mei(keys, numbers), job, filled, (working, landscape)),
            Model::Stava(keys) => {
                let script = self.script(&landscape.materials)?;
                let chosen = self.stava(keys, landscape, numbers, script)?;
                self.simulate(&chosen, job, filled, (working, landscape))
            }
        }?;
        let mut outcome = working.store(landscape, &self.layer.0, &finished, self.kept());
        let springs = self.model.stava().into_iter();
        for (key, springs) in springs.flat_map(|keys| [("sources", &keys.sources), ("drains", &keys.drains)])
        {
            outcome.notes.extend(springs::out_of_reach(&landscape.domain, key, springs));
        }
        Ok(outcome)
    }

    fn kept(&self) -> RunResult {
        RunResult { iterations: u64::from(self.iterations), conserving: self.conserves() }
    }

    fn simulate<P: Process<Weather = Forcing>>(
        &self,
        chosen: &SelectedModel<P>,
        job: &Job<'_>,
        filled: &ResolvedKeys,
        (working, landscape): (&WorkingGrid, &Landscape),
    ) -> Result<Finished, Error> {
        let seen = |finished: &Finished| {
            let mut seen = landscape.clone();
            working.store(&mut seen, &self.layer.0, finished, self.kept());
            seen
        };
        let simulation = Simulation {
            process: &chosen.process,
            plane_names: &chosen.plane_names,
            iterations: u64::from(self.iterations),
            weather: &|step| self.forcing(filled, step),
            record: Some(Record { steps: self.last_cycle(filled), means: chosen.means }),
            edits: chosen.edits.as_ref(),
            seen: Some(&seen),
        };
        working.show(job)?;
        simulation.run(chosen.start(working), job)
    }

    fn han(&self, keys: &HanKeys, (filled, working): (&ResolvedKeys, &WorkingGrid)) -> SelectedModel<Han> {
        let uptake = |law| if keys.law == law { filled.erosion } else { 0.0 };
        let constants = HanConstants {
            flow_rate: filled.flow_rate,
            capacity: filled.capacity,
            uptake_by_speed: uptake(UptakeLaw::Velocity),
            uptake_by_capacity: uptake(UptakeLaw::Dissolution),
            deposit_ratio: keys.deposit_ratio as f32,
            epsilon: filled.epsilon,
            velocity_epsilon: filled.velocity_epsilon,
        };
        SelectedModel {
            process: Han { constants, limiter: keys.limiter, setting: self.setting(filled, working) },
            plane_names: named(&["change", "water", "sediment", "flux_east", "flux_south"]),
            means: han::MEAN_FLUXES,
            constants: Vec::new(),
            edits: None,
        }
    }

    fn mei(&self, keys: &MeiKeys, (filled, working): (&ResolvedKeys, &WorkingGrid)) -> SelectedModel<Mei> {
        let constants = MeiConstants {
            flow_rate: filled.flow_rate,
            capacity: filled.capacity,
            erosion: filled.erosion,
            deposition: keys.deposition as f32,
            deposit_ratio: keys.deposit_ratio as f32,
            epsilon: filled.epsilon,
            velocity_epsilon: filled.velocity_epsilon,
        };
        SelectedModel {
            process: Mei { constants, limiter: keys.limiter, setting: self.setting(filled, working) },
            plane_names: named(MEI_PLANES),
            means: mei::MEAN_FLUXES,
            constants: Vec::new(),
            edits: None,
        }
    }

    pub(super) fn setting(&self, filled: &ResolvedKeys, working: &WorkingGrid) -> Setting {
        Setting {
            links: Links::new(working.size, working.mask.is_some()),
            open: self.boundary == Boundary::Open,
            advection: self.advection(filled),
            slide: self.slide(),
            arch: Arch::new(),
        }
    }

    /// The model on a landscape as compute passes.
    pub fn program(&self, landscape: &Landscape) -> Result<Program, Error> {
        let filled = self.filled(landscape.domain.cell);
        let working = self.working(landscape, false)?;
        let numbers = (&filled, &working);
        Ok(match &self.model {
            Model::Han(keys) => self.han(keys, numbers).process.program(),
            Model::Mei(keys) => self.mei(keys, numbers).process.program(),
            Model::Stava(keys) => self.stava(keys, landscape, numbers, None)?.process.program(),
        })
    }

    /// Seconds that `iterations` steps take on a landscape, set-up and mean fluxes left out: for benchmarks.
    ///
    /// # Errors
    /// [`Error::Run`] where the landscape lacks the layer.
    pub fn seconds(&self, landscape: &Landscape, engine: &Engine) -> Result<f64, Error> {
        let filled = self.filled(landscape.domain.cell);
        let working = self.working(landscape, false)?;
        let weather: Vec<_> =
            (0..u64::from(self.iterations)).map(|step| self.forcing(&filled, step)).collect();
        let numbers = (&filled, &working);
        match &self.model {
            Model::Han(keys) => seconds_of(&self.han(keys, numbers), &working, &weather, engine),
            Model::Mei(keys) => seconds_of(&self.mei(keys, numbers), &working, &weather, engine),
            Model::Stava(keys) => {
                seconds_of(&self.stava(keys, landscape, numbers, None)?, &working, &weather, engine)
            }
        }
    }
}

fn seconds_of<P: Process<Weather = Forcing>>(
    chosen: &SelectedModel<P>,
    working: &WorkingGrid,
    weather: &[Forcing],
    engine: &Engine,
) -> Result<f64, Error> {
    let start = Snapshot::start(chosen.start(working), 0);
    let mut machine = machine_of_engine::start(&chosen.process, &[], &start, engine)?;
    // The first step compiles, allocates and warms up; the look at the end waits for a device.
    machine.advance(&weather[..1], false)?;
    machine.first_not_finite()?;
    let begun = std::time::Instant::now();
    machine.advance(weather, false)?;
    machine.first_not_finite()?;
    Ok(begun.elapsed().as_secs_f64())
}

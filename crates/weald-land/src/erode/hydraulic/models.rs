//! The models with the keys of a recipe filled in: begun on a landscape, or timed.

use std::sync::Arc;

use pulp::Arch;

use super::defaults::ResolvedKeys;
use super::keys::{Boundary, Hydraulic, Model};
use crate::edit::Setting;
use crate::erode::edits::{PaintedPlanes, Place};
use crate::erode::extent::Extent;
use crate::erode::finished::Finished;
use crate::erode::han::Han;
use crate::erode::interactive::InteractiveSimulation;
use crate::erode::links::Links;
use crate::erode::material_planes::WEATHER_PLANES;
use crate::erode::mei::Mei;
use crate::erode::scripted::{Numbers, Remake};
use crate::erode::setting::Setting as Around;
use crate::erode::settings;
use crate::erode::springs;
use crate::erode::springs::Forcing;
use crate::erode::stack::Column;
use crate::erode::started::{Course, StartedSimulation, unscripted};
use crate::erode::stava::Stava;
use crate::erode::water_planes as plane;
use crate::erode::working::{RunResult, WorkingGrid};
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_engine::machine::{Means, Snapshot};
use weald_engine::machine_of_engine;
use weald_engine::program::Program;
use weald_engine::stencil::chain::Process;
use weald_engine::step::Outcome;
use weald_engine::{Engine, Job};

/// Keys of what a simulation begins with.
const FIXED: &[&str] = &[
    "model",
    "iterations",
    "mean_over",
    "boundary",
    "layer",
    "initial_water",
    "region",
    "edits",
    "rain_layer",
    "evaporation_layer",
    "source_layer",
    "sources",
    "drains",
    "deposit",
];

/// What a model is made from.
pub(super) struct OnLand<'a> {
    pub(super) landscape: &'a Landscape,
    pub(super) filled: &'a ResolvedKeys,
    pub(super) working: &'a WorkingGrid,
    /// Whether there are planes of painted weather.
    pub(super) painted: bool,
}

/// A model by the keys of the step.
pub(super) trait Scheme: Process<Weather = Forcing> {
    /// Means of the water's fluxes.
    const MEANS: Means<'static>;

    /// The process.
    fn of(step: &Hydraulic, on: &OnLand<'_>) -> Result<Self, Error>
    where
        Self: Sized;

    /// Names of its state planes.
    fn plane_names(&self, landscape: &Landscape) -> Vec<String>;

    /// Where the materials stand that it tells apart.
    fn column(&self) -> Column;

    /// Constant planes of painted weather, where there are any or may be.
    fn weather(
        step: &Hydraulic,
        landscape: &Landscape,
        working: &WorkingGrid,
        changes: bool,
    ) -> Result<Vec<Vec<f32>>, Error> {
        let _ = (step, landscape, working, changes);
        Ok(Vec::new())
    }
}

/// Names of planes as a simulation wants them.
pub(super) fn named(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

impl Hydraulic {
    /// The landscape in working units, such that strokes can change it where it is `editable`.
    fn working(&self, landscape: &Landscape, editable: bool) -> Result<WorkingGrid, Error> {
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

    /// Runs the model on a landscape.
    pub(super) fn run_model(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let editable = self.edits.is_some();
        let course = Course {
            iterations: u64::from(self.iterations),
            record: self.recorded(landscape.domain.cell),
            script: self.script(&landscape.materials)?,
            seen: true,
        };
        match &self.model {
            Model::Han(_) => self.begin::<Han>(landscape, editable)?.run(course, landscape, job),
            Model::Mei(_) => self.begin::<Mei>(landscape, editable)?.run(course, landscape, job),
            Model::Stava(_) => self.begin::<Stava>(landscape, editable)?.run(course, landscape, job),
        }
    }

    /// The model as a simulation that a person holds.
    pub(super) fn held(
        &self,
        landscape: &Landscape,
        engine: &Engine,
    ) -> Result<InteractiveSimulation, Error> {
        match &self.model {
            Model::Han(_) => {
                InteractiveSimulation::new(self.begin::<Han>(landscape, true)?, landscape, engine)
            }
            Model::Mei(_) => {
                InteractiveSimulation::new(self.begin::<Mei>(landscape, true)?, landscape, engine)
            }
            Model::Stava(_) => {
                InteractiveSimulation::new(self.begin::<Stava>(landscape, true)?, landscape, engine)
            }
        }
    }

    /// What a simulation begins with.
    fn begin<M: Scheme>(&self, landscape: &Landscape, editable: bool) -> Result<StartedSimulation<M>, Error> {
        let filled = self.filled(landscape.domain.cell);
        let working = Arc::new(self.working(landscape, editable)?);
        let weather = M::weather(self, landscape, &working, editable)?;
        let painted = !weather.is_empty();
        let process = M::of(self, &OnLand { landscape, filled: &filled, working: &working, painted })?;
        let place = editable.then(|| Arc::new(self.place(&process, landscape, &working, painted)));
        let remake = if editable { self.remake(landscape, &working, painted) } else { unscripted() };
        let (planes, ground) = (process.state_planes(), Arc::clone(&working));
        Ok(StartedSimulation {
            plane_names: process.plane_names(landscape),
            start: Box::new(move || ground.water_state(planes, &weather)),
            numbers: self.numbers(process, filled),
            remake,
            means: M::MEANS,
            place,
            store: self.store(&working),
            working: Some(working),
        })
    }

    fn numbers<M: Scheme>(&self, process: M, filled: ResolvedKeys) -> Numbers<M> {
        let step = self.clone();
        Numbers::new(process, move |at| step.forcing(&filled, at))
    }

    /// The step after keys were set while it ran.
    pub(super) fn after(&self, settings: &[Setting]) -> Result<Self, Error> {
        settings::after(self, (&[self.model.word()], FIXED), settings)
    }

    fn remake<M: Scheme>(
        &self,
        landscape: &Landscape,
        working: &Arc<WorkingGrid>,
        painted: bool,
    ) -> Remake<M> {
        let (step, landscape, working) = (self.clone(), landscape.clone(), Arc::clone(working));
        Arc::new(move |settings| {
            let step = step.after(settings)?;
            settings::no_faults(&step, &landscape.materials)?;
            let filled = step.filled(landscape.domain.cell);
            let on = OnLand { landscape: &landscape, filled: &filled, working: &working, painted };
            let process = M::of(&step, &on)?;
            Ok(step.numbers(process, filled))
        })
    }

    fn place<M: Scheme>(
        &self,
        process: &M,
        landscape: &Landscape,
        working: &WorkingGrid,
        painted: bool,
    ) -> Place {
        let column = process.column();
        let planes = PaintedPlanes {
            water: Some(plane::DEPTH),
            weather: painted.then(|| process.state_planes() + process.constant_planes() - WEATHER_PLANES),
            ..PaintedPlanes::of(process, column, working)
        };
        let materials = landscape.materials.iter().take(column.planes.materials);
        let materials = materials.map(|material| material.name.clone()).collect();
        Place::of(self.model.word(), working, materials, planes)
    }

    /// Writes what the simulation leaves.
    fn store(&self, working: &Arc<WorkingGrid>) -> crate::erode::started::Store {
        let (step, working) = (self.clone(), Arc::clone(working));
        Arc::new(move |landscape: &mut Landscape, finished: &Finished, iterations| {
            let kept = RunResult { iterations, conserving: step.conserves() };
            let mut outcome = working.store(landscape, &step.layer.0, finished, kept);
            let stava = step.model.stava().into_iter();
            for (key, springs) in
                stava.flat_map(|keys| [("sources", &keys.sources), ("drains", &keys.drains)])
            {
                outcome.notes.extend(springs::out_of_reach(&landscape.domain, key, springs));
            }
            Ok(outcome)
        })
    }

    pub(super) fn setting(&self, filled: &ResolvedKeys, (size, is_masked): (Size, bool)) -> Around {
        Around {
            links: Links::new(size, is_masked),
            open: self.boundary == Boundary::Open,
            advection: self.advection(filled),
            slide: self.slide(),
            arch: Arch::new(),
        }
    }

    /// The model on a landscape as compute passes.
    pub fn program(&self, landscape: &Landscape) -> Result<Program, Error> {
        Ok(match &self.model {
            Model::Han(_) => self.begin::<Han>(landscape, false)?.numbers.process.program(),
            Model::Mei(_) => self.begin::<Mei>(landscape, false)?.numbers.process.program(),
            Model::Stava(_) => self.begin::<Stava>(landscape, false)?.numbers.process.program(),
        })
    }

    /// Seconds that `iterations` steps take on a landscape, set-up and mean fluxes left out: for benchmarks.
    ///
    /// # Errors
    /// [`Error::Run`] where the landscape lacks the layer.
    pub fn seconds(&self, landscape: &Landscape, engine: &Engine) -> Result<f64, Error> {
        let iterations = u64::from(self.iterations);
        match &self.model {
            Model::Han(_) => seconds_of(self.begin::<Han>(landscape, false)?, iterations, engine),
            Model::Mei(_) => seconds_of(self.begin::<Mei>(landscape, false)?, iterations, engine),
            Model::Stava(_) => seconds_of(self.begin::<Stava>(landscape, false)?, iterations, engine),
        }
    }
}

fn seconds_of<M: Scheme>(
    begun: StartedSimulation<M>,
    iterations: u64,
    engine: &Engine,
) -> Result<f64, Error> {
    let weather: Vec<_> = (0..iterations).map(|step| (begun.numbers.weather)(step)).collect();
    let start = Snapshot::start((begun.start)(), 0);
    let mut machine = machine_of_engine::start(&begun.numbers.process, &[], &start, engine)?;
    // The first step compiles, allocates and warms up; the look at the end waits for a device.
    machine.advance(&weather[..1], false)?;
    machine.first_not_finite()?;
    let begun = web_time::Instant::now();
    machine.advance(&weather, false)?;
    machine.first_not_finite()?;
    Ok(begun.elapsed().as_secs_f64())
}

/// The model cannot change while it runs, and a step knows its own: a bug.
pub(super) fn another_model(step: &Hydraulic) -> Error {
    Error::Run(format!("a simulation of another model was asked to be `{}`", step.model.word()))
}

//! The `fluvial` step: floods carve ground over years, in metres and time.

use super::extent::Extent;
use super::finished::Finished;
use super::fluvial::{self, FluvialConstants};
use super::fluvial_levels::{self as levels, HandedDown, OfCoarse};
use super::forcing::Forcing;
use super::hydraulic::Boundary;
use super::pipeline::Stepped;
use super::simulation::{Record, Simulation};
use super::stored::MeanFluxes;
use super::water_planes as plane;
use super::working::WorkingGrid;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Fault, LayerName};
use weald_core::parameters;
use weald_engine::stencil::rows::Rows;
use weald_engine::step::{Entry, Outcome, Stage, Step};
use weald_engine::{Budget, Job};

parameters! {
    /// Floods that carve ground over years: rivers, valleys, fans and lakes in metres and time. The grid only says how
    /// finely all this is computed: the length of a step follows from the cells, and their number with it.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::erode::fluvial_step::Fluvial;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(32, 32)?, 40.0)); // columns, rows, metres
    /// let valley = |x, y| 6.0 * (x as f32 - 16.0).abs() + 4.0 * (32.0 - y as f32);
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, valley));
    /// let outcome = Fluvial { flow_time: 0.5, ..Fluvial::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let deepest = landscape.field("erosion")?.range(None).expect("there are cells").1;
    /// assert!(deepest > 0.5, "the river has carved up to {deepest} m");
    /// assert!(outcome.budget.expect("is kept").solid.error().abs() < 1.0e-5, "nothing is lost");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Fluvial {
        /// Years that pass for the ground.
        duration: f64 = 10_000.0, range 0.0..=100_000_000.0, unit "a";
        /// Time of flow that stands for them: all of these years' floods as one. Water needs some hours to come down
        /// from a mountain range; the longer it flows, the less the ground changes under it at a time.
        flow_time: f64 = 3.0, range 0.001..=100_000.0, unit "h";
        /// Rain that runs off in a flood, over all of the ground.
        rain: f64 = 40.0, range 0.0..=10_000.0, unit "mm/h";
        /// Ground that a unit of stream power takes up in a year (K). Hard rock has less than 1, loose soil 10 and more.
        erodibility: f64 = 3.0, range 0.0..=100_000.0, unit "m/a per m²/s";
        /// Unit stream power below which nothing is taken up: discharge by width, times slope.
        threshold: f64 = 0.002, range 0.0..=1000.0, unit "m²/s";
        /// Speed at which sediment falls to the bed (v_s): the faster, the sooner it settles again.
        settling: f64 = 0.002, range 0.0..=10.0, unit "m/s";
        /// Width of a channel in which 1 m³/s flows; others are wider with the root of their discharge.
        channel_width: f64 = 4.0, range 0.01..=1000.0, unit "m";
        /// Distance of the channels in which water gathers that runs down a slope as a sheet.
        gathering: f64 = 20.0, range 0.01..=10_000.0, unit "m";
        /// Friction of the bed (c_f, an eighth of the factor of Darcy and Weisbach): 0.003 for smooth, 0.1 for rough
        /// beds.
        friction: f64 = 0.01, range 0.0001..=10.0;
        /// Depth from which on water flows as if it were that deep. It bounds the speed of waves, and so the number of
        /// steps.
        deepest: f64 = 2.0, range 0.01..=1000.0, unit "m";
        /// Creep of the ground (D), which rounds what rivers do not reach.
        creep: f64 = 0.03, range 0.0..=1000.0, unit "m²/a";
        /// Steepest slope that rests, as a tangent.
        talus: f64 = 0.7, range 0.0..=100.0;
        /// How fast steeper ground slides.
        slide: f64 = 1.0, range 0.0..=10_000.0, unit "m²/a";
        /// Grids that it runs on, each with cells twice as long as those of the next: nine tenths of the time pass on the
        /// coarser ones, which hand ground, water and sediment down. 3 is some six times as fast as 1. The numbers of
        /// cells must divide, and none may be without data.
        levels: u32 = 1, range 1..=8;
        /// What happens at the edge and at no-data cells.
        boundary: Boundary = Boundary::Open;
        /// Layer to erode.
        layer: LayerName = LayerName::of("height");
        /// Layer with the depth of water that stands at the start. Default: none stands.
        initial_water: Option<LayerName> = None;
        /// Layer that says where to simulate: cells where it is below 0.5 stand still, and nothing passes
        /// their edge. Default: everywhere.
        region: Option<LayerName> = None;
    }
}

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Fluvial>(
    "fluvial",
    Stage::Erode,
    "carves ground by the floods of years, in metres and time",
    "Bates, Horritt, Fewtrell 2010, doi 10.1016/j.jhydrol.2010.03.027; Davy and Lague 2009, doi 10.1029/2008JF001146",
);

/// Gravity in m/s².
const GRAVITY: f64 = 9.81;

/// Part of a cell that the fastest wave passes in a step. Eight pipes are stable up to √3/2.
const COURANT: f64 = 0.5;

/// Most of the step between two cells that creeps or slides in a step of time. Stable up to 3/8.
const MAX_UNREST: f64 = 0.15;

/// Depth in metres that is added where something is divided by depth.
const THIN: f64 = 0.001;

/// Steps of the end over which fluxes are averaged: one in so many.
const RECORDED: u64 = 10;

/// How long a step is, and how many there are.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Steps {
    seconds: f64,
    count: u64,
}

impl Fluvial {
    /// Years that pass in a second of flow.
    fn years_a_second(&self) -> f64 {
        self.duration / (self.flow_time * 3600.0)
    }

    /// The longest steps that are stable, so many that they fill the time.
    fn steps(&self, cell: f64) -> Steps {
        let by_waves = COURANT * cell / (GRAVITY * self.deepest).sqrt();
        let diffusivity = (self.creep + self.slide) * self.years_a_second();
        let by_ground = MAX_UNREST * cell * cell / diffusivity.max(f64::MIN_POSITIVE);
        let time = self.flow_time * 3600.0;
        let count = (time / by_waves.min(by_ground)).ceil().max(1.0);
        Steps { seconds: time / count, count: count as u64 }
    }

    /// The numbers in cells and steps.
    fn constants(&self, cell: f64, Steps { seconds, .. }: Steps) -> FluvialConstants {
        let years = self.years_a_second();
        let by_area = seconds / (cell * cell);
        FluvialConstants {
            flow_rate: (GRAVITY * seconds * seconds / cell) as f32,
            deepest: (self.deepest / cell) as f32,
            friction: self.friction as f32,
            gathering: (self.gathering / cell) as f32,
            channel_width: (self.channel_width * (cell / seconds).sqrt()) as f32,
            erodibility: (self.erodibility * years * cell) as f32,
            threshold: (self.threshold * by_area) as f32,
            settling: (self.settling * seconds / cell) as f32,
            thin: (THIN / cell) as f32,
            talus: self.talus as f32,
            slide: (self.slide * years * by_area) as f32,
            creep: (self.creep * years * by_area) as f32,
            open: f32::from(u8::from(self.boundary == Boundary::Open)),
        }
    }

    fn working(&self, landscape: &Landscape) -> Result<WorkingGrid, Error> {
        let open = self.boundary == Boundary::Open;
        let region = self.region.as_ref().map(|region| region.0.as_str());
        let mut working =
            WorkingGrid::within(landscape, &self.layer.0, &Extent { open, region, cropped: true })?;
        if let Some(water) = &self.initial_water {
            working.set_water(landscape, &water.0)?;
        }
        Ok(working)
    }

    fn process(&self, working: &WorkingGrid) -> Stepped<Forcing> {
        let constants = self.constants(working.cell, self.steps(working.cell));
        let pipeline = fluvial::pipeline(&constants);
        let masked = working.mask.is_some();
        let program = fluvial::program(&constants, masked, pipeline.reach());
        Stepped::with_program(&pipeline, (working.size, masked), program)
    }

    /// The same for the time that passes on a level.
    fn for_level(&self, level: u32) -> Self {
        let share = levels::share_of_time(level, self.levels);
        let (duration, flow_time) = (self.duration * share, self.flow_time * share);
        Self { duration, flow_time, ..self.clone() }
    }

    /// A coarse level: its budget, and what it hands down.
    fn coarse(
        &self,
        landscape: &Landscape,
        (level, handed): (u32, Option<&HandedDown>),
        job: &Job<'_>,
    ) -> Result<(Budget, HandedDown), Error> {
        let step = self.for_level(level);
        let layers: Vec<_> = std::iter::once(&self.layer).chain(&self.initial_water).collect();
        let coarse = levels::coarsened(landscape, 1 << level, &layers)?;
        let mut working = step.working(&coarse)?;
        let start = start(&mut working, handed);
        let watcher = OfCoarse(job.watcher);
        let finished = step.flood((&coarse, &working), start, &watcher.job(job))?;
        let cell = working.cell as f32;
        let planes = [plane::CHANGE, plane::DEPTH, plane::SEDIMENT].map(|at| finished.state.gather(at));
        let [change, water, sediment] =
            planes.each_ref().map(|plane| working.field(plane, |value| value * cell));
        let budget = working.budget(&planes[1], &planes[2], &finished);
        Ok((budget, HandedDown { change, water, sediment }))
    }

    fn fluxes(&self, working: &WorkingGrid, finished: &Finished) -> MeanFluxes {
        let planes = fluvial::through_sides(&finished.means, working.size.columns);
        let factor = (working.cell.powi(3) / self.steps(working.cell).seconds) as f32;
        MeanFluxes { planes, unit: "m³/s", factor }
    }

    /// Runs all steps.
    fn flood(
        &self,
        (landscape, working): (&Landscape, &WorkingGrid),
        start: Rows,
        job: &Job<'_>,
    ) -> Result<Finished, Error> {
        let Steps { seconds, count } = self.steps(working.cell);
        let process = self.process(working);
        let plane_names = process.state_names();
        let rain = (self.rain / 3.6e6 * seconds / working.cell) as f32;
        let seen = |finished: &Finished| {
            let mut seen = landscape.clone();
            working.store_with(&mut seen, &self.layer.0, finished, &self.fluxes(working, finished));
            seen
        };
        let simulation = Simulation {
            process: &process,
            plane_names: &plane_names,
            iterations: count,
            weather: &|_| Forcing { rain, evaporation: 0.0 },
            record: Some(Record {
                steps: count - count.div_ceil(RECORDED)..count,
                means: fluvial::MEAN_FLUXES,
            }),
            edits: None,
            seen: Some(&seen),
        };
        working.show(job)?;
        simulation.run(start, job)
    }
}

/// The state before the first step, with what a coarser level hands down.
fn start(working: &mut WorkingGrid, handed: Option<&HandedDown>) -> Rows {
    let Some(HandedDown { change, water, sediment }) = handed else {
        return working.water_state(fluvial::PLANES, &[]);
    };
    working.set_standing(water.clone());
    let mut rows = working.water_state(fluvial::PLANES, &[]);
    let cell = working.cell as f32;
    rows.scatter(plane::CHANGE, &working.ringed(|x, y| change.at(x, y) / cell));
    rows.scatter(plane::SEDIMENT, &working.lengths(sediment));
    rows
}

impl Step for Fluvial {
    fn reads(&self) -> Vec<String> {
        let others = [&self.initial_water, &self.region].into_iter().flatten();
        std::iter::once(&self.layer).chain(others).map(|name| name.0.clone()).collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        let own = [
            ("water", "m"),
            ("sediment", "m"),
            ("flux_x", "m³/s"),
            ("flux_y", "m³/s"),
            ("erosion", "m"),
            ("deposition", "m"),
        ];
        let own = own.map(|(name, unit)| (name.to_owned(), unit));
        std::iter::once((self.layer.0.clone(), "m")).chain(own).collect()
    }

    fn faults(&self) -> Vec<Fault> {
        let fault = || {
            let message = format!("`levels` is {}, but must be 1 with a `region`", self.levels);
            Fault::of("levels", message)
        };
        (self.levels > 1 && self.region.is_some()).then(fault).into_iter().collect()
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        levels::check(landscape, self.levels)?;
        let (mut before, mut handed) = (Vec::new(), None);
        for level in (1..self.levels).rev() {
            let (budget, down) = self.coarse(landscape, (level, handed.as_ref()), job)?;
            before.push(budget);
            handed = Some(down.refined());
        }
        let step = self.for_level(0);
        let mut working = step.working(landscape)?;
        let start = start(&mut working, handed.as_ref());
        let finished = step.flood((landscape, &working), start, job)?;
        let fluxes = step.fluxes(&working, &finished);
        let budget = working.store_with(landscape, &self.layer.0, &finished, &fluxes);
        let budget = before.iter().fold(budget, levels::joined);
        let iterations = step.steps(landscape.domain.cell).count;
        Ok(Outcome { iterations, budget: Some(budget), notes: finished.notes, ..Outcome::default() })
    }
}

/// The step in every variant that has code of its own.
pub(super) fn variants() -> Vec<Box<dyn Step>> {
    let flood = Fluvial {
        flow_time: 0.002,
        rain: 20_000.0,
        duration: 0.3,
        deepest: 0.5,
        gathering: 1.0,
        channel_width: 0.3,
        ..Fluvial::default()
    };
    let painted = Some(LayerName::of("painted"));
    vec![
        Box::new(Fluvial { boundary: Boundary::Closed, ..flood.clone() }),
        Box::new(Fluvial { region: painted, ..flood.clone() }),
        Box::new(flood),
    ]
}

/// Its programs in every variant, for tests of the shaders.
pub(super) fn programs() -> impl Iterator<Item = weald_engine::program::Program> {
    let borders = [(Boundary::Closed, false), (Boundary::Closed, true), (Boundary::Open, true)];
    borders.into_iter().map(|(boundary, masked)| {
        let step = Fluvial { boundary, ..Fluvial::default() };
        let constants = step.constants(10.0, step.steps(10.0));
        fluvial::program(&constants, masked, fluvial::pipeline(&constants).reach())
    })
}

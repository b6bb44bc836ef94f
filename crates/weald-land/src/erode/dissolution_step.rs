//! The `dissolution` step: ground under standing water turns into regolith, which creeps downhill.

use std::path::PathBuf;
use std::sync::Arc;

use pulp::Arch;

use super::edits::{PaintedPlanes, Place};
use super::links::Links;
use super::loose::{self, Loose};
use super::material_planes::{Planes, REGOLITH_PLANES};
use super::on_ground::store_ground;
use super::scripted::Numbers;
use super::stack::{self, Column, REGOLITH, deposit_of};
use super::started::StartedSimulation;
use super::stava::digging::{DigScratch, Digging};
use super::stava::dissolution::{Dissolution, DissolutionScratch, RegolithRows};
use super::stava::program::{self, StavaNumbers};
use super::sweep::Sweep;
use super::working::WorkingGrid;
use crate::edit::Setting;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{Fault, LayerName, ScriptFile};
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::program::{Content, Program};
use weald_engine::stencil::chain::{Flow, Process};
use weald_engine::stencil::ring::Ring;
use weald_engine::step::{Entry, Layered, Outcome, Stage, Step, Work};

parameters! {
    /// Dissolution as a step of its own, under water that stands still.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::erode::dissolution_step::DissolutionStep;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::filled(landscape.domain.size, 100.0));
    /// let pond = |x, _| if x < 4 { 3.0 } else { 0.0 };
    /// landscape.insert("water", "m", Field::from_function(landscape.domain.size, pond));
    /// DissolutionStep::default().run(&mut landscape, &Job::unwatched(0))?;
    /// let regolith = landscape.field("regolith")?;
    /// let soaked = 0.2 * (1.0 - (1.0 - 0.002_f32).powi(100)); // depth, solubility of rock, iterations
    /// assert!((regolith.at(1, 3) - soaked).abs() < 1.0e-4, "under the water");
    /// assert_eq!(regolith.at(7, 3), 0.0, "on dry ground");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct DissolutionStep {
        /// Depth to which standing water soaks the ground (`r_max`).
        depth: f64 = 0.2, range 0.0..=1000.0, unit "m";
        /// Share of the flow of the regolith that friction takes in an iteration.
        damping: f64 = 0.85, range 0.0..=1.0;
        /// Pipe constant k of the regolith, which is no discharge: how fast differences in level turn into flow.
        /// Unstable above 0.5.
        flow_rate: f64 = 0.0981, range 0.0001..=0.5;
        /// Material that settles. Default: the last of the landscape.
        deposit: Option<LayerName> = None;
        /// Iterations to run.
        iterations: u32 = 100, range 0..=10_000_000;
        /// Layer with the depth of the water.
        water: LayerName = LayerName::of("water");
        /// Layer with the height of the ground.
        layer: LayerName = LayerName::of("height");
        /// Script of edits, in JSON lines (.jsonl) or TOML: strokes of a brush, and keys that change, between iterations.
        /// Its path starts at the folder of the recipe.
        edits: Option<ScriptFile> = None;
    }
}

parameters! {
    /// Dissolution within every iteration of `hydraulic`.
    pub struct DissolutionWithin {
        /// Depth to which standing water soaks the ground (`r_max`).
        depth: f64 = 0.2, range 0.0..=1000.0, unit "m";
        /// Share of the flow of the regolith that friction takes in an iteration.
        damping: f64 = 0.85, range 0.0..=1.0;
    }
}

impl DissolutionWithin {
    /// The method's constants for these materials, with the first plane of the regolith, the flow rate and the
    /// cell size.
    pub(crate) fn dissolution(
        &self,
        materials: &[Material],
        deposit: usize,
        plane: usize,
        (flow_rate, cell): (f32, f64),
    ) -> Dissolution {
        let shares = materials.iter().map(|material| material.solubility.clamp(0.0, 1.0) as f32).collect();
        Dissolution {
            plane,
            most: (self.depth / cell) as f32,
            kept: (1.0 - self.damping) as f32,
            flow_rate,
            // Surplus settles at once: ground under water strives for just `r_max`.
            digging: Digging { shares, deposit, deposition: 1.0 },
        }
    }
}

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<DissolutionStep>(
    "dissolution",
    Stage::Erode,
    "softens ground under standing water to regolith, which creeps downhill",
    "Šťava et al. 2008, doi 10.2312/SCA/SCA08/201-210",
);

/// First plane of the regolith, behind the change of the bedrock.
const REGOLITH_PLANE: usize = 1;

impl Step for DissolutionStep {
    fn reads(&self) -> Vec<String> {
        vec![self.layer.0.clone(), self.water.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        [self.layer.0.as_str(), REGOLITH].map(|name| (name.to_owned(), "m")).into()
    }

    fn layered(&self) -> Layered {
        Layered::Changes
    }

    fn faults_among(&self, materials: &[Material]) -> Vec<Fault> {
        let fault = deposit_of(self.deposit.as_ref(), materials).err();
        fault.map(|message| Fault::of("deposit", message)).into_iter().collect()
    }

    fn bytes_per_cell(&self) -> u64 {
        60
    }

    fn runs_over_ranks(&self) -> bool {
        true
    }

    fn work(&self, _: &Domain) -> Work {
        Work::of(self.iterations)
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        loose::run(self, landscape, job)
    }

    fn files(&self) -> Vec<PathBuf> {
        loose::files(self)
    }

    fn look_ahead(&self, materials: &[Material], _: &Domain) -> Result<(), Error> {
        loose::script(self, materials).map(drop)
    }
}

impl Loose for DissolutionStep {
    type Process = Dissolving;

    const FIXED: &'static [&'static str] = &["layer", "water", "deposit"];

    fn begin(&self, landscape: &Landscape, editable: bool) -> Result<StartedSimulation<Dissolving>, Error> {
        let deposit = deposit_of(self.deposit.as_ref(), &landscape.materials).map_err(Error::Run)?;
        let mut working = WorkingGrid::new(landscape, &self.layer.0, false)?;
        working.set_water(landscape, &self.water.0)?;
        let first_layer = REGOLITH_PLANE + REGOLITH_PLANES;
        let planes = Planes { first_layer, materials: landscape.materials.len() };
        let column = Column { planes, regolith: Some(REGOLITH_PLANE) };
        working.set_stack(landscape, column, deposit)?;
        if editable {
            working.set_changing_mask();
        }
        let working = Arc::new(working);
        let (step, materials, grid) = (self.clone(), landscape.materials.clone(), Arc::clone(&working));
        let process = move |settings: &[Setting]| -> Result<Dissolving, Error> {
            Ok(loose::after(&step, settings)?.process(&materials, deposit, planes, &grid))
        };
        let first = process(&[])?;
        let water = Some(first.state_planes() + first.constant_planes() - 1);
        let painted = PaintedPlanes { water, ..PaintedPlanes::of(&first, column, &working) };
        let names = stack::names(&landscape.materials);
        let ground = Arc::clone(&working);
        Ok(StartedSimulation {
            plane_names: stack::plane_names(column, &landscape.materials),
            start: Box::new(move || ground.state(planes.count(), &[ground.water().to_vec()])),
            numbers: Numbers::new(first, |_| ()),
            remake: Arc::new(move |settings| Ok(Numbers::new(process(settings)?, |_| ()))),
            means: &[],
            place: Some(Arc::new(Place::of("dissolution", &working, names, painted))),
            store: store_ground(&working, &self.layer.0),
            working: Some(working),
        })
    }

    fn iterations(&self) -> u32 {
        self.iterations
    }

    fn edits(&self) -> Option<&ScriptFile> {
        self.edits.as_ref()
    }
}

impl DissolutionStep {
    fn process(
        &self,
        materials: &[Material],
        deposit: usize,
        planes: Planes,
        working: &WorkingGrid,
    ) -> Dissolving {
        let within = DissolutionWithin { depth: self.depth, damping: self.damping };
        let numbers = (self.flow_rate as f32, working.cell);
        Dissolving {
            dissolution: within.dissolution(materials, deposit, REGOLITH_PLANE, numbers),
            planes,
            links: Links::new(working.size, working.mask.is_some()),
            arch: Arch::new(),
        }
    }
}

/// Dissolution alone as a stream of rows. The last constant plane is the depth of the water.
pub(super) struct Dissolving {
    pub(super) dissolution: Dissolution,
    pub(super) planes: Planes,
    pub(super) links: Links,
    pub(super) arch: Arch,
}

/// Rows in flight within one step.
pub(super) struct DissolvingScratch {
    solid: Vec<Ring>,
    dig: DigScratch,
    dissolution: DissolutionScratch,
}

impl Process for Dissolving {
    type Weather = ();
    type Scratch = DissolvingScratch;

    fn state_planes(&self) -> usize {
        self.planes.count()
    }

    fn constant_planes(&self) -> usize {
        2 + self.links.planes()
    }

    fn lag(&self) -> usize {
        Dissolution::LAG
    }

    fn begins(&self) -> usize {
        // Materials leave as soon as they come.
        0
    }

    fn scratch(&self, columns: usize) -> DissolvingScratch {
        DissolvingScratch {
            solid: (0..self.planes.materials).map(|_| Ring::new(columns, 1)).collect(),
            dig: DigScratch::new(columns),
            dissolution: DissolutionScratch::new(columns),
        }
    }

    fn sized(&self, size: Size) -> Self {
        Self { dissolution: self.dissolution.clone(), links: self.links.sized(size), ..*self }
    }

    fn program(&self) -> Program {
        let numbers = StavaNumbers::of(Some(&self.dissolution), None);
        let deposit = (self.planes, self.dissolution.digging.deposit);
        let mut draft = program::draft("dissolution", &numbers, deposit, self.links.planes() > 0);
        let water = self.planes.count() + 1 + self.links.planes();
        draft.buffer("water", 1, Content::Constant(vec![water]));
        self.dissolution.add_buffers_to(&mut draft);
        Dissolution::add_to(&mut draft, include_str!("stava/standing_lake.wgsl"), "water");
        draft.shows("column", None);
        draft.finish(self.reach())
    }

    fn advance(&self, flow: &mut Flow<'_, Self>) {
        let sweep = Sweep::of(flow, &self.links, self.arch, Some(flow.y));
        let DissolvingScratch { solid, dig, dissolution: scratch } = &mut *flow.scratch;
        let rows = RegolithRows {
            depth: &flow.constants[1 + self.links.planes()],
            before: &flow.input[REGOLITH_PLANE..],
            base: &flow.constants[0],
            sweep,
        };
        if flow.span.contains(&flow.y) {
            self.planes.take(flow.input, solid, flow.y);
            self.dissolution.dissolve(&rows, flow.y, solid, (scratch, dig));
            self.planes.copy(solid, flow.output, flow.y);
        }
        self.dissolution.creep(&rows, scratch, &mut flow.output[REGOLITH_PLANE..]);
    }
}

/// The step in every variant that has code of its own.
pub(super) fn variants() -> Vec<Box<dyn Step>> {
    let water = LayerName::of("painted");
    vec![Box::new(DissolutionStep { water, iterations: 15, ..DissolutionStep::default() })]
}

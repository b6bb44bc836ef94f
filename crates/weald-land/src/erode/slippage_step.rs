//! The `slippage` step: every material slides off slopes steeper than its talus.

use std::path::PathBuf;
use std::sync::Arc;

use super::edits::{PaintedPlanes, Place};
use super::loose::{self, Loose};
use super::material_planes::Planes;
use super::on_ground::store_ground;
use super::pipeline::Stepped;
use super::scripted::Numbers;
use super::stack::{self, Column, deposit_of};
use super::started::StartedSimulation;
use super::stava::program::{self, StavaNumbers};
use super::stava::slippage::Slippage;
use super::working::WorkingGrid;
use crate::edit::Setting;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{Fault, LayerName, ScriptFile};
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::program::Program;
use weald_engine::step::{Entry, Layered, Outcome, Stage, Step, Work};

parameters! {
    /// Slippage as a step of its own.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::erode::slippage_step::SlippageStep;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// let soil = Field::from_function(landscape.domain.size, |x, _| if x < 4 { 40.0 } else { 0.0 });
    /// let height = Field::from_function(landscape.domain.size, |x, y| 100.0 + soil.at(x, y)); // on level rock
    /// landscape.insert("soil", "m", soil);
    /// landscape.insert("height", "m", height);
    /// SlippageStep::default().run(&mut landscape, &Job::unwatched(0))?;
    /// assert!(landscape.field("soil")?.at(4, 3) > 5.0, "soil has slid over the edge");
    /// assert_eq!(landscape.field("bedrock")?.at(4, 3), 100.0, "rock is under its talus");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct SlippageStep {
        /// Share of the excess that slides in an iteration. Times the number of materials at most 0.25.
        strength: f64 = 0.03, range 0.0..=0.25;
        /// Whether rough ground loses its hold and slides off gentler slopes too.
        softening: bool = false;
        /// Iterations to run.
        iterations: u32 = 100, range 0..=10_000_000;
        /// Layer with the height of the ground.
        layer: LayerName = LayerName::of("height");
        /// Script of edits, in JSON lines (.jsonl) or TOML: strokes of a brush, and keys that change, between iterations.
        /// Its path starts at the folder of the recipe.
        edits: Option<ScriptFile> = None;
    }
}

parameters! {
    /// Slippage within every iteration of `hydraulic`.
    pub struct SlippageWithin {
        /// Share of the excess that slides in an iteration. Times the number of materials at most 0.25.
        strength: f64 = 0.03, range 0.0..=0.25;
        /// Whether rough ground loses its hold and slides off gentler slopes too.
        softening: bool = false;
    }
}

impl SlippageWithin {
    /// The method for these materials, which stand in these planes.
    ///
    /// # Errors
    /// [`Error::Run`] for a strength that is unstable with so many.
    pub(crate) fn slippage(&self, materials: &[Material], planes: Planes) -> Result<Slippage, Error> {
        if let Some(fault) = self.fault_among(materials) {
            return Err(Error::Run(fault.message));
        }
        let tangent =
            |material: &Material| libm::tan(material.talus_deg.clamp(0.0, 90.0).to_radians()).max(0.0) as f32;
        let talus = materials.iter().map(tangent).collect();
        Ok(Slippage::new(planes, talus, self.strength as f32, self.softening))
    }

    /// Materials slide at once, so the share of each is bounded by their number.
    pub(super) fn fault_among(&self, materials: &[Material]) -> Option<Fault> {
        let (strength, count) = (self.strength, materials.len());
        let most = 0.25 / count as f64;
        (strength > most).then(|| {
            let message = format!(
                "`strength` is {strength}, but must be at most 0.25 / {count} = {most:.4}: all {count} materials \
                 slide at once"
            );
            Fault::of("strength", message)
        })
    }
}

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<SlippageStep>(
    "slippage",
    Stage::Erode,
    "lets every material slide off slopes steeper than its talus",
    "Šťava et al. 2008, doi 10.2312/SCA/SCA08/201-210",
);

impl Step for SlippageStep {
    fn reads(&self) -> Vec<String> {
        vec![self.layer.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.layer.0.clone(), "m")]
    }

    fn layered(&self) -> Layered {
        Layered::Changes
    }

    fn faults_among(&self, materials: &[Material]) -> Vec<Fault> {
        self.within().fault_among(materials).into_iter().collect()
    }

    fn bytes_per_cell(&self) -> u64 {
        44
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

impl Loose for SlippageStep {
    type Process = Stepped;

    const FIXED: &'static [&'static str] = &["layer"];

    fn begin(&self, landscape: &Landscape, editable: bool) -> Result<StartedSimulation<Stepped>, Error> {
        let planes = Planes { first_layer: 1, materials: landscape.materials.len() };
        let column = Column { planes, regolith: None };
        let mut working = WorkingGrid::new(landscape, &self.layer.0, false)?;
        let deposit = deposit_of(None, &landscape.materials).map_err(Error::Run)?;
        working.set_stack(landscape, column, deposit)?;
        if editable {
            working.set_changing_mask();
        }
        let (step, materials) = (self.clone(), landscape.materials.clone());
        let grid = (working.size, working.mask.is_some());
        let process = move |settings: &[Setting]| -> Result<Stepped, Error> {
            let slippage = loose::after(&step, settings)?.within().slippage(&materials, planes)?;
            let program = program(&slippage, planes, grid.1);
            Ok(Stepped::with_program(&slippage.pipeline, grid, program))
        };
        let working = Arc::new(working);
        let first = process(&[])?;
        let names = stack::names(&landscape.materials);
        let place = Place::of("slippage", &working, names, PaintedPlanes::of(&first, column, &working));
        let ground = Arc::clone(&working);
        Ok(StartedSimulation {
            plane_names: stack::plane_names(column, &landscape.materials),
            start: Box::new(move || ground.state(planes.count(), &[])),
            numbers: Numbers::new(first, |_| ()),
            remake: Arc::new(move |settings| Ok(Numbers::new(process(settings)?, |_| ()))),
            means: &[],
            place: Some(Arc::new(place)),
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

impl SlippageStep {
    fn within(&self) -> SlippageWithin {
        let Self { strength, softening, .. } = *self;
        SlippageWithin { strength, softening }
    }
}

/// Slippage alone as compute passes.
pub(super) fn program(slippage: &Slippage, planes: Planes, masked: bool) -> Program {
    let numbers = StavaNumbers::of(None, Some(slippage));
    let mut draft = program::draft("slippage", &numbers, (planes, 0), masked);
    slippage.add_to(&mut draft, planes.materials);
    draft.shows("column", None);
    draft.finish(slippage.pipeline.reach())
}

/// The step in every variant that has code of its own.
pub(super) fn variants() -> Vec<Box<dyn Step>> {
    let slipping =
        |softening| SlippageStep { strength: 0.06, softening, iterations: 15, ..SlippageStep::default() };
    [false, true].map(|softening| -> Box<dyn Step> { Box::new(slipping(softening)) }).into()
}

//! The `slippage` step: every material slides off slopes steeper than its talus.

use pulp::Arch;

use super::hydraulic::deposit_of;
use super::links::Links;
use super::simulation::Simulation;
use super::stack::Column;
use super::stava::planes::Planes;
use super::stava::program::{self, StavaNumbers};
use super::stava::slippage::{Slippage, SlippageRows, SlippageScratch};
use super::sweep::Sweep;
use super::working::WorkingGrid;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{Fault, LayerName};
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::program::Program;
use weald_engine::stencil::chain::{Flow, Process};
use weald_engine::step::{Entry, Layered, Outcome, Stage, Step};

parameters! {
    /// Slippage as a step of its own.
    pub struct SlippageStep {
        /// Share of the excess that slides in a step. Times the number of materials at most 0.25.
        strength: f64 = 0.03, range 0.0..=0.25;
        /// Whether rough ground loses its hold and slides off gentler slopes too.
        softening: bool = false;
        /// Steps to run.
        iterations: u32 = 100, range 0..=10_000_000;
        /// Layer with the height of the ground.
        layer: LayerName = LayerName::of("height");
    }
}

parameters! {
    /// Slippage within every step of `hydraulic`.
    pub struct SlippageWithin {
        /// Share of the excess that slides in a step. Times the number of materials at most 0.25.
        strength: f64 = 0.03, range 0.0..=0.25;
        /// Whether rough ground loses its hold and slides off gentler slopes too.
        softening: bool = false;
    }
}

impl SlippageWithin {
    /// The method's constants for these materials.
    ///
    /// # Errors
    /// [`Error::Run`] for a strength that is unstable with so many.
    pub(crate) fn slippage(&self, materials: &[Material]) -> Result<Slippage, Error> {
        if let Some(fault) = self.fault_among(materials) {
            return Err(Error::Run(fault.message));
        }
        let tangent =
            |material: &Material| libm::tan(material.talus_deg.clamp(0.0, 90.0).to_radians()).max(0.0) as f32;
        let talus = materials.iter().map(tangent).collect();
        Ok(Slippage { talus, strength: self.strength as f32, softening: self.softening })
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

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let slippage = self.within().slippage(&landscape.materials)?;
        let mut working = WorkingGrid::new(landscape, &self.layer.0, false)?;
        let planes = Planes { first_layer: 1, materials: landscape.materials.len() };
        let column = Column { planes, regolith: None };
        let deposit = deposit_of(None, &landscape.materials).map_err(Error::Run)?;
        working.set_stack(landscape, column, deposit)?;
        let links = Links::new(working.size, working.mask.is_some());
        let process = Slipping { slippage, planes, links, arch: Arch::new() };
        let plane_names: Vec<_> =
            std::iter::once("change".to_owned()).chain(column.names(&landscape.materials)).collect();
        let simulation = Simulation::alone(&process, &plane_names, self.iterations);
        working.show(job)?;
        let finished = simulation.run(working.state(planes.count(), &[]), job)?;
        Ok(working.store_ground(landscape, &self.layer.0, &finished, u64::from(self.iterations)))
    }
}

impl SlippageStep {
    fn within(&self) -> SlippageWithin {
        let Self { strength, softening, .. } = *self;
        SlippageWithin { strength, softening }
    }
}

/// Slippage alone as a stream of rows.
pub(super) struct Slipping {
    pub(super) slippage: Slippage,
    pub(super) planes: Planes,
    pub(super) links: Links,
    pub(super) arch: Arch,
}

impl Process for Slipping {
    type Weather = ();
    type Scratch = SlippageScratch;

    fn state_planes(&self) -> usize {
        self.planes.count()
    }

    fn constant_planes(&self) -> usize {
        1 + self.links.planes()
    }

    fn lag(&self) -> usize {
        self.slippage.lag()
    }

    fn scratch(&self, columns: usize) -> SlippageScratch {
        SlippageScratch::new(columns, self.planes.materials)
    }

    fn sized(&self, size: Size) -> Self {
        Self { slippage: self.slippage.clone(), links: self.links.sized(size), ..*self }
    }

    fn program(&self) -> Program {
        let numbers = StavaNumbers::of(None, Some(&self.slippage));
        let mut draft = program::draft("slippage", &numbers, (self.planes, 0), &self.links);
        self.slippage.add_to(&mut draft, self.planes.materials);
        draft.shows("column", None);
        draft.finish(self.reach())
    }

    fn advance(&self, flow: &mut Flow<'_, Self>) {
        let sweep = Sweep::of(flow, &self.links, self.arch, Some(flow.y));
        self.slippage.advance(
            &SlippageRows { solid: flow.input, base: &flow.constants[0], sweep },
            flow.scratch,
            (self.planes, flow.output),
        );
    }
}

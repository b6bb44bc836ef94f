//! The `thermal` step: gravity lays steep ground to rest.

mod program;

use pulp::Arch;

use super::links::Links;
use super::simulation::{Finished, Simulation};
use super::sweep::Sweep;
use super::thermal::{Scheme, Slide, SlideConstants, SlideRows, SlideScratch};
use super::working::WorkingGrid;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::program::Program;
use weald_engine::stencil::chain::{Flow, Process};
use weald_engine::step::{Entry, Outcome, Stage, Step};

parameters! {
    /// Thermal weathering as a step of its own.
    pub struct Thermal {
        /// How slopes are compared with the talus.
        scheme: Scheme = Scheme::Isotropic;
        /// Steepest slope that rests, as a tangent; 0.8 is 39°.
        talus: f64 = 0.8, range 0.0..=100.0;
        /// Share of the excess that slides in a step. Unstable above 0.25.
        strength: f64 = 0.05, range 0.0..=0.25;
        /// Steps to run.
        iterations: u32 = 100, range 0..=10_000_000;
        /// Layer to weather.
        layer: LayerName = LayerName::of("height");
    }
}

parameters! {
    /// Thermal weathering within every step of `hydraulic`.
    pub struct ThermalWithin {
        /// How slopes are compared with the talus.
        scheme: Scheme = Scheme::Isotropic;
        /// Steepest slope that rests, as a tangent; 0.8 is 39°.
        talus: f64 = 0.8, range 0.0..=100.0;
        /// Share of the excess that slides in a step. Unstable above 0.25.
        strength: f64 = 0.05, range 0.0..=0.25;
    }
}

impl ThermalWithin {
    /// The method's constants.
    pub(crate) fn slide(&self) -> Slide {
        let constants = SlideConstants { talus: self.talus as f32, strength: self.strength as f32 };
        Slide { scheme: self.scheme, constants }
    }
}

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Thermal>(
    "thermal",
    Stage::Erode,
    "lets ground steeper than its talus slide until it rests",
    "Han 2015, eq. 17–21, doi 10.7583/JKGS.2015.15.6.171",
);

impl Step for Thermal {
    fn reads(&self) -> Vec<String> {
        vec![self.layer.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.layer.0.clone(), "m")]
    }

    fn watched(&self) -> u64 {
        u64::from(self.iterations)
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let working = WorkingGrid::new(landscape, &self.layer.0, false)?;
        let within = ThermalWithin { scheme: self.scheme, talus: self.talus, strength: self.strength };
        let slide = within.slide();
        let links = Links::new(working.size, working.mask.is_some());
        let process = Sliding { slide, links, arch: Arch::new() };
        let plane_names = ["change".to_owned()];
        let seen = |finished: &Finished| {
            let mut seen = landscape.clone();
            working.store_ground(&mut seen, &self.layer.0, finished, self.watched());
            seen
        };
        let simulation =
            Simulation { seen: Some(&seen), ..Simulation::alone(&process, &plane_names, self.iterations) };
        working.show(job)?;
        let finished = simulation.run(working.state(1, &[]), job)?;
        Ok(working.store_ground(landscape, &self.layer.0, &finished, self.watched()))
    }
}

/// Thermal weathering alone as a stream of rows.
pub(crate) struct Sliding {
    pub(crate) slide: Slide,
    pub(crate) links: Links,
    pub(crate) arch: Arch,
}

impl Process for Sliding {
    type Weather = ();
    type Scratch = SlideScratch;

    fn state_planes(&self) -> usize {
        1
    }

    fn constant_planes(&self) -> usize {
        1 + self.links.planes()
    }

    fn lag(&self) -> usize {
        self.slide.lag()
    }

    fn scratch(&self, columns: usize) -> SlideScratch {
        SlideScratch::new(columns)
    }

    fn sized(&self, size: Size) -> Self {
        Self { links: self.links.sized(size), ..*self }
    }

    fn program(&self) -> Program {
        self.passes()
    }

    fn advance(&self, flow: &mut Flow<'_, Self>) {
        let sweep = Sweep::of(flow, &self.links, self.arch, Some(flow.y));
        self.slide.advance(
            &SlideRows { base: &flow.constants[0], change: &flow.input[0], sweep },
            flow.scratch,
            &mut flow.output[0],
        );
    }
}

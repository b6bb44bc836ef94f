//! The `hydraulic` step: rain carves ground. The models `han`, `mei` and `stava` each have keys of their own beside those in common.
//!
//! Its layers `erosion` and `deposition` are what the ground lost and gained in metres between the start of this step
//! and its end, all materials, regolith and sliding together; of each cell one of them is 0. What was laid down and
//! worn away again is in neither.

mod defaults;
mod faults;
mod interactive;
mod keys;
mod models;
mod stava;

pub use interactive::{InteractiveSession, SessionState};
pub use keys::{HanKeys, MeiKeys, StavaKeys};
pub(super) use stava::deposit_of;

use std::path::PathBuf;

use super::advection::Advection;
use super::simulation::Forcing;
use super::stack::REGOLITH;
use super::thermal::Slide;
use super::thermal_step::ThermalWithin;
use defaults::ResolvedKeys;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{Fault, LayerName, Length, ScriptFile};
use weald_core::{choices, parameters, variants};
use weald_engine::Job;
use weald_engine::step::{Entry, Layered, Outcome, Stage, Step};

variants! {
    /// Whose scheme, with the keys that it has beside those of all.
    pub enum Model {
        /// Han 2015: signed fluxes, erosion by velocity.
        Han(HanKeys) = "han",
        /// Mei, Decaudin, Hu 2007: four outflows, erosion towards a capacity.
        Mei(MeiKeys) = "mei",
        /// Šťava et al. 2008: materials in layers, dissolution, slippage, springs.
        Stava(StavaKeys) = "stava",
    }
}

choices! {
    /// What `han` takes up sediment by.
    pub enum UptakeLaw {
        /// In proportion to the speed of the water.
        Velocity = "velocity",
        /// As a share of the free capacity.
        Dissolution = "dissolution",
    }
}

choices! {
    /// How sediment travels.
    pub enum Transport {
        /// With the fluxes of the water; loses nothing.
        Upwind = "upwind",
        /// Back along the velocity; loses sediment, and the report says how much.
        SemiLagrangian = "semi-lagrangian",
        /// Corrected to second order; with `conserve` it loses nothing, without it is the published scheme.
        MacCormack = "maccormack",
    }
}

choices! {
    /// What happens at the edge and at no-data cells.
    pub enum Boundary {
        /// Walls: nothing leaves.
        Closed = "closed",
        /// Water and what it carries leave over the edge, and the budget counts them.
        Open = "open",
    }
}

parameters! {
    /// Rain, rivers, erosion and deposition. Lengths are in metres; where a default is given in cells it is
    /// multiplied by the cell size. One step is the unit of time.
    pub struct Hydraulic {
        /// Whose scheme.
        model: Model = Model::Han(HanKeys::default());
        /// Steps to run.
        iterations: u32 = 1000, range 0..=10_000_000;
        /// Steps of rain before a dry period.
        rain_period: u32 = 60, range 1..=10_000_000, unit "steps";
        /// Depth added where sediment is divided by depth.
        epsilon: Length = Length::Cells(0.001), range 0.000_000_1..=100.0, unit "m",
            unless transport = "semi-lagrangian", unless conserve = false;
        /// What happens at the edge and at no-data cells.
        boundary: Boundary = Boundary::Closed;
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
pub const ENTRY: Entry = Entry::of::<Hydraulic>(
    "hydraulic",
    Stage::Erode,
    "carves ground by rain, rivers and sediment",
    "Han 2015, doi 10.7583/JKGS.2015.15.6.171; Mei, Decaudin, Hu 2007, doi 10.1109/PG.2007.15; \
     Šťava et al. 2008, doi 10.2312/SCA/SCA08/201-210",
);

impl Hydraulic {
    /// How sediment travels.
    pub fn transport(&self) -> Transport {
        self.model.transport().0
    }

    fn advection(&self, filled: &ResolvedKeys) -> Option<Advection> {
        match self.model.transport() {
            (Transport::Upwind, _) => None,
            (Transport::SemiLagrangian, _) => Some(Advection::SemiLagrangian),
            (Transport::MacCormack, true) => Some(Advection::FluxCorrected { epsilon: filled.epsilon }),
            (Transport::MacCormack, false) => Some(Advection::MacCormack),
        }
    }

    /// Whether transport loses no sediment.
    fn conserves(&self) -> bool {
        match self.model.transport() {
            (Transport::Upwind, _) => true,
            (Transport::SemiLagrangian, _) => false,
            (Transport::MacCormack, conserve) => conserve,
        }
    }

    fn slide(&self) -> Option<Slide> {
        self.model.thermal().map(ThermalWithin::slide)
    }

    /// Rain and evaporation of a step: first it rains, then the sun shines; `mei` evaporates always, and `stava`
    /// where there is no dry period.
    fn forcing(&self, filled: &ResolvedKeys, step: u64) -> Forcing {
        let cycle = u64::from(self.rain_period) + u64::from(filled.dry_period);
        let raining = step % cycle < u64::from(self.rain_period);
        let rain = if raining { filled.rain } else { 0.0 };
        let evaporates = match self.model {
            Model::Han(_) => !raining,
            Model::Mei(_) => true,
            Model::Stava(_) => !raining || filled.dry_period == 0,
        };
        Forcing { rain, evaporation: if evaporates { filled.evaporation } else { 0.0 } }
    }

    /// The script of edits.
    fn edits(&self) -> Option<&ScriptFile> {
        self.model.stava()?.edits.as_ref()
    }

    /// The steps of the last whole cycle of rain and sun, or all where none was whole.
    fn last_cycle(&self, filled: &ResolvedKeys) -> std::ops::Range<u64> {
        let cycle = u64::from(self.rain_period) + u64::from(filled.dry_period);
        let iterations = u64::from(self.iterations);
        let end = iterations / cycle * cycle;
        if end == 0 { 0..iterations } else { end - cycle..end }
    }
}

impl Step for Hydraulic {
    fn reads(&self) -> Vec<String> {
        let painted = self.model.stava().into_iter();
        let painted =
            painted.flat_map(|keys| [&keys.rain_layer, &keys.evaporation_layer, &keys.source_layer]);
        let others = [&self.initial_water, &self.region].into_iter().chain(painted);
        std::iter::once(&self.layer).chain(others.flatten()).map(|name| name.0.clone()).collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        let own = [
            ("water", "m"),
            ("sediment", "m"),
            ("flux_x", "m³/step"),
            ("flux_y", "m³/step"),
            ("erosion", "m"),
            ("deposition", "m"),
        ];
        let dissolves = self.model.stava().is_some_and(|keys| keys.dissolution.is_some());
        let regolith = dissolves.then_some((REGOLITH, "m"));
        let own = own.into_iter().chain(regolith);
        let own = own.map(|(name, unit)| (name.to_owned(), unit));
        std::iter::once((self.layer.0.clone(), "m")).chain(own).collect()
    }

    fn watched(&self) -> u64 {
        u64::from(self.iterations)
    }

    fn layered(&self) -> Layered {
        if self.model.stava().is_some() { Layered::Changes } else { Layered::Never }
    }

    fn files(&self) -> Vec<PathBuf> {
        self.edits().map(ScriptFile::path).into_iter().collect()
    }

    fn look_ahead(&self, materials: &[Material]) -> Result<(), Error> {
        self.script(materials).map(drop)
    }

    fn faults(&self) -> Vec<Fault> {
        self.all_faults()
    }

    fn faults_among(&self, materials: &[Material]) -> Vec<Fault> {
        self.all_faults_among(materials)
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let filled = self.filled(landscape.domain.cell);
        let working = self.working(landscape, self.edits().is_some())?;
        self.run_model(landscape, job, &filled, &working)
    }
}

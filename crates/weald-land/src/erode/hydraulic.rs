//! The `hydraulic` step: rain carves ground. Presets `han`, `mei` and `stava` differ only in these keys.
//!
//! Its layers `erosion` and `deposition` are what the ground lost and gained in metres between the start of this step
//! and its end, all materials, regolith and sliding together; of each cell one of them is 0. What was laid down and
//! worn away again is in neither.

mod defaults;
mod faults;
mod models;
mod sitting;
mod stava;

pub use sitting::{Moment, Sitting};
pub(super) use stava::deposit_of;

use std::path::PathBuf;

use super::advection::Advection;
use super::dissolution_step::DissolutionWithin;
use super::simulation::Sky;
use super::slippage_step::SlippageWithin;
use super::springs::Spring;
use super::stack::REGOLITH;
use super::thermal::Slide;
use super::thermal_step::ThermalWithin;
use defaults::Filled;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{LayerName, Nested, ScriptFile};
use weald_core::{choices, parameters};
use weald_engine::Job;
use weald_engine::step::{Entry, Layered, Outcome, Stage, Step};

choices! {
    /// Whose scheme.
    pub enum Model {
        /// Han 2015: signed fluxes, erosion by velocity.
        Han = "han",
        /// Mei, Decaudin, Hu 2007: four outflows, erosion towards a capacity.
        Mei = "mei",
        /// Šťava et al. 2008: materials in layers, dissolution, slippage, springs.
        Stava = "stava",
    }
}

choices! {
    /// How `han` takes up sediment.
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
        /// Scheme, and with it the defaults of the other keys.
        model: Model = Model::Han;
        /// Steps to run.
        iterations: u32 = 1000, range 0..=10_000_000;
        /// Pipe constant k = dt² g A / l: how fast differences in level turn into flow. Unstable above 0.5.
        /// Default 0.4 (han), 0.1 (mei), 0.0981 (stava).
        flow_rate: Option<f64> = None, range 0.0001..=0.5;
        /// Rain a step while it rains. Default 0.01 cells (han), 0.002 cells (mei,
        /// stava).
        rain: Option<f64> = None, range 0.0..=100.0, unit "m/step";
        /// han: evaporation a step in dry periods, default 0.03 cells. mei: share of the depth that
        /// evaporates in every step, default 0.015. stava: evaporation a step, in dry periods or, where
        /// `dry_period` is 0, always; default 0.006 cells.
        evaporation: Option<f64> = None, range 0.0..=100.0, unit "m/step";
        /// Steps of rain before a dry period. Default 60.
        rain_period: u32 = 60, range 1..=10_000_000, unit "steps";
        /// Steps without rain that follow; 0 means that it always rains. Default 60 (han, stava), 0
        /// (mei).
        dry_period: Option<u32> = None, range 0..=10_000_000, unit "steps";
        /// Sediment that a unit of water holds at unit speed and slope (K_c). Default 10 (han), 0.05 (mei),
        /// 0.5 (stava).
        capacity: Option<f64> = None, range 0.0..=10_000.0;
        /// han: uptake a unit of speed (K_v), default 0.005; with law = "dissolution" the share of the free
        /// capacity (K_s), default 0.01. mei: share of the free capacity (K_s), default 0.1.
        /// stava: factor of the erodibility of every material, default 20.
        erosion: Option<f64> = None, range 0.0..=10_000.0;
        /// mei, stava: share of the surplus sediment that settles in a step (K_d). han settles all of it.
        deposition: f64 = 0.1, range 0.0..=1.0;
        /// Share of a deposit that the ground gets back (r); below 1 it keeps lakes from filling with more
        /// than their water, and the rest is counted as out.
        deposit_ratio: f64 = 1.0, range 0.0..=1.0;
        /// How `han` takes up sediment.
        law: UptakeLaw = UptakeLaw::Velocity;
        /// Whether a cell gives no more water than it has. `false` is the scheme as printed: han lets depths
        /// go negative.
        limiter: bool = true;
        /// How sediment travels. Default "upwind" (han, mei), "maccormack" (stava).
        transport: Option<Transport> = None;
        /// Whether transport = "maccormack" takes the form that conserves sediment. Default true.
        conserve: Option<bool> = None;
        /// Depth added where sediment is divided by depth. Default 0.001 cells.
        epsilon: Option<f64> = None, range 0.000_000_1..=100.0, unit "m";
        /// han: depth added where flux is divided by depth, default 0.1 cells. mei, stava: depth below
        /// which water stands still, default 0.0001 cells (mei), 0.02 cells (stava).
        velocity_epsilon: Option<f64> = None, range 0.000_000_1..=100.0, unit "m";
        /// What happens at the edge and at no-data cells.
        boundary: Boundary = Boundary::Closed;
        /// Thermal weathering in every step, with the keys of the `thermal` step. Default: none.
        thermal: Option<Nested<ThermalWithin>> = None;
        /// Layer to erode.
        layer: LayerName = LayerName::of("height");
        /// Layer with the depth of water that stands at the start. Default: none stands.
        initial_water: Option<LayerName> = None;
        /// Layer that says where to simulate: cells where it is below 0.5 stand still, and nothing passes
        /// their edge. Default: everywhere.
        region: Option<LayerName> = None;
        /// stava: layer with a factor of the rain, cell by cell.
        rain_layer: Option<LayerName> = None;
        /// stava: layer with a factor of the evaporation, cell by cell.
        evaporation_layer: Option<LayerName> = None;
        /// stava: layer with the water that springs in a step, in metres; drains where it is negative.
        source_layer: Option<LayerName> = None;
        /// stava: places where water springs.
        sources: Vec<Nested<Spring>> = Vec::new();
        /// stava: places where water drains, as far as there is any.
        drains: Vec<Nested<Spring>> = Vec::new();
        /// stava: viscosity of the water, which evens out its velocity; 0 is none.
        viscosity: f64 = 0.0, range 0.0..=1_000_000.0, unit "m²/step";
        /// stava: material that settles. Default: the last of the landscape.
        deposit: Option<LayerName> = None;
        /// stava: standing water turns ground into regolith that creeps. Default: it does not.
        dissolution: Option<Nested<DissolutionWithin>> = None;
        /// stava: materials slide off slopes steeper than their talus. Default: they do not.
        slippage: Option<Nested<SlippageWithin>> = None;
        /// stava: script of edits, in JSON lines (.jsonl) or TOML: strokes of a brush that happen between the
        /// steps. Its path starts at the folder of the recipe.
        edits: Option<ScriptFile> = None;
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
    /// How sediment travels, where the recipe says nothing as in the model's publication; but Mei et al. lose
    /// sediment, so there upwind stands in.
    pub fn transport(&self) -> Transport {
        let usual = if self.model == Model::Stava { Transport::MacCormack } else { Transport::Upwind };
        self.transport.unwrap_or(usual)
    }

    fn advection(&self, filled: &Filled) -> Option<Advection> {
        match self.transport() {
            Transport::Upwind => None,
            Transport::SemiLagrangian => Some(Advection::SemiLagrangian),
            Transport::MacCormack if self.conserves() => {
                Some(Advection::FluxCorrected { epsilon: filled.epsilon })
            }
            Transport::MacCormack => Some(Advection::MacCormack),
        }
    }

    /// Whether transport loses no sediment.
    fn conserves(&self) -> bool {
        match self.transport() {
            Transport::Upwind => true,
            Transport::SemiLagrangian => false,
            Transport::MacCormack => self.conserve.unwrap_or(true),
        }
    }

    fn slide(&self) -> Option<Slide> {
        self.thermal.as_ref().map(|Nested(thermal)| thermal.slide())
    }

    /// Rain and evaporation of a step: first it rains, then the sun shines; `mei` evaporates always, and `stava`
    /// where there is no dry period.
    fn sky(&self, filled: &Filled, step: u64) -> Sky {
        let cycle = u64::from(self.rain_period) + u64::from(filled.dry_period);
        let raining = step % cycle < u64::from(self.rain_period);
        let rain = if raining { filled.rain } else { 0.0 };
        let evaporates = match self.model {
            Model::Han => !raining,
            Model::Mei => true,
            Model::Stava => !raining || filled.dry_period == 0,
        };
        Sky { rain, evaporation: if evaporates { filled.evaporation } else { 0.0 } }
    }

    /// The steps of the last whole cycle of rain and sun, or all where none was whole.
    fn last_cycle(&self, filled: &Filled) -> std::ops::Range<u64> {
        let cycle = u64::from(self.rain_period) + u64::from(filled.dry_period);
        let iterations = u64::from(self.iterations);
        let end = iterations / cycle * cycle;
        if end == 0 { 0..iterations } else { end - cycle..end }
    }
}

impl Step for Hydraulic {
    fn reads(&self) -> Vec<String> {
        let painted = [&self.rain_layer, &self.evaporation_layer, &self.source_layer];
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
        let regolith = self.dissolution.is_some().then_some((REGOLITH, "m"));
        let own = own.into_iter().chain(regolith);
        let own = own.map(|(name, unit)| (name.to_owned(), unit));
        std::iter::once((self.layer.0.clone(), "m")).chain(own).collect()
    }

    fn watched(&self) -> u64 {
        u64::from(self.iterations)
    }

    fn layered(&self) -> Layered {
        if self.model == Model::Stava { Layered::Changes } else { Layered::Never }
    }

    fn files(&self) -> Vec<PathBuf> {
        self.edits.iter().map(ScriptFile::path).collect()
    }

    fn look_ahead(&self, materials: &[Material]) -> Result<(), Error> {
        self.script(materials).map(drop)
    }

    fn faults(&self) -> Vec<String> {
        self.all_faults()
    }

    fn faults_among(&self, materials: &[Material]) -> Vec<String> {
        self.all_faults_among(materials)
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let filled = self.filled(landscape.domain.cell);
        let working = self.working(landscape, self.edits.is_some())?;
        self.run_model(landscape, job, &filled, &working)
    }
}

//! The `hydraulic` step: rain carves ground. Presets `han` and `mei` differ only in these keys.

mod models;

use super::advection::Advection;
use super::simulation::Sky;
use super::thermal::Slide;
use super::thermal_step::ThermalWithin;
use super::working::Working;
use crate::engine::Job;
use crate::error::Error;
use crate::landscape::Landscape;
use crate::recipe::parameter::{LayerName, Nested};
use crate::step::{Entry, Outcome, Stage, Step};
use crate::{choices, parameters};

choices! {
    /// Whose scheme.
    pub enum Model {
        /// Han 2015: signed fluxes, erosion by velocity.
        Han = "han",
        /// Mei, Decaudin, Hu 2007: four outflows, erosion towards a capacity.
        Mei = "mei",
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
        /// Default 0.4 (han), 0.1 (mei).
        flow_rate: Option<f64> = None, range 0.0001..=0.5;
        /// Rain a step while it rains. Default 0.01 cells (han), 0.002 cells (mei).
        rain: Option<f64> = None, range 0.0..=100.0, unit "m/step";
        /// han: evaporation a step in dry periods, default 0.03 cells. mei: share of the depth that
        /// evaporates in every step, default 0.015.
        evaporation: Option<f64> = None, range 0.0..=100.0, unit "m/step";
        /// Steps of rain before a dry period. Default 60.
        rain_period: u32 = 60, range 1..=10_000_000, unit "steps";
        /// Steps without rain that follow; 0 means that it always rains. Default 60 (han), 0 (mei).
        dry_period: Option<u32> = None, range 0..=10_000_000, unit "steps";
        /// Sediment that a unit of water holds at unit speed and slope (K_c). Default 10 (han), 0.05 (mei).
        capacity: Option<f64> = None, range 0.0..=10_000.0;
        /// han: uptake a unit of speed (K_v), default 0.005; with law = "dissolution" the share of the free
        /// capacity (K_s), default 0.01. mei: share of the free capacity (K_s), default 0.1.
        erosion: Option<f64> = None, range 0.0..=1.0;
        /// mei: share of the surplus sediment that settles in a step (K_d). han settles all of it.
        deposition: f64 = 0.1, range 0.0..=1.0;
        /// Share of a deposit that the ground gets back (r); below 1 it keeps lakes from filling with more
        /// than their water, and the rest is counted as out.
        deposit_ratio: f64 = 1.0, range 0.0..=1.0;
        /// How `han` takes up sediment.
        law: UptakeLaw = UptakeLaw::Velocity;
        /// Whether a cell gives no more water than it has. `false` is the scheme as printed: han lets depths
        /// go negative.
        limiter: bool = true;
        /// How sediment travels.
        transport: Transport = Transport::Upwind;
        /// Whether transport = "maccormack" takes the form that conserves sediment. Default true.
        conserve: Option<bool> = None;
        /// Depth added where sediment is divided by depth. Default 0.001 cells.
        epsilon: Option<f64> = None, range 0.000_000_1..=100.0, unit "m";
        /// han: depth added where flux is divided by depth, default 0.1 cells. mei: depth below which water
        /// stands still, default 0.0001 cells.
        velocity_epsilon: Option<f64> = None, range 0.000_000_1..=100.0, unit "m";
        /// What happens at the edge and at no-data cells.
        boundary: Boundary = Boundary::Closed;
        /// Thermal weathering in every step, with the keys of the `thermal` step. Default: none.
        thermal: Option<Nested<ThermalWithin>> = None;
        /// Layer to erode.
        layer: LayerName = LayerName::of("height");
        /// Layer with the depth of water that stands at the start. Default: none stands.
        initial_water: Option<LayerName> = None;
    }
}

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Hydraulic>(
    "hydraulic",
    Stage::Erode,
    "carves ground by rain, rivers and sediment",
    "Han 2015, doi 10.7583/JKGS.2015.15.6.171; Mei, Decaudin, Hu 2007, doi 10.1109/PG.2007.15",
);

/// Keys with their defaults filled in, in cells and steps.
struct Filled {
    flow_rate: f32,
    rain: f32,
    evaporation: f32,
    dry_period: u32,
    capacity: f32,
    erosion: f32,
    epsilon: f32,
    velocity_epsilon: f32,
}

impl Hydraulic {
    fn filled(&self, cell: f64) -> Filled {
        let length = |given: Option<f64>, cells: f64| given.map_or(cells, |metres| metres / cell) as f32;
        let number = |given: Option<f64>, default: f64| given.unwrap_or(default) as f32;
        match self.model {
            Model::Han => Filled {
                flow_rate: number(self.flow_rate, 0.4),
                rain: length(self.rain, 0.01),
                evaporation: length(self.evaporation, 0.03),
                dry_period: self.dry_period.unwrap_or(60),
                capacity: number(self.capacity, if self.law == UptakeLaw::Velocity { 10.0 } else { 1.0 }),
                erosion: number(self.erosion, if self.law == UptakeLaw::Velocity { 0.005 } else { 0.01 }),
                epsilon: length(self.epsilon, 0.001),
                velocity_epsilon: length(self.velocity_epsilon, 0.1),
            },
            Model::Mei => Filled {
                flow_rate: number(self.flow_rate, 0.1),
                rain: length(self.rain, 0.002),
                evaporation: number(self.evaporation, 0.015),
                dry_period: self.dry_period.unwrap_or(0),
                capacity: number(self.capacity, 0.05),
                erosion: number(self.erosion, 0.1),
                epsilon: length(self.epsilon, 0.001),
                velocity_epsilon: length(self.velocity_epsilon, 0.0001),
            },
        }
    }

    fn advection(&self, filled: &Filled) -> Option<Advection> {
        match self.transport {
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
        match self.transport {
            Transport::Upwind => true,
            Transport::SemiLagrangian => false,
            Transport::MacCormack => self.conserve.unwrap_or(true),
        }
    }

    fn slide(&self) -> Option<Slide> {
        self.thermal.as_ref().map(|Nested(thermal)| thermal.slide())
    }

    /// Rain and evaporation of a step: first it rains, then the sun shines; `mei` evaporates always.
    fn sky(&self, filled: &Filled, step: u64) -> Sky {
        let cycle = u64::from(self.rain_period) + u64::from(filled.dry_period);
        let raining = step % cycle < u64::from(self.rain_period);
        let rain = if raining { filled.rain } else { 0.0 };
        let evaporates = self.model == Model::Mei || !raining;
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
        let water = self.initial_water.iter().map(|name| name.0.clone());
        std::iter::once(self.layer.0.clone()).chain(water).collect()
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
        let own = own.into_iter().map(|(name, unit)| (name.to_owned(), unit));
        std::iter::once((self.layer.0.clone(), "m")).chain(own).collect()
    }

    fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        if self.model == Model::Mei && self.law == UptakeLaw::Dissolution {
            faults.push("`law` belongs to model \"han\"; mei always erodes towards its capacity".to_owned());
        }
        if self.model == Model::Mei && self.evaporation.is_some_and(|share| share > 1.0) {
            faults.push("`evaporation` of model \"mei\" is a share of the depth, 0 to 1".to_owned());
        }
        if self.transport == Transport::Upwind && self.conserve == Some(false) {
            faults
                .push("`conserve` is false, but transport = \"upwind\" always conserves sediment".to_owned());
        }
        if self.transport == Transport::SemiLagrangian && self.conserve == Some(true) {
            faults.push(
                "`conserve` is true, but transport = \"semi-lagrangian\" cannot conserve sediment; \
                 \"maccormack\" and \"upwind\" can"
                    .to_owned(),
            );
        }
        faults
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let filled = self.filled(landscape.domain.cell);
        let open = self.boundary == Boundary::Open;
        let mut working = Working::new(landscape, &self.layer.0, open)?;
        if let Some(water) = &self.initial_water {
            working.set_water(landscape, &water.0)?;
        }
        self.run_model(landscape, job, &filled, &working)
    }
}

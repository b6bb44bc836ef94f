//! The keys of each model.

use crate::erode::dissolution_step::DissolutionWithin;
use crate::erode::mei::Slope;
use crate::erode::slippage_step::SlippageWithin;
use crate::erode::springs::Spring;
use crate::erode::thermal_step::ThermalWithin;
use weald_core::parameter::{LayerName, Length, Nested, ScriptFile};
use weald_core::parameters;
use weald_core::{choices, variants};

variants! {
    /// Whose scheme, with the keys that it has beside those of all.
    pub enum Model {
        /// Han 2015: signed fluxes, erosion by velocity.
        Han(HanKeys) = "han",
        /// Mei, Decaudin, Hu 2007: four outflows, erosion towards the transport capacity.
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
        /// As a share of the unused transport capacity. Nothing chemical is meant: the source calls it so.
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
    /// Rain, rivers, erosion and deposition. Lengths are in metres; a default of "0.01 × cell size" is in
    /// proportion to the cells. An iteration is the unit of time.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::erode::hydraulic::Hydraulic;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(32, 32)?, 10.0)); // columns, rows, metres
    /// let valley = |x, y| 3.0 * (x as f32 - 16.0).abs() - y as f32;
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, valley));
    /// let outcome = Hydraulic { iterations: 120, ..Hydraulic::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let deepest = landscape.field("erosion")?.range(None).expect("there are cells").1;
    /// assert!(deepest > 0.1, "rain has carved up to {deepest} m");
    /// assert!(outcome.budget.expect("is kept").solid.error().abs() < 1.0e-4, "nothing is lost");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Hydraulic {
        /// Whose scheme.
        model: Model = Model::Han(HanKeys::default());
        /// Iterations to run. An iteration has no fixed physical duration.
        iterations: u32 = 1000, range 0..=10_000_000;
        /// Iterations of rain before a dry period.
        rain_period: u32 = 60, range 1..=10_000_000, unit "iterations";
        /// Depth added to the divisor where sediment is divided by depth.
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
        /// Iterations at the end over which `flux_x` and `flux_y` are averaged. Default: the last whole cycle of rain and
        /// sun.
        mean_over: Option<u32> = None, range 1..=10_000_000, unit "iterations";
        /// Script of edits, in JSON lines (.jsonl) or TOML: strokes of a brush, and keys that change, between iterations.
        /// Its path starts at the folder of the recipe.
        edits: Option<ScriptFile> = None;
    }
}

parameters! {
    /// The keys of model "han".
    pub struct HanKeys {
        /// Pipe constant k, which is no discharge: how fast differences in level turn into flow. It stands for
        /// dt² g A / l with lengths in cells and has no unit. Unstable above 0.5.
        // `dt² g A / L`: stable up to 1/2, and the larger, the better the streams.
        flow_rate: f64 = 0.4, range 0.0001..=0.5;
        /// Rain in an iteration of a rain period. It is no rainfall intensity, for an iteration has no duration.
        rain: Length = Length::Cells(0.01), range 0.0..=100.0, unit "m/iteration";
        /// Evaporation in an iteration of a dry period.
        // Two to three times the rain, over as long a time: from five times on all water goes and with it the rivers,
        // and at one and a half times half of the land stays under lakes.
        evaporation: Length = Length::Cells(0.03), range 0.0..=100.0, unit "m/iteration";
        /// Iterations without rain that follow; 0 means that it always rains.
        dry_period: u32 = 60, range 0..=10_000_000, unit "iterations";
        /// What sediment is taken up by.
        law: UptakeLaw = UptakeLaw::Velocity;
        /// Transport capacity (K_c): depth of sediment by depth of water at a speed of 1 cell/iteration on a slope with
        /// the sine 1. Default 10, with law = "dissolution" 1.
        // Networks form between 1 and 100 where uptake follows the speed, and hardly change with it; at 0.1 they do
        // not.
        capacity: Option<f64> = None, range 0.0..=10_000.0;
        /// With law = "velocity" the depth in cells that an iteration takes up at a speed of 1 cell/iteration (K_v),
        /// default 0.005; with law = "dissolution" the share of the unused transport capacity that an iteration
        /// takes up (K_s), default 0.01.
        // Uptake by speed: 0.003 to 0.01 make networks, less takes too long, 0.1 breaks them into gullies. By unused
        // capacity: rivers form at 0.01; from 0.1 on they do not.
        erosion: Option<f64> = None, range 0.0..=1.0;
        /// Share of the deposited sediment that is added to the ground (r). The rest leaves the model and counts as
        /// solid out, so that below 1 lakes do not silt up.
        deposit_ratio: f64 = 1.0, range 0.0..=1.0;
        /// Whether a cell gives no more water than it has. `false` is the scheme as printed, which lets depths go
        /// negative.
        limiter: bool = true;
        /// How sediment travels.
        transport: Transport = Transport::Upwind;
        /// Whether it takes the form that conserves sediment.
        conserve: bool = true, when transport = "maccormack";
        /// Depth added to the depth of the water where velocity = flux / depth.
        // At least half of the evaporation, which bounds the speed by two cells per step.
        velocity_epsilon: Length = Length::Cells(0.1), range 0.000_000_1..=100.0, unit "m";
        /// Thermal weathering (dry sliding to the talus) in every iteration, with the keys of the `thermal` step.
        /// Default: none.
        thermal: Option<Nested<ThermalWithin>> = None;
    }
}

parameters! {
    /// The keys of model "mei".
    pub struct MeiKeys {
        /// Pipe constant k, which is no discharge: how fast differences in level turn into flow. It stands for
        /// dt² g A / l with lengths in cells and has no unit. Unstable above 0.5.
        // As published programs have it, 0.098. It rains in every step, and a fifth of what falls on `han`.
        flow_rate: f64 = 0.1, range 0.0001..=0.5;
        /// Rain in an iteration of a rain period. It is no rainfall intensity, for an iteration has no duration.
        rain: Length = Length::Cells(0.002), range 0.0..=100.0, unit "m/iteration";
        /// Share of the depth of the water that evaporates in every iteration.
        // A share of the depth, not a length, as in the source; 0.015 is what published programs use.
        evaporation: f64 = 0.015, range 0.0..=1.0;
        /// Iterations without rain that follow; 0 means that it always rains.
        dry_period: u32 = 0, range 0..=10_000_000, unit "iterations";
        /// Transport capacity (K_c): depth of sediment by depth of water at a speed of 1 cell/iteration on a slope with
        /// the sine 1.
        // Chosen for cells and steps of 1; published programs have 1 on cells of 1/256.
        capacity: f64 = 0.05, range 0.0..=10_000.0;
        /// Share of the unused transport capacity that an iteration takes up (K_s).
        erosion: f64 = 0.1, range 0.0..=1.0;
        /// Share of the sediment above the transport capacity that settles in an iteration (K_d).
        deposition: f64 = 0.1, range 0.0..=1.0;
        /// Share of the deposited sediment that is added to the ground (r). The rest leaves the model and counts as
        /// solid out, so that below 1 lakes do not silt up.
        deposit_ratio: f64 = 1.0, range 0.0..=1.0;
        /// The slope that counts for the transport capacity. The publication has the tilt of the ground and does not say
        /// how it is found.
        slope: Slope = Slope::MeanSine;
        /// Whether a cell gives no more water than it has. `false` is the scheme as printed.
        limiter: bool = true;
        /// How sediment travels. The publication has "semi-lagrangian", which loses sediment.
        transport: Transport = Transport::Upwind;
        /// Whether it takes the form that conserves sediment.
        conserve: bool = true, when transport = "maccormack";
        /// Depth below which water has no velocity.
        // Here a bound: water that is thinner has no velocity.
        velocity_epsilon: Length = Length::Cells(0.0001), range 0.000_000_1..=100.0, unit "m";
        /// Thermal weathering (dry sliding to the talus) in every iteration, with the keys of the `thermal` step.
        /// Default: none.
        thermal: Option<Nested<ThermalWithin>> = None;
    }
}

parameters! {
    /// The keys of model "stava".
    pub struct StavaKeys {
        /// Pipe constant k, which is no discharge: how fast differences in level turn into flow. It stands for
        /// dt² g A / l with lengths in cells and has no unit. Unstable above 0.5.
        // `dt² g A / l` for a step of 0.1 s on cells of 1 m, as the authors have it.
        flow_rate: f64 = 0.0981, range 0.0001..=0.5;
        /// Rain in an iteration of a rain period. It is no rainfall intensity, for an iteration has no duration.
        rain: Length = Length::Cells(0.002), range 0.0..=100.0, unit "m/iteration";
        /// Evaporation in an iteration of a dry period or, where `dry_period` is 0, of any.
        evaporation: Length = Length::Cells(0.006), range 0.0..=100.0, unit "m/iteration";
        /// Iterations without rain that follow; 0 means that it always rains.
        dry_period: u32 = 60, range 0..=10_000_000, unit "iterations";
        /// Transport capacity (K_c): depth of sediment by depth of water at a speed of 1 cell/iteration on a slope with
        /// the sine 1.
        capacity: f64 = 0.5, range 0.0..=10_000.0;
        /// Factor of the `erodibility` of every material.
        // On erodibilities from 0.0005 (rock) to 0.05 (sand): in a step sand gives all that is asked for, rock 1 %.
        erosion: f64 = 20.0, range 0.0..=10_000.0;
        /// Share of the sediment above the transport capacity that settles in an iteration (K_d).
        deposition: f64 = 0.1, range 0.0..=1.0;
        /// How sediment travels.
        transport: Transport = Transport::MacCormack;
        /// Whether it takes the form that conserves sediment.
        conserve: bool = true, when transport = "maccormack";
        /// Depth below which water has no velocity. Thin water on slopes would wear all ground alike: only water that
        /// has gathered carves.
        velocity_epsilon: Length = Length::Cells(0.02), range 0.000_000_1..=100.0, unit "m";
        /// Layer with a factor of the rain, cell by cell.
        rain_layer: Option<LayerName> = None;
        /// Layer with a factor of the evaporation, cell by cell.
        evaporation_layer: Option<LayerName> = None;
        /// Layer with the depth of water that springs in an iteration, in metres; drains where it is negative, with the
        /// sediment that the water carries.
        source_layer: Option<LayerName> = None;
        /// Places where water springs.
        sources: Vec<Nested<Spring>> = Vec::new();
        /// Places where water drains, as far as there is any, with the sediment that it carries.
        drains: Vec<Nested<Spring>> = Vec::new();
        /// Viscosity of the water, which evens out its velocity; 0 is none.
        viscosity: f64 = 0.0, range 0.0..=1_000_000.0, unit "m²/iteration";
        /// Material that settles. Default: the last of the landscape.
        deposit: Option<LayerName> = None;
        /// Dissolution: ground under standing water loses its strength (nothing chemical is meant) and creeps as
        /// regolith. Default: it does not.
        dissolution: Option<Nested<DissolutionWithin>> = None;
        /// Slippage: materials slide off slopes steeper than their talus. Default: they do not.
        slippage: Option<Nested<SlippageWithin>> = None;
    }
}

impl Model {
    /// The keys of `stava`, which alone knows layers.
    pub(super) fn stava(&self) -> Option<&StavaKeys> {
        match self {
            Self::Stava(keys) => Some(keys),
            Self::Han(_) | Self::Mei(_) => None,
        }
    }

    /// How sediment travels, and whether "maccormack" conserves it.
    pub(super) fn transport(&self) -> (Transport, bool) {
        match self {
            Self::Han(keys) => (keys.transport, keys.conserve),
            Self::Mei(keys) => (keys.transport, keys.conserve),
            Self::Stava(keys) => (keys.transport, keys.conserve),
        }
    }

    /// Thermal weathering in every step; `stava` has slippage instead.
    pub(super) fn thermal(&self) -> Option<&ThermalWithin> {
        let thermal = match self {
            Self::Han(keys) => &keys.thermal,
            Self::Mei(keys) => &keys.thermal,
            Self::Stava(_) => &None,
        };
        thermal.as_ref().map(|Nested(within)| within)
    }
}

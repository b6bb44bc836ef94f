//! The keys of any model in metres and steps, those that it has not at rest.

use weald_core::parameter::{Length, Nested};
use weald_land::erode::hydraulic::{
    HanKeys, Hydraulic, MeiKeys, Model, Slope, StavaKeys, Transport, UptakeLaw,
};
use weald_land::erode::thermal_step::ThermalWithin;

/// Numbers of a simulation.
pub struct Numbers {
    pub rain_period: u32,
    pub dry_period: u32,
    pub flow_rate: f64,
    pub rain: f64,
    pub evaporation: f64,
    pub capacity: f64,
    pub erosion: f64,
    pub deposition: f64,
    pub deposit_ratio: f64,
    pub epsilon: f64,
    pub velocity_epsilon: f64,
    pub limiter: bool,
    pub slope: Slope,
    pub law: UptakeLaw,
    pub transport: Transport,
    pub conserve: bool,
    pub thermal: Option<Nested<ThermalWithin>>,
}

impl Numbers {
    pub fn of(step: &Hydraulic) -> Self {
        let numbers = match &step.model {
            Model::Han(keys) => Self::of_han(keys),
            Model::Mei(keys) => Self::of_mei(keys),
            Model::Stava(keys) => Self::of_stava(keys),
        };
        Self { rain_period: step.rain_period, epsilon: metres(step.epsilon), ..numbers }
    }

    fn of_han(keys: &HanKeys) -> Self {
        Self {
            flow_rate: keys.flow_rate,
            rain: metres(keys.rain),
            evaporation: metres(keys.evaporation),
            capacity: keys.capacity.expect("given"),
            erosion: keys.erosion.expect("given"),
            deposition: 1.0,
            deposit_ratio: keys.deposit_ratio,
            velocity_epsilon: metres(keys.velocity_epsilon),
            limiter: keys.limiter,
            law: keys.law,
            thermal: keys.thermal.clone(),
            ..Self::moving(keys.dry_period, keys.transport, keys.conserve)
        }
    }

    fn of_mei(keys: &MeiKeys) -> Self {
        Self {
            flow_rate: keys.flow_rate,
            rain: metres(keys.rain),
            evaporation: keys.evaporation,
            capacity: keys.capacity,
            erosion: keys.erosion,
            deposition: keys.deposition,
            deposit_ratio: keys.deposit_ratio,
            velocity_epsilon: metres(keys.velocity_epsilon),
            limiter: keys.limiter,
            slope: keys.slope,
            thermal: keys.thermal.clone(),
            ..Self::moving(keys.dry_period, keys.transport, keys.conserve)
        }
    }

    fn of_stava(keys: &StavaKeys) -> Self {
        Self {
            flow_rate: keys.flow_rate,
            rain: metres(keys.rain),
            evaporation: metres(keys.evaporation),
            capacity: keys.capacity,
            erosion: keys.erosion,
            deposition: keys.deposition,
            velocity_epsilon: metres(keys.velocity_epsilon),
            ..Self::moving(keys.dry_period, keys.transport, keys.conserve)
        }
    }

    fn moving(dry_period: u32, transport: Transport, conserve: bool) -> Self {
        Self {
            rain_period: 0,
            dry_period,
            flow_rate: 0.0,
            rain: 0.0,
            evaporation: 0.0,
            capacity: 0.0,
            erosion: 0.0,
            deposition: 0.0,
            deposit_ratio: 1.0,
            epsilon: 0.0,
            velocity_epsilon: 0.0,
            limiter: true,
            slope: Slope::MeanSine,
            law: UptakeLaw::Velocity,
            transport,
            conserve,
            thermal: None,
        }
    }
}

/// The cells of the reference are a metre wide.
fn metres(length: Length) -> f64 {
    length.in_cells(1.0)
}

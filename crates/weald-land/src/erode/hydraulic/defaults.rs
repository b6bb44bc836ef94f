//! The numbers of each model where a recipe gives none.

use super::{Hydraulic, Model, UptakeLaw};

/// Keys with their defaults filled in, in cells and steps.
pub(super) struct Filled {
    pub(super) flow_rate: f32,
    pub(super) rain: f32,
    pub(super) evaporation: f32,
    pub(super) dry_period: u32,
    pub(super) capacity: f32,
    pub(super) erosion: f32,
    pub(super) epsilon: f32,
    pub(super) velocity_epsilon: f32,
}

impl Hydraulic {
    pub(super) fn filled(&self, cell: f64) -> Filled {
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
            Model::Stava => Filled {
                flow_rate: number(self.flow_rate, 0.0981),
                rain: length(self.rain, 0.002),
                evaporation: length(self.evaporation, 0.006),
                dry_period: self.dry_period.unwrap_or(60),
                capacity: number(self.capacity, 0.5),
                erosion: number(self.erosion, 20.0),
                epsilon: length(self.epsilon, 0.001),
                // Films on slopes would wear all ground alike: only water that has gathered carves.
                velocity_epsilon: length(self.velocity_epsilon, 0.02),
            },
        }
    }
}

//! The numbers of a model on a landscape.

use super::keys::{Hydraulic, Model, UptakeLaw};

/// What all models have, in cells and steps.
pub(crate) struct ResolvedKeys {
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
    pub(super) fn filled(&self, cell: f64) -> ResolvedKeys {
        let epsilon = self.epsilon.in_cells(cell) as f32;
        match &self.model {
            Model::Han(keys) => {
                let [capacity, erosion] = match keys.law {
                    UptakeLaw::Velocity => [10.0, 0.005],
                    UptakeLaw::Dissolution => [1.0, 0.01],
                };
                ResolvedKeys {
                    flow_rate: keys.flow_rate as f32,
                    rain: keys.rain.in_cells(cell) as f32,
                    evaporation: keys.evaporation.in_cells(cell) as f32,
                    dry_period: keys.dry_period,
                    capacity: keys.capacity.unwrap_or(capacity) as f32,
                    erosion: keys.erosion.unwrap_or(erosion) as f32,
                    epsilon,
                    velocity_epsilon: keys.velocity_epsilon.in_cells(cell) as f32,
                }
            }
            Model::Mei(keys) => ResolvedKeys {
                flow_rate: keys.flow_rate as f32,
                rain: keys.rain.in_cells(cell) as f32,
                evaporation: keys.evaporation as f32,
                dry_period: keys.dry_period,
                capacity: keys.capacity as f32,
                erosion: keys.erosion as f32,
                epsilon,
                velocity_epsilon: keys.velocity_epsilon.in_cells(cell) as f32,
            },
            Model::Stava(keys) => ResolvedKeys {
                flow_rate: keys.flow_rate as f32,
                rain: keys.rain.in_cells(cell) as f32,
                evaporation: keys.evaporation.in_cells(cell) as f32,
                dry_period: keys.dry_period,
                capacity: keys.capacity as f32,
                erosion: keys.erosion as f32,
                epsilon,
                velocity_epsilon: keys.velocity_epsilon.in_cells(cell) as f32,
            },
        }
    }
}

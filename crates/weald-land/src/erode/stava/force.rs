//! Force-based erosion: running water takes from the materials what it has the force to carry, and drops what it
//! has not (Šťava et al. 2008).
//!
//! The capacity is `K_c sin a |v|`, with the mean sine of the slopes around a cell, floored at 0.1. The unused
//! transport capacity is dug out of the column from the top down ([`super::digging`]).

use super::{Stava, StavaScratch};
use crate::erode::before;
use crate::erode::water_planes as plane;
use weald_engine::kernel;
use weald_engine::stencil::chain::Flow;

/// Least sine that counts as a slope, so that water on flat ground still carries something.
const MIN_SLOPE: f32 = 0.1;

kernel! {
    /// Unused transport capacity; negative where the water carries too much.
    pub(crate) struct UnusedCapacity {
        reads {
            found, eastward, southward, sine_east, sine_west, sine_south, sine_north, neighbour_share, erodible,
        }
        updates {}
        writes { room }
        constants { capacity: f32 }
    }
    fn cell() {
        let speed = (eastward * eastward + southward * southward).sqrt();
        let mean_sine = ((sine_west + sine_east) + (sine_north + sine_south)) * neighbour_share;
        room = (capacity * mean_sine.max(MIN_SLOPE) * speed - found) * erodible;
    }
}

impl Stava {
    pub(super) fn erode(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let StavaScratch { solid, dig, settled, sine_east, sine_south, still, found, .. } =
            &mut *flow.scratch;
        self.planes.take(flow.input, solid, y);
        let links = self.setting.links.row(flow.constants, y);
        let found = if self.painted { &*found } else { &flow.input[plane::SEDIMENT] }.here(y);
        UnusedCapacity {
            found,
            eastward: settled.eastward.here(y),
            southward: settled.southward.here(y),
            sine_east: sine_east.here(y),
            sine_west: sine_east.west(y),
            sine_south: sine_south.here(y),
            sine_north: before(sine_south, still, y, flow.span.start),
            neighbour_share: links.neighbour_share,
            erodible: links.erodible,
            room: dig.room.here_mut(0),
            capacity: self.constants.capacity,
        }
        .run(self.setting.arch);
        let carried = settled.sediment.here_mut(y);
        self.erosion.exchange((solid, y), (found, carried), dig, self.setting.arch);
    }
}

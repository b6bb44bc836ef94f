//! What one cell becomes in a step of Mei et al. 2007; [`super`] has the source and the order.

use crate::erode::pipes::without_negligible;
use weald_engine::kernel;

/// Least sine that counts as a slope, so that water on flat ground still carries something (Mei 2007,
/// section 3.3).
const MIN_SINE: f32 = 0.05;

kernel! {
    /// Depth after rain, ground, water surface.
    pub(crate) struct Rained {
        reads { base, change, before, valid }
        updates {}
        writes { ground, surface, depth, fallen }
        constants { rain: f32 }
    }
    fn cell() {
        ground = base + change;
        depth = before + rain * valid;
        surface = ground + depth;
        fallen = depth - before;
    }
}

kernel! {
    /// Depth after the fluxes and evaporation, the velocity of the water that flowed, and what it takes from
    /// or gives to the ground: towards the capacity `C = K_c |v| sin a` by the share `K_s`, from a surplus
    /// by the share `K_d`.
    pub(crate) struct Exchange {
        reads {
            rained, east, west, south, north, from_west, from_east, from_north, from_south,
            found, change_before, sine_east, sine_west, sine_south, sine_north, neighbour_share, erodible,
            valid,
        }
        updates {}
        writes { depth, evaporated, eastward, southward, change, sediment, lost }
        constants {
            evaporation: f32, velocity_epsilon: f32, capacity: f32, erosion: f32, deposition: f32,
            deposit_ratio: f32,
        }
    }
    fn cell() {
        let inflow = (from_west + from_east) + (from_north + from_south);
        let flowed = rained + (inflow - ((east + west) + (south + north)));
        let mean_depth = (rained + flowed) * 0.5;
        let per_depth = if mean_depth > velocity_epsilon { 0.5 / mean_depth } else { 0.0 };
        eastward = ((from_west - west) + (east - from_east)) * per_depth;
        southward = ((from_north - north) + (south - from_south)) * per_depth;
        depth = without_negligible(flowed * (1.0 - evaporation * valid));
        evaporated = depth - flowed;
        let speed = (eastward * eastward + southward * southward).sqrt();
        let mean_sine = ((sine_west + sine_east) + (sine_north + sine_south)) * neighbour_share;
        let room = (capacity * mean_sine.max(MIN_SINE) * speed - found) * erodible;
        let eroded = change_before - erosion * room.max(0.0);
        let deposit = deposition * (-room).max(0.0);
        change = if room > 0.0 { eroded } else { change_before + deposit_ratio * deposit };
        sediment = if room > 0.0 { found + (change_before - eroded) } else { found - deposit };
        lost = (1.0 - deposit_ratio) * deposit;
    }
}

kernel! {
    /// The same where outflows are not limited: capped so that a cell never gives more than it has.
    pub(crate) struct LoadUnlimited {
        reads { sediment, depth, east, west, south, north }
        updates {}
        writes { concentration }
        constants { epsilon: f32 }
    }
    fn cell() {
        let outflow = (east + west) + (south + north);
        concentration = sediment / (depth.max(0.0) + epsilon).max(outflow);
    }
}

#[cfg(test)]
mod tests {
    use super::MIN_SINE;
    use weald_engine::program::twin::number;

    #[test]
    fn the_shader_has_the_same_constants() {
        assert_eq!(number(include_str!("kernels.wgsl"), "MIN_SINE") as f32, MIN_SINE);
    }
}

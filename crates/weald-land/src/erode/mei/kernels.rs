//! What one cell becomes in a step of Mei et al. 2007; [`super`] has the source and the order.

use crate::erode::pipes::{RETAINED_SHARE, sine, without_negligible};
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
    /// Sines of the slopes to the eastern and southern neighbours.
    pub(crate) struct Sines {
        reads { ground, ground_east, ground_south, link_east, link_south }
        updates {}
        writes { sine_east, sine_south }
        constants {}
    }
    fn cell() {
        sine_east = sine(ground_east - ground, link_east);
        sine_south = sine(ground_south - ground, link_south);
    }
}

/// The four outflows scaled to the water that the cell has, or to `most` where the scheme runs as it is.
#[inline(always)]
pub(crate) fn scaled(wanted: [f32; 4], depth: f32, most: f32) -> [f32; 4] {
    let sum = (wanted[0] + wanted[1]) + (wanted[2] + wanted[3]);
    let available = (depth * (1.0 - RETAINED_SHARE)).max(most);
    let share = if sum > available { available / sum } else { 1.0 };
    wanted.map(|outflow| outflow * share)
}

kernel! {
    /// Outflows to the four neighbours, scaled.
    pub(crate) struct Outflow {
        reads {
            old_east, old_west, old_south, old_north, surface, surface_east, surface_west, surface_south,
            surface_north, depth, link_east, link_west, link_south, link_north,
        }
        updates {}
        writes { east, west, south, north }
        constants { flow_rate: f32, most: f32 }
    }
    fn cell() {
        let outflow = |old: f32, next: f32, link: f32| (old + flow_rate * (surface - next)).max(0.0) * link;
        let wanted = [
            outflow(old_east, surface_east, link_east),
            outflow(old_west, surface_west, link_west),
            outflow(old_south, surface_south, link_south),
            outflow(old_north, surface_north, link_north),
        ];
        [east, west, south, north] = scaled(wanted, depth, most);
    }
}

kernel! {
    /// The same where water falls freely into cells without data, driven by how high it stands over the
    /// ground of the start.
    pub(crate) struct OpenOutflow {
        reads {
            old_east, old_west, old_south, old_north, surface, surface_east, surface_west, surface_south,
            surface_north, depth, link_east, link_west, link_south, link_north, valid, base,
        }
        updates {}
        writes { east, west, south, north }
        constants { flow_rate: f32, most: f32 }
    }
    fn cell() {
        let outflow = |old: f32, next: f32, link: f32| {
            let drop = if link > 0.0 { surface - next } else { surface - base };
            (old + flow_rate * drop).max(0.0) * valid
        };
        let wanted = [
            outflow(old_east, surface_east, link_east),
            outflow(old_west, surface_west, link_west),
            outflow(old_south, surface_south, link_south),
            outflow(old_north, surface_north, link_north),
        ];
        [east, west, south, north] = scaled(wanted, depth, most);
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
        depth = without_negligible(flowed * (1.0 - evaporation));
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
    /// Sediment in a unit of water.
    pub(crate) struct Load {
        reads { sediment, depth }
        updates {}
        writes { concentration }
        constants { epsilon: f32 }
    }
    fn cell() {
        concentration = sediment / (depth.max(0.0) + epsilon);
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

kernel! {
    /// Sediment after the outflows, each with the concentration of the cell that it leaves.
    pub(crate) struct Carry {
        reads {
            before, east, west, south, north, from_west, from_east, from_north, from_south,
            concentration, concentration_west, concentration_east, concentration_north, concentration_south,
        }
        updates {}
        writes { sediment }
        constants {}
    }
    fn cell() {
        let went = ((east + west) + (south + north)) * concentration;
        let inflow = (from_west * concentration_west + from_east * concentration_east)
            + (from_north * concentration_north + from_south * concentration_south);
        sediment = without_negligible(before + (inflow - went));
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

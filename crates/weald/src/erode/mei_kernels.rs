//! What one cell becomes in a step of Mei et al. 2007; [`super::mei`] has the source and the order.

use super::pipes::{KEPT, worth_counting};
use crate::stencil::kernel::kernel;

/// Least sine that counts as a slope, so that water on level ground still carries something (Mei 2007,
/// section 3.3).
const LEAST_SINE: f32 = 0.05;

kernel! {
    /// Depth after rain, ground, water surface.
    pub(crate) struct Rained {
        reads { base, change, before, land }
        updates {}
        writes { ground, surface, depth, fallen }
        constants { rain: f32 }
    }
    fn cell() {
        ground = base + change;
        depth = before + rain * land;
        surface = ground + depth;
        fallen = depth - before;
    }
}

kernel! {
    /// Sine of the slope along an edge.
    pub(crate) struct Sine {
        reads { ground, ground_next, link }
        updates {}
        writes { sine }
        constants {}
    }
    fn cell() {
        let rise = ground_next - ground;
        sine = rise.abs() * link / (1.0 + rise * rise).sqrt();
    }
}

kernel! {
    /// Outflow to one neighbour before scaling. `spill` is 1 where water falls freely into cells without
    /// data, driven by its own depth.
    pub(crate) struct Outflow {
        reads { old, surface, surface_next, depth, link, land }
        updates {}
        writes { outflow }
        constants { flow_rate: f32, spill: f32 }
    }
    fn cell() {
        let fall = land * (1.0 - link) * spill;
        let drop = (surface - surface_next) * link + depth * fall;
        outflow = (old + flow_rate * drop).max(0.0) * (link + fall);
    }
}

kernel! {
    /// Scales the four outflows to the water that the cell has, or to `most` where the scheme runs as it is.
    pub(crate) struct ScaleOutflow {
        reads { depth, wanted_east, wanted_west, wanted_south, wanted_north }
        updates {}
        writes { east, west, south, north }
        constants { most: f32 }
    }
    fn cell() {
        let wanted = (wanted_east + wanted_west) + (wanted_south + wanted_north);
        let afford = (depth * (1.0 - KEPT)).max(most);
        let share = if wanted > afford { afford / wanted } else { 1.0 };
        east = wanted_east * share;
        west = wanted_west * share;
        south = wanted_south * share;
        north = wanted_north * share;
    }
}

kernel! {
    /// Depth after the fluxes and evaporation, and the velocity of the water that flowed.
    pub(crate) struct WaterAndVelocity {
        reads { rained, east, west, south, north, from_west, from_east, from_north, from_south }
        updates {}
        writes { depth, eastward, southward, evaporated }
        constants { evaporation: f32, velocity_epsilon: f32 }
    }
    fn cell() {
        let came = (from_west + from_east) + (from_north + from_south);
        let went = (east + west) + (south + north);
        let flowed = rained + (came - went);
        let mean_depth = (rained + flowed) * 0.5;
        let wet = mean_depth > velocity_epsilon;
        let per_depth = if wet { 0.5 / mean_depth } else { 0.0 };
        eastward = ((from_west - west) + (east - from_east)) * per_depth;
        southward = ((from_north - north) + (south - from_south)) * per_depth;
        depth = worth_counting(flowed * (1.0 - evaporation));
        evaporated = depth - flowed;
    }
}

kernel! {
    /// Erosion towards the capacity `C = K_c |v| sin a` by the share `K_s`, deposition by the share `K_d`.
    pub(crate) struct Exchange {
        reads {
            found, change_before, eastward, southward,
            sine_east, sine_west, sine_south, sine_north, neighbour_share, land,
        }
        updates {}
        writes { change, sediment, lost }
        constants { capacity: f32, erosion: f32, deposition: f32, deposit_ratio: f32 }
    }
    fn cell() {
        let speed = (eastward * eastward + southward * southward).sqrt();
        let sine = ((sine_west + sine_east) + (sine_north + sine_south)) * neighbour_share;
        let room = (capacity * sine.max(LEAST_SINE) * speed - found) * land;
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
        let came = (from_west * concentration_west + from_east * concentration_east)
            + (from_north * concentration_north + from_south * concentration_south);
        sediment = worth_counting(before + (came - went));
    }
}

//! What one cell becomes in models with four outflows a cell (Mei et al. 2007, Šťava et al. 2008).

use crate::erode::pipes::{RETAINED_SHARE, sine, without_negligible};
use weald_engine::kernel;

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

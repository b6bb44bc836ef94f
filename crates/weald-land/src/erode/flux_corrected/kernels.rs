//! What one cell becomes in the transport in flux form; [`super`] has the equations and their sources.

use crate::erode::pipes::{RETAINED_SHARE, without_negligible};
use weald_engine::kernel;

kernel! {
    /// Sediment in a unit of water, and the water that it is mixed in: never less than what flows out.
    pub(crate) struct Mixed {
        reads { sediment, depth, east, west, south, north }
        updates {}
        writes { concentration, volume }
        constants { epsilon: f32 }
    }
    fn cell() {
        let outflow = (east.max(0.0) + (-west).max(0.0)) + (south.max(0.0) + (-north).max(0.0));
        // Never less than what flows out, so that no cell gives more sediment than it has.
        volume = (depth.max(0.0) + epsilon).max(outflow * (1.0 + RETAINED_SHARE));
        concentration = sediment / volume;
    }
}

/// Antidiffusive flux through a face, positive to the east or south.
#[inline(always)]
fn antidiffusion(flux: f32, volumes: [f32; 2], concentrations: [f32; 2]) -> f32 {
    let volume = if flux > 0.0 { volumes[0] } else { volumes[1] };
    let still = 1.0 - flux.abs() / volume;
    0.5 * flux.abs() * still * (concentrations[1] - concentrations[0])
}

kernel! {
    /// The upwind step, the water after it, the range of concentrations of this cell, and what antidiffusion
    /// would carry east and south.
    pub(crate) struct LowOrder {
        reads {
            sediment, volume, volume_east, volume_south, east, west, south, north,
            concentration, concentration_east, concentration_west, concentration_south, concentration_north,
            link_east, link_south,
        }
        updates {}
        writes { low, after, least, most, to_east, to_south }
        constants {}
    }
    fn cell() {
        let carried_east = east * if east >= 0.0 { concentration } else { concentration_east };
        let carried_west = west * if west >= 0.0 { concentration_west } else { concentration };
        let carried_south = south * if south >= 0.0 { concentration } else { concentration_south };
        let carried_north = north * if north >= 0.0 { concentration_north } else { concentration };
        low = sediment + ((carried_west - carried_east) + (carried_north - carried_south));
        after = volume + ((west - east) + (north - south));
        let mixed = if after > 0.0 { low / after } else { concentration };
        least = mixed.min(concentration);
        most = mixed.max(concentration);
        let linked = if link_east > 0.0 { volume_east } else { volume };
        to_east = link_east * antidiffusion(east, [volume, linked], [concentration, concentration_east]);
        let linked = if link_south > 0.0 { volume_south } else { volume };
        to_south = link_south * antidiffusion(south, [volume, linked], [concentration, concentration_south]);
    }
}

/// The share of `wanted` that fits.
#[inline(always)]
fn fitting(room: f32, wanted: f32) -> f32 {
    // Not to the last digit, or rounding would leave the range.
    let room = room.max(0.0) * (1.0 - RETAINED_SHARE);
    if wanted > room { room / wanted } else { 1.0 }
}

kernel! {
    /// Shares of its antidiffusive gains and losses that a cell can take without leaving the range of
    /// concentrations around it.
    pub(crate) struct Range {
        reads {
            low, after, least, least_east, least_west, least_south, least_north,
            most, most_east, most_west, most_south, most_north,
            link_east, link_west, link_south, link_north,
            to_east, from_west, to_south, from_north,
        }
        updates {}
        writes { gain, loss }
        constants {}
    }
    fn cell() {
        let among = |link: f32, there: f32, here: f32| if link > 0.0 { there } else { here };
        let top = most
            .max(among(link_east, most_east, most).max(among(link_west, most_west, most)))
            .max(among(link_south, most_south, most).max(among(link_north, most_north, most)));
        let bottom = least
            .min(among(link_east, least_east, least).min(among(link_west, least_west, least)))
            .min(among(link_south, least_south, least).min(among(link_north, least_north, least)));
        let gained = (from_west.max(0.0) + (-to_east).max(0.0)) + (from_north.max(0.0) + (-to_south).max(0.0));
        let lost = (to_east.max(0.0) + (-from_west).max(0.0)) + (to_south.max(0.0) + (-from_north).max(0.0));
        gain = fitting(top * after - low, gained);
        loss = fitting(low - bottom * after, lost);
    }
}

/// An antidiffusive flux as far as the giving and the taking cell allow; `from` is the western or northern one.
#[inline(always)]
fn limited(flux: f32, from: [f32; 2], to: [f32; 2]) -> f32 {
    let [gain_from, loss_from] = from;
    let [gain_to, loss_to] = to;
    flux * if flux > 0.0 { loss_from.min(gain_to) } else { gain_from.min(loss_to) }
}

kernel! {
    /// The upwind step corrected by the limited antidiffusive fluxes.
    pub(crate) struct Corrected {
        reads {
            low, to_east, from_west, to_south, from_north,
            gain, gain_east, gain_west, gain_south, gain_north,
            loss, loss_east, loss_west, loss_south, loss_north,
        }
        updates {}
        writes { sediment }
        constants {}
    }
    fn cell() {
        let here = [gain, loss];
        let east = limited(to_east, here, [gain_east, loss_east]);
        let west = limited(from_west, [gain_west, loss_west], here);
        let south = limited(to_south, here, [gain_south, loss_south]);
        let north = limited(from_north, [gain_north, loss_north], here);
        sediment = without_negligible(low + ((west - east) + (north - south)));
    }
}

kernel! {
    /// Water through the eastern and southern faces of models that keep an outflow for each side.
    pub(crate) struct NetFlux {
        reads { east, from_east, south, from_south }
        updates {}
        writes { eastward, southward }
        constants {}
    }
    fn cell() {
        eastward = east - from_east;
        southward = south - from_south;
    }
}

//! MacCormack transport that loses nothing: flux form, corrected and limited.
//!
//! For transport at constant speed MacCormack's predictor and corrector are the scheme of Lax and Wendroff,
//! whose flux through a face is the upwind flux and an antidiffusive one:
//!
//! ```text
//! F c_face = F c_up + A,     A = |F| (1 - ν) (c_next - c_here) / 2,     ν = |F| / volume_up
//! ```
//!
//! `F` is the water through the face, `c` sediment in a unit of water. In flux form what leaves a cell enters
//! its neighbour. Antidiffusion alone would make new peaks and pits; each `A` is scaled to what its two cells
//! can take without leaving the range of concentrations around them, before and after the upwind step:
//!
//! ```text
//! low = s + Σ upwind fluxes          R⁺ = min(1, (c_max V - low) / Σ A in)     R⁻ = min(1, (low - c_min V) / Σ A out)
//! s'  = low + Σ min(R⁻ of the giving cell, R⁺ of the taking cell) A
//! ```
//!
//! MacCormack 1969, doi 10.2514/6.1969-354; Lax, Wendroff 1960, doi 10.1002/cpa.3160130205; Zalesak 1979,
//! doi 10.1016/0021-9991(79)90051-2. What differs from the MacCormack scheme of Šťava et al. 2008 (in
//! [`super::advection`]): sediment goes with the fluxes of the water, not back along a velocity, so its
//! concentration obeys the minimum and maximum principle and its sum is conserved.

mod program;

pub(crate) use program::add_to;

use super::advection::AdvectionRows;
use super::before;
use super::pipes::{KEPT, worth_counting};
use crate::stencil::kernel::kernel;
use crate::stencil::ring::Ring;

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
        volume = (depth.max(0.0) + epsilon).max(outflow * (1.0 + KEPT));
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
    let room = room.max(0.0) * (1.0 - KEPT);
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
        sediment = worth_counting(low + ((west - east) + (north - south)));
    }
}

/// Rows in flight.
pub(crate) struct FluxCorrectedScratch {
    concentration: Ring,
    volume: Ring,
    low: Ring,
    after: Ring,
    least: Ring,
    most: Ring,
    to_east: Ring,
    to_south: Ring,
    gain: Ring,
    loss: Ring,
    still: Ring,
}

impl FluxCorrectedScratch {
    pub(crate) fn new(columns: usize) -> Self {
        let ring = |depth| Ring::new(columns, depth);
        Self {
            concentration: ring(3),
            volume: ring(2),
            low: ring(3),
            after: ring(2),
            least: ring(3),
            most: ring(3),
            to_east: ring(3),
            to_south: ring(4),
            gain: ring(3),
            loss: ring(3),
            still: Ring::new(columns, 1),
        }
    }
}

/// Rows by which the output lies behind the newest input.
pub(crate) const LAG: usize = 3;

/// Carries the sediment of the next row that is ready. `rows` gives the water through the eastern and southern
/// faces in place of velocities; `depth` is the row of the water before it flowed.
pub(crate) fn advance(
    rows: &AdvectionRows<'_>,
    epsilon: f32,
    scratch: &mut FluxCorrectedScratch,
    output: &mut Ring,
) {
    if let Some(y) = rows.behind(0) {
        mix(rows, epsilon, scratch, y);
    }
    if let Some(y) = rows.behind(1) {
        low_order(rows, scratch, y);
    }
    if let Some(y) = rows.behind(2) {
        range(rows, scratch, y);
    }
    if let Some(y) = rows.behind(LAG) {
        correct(rows, scratch, y, output.here_mut(y));
    }
}

fn mix(rows: &AdvectionRows<'_>, epsilon: f32, scratch: &mut FluxCorrectedScratch, y: usize) {
    Mixed {
        sediment: rows.sediment.here(y),
        depth: rows.depth.here(y),
        east: rows.eastward.here(y),
        west: rows.eastward.west(y),
        south: rows.southward.here(y),
        north: before(rows.southward, &scratch.still, y, rows.span.start),
        concentration: scratch.concentration.here_mut(y),
        volume: scratch.volume.here_mut(y),
        epsilon,
    }
    .run(rows.arch);
}

fn low_order(rows: &AdvectionRows<'_>, scratch: &mut FluxCorrectedScratch, y: usize) {
    let (next, links) = (rows.next(y), rows.links.row(rows.constants, y));
    let (concentration, volume) = (&scratch.concentration, &scratch.volume);
    LowOrder {
        sediment: rows.sediment.here(y),
        volume: volume.here(y),
        volume_east: volume.east(y),
        volume_south: volume.here(next),
        east: rows.eastward.here(y),
        west: rows.eastward.west(y),
        south: rows.southward.here(y),
        north: before(rows.southward, &scratch.still, y, rows.span.start),
        concentration: concentration.here(y),
        concentration_east: concentration.east(y),
        concentration_west: concentration.west(y),
        concentration_south: concentration.here(next),
        concentration_north: before(concentration, &scratch.still, y, rows.span.start),
        link_east: links.east,
        link_south: links.south,
        low: scratch.low.here_mut(y),
        after: scratch.after.here_mut(y),
        least: scratch.least.here_mut(y),
        most: scratch.most.here_mut(y),
        to_east: scratch.to_east.here_mut(y),
        to_south: scratch.to_south.here_mut(y),
    }
    .run(rows.arch);
}

fn range(rows: &AdvectionRows<'_>, scratch: &mut FluxCorrectedScratch, y: usize) {
    let FluxCorrectedScratch { low, after, least, most, to_east, to_south, gain, loss, still, .. } = scratch;
    let (next, start, links) = (rows.next(y), rows.span.start, rows.links.row(rows.constants, y));
    Range {
        low: low.here(y),
        after: after.here(y),
        least: least.here(y),
        least_east: least.east(y),
        least_west: least.west(y),
        least_south: least.here(next),
        least_north: before(least, still, y, start),
        most: most.here(y),
        most_east: most.east(y),
        most_west: most.west(y),
        most_south: most.here(next),
        most_north: before(most, still, y, start),
        link_east: links.east,
        link_west: links.west,
        link_south: links.south,
        link_north: links.north,
        to_east: to_east.here(y),
        from_west: to_east.west(y),
        to_south: to_south.here(y),
        from_north: before(to_south, still, y, start),
        gain: gain.here_mut(y),
        loss: loss.here_mut(y),
    }
    .run(rows.arch);
}

fn correct(rows: &AdvectionRows<'_>, scratch: &FluxCorrectedScratch, y: usize, sediment: &mut [f32]) {
    let FluxCorrectedScratch { low, to_east, to_south, gain, loss, still, .. } = scratch;
    let (next, start) = (rows.next(y), rows.span.start);
    Corrected {
        low: low.here(y),
        to_east: to_east.here(y),
        from_west: to_east.west(y),
        to_south: to_south.here(y),
        from_north: before(to_south, still, y, start),
        gain: gain.here(y),
        gain_east: gain.east(y),
        gain_west: gain.west(y),
        gain_south: gain.here(next),
        gain_north: before(gain, still, y, start),
        loss: loss.here(y),
        loss_east: loss.east(y),
        loss_west: loss.west(y),
        loss_south: loss.here(next),
        loss_north: before(loss, still, y, start),
        sediment,
    }
    .run(rows.arch);
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

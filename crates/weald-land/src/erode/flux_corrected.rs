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

mod kernels;
mod program;

pub(crate) use kernels::NetFlux;
pub(crate) use program::add_to;

use super::advection_rows::AdvectionRows;
use super::before;
use kernels::{Corrected, LowOrder, Mixed, Range};
use weald_engine::stencil::ring::Ring;

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
            still: Ring::still(columns),
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
    if let Some(y) = rows.sweep.behind(0) {
        mix(rows, epsilon, scratch, y);
    }
    if let Some(y) = rows.sweep.behind(1) {
        low_order(rows, scratch, y);
    }
    if let Some(y) = rows.sweep.behind(2) {
        range(rows, scratch, y);
    }
    if let Some(y) = rows.sweep.behind(LAG) {
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
        north: before(rows.southward, &scratch.still, y, rows.sweep.span.start),
        concentration: scratch.concentration.here_mut(y),
        volume: scratch.volume.here_mut(y),
        epsilon,
    }
    .run(rows.sweep.arch);
}

fn low_order(rows: &AdvectionRows<'_>, scratch: &mut FluxCorrectedScratch, y: usize) {
    let (next, links) = (rows.sweep.next(y), rows.sweep.links(y));
    let (concentration, volume) = (&scratch.concentration, &scratch.volume);
    LowOrder {
        sediment: rows.sediment.here(y),
        volume: volume.here(y),
        volume_east: volume.east(y),
        volume_south: volume.here(next),
        east: rows.eastward.here(y),
        west: rows.eastward.west(y),
        south: rows.southward.here(y),
        north: before(rows.southward, &scratch.still, y, rows.sweep.span.start),
        concentration: concentration.here(y),
        concentration_east: concentration.east(y),
        concentration_west: concentration.west(y),
        concentration_south: concentration.here(next),
        concentration_north: before(concentration, &scratch.still, y, rows.sweep.span.start),
        link_east: links.east,
        link_south: links.south,
        low: scratch.low.here_mut(y),
        after: scratch.after.here_mut(y),
        least: scratch.least.here_mut(y),
        most: scratch.most.here_mut(y),
        to_east: scratch.to_east.here_mut(y),
        to_south: scratch.to_south.here_mut(y),
    }
    .run(rows.sweep.arch);
}

fn range(rows: &AdvectionRows<'_>, scratch: &mut FluxCorrectedScratch, y: usize) {
    let FluxCorrectedScratch { low, after, least, most, to_east, to_south, gain, loss, still, .. } = scratch;
    let (next, start, links) = (rows.sweep.next(y), rows.sweep.span.start, rows.sweep.links(y));
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
    .run(rows.sweep.arch);
}

fn correct(rows: &AdvectionRows<'_>, scratch: &FluxCorrectedScratch, y: usize, sediment: &mut [f32]) {
    let FluxCorrectedScratch { low, to_east, to_south, gain, loss, still, .. } = scratch;
    let (next, start) = (rows.sweep.next(y), rows.sweep.span.start);
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
    .run(rows.sweep.arch);
}

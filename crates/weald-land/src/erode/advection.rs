//! Transport of sediment by the velocity of its cell: semi-Lagrangian and MacCormack.
//!
//! Semi-Lagrangian (Mei, Decaudin, Hu 2007, doi 10.1109/PG.2007.15): `s'(x) = s(x - v)`, bilinear. Velocities
//! are limited to one cell a step, the stability limit of the scheme's water, so that the departure point
//! lies within the nine cells around and needs no gathering. MacCormack (Selle et al. 2008, doi
//! 10.1007/s10915-007-9166-4; used by Šťava et al. 2008): with `A = SL(s, v)` and `B = SL(A, -v)`,
//! `s' = A + (s - B) / 2`, clamped to the four cells around the departure point.
//!
//! Neither conserves sediment; the budget of the run shows what they lose, and [`super::flux_corrected`] is
//! the form that loses nothing. What differs from the sources:
//! at walls and no-data cells the departure point stops at the last cell with data.

mod program;

use super::advection_rows::AdvectionRows;

use std::ops::Range;

use super::flux_corrected::{self, FluxCorrectedScratch};
use weald_engine::kernel;
use weald_engine::stencil::ring::Ring;

/// Which of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Advection {
    SemiLagrangian,
    MacCormack,
    /// MacCormack in flux form, which conserves: [`super::flux_corrected`].
    FluxCorrected {
        /// Depth added where sediment is divided by depth.
        epsilon: f32,
    },
}

/// Value at the departure point of a cell, from the nine cells around it (north to south, west to east).
#[inline(always)]
fn departure(nine: [[f32; 3]; 3], velocity: [f32; 2], links: [f32; 4]) -> f32 {
    let [west, east, north, south] = weights(velocity, links);
    let across = |row: [f32; 3]| (west * row[0] + east * row[2]) + (1.0 - (west + east)) * row[1];
    (north * across(nine[0]) + south * across(nine[2])) + (1.0 - (north + south)) * across(nine[1])
}

/// Weights of the western, eastern, northern and southern neighbours.
#[inline(always)]
fn weights(velocity: [f32; 2], links: [f32; 4]) -> [f32; 4] {
    // One cell a step: further away the departure point would lie beyond the nine cells.
    let [u, v] = velocity.map(|speed| speed.clamp(-1.0, 1.0));
    [u.max(0.0) * links[0], (-u).max(0.0) * links[1], v.max(0.0) * links[2], (-v).max(0.0) * links[3]]
}

kernel! {
    /// One semi-Lagrangian step along `direction` times the velocity.
    pub(crate) struct Depart {
        reads {
            north_west, north, north_east, west, here, east, south_west, south, south_east,
            eastward, southward, link_west, link_east, link_north, link_south,
        }
        updates {}
        writes { arrived }
        constants { direction: f32 }
    }
    fn cell() {
        arrived = departure(
            [[north_west, north, north_east], [west, here, east], [south_west, south, south_east]],
            [direction * eastward, direction * southward],
            [link_west, link_east, link_north, link_south],
        );
    }
}

kernel! {
    /// MacCormack's correction of the forward step by the error that the way back shows.
    pub(crate) struct Correct {
        reads {
            forward, back, eastward, southward, link_west, link_east, link_north, link_south,
            north_west, north, north_east, west, here, east, south_west, south, south_east,
        }
        updates {}
        writes { arrived }
        constants {}
    }
    fn cell() {
        let left = eastward * link_west > 0.0;
        let right = eastward * link_east < 0.0;
        let up = southward * link_north > 0.0;
        let down = southward * link_south < 0.0;
        let aside = |row: [f32; 3]| if left { row[0] } else if right { row[2] } else { row[1] };
        let (level, above, below) = (
            aside([west, here, east]),
            [north, aside([north_west, north, north_east])],
            [south, aside([south_west, south, south_east])],
        );
        let beyond = if up { above } else if down { below } else { [here, level] };
        let least = here.min(level).min(beyond[0].min(beyond[1]));
        let most = here.max(level).max(beyond[0].max(beyond[1]));
        // Going forth and back errs twice as much as going once.
        arrived = (forward + (here - back) * 0.5).max(least).min(most);
    }
}

/// Rows in flight within the transport.
pub(crate) struct AdvectionScratch {
    forward: Ring,
    back: Ring,
    still: Ring,
    flux_corrected: FluxCorrectedScratch,
}

impl AdvectionScratch {
    pub(crate) fn new(columns: usize) -> Self {
        Self {
            // The way back looks at a row and both its neighbours.
            forward: Ring::new(columns, 3),
            back: Ring::new(columns, 1),
            still: Ring::still(columns),
            flux_corrected: FluxCorrectedScratch::new(columns),
        }
    }
}

/// The rows around a row: western, own and eastern cells each.
struct Stencil9<'a> {
    north: [&'a [f32]; 3],
    level: [&'a [f32]; 3],
    south: [&'a [f32]; 3],
}

impl<'a> Stencil9<'a> {
    fn of(ring: &'a Ring, still: &'a Ring, y: usize, span: &Range<usize>) -> Self {
        let three = |ring: &'a Ring, y| [ring.west(y), ring.here(y), ring.east(y)];
        Self {
            north: if y > span.start { three(ring, y - 1) } else { three(still, 0) },
            level: three(ring, y),
            south: if y + 1 < span.end { three(ring, y + 1) } else { three(still, 0) },
        }
    }
}

impl Advection {
    /// Rows by which the output lies behind the newest input.
    pub(crate) fn lag(self) -> usize {
        match self {
            Self::SemiLagrangian => 1,
            Self::MacCormack => 2,
            Self::FluxCorrected { .. } => flux_corrected::LAG,
        }
    }

    /// Moves the sediment of the next row that is ready.
    pub(crate) fn advance(self, rows: &AdvectionRows<'_>, scratch: &mut AdvectionScratch, output: &mut Ring) {
        match self {
            Self::SemiLagrangian => {
                if let Some(y) = rows.sweep.behind(1) {
                    rows.depart(y, rows.sediment, &scratch.still, output.here_mut(y), 1.0);
                }
            }
            Self::MacCormack => maccormack(rows, scratch, output),
            Self::FluxCorrected { epsilon } => {
                flux_corrected::advance(rows, epsilon, &mut scratch.flux_corrected, output);
            }
        }
    }
}

fn maccormack(rows: &AdvectionRows<'_>, scratch: &mut AdvectionScratch, output: &mut Ring) {
    let AdvectionScratch { forward, back, still, .. } = scratch;
    if let Some(y) = rows.sweep.behind(1) {
        rows.depart(y, rows.sediment, still, forward.here_mut(y), 1.0);
    }
    if let Some(y) = rows.sweep.behind(2) {
        rows.depart(y, forward, still, back.here_mut(0), -1.0);
        correct(rows, y, forward.here(y), back.here(0), (still, output));
    }
}

fn correct(rows: &AdvectionRows<'_>, y: usize, forward: &[f32], back: &[f32], rings: (&Ring, &mut Ring)) {
    let (still, output) = rings;
    let nine = Stencil9::of(rows.sediment, still, y, &rows.sweep.span);
    let link = rows.sweep.links(y);
    Correct {
        forward,
        back,
        eastward: rows.eastward.here(y),
        southward: rows.southward.here(y),
        link_west: link.west,
        link_east: link.east,
        link_north: link.north,
        link_south: link.south,
        north_west: nine.north[0],
        north: nine.north[1],
        north_east: nine.north[2],
        west: nine.level[0],
        here: nine.level[1],
        east: nine.level[2],
        south_west: nine.south[0],
        south: nine.south[1],
        south_east: nine.south[2],
        arrived: output.here_mut(y),
    }
    .run(rows.sweep.arch);
}

impl AdvectionRows<'_> {
    fn depart(&self, y: usize, from: &Ring, still: &Ring, arrived: &mut [f32], direction: f32) {
        let nine = Stencil9::of(from, still, y, &self.sweep.span);
        let link = self.sweep.links(y);
        Depart {
            north_west: nine.north[0],
            north: nine.north[1],
            north_east: nine.north[2],
            west: nine.level[0],
            here: nine.level[1],
            east: nine.level[2],
            south_west: nine.south[0],
            south: nine.south[1],
            south_east: nine.south[2],
            eastward: self.eastward.here(y),
            southward: self.southward.here(y),
            link_west: link.west,
            link_east: link.east,
            link_north: link.north,
            link_south: link.south,
            arrived,
            direction,
        }
        .run(self.sweep.arch);
    }
}

//! Diffusion of the velocity: two Jacobi sweeps of `v' = (Σ v_n + c v) / (4 + c)` with `c = l² / (ν dt)`, as in
//! the implicit step of Stam 1999, doi 10.1145/311535.311548, which Šťava et al. 2008 take over.
//!
//! Walls are free-slip: beyond them stands the cell's own velocity, which leaves the mean as it is.

use crate::erode::sweep::Sweep;
use weald_engine::kernel;
use weald_engine::stencil::ring::Ring;

/// The sweeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Viscosity {
    /// `1 / (4 + c)`: what each neighbour counts.
    pub(crate) share: f32,
}

kernel! {
    /// One sweep of one component.
    pub(crate) struct Diffuse {
        reads { here, east, west, south, north, link_east, link_west, link_south, link_north }
        updates {}
        writes { diffused }
        constants { share: f32 }
    }
    fn cell() {
        let across = link_west * (west - here) + link_east * (east - here);
        let along = link_north * (north - here) + link_south * (south - here);
        diffused = here + share * (across + along);
    }
}

/// Rows between the two sweeps.
pub(crate) struct ViscosityScratch {
    once: [Ring; 2],
}

impl ViscosityScratch {
    pub(crate) fn new(columns: usize) -> Self {
        Self { once: [Ring::new(columns, 3), Ring::new(columns, 3)] }
    }
}

/// What the diffusion reads.
pub(crate) struct ViscosityRows<'a> {
    /// Eastward and southward velocity.
    pub(crate) velocity: [&'a Ring; 2],
    pub(crate) sweep: Sweep<'a>,
}

impl ViscosityRows<'_> {
    fn sweep(&self, from: &Ring, to: &mut Ring, y: usize, share: f32) {
        let links = self.sweep.links(y);
        // Behind a wall no link leads on, so that the row that stands for it does not matter.
        let next = self.sweep.next(y);
        let previous = self.sweep.previous(y);
        Diffuse {
            here: from.here(y),
            east: from.east(y),
            west: from.west(y),
            south: from.here(next),
            north: from.here(previous),
            link_east: links.east,
            link_west: links.west,
            link_south: links.south,
            link_north: links.north,
            diffused: to.here_mut(y),
            share,
        }
        .run(self.sweep.arch);
    }
}

impl Viscosity {
    /// Sweeps for a viscosity in cells² a step, above 0.
    pub(crate) fn new(viscosity: f32) -> Self {
        Self { share: viscosity / (4.0 * viscosity + 1.0) }
    }

    /// Rows by which the output lies behind the newest input.
    pub(crate) const LAG: usize = 2;

    /// Diffuses the next rows that are ready.
    pub(crate) fn advance(
        self,
        rows: &ViscosityRows<'_>,
        scratch: &mut ViscosityScratch,
        diffused: [&mut Ring; 2],
    ) {
        for ((from, once), to) in rows.velocity.into_iter().zip(&mut scratch.once).zip(diffused) {
            if let Some(y) = rows.sweep.behind(1) {
                rows.sweep(from, once, y, self.share);
            }
            if let Some(y) = rows.sweep.behind(2) {
                rows.sweep(once, to, y, self.share);
            }
        }
    }
}

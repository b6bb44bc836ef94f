//! Dissolution: ground under standing water turns into regolith, which creeps downhill as a viscous fluid
//! (Šťava et al. 2008, after Beneš 2007).
//!
//! Regolith `r` strives for `min(r_max, w)`. What is missing is dug out of the column by the solubility of each
//! material ([`super::digging`]); what is too much settles at once. It then flows like the water, by pipes over
//! the surface of all that is solid, `f' = max(0, (1 - damping) f + k ΔH)`, and no cell gives more than it has.
//! Regolith does not leave over open edges. Between its flow and the next exchange there may be more than
//! `r_max` in a cell.

use super::digging::{DigScratch, Digging};
use crate::erode::before;
use crate::erode::material_planes::{Pile, pile};
use crate::erode::outflow_kernels::scaled;
use crate::erode::pipes::without_negligible;
use crate::erode::sweep::Sweep;
use weald_engine::kernel;
use weald_engine::stencil::ring::Ring;

/// Constants of the method, in cells and steps.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Dissolution {
    /// First of the planes of the regolith.
    pub(crate) plane: usize,
    /// Depth to which standing water soaks the ground.
    pub(crate) most: f32,
    /// Share of its flow that regolith keeps from step to step: 1 less the damping.
    pub(crate) kept: f32,
    pub(crate) flow_rate: f32,
    /// Shares are solubilities; all of a surplus settles.
    pub(crate) digging: Digging,
}

kernel! {
    /// Regolith that is missing; negative where there is too much.
    pub(crate) struct Missing {
        reads { depth, regolith, erodible }
        updates {}
        writes { room }
        constants { most: f32 }
    }
    fn cell() {
        room = (depth.min(most) - regolith) * erodible;
    }
}

kernel! {
    /// Outflows of regolith to the four neighbours, scaled to what there is.
    pub(crate) struct Creep {
        reads {
            old_east, old_west, old_south, old_north, surface, surface_east, surface_west, surface_south,
            surface_north, regolith, link_east, link_west, link_south, link_north,
        }
        updates {}
        writes { east, west, south, north }
        constants { flow_rate: f32, kept: f32 }
    }
    fn cell() {
        let outflow =
            |old: f32, next: f32, link: f32| (kept * old + flow_rate * (surface - next)).max(0.0) * link;
        let wanted = [
            outflow(old_east, surface_east, link_east),
            outflow(old_west, surface_west, link_west),
            outflow(old_south, surface_south, link_south),
            outflow(old_north, surface_north, link_north),
        ];
        [east, west, south, north] = scaled(wanted, regolith, 0.0);
    }
}

kernel! {
    /// Regolith after the outflows.
    pub(crate) struct Crept {
        reads { before, east, west, south, north, from_west, from_east, from_north, from_south }
        updates {}
        writes { regolith }
        constants {}
    }
    fn cell() {
        let inflow = (from_west + from_east) + (from_north + from_south);
        regolith = without_negligible(before + (inflow - ((east + west) + (south + north))));
    }
}

/// Rows in flight between the exchange and the flow.
pub(crate) struct DissolutionScratch {
    regolith: Ring,
    surface: Ring,
    still: Ring,
}

impl DissolutionScratch {
    pub(crate) fn new(columns: usize) -> Self {
        Self { regolith: Ring::new(columns, 3), surface: Ring::new(columns, 3), still: Ring::still(columns) }
    }
}

/// What dissolution reads.
pub(crate) struct RegolithRows<'a> {
    /// Depth of the water.
    pub(crate) depth: &'a Ring,
    /// The regolith planes as the step finds them.
    pub(crate) before: &'a [Ring],
    pub(crate) base: &'a Ring,
    pub(crate) sweep: Sweep<'a>,
}

impl Dissolution {
    /// Rows by which the output lies behind the exchange.
    pub(crate) const LAG: usize = 2;

    /// Exchanges row `y` of the materials with the regolith.
    pub(crate) fn dissolve(
        &self,
        rows: &RegolithRows<'_>,
        y: usize,
        solid: &mut [Ring],
        (scratch, dig): (&mut DissolutionScratch, &mut DigScratch),
    ) {
        let found = rows.before[0].here(y);
        Missing {
            depth: rows.depth.here(y),
            regolith: found,
            erodible: rows.sweep.links(y).erodible,
            room: dig.room.here_mut(0),
            most: self.most,
        }
        .run(rows.sweep.arch);
        self.digging.exchange((solid, y), (found, scratch.regolith.here_mut(y)), dig, rows.sweep.arch);
        let surface = scratch.surface.here_mut(y);
        let layers = solid[1..].iter().map(|layer| layer.here(y));
        pile(rows.sweep.arch, [rows.base.here(y), solid[0].here(y)], layers, surface);
        Pile { thickness: scratch.regolith.here(y), ground: surface }.run(rows.sweep.arch);
    }

    /// Moves the regolith of the next rows that are ready; `output` begins with its planes.
    pub(crate) fn creep(&self, rows: &RegolithRows<'_>, scratch: &DissolutionScratch, output: &mut [Ring]) {
        if let Some(y) = rows.sweep.behind(1) {
            self.outflow(rows, scratch, output, y);
        }
        if let Some(y) = rows.sweep.behind(2) {
            crept(rows, scratch, output, y);
        }
    }

    fn outflow(&self, rows: &RegolithRows<'_>, scratch: &DissolutionScratch, output: &mut [Ring], y: usize) {
        let [_, old_east, old_west, old_south, old_north, ..] = rows.before else {
            unreachable!("five planes of regolith")
        };
        let [_, east, west, south, north, ..] = output else { unreachable!("five planes of regolith") };
        let links = rows.sweep.links(y);
        let surface = &scratch.surface;
        // Behind a wall no link leads on, so that the row that stands for it does not matter.
        let next = rows.sweep.next(y);
        let previous = rows.sweep.previous(y);
        Creep {
            old_east: old_east.here(y),
            old_west: old_west.here(y),
            old_south: old_south.here(y),
            old_north: old_north.here(y),
            surface: surface.here(y),
            surface_east: surface.east(y),
            surface_west: surface.west(y),
            surface_south: surface.here(next),
            surface_north: surface.here(previous),
            regolith: scratch.regolith.here(y),
            link_east: links.east,
            link_west: links.west,
            link_south: links.south,
            link_north: links.north,
            east: east.here_mut(y),
            west: west.here_mut(y),
            south: south.here_mut(y),
            north: north.here_mut(y),
            flow_rate: self.flow_rate,
            kept: self.kept,
        }
        .run(rows.sweep.arch);
    }
}

fn crept(rows: &RegolithRows<'_>, scratch: &DissolutionScratch, output: &mut [Ring], y: usize) {
    let [regolith, east, west, south, north, ..] = output else { unreachable!("five planes of regolith") };
    let still = &scratch.still;
    Crept {
        before: scratch.regolith.here(y),
        east: east.here(y),
        west: west.here(y),
        south: south.here(y),
        north: north.here(y),
        from_west: east.west(y),
        from_east: west.east(y),
        from_north: before(south, still, y, rows.sweep.span.start),
        from_south: if y + 1 < rows.sweep.span.end { north.here(y + 1) } else { still.here(0) },
        regolith: regolith.here_mut(y),
    }
    .run(rows.sweep.arch);
}

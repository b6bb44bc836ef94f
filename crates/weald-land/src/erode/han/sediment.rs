//! The sediment of a step of Han 2015: velocities, settling, and what follows it.

use super::{Han, plane};
use crate::erode::before;
use crate::erode::pipes::without_negligible;
use crate::erode::settling::{CellVelocity, FaceVelocities, Settle};
use crate::erode::sums;
use weald_engine::kernel;
use weald_engine::stencil::chain::Flow;

impl Han {
    pub(super) fn faces(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let depth = &flow.output[plane::DEPTH];
        FaceVelocities {
            flux_east: flow.output[plane::EAST].here(y),
            flux_south: flow.output[plane::SOUTH].here(y),
            depth: depth.here(y),
            depth_east: depth.east(y),
            depth_south: depth.here(flow.next(y)),
            east: flow.scratch.face_east.here_mut(y),
            south: flow.scratch.face_south.here_mut(y),
            velocity_epsilon: self.constants.velocity_epsilon,
        }
        .run(self.setting.arch);
    }

    pub(super) fn settle(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let start = flow.span.start;
        let [change_out, depth, sediment_out, ..] = flow.output else { unreachable!("five state planes") };
        let change = if self.setting.slide.is_some() { &mut scratch.settled.change } else { change_out };
        let sediment =
            if self.setting.advection.is_some() { &mut scratch.settled.sediment } else { sediment_out };
        let links = self.setting.links.row(flow.constants, y);
        Settle {
            found: scratch.found.here(y),
            depth: depth.here(y),
            change_before: flow.input[plane::CHANGE].here(y),
            face_east: scratch.face_east.here(y),
            face_west: scratch.face_east.west(y),
            face_south: scratch.face_south.here(y),
            face_north: before(&scratch.face_south, &scratch.still, y, start),
            sine_east: scratch.sine_east.here(y),
            sine_west: scratch.sine_east.west(y),
            sine_south: scratch.sine_south.here(y),
            sine_north: before(&scratch.sine_south, &scratch.still, y, start),
            neighbour_share: links.neighbour_share,
            erodible: links.erodible,
            change: change.here_mut(y),
            sediment: sediment.here_mut(y),
            lost: scratch.tally[0].here_mut(0),
            capacity: self.constants.capacity,
            uptake_by_speed: self.constants.uptake_by_speed,
            uptake_by_capacity: self.constants.uptake_by_capacity,
            deposit_ratio: self.constants.deposit_ratio,
        }
        .run(self.setting.arch);
        if self.constants.deposit_ratio < 1.0 {
            flow.sums.add(y, sums::SHRUNK, scratch.tally[0].here(0));
        }
    }

    /// Fluxes through the faces, for transport in flux form. The water before them comes with the flow: the row of it
    /// is gone by now where the step before is chained to this one.
    pub(super) fn fluxes(flow: &mut Flow<'_, Self>, y: usize) {
        let settled = &mut flow.scratch.settled;
        settled.eastward.here_mut(y).copy_from_slice(flow.output[plane::EAST].here(y));
        settled.southward.here_mut(y).copy_from_slice(flow.output[plane::SOUTH].here(y));
    }

    /// Velocities of the cells, for the advection.
    pub(super) fn cell_velocity(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        CellVelocity {
            east: scratch.face_east.here(y),
            west: scratch.face_east.west(y),
            south: scratch.face_south.here(y),
            north: before(&scratch.face_south, &scratch.still, y, flow.span.start),
            eastward: scratch.settled.eastward.here_mut(y),
            southward: scratch.settled.southward.here_mut(y),
        }
        .run(self.setting.arch);
    }
}

kernel! {
    /// Depth and sediment after the fluxes of a step (eq. 7 to 9), and what the sky gave or took. Each flux carries the
    /// concentration of the cell it comes from, so that none is lost; evaporation stops at dry ground. The cap that
    /// keeps it stable is in [`crate::erode::pipes`].
    pub(crate) struct Upwind {
        reads {
            depth_before, sediment_before, east, west, south, north, valid,
            concentration, concentration_east, concentration_west, concentration_south, concentration_north,
        }
        updates {}
        writes { depth, sky, sediment }
        constants { rain: f32, evaporation: f32 }
    }
    fn cell() {
        let flowed = depth_before + ((west - east) + (north - south));
        depth = without_negligible(flowed + rain * valid - flowed.max(0.0).min(evaporation * valid));
        sky = depth - flowed;
        let to_east = east * if east >= 0.0 { concentration } else { concentration_east };
        let from_west = west * if west >= 0.0 { concentration_west } else { concentration };
        let to_south = south * if south >= 0.0 { concentration } else { concentration_south };
        let from_north = north * if north >= 0.0 { concentration_north } else { concentration };
        sediment = without_negligible(sediment_before + ((from_west - to_east) + (from_north - to_south)));
    }
}

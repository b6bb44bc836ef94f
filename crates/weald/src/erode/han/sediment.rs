//! The sediment of a step of Han 2015: velocities, settling, and what follows it.

use super::{Han, Law, SETTLED, plane};
use crate::erode::advection::AdvectionRows;
use crate::erode::before;
use crate::erode::settling::{CellVelocity, FaceVelocities, SettleByDissolution, SettleByVelocity};
use crate::erode::sums;
use crate::erode::thermal::SlideRows;
use crate::stencil::chain::Flow;

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
        .run(self.arch);
    }

    pub(super) fn settle(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let start = flow.span.start;
        let [change_out, depth, sediment_out, ..] = flow.output else { unreachable!("five state planes") };
        let change = if self.slide.is_some() { &mut scratch.settled_change } else { change_out };
        let sediment = if self.advection.is_some() { &mut scratch.settled_sediment } else { sediment_out };
        let links = self.links.row(flow.constants, y);
        let arguments = (
            before(&scratch.face_south, &scratch.still, y, start),
            before(&scratch.sine_south, &scratch.still, y, start),
        );
        macro_rules! settle {
            ($Law:ident) => {
                $Law {
                    found: scratch.found.here(y),
                    depth: depth.here(y),
                    change_before: flow.input[plane::CHANGE].here(y),
                    face_east: scratch.face_east.here(y),
                    face_west: scratch.face_east.west(y),
                    face_south: scratch.face_south.here(y),
                    face_north: arguments.0,
                    sine_east: scratch.sine_east.here(y),
                    sine_west: scratch.sine_east.west(y),
                    sine_south: scratch.sine_south.here(y),
                    sine_north: arguments.1,
                    neighbour_share: links.neighbour_share,
                    yields: links.yields,
                    change: change.here_mut(y),
                    sediment: sediment.here_mut(y),
                    lost: scratch.tally[0].here_mut(0),
                    capacity: self.constants.capacity,
                    erosion: self.constants.erosion,
                    deposit_ratio: self.constants.deposit_ratio,
                }
                .run(self.arch)
            };
        }
        match self.constants.law {
            Law::Velocity => settle!(SettleByVelocity),
            Law::Dissolution => settle!(SettleByDissolution),
        }
        if self.constants.deposit_ratio < 1.0 {
            flow.sums.add(y, sums::SHRUNK, scratch.tally[0].here(0));
        }
    }

    pub(super) fn slide(&self, flow: &mut Flow<'_, Self>) {
        let Some(slide) = self.slide else { return };
        slide.advance(
            &SlideRows {
                base: &flow.constants[0],
                change: &flow.scratch.settled_change,
                links: &self.links,
                constants: flow.constants,
                newest: flow.y.checked_sub(SETTLED),
                span: flow.span.clone(),
                arch: self.arch,
            },
            &mut flow.scratch.slide,
            &mut flow.output[plane::CHANGE],
        );
    }

    pub(super) fn advect(&self, flow: &mut Flow<'_, Self>) {
        let Some(advection) = self.advection else { return };
        let scratch = &mut *flow.scratch;
        let newest = flow.y.checked_sub(SETTLED);
        if let Some(y) = newest.filter(|y| flow.span.contains(y)) {
            CellVelocity {
                east: scratch.face_east.here(y),
                west: scratch.face_east.west(y),
                south: scratch.face_south.here(y),
                north: before(&scratch.face_south, &scratch.still, y, flow.span.start),
                eastward: scratch.eastward.here_mut(y),
                southward: scratch.southward.here_mut(y),
            }
            .run(self.arch);
        }
        advection.advance(
            &AdvectionRows {
                sediment: &scratch.settled_sediment,
                eastward: &scratch.eastward,
                southward: &scratch.southward,
                links: &self.links,
                constants: flow.constants,
                newest,
                span: flow.span.clone(),
                arch: self.arch,
            },
            &mut scratch.advection,
            &mut flow.output[plane::SEDIMENT],
        );
    }
}

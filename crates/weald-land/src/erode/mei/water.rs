//! The water of a step of Mei et al. 2007: rain, outflow, and what leaves over an open edge.

use super::{Mei, MeiScratch, plane};
use crate::erode::four_outflows::{OutflowDrive, Row, sines};
use crate::erode::mei::kernels::Rained;
use crate::erode::sums;
use weald_engine::stencil::chain::Flow;

impl Mei {
    pub(super) fn rain(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let links = self.setting.links.row(flow.constants, y);
        Rained {
            base: flow.constants[0].here(y),
            change: flow.input[plane::CHANGE].here(y),
            before: flow.input[plane::DEPTH].here(y),
            valid: links.valid,
            ground: scratch.ground.here_mut(y),
            surface: scratch.surface.here_mut(y),
            depth: scratch.rained.here_mut(y),
            fallen: scratch.tally[0].here_mut(0),
            rain: flow.weather.rain,
        }
        .run(self.setting.arch);
        if flow.weather.rain > 0.0 {
            flow.sums.add(y, sums::RAINED, scratch.tally[0].here(0));
        }
    }

    pub(super) fn outflow(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let row = Row::of(flow, y);
        let MeiScratch { surface, rained, .. } = &*flow.scratch;
        OutflowDrive {
            setting: &self.setting,
            constants: flow.constants,
            input: flow.input,
            surface,
            depth: rained,
            base: flow.constants[0].here(y),
            flow_rate: self.constants.flow_rate,
            most: if self.limiter { 0.0 } else { f32::INFINITY },
        }
        .pour(&row, flow.output);
    }

    pub(super) fn sines(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let row = Row::of(flow, y);
        let MeiScratch { ground, sine_east, sine_south, .. } = flow.scratch;
        sines(&self.setting, flow.constants, ground, &row, [sine_east, sine_south]);
    }
}

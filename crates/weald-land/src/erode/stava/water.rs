//! Water in virtual pipes with four outflows a cell (Šťava et al. 2008; the scheme is that of
//! [`crate::erode::mei`]), and its velocity: flux differences over the mean depth of the step.

use super::{Stava, StavaScratch};
use crate::erode::four_outflows::{OutflowDrive, Row, inflows, outflows_of, sines};
use crate::erode::material_planes::{Pile, pile};
use crate::erode::pipes::without_negligible;
use crate::erode::water_planes as plane;
use weald_engine::kernel;
use weald_engine::stencil::chain::Flow;

kernel! {
    /// Depth after the outflows, and the velocity of the water that flowed.
    pub(crate) struct Moved {
        reads { rained, east, west, south, north, from_west, from_east, from_north, from_south }
        updates {}
        writes { depth, eastward, southward }
        constants { velocity_epsilon: f32 }
    }
    fn cell() {
        let inflow = (from_west + from_east) + (from_north + from_south);
        let flowed = rained + (inflow - ((east + west) + (south + north)));
        let mean_depth = (rained + flowed) * 0.5;
        let per_depth = if mean_depth > velocity_epsilon { 0.5 / mean_depth } else { 0.0 };
        eastward = ((from_west - west) + (east - from_east)) * per_depth;
        southward = ((from_north - north) + (south - from_south)) * per_depth;
        depth = without_negligible(flowed);
    }
}

impl Stava {
    /// All that is solid, regolith on top, and the water on it.
    pub(super) fn surface(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let StavaScratch { ground, surface, rained, .. } = &mut *flow.scratch;
        let arch = self.setting.arch;
        let layers = (1..self.planes.materials).map(|material| self.planes.of(material));
        let regolith = self.dissolution.as_ref().map(|dissolution| dissolution.plane);
        let layers = layers.chain(regolith).map(|plane| flow.input[plane].here(y));
        let bedrock = [flow.constants[0].here(y), flow.input[plane::CHANGE].here(y)];
        pile(arch, bedrock, layers, ground.here_mut(y));
        surface.here_mut(y).copy_from_slice(ground.here(y));
        Pile { thickness: rained.here(y), ground: surface.here_mut(y) }.run(arch);
    }

    pub(super) fn outflow(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let row = Row::of(flow, y);
        let StavaScratch { ground, surface, rained, .. } = &*flow.scratch;
        OutflowDrive {
            setting: &self.setting,
            constants: flow.constants,
            input: flow.input,
            surface,
            depth: rained,
            // Over an open edge water falls from the ground as it is: layers have no start of their own.
            base: ground.here(y),
            flow_rate: self.constants.flow_rate,
            most: 0.0,
        }
        .pour(&row, flow.output);
    }

    pub(super) fn sines(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let row = Row::of(flow, y);
        let StavaScratch { ground, sine_east, sine_south, .. } = &mut *flow.scratch;
        sines(&self.setting, flow.constants, ground, &row, [sine_east, sine_south]);
    }

    pub(super) fn moved(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let row = Row::of(flow, y);
        let StavaScratch { rained, eastward, southward, settled, still, .. } = &mut *flow.scratch;
        let velocity = if self.viscosity.is_some() {
            [eastward, southward]
        } else {
            [&mut settled.eastward, &mut settled.southward]
        };
        let [eastward, southward] = velocity.map(|ring| ring.here_mut(y));
        let (before, outflows) = flow.output.split_at_mut(plane::EAST);
        let [from_east, from_west, from_south, from_north] = inflows(outflows, still, &row);
        let [east, west, south, north] = outflows_of(outflows).map(|ring| ring.here(y));
        Moved {
            rained: rained.here(y),
            east,
            west,
            south,
            north,
            from_west,
            from_east,
            from_north,
            from_south,
            depth: before[plane::DEPTH].here_mut(y),
            eastward,
            southward,
            velocity_epsilon: self.constants.velocity_epsilon,
        }
        .run(self.setting.arch);
    }
}

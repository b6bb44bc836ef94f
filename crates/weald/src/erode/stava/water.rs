//! Water in virtual pipes with four outflows a cell (Šťava et al. 2008; the scheme is that of
//! [`crate::erode::mei`]), and its velocity: flux differences over the mean depth of the step.

use super::{Stava, StavaScratch, plane};
use crate::erode::before;
use crate::erode::mei::kernels::{OpenOutflow, Outflow, Sines};
use crate::erode::pipes::worth_counting;
use crate::erode::stava::planes::{Pile, pile};
use crate::stencil::chain::Flow;
use crate::stencil::kernel::kernel;

kernel! {
    /// Depth after the outflows, and the velocity of the water that flowed.
    pub(crate) struct Moved {
        reads { rained, east, west, south, north, from_west, from_east, from_north, from_south }
        updates {}
        writes { depth, eastward, southward }
        constants { velocity_epsilon: f32 }
    }
    fn cell() {
        let came = (from_west + from_east) + (from_north + from_south);
        let flowed = rained + (came - ((east + west) + (south + north)));
        let mean_depth = (rained + flowed) * 0.5;
        let per_depth = if mean_depth > velocity_epsilon { 0.5 / mean_depth } else { 0.0 };
        eastward = ((from_west - west) + (east - from_east)) * per_depth;
        southward = ((from_north - north) + (south - from_south)) * per_depth;
        depth = worth_counting(flowed);
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
        let next = flow.next(y);
        let previous = if y > flow.span.start { y - 1 } else { y };
        let scratch = &mut *flow.scratch;
        let links = self.setting.links.row(flow.constants, y);
        let [_, _, _, east, west, south, north, ..] = flow.output else {
            unreachable!("seven planes and more")
        };
        let surface = &scratch.surface;
        macro_rules! outflow {
            ($Outflow:ident $(, $land:ident, $base:ident)?) => {
                $Outflow {
                    old_east: flow.input[plane::EAST].here(y),
                    old_west: flow.input[plane::WEST].here(y),
                    old_south: flow.input[plane::SOUTH].here(y),
                    old_north: flow.input[plane::NORTH].here(y),
                    surface: surface.here(y),
                    surface_east: surface.east(y),
                    surface_west: surface.west(y),
                    surface_south: surface.here(next),
                    surface_north: surface.here(previous),
                    depth: scratch.rained.here(y),
                    link_east: links.east,
                    link_west: links.west,
                    link_south: links.south,
                    link_north: links.north,
                    // Over an open edge water falls from the ground as it is: layers have no start of their own.
                    $($land: links.land, $base: scratch.ground.here(y),)?
                    east: east.here_mut(y),
                    west: west.here_mut(y),
                    south: south.here_mut(y),
                    north: north.here_mut(y),
                    flow_rate: self.constants.flow_rate,
                    most: 0.0,
                }
                .run(self.setting.arch)
            };
        }
        if self.setting.open {
            outflow!(OpenOutflow, land, base);
        } else {
            outflow!(Outflow);
        }
    }

    pub(super) fn sines(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let next = flow.next(y);
        let links = self.setting.links.row(flow.constants, y);
        let StavaScratch { ground, sine_east, sine_south, .. } = flow.scratch;
        Sines {
            ground: ground.here(y),
            ground_east: ground.east(y),
            ground_south: ground.here(next),
            link_east: links.east,
            link_south: links.south,
            sine_east: sine_east.here_mut(y),
            sine_south: sine_south.here_mut(y),
        }
        .run(self.setting.arch);
    }

    pub(super) fn moved(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let StavaScratch { rained, eastward, southward, settled, still, .. } = &mut *flow.scratch;
        let velocity = if self.viscosity.is_some() {
            [eastward, southward]
        } else {
            [&mut settled.eastward, &mut settled.southward]
        };
        let [eastward, southward] = velocity.map(|ring| ring.here_mut(y));
        let [_, depth, _, east, west, south, north, ..] = flow.output else {
            unreachable!("seven planes and more")
        };
        Moved {
            rained: rained.here(y),
            east: east.here(y),
            west: west.here(y),
            south: south.here(y),
            north: north.here(y),
            from_west: east.west(y),
            from_east: west.east(y),
            from_north: before(south, still, y, flow.span.start),
            from_south: if y + 1 < flow.span.end { north.here(y + 1) } else { still.here(0) },
            depth: depth.here_mut(y),
            eastward,
            southward,
            velocity_epsilon: self.constants.velocity_epsilon,
        }
        .run(self.setting.arch);
    }
}

//! The water of a step of Mei et al. 2007: rain, outflow, and what leaves over an open edge.

use super::{Mei, MeiScratch, plane};
use crate::erode::mei::kernels::{OpenOutflow, Outflow, Rained, Sines};
use crate::erode::sums;
use crate::stencil::chain::Flow;

impl Mei {
    pub(super) fn rain(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let links = self.setting.links.row(flow.constants, y);
        Rained {
            base: flow.constants[0].here(y),
            change: flow.input[plane::CHANGE].here(y),
            before: flow.input[plane::DEPTH].here(y),
            land: links.land,
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
        let next = flow.next(y);
        let previous = if y > flow.span.start { y - 1 } else { y };
        let scratch = &mut *flow.scratch;
        let links = self.setting.links.row(flow.constants, y);
        let [_, _, _, east, west, south, north] = flow.output else { unreachable!("seven state planes") };
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
                    $($land: links.land, $base: flow.constants[0].here(y),)?
                    east: east.here_mut(y),
                    west: west.here_mut(y),
                    south: south.here_mut(y),
                    north: north.here_mut(y),
                    flow_rate: self.constants.flow_rate,
                    most: if self.limiter { 0.0 } else { f32::INFINITY },
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
        let MeiScratch { ground, sine_east, sine_south, .. } = flow.scratch;
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
}

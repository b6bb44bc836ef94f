//! The water of a step of Han 2015: surface, fluxes, limiter, depth.

use super::sediment::Upwind;
use super::{Han, plane};
use crate::erode::before;
use crate::erode::pipes::{Flux, Limit, Overfall, Scale, Surface, Unlimited};
use crate::erode::sums;
use weald_engine::stencil::chain::Flow;

impl Han {
    pub(super) fn surface(&self, flow: &mut Flow<'_, Self>, y: usize) {
        Surface {
            base: flow.constants[0].here(y),
            change: flow.input[plane::CHANGE].here(y),
            depth: flow.input[plane::DEPTH].here(y),
            ground: flow.scratch.ground.here_mut(y),
            surface: flow.scratch.surface.here_mut(y),
        }
        .run(self.setting.arch);
    }

    /// Fluxes from row `y` to its eastern and southern neighbours; nothing flows through the wall behind the
    /// last row, where no link leads on.
    pub(super) fn flux(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let next = flow.next(y);
        let scratch = &mut *flow.scratch;
        let depth = &flow.input[plane::DEPTH];
        let links = self.setting.links.row(flow.constants, y);
        Flux {
            old_east: flow.input[plane::EAST].here(y),
            old_south: flow.input[plane::SOUTH].here(y),
            surface: scratch.surface.here(y),
            surface_east: scratch.surface.east(y),
            surface_south: scratch.surface.here(next),
            depth: depth.here(y),
            depth_east: depth.east(y),
            depth_south: depth.here(next),
            ground: scratch.ground.here(y),
            ground_east: scratch.ground.east(y),
            ground_south: scratch.ground.here(next),
            link_east: links.east,
            link_south: links.south,
            east: scratch.wanted_east.here_mut(y),
            south: scratch.wanted_south.here_mut(y),
            sine_east: scratch.sine_east.here_mut(y),
            sine_south: scratch.sine_south.here_mut(y),
            flow_rate: self.constants.flow_rate,
        }
        .run(self.setting.arch);
        if self.setting.open {
            self.overfall(flow, y);
        }
    }

    pub(super) fn overfall(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let next = flow.next(y);
        let scratch = &mut *flow.scratch;
        let depth = &flow.input[plane::DEPTH];
        let (change, valid) = (&flow.input[plane::CHANGE], &flow.constants[1]);
        let edges = [
            (plane::EAST, [depth.east(y), change.east(y), valid.east(y)], &mut scratch.wanted_east),
            (
                plane::SOUTH,
                [depth.here(next), change.here(next), valid.here(next)],
                &mut scratch.wanted_south,
            ),
        ];
        for (plane, [depth_next, change_next, land_next], flux) in edges {
            Overfall {
                old: flow.input[plane].here(y),
                depth: depth.here(y),
                depth_next,
                change: change.here(y),
                change_next,
                valid: valid.here(y),
                land_next,
                flux: flux.here_mut(y),
                flow_rate: self.constants.flow_rate,
            }
            .run(self.setting.arch);
        }
    }

    pub(super) fn limit(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let depth = flow.input[plane::DEPTH].here(y);
        let sediment = flow.input[plane::SEDIMENT].here(y);
        let east = scratch.wanted_east.here(y);
        let west = scratch.wanted_east.west(y);
        let south = scratch.wanted_south.here(y);
        let north = before(&scratch.wanted_south, &scratch.still, y, flow.span.start);
        let share = scratch.share.here_mut(y);
        let concentration = scratch.concentration.here_mut(y);
        let epsilon = self.constants.epsilon;
        if self.limiter {
            Limit { depth, sediment, east, west, south, north, share, concentration, epsilon }
                .run(self.setting.arch);
        } else {
            Unlimited { depth, sediment, east, west, south, north, share, concentration, epsilon }
                .run(self.setting.arch);
        }
    }

    pub(super) fn scale(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let next = flow.next(y);
        let scratch = &*flow.scratch;
        let [_, _, _, east, south] = flow.output else { unreachable!("five state planes") };
        Scale {
            wanted_east: scratch.wanted_east.here(y),
            wanted_south: scratch.wanted_south.here(y),
            share: scratch.share.here(y),
            share_east: scratch.share.east(y),
            share_south: scratch.share.here(next),
            east: east.here_mut(y),
            south: south.here_mut(y),
        }
        .run(self.setting.arch);
    }

    /// Moves water, and sediment with it unless it is advected later.
    pub(super) fn flow(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let next = flow.next(y);
        let scratch = &mut *flow.scratch;
        let [_, depth, _, east, south] = flow.output else { unreachable!("five state planes") };
        let concentration = &scratch.concentration;
        Upwind {
            depth_before: flow.input[plane::DEPTH].here(y),
            sediment_before: flow.input[plane::SEDIMENT].here(y),
            east: east.here(y),
            west: east.west(y),
            south: south.here(y),
            north: before(south, &scratch.still, y, flow.span.start),
            concentration: concentration.here(y),
            concentration_east: concentration.east(y),
            concentration_west: concentration.west(y),
            concentration_south: concentration.here(next),
            concentration_north: before(concentration, &scratch.still, y, flow.span.start),
            valid: self.setting.links.row(flow.constants, y).valid,
            depth: depth.here_mut(y),
            sky: scratch.tally[0].here_mut(0),
            sediment: scratch.found.here_mut(y),
            rain: flow.weather.rain,
            evaporation: flow.weather.evaporation,
        }
        .run(self.setting.arch);
        let which = if flow.weather.rain > 0.0 { sums::RAINED } else { sums::EVAPORATED };
        flow.sums.add(y, which, scratch.tally[0].here(0));
        if self.setting.in_flux_form() {
            scratch.settled.depth.here_mut(y).copy_from_slice(flow.input[plane::DEPTH].here(y));
        }
        if self.setting.advection.is_some() {
            scratch.found.here_mut(y).copy_from_slice(flow.input[plane::SEDIMENT].here(y));
        }
    }
}

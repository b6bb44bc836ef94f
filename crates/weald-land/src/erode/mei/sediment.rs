//! The sediment of a step of Mei et al. 2007: exchange with the ground, sliding, transport.

use super::{Mei, MeiScratch, Slope, plane};
use crate::erode::before;
use crate::erode::four_outflows::{Row, carry_upwind, inflows, outflows_of, store_transport_fluxes};
use crate::erode::mei::kernels::{CentralTilt, Exchange, LoadUnlimited, MeanSine};
use crate::erode::outflow_kernels::Load;
use crate::erode::sums;
use weald_engine::stencil::chain::Flow;

impl Mei {
    /// The slope of a row, for its capacity.
    pub(super) fn tilt(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let row = Row::of(flow, y);
        let MeiScratch { ground, sine_east, sine_south, tilt, still, .. } = &mut *flow.scratch;
        let links = self.setting.links.row(flow.constants, y);
        match self.slope {
            Slope::MeanSine => MeanSine {
                sine_east: sine_east.here(y),
                sine_west: sine_east.west(y),
                sine_south: sine_south.here(y),
                sine_north: before(sine_south, still, y, flow.span.start),
                neighbour_share: links.neighbour_share,
                tilt: tilt.here_mut(0),
            }
            .run(self.setting.arch),
            Slope::Central => CentralTilt {
                ground: ground.here(y),
                ground_east: ground.east(y),
                ground_west: ground.west(y),
                ground_south: ground.here(row.next()),
                ground_north: ground.here(row.previous()),
                link_east: links.east,
                link_west: links.west,
                link_south: links.south,
                link_north: links.north,
                tilt: tilt.here_mut(0),
            }
            .run(self.setting.arch),
        }
    }

    pub(super) fn exchange(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let row = Row::of(flow, y);
        let scratch = &mut *flow.scratch;
        let links = self.setting.links.row(flow.constants, y);
        let ([change_out, depth, ..], outflows) = flow.output.split_at_mut(plane::EAST) else {
            unreachable!("seven state planes")
        };
        let [from_east, from_west, from_south, from_north] = inflows(outflows, &scratch.still, &row);
        let [east, west, south, north] = outflows_of(outflows).map(|ring| ring.here(y));
        let change = if self.setting.slide.is_some() { &mut scratch.settled.change } else { change_out };
        let [evaporated, lost] = &mut scratch.tally;
        Exchange {
            rained: scratch.rained.here(y),
            east,
            west,
            south,
            north,
            from_west,
            from_east,
            from_north,
            from_south,
            found: flow.input[plane::SEDIMENT].here(y),
            change_before: flow.input[plane::CHANGE].here(y),
            tilt: scratch.tilt.here(0),
            erodible: links.erodible,
            valid: links.valid,
            depth: depth.here_mut(y),
            evaporated: evaporated.here_mut(0),
            eastward: scratch.settled.eastward.here_mut(y),
            southward: scratch.settled.southward.here_mut(y),
            change: change.here_mut(y),
            sediment: scratch.settled.sediment.here_mut(y),
            lost: lost.here_mut(0),
            evaporation: flow.weather.evaporation,
            velocity_epsilon: self.constants.velocity_epsilon,
            capacity: self.constants.capacity,
            erosion: self.constants.erosion,
            deposition: self.constants.deposition,
            deposit_ratio: self.constants.deposit_ratio,
        }
        .run(self.setting.arch);
        if flow.weather.evaporation > 0.0 {
            flow.sums.add(y, sums::EVAPORATED, evaporated.here(0));
        }
        if self.constants.deposit_ratio < 1.0 {
            flow.sums.add(y, sums::SHRUNK, lost.here(0));
        }
    }

    /// Fluxes through the faces and the water before them, for transport in flux form.
    pub(super) fn fluxes(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let row = Row::of(flow, y);
        let MeiScratch { rained, still, settled, .. } = &mut *flow.scratch;
        store_transport_fluxes(&self.setting, flow.output, (rained.here(y), still), &row, settled);
    }

    pub(super) fn load(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let sediment = scratch.settled.sediment.here(y);
        let depth = scratch.rained.here(y);
        let concentration = scratch.concentration.here_mut(y);
        let epsilon = self.constants.epsilon;
        if self.limiter {
            Load { sediment, depth, concentration, epsilon }.run(self.setting.arch);
            return;
        }
        let [_, _, _, east, west, south, north] = &*flow.output else { unreachable!("seven state planes") };
        let (east, west, south, north) = (east.here(y), west.here(y), south.here(y), north.here(y));
        LoadUnlimited { sediment, depth, east, west, south, north, concentration, epsilon }
            .run(self.setting.arch);
    }

    pub(super) fn carry(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let row = Row::of(flow, y);
        let MeiScratch { settled, concentration, still, .. } = &*flow.scratch;
        carry_upwind(&self.setting, (&settled.sediment, concentration), still, &row, flow.output);
    }
}

//! Transport of sediment: upwind with the outflows of the step and the depth before them, as in
//! [`crate::erode::mei`], or by velocity as the setting says.

use super::Stava;
use crate::erode::before;
use crate::erode::flux_corrected::NetFlux;
use crate::erode::mei::kernels::{Carry, Load};
use crate::stencil::chain::Flow;

impl Stava {
    /// Moves the sediment of the next row that is ready.
    pub(super) fn transport(&self, flow: &mut Flow<'_, Self>) {
        if self.setting.in_flux_form()
            && let Some(y) = flow.behind(self.exchanged())
        {
            self.fluxes(flow, y);
        }
        if self.setting.advection.is_some() {
            self.setting.advect(flow, flow.y.checked_sub(self.exchanged()));
            return;
        }
        if let Some(y) = flow.behind(self.exchanged()) {
            self.load(flow, y);
        }
        if let Some(y) = flow.behind(self.exchanged() + 1) {
            self.carry(flow, y);
        }
    }

    /// Fluxes through the faces and the water before them, for transport in flux form.
    fn fluxes(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let [_, _, _, east, west, south, north, ..] = &*flow.output else {
            unreachable!("seven planes and more")
        };
        let from_south = if y + 1 < flow.span.end { north.here(y + 1) } else { scratch.still.here(0) };
        scratch.settled.depth.here_mut(y).copy_from_slice(scratch.rained.here(y));
        NetFlux {
            east: east.here(y),
            from_east: west.east(y),
            south: south.here(y),
            from_south,
            eastward: scratch.settled.eastward.here_mut(y),
            southward: scratch.settled.southward.here_mut(y),
        }
        .run(self.setting.arch);
    }

    fn load(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        Load {
            sediment: scratch.settled.sediment.here(y),
            depth: scratch.rained.here(y),
            concentration: scratch.concentration.here_mut(y),
            epsilon: self.constants.epsilon,
        }
        .run(self.setting.arch);
    }

    fn carry(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let next = flow.next(y);
        let scratch = &*flow.scratch;
        let [_, _, sediment, east, west, south, north, ..] = flow.output else {
            unreachable!("seven planes and more")
        };
        let (still, start) = (&scratch.still, flow.span.start);
        let concentration = &scratch.concentration;
        Carry {
            before: scratch.settled.sediment.here(y),
            east: east.here(y),
            west: west.here(y),
            south: south.here(y),
            north: north.here(y),
            from_west: east.west(y),
            from_east: west.east(y),
            from_north: before(south, still, y, start),
            from_south: if y + 1 < flow.span.end { north.here(y + 1) } else { still.here(0) },
            concentration: concentration.here(y),
            concentration_west: concentration.west(y),
            concentration_east: concentration.east(y),
            concentration_north: before(concentration, still, y, start),
            concentration_south: concentration.here(next),
            sediment: sediment.here_mut(y),
        }
        .run(self.setting.arch);
    }
}

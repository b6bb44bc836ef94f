//! Transport of sediment: upwind with the outflows of the step and the depth before them, as in
//! [`crate::erode::mei`], or by velocity as the setting says.

use super::{Stava, StavaScratch};
use crate::erode::four_outflows::{Row, carry_upwind, store_transport_fluxes};
use crate::erode::outflow_kernels::Load;
use weald_engine::stencil::chain::Flow;

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
        let row = Row::of(flow, y);
        let StavaScratch { rained, still, settled, .. } = &mut *flow.scratch;
        store_transport_fluxes(&self.setting, flow.output, (rained.here(y), still), &row, settled);
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
        let row = Row::of(flow, y);
        let StavaScratch { settled, concentration, still, .. } = &*flow.scratch;
        carry_upwind(&self.setting, (&settled.sediment, concentration), still, &row, flow.output);
    }
}

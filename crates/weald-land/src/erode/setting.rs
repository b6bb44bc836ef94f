//! What the two water models share: cells and edges, the first planes of the state, and all that follows the
//! exchange with the ground, which is sliding, advection, and what leaves over an open edge.

mod program;

use super::water_planes as plane;
use pulp::Arch;

use super::advection::{Advection, AdvectionScratch};
use super::links::Links;
use super::pipeline::{PipelineOutput, PipelineRows, PipelineScratch};
use super::pipes::Drain;
use super::sums;
use super::sweep::Sweep;
use super::thermal::Slide;
use crate::erode::advection_rows::AdvectionRows;
use weald_core::grid::Size;
use weald_engine::stencil::chain::{Flow, Process};
use weald_engine::stencil::ring::Ring;

/// Where a model runs, and with what beside its own equations.
pub(crate) struct Setting {
    pub(crate) links: Links,
    /// Whether water falls into cells without data.
    pub(crate) open: bool,
    /// Advection by velocity instead of upwind fluxes.
    pub(crate) advection: Option<Advection>,
    pub(crate) slide: Option<Slide>,
    pub(crate) arch: Arch,
}

/// Rows in flight after the exchange with the ground.
pub(crate) struct Settled {
    pub(crate) change: Ring,
    pub(crate) sediment: Ring,
    /// Water before it flowed, for transport in flux form.
    pub(crate) depth: Ring,
    /// Velocities, or the fluxes themselves for transport in flux form.
    pub(crate) eastward: Ring,
    pub(crate) southward: Ring,
    slide: Option<PipelineScratch>,
    advection: AdvectionScratch,
}

impl Settled {
    pub(crate) fn new(columns: usize, slide: Option<&Slide>) -> Self {
        let ring = |depth| Ring::new(columns, depth);
        Self {
            change: ring(slide.map_or(0, |slide| slide.pipeline.look_back()) + 1),
            sediment: ring(4),
            depth: ring(2),
            eastward: ring(3),
            southward: ring(3),
            slide: slide.map(|slide| slide.pipeline.scratch(columns)),
            advection: AdvectionScratch::new(columns),
        }
    }
}

impl Setting {
    /// The same over a part of the domain.
    pub(crate) fn sized(&self, size: Size) -> Self {
        Self { links: self.links.sized(size), slide: self.slide.clone(), ..*self }
    }

    /// Planes that stay: the ground of the start and what the links need.
    pub(crate) fn constant_planes(&self) -> usize {
        1 + self.links.planes()
    }

    /// Rows by which the output lies behind the exchange, where upwind transport after it takes `upwind`.
    pub(crate) fn lag(&self, upwind: usize) -> usize {
        self.slide
            .as_ref()
            .map_or(0, |slide| slide.pipeline.lag())
            .max(self.advection.map_or(upwind, Advection::lag))
    }

    /// The sweep of a part that reads rows up to `newest`.
    pub(crate) fn sweep<'a, 'flow: 'a, P: Process>(
        &'a self,
        flow: &Flow<'flow, P>,
        newest: Option<usize>,
    ) -> Sweep<'a> {
        Sweep::of(flow, &self.links, self.arch, newest)
    }

    /// Slides the ground of the next row that is ready; `settled` is the row of the exchange.
    pub(crate) fn slide<P>(&self, flow: &mut Flow<'_, P>, settled: Option<usize>)
    where
        P: Process<Scratch: AsMut<Settled>>,
    {
        let Some(slide) = &self.slide else { return };
        let sweep = self.sweep(flow, settled);
        let Settled { change, slide: Some(scratch), .. } = flow.scratch.as_mut() else { return };
        let rows = PipelineRows { input: std::slice::from_ref(change), sweep: &sweep, weather: &[] };
        let planes = std::slice::from_mut(&mut flow.output[plane::CHANGE]);
        slide.pipeline.advance(&rows, scratch, &mut PipelineOutput { planes, tally: &mut |_, _, _| {} });
    }

    /// Whether sediment goes with the fluxes of the water and not by its velocity.
    pub(crate) fn in_flux_form(&self) -> bool {
        matches!(self.advection, Some(Advection::FluxCorrected { .. }))
    }

    /// Advects the sediment of the next row that is ready, unless it goes upwind.
    pub(crate) fn advect<P>(&self, flow: &mut Flow<'_, P>, settled: Option<usize>)
    where
        P: Process<Scratch: AsMut<Settled>>,
    {
        let Some(advection) = self.advection else { return };
        let sweep = self.sweep(flow, settled);
        let rows = flow.scratch.as_mut();
        advection.advance(
            &AdvectionRows {
                sediment: &rows.sediment,
                depth: &rows.depth,
                eastward: &rows.eastward,
                southward: &rows.southward,
                sweep,
            },
            &mut rows.advection,
            &mut flow.output[plane::SEDIMENT],
        );
    }

    /// Empties the cells without data of row `y` into the sums, where edges are open. `rows` gives the
    /// sediment to empty and two rows to count in.
    pub(crate) fn drain<P: Process>(
        &self,
        flow: &mut Flow<'_, P>,
        y: usize,
        rows: fn(&mut P::Scratch) -> (&mut Ring, &mut [Ring; 2]),
    ) {
        if !self.open {
            return;
        }
        let (sediment, [water_out, sediment_out]) = rows(flow.scratch);
        Drain {
            valid: self.links.row(flow.constants, y).valid,
            depth: flow.output[plane::DEPTH].here_mut(y),
            sediment: sediment.here_mut(y),
            water_out: water_out.here_mut(0),
            sediment_out: sediment_out.here_mut(0),
        }
        .run(self.arch);
        flow.sums.add(y, sums::WATER_OUT, water_out.here(0));
        flow.sums.add(y, sums::SEDIMENT_OUT, sediment_out.here(0));
    }
}

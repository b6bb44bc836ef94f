//! What the models with four outflows a cell share (Mei et al. 2007, Šťava et al. 2008): the outflows themselves,
//! and the transport of sediment with them.

use std::ops::Range;

use super::before;
use super::flux_corrected::NetFlux;
use super::outflow_kernels::{Carry, OpenOutflow, Outflow, Sines};
use super::setting::{Setting, Settled};
use super::water_planes as plane;
use weald_engine::stencil::chain::{Flow, Process};
use weald_engine::stencil::ring::Ring;

/// Row `y` of a subdomain, between its walls.
#[derive(Clone)]
pub(crate) struct Row {
    pub(crate) y: usize,
    pub(crate) span: Range<usize>,
}

impl Row {
    /// Row `y` of what flows.
    pub(crate) fn of<P: Process>(flow: &Flow<'_, P>, y: usize) -> Self {
        Self { y, span: flow.span.clone() }
    }

    /// The row after, or the same before a wall, where no link leads on.
    pub(crate) fn next(&self) -> usize {
        if self.y + 1 < self.span.end { self.y + 1 } else { self.y }
    }

    /// The row before, or the same behind a wall.
    pub(crate) fn previous(&self) -> usize {
        if self.y > self.span.start { self.y - 1 } else { self.y }
    }
}

/// The outflows to the east, west, south and north, with which `planes` begin.
pub(crate) fn outflows_of(planes: &[Ring]) -> [&Ring; 4] {
    let [east, west, south, north, ..] = planes else { unreachable!("four outflows") };
    [east, west, south, north]
}

/// What outflows come from.
pub(crate) struct OutflowDrive<'a> {
    pub(crate) setting: &'a Setting,
    pub(crate) constants: &'a [Ring],
    /// The state before the step.
    pub(crate) input: &'a [Ring],
    /// Height of the water.
    pub(crate) surface: &'a Ring,
    /// Depth after the weather.
    pub(crate) depth: &'a Ring,
    /// Ground from which water falls over an open edge.
    pub(crate) base: &'a [f32],
    pub(crate) flow_rate: f32,
    /// What a cell may give although it does not have it.
    pub(crate) most: f32,
}

impl OutflowDrive<'_> {
    /// Outflows of a row to the four neighbours.
    pub(crate) fn pour(&self, row: &Row, output: &mut [Ring]) {
        let y = row.y;
        let links = self.setting.links.row(self.constants, y);
        let [old_east, old_west, old_south, old_north] =
            outflows_of(&self.input[plane::EAST..]).map(|ring| ring.here(y));
        let [_, _, _, east, west, south, north, ..] = output else { unreachable!("seven planes and more") };
        macro_rules! pour {
            ($Outflow:ident $(, $valid:ident, $base:ident)?) => {
                $Outflow {
                    old_east,
                    old_west,
                    old_south,
                    old_north,
                    surface: self.surface.here(y),
                    surface_east: self.surface.east(y),
                    surface_west: self.surface.west(y),
                    surface_south: self.surface.here(row.next()),
                    surface_north: self.surface.here(row.previous()),
                    depth: self.depth.here(y),
                    link_east: links.east,
                    link_west: links.west,
                    link_south: links.south,
                    link_north: links.north,
                    $($valid: links.valid, $base: self.base,)?
                    east: east.here_mut(y),
                    west: west.here_mut(y),
                    south: south.here_mut(y),
                    north: north.here_mut(y),
                    flow_rate: self.flow_rate,
                    most: self.most,
                }
                .run(self.setting.arch)
            };
        }
        if self.setting.open { pour!(OpenOutflow, valid, base) } else { pour!(Outflow) }
    }
}

/// What flows into the cells of a row from the east, west, south and north; `planes` begin with the outflows.
pub(crate) fn inflows<'a>(planes: &'a [Ring], still: &'a Ring, row: &Row) -> [&'a [f32]; 4] {
    let [east, west, south, north] = outflows_of(planes);
    let below = row.y + 1 < row.span.end;
    let from_south = if below { north.here(row.y + 1) } else { still.here(0) };
    [west.east(row.y), east.west(row.y), from_south, before(south, still, row.y, row.span.start)]
}

/// Fluxes through the faces of a row and the water before them, for transport in flux form.
pub(crate) fn store_transport_fluxes(
    setting: &Setting,
    state: &[Ring],
    (depth, still): (&[f32], &Ring),
    row: &Row,
    settled: &mut Settled,
) {
    let [from_east, _, from_south, _] = inflows(&state[plane::EAST..], still, row);
    settled.depth.here_mut(row.y).copy_from_slice(depth);
    NetFlux {
        east: state[plane::EAST].here(row.y),
        from_east,
        south: state[plane::SOUTH].here(row.y),
        from_south,
        eastward: settled.eastward.here_mut(row.y),
        southward: settled.southward.here_mut(row.y),
    }
    .run(setting.arch);
}

/// Sines of the slopes from a row to its eastern and southern neighbours.
pub(crate) fn sines(
    setting: &Setting,
    constants: &[Ring],
    ground: &Ring,
    row: &Row,
    [sine_east, sine_south]: [&mut Ring; 2],
) {
    let links = setting.links.row(constants, row.y);
    Sines {
        ground: ground.here(row.y),
        ground_east: ground.east(row.y),
        ground_south: ground.here(row.next()),
        link_east: links.east,
        link_south: links.south,
        sine_east: sine_east.here_mut(row.y),
        sine_south: sine_south.here_mut(row.y),
    }
    .run(setting.arch);
}

/// Carries the sediment of a row with the outflows, each with the concentration of the cell that it leaves.
pub(crate) fn carry_upwind(
    setting: &Setting,
    (sediment, concentration): (&Ring, &Ring),
    still: &Ring,
    row: &Row,
    output: &mut [Ring],
) {
    let y = row.y;
    let (before_them, outflows) = output.split_at_mut(plane::EAST);
    let [from_east, from_west, from_south, from_north] = inflows(outflows, still, row);
    let [east, west, south, north] = outflows_of(outflows).map(|ring| ring.here(y));
    Carry {
        before: sediment.here(y),
        east,
        west,
        south,
        north,
        from_west,
        from_east,
        from_north,
        from_south,
        concentration: concentration.here(y),
        concentration_west: concentration.west(y),
        concentration_east: concentration.east(y),
        concentration_north: before(concentration, still, y, row.span.start),
        concentration_south: concentration.here(row.next()),
        sediment: before_them[plane::SEDIMENT].here_mut(y),
    }
    .run(setting.arch);
}

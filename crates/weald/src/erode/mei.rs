//! One step of Mei, Decaudin, Hu 2007 as a stream of rows: rain, outflow, water, velocity, exchange,
//! transport, evaporation, thermal.
//!
//! "Fast Hydraulic Erosion Simulation and Visualization on GPU", Pacific Graphics 2007, doi
//! 10.1109/PG.2007.15. State: change of the ground, depth, sediment, four outflows a cell. Lengths are in
//! cells and time in steps, so that `k = dt² g A / l` is the flow rate. What differs from the source:
//! transport is upwind by default, with the fluxes and the depth before them, so that no sediment is lost
//! (`semi-lagrangian` gives the source's); exchange constants are per step; ground is kept as start plus
//! change (see [`super::settling`]).

use pulp::Arch;

use super::advection::{Advection, AdvectionRows, AdvectionScratch};
use super::han::{Sky, before};
use super::links::Links;
use super::mei_kernels::{Carry, Exchange, Load, LoadUnlimited, OpenOutflow, Outflow, Rained, Sines};
use super::pipes::Drain;
use super::simulation::Part;
use super::sums;
use super::thermal::{Slide, SlideRows, SlideScratch};
use crate::stencil::chain::{Flow, Process};
use crate::stencil::ring::Ring;

/// Planes of the state.
pub(crate) mod plane {
    /// Change of the ground since the start.
    pub(crate) const CHANGE: usize = 0;
    /// Depth of water.
    pub(crate) const DEPTH: usize = 1;
    /// Sediment in the water.
    pub(crate) const SEDIMENT: usize = 2;
    /// Outflow to the east.
    pub(crate) const EAST: usize = 3;
    /// Outflow to the west.
    pub(crate) const WEST: usize = 4;
    /// Outflow to the south.
    pub(crate) const SOUTH: usize = 5;
    /// Outflow to the north.
    pub(crate) const NORTH: usize = 6;
    /// Number of state planes.
    pub(crate) const COUNT: usize = 7;
}

/// Mean fluxes through the eastern and southern edge of each cell: what it gives, less what its neighbour gives
/// back.
pub(crate) const MEAN_FLUXES: &[&[Part]] = &[
    &[
        Part { plane: plane::EAST, factor: 1.0, from: [0, 0] },
        Part { plane: plane::WEST, factor: -1.0, from: [1, 0] },
    ],
    &[
        Part { plane: plane::SOUTH, factor: 1.0, from: [0, 0] },
        Part { plane: plane::NORTH, factor: -1.0, from: [0, 1] },
    ],
];

/// Constants of the method, in cells and steps; names as in the recipe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeiConstants {
    pub(crate) flow_rate: f32,
    pub(crate) capacity: f32,
    pub(crate) erosion: f32,
    pub(crate) deposition: f32,
    pub(crate) deposit_ratio: f32,
    pub(crate) epsilon: f32,
    pub(crate) velocity_epsilon: f32,
    /// Whether outflows are scaled to what their cell has.
    pub(crate) limiter: bool,
}

/// The process.
pub(crate) struct Mei {
    pub(crate) constants: MeiConstants,
    pub(crate) links: Links,
    /// Whether water falls into cells without data.
    pub(crate) open: bool,
    /// Advection by velocity instead of upwind fluxes.
    pub(crate) advection: Option<Advection>,
    pub(crate) slide: Option<Slide>,
    pub(crate) arch: Arch,
}

/// Rows in flight within one step.
pub(crate) struct MeiScratch {
    rained: Ring,
    ground: Ring,
    surface: Ring,
    sine_east: Ring,
    sine_south: Ring,
    eastward: Ring,
    southward: Ring,
    settled_change: Ring,
    loaded: Ring,
    concentration: Ring,
    slide: SlideScratch,
    advection: AdvectionScratch,
    tally: [Ring; 2],
    still: Ring,
}

const FLUX: usize = 1;
const EXCHANGED: usize = 2;

impl Process for Mei {
    type Weather = Sky;
    type Scratch = MeiScratch;

    fn state_planes(&self) -> usize {
        plane::COUNT
    }

    fn constant_planes(&self) -> usize {
        1 + self.links.planes()
    }

    fn lag(&self) -> usize {
        EXCHANGED + self.slide.map_or(0, Slide::lag).max(self.advection.map_or(1, Advection::lag))
    }

    fn reach(&self) -> usize {
        self.lag() + 1
    }

    fn scratch(&self, columns: usize) -> MeiScratch {
        let ring = |depth| Ring::new(columns, depth);
        MeiScratch {
            rained: ring(3),
            ground: ring(2),
            surface: ring(3),
            sine_east: ring(2),
            sine_south: ring(3),
            eastward: ring(3),
            southward: ring(3),
            settled_change: ring(3),
            loaded: ring(4),
            concentration: ring(3),
            slide: SlideScratch::new(columns),
            advection: AdvectionScratch::new(columns),
            tally: [Ring::new(columns, 1), Ring::new(columns, 1)],
            still: Ring::new(columns, 1),
        }
    }

    fn advance(&self, flow: &mut Flow<'_, Self>) {
        if let Some(y) = flow.behind(0) {
            self.rain(flow, y);
        }
        if let Some(y) = flow.behind(FLUX) {
            self.outflow(flow, y);
            self.sines(flow, y);
        }
        if let Some(y) = flow.behind(EXCHANGED) {
            self.exchange(flow, y);
            if self.open {
                self.drain(flow, y);
            }
            if self.advection.is_none() {
                self.load(flow, y);
            }
        }
        self.slide(flow);
        self.transport(flow);
    }
}

impl Mei {
    fn rain(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let links = self.links.row(flow.constants, y);
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
        .run(self.arch);
        if flow.weather.rain > 0.0 {
            flow.sums.add(y, sums::RAINED, scratch.tally[0].here(0));
        }
    }

    fn outflow(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let next = flow.next(y);
        let previous = if y > flow.span.start { y - 1 } else { y };
        let scratch = &mut *flow.scratch;
        let links = self.links.row(flow.constants, y);
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
                    most: if self.constants.limiter { 0.0 } else { f32::INFINITY },
                }
                .run(self.arch)
            };
        }
        if self.open {
            outflow!(OpenOutflow, land, base);
        } else {
            outflow!(Outflow);
        }
    }

    fn sines(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let next = flow.next(y);
        let links = self.links.row(flow.constants, y);
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
        .run(self.arch);
    }

    fn exchange(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let links = self.links.row(flow.constants, y);
        let [change_out, depth, _, east, west, south, north] = flow.output else {
            unreachable!("seven state planes")
        };
        let start = flow.span.start;
        let from_south = if y + 1 < flow.span.end { north.here(y + 1) } else { scratch.still.here(0) };
        let change = if self.slide.is_some() { &mut scratch.settled_change } else { change_out };
        let [evaporated, lost] = &mut scratch.tally;
        Exchange {
            rained: scratch.rained.here(y),
            east: east.here(y),
            west: west.here(y),
            south: south.here(y),
            north: north.here(y),
            from_west: east.west(y),
            from_east: west.east(y),
            from_north: before(south, &scratch.still, y, start),
            from_south,
            found: flow.input[plane::SEDIMENT].here(y),
            change_before: flow.input[plane::CHANGE].here(y),
            sine_east: scratch.sine_east.here(y),
            sine_west: scratch.sine_east.west(y),
            sine_south: scratch.sine_south.here(y),
            sine_north: before(&scratch.sine_south, &scratch.still, y, start),
            neighbour_share: links.neighbour_share,
            yields: links.yields,
            depth: depth.here_mut(y),
            evaporated: evaporated.here_mut(0),
            eastward: scratch.eastward.here_mut(y),
            southward: scratch.southward.here_mut(y),
            change: change.here_mut(y),
            sediment: scratch.loaded.here_mut(y),
            lost: lost.here_mut(0),
            evaporation: flow.weather.evaporation,
            velocity_epsilon: self.constants.velocity_epsilon,
            capacity: self.constants.capacity,
            erosion: self.constants.erosion,
            deposition: self.constants.deposition,
            deposit_ratio: self.constants.deposit_ratio,
        }
        .run(self.arch);
        if flow.weather.evaporation > 0.0 {
            flow.sums.add(y, sums::EVAPORATED, evaporated.here(0));
        }
        if self.constants.deposit_ratio < 1.0 {
            flow.sums.add(y, sums::SHRUNK, lost.here(0));
        }
    }

    /// Empties the cells without data. Their sediment came with the step before.
    fn drain(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let [water_out, sediment_out] = &mut flow.scratch.tally;
        Drain {
            land: self.links.row(flow.constants, y).land,
            depth: flow.output[plane::DEPTH].here_mut(y),
            sediment: flow.scratch.loaded.here_mut(y),
            water_out: water_out.here_mut(0),
            sediment_out: sediment_out.here_mut(0),
        }
        .run(self.arch);
        flow.sums.add(y, sums::WATER_OUT, water_out.here(0));
        flow.sums.add(y, sums::SEDIMENT_OUT, sediment_out.here(0));
    }

    fn load(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let sediment = scratch.loaded.here(y);
        let depth = scratch.rained.here(y);
        let concentration = scratch.concentration.here_mut(y);
        let epsilon = self.constants.epsilon;
        if self.constants.limiter {
            Load { sediment, depth, concentration, epsilon }.run(self.arch);
            return;
        }
        let [_, _, _, east, west, south, north] = &*flow.output else { unreachable!("seven state planes") };
        let (east, west, south, north) = (east.here(y), west.here(y), south.here(y), north.here(y));
        LoadUnlimited { sediment, depth, east, west, south, north, concentration, epsilon }.run(self.arch);
    }

    fn slide(&self, flow: &mut Flow<'_, Self>) {
        let Some(slide) = self.slide else { return };
        slide.advance(
            &SlideRows {
                base: &flow.constants[0],
                change: &flow.scratch.settled_change,
                links: &self.links,
                constants: flow.constants,
                newest: flow.y.checked_sub(EXCHANGED),
                span: flow.span.clone(),
                arch: self.arch,
            },
            &mut flow.scratch.slide,
            &mut flow.output[plane::CHANGE],
        );
    }

    fn transport(&self, flow: &mut Flow<'_, Self>) {
        let Some(advection) = self.advection else {
            if let Some(y) = flow.behind(EXCHANGED + 1) {
                self.carry(flow, y);
            }
            return;
        };
        let scratch = &mut *flow.scratch;
        advection.advance(
            &AdvectionRows {
                sediment: &scratch.loaded,
                eastward: &scratch.eastward,
                southward: &scratch.southward,
                links: &self.links,
                constants: flow.constants,
                newest: flow.y.checked_sub(EXCHANGED),
                span: flow.span.clone(),
                arch: self.arch,
            },
            &mut scratch.advection,
            &mut flow.output[plane::SEDIMENT],
        );
    }

    fn carry(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &*flow.scratch;
        let [_, _, sediment, east, west, south, north] = flow.output else {
            unreachable!("seven state planes")
        };
        let (still, start) = (&scratch.still, flow.span.start);
        let concentration = &scratch.concentration;
        let next = if y + 1 < flow.span.end { y + 1 } else { y };
        let from_south = if y + 1 < flow.span.end { north.here(y + 1) } else { still.here(0) };
        Carry {
            before: scratch.loaded.here(y),
            east: east.here(y),
            west: west.here(y),
            south: south.here(y),
            north: north.here(y),
            from_west: east.west(y),
            from_east: west.east(y),
            from_north: before(south, still, y, start),
            from_south,
            concentration: concentration.here(y),
            concentration_west: concentration.west(y),
            concentration_east: concentration.east(y),
            concentration_north: before(concentration, still, y, start),
            concentration_south: concentration.here(next),
            sediment: sediment.here_mut(y),
        }
        .run(self.arch);
    }
}

//! One step of Han 2015 as a stream of rows: flux, limiter, transport, water, velocity, settling, thermal.
//!
//! Y.-D. Han, "Creation of Natural Terrain by Erosion Simulation", J. Korea Game Society 15(6), 171–182,
//! 2015, doi 10.7583/JKGS.2015.15.6.171. State: change of the ground, depth, sediment, one signed flux an
//! edge. Lengths are in cells and time in steps. What differs from the source: the limiter (see
//! [`super::pipes`]); ground as start plus change (see [`super::settling`]); and the transport by
//! semi-Lagrangian or MacCormack advection, which the source does not have, follows the settling as in
//! Mei et al. 2007.

use pulp::Arch;

use super::advection::{Advection, AdvectionRows, AdvectionScratch};
use super::links::Links;
use super::pipes::{Drain, Flux, Limit, Overfall, Scale, Surface, Unlimited};
use super::settling::{CellVelocity, FaceVelocities, SettleByDissolution, SettleByVelocity};
use super::simulation::Part;
use super::sums;
use super::thermal::{Slide, SlideRows, SlideScratch};
use super::upwind::Upwind;
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
    /// Flux through the eastern edge.
    pub(crate) const EAST: usize = 3;
    /// Flux through the southern edge.
    pub(crate) const SOUTH: usize = 4;
    /// Number of state planes.
    pub(crate) const COUNT: usize = 5;
}

/// Mean fluxes through the eastern and southern edge of each cell.
pub(crate) const MEAN_FLUXES: &[&[Part]] = &[
    &[Part { plane: plane::EAST, factor: 1.0, from: [0, 0] }],
    &[Part { plane: plane::SOUTH, factor: 1.0, from: [0, 0] }],
];

/// How sediment is taken up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Law {
    /// By the speed of the water.
    Velocity,
    /// By its free capacity.
    Dissolution,
}

/// Constants of the method, in cells and steps; names as in the recipe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HanConstants {
    pub(crate) flow_rate: f32,
    pub(crate) capacity: f32,
    pub(crate) erosion: f32,
    pub(crate) deposit_ratio: f32,
    pub(crate) epsilon: f32,
    pub(crate) velocity_epsilon: f32,
    pub(crate) limiter: bool,
    pub(crate) law: Law,
}

/// Rain and evaporation of one step, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sky {
    pub(crate) rain: f32,
    pub(crate) evaporation: f32,
}

/// The process.
pub(crate) struct Han {
    pub(crate) constants: HanConstants,
    pub(crate) links: Links,
    /// Whether water falls into cells without data.
    pub(crate) open: bool,
    /// Advection by velocity instead of upwind fluxes.
    pub(crate) advection: Option<Advection>,
    pub(crate) slide: Option<Slide>,
    pub(crate) arch: Arch,
}

/// Rows in flight within one step.
pub(crate) struct HanScratch {
    ground: Ring,
    surface: Ring,
    wanted_east: Ring,
    wanted_south: Ring,
    sine_east: Ring,
    sine_south: Ring,
    share: Ring,
    concentration: Ring,
    found: Ring,
    face_east: Ring,
    face_south: Ring,
    settled_change: Ring,
    settled_sediment: Ring,
    eastward: Ring,
    southward: Ring,
    slide: SlideScratch,
    advection: AdvectionScratch,
    /// Rows for the sums.
    tally: [Ring; 2],
    /// The row beyond a wall: nothing flows, nothing stands there.
    still: Ring,
}

/// Stages behind the newest row.
const LIMITED: usize = 1;
const FLOWED: usize = 2;
const SETTLED: usize = 3;

impl Process for Han {
    type Weather = Sky;
    type Scratch = HanScratch;

    fn state_planes(&self) -> usize {
        plane::COUNT
    }

    fn constant_planes(&self) -> usize {
        1 + self.links.planes()
    }

    fn lag(&self) -> usize {
        let slide = self.slide.map_or(0, Slide::lag);
        let advection = self.advection.map_or(0, Advection::lag);
        SETTLED + slide.max(advection)
    }

    fn reach(&self) -> usize {
        self.lag() + 1
    }

    fn scratch(&self, columns: usize) -> HanScratch {
        // As many rows as lie between the stage that writes one and the last that reads it, and no more: what
        // is in flight should stay in the second-level cache.
        let ring = |depth| Ring::new(columns, depth);
        HanScratch {
            ground: ring(2),
            surface: ring(2),
            wanted_east: ring(2),
            wanted_south: ring(2),
            sine_east: ring(3),
            sine_south: ring(4),
            share: ring(2),
            concentration: ring(3),
            found: ring(2),
            face_east: ring(1),
            face_south: ring(2),
            settled_change: ring(3),
            settled_sediment: ring(4),
            eastward: ring(3),
            southward: ring(3),
            slide: SlideScratch::new(columns),
            advection: AdvectionScratch::new(columns),
            tally: [Ring::new(columns, 1), Ring::new(columns, 1)],
            still: Ring::new(columns, 1),
        }
    }

    fn advance(&self, flow: &mut Flow<'_, Self>) {
        if let Some(y) = flow.behind(0) {
            self.surface(flow, y);
        }
        if let Some(y) = flow.behind(LIMITED) {
            self.flux(flow, y);
            self.limit(flow, y);
        }
        if let Some(y) = flow.behind(FLOWED) {
            self.scale(flow, y);
            self.flow(flow, y);
            self.drain(flow, y);
        }
        if let Some(y) = flow.behind(SETTLED) {
            self.faces(flow, y);
            self.settle(flow, y);
        }
        self.slide(flow);
        self.advect(flow);
    }
}

impl Han {
    fn surface(&self, flow: &mut Flow<'_, Self>, y: usize) {
        Surface {
            base: flow.constants[0].here(y),
            change: flow.input[plane::CHANGE].here(y),
            depth: flow.input[plane::DEPTH].here(y),
            ground: flow.scratch.ground.here_mut(y),
            surface: flow.scratch.surface.here_mut(y),
        }
        .run(self.arch);
    }

    /// Fluxes from row `y` to its eastern and southern neighbours; nothing flows through the wall behind the
    /// last row, where no link leads on.
    fn flux(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let next = flow.next(y);
        let scratch = &mut *flow.scratch;
        let depth = &flow.input[plane::DEPTH];
        let links = self.links.row(flow.constants, y);
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
        .run(self.arch);
        if self.open {
            self.overfall(flow, y);
        }
    }

    fn overfall(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let next = flow.next(y);
        let scratch = &mut *flow.scratch;
        let depth = &flow.input[plane::DEPTH];
        let (change, land) = (&flow.input[plane::CHANGE], &flow.constants[1]);
        let edges = [
            (plane::EAST, [depth.east(y), change.east(y), land.east(y)], &mut scratch.wanted_east),
            (plane::SOUTH, [depth.here(next), change.here(next), land.here(next)], &mut scratch.wanted_south),
        ];
        for (plane, [depth_next, change_next, land_next], flux) in edges {
            Overfall {
                old: flow.input[plane].here(y),
                depth: depth.here(y),
                depth_next,
                change: change.here(y),
                change_next,
                land: land.here(y),
                land_next,
                flux: flux.here_mut(y),
                flow_rate: self.constants.flow_rate,
            }
            .run(self.arch);
        }
    }

    fn limit(&self, flow: &mut Flow<'_, Self>, y: usize) {
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
        if self.constants.limiter {
            Limit { depth, sediment, east, west, south, north, share, concentration, epsilon }.run(self.arch);
        } else {
            Unlimited { depth, sediment, east, west, south, north, share, concentration, epsilon }
                .run(self.arch);
        }
    }

    fn scale(&self, flow: &mut Flow<'_, Self>, y: usize) {
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
        .run(self.arch);
    }

    /// Moves water, and sediment with it unless it is advected later.
    fn flow(&self, flow: &mut Flow<'_, Self>, y: usize) {
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
            land: self.links.row(flow.constants, y).land,
            depth: depth.here_mut(y),
            sky: scratch.tally[0].here_mut(0),
            sediment: scratch.found.here_mut(y),
            rain: flow.weather.rain,
            evaporation: flow.weather.evaporation,
        }
        .run(self.arch);
        let which = if flow.weather.rain > 0.0 { sums::RAINED } else { sums::EVAPORATED };
        flow.sums.add(y, which, scratch.tally[0].here(0));
        if self.advection.is_some() {
            scratch.found.here_mut(y).copy_from_slice(flow.input[plane::SEDIMENT].here(y));
        }
    }

    fn drain(&self, flow: &mut Flow<'_, Self>, y: usize) {
        if !self.open {
            return;
        }
        let [water_out, sediment_out] = &mut flow.scratch.tally;
        Drain {
            land: self.links.row(flow.constants, y).land,
            depth: flow.output[plane::DEPTH].here_mut(y),
            sediment: flow.scratch.found.here_mut(y),
            water_out: water_out.here_mut(0),
            sediment_out: sediment_out.here_mut(0),
        }
        .run(self.arch);
        flow.sums.add(y, sums::WATER_OUT, water_out.here(0));
        flow.sums.add(y, sums::SEDIMENT_OUT, sediment_out.here(0));
    }

    fn faces(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let depth = &flow.output[plane::DEPTH];
        FaceVelocities {
            flux_east: flow.output[plane::EAST].here(y),
            flux_south: flow.output[plane::SOUTH].here(y),
            depth: depth.here(y),
            depth_east: depth.east(y),
            depth_south: depth.here(flow.next(y)),
            east: flow.scratch.face_east.here_mut(y),
            south: flow.scratch.face_south.here_mut(y),
            velocity_epsilon: self.constants.velocity_epsilon,
        }
        .run(self.arch);
    }

    fn settle(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let scratch = &mut *flow.scratch;
        let start = flow.span.start;
        let [change_out, depth, sediment_out, ..] = flow.output else { unreachable!("five state planes") };
        let change = if self.slide.is_some() { &mut scratch.settled_change } else { change_out };
        let sediment = if self.advection.is_some() { &mut scratch.settled_sediment } else { sediment_out };
        let links = self.links.row(flow.constants, y);
        let arguments = (
            before(&scratch.face_south, &scratch.still, y, start),
            before(&scratch.sine_south, &scratch.still, y, start),
        );
        macro_rules! settle {
            ($Law:ident) => {
                $Law {
                    found: scratch.found.here(y),
                    depth: depth.here(y),
                    change_before: flow.input[plane::CHANGE].here(y),
                    face_east: scratch.face_east.here(y),
                    face_west: scratch.face_east.west(y),
                    face_south: scratch.face_south.here(y),
                    face_north: arguments.0,
                    sine_east: scratch.sine_east.here(y),
                    sine_west: scratch.sine_east.west(y),
                    sine_south: scratch.sine_south.here(y),
                    sine_north: arguments.1,
                    neighbour_share: links.neighbour_share,
                    yields: links.yields,
                    change: change.here_mut(y),
                    sediment: sediment.here_mut(y),
                    lost: scratch.tally[0].here_mut(0),
                    capacity: self.constants.capacity,
                    erosion: self.constants.erosion,
                    deposit_ratio: self.constants.deposit_ratio,
                }
                .run(self.arch)
            };
        }
        match self.constants.law {
            Law::Velocity => settle!(SettleByVelocity),
            Law::Dissolution => settle!(SettleByDissolution),
        }
        if self.constants.deposit_ratio < 1.0 {
            flow.sums.add(y, sums::SHRUNK, scratch.tally[0].here(0));
        }
    }

    fn slide(&self, flow: &mut Flow<'_, Self>) {
        let Some(slide) = self.slide else { return };
        slide.advance(
            &SlideRows {
                base: &flow.constants[0],
                change: &flow.scratch.settled_change,
                links: &self.links,
                constants: flow.constants,
                newest: flow.y.checked_sub(SETTLED),
                span: flow.span.clone(),
                arch: self.arch,
            },
            &mut flow.scratch.slide,
            &mut flow.output[plane::CHANGE],
        );
    }

    fn advect(&self, flow: &mut Flow<'_, Self>) {
        let Some(advection) = self.advection else { return };
        let scratch = &mut *flow.scratch;
        let newest = flow.y.checked_sub(SETTLED);
        if let Some(y) = newest.filter(|y| flow.span.contains(y)) {
            CellVelocity {
                east: scratch.face_east.here(y),
                west: scratch.face_east.west(y),
                south: scratch.face_south.here(y),
                north: before(&scratch.face_south, &scratch.still, y, flow.span.start),
                eastward: scratch.eastward.here_mut(y),
                southward: scratch.southward.here_mut(y),
            }
            .run(self.arch);
        }
        advection.advance(
            &AdvectionRows {
                sediment: &scratch.settled_sediment,
                eastward: &scratch.eastward,
                southward: &scratch.southward,
                links: &self.links,
                constants: flow.constants,
                newest,
                span: flow.span.clone(),
                arch: self.arch,
            },
            &mut scratch.advection,
            &mut flow.output[plane::SEDIMENT],
        );
    }
}

/// The row before `y`, or the still row beyond the wall.
pub(super) fn before<'a>(ring: &'a Ring, still: &'a Ring, y: usize, start: usize) -> &'a [f32] {
    if y > start { ring.here(y - 1) } else { still.here(0) }
}

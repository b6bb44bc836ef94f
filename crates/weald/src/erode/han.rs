//! One step of Han 2015 as a stream of rows: flux, limiter, transport, water, velocity, settling, thermal.
//!
//! Y.-D. Han, "Creation of Natural Terrain by Erosion Simulation", J. Korea Game Society 15(6), 171–182,
//! 2015, doi 10.7583/JKGS.2015.15.6.171. State: change of the ground, depth, sediment, one signed flux an
//! edge. Lengths are in cells and time in steps. What differs from the source: the limiter (see
//! [`super::pipes`]); ground as start plus change (see [`super::settling`]); and the transport by
//! semi-Lagrangian or MacCormack advection, which the source does not have, follows the settling as in
//! Mei et al. 2007.

mod sediment;
mod water;

use pulp::Arch;

use super::advection::{Advection, AdvectionScratch};
use super::links::Links;
use super::simulation::{Part, Sky};
use super::thermal::{Slide, SlideScratch};
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

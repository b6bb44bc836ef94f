//! One step of Han 2015 as a stream of rows: flux, limiter, transport, water, velocity, settling, thermal.
//!
//! Y.-D. Han, "Creation of Natural Terrain by Erosion Simulation", J. Korea Game Society 15(6), 171–182,
//! 2015, doi 10.7583/JKGS.2015.15.6.171. State: change of the ground, depth, sediment, one signed flux an
//! edge. Lengths are in cells and time in steps. What differs from the source: the limiter (see
//! [`super::pipes`]); ground as start plus change (see [`super::settling`]); and the transport by
//! semi-Lagrangian or MacCormack advection, which the source does not have, follows the settling as in
//! Mei et al. 2007.

mod program;
mod sediment;
mod water;

use super::setting::{Setting, Settled};
use super::springs::Forcing;
use weald_core::grid::Size;
use weald_engine::machine::{Means, Part};
use weald_engine::program::Program;
use weald_engine::stencil::chain::{Flow, Process};
use weald_engine::stencil::ring::Ring;
use weald_engine::uniform;

/// Planes of the state.
pub(crate) mod plane {
    pub(crate) use crate::erode::water_planes::{CHANGE, DEPTH, SEDIMENT};
    /// Flux through the eastern edge.
    pub(crate) const EAST: usize = 3;
    /// Flux through the southern edge.
    pub(crate) const SOUTH: usize = 4;
    /// Number of state planes.
    pub(crate) const COUNT: usize = 5;
}

/// Mean fluxes through the eastern and southern edge of each cell.
pub(crate) const MEAN_FLUXES: Means<'static> = &[
    &[Part { plane: plane::EAST, factor: 1.0, from: [0, 0] }],
    &[Part { plane: plane::SOUTH, factor: 1.0, from: [0, 0] }],
];

uniform! {
    /// Constants of the method, in cells and steps; names as in the recipe.
    pub(crate) struct HanConstants {
        pub(crate) flow_rate: f32,
        pub(crate) capacity: f32,
        /// Uptake a unit of speed.
        pub(crate) uptake_by_speed: f32,
        /// Share of the unused transport capacity that is taken up.
        pub(crate) uptake_by_capacity: f32,
        pub(crate) deposit_ratio: f32,
        pub(crate) epsilon: f32,
        pub(crate) velocity_epsilon: f32,
    }
}

/// The process.
pub(crate) struct Han {
    pub(crate) constants: HanConstants,
    /// Whether outflows are scaled to what their cell has.
    pub(crate) limiter: bool,
    pub(crate) setting: Setting,
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
    settled: Settled,
    /// Rows for the sums.
    tally: [Ring; 2],
    /// The row beyond a wall: nothing flows, nothing stands there.
    still: Ring,
}

/// Stages behind the newest row.
// Each needs the row south of its own from the one before: fluxes its surface, flows the share that it can
// give, and velocities its depth.
const LIMITED: usize = 1;
const FLOWED: usize = 2;
const SETTLED: usize = 3;

impl Process for Han {
    type Weather = Forcing;
    type Scratch = HanScratch;

    fn state_planes(&self) -> usize {
        plane::COUNT
    }

    fn constant_planes(&self) -> usize {
        self.setting.constant_planes()
    }

    fn lag(&self) -> usize {
        SETTLED + self.setting.lag(0)
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
            settled: Settled::new(columns, self.setting.slide.as_ref()),
            tally: [Ring::new(columns, 1), Ring::new(columns, 1)],
            still: Ring::still(columns),
        }
    }

    fn sized(&self, size: Size) -> Self {
        Self { setting: self.setting.sized(size), ..*self }
    }

    fn program(&self) -> Program {
        self.passes()
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
            self.setting.drain(flow, y, |scratch| (&mut scratch.found, &mut scratch.tally));
        }
        if let Some(y) = flow.behind(SETTLED) {
            self.faces(flow, y);
            self.settle(flow, y);
            if self.setting.in_flux_form() {
                Self::fluxes(flow, y);
            } else if self.setting.advection.is_some() {
                self.cell_velocity(flow, y);
            }
        }
        let settled = flow.y.checked_sub(SETTLED);
        self.setting.slide(flow, settled);
        self.setting.advect(flow, settled);
    }
}

impl AsMut<Settled> for HanScratch {
    fn as_mut(&mut self) -> &mut Settled {
        &mut self.settled
    }
}

//! One step of Mei, Decaudin, Hu 2007 as a stream of rows: rain, outflow, water, velocity, exchange,
//! transport, evaporation, thermal.
//!
//! "Fast Hydraulic Erosion Simulation and Visualization on GPU", Pacific Graphics 2007, doi
//! 10.1109/PG.2007.15. State: change of the ground, depth, sediment, four outflows a cell. Lengths are in
//! cells and time in steps, so that `k = dt² g A / l` is the flow rate. What differs from the source:
//! transport is upwind by default, with the fluxes and the depth before them, so that no sediment is lost
//! (`semi-lagrangian` gives the source's); exchange constants are per step; ground is kept as start plus
//! change (see [`super::settling`]); the slope is the mean sine to the four neighbours, which a ridge and a channel
//! have too, unless `slope` asks for the tilt by central differences.

pub(crate) mod kernels;
mod program;
mod sediment;
mod water;

use super::setting::{Setting, Settled};
use super::springs::Forcing;
use super::water_planes as plane;
use weald_core::choices;
use weald_core::grid::Size;
use weald_engine::machine::{Means, Part};
use weald_engine::program::Program;
use weald_engine::stencil::chain::{Flow, Process};
use weald_engine::stencil::ring::Ring;
use weald_engine::uniform;

/// Mean fluxes through the eastern and southern edge of each cell: what it gives, less what its neighbour gives
/// back.
pub(crate) const MEAN_FLUXES: Means<'static> = &[
    &[
        Part { plane: plane::EAST, factor: 1.0, from: [0, 0] },
        Part { plane: plane::WEST, factor: -1.0, from: [1, 0] },
    ],
    &[
        Part { plane: plane::SOUTH, factor: 1.0, from: [0, 0] },
        Part { plane: plane::NORTH, factor: -1.0, from: [0, 1] },
    ],
];

choices! {
    /// The slope that counts for the transport capacity.
    pub enum Slope {
        /// Mean sine of the slopes to the neighbours. Ridges and beds of channels are steep by it.
        MeanSine = "mean-sine",
        /// Sine of the tilt by central differences: of a plane exactly its own, in every direction.
        Central = "central",
    }
}

uniform! {
    /// Constants of the method, in cells and steps; names as in the recipe.
    pub(crate) struct MeiConstants {
        pub(crate) flow_rate: f32,
        pub(crate) capacity: f32,
        pub(crate) erosion: f32,
        pub(crate) deposition: f32,
        pub(crate) deposit_ratio: f32,
        pub(crate) epsilon: f32,
        pub(crate) velocity_epsilon: f32,
    }
}

/// The process.
pub(crate) struct Mei {
    pub(crate) constants: MeiConstants,
    /// Whether outflows are scaled to what their cell has.
    pub(crate) limiter: bool,
    pub(crate) slope: Slope,
    pub(crate) setting: Setting,
}

/// Rows in flight within one step.
pub(crate) struct MeiScratch {
    rained: Ring,
    ground: Ring,
    surface: Ring,
    sine_east: Ring,
    sine_south: Ring,
    tilt: Ring,
    concentration: Ring,
    settled: Settled,
    tally: [Ring; 2],
    still: Ring,
}

const FLUX: usize = 1;
const EXCHANGED: usize = 2;

impl Process for Mei {
    type Weather = Forcing;
    type Scratch = MeiScratch;

    fn state_planes(&self) -> usize {
        plane::COUNT
    }

    fn constant_planes(&self) -> usize {
        self.setting.constant_planes()
    }

    fn lag(&self) -> usize {
        EXCHANGED + self.setting.lag(1)
    }

    fn scratch(&self, columns: usize) -> MeiScratch {
        let ring = |depth| Ring::new(columns, depth);
        MeiScratch {
            rained: ring(3),
            ground: ring(4),
            surface: ring(3),
            sine_east: ring(2),
            sine_south: ring(3),
            tilt: ring(1),
            concentration: ring(3),
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
            self.rain(flow, y);
        }
        if let Some(y) = flow.behind(FLUX) {
            self.outflow(flow, y);
            if self.slope == Slope::MeanSine {
                self.sines(flow, y);
            }
        }
        if let Some(y) = flow.behind(EXCHANGED) {
            self.tilt(flow, y);
            self.exchange(flow, y);
            // Their sediment came with the transport of the step before.
            self.setting.drain(flow, y, |scratch| (&mut scratch.settled.sediment, &mut scratch.tally));
            if self.setting.in_flux_form() {
                self.fluxes(flow, y);
            } else if self.setting.advection.is_none() {
                self.load(flow, y);
            }
        }
        let settled = flow.y.checked_sub(EXCHANGED);
        self.setting.slide(flow, settled);
        self.setting.advect(flow, settled);
        if self.setting.advection.is_none()
            && let Some(y) = flow.behind(EXCHANGED + 1)
        {
            self.carry(flow, y);
        }
    }
}

impl AsMut<Settled> for MeiScratch {
    fn as_mut(&mut self) -> &mut Settled {
        &mut self.settled
    }
}

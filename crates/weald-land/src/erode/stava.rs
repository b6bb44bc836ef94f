//! One step of Šťava, Beneš, Brisbin, Křivánek 2008 as a stream of rows: weather, water, velocity, force-based
//! erosion of stacked materials, transport, dissolution, flow of regolith, slippage.
//!
//! "Interactive Terrain Modeling Using Hydraulic Erosion", Symposium on Computer Animation 2008, doi
//! 10.2312/SCA/SCA08/201-210. Ground is a column of materials, bedrock first; water takes from the top down what
//! each material yields, and lays down one that the user names. Lengths are in cells and time in steps, so that
//! `k = dt² g A / l` is the flow rate. What differs from the source: walls do not clone their neighbours, so that
//! nothing is lost there; MacCormack transport has a conserving form, for the same reason; the bedrock is kept as
//! start plus change, which has the digits of a small change on a high mountain; what settles is the material that
//! the recipe names, whatever was taken before; drains take what is suspended in their water. Each process has its own
//! file and can be left out.

pub(crate) mod digging;
pub(crate) mod dissolution;
mod force;
pub(crate) mod program;
pub(crate) mod slippage;
mod transport;
pub(crate) mod viscosity;
mod water;
mod weather;

use super::material_planes::{Planes, WEATHER_PLANES};
use super::water_planes as plane;
use digging::{DigScratch, Digging};
use dissolution::{Dissolution, DissolutionScratch, RegolithRows};
use slippage::Slippage;
use viscosity::{Viscosity, ViscosityRows, ViscosityScratch};

use super::pipeline::{PipelineOutput, PipelineRows, PipelineScratch};
use super::setting::{Setting, Settled};
use super::springs::Forcing;
use weald_core::grid::Size;
use weald_engine::program::Program;
use weald_engine::stencil::chain::{Flow, Process};
use weald_engine::stencil::ring::Ring;

/// Constants of the method, in cells and steps; names as in the recipe.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StavaConstants {
    pub(crate) flow_rate: f32,
    pub(crate) capacity: f32,
    pub(crate) epsilon: f32,
    pub(crate) velocity_epsilon: f32,
}

/// The process.
pub(crate) struct Stava {
    pub(crate) constants: StavaConstants,
    pub(crate) planes: Planes,
    /// Whether [`WEATHER_PLANES`] say where it rains and springs.
    pub(crate) painted: bool,
    pub(crate) viscosity: Option<Viscosity>,
    /// What the force of the water takes and lays down.
    pub(crate) erosion: Digging,
    pub(crate) dissolution: Option<Dissolution>,
    pub(crate) slippage: Option<Slippage>,
    pub(crate) setting: Setting,
}

/// Rows in flight within one step.
pub(crate) struct StavaScratch {
    rained: Ring,
    /// Sediment that drains left, where there may be any.
    found: Ring,
    ground: Ring,
    surface: Ring,
    sine_east: Ring,
    sine_south: Ring,
    /// Velocity before diffusion, where there is any.
    eastward: Ring,
    southward: Ring,
    viscosity: ViscosityScratch,
    concentration: Ring,
    settled: Settled,
    /// The materials after erosion and dissolution, before slippage.
    solid: Vec<Ring>,
    dig: DigScratch,
    dissolution: DissolutionScratch,
    slippage: Option<PipelineScratch>,
    tally: [Ring; 2],
    ones: Ring,
    still: Ring,
}

const FLUX: usize = 1;
const MOVED: usize = 2;

impl Stava {
    /// Rows by which the exchange with the ground lies behind the input.
    fn exchanged(&self) -> usize {
        MOVED + self.viscosity.map_or(0, |_| Viscosity::LAG)
    }
}

impl Process for Stava {
    type Weather = Forcing;
    type Scratch = StavaScratch;

    fn state_planes(&self) -> usize {
        self.planes.count()
    }

    fn constant_planes(&self) -> usize {
        self.setting.constant_planes() + if self.painted { WEATHER_PLANES } else { 0 }
    }

    fn lag(&self) -> usize {
        let dissolution = self.dissolution.as_ref().map_or(0, |_| Dissolution::LAG);
        let slippage = self.slippage.as_ref().map_or(0, |slippage| slippage.pipeline.lag());
        self.exchanged() + self.setting.lag(1).max(dissolution).max(slippage)
    }

    fn scratch(&self, columns: usize) -> StavaScratch {
        let ring = |depth| Ring::new(columns, depth);
        let looked_back = self.exchanged() + 1;
        let mut ones = ring(1);
        ones.here_mut(0).fill(1.0);
        StavaScratch {
            rained: ring(looked_back),
            found: ring(if self.painted { looked_back } else { 1 }),
            ground: ring(2),
            surface: ring(3),
            sine_east: ring(looked_back),
            sine_south: ring(looked_back),
            eastward: ring(3),
            southward: ring(3),
            viscosity: ViscosityScratch::new(columns),
            concentration: ring(3),
            settled: Settled::new(columns, None),
            solid: (0..self.planes.materials).map(|_| ring(4)).collect(),
            dig: DigScratch::new(columns),
            dissolution: DissolutionScratch::new(columns),
            slippage: self.slippage.as_ref().map(|slippage| slippage.pipeline.scratch(columns)),
            tally: [ring(1), ring(1)],
            ones,
            still: Ring::still(columns),
        }
    }

    fn sized(&self, size: Size) -> Self {
        Self {
            erosion: self.erosion.clone(),
            dissolution: self.dissolution.clone(),
            slippage: self.slippage.clone(),
            setting: self.setting.sized(size),
            ..*self
        }
    }

    fn program(&self) -> Program {
        self.passes()
    }

    fn advance(&self, flow: &mut Flow<'_, Self>) {
        if let Some(y) = flow.behind(0) {
            self.weather(flow, y);
            self.drain(flow, y);
            self.surface(flow, y);
        }
        if let Some(y) = flow.behind(FLUX) {
            self.outflow(flow, y);
            self.sines(flow, y);
        }
        if let Some(y) = flow.behind(MOVED) {
            self.moved(flow, y);
        }
        self.diffuse(flow);
        if let Some(y) = flow.behind(self.exchanged()) {
            self.erode(flow, y);
            self.dissolve(flow, y);
            // Their sediment came with the transport of the step before.
            self.setting.drain(flow, y, |scratch| (&mut scratch.settled.sediment, &mut scratch.tally));
        }
        self.transport(flow);
        self.creep(flow);
        self.slip(flow);
    }
}

impl Stava {
    fn diffuse(&self, flow: &mut Flow<'_, Self>) {
        let Some(viscosity) = self.viscosity else { return };
        let sweep = self.setting.sweep(flow, flow.y.checked_sub(MOVED));
        let StavaScratch { eastward, southward, viscosity: scratch, settled, .. } = &mut *flow.scratch;
        viscosity.advance(
            &ViscosityRows { velocity: [eastward, southward], sweep },
            scratch,
            [&mut settled.eastward, &mut settled.southward],
        );
    }

    fn dissolve(&self, flow: &mut Flow<'_, Self>, y: usize) {
        let Some(dissolution) = &self.dissolution else { return };
        let sweep = self.setting.sweep(flow, Some(y));
        let scratch = &mut *flow.scratch;
        dissolution.dissolve(
            &RegolithRows {
                depth: &flow.output[plane::DEPTH],
                before: &flow.input[dissolution.plane..],
                base: &flow.constants[0],
                sweep,
            },
            y,
            &mut scratch.solid,
            (&mut scratch.dissolution, &mut scratch.dig),
        );
    }

    fn creep(&self, flow: &mut Flow<'_, Self>) {
        let Some(dissolution) = &self.dissolution else { return };
        let sweep = self.setting.sweep(flow, flow.y.checked_sub(self.exchanged()));
        let (before, after) = flow.output.split_at_mut(dissolution.plane);
        let rows = RegolithRows {
            depth: &before[plane::DEPTH],
            before: &flow.input[dissolution.plane..],
            base: &flow.constants[0],
            sweep,
        };
        dissolution.creep(&rows, &flow.scratch.dissolution, after);
    }

    /// Slippage, or the materials as they are where there is none.
    fn slip(&self, flow: &mut Flow<'_, Self>) {
        let newest = flow.y.checked_sub(self.exchanged());
        let sweep = self.setting.sweep(flow, newest);
        let StavaScratch { solid, slippage: scratch, .. } = &mut *flow.scratch;
        let (Some(slippage), Some(scratch)) = (&self.slippage, scratch) else {
            if let Some(y) = newest.filter(|y| flow.span.contains(y)) {
                self.planes.copy(solid, flow.output, y);
            }
            return;
        };
        let rows = PipelineRows { input: solid, sweep: &sweep, weather: &[] };
        let mut output = PipelineOutput { planes: flow.output, tally: &mut |_, _, _| {} };
        slippage.pipeline.advance(&rows, scratch, &mut output);
    }
}

impl AsMut<Settled> for StavaScratch {
    fn as_mut(&mut self) -> &mut Settled {
        &mut self.settled
    }
}

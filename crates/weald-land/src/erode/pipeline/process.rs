//! A pipeline as a process of its own.

use std::marker::PhantomData;
use std::sync::Arc;

use pulp::Arch;

use super::PipelineScratch;
use super::parts::Pipeline;
use crate::erode::links::Links;
use crate::erode::pipeline::running::{PipelineOutput, PipelineRows};
use crate::erode::sweep::Sweep;
use weald_core::grid::Size;
use weald_engine::program::Program;
use weald_engine::stencil::chain::{Flow, Process};
use weald_engine::uniform::{FromWords, Uniform};

/// A process that is one pipeline, with weather of this kind.
pub(crate) struct Stepped<W = ()> {
    pipeline: Arc<Pipeline>,
    program: Arc<Program>,
    links: Links,
    arch: Arch,
    weather: PhantomData<fn() -> W>,
}

impl<W> Stepped<W> {
    /// A pipeline over a domain of that size.
    pub(crate) fn new(name: &'static str, pipeline: &Arc<Pipeline>, (size, masked): (Size, bool)) -> Self {
        let program = pipeline.program(name, masked);
        Self::with_program(pipeline, (size, masked), program)
    }

    /// The same with a program of its own making.
    pub(crate) fn with_program(
        pipeline: &Arc<Pipeline>,
        (size, masked): (Size, bool),
        program: Program,
    ) -> Self {
        let links = Links::new(size, masked);
        Self {
            pipeline: Arc::clone(pipeline),
            program: Arc::new(program),
            links,
            arch: Arch::new(),
            weather: PhantomData,
        }
    }

    /// Names of the state planes.
    pub(crate) fn state_names(&self) -> Vec<String> {
        self.pipeline.state_names()
    }
}

impl<W: Uniform + FromWords + Copy + Send + Sync + 'static> Process for Stepped<W> {
    type Weather = W;
    type Scratch = PipelineScratch;

    fn state_planes(&self) -> usize {
        self.pipeline.state.len()
    }

    fn constant_planes(&self) -> usize {
        self.pipeline.constants.len() + self.links.planes()
    }

    fn lag(&self) -> usize {
        self.pipeline.lag()
    }

    fn look_back(&self) -> usize {
        self.pipeline.look_back()
    }

    fn begins(&self) -> usize {
        self.pipeline.begins()
    }

    fn reach(&self) -> usize {
        self.pipeline.reach()
    }

    fn scratch(&self, columns: usize) -> PipelineScratch {
        self.pipeline.scratch(columns)
    }

    fn sized(&self, size: Size) -> Self {
        Self {
            pipeline: Arc::clone(&self.pipeline),
            program: Arc::clone(&self.program),
            links: self.links.sized(size),
            arch: self.arch,
            weather: PhantomData,
        }
    }

    fn program(&self) -> Program {
        (*self.program).clone()
    }

    fn advance(&self, flow: &mut Flow<'_, Self>) {
        let sweep = Sweep::of(flow, &self.links, self.arch, Some(flow.y));
        let weather: Vec<_> = flow.weather.words().into_iter().map(f32::from_bits).collect();
        let rows = PipelineRows { input: flow.input, sweep: &sweep, weather: &weather };
        let sums = &mut *flow.sums;
        let tally = &mut |y, sum, cells: &[f32]| sums.add(y, sum, cells);
        self.pipeline.advance(&rows, flow.scratch, &mut PipelineOutput { planes: flow.output, tally });
    }
}

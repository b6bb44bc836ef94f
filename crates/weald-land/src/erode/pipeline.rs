//! A process as its kernels in their order. How many rows the result lies behind the input, how many rows of each
//! plane must be in memory and how far a cell feels others all follow from the names of the rows that the kernels
//! read and write.
//!
//! A kernel that reads `ground_south` reads the row `ground` of the cells to the south, so it can run for a row
//! once the next row of `ground` is there: one row behind the kernel that writes `ground`. Beyond a wall all rows
//! read 0, and no link leads there.

mod parts;
mod process;
mod program;
mod running;
mod schedule;
mod source;
#[cfg(test)]
mod tests;

pub(crate) use process::Stepped;
pub(crate) use running::{PipelineOutput, PipelineRows, PipelineScratch};

use std::sync::Arc;

pub(crate) use parts::Pipeline;
use parts::{State, Twin};
use schedule::Rows;
use weald_engine::program::Uniforms;
use weald_engine::stencil::kernel::RowKernel;
use weald_engine::uniform::Uniform;

/// Most rows that a kernel reads.
const MAX_READS: usize = 32;

/// Most rows that a kernel changes.
const MAX_CHANGES: usize = 16;

/// Most numbers that a kernel knows.
const MAX_CONSTANTS: usize = 16;

/// Equations in the making: planes and kernels by their names.
#[derive(Clone, Debug)]
pub(crate) struct Equations {
    pipeline: Pipeline,
    /// Numbers that kernels find by their names; of those with the same name the last.
    numbers: Vec<(&'static str, f32)>,
}

impl Equations {
    /// Equations without kernels. `constants` are planes that stay, of which the first comes before the planes of
    /// a mask; `state` are planes that change, each with a name before and one after the step; kernels find their
    /// constants among the fields of `numbers`.
    pub(crate) fn new<U: Uniform>(
        constants: &[&'static str],
        state: &[(&'static str, &'static str)],
        numbers: &U,
    ) -> Self {
        let uniforms = Uniforms::of(numbers);
        // Vectors stand before all numbers.
        let numbers = uniforms.fields.iter().rev().zip(uniforms.words.iter().rev());
        let numbers = numbers.take_while(|((_, kind), _)| !kind.contains("vec4"));
        let numbers = numbers.map(|((name, _), &word)| (*name, f32::from_bits(word))).collect();
        let pipeline = Pipeline {
            uniforms,
            constants: constants.to_vec(),
            state: state.iter().map(|&(before, after)| State { before, after }).collect(),
            planes: Vec::new(),
            stages: Vec::new(),
            leaves: Vec::new(),
            look_back: 0,
            weather: Vec::new(),
            twin: Twin::default(),
        };
        Self { pipeline, numbers }
    }

    /// A number for the kernels that follow.
    pub(crate) fn number(&mut self, name: &'static str, value: f32) -> &mut Self {
        self.numbers.push((name, value));
        self
    }

    /// Adds a kernel, the rows of which bear the names of planes. A neighbour's row has its direction behind the
    /// plane's name: `ground_south`, `ground_north_east`. What a kernel writes is a new plane, which hides an older
    /// one of the same name from the kernels that follow.
    pub(crate) fn kernel<K: RowKernel>(&mut self) -> &mut Self {
        self.kernel_on::<K>(&[])
    }

    /// Adds a kernel, some rows of which have other names than the planes: pairs of a row and its plane.
    pub(crate) fn kernel_on<K: RowKernel>(&mut self, renamed: &[(&str, &'static str)]) -> &mut Self {
        for (row, _) in renamed {
            let mut rows = [K::READS, K::UPDATES, K::WRITES].into_iter().flatten();
            assert!(rows.any(|name| name == row), "the kernel `{}` has no row `{row}`", K::NAME);
        }
        let plane = |row: &&'static str| {
            renamed.iter().find(|(name, _)| name == row).map_or(*row, |&(_, plane)| plane)
        };
        let pipeline = &mut self.pipeline;
        let find = |row| pipeline.find(row, K::NAME);
        let reads: Vec<_> = K::READS.iter().map(plane).map(find).collect();
        let updates: Vec<_> = K::UPDATES.iter().map(plane).map(find).collect();
        let forced = K::CONSTANTS.iter().enumerate();
        let forced = forced.filter_map(|(at, name)| Some((at, pipeline.forced(name)?))).collect();
        let number = |constant: &&str| {
            let found = self.numbers.iter().rev().find(|(name, _)| name == constant);
            let found = found.map(|(_, number)| *number).or(pipeline.forced(constant).map(|_| 0.0));
            found.unwrap_or_else(|| panic!("no number `{constant}` for the kernel `{}`", K::NAME))
        };
        let constants = K::CONSTANTS.iter().map(number).collect();
        let changes: Vec<_> = K::UPDATES.iter().chain(K::WRITES).map(plane).collect();
        assert!(reads.len() <= MAX_READS && changes.len() <= MAX_CHANGES, "`{}` has too many rows", K::NAME);
        assert!(K::CONSTANTS.len() <= MAX_CONSTANTS, "`{}` has too many numbers", K::NAME);
        pipeline.add(K::run_on, Rows { reads, updates, changes }, (constants, forced));
        self
    }

    /// Says which numbers differ from step to step. Kernels find them by their names, as they find constants.
    pub(crate) fn weather<U: Uniform>(&mut self, weather: &U) -> &mut Self {
        self.pipeline.weather = Uniforms::of(weather).fields.iter().map(|(name, _)| *name).collect();
        self
    }

    /// Sums a row that the latest kernel changes, over all cells and steps.
    pub(crate) fn tally(&mut self, plane: &str, sum: usize) -> &mut Self {
        let stage = self.pipeline.stages.last_mut().expect("a kernel");
        let changed = &self.pipeline.planes[stage.first..][..stage.changes];
        let row = changed.iter().position(|changed| changed.name == plane);
        stage
            .tallies
            .push((row.unwrap_or_else(|| panic!("the latest kernel does not change `{plane}`")), sum));
        self
    }

    /// Adds a pass of the twin: the function of this name in a shader, which does on a device what the kernels do on
    /// rows. Planes have their names there, as buffers; what one pass hands to another is a plane as well.
    pub(crate) fn pass(&mut self, name: &'static str, shader: &'static str) -> &mut Self {
        self.pipeline.twin.passes.push((name, shader));
        self
    }

    /// Adds a number that the shaders know when they are compiled.
    pub(crate) fn count(&mut self, name: &'static str, value: usize) -> &mut Self {
        self.pipeline.twin.counts.push((name, value));
        self
    }

    /// The pipeline.
    pub(crate) fn finish(&self) -> Arc<Pipeline> {
        let mut pipeline = self.pipeline.clone();
        for (number, state) in self.pipeline.state.iter().enumerate() {
            let written = pipeline.planes.iter().rposition(|plane| plane.name == state.after);
            let written = written.unwrap_or_else(|| panic!("no kernel writes `{}`", state.after));
            if pipeline.planes[written].oldest.is_some() {
                pipeline.leave(written, number);
            } else {
                pipeline.planes[written].output = Some(number);
            }
        }
        Arc::new(pipeline)
    }
}

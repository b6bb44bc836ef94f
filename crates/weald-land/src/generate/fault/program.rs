//! Fault formation as a compute pass: each step adds some faults to every cell.

use super::{Fault, Line};
use weald_core::grid::Size;
use weald_engine::on_device::OnDevice;
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::{Buffer, Content, Program, Uniforms};
use weald_engine::uniform;
use weald_engine::uniform::Uniform;

const FAULT: &str = include_str!("../fault.wgsl");

/// Faults of one step: few enough that a step is short, many enough that the sums of the step before cost
/// nothing beside them.
const FAULTS_PER_STEP: u32 = 64;

uniform! {
    /// What the shader has to know.
    struct FaultConstants {
        /// Number of faults.
        count: u32,
    }
}

uniform! {
    /// First row of a band of the landscape, and the faults of one step.
    struct Faults {
        first_row: u32,
        first: u32,
        end: u32,
    }
}

impl Fault {
    /// The program that adds up the steps of these lines.
    pub(super) fn sum_of_steps(&self, lines: &[Line], size: Size) -> OnDevice {
        let count = lines.len() as u32;
        let steps = move |first_row| {
            let firsts = (0..count.max(1)).step_by(FAULTS_PER_STEP as usize);
            let step = |first| Faults { first_row, first, end: (first + FAULTS_PER_STEP).min(count) };
            firsts.map(|first| step(first).words()).collect()
        };
        OnDevice {
            program: self.program(lines.len()),
            tables: vec![("lines", lines.iter().flat_map(words).collect())],
            size,
            in_bands: true,
            steps: Box::new(steps),
            result: "steps",
        }
    }

    fn program(&self, lines: usize) -> Program {
        let constants = Uniforms::of(&FaultConstants { count: self.iterations });
        let weather = Uniforms::of(&Faults { first_row: 0, first: 0, end: 0 });
        let mut draft = ProgramBuilder::new("fault", &[FAULT], constants, weather);
        draft.add(Buffer::of_words("lines", 4, Content::Table(lines)));
        draft.add(Buffer::of_words("steps", 1, Content::Scratch));
        draft.pass("fault", &[], &["lines"], &["steps"]);
        draft.finish(0)
    }
}

fn words(line: &Line) -> [u32; 4] {
    [line.start[0], line.start[1], line.along[0], line.along[1]].map(|number| number as i32 as u32)
}

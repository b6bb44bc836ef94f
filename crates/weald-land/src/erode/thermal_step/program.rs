//! Thermal weathering alone as a program.

use super::Sliding;
use crate::erode::links::plane;
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::{Content, Program, Uniforms};
use weald_engine::stencil::chain::Process;

const CONSTANTS: &str = include_str!("../thermal_step.wgsl");

impl Sliding {
    pub(super) fn passes(&self) -> Program {
        let constants = Uniforms::of(&self.slide.constants);
        let mut draft = ProgramBuilder::new("thermal", &[CONSTANTS], constants, Uniforms::default());
        let planes = self.state_planes();
        draft.buffer("base", 1, Content::Constant(vec![planes]));
        draft.buffer("settled", 1, Content::State(vec![0]));
        draft.scratch("change", 1);
        if self.links.planes() > 0 {
            draft.mask(planes + plane::VALID, planes + plane::ERODIBLE);
        }
        self.slide.add_to(&mut draft);
        draft.swap("settled", "change");
        draft.shows("settled", None);
        draft.finish(self.reach())
    }
}

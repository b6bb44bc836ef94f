//! A pipeline on a device.

use super::parts::Pipeline;
use crate::erode::links::{MASK_PLANES, plane};
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::mentions::{Mention, mention};
use weald_engine::program::{Content, Program, Uniforms};

impl Pipeline {
    /// The program: a buffer for each plane that stays, two for each that changes, which change roles after the
    /// step, and the passes of the twin.
    pub(crate) fn program(&self, name: &'static str, masked: bool) -> Program {
        let mut draft = ProgramBuilder::new(name, &[], self.uniforms.clone(), Uniforms::default());
        let planes = self.state.len();
        for (number, constant) in self.constants.iter().enumerate() {
            let masks = if masked && number > 0 { MASK_PLANES } else { 0 };
            draft.buffer(constant, 1, Content::Constant(vec![planes + masks + number]));
        }
        for (number, state) in self.state.iter().enumerate() {
            draft.buffer(state.before, 1, Content::State(vec![number]));
            draft.scratch(state.after, 1);
        }
        if masked {
            draft.mask(planes + plane::VALID, planes + plane::ERODIBLE);
        }
        self.add_to(&mut draft);
        self.state.iter().for_each(|state| draft.swap(state.before, state.after));
        if self.constants.first() == Some(&"base") {
            draft.shows(self.state[0].before, None);
        }
        draft.finish(self.reach())
    }

    /// Adds the passes to a program that has the buffers of the constants and of the state, and buffers for what
    /// one pass hands to another.
    pub(crate) fn add_to(&self, draft: &mut ProgramBuilder) {
        let state = self.state.iter().flat_map(|state| [state.before, state.after]);
        let known: Vec<_> = self.constants.iter().copied().chain(state).collect();
        let mut handed: Vec<_> = self.planes.iter().map(|plane| plane.name).collect();
        handed.sort_unstable();
        handed.dedup();
        for name in handed {
            let named = self.twin.passes.iter().any(|(_, shader)| mention(shader, name) != Mention::Never);
            if named && !known.contains(&name) {
                draft.scratch(name, 1);
            }
        }
        self.twin.counts.iter().for_each(|&(name, value)| draft.count(name, value));
        for &(name, shader) in &self.twin.passes {
            draft.pass_of(name, &[shader]);
        }
    }
}

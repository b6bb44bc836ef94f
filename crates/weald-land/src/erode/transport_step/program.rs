//! Transport alone as a program.

use super::Carrying;
use crate::erode::advection::Advection;
use crate::erode::advection_rows::Advected;
use crate::erode::links::plane;
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::{Content, Program, Uniforms};
use weald_engine::stencil::chain::Process;
use weald_engine::uniform;

const CONSTANTS: &str = include_str!("../transport_step.wgsl");
const LOAD: &str = include_str!("load.wgsl");
const VELOCITY: &str = include_str!("velocity.wgsl");
const FACES: &str = include_str!("faces.wgsl");
const ARRIVE: &str = include_str!("arrive.wgsl");

uniform! {
    /// What transport in flux form has to know.
    struct CarryConstants {
        /// Depth added where amounts are divided by depth.
        epsilon: f32,
    }
}

impl Carrying {
    pub(super) fn passes(&self) -> Program {
        let epsilon = match self.advection {
            Advection::FluxCorrected { epsilon } => Some(epsilon),
            _ => None,
        };
        let constants = Uniforms::of(&CarryConstants { epsilon: epsilon.unwrap_or(0.0) });
        let mut draft = ProgramBuilder::new("transport", &[CONSTANTS], constants, Uniforms::default());
        let planes = self.state_planes();
        let flows = planes + 1 + self.links.planes();
        draft.buffer("load", 1, Content::State(vec![0]));
        draft.scratch("load_next", 1);
        draft.buffer("water", 1, Content::Constant(vec![planes]));
        draft.buffer("flows", 2, Content::Constant(vec![flows, flows + 1]));
        if self.links.planes() > 0 {
            draft.mask(planes + plane::VALID, planes + plane::ERODIBLE);
        }
        let fluxes = epsilon.is_some();
        let model = Advected {
            from: if fluxes { &[LOAD, FACES] } else { &[LOAD, VELOCITY] },
            into: &[ARRIVE],
            reads: if fluxes { &["load", "flows", "water"] } else { &["load", "flows"] },
            keeps: &[],
            writes: "load_next",
        };
        self.advection.add_to(&mut draft, &model);
        draft.swap("load", "load_next");
        draft.finish(self.reach())
    }
}

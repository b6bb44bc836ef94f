//! A step of Han 2015 as compute passes: wanted fluxes; limiter, transport and water; velocity and settling;
//! then what the setting asks for. The shaders stand beside the kernels that they repeat.
//!
//! Depth, sediment and change of the ground are buffers of their own, so that no pass has more than eight.

use super::{Han, plane};
use crate::erode::advection_rows::Advected;
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::{Content, Program, Uniforms};
use weald_engine::stencil::chain::Process;

const CONSTANTS: &str = include_str!("../han.wgsl");
const PIPES: &str = include_str!("../pipes.wgsl");
const UPWIND: &str = include_str!("../upwind.wgsl");
const SETTLING: &str = include_str!("../settling.wgsl");
const SLOPES: &str = include_str!("../settling/slopes.wgsl");
const FLUX: &str = include_str!("flux.wgsl");
const FLOW: &str = include_str!("flow.wgsl");
const FACES: &str = include_str!("faces.wgsl");
const SETTLE: &str = include_str!("settle.wgsl");
const SETTLED: &str = include_str!("settled.wgsl");
const VELOCITY: &str = include_str!("velocity.wgsl");
const FACES_OF_FLUX: &str = include_str!("faces_of_flux.wgsl");
const ARRIVE: &str = include_str!("arrive.wgsl");
const RECORD: &str = include_str!("record.wgsl");

impl Han {
    pub(super) fn passes(&self) -> Program {
        let constants = Uniforms::of(&self.constants);
        let mut draft = self.setting.draft("han", CONSTANTS, constants, plane::COUNT);
        draft.flag("LIMITER", self.limiter);
        draft.buffer("depth", 1, Content::State(vec![plane::DEPTH]));
        draft.buffer("sediment", 1, Content::State(vec![plane::SEDIMENT]));
        draft.buffer("fluxes", 2, Content::State(vec![plane::EAST, plane::SOUTH]));
        draft.scratch("wanted", 2);
        draft.scratch("depth_next", 1);
        draft.scratch("sediment_next", 1);
        draft.buffer("means", 2, Content::Mean);
        add_water_to(&mut draft);
        self.add_sediment_to(&mut draft);
        draft.pass("record", &[RECORD], &["fluxes"], &["means"]).recorded = true;
        draft.shows("change", Some("depth"));
        draft.finish(self.reach())
    }

    fn add_sediment_to(&self, draft: &mut ProgramBuilder) {
        let shaders = [PIPES, SETTLING, SLOPES, FACES, SETTLE];
        let reads = ["base", "change", "depth_next", "fluxes"];
        let settle = draft.pass("settle", &shaders, &reads, &["settled", "sediment_next"]);
        settle.tallies = self.constants.deposit_ratio < 1.0;
        match self.setting.advection {
            None => draft.swap("sediment", "sediment_next"),
            Some(advection) => advection.add_to(draft, &self.advected()),
        }
        self.setting.add_slide_to(draft);
    }

    fn advected(&self) -> Advected<'static> {
        let fluxes = self.setting.in_flux_form();
        Advected {
            from: if fluxes { &[SETTLED, FACES_OF_FLUX] } else { &[SETTLED, SETTLING, FACES, VELOCITY] },
            into: &[ARRIVE],
            reads: if fluxes {
                &["sediment_next", "fluxes", "depth"]
            } else {
                &["sediment_next", "fluxes", "depth_next"]
            },
            keeps: &[],
            writes: "sediment",
        }
    }
}

fn add_water_to(draft: &mut ProgramBuilder) {
    draft.pass("flux", &[PIPES, FLUX], &["base", "change", "depth", "fluxes"], &["wanted"]);
    let reads = ["depth", "sediment", "wanted"];
    let writes = ["fluxes", "depth_next", "sediment_next"];
    draft.pass("flow", &[PIPES, UPWIND, FLOW], &reads, &writes).tallies = true;
    draft.swap("depth", "depth_next");
}

//! A step of Mei et al. 2007 as compute passes: rain and outflow; water, velocity and exchange; transport; then
//! what the setting asks for. The shaders stand beside the kernels that they repeat.

use super::{Mei, Slope, plane};
use crate::erode::advection::Advection;
use crate::erode::advection_rows::Advected;
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::{Content, Program, Uniforms};
use weald_engine::stencil::chain::Process;

const CONSTANTS: &str = include_str!("../mei.wgsl");
const PIPES: &str = include_str!("../pipes.wgsl");
const SLOPES: &str = include_str!("../settling/slopes.wgsl");
const FLOWS: &str = include_str!("flows.wgsl");
const KERNELS: &str = include_str!("kernels.wgsl");
const RAINED: &str = include_str!("rained.wgsl");
const FOUR_OUTFLOWS: &str = include_str!("../four_outflows.wgsl");
const OUTFLOW: &str = include_str!("outflow.wgsl");
const INFLOW: &str = include_str!("inflow.wgsl");
const EXCHANGE: &str = include_str!("exchange.wgsl");
const TRANSPORT_INPUT_LOAD: &str = include_str!("transport_input_load.wgsl");
const TRANSPORT_INPUT_DEPTH: &str = include_str!("transport_input_depth.wgsl");
const TRANSPORT_INPUT_VELOCITY: &str = include_str!("transport_input_velocity.wgsl");
const CARRY: &str = include_str!("carry.wgsl");
const SETTLED: &str = include_str!("settled.wgsl");
const VELOCITY: &str = include_str!("velocity.wgsl");
const FACES_OF_FLUX: &str = include_str!("faces_of_flux.wgsl");
const WATER_BEFORE: &str = include_str!("water_before.wgsl");
const ARRIVE: &str = include_str!("arrive.wgsl");
const RECORD: &str = include_str!("record.wgsl");

/// What a buffer of outflows holds, lane by lane.
const OUTFLOWS: [usize; 4] = [plane::EAST, plane::WEST, plane::SOUTH, plane::NORTH];

impl Mei {
    pub(super) fn passes(&self) -> Program {
        let constants = Uniforms::of(&self.constants);
        let mut draft = self.setting.draft("mei", CONSTANTS, constants, plane::COUNT);
        draft.flag("LIMITER", self.limiter);
        draft.flag("CENTRAL", self.slope == Slope::Central);
        draft.flag("SHRINKS", self.constants.deposit_ratio < 1.0);
        draft.buffer("carried", 2, Content::State(vec![plane::DEPTH, plane::SEDIMENT]));
        draft.buffer("outflows", 4, Content::State(OUTFLOWS.to_vec()));
        draft.buffer("means", 2, Content::Mean);
        let reads = ["base", "change", "carried"];
        draft
            .pass("outflow", &[PIPES, FLOWS, KERNELS, RAINED, FOUR_OUTFLOWS, OUTFLOW], &reads, &["outflows"])
            .tallies = true;
        match self.setting.advection {
            None => add_upwind_to(&mut draft),
            Some(advection) => add_advection_to(&mut draft, advection),
        }
        self.setting.add_slide_to(&mut draft);
        draft.pass("record", &[INFLOW, RECORD], &["outflows"], &["means"]).recorded = true;
        draft.shows("change", Some("carried"));
        draft.finish(self.reach())
    }
}

fn add_upwind_to(draft: &mut ProgramBuilder) {
    draft.scratch("concentration", 1);
    add_exchange_to(draft, TRANSPORT_INPUT_LOAD, "concentration");
    draft.pass(
        "carry",
        &[PIPES, FLOWS, KERNELS, INFLOW, CARRY],
        &["outflows", "concentration"],
        &["carried"],
    );
}

fn add_advection_to(draft: &mut ProgramBuilder, advection: Advection) {
    draft.scratch("carried_next", 2);
    if let Advection::FluxCorrected { .. } = advection {
        draft.scratch("rained_depth", 1);
        add_exchange_to(draft, TRANSPORT_INPUT_DEPTH, "rained_depth");
        let from = [SETTLED, INFLOW, FACES_OF_FLUX, WATER_BEFORE];
        advection.add_to(draft, &advected(&from, &["carried", "outflows", "rained_depth"]));
    } else {
        draft.scratch("velocities", 2);
        add_exchange_to(draft, TRANSPORT_INPUT_VELOCITY, "velocities");
        advection.add_to(draft, &advected(&[SETTLED, VELOCITY], &["carried", "velocities"]));
    }
    draft.swap("carried", "carried_next");
}

fn advected<'a>(from: &'a [&'static str], reads: &'a [&'a str]) -> Advected<'a> {
    Advected { from, into: &[ARRIVE], reads, keeps: &["carried"], writes: "carried_next" }
}

fn add_exchange_to(draft: &mut ProgramBuilder, store_transport_input: &'static str, transport_input: &str) {
    let shaders = [PIPES, SLOPES, FLOWS, KERNELS, RAINED, INFLOW, EXCHANGE, store_transport_input];
    let reads = ["base", "change", "outflows"];
    draft.pass("exchange", &shaders, &reads, &["settled", "carried", transport_input]).tallies = true;
}

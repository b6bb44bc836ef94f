//! A step as compute passes. Depth, sediment and change of the ground are buffers of their own, and passes hand on
//! vectors, so that no pass has more than eight.

use super::Numbers;
use crate::erode::links::MASK_PLANES;
use crate::erode::links::plane::{ERODIBLE, VALID};
use crate::erode::springs::Forcing;
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::{Content, Program, Uniforms};

const FORCING: &str = include_str!("../forcing.wgsl");
const SUMS: &str = include_str!("../sums.wgsl");
const EDGES: &str = include_str!("edges.wgsl");
const BANKS: &str = include_str!("banks.wgsl");
const LEVEL: &str = include_str!("level.wgsl");
const ACCELERATE: &str = include_str!("accelerate.wgsl");
const SHARES: &str = include_str!("shares.wgsl");
const FLOW: &str = include_str!("flow.wgsl");
const WEAR: &str = include_str!("wear.wgsl");
const UNREST: &str = include_str!("unrest.wgsl");
const SLID: &str = include_str!("slid.wgsl");
const EXPOSE: &str = include_str!("expose.wgsl");
const RECORD: &str = include_str!("record.wgsl");

/// The ground before it creeps and slides.
const SETTLED_GROUND: &str = "
fn ground(cell: vec2<i32>) -> f32 {
    let at = index(cell);
    return base[at] + settled[at];
}
";
/// What would flow if every cell had water enough.
const WANTED: &str = "
fn wanted_at(cell: vec2<i32>) -> vec4<f32> {
    return select(vec4<f32>(0.0), wanted[index(cell)], inside(cell));
}
";

/// What the ground is where it is the same everywhere, of one material or of several, and softer by a map or not.
const ONE_MATERIAL: &str = "
fn stratum_of(cell: vec2<i32>) -> vec4<f32> {
    return vec4<f32>(1.0);
}
";
const MATERIALS: &str = "
fn stratum_of(cell: vec2<i32>) -> vec4<f32> {
    return strength[index(cell)];
}
";
const UNMAPPED: &str = "
fn softness_of(cell: vec2<i32>) -> f32 {
    return stratum_of(cell).x;
}
";
const MAPPED: &str = "
fn softness_of(cell: vec2<i32>) -> f32 {
    return stratum_of(cell).x * erodibility_map[index(cell)];
}
";
const EVEN_RAIN: &str = "
fn inflow_of(cell: vec2<i32>) -> f32 {
    return valid(cell);
}
";
const MAPPED_RAIN: &str = "
fn inflow_of(cell: vec2<i32>) -> f32 {
    return inflow[index(cell)];
}
";

const STAYS: &str = "
fn dried(wet: f32, cell: vec2<i32>) -> f32 {
    return wet;
}
";
const EVAPORATES: &str = "
fn dried(wet: f32, cell: vec2<i32>) -> f32 {
    let left = exact(wet - min(wet, weather.evaporation));
    tally(EVAPORATED, cell, left - wet);
    return left;
}
";

/// The passes, over cells all of which hold data or not.
pub(crate) fn program(numbers: &Numbers, masked: bool, reach: usize) -> Program {
    let weather = Uniforms::of(&Forcing { rain: 0.0, evaporation: 0.0 });
    let constants = Uniforms::of(&numbers.constants);
    let mut draft = ProgramBuilder::new("fluvial", &[FORCING, SUMS, EDGES], constants, weather);
    let planes = numbers.planes();
    draft.buffer("base", 1, Content::Constant(vec![planes]));
    draft.buffer("change", 1, Content::State(vec![0]));
    draft.buffer("depth", 1, Content::State(vec![1]));
    draft.buffer("sediment", 1, Content::State(vec![2]));
    draft.buffer("fluxes", 4, Content::State(vec![3, 4, 5, 6]));
    draft.buffer("resistance", 1, Content::State(vec![7]));
    for (name, lanes) in
        [("level", 4), ("wanted", 4), ("limits", 4), ("carried", 4), ("settled", 1), ("unrest", 1)]
    {
        draft.scratch(name, lanes);
    }
    draft.buffer("means", 4, Content::Mean);
    if masked {
        draft.mask(planes + VALID, planes + ERODIBLE);
    }
    let mut constants = planes + 1 + if masked { MASK_PLANES } else { 0 }..;
    let mut map = |name, there| {
        if there {
            draft.buffer(name, 1, Content::Constant(constants.by_ref().take(1).collect()));
        }
    };
    map("inflow", numbers.rain_map);
    map("erodibility_map", numbers.erodibility_map);
    if let Some(strata) = &numbers.strata {
        expose(&mut draft, (planes - 1, constants.take(strata.beds.len()).collect()));
    }
    let ground = if numbers.strata.is_some() { MATERIALS } else { ONE_MATERIAL };
    let softness = if numbers.erodibility_map { MAPPED } else { UNMAPPED };
    let inflow = if numbers.rain_map { MAPPED_RAIN } else { EVEN_RAIN };
    let evaporation = if numbers.evaporates { EVAPORATES } else { STAYS };
    draft.pass_of("level_of_water", &[LEVEL, inflow, evaporation]);
    draft.pass_of("accelerate", &[ACCELERATE]);
    draft.pass_of("share_out", &[WANTED, SHARES, ground, softness]);
    draft.pass_of("flow", &[WANTED, BANKS, FLOW]);
    draft.pass_of("wear", &[BANKS, WEAR]);
    draft.pass_of("find_unrest", &[SETTLED_GROUND, UNREST, ground]);
    draft.pass_of("slide", &[SETTLED_GROUND, BANKS, SLID]);
    draft.pass("record", &[RECORD], &["fluxes"], &["means"]).recorded = true;
    draft.shows("change", Some("depth"));
    draft.finish(reach)
}

/// Finds how the ground withstands; `rock` is a plane of the state, `bottoms` are the constant ones of the strata.
fn expose(draft: &mut ProgramBuilder, (rock, mut bottoms): (usize, Vec<usize>)) {
    draft.count("STRATA", bottoms.len());
    draft.buffer("rock", 1, Content::State(vec![rock]));
    if bottoms.is_empty() {
        // A buffer holds a plane at least; without strata none is read.
        bottoms.push(rock + 1);
    }
    draft.layered("bottoms", bottoms.len(), Content::Constant(bottoms));
    draft.scratch("strength", 4);
    draft.pass_of("expose", &[EXPOSE]);
}

//! A step as compute passes. Depth, sediment and change of the ground are buffers of their own, and passes hand on
//! vectors, so that no pass has more than eight.

use super::{FluvialConstants, STATE};
use crate::erode::forcing::Forcing;
use crate::erode::links::plane::{ERODIBLE, VALID};
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::{Content, Program, Uniforms};

const FORCING: &str = include_str!("../forcing.wgsl");
const SUMS: &str = include_str!("../sums.wgsl");
const EDGES: &str = include_str!("edges.wgsl");
const LEVEL: &str = include_str!("level.wgsl");
const RESIST: &str = include_str!("resist.wgsl");
const ACCELERATE: &str = include_str!("accelerate.wgsl");
const SHARES: &str = include_str!("shares.wgsl");
const FLOW: &str = include_str!("flow.wgsl");
const WEAR: &str = include_str!("wear.wgsl");
const UNREST: &str = include_str!("unrest.wgsl");
const SLID: &str = include_str!("slid.wgsl");
const RECORD: &str = include_str!("record.wgsl");

/// The passes, over cells all of which hold data or not.
pub(crate) fn program(constants: &FluvialConstants, masked: bool, reach: usize) -> Program {
    let weather = Uniforms::of(&Forcing { rain: 0.0, evaporation: 0.0 });
    let mut draft = ProgramBuilder::new("fluvial", &[FORCING, SUMS, EDGES], Uniforms::of(constants), weather);
    draft.flag("OPEN", constants.open > 0.0);
    draft.buffer("base", 1, Content::Constant(vec![STATE.len()]));
    draft.buffer("change", 1, Content::State(vec![0]));
    draft.buffer("depth", 1, Content::State(vec![1]));
    draft.buffer("sediment", 1, Content::State(vec![2]));
    draft.buffer("fluxes", 4, Content::State(vec![3, 4, 5, 6]));
    draft.scratch("level", 4);
    draft.scratch("resistance", 1);
    draft.scratch("wanted", 4);
    draft.scratch("limits", 4);
    draft.scratch("carried", 2);
    draft.scratch("settled", 1);
    draft.scratch("unrest", 1);
    draft.buffer("means", 4, Content::Mean);
    if masked {
        draft.mask(STATE.len() + VALID, STATE.len() + ERODIBLE);
    }
    for (name, shader) in [
        ("level_of_water", LEVEL),
        ("resist", RESIST),
        ("accelerate", ACCELERATE),
        ("share_out", SHARES),
        ("flow", FLOW),
        ("wear", WEAR),
        ("find_unrest", UNREST),
        ("slide", SLID),
    ] {
        draft.pass_of(name, &[shader]);
    }
    draft.pass("record", &[RECORD], &["fluxes"], &["means"]).recorded = true;
    draft.shows("change", Some("depth"));
    draft.finish(reach)
}

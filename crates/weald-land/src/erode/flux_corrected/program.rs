//! The transport in flux form as compute passes.

use crate::erode::advection_rows::Advected;
use weald_engine::program::builder::ProgramBuilder;

const FLUX_CORRECTED: &str = include_str!("../flux_corrected.wgsl");
const PIPES: &str = include_str!("../pipes.wgsl");
const UPWIND: &str = include_str!("../upwind.wgsl");
const LOW_ORDER: &str = include_str!("low_order.wgsl");
const ANTIDIFFUSIVE: &str = include_str!("antidiffusive.wgsl");
const RANGE: &str = include_str!("range.wgsl");
const RAISE_ORDER: &str = include_str!("raise_order.wgsl");

/// Adds the passes that move the sediment.
pub(crate) fn add_to(draft: &mut ProgramBuilder, model: &Advected<'_>) {
    draft.scratch("upwind_step", 4);
    draft.scratch("antidiffusive", 2);
    draft.scratch("shares", 2);
    let shaders = [&[PIPES, UPWIND, FLUX_CORRECTED, LOW_ORDER], model.from].concat();
    draft.pass("low_order", &shaders, model.reads, &["upwind_step", "antidiffusive"]);
    let written = ["upwind_step", "antidiffusive"];
    draft.pass("range", &[PIPES, ANTIDIFFUSIVE, RANGE], &written, &["shares"]);
    let shaders = [&[PIPES, ANTIDIFFUSIVE, RAISE_ORDER], model.into].concat();
    draft.pass("raise_order", &shaders, &[&written, model.keeps, &["shares"]].concat(), &[model.writes]);
}

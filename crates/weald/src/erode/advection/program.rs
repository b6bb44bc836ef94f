//! The transport as compute passes.

use super::Advection;
use crate::engine::program::draft::Draft;

const ADVECTION: &str = include_str!("../advection.wgsl");
const SEDIMENT: &str = include_str!("sediment.wgsl");
const ADVECT: &str = include_str!("advect.wgsl");
const DEPART: &str = include_str!("depart.wgsl");
const CORRECT: &str = include_str!("correct.wgsl");

/// How a model lets its sediment be advected.
pub(crate) struct Advected<'a> {
    /// Shaders with `velocity(cell)` and `settled_sediment(cell)`.
    pub(crate) from: &'a [&'static str],
    /// Shader with `arrive(cell, amount)`.
    pub(crate) into: &'static str,
    /// Buffers that `from` reads.
    pub(crate) reads: &'a [&'a str],
    /// Buffer that `into` writes.
    pub(crate) writes: &'a str,
}

impl Advection {
    /// Adds the passes that move the sediment.
    pub(crate) fn add_to(self, draft: &mut Draft, model: &Advected<'_>) {
        let shaders = [&[ADVECTION, SEDIMENT], model.from].concat();
        match self {
            Self::SemiLagrangian => {
                draft.pass(
                    "advect",
                    &[&*shaders, &[model.into, ADVECT]].concat(),
                    model.reads,
                    &[model.writes],
                );
            }
            Self::MacCormack => {
                draft.scratch("forward", 1);
                draft.pass("depart", &[&*shaders, &[DEPART]].concat(), model.reads, &["forward"]);
                let reads = [model.reads, &["forward"]].concat();
                draft.pass("correct", &[&*shaders, &[model.into, CORRECT]].concat(), &reads, &[model.writes]);
            }
        }
    }
}

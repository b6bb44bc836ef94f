//! The transport as compute passes.

use super::Advection;
use crate::erode::advection_rows::Advected;
use crate::erode::flux_corrected;
use weald_engine::program::builder::ProgramBuilder;

const ADVECTION: &str = include_str!("../advection.wgsl");
const SEDIMENT: &str = include_str!("sediment.wgsl");
const ADVECT: &str = include_str!("advect.wgsl");
const DEPART: &str = include_str!("depart.wgsl");
const CORRECT: &str = include_str!("correct.wgsl");

impl Advection {
    /// Adds the passes that move the sediment.
    pub(crate) fn add_to(self, draft: &mut ProgramBuilder, model: &Advected<'_>) {
        let shaders = [&[ADVECTION, SEDIMENT], model.from].concat();
        match self {
            Self::SemiLagrangian => {
                let shaders = [&shaders, model.into, &[ADVECT]].concat();
                draft.pass("advect", &shaders, model.reads, &[model.writes]);
            }
            Self::MacCormack => {
                draft.scratch("forward", 1);
                draft.pass("depart", &[&*shaders, &[DEPART]].concat(), model.reads, &["forward"]);
                let shaders = [&shaders, model.into, &[CORRECT]].concat();
                draft.pass("correct", &shaders, &[model.reads, &["forward"]].concat(), &[model.writes]);
            }
            Self::FluxCorrected { .. } => flux_corrected::add_to(draft, model),
        }
    }
}

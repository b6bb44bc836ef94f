//! What the programs of the two water models share.

use super::{Setting, plane};
use crate::erode::links::plane::{ERODIBLE, VALID};
use crate::erode::springs::Forcing;
use crate::erode::thermal::SlideConstants;
use weald_engine::program::builder::ProgramBuilder;
use weald_engine::program::{Content, Uniforms};

const FORCING: &str = include_str!("../forcing.wgsl");
const SUMS: &str = include_str!("../sums.wgsl");

impl Setting {
    /// A program with the buffers of the ground and the switches of the setting. `shader` has the struct of the
    /// model's constants, to which those of the sliding are added; `planes` is the number of its state planes.
    pub(crate) fn draft(
        &self,
        name: &'static str,
        shader: &'static str,
        constants: Uniforms,
        planes: usize,
    ) -> ProgramBuilder {
        let nothing = SlideConstants { talus: 0.0, strength: 0.0 };
        let constants = constants.followed_by(&self.slide.as_ref().map_or(nothing, |slide| slide.constants));
        let weather = Uniforms::of(&Forcing { rain: 0.0, evaporation: 0.0 });
        let mut draft = ProgramBuilder::new(name, &[FORCING, SUMS, shader], constants, weather);
        draft.flag("OPEN", self.open);
        draft.flag("UPWIND", self.advection.is_none());
        draft.buffer("base", 1, Content::Constant(vec![planes]));
        draft.buffer("change", 1, Content::State(vec![plane::CHANGE]));
        draft.scratch("settled", 1);
        if self.links.planes() > 0 {
            draft.mask(planes + VALID, planes + ERODIBLE);
        }
        draft
    }

    /// Adds the sliding, or where there is none makes what settled the change of the ground.
    pub(crate) fn add_slide_to(&self, draft: &mut ProgramBuilder) {
        match &self.slide {
            Some(slide) => slide.pipeline.add_to(draft),
            None => draft.swap("change", "settled"),
        }
    }
}

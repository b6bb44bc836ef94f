//! The sliding as one compute pass.

use super::{Scheme, Slide};
use weald_engine::program::builder::ProgramBuilder;

const SLIDE: &str = include_str!("../thermal.wgsl");
const AXIS: &str = include_str!("axis.wgsl");
const TRIANGLE: &str = include_str!("triangle.wgsl");
const ISOTROPIC: &str = include_str!("isotropic.wgsl");
const ISOTROPIC_SYMMETRIC: &str = include_str!("isotropic_symmetric.wgsl");

impl Slide {
    /// Adds the pass from the buffers `base` and `settled` to `change`. Its program has this method's constants
    /// among its own.
    pub(crate) fn add_to(self, draft: &mut ProgramBuilder) {
        let shaders: &[_] = match self.scheme {
            Scheme::Axis => &[SLIDE, AXIS],
            Scheme::Isotropic => &[SLIDE, TRIANGLE, ISOTROPIC],
            Scheme::IsotropicSymmetric => &[SLIDE, TRIANGLE, ISOTROPIC_SYMMETRIC],
        };
        draft.pass("slide", shaders, &["base", "settled"], &["change"]);
    }
}

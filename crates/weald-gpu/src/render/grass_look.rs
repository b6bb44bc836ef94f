//! How grass is looked at: whole, or as little of it as the picture needs.

use super::sowing::Wedge;
use weald::picture::Camera;

/// What of a landscape's grass is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrassLook {
    /// Whether sets out of sight are left out. The picture is the same.
    pub culled: bool,
    /// Whether sets become fewer, and blades coarser, with the distance, up to 96 m times `reach`. Otherwise all sets of the landscape
    /// are drawn, each blade with ten vertices a level of growth, as in the source.
    pub thinned: bool,
    /// How many times as far from the camera sets stand, 1 to 4: a picture that is drawn once shows more of them
    /// ([`of_a_still`](Self::of_a_still)).
    pub reach: f32,
    /// Level of growth of all sets, 0 to 4, in place of their own.
    pub level: Option<f32>,
}

impl Default for GrassLook {
    fn default() -> Self {
        Self { culled: true, thinned: true, reach: 1.0, level: None }
    }
}

/// How many times as far blades reach in a picture that is drawn once: its four samples make pixels half as large, and it has time for a
/// little more.
const REACH_OF_A_STILL: f32 = 2.5;

/// Most times as far.
const FARTHEST_REACH: f32 = 4.0;

impl GrassLook {
    /// That of a picture that is drawn once.
    pub fn of_a_still() -> Self {
        Self { reach: REACH_OF_A_STILL, ..Self::default() }
    }

    /// That of a camera: where it sees ground on all sides, or sets out of sight are not left out, there would be too many, and blades
    /// reach no farther than in a moving picture.
    pub(super) fn of_camera(self, camera: &Camera) -> Self {
        let is_narrow = self.culled && Wedge::of(camera).is_some();
        let reach = if is_narrow { self.reach.clamp(1.0, FARTHEST_REACH) } else { 1.0 };
        Self { reach, ..self }
    }
}

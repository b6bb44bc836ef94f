//! Ground of several materials: a loose cover of what has settled or slid, on rock in strata that nothing but wear can
//! lower.
//!
//! The rock's top is the lowest that the ground has ever been (`rock = min(rock, change)`, both counted from the ground
//! of the start), all above it is loose. How easily ground wears and how steeply it rests goes over from that of the
//! stratum to that of the cover with `h / (h + h₀)`, `h` the cover's thickness: the idea, with an exponential, is that of
//! SPACE (Shobe, Tucker, Barnhart 2017, doi 10.5194/gmd-10-4577-2017), in which a thin cover protects rock in part.

use crate::erode::pipeline::Equations;
use weald_engine::kernel;

/// Strata between the bedrock and the cover at most: as many materials as there can be, less these two.
pub(crate) const MAX_STRATA: usize = weald_core::material::MAX_MATERIALS - 2;

/// Planes of the depth at which strata end under the ground of the start.
pub(super) const BOTTOMS: [&str; MAX_STRATA] =
    ["bottom_1", "bottom_2", "bottom_3", "bottom_4", "bottom_5", "bottom_6"];

/// How a material withstands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Strength {
    /// Its erodibility over that of the bedrock.
    pub(crate) softness: f32,
    /// Tangent of the steepest slope that rests.
    pub(crate) repose: f32,
}

/// The materials of the ground, from the bedrock to what settles.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Strata {
    pub(crate) bedrock: Strength,
    /// What lies on it, lowest first.
    pub(crate) beds: Vec<Strength>,
    /// What settles.
    pub(crate) cover: Strength,
    /// Thickness of the cover that protects by half, in cells.
    pub(crate) half: f32,
}

kernel! {
    /// The top of the rock, and the bedrock where nothing lies on it.
    pub(crate) struct Bedrock {
        reads { rock_before, change_before }
        writes { rock, worn, rock_softness, rock_repose }
        constants { softness_here: f32, repose_here: f32 }
    }
    fn cell() {
        rock = rock_before.min(change_before);
        worn = -rock;
        rock_softness = softness_here;
        rock_repose = repose_here;
    }
}

kernel! {
    /// The same where not all of a stratum is worn away.
    pub(crate) struct Stratum {
        reads { worn, bottom }
        updates { rock_softness, rock_repose }
        constants { softness_here: f32, repose_here: f32 }
    }
    fn cell() {
        rock_softness = if worn < bottom { softness_here } else { rock_softness };
        rock_repose = if worn < bottom { repose_here } else { rock_repose };
    }
}

kernel! {
    /// The ground as its cover protects the rock.
    pub(crate) struct Covered {
        reads { change_before, rock, rock_softness, rock_repose }
        writes { softness, repose, loose }
        constants { half: f32, softness_here: f32, repose_here: f32 }
    }
    fn cell() {
        let thickness = change_before - rock;
        loose = thickness / (thickness + half);
        softness = rock_softness + loose * (softness_here - rock_softness);
        repose = rock_repose + loose * (repose_here - rock_repose);
    }
}

kernel! {
    /// Softness as a map multiplies it.
    pub(crate) struct Mapped {
        reads { factor }
        updates { softness }
    }
    fn cell() {
        softness *= factor;
    }
}

impl Strata {
    /// All materials, from the bedrock up.
    pub(crate) fn all(&self) -> impl Iterator<Item = Strength> + '_ {
        std::iter::once(self.bedrock).chain(self.beds.iter().copied()).chain([self.cover])
    }

    /// Adds what finds `softness`, `repose` and `loose`.
    pub(super) fn add_to(&self, equations: &mut Equations) {
        let strength = |equations: &mut Equations, Strength { softness, repose }| {
            equations.number("softness_here", softness).number("repose_here", repose);
        };
        strength(equations, self.bedrock);
        equations.kernel::<Bedrock>();
        for (&stratum, bottom) in self.beds.iter().zip(BOTTOMS) {
            strength(equations, stratum);
            equations.kernel_on::<Stratum>(&[("bottom", bottom)]);
        }
        strength(equations, self.cover);
        equations.number("half", self.half).kernel::<Covered>();
    }
}

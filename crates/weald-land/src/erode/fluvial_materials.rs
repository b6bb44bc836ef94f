//! The materials of a landscape as a flood finds and leaves them.
//!
//! The ground of the start is the mark from which all is counted: each material ends so far under it, rock is worn down
//! so far below it, and what lies on the rock is the last material.

use super::fluvial::strata::{Strata, Strength};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::material::{BEDROCK, Material};

/// What lies on the bedrock at the start, in metres.
pub(super) struct StartColumn {
    /// Thicknesses, lowest first.
    pub(super) thicknesses: Vec<Field>,
}

impl StartColumn {
    /// The materials under a ground.
    pub(super) fn of(landscape: &Landscape, ground: &Field) -> Result<Self, Error> {
        Ok(Self { thicknesses: weald_core::strata::stack(landscape, ground)? })
    }

    /// Depth at which each material but the last ends, lowest first.
    pub(super) fn bottoms(&self) -> Vec<Field> {
        let Some((last, strata)) = self.thicknesses.split_last() else { return Vec::new() };
        let mut depth = last.clone();
        let mut bottoms: Vec<_> = strata
            .iter()
            .rev()
            .map(|thickness| {
                depth = both(&depth, thickness, |depth, thickness| depth + thickness);
                depth.clone()
            })
            .collect();
        bottoms.reverse();
        bottoms
    }

    /// Change of the rock's top: the last material lies on it from the start.
    pub(super) fn rock(&self, like: &Field) -> Field {
        let none = || Field::filled(like.size(), 0.0);
        self.thicknesses.last().map_or_else(none, |last| both(last, last, |thickness, _| -thickness))
    }

    /// Writes what each material has become, where the ground of the start has changed by `change` and the top of the
    /// rock by `rock`, in metres.
    pub(super) fn store(&self, landscape: &mut Landscape, start: &Field, [change, rock]: [&Field; 2]) {
        let rock = both(rock, change, f32::min);
        let names: Vec<_> =
            landscape.materials.iter().skip(1).map(|material| material.name.clone()).collect();
        let strata = self.thicknesses.iter().zip(self.bottoms());
        let left: Vec<_> = strata.map(|(thickness, bottom)| left_of(thickness, &bottom, &rock)).collect();
        let under =
            self.bottoms().into_iter().next().map(|deepest| both(&deepest, &rock, |d, r| (-d).min(r)));
        let bedrock = both(start, under.as_ref().unwrap_or(&rock), |start, under| start + under);
        landscape.insert(BEDROCK, "m", bedrock);
        let loose = both(change, &rock, |change, rock| change - rock);
        for (name, thickness) in names.into_iter().zip(left.into_iter().chain([loose])) {
            landscape.insert(&name, "m", thickness);
        }
    }
}

/// What is left of a stratum that ends at `bottom`.
fn left_of(thickness: &Field, bottom: &Field, rock: &Field) -> Field {
    let above = both(bottom, rock, |bottom, rock| (bottom + rock).max(0.0));
    both(thickness, &above, f32::min)
}

fn both(a: &Field, b: &Field, of: impl Fn(f32, f32) -> f32) -> Field {
    let values = a.values().iter().zip(b.values()).map(|(&a, &b)| of(a, b)).collect();
    Field::from_values(a.size(), values)
}

/// How materials withstand, of which the last is what settles; `half` is the cover that protects by half, in cells.
pub(super) fn strata_of(materials: &[Material], half: f32) -> Option<Strata> {
    let (bedrock, above) = materials.split_first()?;
    let strength = |material: &Material| Strength {
        softness: (material.erodibility / bedrock.erodibility) as f32,
        repose: libm::tan(material.talus_deg.clamp(0.0, 90.0).to_radians()).max(0.0) as f32,
    };
    let (cover, strata) = above.split_last().map_or((bedrock, above), |(cover, strata)| (cover, strata));
    let beds = strata.iter().map(strength).collect();
    Some(Strata { bedrock: strength(bedrock), beds, cover: strength(cover), half })
}

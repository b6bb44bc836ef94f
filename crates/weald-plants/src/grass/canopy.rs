//! What grass is where its blades are not told apart: how much leaf stands on a square metre, and of what colour it is.
//!
//! The leaf area index L is the area of leaves on an area of ground. Of light that meets leaves of random directions at an
//! angle whose cosine with the upright is c, the share exp(-L / 2c) goes through: Monsi and Saeki 1953, "Über den
//! Lichtfaktor in den Pflanzengesellschaften". So a lawn that one looks down on shows its soil, and one that one looks
//! across does not.

use rayon::prelude::*;

use super::blade::{BLADES, Blade, Set};
use super::meadow::Meadow;
use weald_core::grid::{Field, Size};

/// Looks along a blade for its area.
const SAMPLES: usize = 6;

/// The grass of a landscape as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Canopy {
    /// Columns and rows.
    pub size: Size,
    /// For each cell the mean colour of leaves in linear light, and the leaf area index.
    pub cells: Vec<[f32; 4]>,
}

impl Canopy {
    /// That of several meadows of one size together; `None` where there is none.
    pub fn of<'a>(meadows: impl Iterator<Item = &'a Meadow>) -> Option<Self> {
        let all = meadows.map(|meadow| {
            let size = meadow.maps.density.size();
            let cells: Vec<_> = (0..size.cells()).into_par_iter().map(|cell| meadow.leaves(cell)).collect();
            Self { size, cells }
        });
        all.reduce(|mut sum, other| {
            for (sum, other) in sum.cells.iter_mut().zip(&other.cells) {
                *sum = together(*sum, *other);
            }
            sum
        })
    }
}

/// Leaves of two kinds on one ground.
fn together(a: [f32; 4], b: [f32; 4]) -> [f32; 4] {
    let leaves = a[3] + b[3];
    let share = if leaves > 0.0 { b[3] / leaves } else { 0.0 };
    let colour: [f32; 3] = std::array::from_fn(|i| a[i] + share * (b[i] - a[i]));
    [colour[0], colour[1], colour[2], leaves]
}

impl Meadow {
    /// Colour and leaf area index of the grass in the middle of a cell.
    fn leaves(&self, cell: usize) -> [f32; 4] {
        let maps = &self.maps;
        let value = |map: &Option<Field>| map.as_ref().map_or(0.0, |map| map.values()[cell]);
        let is_valid = maps.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
        let density = maps.density.values()[cell].clamp(0.0, 1.0);
        if !is_valid || density <= 0.0 || (maps.water.is_some() && value(&maps.water) > self.deepest) {
            return [0.0; 4];
        }
        let mut sum = [0.0; 4];
        let mut before = 0.0;
        for (number, (species, shares)) in self.species.iter().zip(&maps.shares).enumerate() {
            let upto = if maps.shares.len() == 1 { 1.0 } else { shares.values()[cell] };
            let sets = self.densest as f32 * density * (upto - before).max(0.0);
            before = before.max(upto);
            if sets > 0.0 {
                let tuft = Set {
                    soil: maps.soil.values()[cell],
                    light: maps.light.values()[cell],
                    level: self.level,
                    cut: self.cut(number, value(&maps.mown).clamp(0.0, 1.0)),
                    trodden: value(&maps.trodden).clamp(0.0, 1.0),
                    seed: 0,
                };
                // The last blade is a leaf where any is: stalks come first.
                let blade = Blade::of(species, &tuft, BLADES - 1, self.bend);
                let [r, g, b] = species.colour(blade.blend, 0.0);
                sum = together(sum, [r, g, b, sets * BLADES as f32 * area(&blade)]);
            }
        }
        sum
    }
}

/// Area of one side of a blade in square metres.
fn area(blade: &Blade) -> f32 {
    let step = 1.0 / SAMPLES as f32;
    (0..SAMPLES)
        .map(|look| {
            let along = (look as f32 + 0.5) * step;
            let (_, [rise, run]) = blade.stem.at(along);
            (rise * rise + run * run).sqrt() * step * blade.width * (1.0 - blade.taper * along * along)
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grass::{Bend, Instance, LEVELS, Maps, SPECIES};

    fn meadow(density: f32) -> Meadow {
        let size = Size::square(12).expect("small");
        let even = |value: f32| Field::filled(size, value);
        let (valid, water, mown, trodden) = (None, None, None, None);
        let (density, soil, light) = (even(density), even(0.7), even(0.6));
        let shares = vec![even(0.4), even(1.0)];
        Meadow {
            species: vec![SPECIES[0].clone(), SPECIES[1].clone()],
            bend: Bend::Total,
            seed: 3,
            densest: 40.0,
            level: LEVELS as f32,
            mown_height: 0.05,
            deepest: 0.0,
            tussocks: 0.6,
            maps: Maps { cell: 2.0, valid, density, soil, light, shares, water, mown, trodden },
        }
    }

    /// Area of all triangles of all leaves, over that of the ground.
    fn leaf_area(meadow: &Meadow) -> f32 {
        let sets = meadow.sets(&meadow.area());
        let ground = sets.len() as f64 / meadow.densest / 0.5;
        let triangle = |corners: [[f32; 3]; 3]| {
            let [a, b] = [1, 2]
                .map(|to| -> [f32; 3] { std::array::from_fn(|axis| corners[to][axis] - corners[0][axis]) });
            let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            0.5 * cross.iter().map(|part| part * part).sum::<f32>().sqrt()
        };
        let leaves = sets.iter().map(|&packed| {
            let Instance { species, tuft, .. } = Instance::unpack(packed);
            let species = &meadow.species[species as usize];
            let leaves = species.heads..BLADES;
            let area: f32 = leaves
                .clone()
                .map(|number| {
                    let strip: Vec<_> = Blade::of(species, &tuft, number, meadow.bend)
                        .vertices(12)
                        .map(|v| v.place)
                        .collect();
                    strip
                        .windows(3)
                        .map(|corners| triangle([corners[0], corners[1], corners[2]]))
                        .sum::<f32>()
                })
                .sum();
            area * BLADES as f32 / leaves.count() as f32
        });
        leaves.sum::<f32>() / ground as f32
    }

    #[test]
    fn the_leaf_area_is_that_of_the_blades_which_stand_there() {
        let meadow = meadow(0.5);
        let canopy = Canopy::of([&meadow].into_iter()).expect("grass");
        let [.., leaves] = canopy.cells[40];
        let drawn = leaf_area(&meadow);
        // Blades differ in height by chance, one does not.
        assert!(drawn > 0.02 && (leaves / drawn - 1.0).abs() < 0.2, "{leaves} for {drawn}");
        assert!(canopy.cells.iter().all(|cell| *cell == canopy.cells[40]), "even ground has even grass");
    }

    #[test]
    fn meadows_add_their_leaves_and_mix_their_colours_by_them() {
        let (thin, thick) = (meadow(0.25), meadow(0.75));
        let one = |meadow: &Meadow| Canopy::of([meadow].into_iter()).expect("grass").cells[7];
        let both = Canopy::of([&thin, &thick].into_iter()).expect("grass").cells[7];
        assert!((both[3] - one(&thin)[3] - one(&thick)[3]).abs() < 1e-5 * both[3]);
        assert!((0..3).all(|i| (both[i] - one(&thin)[i]).abs() < 1e-6), "{both:?}");
        assert_eq!(Canopy::of(std::iter::empty()), None);
        assert_eq!(one(&meadow(0.0)), [0.0; 4], "no grass, no leaves");
    }
}

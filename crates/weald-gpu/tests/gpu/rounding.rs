//! How far the last place of the ground carries: what a graphics card may differ by from the CPU.
//!
//! Software computes as the CPU does but for some quotients and roots, and fixed bounds hold it. A card fuses products with
//! sums in nearly every line. Where a last digit then decides whether water flows, or whether a cell has enough of it to
//! have a velocity (without a limiter that velocity has no bound), no fixed bound is right: what the same program makes
//! on the CPU of ground that differs by some last places is the measure.

use crate::common::worst_difference;
use weald::random::{hash2, unit};
use weald::{Field, Landscape};
use weald_gpu::Gpu;

/// Other grounds that are tried.
const TRIES: u64 = 16;

/// Last places that their cells are higher or lower by: as much as the roundings of some steps add up to.
const LAST_PLACES: i32 = 4;

/// How much farther than the farthest of them a card may go: it rounds otherwise in every step, they differ once.
const FARTHER: f32 = 4.0;

/// The farthest that one layer may be off in its worst cell, and on average.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub(crate) worst: f32,
    pub(crate) mean: f32,
}

impl Bounds {
    /// What two fields differ by.
    pub(crate) fn between(one: &Field, other: &Field) -> Self {
        let pairs = one.values().iter().zip(other.values());
        let mean = pairs.map(|(a, b)| (a - b).abs()).sum::<f32>() / one.values().len() as f32;
        Self { worst: worst_difference(one, other), mean }
    }

    /// Whether neither passes a bound.
    pub(crate) fn within(self, bound: Self) -> bool {
        self.worst < bound.worst && self.mean < bound.mean
    }

    /// The wider of both.
    fn or(self, other: Self) -> Self {
        Self { worst: self.worst.max(other.worst), mean: self.mean.max(other.mean) }
    }
}

/// Bounds of the fields that a device makes of a ground: at least those of `least` by number, and on a card as wide as ground that differs by some
/// last places makes them on the CPU, where `run` makes `expected` of the ground itself.
pub(crate) fn bounds(
    gpu: &Gpu,
    least: impl Fn(usize) -> Bounds,
    (ground, expected): (&Landscape, &[Field]),
    run: &dyn Fn(&Landscape) -> Vec<Field>,
) -> Vec<Bounds> {
    let mut bounds: Vec<_> = (0..expected.len()).map(least).collect();
    if gpu.is_software() {
        return bounds;
    }
    for seed in 0..TRIES {
        let made = run(&nudged(ground, seed));
        for (bound, (expected, made)) in bounds.iter_mut().zip(expected.iter().zip(&made)) {
            let Bounds { worst, mean } = Bounds::between(expected, made);
            *bound = bound.or(Bounds { worst: FARTHER * worst, mean: FARTHER * mean });
        }
    }
    bounds
}

/// The same ground, some last places higher or lower in two of three cells.
fn nudged(ground: &Landscape, seed: u64) -> Landscape {
    let height = ground.field("height").expect("a ground has a height");
    let nudge = |x: usize, y: usize| {
        let by: fn(f32) -> f32 = match (3.0 * unit(hash2(seed, x as i64, y as i64))) as u32 {
            0 => f32::next_down,
            1 => f32::next_up,
            _ => |height| height,
        };
        (0..LAST_PLACES).fold(height.at(x, y), |height, _| by(height))
    };
    let mut nudged = ground.clone();
    nudged.insert("height", "m", Field::from_function(height.size(), nudge));
    nudged
}

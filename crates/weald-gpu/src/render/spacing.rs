//! How far each level of detail is used: as far as the next one would be seen to be wrong.
//!
//! The error of a level is how far straight edges of its spacing lie off the ground. A level ends where the error of the
//! next one takes less than so many pixels. Ranges at least double from level to level, and are several squares wide,
//! which is what keeps neighbours within one level of each other and cracks away.

use weald::picture::SceneTexture;

use super::levels::{MAX_LEVELS, spacing};

/// Least range of a level in metres of its spacing: squares are 32 wide, their diagonal 45; the slide onto the next
/// level takes four tenths of the way between two ranges, and must not begin within a square of the level before.
const MIN_RANGE: f32 = 80.0;

/// Share of the way between two ranges after which vertices begin to slide.
const SLIDE: f32 = 0.6;

/// Share of the places at which the error is less than what counts.
const COUNTS: f64 = 0.99;

/// Most places at which an error is looked for.
const MAX_SAMPLES: usize = 20_000;

/// The distances at which levels end, in metres.
#[derive(Clone, Debug)]
pub(crate) struct Ranges {
    ends: Vec<f32>,
}

impl Ranges {
    /// For errors in metres by level, the distance at which a metre is one pixel over the pixels that an error may
    /// take, and the longer side of a cell in metres.
    pub(crate) fn new(errors: &[f32], reach: f32, cell: f32) -> Self {
        let mut ends: Vec<f32> = Vec::with_capacity(errors.len());
        for level in 0..errors.len() {
            let seen = errors.get(level + 1).copied().unwrap_or(f32::INFINITY) * reach;
            let wide = MIN_RANGE * spacing(level) * cell;
            let doubled = ends.last().map_or(0.0, |end| 2.0 * end);
            ends.push(seen.max(wide).max(doubled));
        }
        Self { ends }
    }

    /// The distance at which a level ends.
    pub(crate) fn end(&self, level: usize) -> f32 {
        self.ends[level]
    }

    /// The distances between which the vertices of a level slide onto the next, by level.
    pub(crate) fn slides(&self) -> [[f32; 4]; MAX_LEVELS] {
        std::array::from_fn(|level| {
            let Some(&end) = self.ends.get(level).filter(|end| end.is_finite()) else {
                return [1e30, 2e30, 0.0, 0.0];
            };
            let before = if level == 0 { 0.0 } else { self.ends[level - 1] };
            [before + SLIDE * (end - before), end, 0.0, 0.0]
        })
    }
}

/// The error in metres of each level of a ground with such control points.
pub(crate) fn errors(top: &SceneTexture, levels: usize) -> Vec<f32> {
    // Of a smooth surface half the spacing has a quarter of the error.
    let finest = bend(top, 1) / 4.0;
    (0..levels)
        .map(|level| {
            let apart = spacing(level);
            if apart <= 1.0 { finest * apart * apart } else { bend(top, (apart / 2.0) as usize) }
        })
        .collect()
}

/// How far the ground lies off the middle of straight lines over two steps of so many cells.
fn bend(top: &SceneTexture, step: usize) -> f32 {
    let [columns, rows] = top.size;
    let mut bends = Vec::new();
    let places = columns * rows;
    let stride = places.div_ceil(MAX_SAMPLES).max(1);
    // A stride without common divisors with the width looks at all columns.
    let stride = if columns.is_multiple_of(stride) { stride + 1 } else { stride };
    for place in (0..places).step_by(stride) {
        let (x, y) = (place % columns, place / columns);
        let at = |x: usize, y: usize| top.values[y * columns + x];
        if x >= step && x + step < columns {
            bends.push((at(x, y) - 0.5 * (at(x - step, y) + at(x + step, y))).abs());
        }
        if y >= step && y + step < rows {
            bends.push((at(x, y) - 0.5 * (at(x, y - step) + at(x, y + step))).abs());
        }
    }
    bends.sort_unstable_by(f32::total_cmp);
    let counts = ((bends.len().saturating_sub(1)) as f64 * COUNTS) as usize;
    bends.get(counts).copied().unwrap_or(f32::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::picture::TextureKind;

    fn ground(height: impl Fn(usize, usize) -> f32) -> SceneTexture {
        let values = (0..64 * 64).map(|cell| height(cell % 64, cell / 64)).collect();
        SceneTexture { name: "top", kind: TextureKind::Exact, size: [64, 64], layers: 1, values }
    }

    #[test]
    fn a_parabola_bends_by_the_square_of_the_spacing_and_a_plane_not_at_all() {
        let parabola = errors(&ground(|x, _| (x * x) as f32), 6);
        // h = x²: between vertices two cells apart the middle is one metre off.
        assert_eq!(parabola[4], 1.0);
        assert!((parabola[5] / parabola[4] - 4.0).abs() < 1e-3, "{parabola:?}");
        assert!((parabola[3] / parabola[4] - 0.25).abs() < 1e-3, "{parabola:?}");
        assert!(errors(&ground(|x, y| (2 * x + y) as f32), 6).iter().all(|&error| error == 0.0));
    }

    #[test]
    fn ranges_at_least_double_and_slides_lie_between_them() {
        let ranges = Ranges::new(&[0.0, 0.1, 40.0, 41.0, 42.0], 100.0, 10.0);
        let slides = ranges.slides();
        for (level, &[start, end, ..]) in slides.iter().enumerate().take(4).skip(1) {
            assert!(ranges.end(level) >= 2.0 * ranges.end(level - 1));
            assert!(start > ranges.end(level - 1) && start < end && end == ranges.end(level));
        }
    }
}

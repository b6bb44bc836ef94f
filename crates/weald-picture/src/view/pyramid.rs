//! Maxima of the ground over ever larger squares, and the way of a ray through them.
//!
//! A ray that stays above the highest ground of a square passes it in one step; else it goes on in the four
//! squares of half the side, down to single patches of the surface. Art Tevs, Ivo Ihrke, Hans-Peter Seidel 2008,
//! "Maximum mipmaps for fast, accurate, and scalable dynamic height field rendering",
//! doi 10.1145/1342250.1342279. What differs: the leaves are patches of a spline and not pairs of triangles.

use rayon::prelude::*;

use super::surface::Surface;

/// Maxima, finest level first.
#[derive(Debug)]
pub(super) struct Pyramid {
    levels: Vec<Level>,
}

#[derive(Debug)]
struct Level {
    columns: usize,
    rows: usize,
    highest: Vec<f32>,
}

/// A straight line over the ground, in cells per metre.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    /// Place at 0 m.
    pub(super) start: [f32; 2],
    /// Cells eastward and southward in a metre.
    pub(super) step: [f32; 2],
}

impl Line {
    #[inline(always)]
    pub(super) fn at(&self, ray_length: f32) -> [f32; 2] {
        [self.start[0] + self.step[0] * ray_length, self.start[1] + self.step[1] * ray_length]
    }

    /// The ways at which the line enters and leaves the rectangle of a landscape; `None` where it misses it.
    pub(super) fn crossing(&self, surface: &Surface) -> Option<[f32; 2]> {
        let size = surface.size();
        let (mut near, mut far) = (f32::NEG_INFINITY, f32::INFINITY);
        for (axis, cells) in [size.columns, size.rows].into_iter().enumerate() {
            let (low, high) = (0.5, cells as f32 + 0.5);
            let (start, step) = (self.start[axis], self.step[axis]);
            if step == 0.0 {
                if start < low || start > high {
                    return None;
                }
                continue;
            }
            let ends = [(low - start) / step, (high - start) / step];
            near = near.max(ends[0].min(ends[1]));
            far = far.min(ends[0].max(ends[1]));
        }
        (near < far).then_some([near, far])
    }
}

/// What looks for something along a line.
pub(super) trait LineSearch {
    /// Whether it may be found between two ways over ground that is nowhere higher than `highest`.
    fn may_find(&self, span: [f32; 2], highest: f32) -> bool;

    /// Looks between two ways within one patch; says whether the search is over.
    fn look(&mut self, span: [f32; 2]) -> bool;
}

impl Pyramid {
    /// The maxima of a surface. Patches for which `is_empty` holds are lower than anything.
    pub(super) fn new(surface: &Surface, is_empty: impl Fn(usize, usize) -> bool + Sync) -> Self {
        let [columns, rows] = surface.patches();
        let mut highest = vec![f32::NEG_INFINITY; columns * rows];
        highest.par_chunks_mut(columns).enumerate().for_each(|(y, row)| {
            for (x, highest) in row.iter_mut().enumerate().filter(|&(x, _)| !is_empty(x, y)) {
                let points = surface.patch(x, y);
                *highest = points.into_iter().flatten().copied().fold(f32::NEG_INFINITY, f32::max);
            }
        });
        let mut levels = vec![Level { columns, rows, highest }];
        while let Some(finer) = levels.last().filter(|level| level.columns > 1 || level.rows > 1) {
            levels.push(finer.halved());
        }
        Self { levels }
    }

    /// The highest control point of all.
    pub(super) fn highest(&self) -> f32 {
        self.levels[self.levels.len() - 1].highest[0]
    }

    /// Follows a line from way to way, from square to square.
    pub(super) fn follow(&self, line: &Line, span: [f32; 2], seeker: &mut impl LineSearch) {
        let mut walk = Walk::new(self, line, span);
        loop {
            let level = &self.levels[walk.level];
            let (exit, axis) = walk.exit(line, span[1]);
            let here =
                level.highest[(walk.leaf[1] >> walk.level) * level.columns + (walk.leaf[0] >> walk.level)];
            if seeker.may_find([walk.ray_length, exit], here) {
                if walk.level > 0 {
                    walk.level -= 1;
                    continue;
                }
                if seeker.look([walk.ray_length, exit]) {
                    return;
                }
            }
            if exit >= span[1] || !walk.step(self, line, exit, axis) {
                return;
            }
        }
    }
}

impl Level {
    fn halved(&self) -> Self {
        let (columns, rows) = (self.columns.div_ceil(2), self.rows.div_ceil(2));
        let four = |cell: usize| {
            let (x, y) = (2 * (cell % columns), 2 * (cell / columns));
            let (right, below) = ((x + 1).min(self.columns - 1), (y + 1).min(self.rows - 1));
            let at = |x: usize, y: usize| self.highest[y * self.columns + x];
            at(x, y).max(at(right, y)).max(at(x, below).max(at(right, below)))
        };
        Self { columns, rows, highest: (0..columns * rows).into_par_iter().map(four).collect() }
    }
}

/// Where a search is.
struct Walk {
    ray_length: f32,
    /// The patch at `ray_length`.
    leaf: [usize; 2],
    level: usize,
}

impl Walk {
    fn new(pyramid: &Pyramid, line: &Line, span: [f32; 2]) -> Self {
        let finest = &pyramid.levels[0];
        let place = line.at(span[0]);
        let patch = |place: f32, count: usize| (place.max(0.0) as usize).min(count - 1);
        let leaf = [patch(place[0], finest.columns), patch(place[1], finest.rows)];
        Self { ray_length: span[0], leaf, level: (pyramid.levels.len() - 1).min(3) }
    }

    /// The way at which the line leaves the square, not beyond `end`, and the axis across whose side it does.
    #[inline(always)]
    fn exit(&self, line: &Line, end: f32) -> (f32, usize) {
        let leave = |axis: usize| {
            let step = line.step[axis];
            if step == 0.0 {
                return f32::INFINITY;
            }
            let square = self.leaf[axis] >> self.level;
            let side = (square + usize::from(step > 0.0)) << self.level;
            (side as f32 - line.start[axis]) / step
        };
        let (x, y) = (leave(0), leave(1));
        (x.min(y).min(end).max(self.ray_length), usize::from(y < x))
    }

    /// Goes on to the next square; says whether there is one.
    #[inline(always)]
    fn step(&mut self, pyramid: &Pyramid, line: &Line, exit: f32, axis: usize) -> bool {
        let other = 1 - axis;
        let finest = &pyramid.levels[0];
        let counts = [finest.columns, finest.rows];
        let [square, beside] = [axis, other].map(|axis| self.leaf[axis] >> self.level);
        let next = if line.step[axis] > 0.0 { square + 1 } else { square.wrapping_sub(1) };
        let leaf =
            if line.step[axis] > 0.0 { next << self.level } else { (square << self.level).wrapping_sub(1) };
        if leaf >= counts[axis] {
            return false;
        }
        let within = (beside << self.level, (((beside + 1) << self.level) - 1).min(counts[other] - 1));
        self.leaf[axis] = leaf;
        self.leaf[other] = (line.at(exit)[other].max(0.0) as usize).clamp(within.0, within.1);
        self.ray_length = exit;
        if self.level + 1 < pyramid.levels.len() && next >> 1 != square >> 1 {
            self.level += 1;
        }
        true
    }
}

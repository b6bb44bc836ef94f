//! Points and lines on a grid: where they meet, leave it, and lie near.

use weald_core::grid::Size;

/// Distance in cells within which a river joins another, or cuts off a loop of its own.
const NEAR: f32 = 2.0;

/// Cells of the border along which no river runs for more than thrice as many.
pub(super) const RIM: usize = 2;

/// Farthest that a point moves from the centre of its cell, in cells.
const FARTHEST: f32 = 1.0;

/// Ends a line where it first meets another.
pub(super) fn cut_where_they_meet(line: &mut Vec<[f32; 2]>, other: &[[f32; 2]]) {
    let meets = |at: usize| {
        let pieces = other.windows(2).map(|pair| [pair[0], pair[1]]);
        pieces.filter_map(|piece| meeting([line[at], line[at + 1]], piece)).min_by(f32::total_cmp)
    };
    if let Some((at, share)) = (0..line.len() - 1).find_map(|at| Some((at, meets(at)?))) {
        let end = [0, 1].map(|axis| line[at][axis] + share * (line[at + 1][axis] - line[at][axis]));
        line.truncate(at + 1);
        line.push(end);
    }
}

/// Share of a piece, from its first end, at which another crosses it.
fn meeting([a, b]: [[f32; 2]; 2], [c, d]: [[f32; 2]; 2]) -> Option<f32> {
    let cross = |a: [f32; 2], b: [f32; 2]| a[0] * b[1] - a[1] * b[0];
    let from = |a: [f32; 2], b: [f32; 2]| [b[0] - a[0], b[1] - a[1]];
    let turn = cross(from(a, b), from(c, d));
    let [share, on_other] = [cross(from(a, c), from(c, d)) / turn, cross(from(a, c), from(a, b)) / turn];
    [share, on_other].iter().all(|share| (0.0..=1.0).contains(share)).then_some(share)
}

/// Where a river that ends beside the border crosses it.
pub(super) fn run_out(line: &[[f32; 2]], size: Size) -> Option<[f32; 2]> {
    let [last, from] = [line[line.len() - 1], line[line.len().saturating_sub(4)]];
    let along = [last[0] - from[0], last[1] - from[1]];
    let steps = [0, 1].map(|axis| {
        let edge = if along[axis] > 0.0 { [size.columns, size.rows][axis] as f32 } else { 0.0 };
        if along[axis] == 0.0 { f32::INFINITY } else { (edge - last[axis]) / along[axis] }
    });
    let step = steps[0].min(steps[1]);
    let end = [0, 1].map(|axis| last[axis] + step * along[axis]);
    (step.is_finite() && distance(last, end) <= 3.0 * RIM as f32).then_some(end)
}

/// Cells whose centres lie near a place, with their distances.
pub(super) fn near(size: Size, place: [f32; 2]) -> impl Iterator<Item = (f32, usize)> {
    let range = |place: f32, count: usize| {
        let first = (place - NEAR).max(0.0) as usize;
        first..((place + NEAR) as usize + 1).min(count)
    };
    let [columns, rows] = [range(place[0], size.columns), range(place[1], size.rows)];
    let cells = rows.flat_map(move |y| columns.clone().map(move |x| size.index(x, y)));
    cells.map(move |cell| (distance(centre(size, cell), place), cell)).filter(|&(away, _)| away <= NEAR)
}

pub(super) fn centre(size: Size, cell: usize) -> [f32; 2] {
    [(cell % size.columns) as f32 + 0.5, (cell / size.columns) as f32 + 0.5]
}

pub(super) fn distance(a: [f32; 2], b: [f32; 2]) -> f32 {
    let [x, y] = [b[0] - a[0], b[1] - a[1]];
    (x * x + y * y).sqrt()
}

pub(super) fn within_reach(home: [f32; 2], place: [f32; 2]) -> [f32; 2] {
    let share = FARTHEST / distance(home, place).max(FARTHEST);
    [0, 1].map(|axis| home[axis] + share * (place[axis] - home[axis]))
}

//! Which patches nearer ground hides from an eye: beyond a range of mountains most of the land up to the horizon.
//!
//! A skyline is known for columns of directions: the steepness up to which ground nearer than some distance is seen for certain,
//! by the least heights of its squares. A patch whose greatest height lies below that in all of its columns is hidden. The
//! ground that is drawn lies between those bounds, so that nothing is left out that any pixel shows. After the horizons of
//! Downs, Möller and Séquin 2001, "Occlusion horizons for driving through urban scenery", doi 10.1145/364338.364378; what differs:
//! heights of a terrain in place of convex parts of buildings.

use weald::picture::Camera;

use super::frustum::Heights;
use super::lattice::{Lattice, Patch, QUADS};

/// Columns of directions.
const COLUMNS: usize = 512;

/// Squares along the side of a patch by which it hides others: whole quads of it and of the next level.
const SQUARES: u32 = 8;

/// The least distance ahead, as a share of the distance: the directions of what lies more to the side are not known.
const AHEAD: f32 = 0.1;

/// What rounding may add to a steepness.
const ROUNDED: f32 = 1e-5;

/// What a camera sees, by columns.
#[derive(Debug)]
pub(super) struct Skyline {
    eye: [f32; 3],
    /// Ahead and to the right, level.
    axes: [[f32; 2]; 2],
    /// Columns for each step to the right that is as long as the one ahead.
    columns: f32,
    /// The steepness up to which each is filled.
    filled: [f32; COLUMNS],
}

/// How a square of the ground is seen: columns, distances ahead, and heights above the eye, the least and the greatest of each.
#[derive(Clone, Copy, Debug)]
struct Span {
    columns: [f32; 2],
    ahead: [f32; 2],
    heights: [f32; 2],
}

impl Skyline {
    /// The empty skyline of a camera; `None` where it looks up or down so steeply that directions have no columns.
    fn of(camera: &Camera) -> Option<Self> {
        let [x, y, _] = camera.forward;
        let run = x.hypot(y);
        let ahead = [x / run, y / run];
        let axes = [ahead, [ahead[1], -ahead[0]]];
        let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]];
        let widest = corners.into_iter().map(|[right, up]: [f32; 2]| {
            let [a, b] = [camera.half[0] * right, camera.half[1] * up];
            let ray = [0, 1].map(|axis| camera.forward[axis] + a * camera.right[axis] + b * camera.up[axis]);
            let [ahead, aside] = along(axes, ray);
            if ahead > AHEAD * run { Some(aside.abs() / ahead) } else { None }
        });
        let widest = widest.reduce(|a, b| a.zip(b).map(|(a, b)| a.max(b))).flatten()?;
        (run > AHEAD).then_some(Self {
            eye: camera.eye,
            axes,
            columns: 0.5 * COLUMNS as f32 / widest,
            filled: [f32::NEG_INFINITY; COLUMNS],
        })
    }

    /// How a square is seen; `None` where some of it lies beside or behind the eye.
    fn span(&self, lattice: &Lattice, [corner, sides]: [[f32; 2]; 2], heights: [f32; 2]) -> Option<Span> {
        let [mut columns, mut aheads] = [[f32::INFINITY, f32::NEG_INFINITY]; 2];
        for [x, y] in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
            let east = (corner[0] + x * sides[0] - 0.5) * lattice.metres[0] - self.eye[0];
            let north = (0.5 - corner[1] - y * sides[1]) * lattice.metres[1] - self.eye[1];
            let [ahead, aside] = along(self.axes, [east, north]);
            if ahead <= AHEAD * aside.abs() || ahead <= lattice.metres[0] {
                return None;
            }
            columns = united(columns, aside / ahead * self.columns + 0.5 * COLUMNS as f32);
            aheads = united(aheads, ahead);
        }
        Some(Span { columns, ahead: aheads, heights: heights.map(|height| height - self.eye[2]) })
    }

    /// Fills the columns that a square takes wholly.
    fn fill(&mut self, span: &Span) {
        let low = span.heights[0];
        let steepness = low / span.ahead[usize::from(low >= 0.0)];
        let [first, end] = [span.columns[0].ceil(), span.columns[1].floor()].map(within);
        for filled in self.filled.iter_mut().take(end).skip(first) {
            *filled = filled.max(steepness);
        }
    }

    /// Whether all columns of a square are filled higher than it is.
    fn hides(&self, span: &Span) -> bool {
        let high = span.heights[1];
        let steepness = high / span.ahead[usize::from(high < 0.0)];
        let [first, end] = [span.columns[0].floor(), span.columns[1].ceil()].map(within);
        first < end && self.filled[first..end].iter().all(|&filled| steepness + ROUNDED < filled)
    }
}

/// The patches, in any order, of which a camera may see something: all but those that nearer ground hides.
pub(super) fn seen_patches(
    camera: &Camera,
    (lattice, heights): (&Lattice, &Heights),
    patches: Vec<Patch>,
) -> Vec<Patch> {
    let Some(mut skyline) = Skyline::of(camera) else { return patches };
    let span_of = |patch: &Patch| {
        let side = QUADS as f32 * patch.spacing;
        skyline.span(lattice, [patch.corner, [side; 2]], heights.bounds(patch.corner, side))
    };
    let spans: Vec<_> = patches.iter().map(span_of).collect();
    let mut nearer: Vec<_> = patches
        .iter()
        .filter(|patch| !lattice.is_beyond(patch))
        .flat_map(|patch| squares(lattice, patch))
        .filter_map(|[corner, sides]| {
            let bounds = heights.bounds(corner, sides[0].max(sides[1]));
            skyline.span(lattice, [corner, sides], bounds)
        })
        .collect();
    nearer.sort_unstable_by(|a, b| a.ahead[1].total_cmp(&b.ahead[1]));
    let mut order: Vec<_> = (0..patches.len()).collect();
    let begins = |at: usize| spans[at].map_or(0.0, |span| span.ahead[0]);
    order.sort_by(|&a, &b| begins(a).total_cmp(&begins(b)));
    let mut nearer = nearer.into_iter().peekable();
    let mut is_seen = vec![true; patches.len()];
    for at in order {
        let Some(span) = spans[at] else { continue };
        while let Some(square) = nearer.next_if(|square| square.ahead[1] <= span.ahead[0]) {
            skyline.fill(&square);
        }
        is_seen[at] = !skyline.hides(&span);
    }
    patches.into_iter().zip(is_seen).filter_map(|(patch, is_seen)| is_seen.then_some(patch)).collect()
}

/// The squares of a patch that lie on the ground, by corner and sides.
fn squares(lattice: &Lattice, patch: &Patch) -> impl Iterator<Item = [[f32; 2]; 2]> {
    let side = (QUADS / SQUARES) as f32 * patch.spacing;
    let [west, north] = patch.corner;
    let [last_x, last_y] = lattice.cells.map(|cells| cells + 0.5);
    let corners = (0..SQUARES * SQUARES).map(move |number| {
        [west + (number % SQUARES) as f32 * side, north + (number / SQUARES) as f32 * side]
    });
    corners
        .map(move |[x, y]| [[x, y], [side.min(last_x - x), side.min(last_y - y)]])
        .filter(|[_, sides]| sides.iter().all(|&side| side > 0.0))
}

fn along(axes: [[f32; 2]; 2], [east, north]: [f32; 2]) -> [f32; 2] {
    axes.map(|[x, y]| x * east + y * north)
}

fn united([low, high]: [f32; 2], value: f32) -> [f32; 2] {
    [low.min(value), high.max(value)]
}

/// A number of columns from the left.
fn within(column: f32) -> usize {
    column.clamp(0.0, COLUMNS as f32) as usize
}

#[cfg(test)]
mod tests {
    use super::super::frustum::Frustum;
    use super::super::lattice::Viewpoint;
    use super::super::levels::MAX_LEVELS;
    use super::super::spacing::Ranges;
    use super::*;
    use weald::picture::{SceneTexture, TextureKind};
    use weald::random::{splitmix64, unit};

    const CELLS: usize = 256;
    const METRES: f32 = 20.0;

    /// Control points of hills, one of them a long ridge.
    fn hills() -> SceneTexture {
        let side = CELLS + 3;
        let height = |x: f32, y: f32| {
            let ridge = 500.0 * (-((y - 140.0) / 12.0).powi(2)).exp();
            ridge + 60.0 * (0.11 * x).sin() * (0.07 * y).cos() + 25.0 * (0.31 * x + 0.2 * y).sin()
        };
        let values = (0..side * side).map(|at| height((at % side) as f32, (at / side) as f32)).collect();
        SceneTexture { name: "top", kind: TextureKind::Exact, size: [side; 2], layers: 1, values }
    }

    /// The ground at a place, between its control points: within what those around have.
    fn ground(top: &SceneTexture, place: [f32; 2]) -> f32 {
        let spline = |t: f32| {
            [(1.0 - t).powi(3), 3.0 * t * t * t - 6.0 * t * t + 4.0, 0.0, t * t * t]
                .map(|weight| weight / 6.0)
        };
        let [x, y] = place.map(|at| at.clamp(0.5, CELLS as f32 - 0.1));
        let [mut across, mut down] = [x.fract(), y.fract()].map(spline);
        across[2] = 1.0 - across[0] - across[1] - across[3];
        down[2] = 1.0 - down[0] - down[1] - down[3];
        let at = |i: usize, j: usize| top.values[(y as usize + j) * top.size[0] + x as usize + i];
        (0..16).map(|n| across[n % 4] * down[n / 4] * at(n % 4, n / 4)).sum()
    }

    fn selected(top: &SceneTexture, camera: &Camera) -> (Vec<Patch>, Vec<Patch>) {
        let lattice = Lattice::new([CELLS as f32; 2], [METRES; 2]);
        let heights = Heights::new(top, [METRES; 2], -200.0);
        let ranges = Ranges::new(&[2.0; MAX_LEVELS], 1.0, METRES);
        let place = [0.5 + camera.eye[0] / METRES, 0.5 - camera.eye[1] / METRES];
        let from = Viewpoint { place, above: 0.0 };
        let all = lattice.select(from, &ranges, &heights, &Frustum::of(camera));
        (all.clone(), seen_patches(camera, (&lattice, &heights), all))
    }

    #[test]
    fn what_is_left_out_is_hidden_from_the_eye_point_by_point() {
        let top = hills();
        let mut hidden = 0;
        for number in 0..40_u64 {
            let random = |purpose: u64| unit(splitmix64(number ^ splitmix64(purpose))) as f32;
            let place = [40.0 + 180.0 * random(1), 60.0 + 180.0 * random(2)];
            let [east, north] = [(place[0] - 0.5) * METRES, (0.5 - place[1]) * METRES];
            let eye = [east, north, ground(&top, place) + 2.0 + 150.0 * random(3)];
            let turn = std::f32::consts::TAU * random(4);
            let camera = Camera::looking(eye, [turn.cos(), turn.sin(), 0.3 * random(5) - 0.25], [0.6, 0.4]);
            let (all, seen) = selected(&top, &camera);
            for patch in all.iter().filter(|patch| !seen.contains(patch)) {
                for point in 0..9_u32 {
                    let side = QUADS as f32 * patch.spacing;
                    let at = [point % 3, point / 3].map(|share| 0.5 * share as f32 * side);
                    let to = [patch.corner[0] + at[0], patch.corner[1] + at[1]]
                        .map(|at| at.min(CELLS as f32 - 0.1));
                    let up = ground(&top, to);
                    let is_blocked = (1..2000).any(|step| {
                        let share = step as f32 / 2000.0;
                        let here = [0, 1].map(|axis| place[axis] + share * (to[axis] - place[axis]));
                        ground(&top, here) > eye[2] + share * (up - eye[2])
                    });
                    assert!(is_blocked, "camera {number}: {patch:?} is seen at {to:?}");
                    hidden += 1;
                }
            }
        }
        assert!(hidden > 2000, "{hidden} points mean little");
    }

    #[test]
    fn what_is_not_certain_counts_for_what_is_farther_away() {
        let camera = Camera::looking([0.0; 3], [0.0, 1.0, 0.0], [0.6, 0.4]);
        let filled = |heights: [f32; 2]| {
            let mut skyline = Skyline::of(&camera).expect("it looks ahead");
            skyline.fill(&Span { columns: [0.5, 20.5], ahead: [100.0, 200.0], heights });
            assert_eq!([0, 20].map(|column| skyline.filled[column]), [f32::NEG_INFINITY; 2], "not wholly");
            skyline
        };
        let (above, below) = (filled([10.0, 20.0]), filled([-10.0, 20.0]));
        assert_eq!([above.filled[1], below.filled[19]], [10.0 / 200.0, -10.0 / 100.0]);
        let hides = |skyline: &Skyline, high: f32| {
            skyline.hides(&Span { columns: [1.5, 9.5], ahead: [400.0, 500.0], heights: [-99.0, high] })
        };
        assert!(hides(&above, 19.0) && !hides(&above, 22.0), "22 m are steeper from the nearer end");
        assert!(hides(&below, -55.0) && !hides(&below, -45.0), "-45 m are less steep from the farther end");
    }

    #[test]
    fn land_beyond_a_ridge_is_left_out_and_the_ridge_is_not() {
        let top = hills();
        let place = [128.0, 200.0];
        let eye = [(place[0] - 0.5) * METRES, (0.5 - place[1]) * METRES, ground(&top, place) + 20.0];
        let (all, seen) = selected(&top, &Camera::looking(eye, [0.0, 1.0, 0.0], [0.6, 0.4]));
        let beyond = |patches: &[Patch]| {
            patches.iter().filter(|patch| patch.corner[1] + QUADS as f32 * patch.spacing < 120.0).count()
        };
        let ridge = |patches: &[Patch]| patches.len() - beyond(patches);
        assert!(
            beyond(&all) > 20 && beyond(&seen) * 10 < beyond(&all),
            "{} of {}",
            beyond(&seen),
            beyond(&all)
        );
        assert!(2 * ridge(&seen) > ridge(&all));
    }

    #[test]
    fn a_camera_that_looks_down_sees_all_that_is_before_it() {
        let top = hills();
        let (all, seen) =
            selected(&top, &Camera::looking([2500.0, -2500.0, 900.0], [0.0, 0.05, -1.0], [0.6, 0.4]));
        assert_eq!(all, seen);
    }
}

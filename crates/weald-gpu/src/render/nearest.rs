//! How far away the nearest ground is that a view shows: what hangs on distances need not be as fine as for the ground below
//! one's feet.
//!
//! A quadtree of boxes is looked through, the nearer ones first; what lies in a box that is farther away than the nearest found
//! so far is left out.

use super::frustum::{Frustum, Heights};
use super::lattice::Lattice;

/// Boxes are looked into until they are smaller than this share of their distance.
const FINEST: f32 = 1.0 / 8.0;

/// Metres from a point to the ground that a view shows, with what stands so high on it: no more than to the nearest of it.
/// Infinite where it shows none.
pub(super) fn nearest_ground(
    from: [f32; 3],
    lattice: &Lattice,
    (heights, view): (&Heights, &Frustum),
    stands: f32,
) -> f32 {
    let mut search = Search { lattice, from, heights, view, stands, least: f32::INFINITY };
    search.square(lattice.first_corner(), lattice.all_levels() - 1);
    search.least
}

/// Looks for what is nearest.
struct Search<'a> {
    lattice: &'a Lattice,
    from: [f32; 3],
    heights: &'a Heights,
    view: &'a Frustum,
    /// Metres that what stands on the ground is high.
    stands: f32,
    least: f32,
}

impl Search<'_> {
    /// Looks through a square of a level.
    fn square(&mut self, corner: [f32; 2], level: usize) {
        let side = Lattice::side(level);
        let Some(distance) = self.distance(corner, side).filter(|&distance| distance < self.least) else {
            return;
        };
        let longer = self.lattice.metres[0].max(self.lattice.metres[1]);
        if level == 0 || side * longer < FINEST * distance {
            self.least = distance;
            return;
        }
        let (quarters, half) = Lattice::quarters(corner, level);
        let mut quarters =
            quarters.map(|corner| (self.distance(corner, half).unwrap_or(f32::INFINITY), corner));
        quarters.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, corner) in quarters {
            self.square(corner, level - 1);
        }
    }

    /// Metres to the box around a square; none where the view does not show it.
    fn distance(&self, corner: [f32; 2], side: f32) -> Option<f32> {
        if !self.lattice.has_ground(corner) {
            return None;
        }
        let [low, mut high] = self.heights.box_of(corner, side);
        // What hangs on this distance is the same for ground that is followed as for the same ground that is not.
        high[2] += self.stands - self.heights.slack();
        let away = |axis: usize| (low[axis] - self.from[axis]).max(self.from[axis] - high[axis]).max(0.0);
        self.view.meets(&[low, high]).then(|| away(0).hypot(away(1)).hypot(away(2)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::picture::{Camera, SceneTexture, TextureKind};

    /// Control points along a side, and metres from one to the next.
    const SIDE: usize = 67;
    const METRES: f32 = 10.0;

    /// Hills, whose control points are as much higher as a spline of them is lower.
    fn hills(x: usize, y: usize, of_spline: bool) -> f32 {
        let wave = |height: f32, turn: f32, at: usize| {
            let kept = if of_spline { (2.0 + turn.cos()) / 3.0 } else { 1.0 };
            height * kept * (turn * at as f32).sin()
        };
        wave(40.0, 0.3, x) + wave(30.0, 0.23, y)
    }

    #[test]
    fn no_point_in_sight_is_nearer_and_in_the_mean_it_is_hardly_farther() {
        let values = (0..SIDE * SIDE).map(|at| hills(at % SIDE, at / SIDE, false)).collect();
        let top = SceneTexture { name: "top", kind: TextureKind::Exact, size: [SIDE; 2], layers: 1, values };
        let heights = Heights::new(&top, [METRES; 2], -100.0);
        let lattice = Lattice::new([64.0; 2], [METRES; 2]);
        let mut shares = Vec::new();
        for number in 0..60_u32 {
            let random = |step: u32| (0.618_034 * (number * 7 + step) as f32).fract();
            let eye = [640.0 * random(0), -640.0 * random(1), 120.0 + 600.0 * random(2)];
            let turn = std::f32::consts::TAU * random(3);
            let camera = Camera::looking(eye, [turn.cos(), turn.sin(), -0.9 * random(4)], [0.5, 0.3]);
            let view = Frustum::of(&camera);
            // The second control point lies on the middle of the first cell.
            let points = (2..SIDE - 2)
                .flat_map(|y| (2..SIDE - 2).map(move |x| [x, y]))
                .map(|[x, y]| [METRES * (x as f32 - 1.5), -METRES * (y as f32 - 1.5), hills(x, y, true)]);
            let away = |p: [f32; 3]| (p[0] - eye[0]).hypot(p[1] - eye[1]).hypot(p[2] - eye[2]);
            let seen =
                points.filter(|&point| view.meets(&[point; 2])).map(away).fold(f32::INFINITY, f32::min);
            let found = nearest_ground(eye, &lattice, (&heights, &view), 0.0);
            assert!(found <= seen, "{found} m, and a point is seen {seen} m away");
            let higher = nearest_ground(eye, &lattice, (&heights, &view), 25.0);
            assert!(higher <= found, "{higher} m to what stands there, {found} m to the ground");
            if seen.is_finite() {
                shares.push(found / seen);
            }
        }
        let mean = shares.iter().sum::<f32>() / shares.len() as f32;
        assert!(shares.len() > 20 && mean > 0.75, "{mean} of the distance in {} views", shares.len());
        let up = Camera::looking([300.0, -300.0, 900.0], [0.0, 0.1, 1.0], [0.5, 0.3]);
        assert_eq!(nearest_ground(up.eye, &lattice, (&heights, &Frustum::of(&up)), 25.0), f32::INFINITY);
    }
}

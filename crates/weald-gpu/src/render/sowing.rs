//! Which sets of grass a picture chooses from: those around its camera, and of a picture that is drawn once those that its
//! camera may see.

use weald::Error;
use weald::error::{Limit, Quantity};
use weald::grow::grass::choice::{Choice, Detail, FARTHEST, reach_of_blades};
use weald::grow::grass::{Area, Instance, Meadow, Packed};
use weald::picture::Camera;

/// Side in metres of the squares that are filled one after the other, at the change of which sets are made anew.
const SQUARE: f64 = 16.0;

/// Most sets at once: records of their blades lie in a texture of at most 8192 by 8192 texels.
const MAX_SETS: f64 = (5_u32 << 20) as f64;

/// Tangent of half the angle of the widest wedge, of 143°.
const WIDEST: f32 = 3.0;

/// The ground of whose sets a picture chooses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GrassArea {
    /// The square in which the camera is, by its column and row.
    square: [i64; 2],
    /// How many times as far as in a moving picture blades reach.
    reach: f32,
    /// What the camera may see, where that is less than all around.
    wedge: Option<Wedge>,
}

impl GrassArea {
    /// The ground around a place, in which blades reach so many times as far as in a moving picture: what of it the camera may see
    /// where they reach farther.
    pub(super) fn around([east, north, _]: [f32; 3], reach: f32, camera: &Camera) -> Self {
        let square = [east, -north].map(|at| (f64::from(at) / SQUARE).floor() as i64);
        let wedge = if reach > 1.0 { Wedge::of(camera) } else { None };
        Self { square, reach, wedge }
    }

    /// The sets that may be drawn from within the square, the smallest pixels included: the farther from it, the fewer.
    pub(super) fn sets(&self, meadow: &Meadow) -> Result<Vec<Packed>, Error> {
        let reach = f64::from(self.reach * FARTHEST);
        let tallest = meadow.species.iter().map(reach_of_blades).fold(0.0, f32::max);
        let choice = Choice::of_a_picture();
        let detail = Detail::new(1.0, self.reach, meadow.densest);
        let may_be_drawn = |set: &Packed| {
            let Instance { place, tuft, .. } = Instance::unpack(*set);
            self.may_be_seen(place, tallest)
                && choice.height_share(tuft.rank(), self.distance(place), &detail) > 0.0
        };
        let squares = (reach / SQUARE).ceil() as i64;
        let beside = || -squares..=squares;
        let mut sets = Vec::new();
        for [column, row] in beside().flat_map(|row| beside().map(move |column| [column, row])) {
            let low = [self.square[0] + column, self.square[1] + row].map(|at| at as f64 * SQUARE);
            let area = Area { low, high: low.map(|low| low + SQUARE) };
            let middle = low.map(|low| (low + 0.5 * SQUARE) as f32);
            if self.may_be_seen(middle, tallest + SQUARE as f32) {
                sets.extend(checked(meadow, &area)?.into_iter().filter(may_be_drawn));
                check(sets.len() as f64)?;
            }
        }
        Ok(sets)
    }

    /// Metres from the square to a place, east and south.
    fn distance(&self, place: [f32; 2]) -> f32 {
        let away = [0, 1].map(|axis| {
            let at = f64::from(place[axis]);
            let low = self.square[axis] as f64 * SQUARE;
            (low - at).max(at - low - SQUARE).max(0.0) as f32
        });
        away[0].hypot(away[1])
    }

    /// Whether what is around a place, east and south, may be seen.
    fn may_be_seen(&self, [east, south]: [f32; 2], radius: f32) -> bool {
        self.wedge.is_none_or(|wedge| wedge.reaches([east, -south], radius))
    }
}

/// The ground that a camera may see, whatever its heights: all between two directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wedge {
    eye: [f32; 2],
    /// Outward normals of its sides.
    sides: [[f32; 2]; 2],
}

impl Wedge {
    /// `None` where a camera looks so far up or down, or so far aside, that it sees ground on nearly all sides.
    pub(super) fn of(camera: &Camera) -> Option<Self> {
        let [ahead_x, ahead_y, _] = camera.forward;
        let ahead = ahead_x.hypot(ahead_y);
        let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]].map(|[across, upward]| {
            let along = |axis: usize| {
                camera.forward[axis]
                    + across * camera.half[0] * camera.right[axis]
                    + upward * camera.half[1] * camera.up[axis]
            };
            // Ahead, and to the left of that.
            [along(0) * ahead_x + along(1) * ahead_y, along(1) * ahead_x - along(0) * ahead_y]
        });
        // With a hundredth of a radian more, for what a device rounds otherwise.
        let steepest =
            corners.map(|[ahead, left]| left.abs() / ahead.max(1e-9)).into_iter().fold(0.0, f32::max) + 0.01;
        if ahead < 1e-3 || corners.iter().any(|corner| corner[0] <= 0.0) || steepest > WIDEST {
            return None;
        }
        let [x, y] = [ahead_x / ahead, ahead_y / ahead];
        let length = steepest.hypot(1.0);
        let side = |left: f32| [(-steepest * x - left * y) / length, (-steepest * y + left * x) / length];
        Some(Self { eye: [camera.eye[0], camera.eye[1]], sides: [side(1.0), side(-1.0)] })
    }

    /// Whether a ball around a place, east and north, may be in sight: half as far outside again, since beside the edges of
    /// what a camera sees a ball counts as in sight that is so far outside two of its planes.
    fn reaches(&self, place: [f32; 2], radius: f32) -> bool {
        let from_eye = [place[0] - self.eye[0], place[1] - self.eye[1]];
        self.sides.iter().all(|side| side[0] * from_eye[0] + side[1] * from_eye[1] <= 1.5 * radius)
    }
}

/// All sets of an area, unless there are too many.
pub(super) fn checked(meadow: &Meadow, area: &Area) -> Result<Vec<Packed>, Error> {
    check(meadow.expected(area))?;
    Ok(meadow.sets(area))
}

fn check(sets: f64) -> Result<(), Error> {
    if sets <= MAX_SETS {
        return Ok(());
    }
    let limit = Limit::new(Quantity::GrassSets, sets.ceil() as u64, 0..=MAX_SETS as u64);
    Err(limit.of("around the camera").remedy("sow fewer `sets` on a square metre").into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::grow::grass::choice::ViewCone;
    use weald::random::{splitmix64, unit};

    #[test]
    fn what_a_camera_sees_is_in_its_wedge_and_much_is_not() {
        let (mut wedges, mut seen, mut kept, mut all) = (0, 0, 0, 0);
        for number in 0..400_u64 {
            let random = |purpose: u64| unit(splitmix64(number ^ splitmix64(purpose))) as f32;
            let (turn, pitch) = (6.3 * random(0), 1.4 * (random(1) - 0.5));
            let forward = [turn.cos() * pitch.cos(), turn.sin() * pitch.cos(), pitch.sin()];
            let camera = Camera::looking([3.0, -7.0, 2.0], forward, [0.3 + 0.5 * random(2), 0.3]);
            let Some(wedge) = Wedge::of(&camera) else { continue };
            wedges += 1;
            let axes = [camera.forward, camera.right, camera.up];
            let detail = Detail::new(1.0, 1.0, 1.0);
            let cone = ViewCone { eye: camera.eye, axes, half: camera.half, detail_from: camera.eye, detail };
            for place in 0..300_u64 {
                let [east, north, up] = [4, 5, 6].map(|axis| 24.0 * random(axis + 16 * place) - 12.0);
                let is_seen = cone.is_in_sight([east, north, up], 1.5);
                let is_kept = wedge.reaches([camera.eye[0] + east, camera.eye[1] + north], 1.5);
                assert!(!is_seen || is_kept, "{east}, {north}, {up} from {camera:?}");
                seen += u32::from(is_seen);
                kept += u32::from(is_kept);
                all += 1;
            }
        }
        assert!(wedges > 200 && seen > 1000, "{wedges} wedges, {seen} seen");
        assert!(4 * kept < 3 * all, "{kept} of {all} are kept");
    }
}

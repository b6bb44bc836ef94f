//! What is under the pointer: the ray of a camera meets ground and water as they are now.

use weald::Field;
use weald::picture::Camera;

/// Halvings of the last stride, after which a place is known to a thousandth of a cell.
const HALVINGS: usize = 12;

/// The surface that is hit: elevations in metres on square cells.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Target<'a> {
    /// Elevation of the ground.
    pub(crate) ground: &'a Field,
    /// Depth of the water on it, where there is some.
    pub(crate) water: Option<&'a Field>,
    /// Side of a cell.
    pub(crate) cell: f64,
    /// Elevation that the camera counts heights from.
    pub(crate) lowest: f64,
    /// Factor on heights above that.
    pub(crate) exaggeration: f64,
}

/// A place on the landscape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    /// Metres east and south of the north-western corner.
    pub(crate) at: [f64; 2],
    /// Column and row.
    pub(crate) cell: [usize; 2],
    /// Elevation of the ground.
    pub(crate) ground: f64,
    /// Depth of the water.
    pub(crate) water: f64,
}

impl Target<'_> {
    /// What the ray through a point of the picture meets first, from -1 to 1 rightward and upward; `None` where it meets
    /// nothing.
    pub(crate) fn pick(&self, camera: &Camera, [x, y]: [f32; 2]) -> Option<Place> {
        let aside =
            |axis: usize| x * camera.half[0] * camera.right[axis] + y * camera.half[1] * camera.up[axis];
        let direction = [0, 1, 2].map(|axis| f64::from(camera.forward[axis] + aside(axis)));
        let eye = camera.eye.map(f64::from);
        let point = |share: f64| [0, 1, 2].map(|axis| eye[axis] + share * direction[axis]);
        let across = direction[0].hypot(direction[1]);
        let stride = if across > 1e-9 { 0.5 * self.cell / across } else { f64::INFINITY };
        let (mut from, end) = self.span(eye, direction)?;
        if stride.is_infinite() {
            return self.at([eye[0], -eye[1]]);
        }
        while from < end {
            let to = (from + stride).min(end);
            if self.is_below(point(to)) {
                return self.between(&point, [from, to]);
            }
            from = to;
        }
        None
    }

    fn between(&self, point: &impl Fn(f64) -> [f64; 3], [mut from, mut to]: [f64; 2]) -> Option<Place> {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (from + to);
            if self.is_below(point(middle)) { to = middle } else { from = middle }
        }
        let [east, north, _] = point(to);
        self.at([east, -north])
    }

    /// From where to where along a ray the landscape lies below or above it, in lengths of its direction.
    fn span(&self, eye: [f64; 3], direction: [f64; 3]) -> Option<(f64, f64)> {
        let size = self.ground.size();
        let far = [size.columns as f64 * self.cell, -(size.rows as f64) * self.cell];
        let (mut first, mut last) = (0.0_f64, f64::INFINITY);
        for axis in 0..2 {
            let [low, high] = [far[axis].min(0.0), far[axis].max(0.0)];
            if direction[axis].abs() < 1e-12 {
                if !(low..=high).contains(&eye[axis]) {
                    return None;
                }
                continue;
            }
            let [one, other] = [low, high].map(|side| (side - eye[axis]) / direction[axis]);
            (first, last) = (first.max(one.min(other)), last.min(one.max(other)));
        }
        (first < last).then_some((first, last))
    }

    fn is_below(&self, [east, north, height]: [f64; 3]) -> bool {
        let top = self.height_at(self.ground, [east, -north])
            + self.water.map_or(0.0, |water| self.height_at(water, [east, -north]));
        height < (top - self.lowest) * self.exaggeration
    }

    /// The place at metres east and south; `None` outside the landscape.
    pub(crate) fn at(&self, at: [f64; 2]) -> Option<Place> {
        let size = self.ground.size();
        let inside = |metres: f64, count: usize| {
            let cell = (metres / self.cell).floor();
            (-1.0..=count as f64).contains(&cell).then(|| (cell.max(0.0) as usize).min(count - 1))
        };
        let cell = [inside(at[0], size.columns)?, inside(at[1], size.rows)?];
        let water = self.water.map_or(0.0, |water| self.height_at(water, at));
        Some(Place { at, cell, ground: self.height_at(self.ground, at), water })
    }

    /// Between the middles of the four cells around.
    pub(crate) fn height_at(&self, field: &Field, [east, south]: [f64; 2]) -> f64 {
        let size = field.size();
        let part = |metres: f64, count: usize| {
            let place = (metres / self.cell - 0.5).clamp(0.0, (count - 1) as f64);
            let low = (place.floor() as usize).min(count.saturating_sub(2));
            (low, (low + 1).min(count - 1), place - low as f64)
        };
        let (west, east, along) = part(east, size.columns);
        let (north, south, down) = part(south, size.rows);
        let value = |x, y| f64::from(field.at(x, y));
        let row = |y| value(west, y) * (1.0 - along) + value(east, y) * along;
        row(north) * (1.0 - down) + row(south) * down
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::Size;

    fn plane(columns: usize) -> Field {
        Field::from_function(Size::square(columns).expect("small"), |x, y| 100.0 + 2.0 * x as f32 + y as f32)
    }

    #[test]
    fn a_ray_to_a_point_of_a_plane_meets_it_there() {
        let ground = plane(64);
        let target = Target { ground: &ground, water: None, cell: 10.0, lowest: 100.0, exaggeration: 1.0 };
        for place in 0..1000_u32 {
            let share = |step: u32| f64::from(place.wrapping_mul(step) % 1000) / 1000.0;
            let at = [20.0 + 600.0 * share(37), 20.0 + 600.0 * share(71)];
            let height = 2.0 * (at[0] / 10.0 - 0.5) + at[1] / 10.0 - 0.5;
            let eye = [320.0 + 500.0 * share(13) as f32, -900.0, 700.0 + 300.0 * share(29) as f32];
            let towards = [at[0] as f32, -at[1] as f32, height as f32];
            let camera = Camera::looking(eye, [0.0, 1.0, 0.0], [0.5, 0.3]).towards(towards);
            let found = target.pick(&camera, [0.0, 0.0]).expect("it meets the plane");
            let miss = (found.at[0] - at[0]).hypot(found.at[1] - at[1]);
            assert!(miss < 0.1, "{at:?} {found:?}");
            assert!((found.ground - 100.0 - height).abs() < 0.1);
        }
    }

    #[test]
    fn water_lies_above_the_ground_and_the_sky_is_nothing() {
        let ground = plane(16);
        let water = Field::filled(ground.size(), 5.0);
        let target =
            Target { ground: &ground, water: Some(&water), cell: 10.0, lowest: 100.0, exaggeration: 2.0 };
        let above = Camera::looking([80.0, -80.0, 500.0], [0.0, 0.0, -1.0], [0.5, 0.5]);
        let found = target.pick(&above, [0.0, 0.0]).expect("below");
        assert_eq!((found.cell, found.water), ([8, 8], 5.0));
        let upward = Camera::looking([80.0, -80.0, 500.0], [0.0, 0.8, 0.6], [0.5, 0.5]);
        assert_eq!(target.pick(&upward, [0.0, 0.0]), None);
        let beside = Camera::looking([1000.0, -80.0, 10.0], [1.0, 0.0, 0.0], [0.5, 0.5]);
        assert_eq!(target.pick(&beside, [0.0, 0.0]), None);
    }
}

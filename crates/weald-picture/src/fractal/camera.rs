//! Where a fractal is seen from: the plane from in front, space from a camera that stands around it.

use weald_plants::ifs::Point;
use weald_plants::ifs::map::dot;

/// A camera that looks at a point, with `y` up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    right: Point,
    up: Point,
    toward: Point,
    target: Point,
    /// Distance to the target; infinite without perspective.
    distance: f64,
}

impl Camera {
    /// A camera that looks at `target`, from a place that is turned about the vertical axis and lifted above the
    /// horizon. `perspective` is 0 for an orthographic picture, else the size of the fractal over its distance.
    pub fn new(target: Point, turn_deg: f64, tilt_deg: f64, [perspective, diameter]: [f64; 2]) -> Self {
        let [(sine, cosine), (rise, reach)] =
            [turn_deg, tilt_deg].map(|angle| libm::sincos(angle.to_radians()));
        let distance = if perspective > 0.0 { diameter / perspective } else { f64::INFINITY };
        Self {
            right: [cosine, 0.0, -sine],
            up: [-sine * rise, reach, -cosine * rise],
            toward: [sine * reach, rise, cosine * reach],
            target,
            distance,
        }
    }

    /// Right and up in the picture, in units of the fractal about the target, and how much nearer than it.
    #[inline]
    pub fn seen(&self, point: Point) -> Point {
        let from = [point[0] - self.target[0], point[1] - self.target[1], point[2] - self.target[2]];
        let nearer = dot(self.toward, from);
        // Infinity over infinity is no number, so a picture without perspective has no quotient.
        let larger = if self.distance.is_finite() { self.distance / (self.distance - nearer) } else { 1.0 };
        [larger * dot(self.right, from), larger * dot(self.up, from), nearer]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn from_in_front_the_plane_is_seen_as_it_is() {
        let camera = Camera::new([1.0, 2.0, 0.0], 0.0, 0.0, [0.0, 1.0]);
        assert_eq!(camera.seen([4.0, 6.0, 0.0]), [3.0, 4.0, 0.0]);
    }

    #[test]
    fn a_quarter_turn_shows_the_side_and_what_is_nearer_looks_larger() {
        let camera = Camera::new([0.0; 3], 90.0, 0.0, [0.5, 2.0]);
        let [right, up, nearer] = camera.seen([2.0, 1.0, -1.0]);
        assert!((nearer - 2.0).abs() < 1e-12, "east is where the camera stands");
        assert!(
            (right - 2.0).abs() < 1e-12 && (up - 2.0).abs() < 1e-12,
            "twice as large at half the distance"
        );
    }

    #[test]
    fn a_camera_above_sees_north_at_the_top() {
        let [_, up, nearer] = Camera::new([0.0; 3], 0.0, 90.0, [0.0, 1.0]).seen([0.0, 3.0, -1.0]);
        assert!((up - 1.0).abs() < 1e-12 && (nearer - 3.0).abs() < 1e-12);
    }
}

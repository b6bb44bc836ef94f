//! A camera's way through points.

use crate::Camera;

/// Share of the way before and after a camera by which it finds the direction of its flight.
const AHEAD: f64 = 0.01;

/// A way along a smooth line through points, evenly in time.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    /// Points of the camera, at least two, as [`Camera::eye`] has them.
    pub points: Vec<[f32; 3]>,
    /// What it looks at; where it flies to if there is none.
    pub target: Option<[f32; 3]>,
}

impl CameraPath {
    /// The camera at a share of the way, 0 to 1, with the angles of another.
    pub fn camera(&self, share: f64, camera: Camera) -> Camera {
        let eye = self.place(share);
        let [before, after] = [self.place(share - AHEAD), self.place(share + AHEAD)];
        let straight = std::array::from_fn(|axis| eye[axis] + after[axis] - before[axis]);
        camera.at(eye).towards(self.target.unwrap_or(straight))
    }

    /// Catmull and Rom's spline through the points, 1974; beyond its ends it goes straight on.
    fn place(&self, share: f64) -> [f32; 3] {
        let last = self.points.len() - 1;
        let position = share * last as f64;
        let first = (position.max(0.0) as usize).min(last - 1);
        let t = (position - first as f64) as f32;
        let at = |index: isize| self.point(index);
        let first = first as isize;
        let [a, b, c, d] = [at(first - 1), at(first), at(first + 1), at(first + 2)];
        std::array::from_fn(|axis| {
            let (a, b, c, d) = (a[axis], b[axis], c[axis], d[axis]);
            0.5 * (2.0 * b
                + t * (c - a)
                + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d)
                + t * t * t * (3.0 * (b - c) + d - a))
        })
    }

    /// A point, or one beyond the ends that the first or last two continue to.
    fn point(&self, index: isize) -> [f32; 3] {
        let last = self.points.len() as isize - 1;
        let inside = index.clamp(0, last);
        let mirror = (2 * inside - index).clamp(0, last);
        let beyond = f32::from(u8::from(inside != index));
        let [inside, mirror] = [inside, mirror].map(|index| self.points[index as usize]);
        std::array::from_fn(|axis| inside[axis] + beyond * (inside[axis] - mirror[axis]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera_path() -> CameraPath {
        CameraPath { points: vec![[0.0, 0.0, 10.0], [100.0, 0.0, 20.0], [100.0, 80.0, 5.0]], target: None }
    }

    #[test]
    fn a_flight_goes_through_its_points_in_equal_times() {
        let camera_path = camera_path();
        for (number, &point) in (0_u8..).zip(&camera_path.points) {
            assert_eq!(camera_path.place(f64::from(number) / 2.0), point);
        }
        let steps: Vec<_> = (0..=40).map(|step| camera_path.place(f64::from(step) / 40.0)).collect();
        let longest = steps
            .windows(2)
            .map(|pair| (0..3).map(|axis| (pair[1][axis] - pair[0][axis]).powi(2)).sum::<f32>().sqrt());
        assert!(longest.fold(0.0, f32::max) < 9.0, "no leap");
    }

    #[test]
    fn it_looks_ahead_or_at_its_target() {
        let camera = Camera::looking([0.0; 3], [0.0, 1.0, 0.0], [0.5, 0.3]);
        let begins = camera_path().camera(0.0, camera);
        assert!(begins.forward[0] > 0.9, "eastward: {:?}", begins.forward);
        let target = Some([0.0, -500.0, 10.0]);
        let looks = CameraPath { target, ..camera_path() }.camera(0.0, camera);
        assert!(looks.forward[1] < -0.99, "southward: {:?}", looks.forward);
    }
}

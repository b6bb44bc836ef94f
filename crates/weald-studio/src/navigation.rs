//! Moving the camera: round a point, aside, towards what is under the pointer, in flight, and on foot.

use weald::picture::Camera;

/// Degrees that a drag over the whole picture turns by.
const TURN_DEG: f64 = 220.0;

/// Least and greatest angle between the line of sight and the vertical, in radians: the picture never tips over.
const STEEPEST: f32 = 0.02;

/// Share of the way to the pointer that a notch of the wheel goes.
const ZOOM: f32 = 0.15;

/// Nearest that zooming comes to what is under the pointer, in metres.
const NEAREST: f32 = 2.0;

/// Height of a person's eyes, in metres.
pub(crate) const EYE_HEIGHT: f32 = 1.7;

/// How the camera is moved by keys and drags.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// Round the landscape.
    #[default]
    Orbit,
    /// Freely.
    Fly,
    /// At a person's height above the ground.
    Walk,
}

impl Mode {
    /// All modes, with what they are called.
    pub(crate) const ALL: [(Self, &str); 3] =
        [(Self::Orbit, "Orbit"), (Self::Fly, "Fly"), (Self::Walk, "Walk")];
}

/// Turns the camera round a point by a drag, in shares of the picture's width and height.
#[must_use]
pub(crate) fn orbit(camera: Camera, centre: [f32; 3], [across, down]: [f32; 2]) -> Camera {
    let turned = camera.turned(centre, f64::from(across) * TURN_DEG);
    let away: [f32; 3] = std::array::from_fn(|axis| turned.eye[axis] - centre[axis]);
    let radius = length(away);
    if radius < 1e-3 {
        return turned;
    }
    let level = away[0].hypot(away[1]).max(1e-6);
    let angle = f32::atan2(level, away[2]) - down * TURN_DEG.to_radians() as f32;
    let angle = angle.clamp(STEEPEST, std::f32::consts::PI - STEEPEST);
    let (sine, cosine) = angle.sin_cos();
    let heading = [away[0] / level, away[1] / level];
    let tilted = [sine * heading[0], sine * heading[1], cosine].map(|part| part * radius);
    // What lies beside the centre stays beside it: the line of sight turns as much as the eye does.
    let forward = tilt(turned.forward, angle - f32::atan2(level, away[2]));
    Camera::looking(std::array::from_fn(|axis| centre[axis] + tilted[axis]), forward, turned.half)
}

/// Turns the line of sight where the eye is, by a drag in shares of the picture's width and height.
#[must_use]
pub(crate) fn look_about(camera: Camera, [across, down]: [f32; 2]) -> Camera {
    let turned = camera.turned(camera.eye, f64::from(across) * TURN_DEG);
    Camera::looking(turned.eye, tilt(turned.forward, -down * TURN_DEG.to_radians() as f32), turned.half)
}

/// A direction raised by an angle, short of straight up and down.
fn tilt(forward: [f32; 3], raised: f32) -> [f32; 3] {
    let level = forward[0].hypot(forward[1]).max(1e-6);
    let limit = std::f32::consts::FRAC_PI_2 - STEEPEST;
    let angle = (f32::atan2(forward[2], level) + raised).clamp(-limit, limit);
    let (sine, cosine) = angle.sin_cos();
    [cosine * forward[0] / level, cosine * forward[1] / level, sine]
}

/// Moves the camera aside, so that what lies `distance` before it follows the pointer.
#[must_use]
pub(crate) fn pan(camera: Camera, distance: f32, [across, down]: [f32; 2]) -> Camera {
    let [right, up] = [-2.0 * across * camera.half[0] * distance, 2.0 * down * camera.half[1] * distance];
    camera
        .at(std::array::from_fn(|axis| camera.eye[axis] + right * camera.right[axis] + up * camera.up[axis]))
}

/// Goes towards a point by notches of the wheel, or away from it.
#[must_use]
pub(crate) fn zoom(camera: Camera, towards: [f32; 3], notches: f32) -> Camera {
    let offset: [f32; 3] = std::array::from_fn(|axis| towards[axis] - camera.eye[axis]);
    let distance = length(offset);
    let left = (distance * (1.0 - ZOOM).powf(notches)).max(NEAREST);
    let share = if distance > 0.0 { 1.0 - left / distance } else { 0.0 };
    camera.at(std::array::from_fn(|axis| camera.eye[axis] + share * offset[axis]))
}

/// Goes so many metres forward, rightward and upward.
#[must_use]
pub(crate) fn go(camera: Camera, [forward, right, up]: [f32; 3], mode: Mode) -> Camera {
    let heading = match mode {
        Mode::Walk => ahead(&camera),
        Mode::Fly | Mode::Orbit => camera.forward,
    };
    let vertical = [0.0, 0.0, up];
    camera.at(std::array::from_fn(|axis| {
        camera.eye[axis] + forward * heading[axis] + right * camera.right[axis] + vertical[axis]
    }))
}

/// Where a camera looks, on the level; upward in its picture where it looks straight down.
pub(crate) fn ahead(camera: &Camera) -> [f32; 3] {
    let [east, north, _] = camera.forward;
    let looks_down = east.hypot(north) < 1e-3;
    let [east, north] = if looks_down { [camera.up[0], camera.up[1]] } else { [east, north] };
    let length = east.hypot(north).max(1e-6);
    [east / length, north / length, 0.0]
}

/// The camera for a picture of other sides, in which all is that lies within `half`, the tangents of half the angles of the
/// picture that it was placed for.
#[must_use]
pub(crate) fn framed(camera: Camera, half: [f32; 2], [width, height]: [u32; 2]) -> Camera {
    let aspect = width as f32 / height.max(1) as f32;
    let is_wider = aspect * half[1] >= half[0];
    let half = if is_wider { [aspect * half[1], half[1]] } else { [half[0], half[0] / aspect] };
    Camera { half, ..camera }
}

/// Distance to a point.
pub(crate) fn distance(camera: &Camera, point: [f32; 3]) -> f32 {
    length(std::array::from_fn(|axis| point[axis] - camera.eye[axis]))
}

fn length(vector: [f32; 3]) -> f32 {
    vector.iter().map(|part| part * part).sum::<f32>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whoever_looks_straight_down_walks_on_upward_in_the_picture() {
        let ahead = |forward| ahead(&Camera::looking([0.0; 3], forward, [0.5; 2]));
        assert_eq!(ahead([3.0, 0.0, -4.0]), [1.0, 0.0, 0.0]);
        let [east, north, up] = ahead([0.0, 0.0, -1.0]);
        assert!((east.hypot(north) - 1.0).abs() < 1e-6 && up == 0.0);
    }

    fn camera() -> Camera {
        Camera::looking([500.0, -2000.0, 900.0], [0.0, 0.8, -0.6], [0.4, 0.3])
    }

    #[test]
    fn orbiting_keeps_the_distance_and_never_tips_over() {
        let (centre, mut eye) = ([500.0, -500.0, 100.0], camera());
        let before = distance(&eye, centre);
        for drag in [[0.3, 0.1], [0.9, -3.0], [-2.0, 3.0], [0.1, 0.02]] {
            eye = orbit(eye, centre, drag);
            assert!((distance(&eye, centre) - before).abs() < 0.01 * before, "{drag:?}");
            assert!(eye.up[2] > 0.0, "{drag:?}: {eye:?}");
        }
    }

    #[test]
    fn what_is_looked_at_stays_in_the_middle_of_an_orbit() {
        let centre = [500.0, -800.0, 0.0];
        let mut eye = camera().towards(centre);
        for drag in [[0.2, 0.05], [-0.7, 0.1], [0.4, -0.2]] {
            eye = orbit(eye, centre, drag);
            let aimed = eye.towards(centre);
            let miss = distance(&Camera { eye: eye.forward, ..eye }, aimed.forward);
            assert!(miss < 1e-3, "{drag:?}: {miss}");
        }
    }

    #[test]
    fn zooming_goes_towards_the_point_and_not_past_it() {
        let towards = [600.0, -700.0, 50.0];
        let mut eye = camera();
        for _ in 0..200 {
            eye = zoom(eye, towards, 1.0);
        }
        assert!((distance(&eye, towards) - NEAREST).abs() < 0.1);
        let back = zoom(zoom(camera(), towards, 3.0), towards, -3.0);
        assert!(distance(&back, camera().eye) < 0.5);
    }

    #[test]
    fn a_picture_of_any_sides_has_all_of_the_one_that_it_was_placed_for() {
        for size in [[800, 300], [300, 800], [640, 480]] {
            let framed = framed(camera(), [0.4, 0.3], size);
            assert!(framed.half[0] >= 0.4 - 1e-6 && framed.half[1] >= 0.3 - 1e-6);
            let square = framed.half[0] / framed.half[1] * size[1] as f32 / size[0] as f32;
            assert!((square - 1.0).abs() < 1e-5, "pixels are square");
        }
    }

    #[test]
    fn who_walks_goes_level_and_who_flies_goes_where_they_look() {
        let walked = go(camera(), [10.0, 0.0, 0.0], Mode::Walk);
        assert_eq!(walked.eye[2], 900.0);
        assert!((walked.eye[1] + 1990.0).abs() < 1e-3);
        let flown = go(camera(), [10.0, 0.0, 0.0], Mode::Fly);
        assert!((flown.eye[2] - 894.0).abs() < 1e-3);
    }
}

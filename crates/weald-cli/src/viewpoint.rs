//! Where the camera of `weald render` stands, as the command line says it.

use crate::values::Point;
use weald::picture::{Camera, CameraPath, LitScene, View};

use crate::arguments::RenderFiles;
use crate::failure::Failure;

/// What is wrong with the cameras before the ground is known. `keys` are those of the view that were given.
pub(crate) fn check(files: &RenderFiles, keys: &[(String, String)]) -> Result<(), Failure> {
    let fault = |message: &str| Err(Failure::usage(message));
    if files.frames.is_some() && files.through.is_empty() {
        return fault(
            "--frames is for a flight with --through; for a turn of the camera use --turntable FRAMES",
        );
    }
    let Some(eye) = files.eye else {
        return match files.eye_height {
            Some(_) => fault("--eye-height METRES goes with --eye X,Y, the place on the ground"),
            None => Ok(()),
        };
    };
    let orbit = ["azimuth_deg", "altitude_deg", "distance"];
    if let Some((key, _)) = keys.iter().find(|(key, _)| orbit.contains(&key.as_str())) {
        let option = key.replace('_', "-");
        return Err(Failure::usage(format!("--{option} has no effect beside --eye; remove either")));
    }
    for point in std::iter::once(&eye).chain(&files.through) {
        match (point.elevation, files.eye_height) {
            (None, None) => {
                return fault("--eye X,Y needs an elevation, X,Y,Z, or --eye-height METRES above the ground");
            }
            (Some(_), Some(_)) => {
                return fault("X,Y,Z and --eye-height both say how high the camera is; leave out one");
            }
            _ => {}
        }
    }
    if files.through.is_empty() && eye.elevation.is_some() && files.target == Some(eye) {
        return fault(SAME_POINT);
    }
    Ok(())
}

const SAME_POINT: &str = "--eye and --target are the same point; move one of them";

/// The cameras of all frames, after [`check`].
pub(crate) fn cameras(files: &RenderFiles, view: &View, scene: &LitScene) -> Result<Vec<Camera>, Failure> {
    if !files.through.is_empty() {
        return camera_path(files, scene);
    }
    let Some(place) = files.eye else {
        return Ok(turned(view, scene, files));
    };
    let eye = standing(place, files.eye_height, scene)?;
    let camera = looking(scene, eye, target(files, scene))?;
    let frames = files.turntable.unwrap_or(1);
    let about = target(files, scene).unwrap_or_else(|| scene.middle());
    Ok((0..frames).map(|frame| camera.turned(about, 360.0 * f64::from(frame) / f64::from(frames))).collect())
}

/// The view's own camera, at each frame of a turntable.
fn turned(view: &View, scene: &LitScene, files: &RenderFiles) -> Vec<Camera> {
    let Some(frames) = files.turntable else {
        return match target(files, scene) {
            Some(target) => vec![scene.camera().towards(target)],
            None => vec![scene.camera()],
        };
    };
    (0..frames).map(|frame| scene.camera_of(&view.turned(f64::from(frame) / f64::from(frames)))).collect()
}

fn drawn(point: Point, scene: &LitScene) -> [f32; 3] {
    let ground = || scene.top_at([point.east, point.south]).unwrap_or(0.0);
    let height = point.elevation.map_or_else(ground, |elevation| scene.drawn_height(elevation));
    [point.east as f32, -point.south as f32, height]
}

fn target(files: &RenderFiles, scene: &LitScene) -> Option<[f32; 3]> {
    files.target.map(|target| drawn(target, scene))
}

/// Where an eye stands, above the ground.
fn standing(place: Point, eye_height: Option<f64>, scene: &LitScene) -> Result<[f32; 3], Failure> {
    let Point { east, south, elevation } = place;
    let ground = scene.top_at([east, south]);
    let height = match elevation {
        Some(elevation) => scene.drawn_height(elevation),
        None => scene.above_ground([east, south], eye_height.unwrap_or_default())[2],
    };
    let height_above = height - ground.unwrap_or(scene.base());
    if height_above < MIN_CLEARANCE {
        return Err(Failure::usage(format!(
            "{}: give a higher --eye X,Y,Z, or --eye X,Y --eye-height 1.7",
            too_low([east, south], height_above)
        )));
    }
    Ok([east as f32, -south as f32, height])
}

fn too_low([east, south]: [f64; 2], height_above: f32) -> String {
    format!(
        "the camera at {east},{south} is {height_above:.2} m above the ground; it must be {MIN_CLEARANCE} m at least"
    )
}

/// Least height of a camera above the ground, in metres.
const MIN_CLEARANCE: f32 = 0.1;

fn looking(scene: &LitScene, eye: [f32; 3], target: Option<[f32; 3]>) -> Result<Camera, Failure> {
    let target = target.unwrap_or_else(|| {
        // Who stands on the ground looks level.
        let [east, north, up] = scene.middle();
        if eye[2] > scene.highest() { [east, north, up] } else { [east, north, eye[2]] }
    });
    if (0..3).all(|axis| (target[axis] - eye[axis]).abs() < 1e-3) {
        return Err(Failure::usage(SAME_POINT));
    }
    Ok(scene.camera().at(eye).towards(target))
}

/// Cameras along a smooth line through all points, evenly in time.
fn camera_path(files: &RenderFiles, scene: &LitScene) -> Result<Vec<Camera>, Failure> {
    let points = files.eye.iter().chain(&files.through);
    let points = points.map(|&point| standing(point, files.eye_height, scene)).collect::<Result<_, _>>()?;
    let camera_path = CameraPath { points, target: target(files, scene) };
    let frames = files.frames.expect("clap asks for it");
    let share = |frame| f64::from(frame) / f64::from(frames - 1);
    let cameras = (0..frames).map(|frame| camera_path.camera(share(frame), scene.camera()));
    let above = |(frame, camera)| match files.eye_height {
        Some(metres) => Ok(scene.kept_above_ground(camera, metres)),
        None => above_ground(camera, frame, scene),
    };
    cameras.enumerate().map(above).collect()
}

/// A camera on its way between two points, unless the ground rises higher there.
fn above_ground(camera: Camera, frame: usize, scene: &LitScene) -> Result<Camera, Failure> {
    let [east, north, height] = camera.eye;
    let place = [f64::from(east), f64::from(-north)];
    let height_above = height - scene.above_ground(place, 0.0)[2];
    if height_above >= MIN_CLEARANCE {
        return Ok(camera);
    }
    let whole = place.map(f64::round);
    Err(Failure::usage(format!(
        "frame {frame} of the flight: {}: give --through a higher point there",
        too_low(whole, height_above)
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::values::{point, size};

    #[test]
    fn points_and_sizes_are_read_or_refused_with_what_would_be_right() {
        assert_eq!(point("1,-2.5,30"), Ok(Point { east: 1.0, south: -2.5, elevation: Some(30.0) }));
        assert_eq!(point(" 4, 5"), Ok(Point { east: 4.0, south: 5.0, elevation: None }));
        for text in ["", "1", "1,2,3,4", "a,b", "1,NaN", "1,inf,2"] {
            assert!(point(text).is_err(), "{text}");
        }
        assert_eq!(size("320x180"), Ok([320, 180]));
        for text in ["", "320", "x", "-1x3", "1.5x2"] {
            assert!(size(text).expect_err("no size").contains("1920x1080"), "{text}");
        }
    }
}

//! Where the camera of `weald render` stands, as the command line says it.

use crate::values::Point;
use weald::picture::{Camera, CameraPath, Stage, View};

use crate::arguments::RenderFiles;
use crate::failure::Failure;

/// The cameras of all frames.
pub(crate) fn cameras(files: &RenderFiles, view: &View, stage: &Stage) -> Result<Vec<Camera>, Failure> {
    if !files.through.is_empty() {
        return camera_path(files, stage);
    }
    let Some(place) = files.camera else {
        if files.eye.is_some() {
            return Err(Failure::usage("--eye METRES goes with --camera X,Y, the place on the ground"));
        }
        return Ok(turned(view, stage, files));
    };
    let eye = standing(place, files.eye, stage)?;
    let camera = looking(stage, eye, target(files, stage))?;
    let frames = files.turntable.unwrap_or(1);
    let about = target(files, stage).unwrap_or_else(|| stage.middle());
    Ok((0..frames).map(|frame| camera.turned(about, 360.0 * f64::from(frame) / f64::from(frames))).collect())
}

/// The view's own camera, at each frame of a turntable.
fn turned(view: &View, stage: &Stage, files: &RenderFiles) -> Vec<Camera> {
    let Some(frames) = files.turntable else {
        return match target(files, stage) {
            Some(target) => vec![stage.camera().towards(target)],
            None => vec![stage.camera()],
        };
    };
    (0..frames).map(|frame| stage.camera_of(&view.turned(f64::from(frame) / f64::from(frames)))).collect()
}

fn drawn(point: Point, stage: &Stage) -> [f32; 3] {
    let ground = || stage.top_at([point.east, point.south]).unwrap_or(0.0);
    let height = point.elevation.map_or_else(ground, |elevation| stage.drawn_height(elevation));
    [point.east as f32, -point.south as f32, height]
}

fn target(files: &RenderFiles, stage: &Stage) -> Option<[f32; 3]> {
    files.target.map(|target| drawn(target, stage))
}

/// Where an eye stands, above the ground.
fn standing(place: Point, eye: Option<f64>, stage: &Stage) -> Result<[f32; 3], Failure> {
    let Point { east, south, elevation } = place;
    let ground = stage.top_at([east, south]);
    let height = match (elevation, eye) {
        (None, None) => {
            return Err(Failure::usage(
                "--camera X,Y needs an elevation, X,Y,Z, or --eye METRES above the ground",
            ));
        }
        (Some(_), Some(_)) => {
            return Err(Failure::usage(
                "--camera X,Y,Z and --eye both say how high the camera is; leave out one",
            ));
        }
        (Some(elevation), None) => stage.drawn_height(elevation),
        (None, Some(eye)) => stage.above_ground([east, south], eye)[2],
    };
    let lowest = ground.unwrap_or(stage.base());
    if height < lowest + MIN_CLEARANCE {
        return Err(Failure::usage(format!(
            "the camera at {east},{south} is {:.2} m above the ground; it must be {MIN_CLEARANCE} m at least: give a \
             higher --camera X,Y,Z, or --camera X,Y --eye 1.7",
            height - lowest
        )));
    }
    Ok([east as f32, -south as f32, height])
}

/// Least height of a camera above the ground, in metres.
const MIN_CLEARANCE: f32 = 0.1;

fn looking(stage: &Stage, eye: [f32; 3], target: Option<[f32; 3]>) -> Result<Camera, Failure> {
    let target = target.unwrap_or_else(|| {
        // Who stands on the ground looks level.
        let [east, north, up] = stage.middle();
        if eye[2] > stage.highest() { [east, north, up] } else { [east, north, eye[2]] }
    });
    if (0..3).all(|axis| (target[axis] - eye[axis]).abs() < 1e-3) {
        return Err(Failure::usage("--camera and --target are the same point; move one of them"));
    }
    Ok(stage.camera().at(eye).towards(target))
}

/// Cameras along a smooth line through all points, evenly in time.
fn camera_path(files: &RenderFiles, stage: &Stage) -> Result<Vec<Camera>, Failure> {
    let points = files.camera.iter().chain(&files.through);
    let points = points.map(|&point| standing(point, files.eye, stage)).collect::<Result<_, _>>()?;
    let camera_path = CameraPath { points, target: target(files, stage) };
    let frames = files.frames.expect("clap asks for it");
    let share = |frame| f64::from(frame) / f64::from(frames - 1);
    Ok((0..frames).map(|frame| camera_path.camera(share(frame), stage.camera())).collect())
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

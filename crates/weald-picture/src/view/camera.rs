//! The camera: where it stands, how it frames the landscape, and the ray of each point of the picture.

use super::keys::View;
use super::terrain::{Ray, Terrain};
use super::vector::{Vector, add, cross, dot, scale, subtract, towards, unit};
use weald_core::parameter::Places;

/// Share of the picture's width and height that a framed landscape takes.
const FILL: [f32; 2] = [0.95, 0.86];

/// Looks at the landscape, along each side, from which it is framed.
const SAMPLES: usize = 33;

/// Rounds in which distance and middle find each other.
const ITERATIONS: usize = 24;

/// Turns at which a landscape that is turned about is framed.
const TURNS: usize = 16;

/// Least height of the eye above the ground, in metres and in cells.
const CLEARANCE: f32 = 2.0;
const CLEARANCE_CELLS: f32 = 0.15;

/// Most of the shorter side of a landscape that [`CLEARANCE`] takes: two metres above a model of a few decimetres, an
/// eye that is level with it would not have it in the picture.
const CLEARANCE_SHARE: f32 = 0.1;

/// A pinhole camera. Its coordinates are metres east and north of the landscape's north-western corner, and up from
/// the lowest ground, heights times the exaggeration. All else counts metres southward: the second coordinate here is
/// minus that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where it stands.
    pub eye: [f32; 3],
    /// Where it looks, of length 1.
    pub forward: [f32; 3],
    /// Rightward in the picture, of length 1.
    pub right: [f32; 3],
    /// Upward in the picture, of length 1.
    pub up: [f32; 3],
    /// Tangents of half the angles that the picture takes across and upward.
    pub half: [f32; 2],
}

impl Camera {
    /// The camera of a view onto a landscape.
    pub(super) fn new(view: &View, terrain: &Terrain, exaggeration: f32) -> Self {
        let across = libm::tan((0.5 * view.field_of_view_deg).to_radians()) as f32;
        let half = [across, across * view.height as f32 / view.width as f32];
        let middle = middle(terrain);
        let target = match first(view.target.as_ref()) {
            Some(place) => on_ground(terrain, place, 0.0),
            None => middle,
        };
        let mut camera = match first(view.eye.as_ref()) {
            Some(place) => {
                let eye = on_ground(terrain, place, view.eye_height as f32 * exaggeration);
                Self::looking(eye, unit(subtract(target, eye)), half)
            }
            None => Self::around(view, terrain, target, half),
        };
        if let Some(turn) = view.turn_deg {
            let axis = if view.target.is_none() { middle } else { target };
            camera.turn(axis, turn);
        }
        camera.eye[2] = camera.eye[2].max(lowest_eye(terrain, camera.eye));
        camera
    }

    /// A camera at a point that looks in a direction of length 1, with such tangents of half its angles.
    pub fn looking(eye: [f32; 3], forward: [f32; 3], half: [f32; 2]) -> Self {
        let side = cross(forward, [0.0, 0.0, 1.0]);
        // Straight down, north is up.
        let right = if dot(side, side) > 1e-10 { unit(side) } else { [1.0, 0.0, 0.0] };
        Self { eye, forward, right, up: cross(right, forward), half }
    }

    /// A camera by azimuth, altitude and distance, or at the distance that frames the landscape.
    fn around(view: &View, terrain: &Terrain, target: Vector, half: [f32; 2]) -> Self {
        let back = towards(view.azimuth_deg, view.altitude_deg);
        let mut points = outline(terrain);
        if view.turn_deg.is_some() {
            points = turned_about(&points, middle(terrain));
        }
        let camera = Self::looking(target, scale(back, -1.0), half);
        let framed = camera.framing(&points);
        match view.distance {
            Some(distance) => Self { eye: add(target, scale(back, distance as f32)), ..camera },
            None if view.target.is_none() => framed,
            None => {
                let distance = dot(subtract(target, framed.eye), framed.forward).max(terrain.cell());
                Self { eye: add(target, scale(back, distance)), ..camera }
            }
        }
    }

    /// The camera moved so that all points are in the picture and fill it.
    fn framing(mut self, points: &[Vector]) -> Self {
        let across = points.iter().map(|&point| dot(subtract(point, self.eye), self.forward).abs());
        let depth = across.fold(1.0, f32::max);
        let mut distance = 8.0 * depth / self.half[1].min(1.0);
        let centre = self.eye;
        let mut shift = [0.0_f32; 2];
        for round in 0..2 * ITERATIONS {
            let sideways = add(scale(self.right, shift[0]), scale(self.up, shift[1]));
            self.eye = add(subtract(centre, scale(self.forward, distance)), sideways);
            let Some([low, high]) = self.bounds(points) else {
                distance *= 2.0;
                continue;
            };
            // Once near, the camera only draws back: needles close to it may not let both settle.
            let is_whole = low.iter().all(|&least| least > -1.0) && high.iter().all(|&most| most < 1.0);
            if round >= ITERATIONS && is_whole {
                break;
            }
            let mut needed = 0.0_f32;
            for axis in 0..2 {
                shift[axis] += 0.5 * (low[axis] + high[axis]) * self.half[axis] * distance;
                needed = needed.max(0.5 * (high[axis] - low[axis]) / FILL[axis]);
            }
            distance *= if round < ITERATIONS { needed.clamp(0.2, 5.0) } else { needed.clamp(1.1, 5.0) };
        }
        self
    }

    /// Least and greatest picture coordinates of points; `None` where one is not in front of the camera.
    fn bounds(&self, points: &[Vector]) -> Option<[[f32; 2]; 2]> {
        let mut bounds = [[f32::MAX; 2], [f32::MIN; 2]];
        for &point in points {
            let place = self.project(point)?;
            for axis in 0..2 {
                bounds[0][axis] = bounds[0][axis].min(place[axis]);
                bounds[1][axis] = bounds[1][axis].max(place[axis]);
            }
        }
        Some(bounds)
    }

    /// Where a point appears, from -1 to 1 rightward and upward; `None` behind the camera.
    pub fn project(&self, point: Vector) -> Option<[f32; 2]> {
        let from = subtract(point, self.eye);
        let depth = dot(from, self.forward);
        let [right, up] = [self.right, self.up].map(|axis| dot(from, axis) / depth);
        (depth > 0.0).then_some([right / self.half[0], up / self.half[1]])
    }

    /// The ray of a point of the picture, from -1 to 1 rightward and upward.
    #[inline(always)]
    pub fn ray(&self, [x, y]: [f32; 2]) -> Ray {
        let aside = add(scale(self.right, x * self.half[0]), scale(self.up, y * self.half[1]));
        Ray { from: self.eye, direction: unit(add(self.forward, aside)) }
    }

    /// Width of a pixel as an angle, in radians, in the middle of a picture of so many pixels.
    pub fn pixel_angle(&self, width: usize) -> f32 {
        2.0 * self.half[0] / width as f32
    }

    /// This camera at another point.
    #[must_use]
    pub fn at(self, eye: [f32; 3]) -> Self {
        Self { eye, ..self }
    }

    /// This camera, looking at a point that is not its own.
    #[must_use]
    pub fn towards(self, target: [f32; 3]) -> Self {
        Self::looking(self.eye, unit(subtract(target, self.eye)), self.half)
    }

    /// This camera, gone round a point by an angle in degrees, clockwise seen from above.
    #[must_use]
    pub fn turned(mut self, centre: [f32; 3], turn_deg: f64) -> Self {
        self.turn(centre, turn_deg);
        self
    }

    fn turn(&mut self, centre: Vector, turn_deg: f64) {
        let turn = turn_deg.to_radians();
        let (sine, cosine) = (libm::sin(turn) as f32, libm::cos(turn) as f32);
        let turned = |v: Vector| [cosine * v[0] + sine * v[1], cosine * v[1] - sine * v[0], v[2]];
        self.eye = add(centre, turned(subtract(self.eye, centre)));
        [self.forward, self.right, self.up] = [self.forward, self.right, self.up].map(turned);
    }
}

fn first(places: Option<&Places>) -> Option<[f64; 2]> {
    places.and_then(|places| places.0.first().copied())
}

/// The height below which no eye may be.
fn lowest_eye(terrain: &Terrain, eye: Vector) -> f32 {
    let place = terrain.place(eye);
    let ground = if terrain.is_valid(place) { terrain.top.at(place) } else { terrain.base };
    let size = terrain.top.size();
    let shorter_side = size.columns.min(size.rows) as f32 * terrain.cell();
    ground + CLEARANCE.min(CLEARANCE_SHARE * shorter_side).max(CLEARANCE_CELLS * terrain.cell())
}

/// The point so high above the ground of a place in metres from the north-western corner.
fn on_ground(terrain: &Terrain, [east, south]: [f64; 2], above: f32) -> Vector {
    let point = [east as f32, -south as f32, 0.0];
    let place = terrain.place(point);
    let ground = if terrain.is_valid(place) { terrain.top.at(place) } else { 0.0 };
    [point[0], point[1], ground + above]
}

/// The middle of the landscape, half-way up.
pub(super) fn middle(terrain: &Terrain) -> Vector {
    let size = terrain.top.size();
    let place = [0.5 + 0.5 * size.columns as f32, 0.5 + 0.5 * size.rows as f32];
    terrain.point(place, 0.5 * (terrain.base + terrain.highest()))
}

/// Points of the surface, and of the base below its border.
fn outline(terrain: &Terrain) -> Vec<Vector> {
    let size = terrain.top.size();
    let at = |look: usize, cells: usize| 0.5 + cells as f32 * look as f32 / (SAMPLES - 1) as f32;
    let mut points = Vec::new();
    for y in 0..SAMPLES {
        for x in 0..SAMPLES {
            let place = [at(x, size.columns), at(y, size.rows)];
            if terrain.is_valid(place) {
                points.push(terrain.point(place, terrain.top.at(place)));
                points.push(terrain.point(place, terrain.base));
            }
        }
    }
    if points.is_empty() {
        points.push(middle(terrain));
    }
    points
}

fn turned_about(points: &[Vector], centre: Vector) -> Vec<Vector> {
    let turns = (0..TURNS).map(|turn| std::f32::consts::TAU * turn as f32 / TURNS as f32);
    let turned = |point: &Vector, turn: f32| {
        let [x, y, z] = subtract(*point, centre);
        let (sine, cosine) = (libm::sinf(turn), libm::cosf(turn));
        add(centre, [cosine * x + sine * y, cosine * y - sine * x, z])
    };
    turns.flat_map(|turn| points.iter().map(move |point| turned(point, turn))).collect()
}

/// Places of the rays within a pixel, from its middle: spread by the plastic number (M. Roberts 2018) and drawn
/// towards the middle as a tent filter weighs them, two pixels wide.
pub(super) fn samples(count: u32) -> Vec<[f32; 2]> {
    let tent = |share: f64| {
        if share < 0.5 { (2.0 * share).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * share).sqrt() }
    };
    let place = |sample: u32, step: f64| {
        let share = 0.5 + f64::from(sample) * step;
        tent(share - share.floor()) as f32 * 0.8
    };
    (0..count)
        .map(|sample| [place(sample, 0.754_877_666_246_692_8), place(sample, 0.569_840_290_998_053_3)])
        .collect()
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::surface::Surface;
    use super::*;
    use proptest::prelude::*;
    use weald_core::grid::{Field, Size};
    use weald_core::random::{hash2, unit as uniform};

    fn terrain([columns, rows]: [usize; 2], cell: f32, relief: f32, seed: u64) -> Terrain {
        let size = Size::new(columns, rows).expect("small");
        let height =
            Field::from_function(size, |x, y| relief * uniform(hash2(seed, x as i64, y as i64)) as f32);
        Terrain::new([cell; 2], Arc::new(Surface::new(&height)), None, -0.05 * cell * columns as f32)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        #[test]
        fn the_usual_camera_stands_above_any_ground_and_sees_all_of_it(
            sides in [1..40_usize, 1..40_usize], cell in 0.1_f32..200.0, slope in 0.0_f32..2.0,
            azimuth_deg in 0.0..360.0, altitude_deg in 0.0..=90.0, field_of_view_deg in 10.0..80.0, turn in 0.0..1.0,
            turns: bool, seed: u64,
        ) {
            let relief = slope * cell * sides[0].max(sides[1]) as f32;
            let terrain = terrain(sides, cell, relief, seed);
            let view = View { azimuth_deg, altitude_deg, field_of_view_deg, ..View::default() };
            let view = if turns { view.turned(turn) } else { view };
            let camera = Camera::new(&view, &terrain, 1.0);
            let place = terrain.place(camera.eye);
            prop_assert!(!terrain.is_valid(place) || camera.eye[2] > terrain.top.at(place));
            for point in outline(&terrain) {
                let seen = camera.project(point);
                prop_assert!(seen.is_some_and(|[x, y]| x.abs() < 1.0 && y.abs() < 1.0), "{point:?} at {seen:?}");
            }
        }

        #[test]
        fn a_camera_below_the_ground_is_lifted_out_of_it(x in 0.0..400.0, y in 0.0..400.0, distance in 1.0..500.0, seed: u64) {
            let terrain = terrain([40, 40], 10.0, 300.0, seed);
            let target = Some(Places(vec![[x, y]]));
            let low = View { target: target.clone(), distance: Some(distance), altitude_deg: 0.0, ..View::default() };
            let standing = View { eye: target, eye_height: 0.0, target: Some(Places(vec![[200.0, 200.0]])), ..View::default() };
            for view in [low, standing] {
                let camera = Camera::new(&view, &terrain, 1.0);
                let place = terrain.place(camera.eye);
                prop_assert!(!terrain.is_valid(place) || camera.eye[2] >= terrain.top.at(place) + 1.9);
            }
        }
    }

    #[test]
    fn a_model_of_a_decimetre_is_in_the_picture_of_a_camera_level_with_it() {
        let terrain = terrain([1, 1], 0.1, 0.0, 0);
        let view = View { azimuth_deg: 0.0, altitude_deg: 0.0, field_of_view_deg: 10.0, ..View::default() };
        let camera = Camera::new(&view, &terrain, 1.0);
        for point in outline(&terrain) {
            let seen = camera.project(point);
            assert!(seen.is_some_and(|[x, y]| x.abs() < 1.0 && y.abs() < 1.0), "{point:?} at {seen:?}");
        }
    }

    #[test]
    fn a_quarter_turn_moves_the_camera_a_quarter_of_the_way_round() {
        let terrain = terrain([30, 30], 10.0, 50.0, 3);
        let at = |share: f64| Camera::new(&View::default().turned(share), &terrain, 1.0);
        let (start, quarter, whole) = (at(0.0), at(0.25), at(1.0));
        let middle = middle(&terrain);
        let [from, to] = [start, quarter].map(|camera| subtract(camera.eye, middle));
        assert!((from[0] + to[1]).abs() < 0.5 && (from[1] - to[0]).abs() < 0.5, "{from:?} {to:?}");
        assert!((dot(from, from) - dot(to, to)).abs() < 1e-2 * dot(from, from));
        assert!(subtract(start.eye, whole.eye).iter().all(|metres| metres.abs() < 0.1));
    }
}

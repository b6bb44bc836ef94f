//! Blades and ground as triangles with light on them: a small rasteriser, for figures alone.
//!
//! Triangles are projected, sorted into bands of rows, and drawn with a depth buffer of three by three samples per
//! pixel, so that edges are smooth and no order matters. Light is that of a sun, of the sky, and of leaves that let
//! light through (a Lambert term on each side); haze takes what is far away.

use rayon::prelude::*;

use weald_picture::{Image, Linear, encode};

/// A point or a direction: metres east, up and south.
pub(super) type Vector = [f32; 3];

/// Samples along each side of a pixel.
const SAMPLES: usize = 3;

/// Rows of samples of a band.
const BAND: usize = 24;

/// Nearest depth that is drawn, in metres.
const NEAR: f32 = 0.02;

/// A corner of a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) place: Vector,
    pub(super) normal: Vector,
    pub(super) colour: Linear,
    /// Share of the sky that is seen from there.
    pub(super) open: f32,
    /// Share of the light that goes through.
    pub(super) through: f32,
}

/// Where the picture is seen from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    pub(super) eye: Vector,
    pub(super) target: Vector,
    /// Angle from the top to the bottom of the picture, in degrees.
    pub(super) view_deg: f32,
    pub(super) size: [usize; 2],
}

/// What lies behind all, and how much of it the air puts before the far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Air {
    /// Colour at the top and at the foot of the sky.
    pub(super) sky: [Linear; 2],
    /// Metres after which two thirds are haze.
    pub(super) clear: f32,
}

impl Air {
    /// A summer's afternoon.
    pub(super) const SUMMER: Self = Self { sky: [[0.2, 0.4, 0.75], [0.72, 0.82, 0.9]], clear: 180.0 };

    /// A grey sheet behind a specimen, on which pale heads show.
    pub(super) const PAPER: Self = Self { sky: [[0.62, 0.66, 0.62]; 2], clear: f32::INFINITY };
}

/// Towards the sun, of length 1.
const SUN: Vector = [-0.52, 0.68, 0.517];
const SUNLIGHT: Linear = [1.9, 1.75, 1.45];
const SKYLIGHT: Linear = [0.5, 0.62, 0.8];

/// A camera as lines of a matrix.
struct Lens {
    camera: Camera,
    right: Vector,
    up: Vector,
    ahead: Vector,
    /// Samples from the middle at one unit beside one ahead.
    focal: f32,
    size: [usize; 2],
}

/// A triangle on the sheet: places in samples with one over the depth, and the corners' light.
struct Drawn {
    at: [[f32; 3]; 3],
    light: [Linear; 3],
}

/// The picture of triangles.
pub(super) fn picture(triangles: &[[Corner; 3]], camera: Camera, air: &Air) -> Image {
    let lens = Lens::of(camera);
    let drawn: Vec<_> = triangles.par_iter().filter_map(|triangle| lens.draw(triangle, air)).collect();
    let [width, height] = lens.size;
    let mut sheet = vec![([0.0; 3], 0.0_f32); width * height];
    sheet.par_chunks_mut(width * BAND).enumerate().for_each(|(band, samples)| {
        for (number, row) in samples.chunks_mut(width).enumerate() {
            let share = (band * BAND + number) as f32 / height as f32;
            row.fill((mixed(air.sky[0], air.sky[1], share.sqrt()), 0.0));
        }
        let rows = samples.len() / width;
        for triangle in &drawn {
            fill(samples, triangle, [width, rows], band * BAND);
        }
    });
    resolved(&sheet, camera.size)
}

impl Camera {
    /// Width in metres that a pixel has at a place.
    pub(super) fn pixel(&self, place: Vector) -> f32 {
        let [away, ahead] = [minus(place, self.eye), unit(minus(self.target, self.eye))];
        let tall = 2.0 * libm::tanf(0.5 * self.view_deg.to_radians());
        dot(away, ahead).max(NEAR) * tall / self.size[1] as f32
    }
}

impl Lens {
    fn of(camera: Camera) -> Self {
        let ahead = unit(minus(camera.target, camera.eye));
        let right = unit(cross(ahead, [0.0, 1.0, 0.0]));
        let size = camera.size.map(|side| side * SAMPLES);
        let focal = 0.5 * size[1] as f32 / libm::tanf(0.5 * camera.view_deg.to_radians());
        Self { camera, right, up: cross(right, ahead), ahead, focal, size }
    }

    fn draw(&self, triangle: &[Corner; 3], air: &Air) -> Option<Drawn> {
        let mut at = [[0.0; 3]; 3];
        for (corner, at) in triangle.iter().zip(&mut at) {
            let away = minus(corner.place, self.camera.eye);
            let depth = dot(away, self.ahead);
            if depth < NEAR {
                return None;
            }
            let [x, y] = [dot(away, self.right), dot(away, self.up)].map(|part| part * self.focal / depth);
            *at = [0.5 * self.size[0] as f32 + x, 0.5 * self.size[1] as f32 - y, 1.0 / depth];
        }
        Some(Drawn { at, light: triangle.map(|corner| self.light(&corner, air)) })
    }

    /// The light that comes from a corner.
    fn light(&self, corner: &Corner, air: &Air) -> Linear {
        let away = minus(self.camera.eye, corner.place);
        let [facing, seen] = [dot(corner.normal, SUN), dot(corner.normal, away)];
        let lit = facing.abs() * if (facing > 0.0) == (seen > 0.0) { 1.0 } else { corner.through };
        let sky = 0.6 + 0.4 * corner.normal[1].abs();
        let far = 1.0 - libm::expf(-dot(away, away).sqrt() / air.clear);
        let light: Linear = std::array::from_fn(|c| {
            corner.colour[c]
                * (corner.open * corner.open.sqrt() * SUNLIGHT[c] * lit + corner.open * sky * SKYLIGHT[c])
        });
        mixed(light, air.sky[1], far)
    }
}

/// Draws a triangle on the samples of a band.
fn fill(samples: &mut [(Linear, f32)], triangle: &Drawn, [width, rows]: [usize; 2], first: usize) {
    let [a, b, c] = triangle.at;
    let span = |axis: usize, low: f32, count: usize| {
        let [low_edge, high_edge] =
            [f32::min, f32::max].map(|pick| pick(pick(a[axis], b[axis]), c[axis]) - low);
        (low_edge.max(0.0) as usize).min(count)..(high_edge.max(0.0).ceil() as usize).min(count)
    };
    let whole = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if whole.abs() < 1e-9 {
        return;
    }
    let columns = span(0, 0.0, width);
    for row in span(1, first as f32, rows) {
        let y = (first + row) as f32 + 0.5;
        for column in columns.clone() {
            let x = column as f32 + 0.5;
            let v = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / whole;
            let w = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / whole;
            let u = 1.0 - v - w;
            if u < 0.0 || v < 0.0 || w < 0.0 {
                continue;
            }
            let near = u * a[2] + v * b[2] + w * c[2];
            let sample = &mut samples[row * width + column];
            if near > sample.1 {
                let light = &triangle.light;
                *sample =
                    (std::array::from_fn(|i| u * light[0][i] + v * light[1][i] + w * light[2][i]), near);
            }
        }
    }
}

/// Samples made pixels: bright light fades towards white, and is averaged as a screen shows it.
fn resolved(sheet: &[(Linear, f32)], [width, height]: [usize; 2]) -> Image {
    let mut rgb = vec![0; 3 * width * height];
    rgb.par_chunks_mut(3).enumerate().for_each(|(pixel, bytes)| {
        let (x, y) = (SAMPLES * (pixel % width), SAMPLES * (pixel / width));
        let mut sum = [0.0; 3];
        for sample in 0..SAMPLES * SAMPLES {
            let at = (y + sample / SAMPLES) * width * SAMPLES + x + sample % SAMPLES;
            sum = [0, 1, 2].map(|c| sum[c] + soft(sheet[at].0[c]));
        }
        bytes.copy_from_slice(&encode(sum.map(|sum| sum / (SAMPLES * SAMPLES) as f32)));
    });
    Image { width, height, rgb }
}

/// Light as it is until three quarters of white, and never beyond white.
fn soft(light: f32) -> f32 {
    if light < 0.75 { light } else { 1.0 - 0.0625 / (light - 0.5) }
}

fn mixed(a: Linear, b: Linear, share: f32) -> Linear {
    std::array::from_fn(|c| a[c] + (b[c] - a[c]) * share)
}

pub(super) fn plus(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

pub(super) fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

pub(super) fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Vector) -> Vector {
    let length = dot(a, a).sqrt();
    a.map(|part| part / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearer_triangle_hides_the_farther_whichever_comes_first() {
        let corner = |x: f32, y: f32, z: f32, colour| Corner {
            place: [x, y, z],
            normal: [0.0, 0.0, 1.0],
            colour,
            open: 1.0,
            through: 0.0,
        };
        let sheet = |z: f32, colour| {
            [corner(-9.0, -9.0, z, colour), corner(9.0, -9.0, z, colour), corner(0.0, 9.0, z, colour)]
        };
        let (red, blue) = (sheet(0.0, [0.4, 0.0, 0.0]), sheet(-1.0, [0.0, 0.0, 0.4]));
        let camera = Camera { eye: [0.0, 0.0, 4.0], target: [0.0; 3], view_deg: 40.0, size: [9, 9] };
        let [one, other] = [[red, blue], [blue, red]].map(|both| picture(&both, camera, &Air::SUMMER));
        assert_eq!(one, other);
        let [red, _, blue] = one.pixel(4, 4);
        assert!(red > 100 && blue < red, "{:?}", one.pixel(4, 4));
    }

    #[test]
    fn a_white_sheet_that_faces_sun_and_sky_sends_both_lights_back() {
        let camera =
            Camera { eye: SUN.map(|part| 4.0 * part), target: [0.0; 3], view_deg: 40.0, size: [9, 9] };
        let lens = Lens::of(camera);
        let clear = Air { sky: [[0.0; 3]; 2], clear: f32::INFINITY };
        let corner = Corner { place: [0.0; 3], normal: SUN, colour: [1.0; 3], open: 1.0, through: 0.0 };
        let sky = 0.6 + 0.4 * SUN[1];
        for (c, light) in lens.light(&corner, &clear).into_iter().enumerate() {
            assert!((light - SUNLIGHT[c] * dot(SUN, SUN) - sky * SKYLIGHT[c]).abs() < 1e-5, "{light}");
        }
        // A quarter of the sky lets an eighth of the sun through.
        let hidden = lens.light(&Corner { open: 0.25, ..corner }, &clear);
        assert!((hidden[0] - 0.125 * SUNLIGHT[0] * dot(SUN, SUN) - 0.25 * sky * SKYLIGHT[0]).abs() < 1e-5);
    }

    #[test]
    fn a_triangle_fills_its_samples_with_depths_between_those_of_its_corners() {
        let at = [[0.0, 0.0, 1.0], [8.0, 0.0, 2.0], [8.0, 8.0, 3.0]];
        let mut samples = vec![([0.0; 3], 0.0); 64];
        fill(&mut samples, &Drawn { at, light: [[1.0; 3]; 3] }, [8, 8], 0);
        for (place, &(light, near)) in samples.iter().enumerate() {
            let (x, y) = (place % 8, place / 8);
            let expected = if y > x { 0.0 } else { 1.0 + (x + y + 1) as f32 / 8.0 };
            assert!((near - expected).abs() < 1e-5, "{near} at {x}, {y}");
            assert!((light[1] - if y > x { 0.0 } else { 1.0 }).abs() < 1e-5, "{light:?} at {x}, {y}");
        }
    }

    #[test]
    fn the_empty_sky_goes_evenly_from_the_colour_of_its_top_to_that_of_its_foot() {
        let camera = Camera { eye: [0.0, 0.0, 4.0], target: [0.0; 3], view_deg: 40.0, size: [40, 60] };
        let sky = picture(&[], camera, &Air::SUMMER);
        let red = |x: usize, y: usize| sky.pixel(x, y)[0];
        assert!((0..60).all(|y| (0..40).all(|x| red(x, y) == red(0, y))), "rows have one colour");
        assert!((1..60).all(|y| red(0, y) >= red(0, y - 1)), "and become brighter downwards");
        let [_, foot] = Air::SUMMER.sky.map(encode);
        assert!(
            red(0, 0) < foot[0] - 40 && foot[0].abs_diff(red(0, 59)) < 3,
            "{} to {}",
            red(0, 0),
            red(0, 59)
        );
    }
}

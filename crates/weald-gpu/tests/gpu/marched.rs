//! How far a picture of a device is from the ray-marched one.

use rayon::prelude::*;

use crate::render::renderer;
use crate::scenes::SIZE;
use weald::Landscape;
use weald::picture::{Camera, Image, LitScene, Oklab, RayMarcher, View, linear_of_hex};
use weald_gpu::Gpu;

/// What is drawn.
pub(crate) const PIXELS: [usize; 2] = [SIZE[0] as usize, SIZE[1] as usize];

/// Means of Oklab over squares of eight pixels, so that edges and dither do not count.
fn squares(image: &Image) -> Vec<Oklab> {
    let side = 8;
    let mut means = Vec::new();
    for top in (0..image.height - side).step_by(side) {
        for left in (0..image.width - side).step_by(side) {
            let mut sum = [0.0_f64; 3];
            for pixel in 0..side * side {
                let [r, g, b] = image.pixel(left + pixel % side, top + pixel / side).map(u32::from);
                let Oklab { lightness, a, b } = Oklab::of(linear_of_hex(r << 16 | g << 8 | b));
                sum = [sum[0] + lightness, sum[1] + a, sum[2] + b];
            }
            let [lightness, a, b] = sum.map(|sum| sum / (side * side) as f64);
            means.push(Oklab { lightness, a, b });
        }
    }
    means
}

/// Distances of a device's picture from the ray-marched one: the mean, and that which one square in twenty passes.
pub(crate) fn distances(gpu: &Gpu, view: &View, landscape: &Landscape, camera: Option<Camera>) -> (f64, f64) {
    let scene = LitScene::with_crags(view, landscape).expect("a scene");
    let camera = camera.unwrap_or_else(|| scene.camera());
    let scene = scene.seen_from(camera);
    if view.samples == 1 {
        return distances_of(gpu, &RayMarcher::of(scene, PIXELS));
    }
    let drawn = renderer(gpu, &scene, 4).render(&camera).expect("drawn");
    distances_between(&drawn, &view.seen_from(landscape, camera).expect("marched"))
}

/// The same of a scene as its camera sees it, with one ray a pixel, as a device shades it once.
pub(crate) fn distances_of(gpu: &Gpu, marcher: &RayMarcher) -> (f64, f64) {
    let scene = marcher.scene();
    let drawn = renderer(gpu, scene, 4).render(&scene.camera()).expect("drawn");
    let [width, height] = PIXELS;
    let rgb = (0..height).into_par_iter().flat_map_iter(|y| marcher.row(y)).collect();
    distances_between(&drawn, &Image { width, height, rgb })
}

fn distances_between(drawn: &Image, marched: &Image) -> (f64, f64) {
    let pairs = squares(drawn).into_iter().zip(squares(marched));
    let mut distances: Vec<f64> = pairs.map(|(a, b)| a.distance(b)).collect();
    distances.sort_by(f64::total_cmp);
    let mean = distances.iter().sum::<f64>() / distances.len() as f64;
    (mean, distances[distances.len() * 19 / 20])
}

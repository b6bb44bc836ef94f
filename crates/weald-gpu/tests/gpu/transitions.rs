//! Levels of detail blend into each other: nothing leaps as one comes nearer.
//!
//! Seen to fail, on llvmpipe (left of the change over the whole path, against 0.07 to 0.09 of grass and 0.035 of ground):
//! where sets vanish instead of sinking, 0.50 at 15 m, 0.52 at 27 m and 0.44 at 60 m; where rows of blades do not slide
//! together before a coarser list begins, 0.38 at 9 m and 0.48 at 28 m, where lists end for pixels as small
//! as a telescope's; where the ground's vertices do not slide, 0.131.

use crate::flip::{flip, reduced};
use crate::programs::gpu;
use crate::scenes::{above, meadow, mountains, treeless, view};
use weald::picture::{Camera, Image, LitScene, View};
use weald_gpu::{Gpu, RenderOptions, Renderer, TestLook};

/// Pixels of what is drawn, and along a side of those that make one of those that are compared.
const SIZE: [u32; 2] = [480, 270];
const REDUCED: usize = 3;

/// The same of trees, of which a picture takes seconds on software.
const SIZE_OF_TREES: [u32; 2] = [240, 135];

/// Most that may be left of the blades of a meadow, and of the ground.
const MAX_RESIDUE_OF_BLADES: f32 = 0.15;
const MAX_RESIDUE_OF_GROUND: f32 = 0.07;

/// Most that may be left of the trees of woods.
const MAX_RESIDUE_OF_TREES: f32 = 0.15;

/// How often a path is halved.
const CUTS: u32 = 9;

/// ꟻLIP of the pixel that changes most between the ends of a path, from whose points a still camera has its detail; and
/// of what is left of it when the path is halved again and again, each time going on with the half that changes more. What
/// passes smoothly becomes as small as one likes, but for single samples of the 36 of a pixel; a leap stays in one half.
fn leap(renderer: &mut Renderer, camera: &Camera, metres: f32) -> [f32; 2] {
    let mut drawn = |gone: f32| -> Image {
        let from = [0, 1, 2].map(|axis| camera.eye[axis] - gone * camera.forward[axis]);
        let look = TestLook { detail_from: Some(from), ..TestLook::default() };
        reduced(&renderer.render_for_a_test(camera, look).expect("drawn"), REDUCED)
    };
    let mut ends = [0.0, metres].map(|gone| (gone, drawn(gone)));
    let whole = flip(&ends[0].1, &ends[1].1).most;
    let mut left = whole;
    for _ in 0..CUTS {
        let middle = 0.5 * (ends[0].0 + ends[1].0);
        let middle = (middle, drawn(middle));
        let halves = [flip(&ends[0].1, &middle.1).most, flip(&middle.1, &ends[1].1).most];
        ends[usize::from(halves[0] >= halves[1])] = middle;
        left = halves[0].max(halves[1]);
    }
    [whole, left]
}

fn renderer(gpu: &Gpu, scene: &LitScene, size: [u32; 2]) -> Renderer {
    Renderer::new(gpu, scene, RenderOptions { size, samples: 4 }).expect("it can be drawn")
}

/// A meadow through a telescope, so far away.
fn grassy(gpu: &Gpu, distance: f32, field_of_view_deg: f64) -> (Renderer, Camera) {
    let landscape = meadow();
    let scene = LitScene::new(&View { field_of_view_deg, ..treeless() }, &landscape).expect("a scene");
    let mut renderer = renderer(gpu, &scene, SIZE);
    renderer.plant(&scene, &landscape).expect("planted");
    let eye = above(&scene, [60.0, 95.0], 1.2, 0.0, 0.0);
    let ground = scene.top_at([60.0, 95.0 - f64::from(distance)]).expect("on the land");
    (renderer, eye.towards([60.0, eye.eye[1] + distance, ground + 0.1]))
}

#[test]
fn blades_become_coarser_and_sets_sink_without_leaps() {
    let Some(gpu) = gpu() else { return };
    // The farther away, the longer is a path on which as much changes.
    for (distance, angle, path) in [(8.7, 4.0, 1.0), (15.0, 4.0, 1.0), (27.5, 1.5, 1.0), (60.0, 1.5, 2.0)] {
        let (mut renderer, camera) = grassy(&gpu, distance, angle);
        let [whole, left] = leap(&mut renderer, &camera, path);
        println!("grass at {distance} m: {left} left of {whole}");
        assert!(whole > 1.3 * MAX_RESIDUE_OF_BLADES, "at {distance} m hardly anything changes: {whole}");
        assert!(left < MAX_RESIDUE_OF_BLADES, "at {distance} m grass leaps: {left} left of {whole}");
    }
}

#[test]
fn levels_of_the_ground_slide_into_each_other() {
    let Some(gpu) = gpu() else { return };
    // Crowns that are painted on the ground would show more of it than its form.
    let scene = LitScene::new(&treeless(), &mountains()).expect("a scene");
    let mut renderer = renderer(&gpu, &scene, SIZE);
    let camera = above(&scene, [1600.0, 2600.0], 60.0, 12.0, 5.0);
    let [whole, left] = leap(&mut renderer, &camera, 120.0);
    println!("ground: {left} left of {whole}");
    assert!(whole > 1.3 * MAX_RESIDUE_OF_GROUND, "hardly anything changes: {whole}");
    assert!(left < MAX_RESIDUE_OF_GROUND, "the ground leaps: {left} left of {whole}");
}

#[test]
fn trees_of_woods_become_coarser_and_pass_into_the_ground_without_leaps() {
    let Some(gpu) = gpu() else { return };
    let landscape = mountains();
    for (metres, down, angle) in [(40.0, 12.0, 15.0), (150.0, 20.0, 6.0), (300.0, 23.2, 3.0)] {
        let scene = LitScene::new(&View { field_of_view_deg: angle, ..view() }, &landscape).expect("a scene");
        let mut renderer = renderer(&gpu, &scene, SIZE_OF_TREES);
        renderer.plant(&scene, &landscape).expect("planted");
        let camera = above(&scene, [1600.0, 2600.0], metres, down, 5.0);
        let [whole, left] = leap(&mut renderer, &camera, 60.0);
        println!("trees from {metres} m above the ground: {left} left of {whole}");
        assert!(whole > 1.3 * MAX_RESIDUE_OF_TREES, "from {metres} m hardly anything changes: {whole}");
        assert!(left < MAX_RESIDUE_OF_TREES, "from {metres} m trees leap: {left} left of {whole}");
    }
}

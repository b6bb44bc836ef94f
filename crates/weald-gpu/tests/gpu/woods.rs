//! The trees of woods around a camera: those that the scene says stand there, on dry ground, and never on cliffs.

use std::collections::HashMap;

use crate::programs::gpu;
use crate::scenes::{above, lakes, mountains, options, view};
use weald::picture::{LitScene, SPACING_OF_TREES, View};
use weald::{Field, Landscape};
use weald_gpu::{Gpu, Renderer, TestLook};

/// Share of trees that may stand for one and not for the other, by rounding of how dense a wood is.
const APART: f64 = 0.01;

fn renderer(gpu: &Gpu, scene: &LitScene, landscape: &Landscape) -> Renderer {
    let mut renderer = Renderer::new(gpu, scene, options(1)).expect("it can be drawn");
    renderer.plant(scene, landscape).expect("planted");
    renderer
}

/// The roots of the trees around a place, by the squares in which they stand.
fn trees(gpu: &Gpu, scene: &LitScene, landscape: &Landscape) -> HashMap<[i32; 2], [f32; 3]> {
    let mut renderer = renderer(gpu, scene, landscape);
    let camera = above(scene, [1600.0, 1600.0], 60.0, 10.0, 0.0);
    renderer.choose_for_a_test(&camera, TestLook::default()).expect("chosen");
    let roots = renderer.trees_for_a_test().expect("read");
    let square = |root: [f32; 3]| [0, 1].map(|axis: usize| (root[axis] / SPACING_OF_TREES).floor() as i32);
    roots.into_iter().map(|root| (square(root), root)).collect()
}

#[test]
fn the_trees_that_are_drawn_are_those_of_the_scene_and_stand_on_its_ground() {
    let Some(gpu) = gpu() else { return };
    let landscape = lakes();
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let drawn = trees(&gpu, &scene, &landscape);
    let middle = [1600.0, -1600.0].map(|at| (at / SPACING_OF_TREES) as i32);
    let (mut all, mut apart, mut conifers) = (0, 0, 0);
    for number in 0..200 * 200 {
        let square = [middle[0] - 100 + number % 200, middle[1] - 100 + number / 200];
        let (found, known) = (drawn.get(&square), scene.tree_in(square));
        all += usize::from(found.is_some());
        apart += usize::from(found.is_some() != known.is_some());
        if let (Some(root), Some((tree, is_conifer))) = (found, known) {
            let [east, north] = tree.place;
            let ground = scene.bed_at([f64::from(east), f64::from(-north)]).expect("on the land");
            assert!((root[0] - east).abs() < 1e-2 && (root[1] - north).abs() < 1e-2, "{root:?} {tree:?}");
            assert!((root[2] - ground).abs() < 0.02, "{root:?} on ground at {ground} m");
            conifers += usize::from(is_conifer);
        }
    }
    println!("{all} trees, {conifers} conifers, {apart} apart");
    assert!(
        all > 4000 && conifers > all / 20 && conifers < all * 19 / 20,
        "{all} trees, {conifers} conifers"
    );
    assert!((apart as f64) < APART * all as f64, "{apart} of {all} stand for one alone");
}

#[test]
fn no_tree_stands_in_a_lake_or_on_a_cliff_or_above_the_tree_line() {
    let Some(gpu) = gpu() else { return };
    let landscape = lakes();
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let drawn = trees(&gpu, &scene, &landscape);
    let bare = trees(&gpu, &scene_of(&View { tree_line: Some(-5000.0), ..view() }, &landscape), &landscape);
    assert!(drawn.len() > 4000 && bare.is_empty(), "{} and {}", drawn.len(), bare.len());
    let (mut steepest, mut lakes) = (0.0_f32, 0);
    for [east, north, _] in drawn.into_values() {
        let at = |x: f32, y: f32| [f64::from(east + x), f64::from(-(north + y))];
        let [bed, top] =
            [scene.bed_at(at(0.0, 0.0)), scene.top_at(at(0.0, 0.0))].map(|height| height.expect("on land"));
        assert!(top - bed < 0.3, "a tree in water {} m deep", top - bed);
        if let (Some(x), Some(y)) = (scene.bed_at(at(1.0, 0.0)), scene.bed_at(at(0.0, 1.0))) {
            steepest = steepest.max((x - bed).hypot(y - bed));
        }
        lakes += usize::from(
            scene.top_at(at(20.0, 0.0)).zip(scene.bed_at(at(20.0, 0.0))).is_some_and(|(top, bed)| top > bed),
        );
    }
    assert!(lakes > 5, "woods reach the lakes, else this would mean little");
    assert!(steepest < 1.25, "a tree on a slope of {steepest}");
}

fn scene_of(view: &View, landscape: &Landscape) -> LitScene {
    LitScene::new(view, landscape).expect("a scene")
}

/// The middle of a part of the woods where each of seven by seven squares has a tree.
fn dense_wood(scene: &LitScene) -> [f64; 2] {
    let is_dense =
        |[x, y]: [i32; 2]| (0..49).all(|at| scene.tree_in([x + at % 7 - 3, y - at / 7 + 3]).is_some());
    let squares = (0..200 * 200).map(|at| [100 + at % 200, -100 - at / 200]);
    let [x, y] = squares.into_iter().find(|&square| is_dense(square)).expect("a wood");
    [x, -y].map(|square| f64::from(square) * f64::from(SPACING_OF_TREES))
}

#[test]
fn a_picture_from_under_crowns_is_exposed_for_their_shade_and_one_from_above_them_is_not() {
    let Some(gpu) = gpu() else { return };
    let landscape = mountains();
    let scene = scene_of(&View { woods: 1.0, ..view() }, &landscape);
    let mut renderer = renderer(&gpu, &scene, &landscape);
    let place = dense_wood(&scene);
    let mut brightness = |metres: f32| {
        let bytes = renderer.render(&above(&scene, place, metres, 35.0, 0.0)).expect("drawn").rgb;
        bytes.iter().map(|&byte| f64::from(byte)).sum::<f64>() / bytes.len() as f64
    };
    let [under, above_all] = [1.7, 60.0].map(&mut brightness);
    println!("{under} under crowns, {above_all} above them");
    assert!(under > 45.0, "the ground of a wood is black: {under} of 255");
    assert!(
        (25.0..55.0).contains(&above_all),
        "from above it is exposed for open ground: {above_all} of 255"
    );
}

#[test]
fn ground_that_rises_lifts_its_trees() {
    let Some(gpu) = gpu() else { return };
    let landscape = mountains();
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let mut renderer = renderer(&gpu, &scene, &landscape);
    let camera = above(&scene, [1600.0, 1600.0], 60.0, 10.0, 0.0);
    let highest = |renderer: &mut Renderer| {
        renderer.choose_for_a_test(&camera, TestLook::default()).expect("chosen");
        let roots = renderer.trees_for_a_test().expect("read");
        roots
            .into_iter()
            .map(|[east, north, up]| ([east.to_bits(), north.to_bits()], up))
            .collect::<HashMap<_, _>>()
    };
    let before = highest(&mut renderer);
    let mut raised = landscape.clone();
    let height = landscape.field("height").expect("there");
    let values = height.values().iter().map(|height| height + 25.0).collect();
    raised.insert("height", "m", Field::from_values(height.size(), values));
    let scene = scene.changed(&view(), &raised).expect("a scene");
    renderer.update(weald_gpu::SceneUpdate::of(&scene)).expect("taken");
    renderer.render(&camera).expect("drawn");
    let after = highest(&mut renderer);
    let risen = before.iter().filter_map(|(at, up)| Some(after.get(at)? - up));
    let risen: Vec<_> = risen.collect();
    assert!(risen.len() > 1000, "{}", risen.len());
    assert!(risen.iter().all(|risen| (risen - 25.0).abs() < 0.1));
}

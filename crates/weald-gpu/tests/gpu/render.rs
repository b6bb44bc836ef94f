//! What is drawn on a device: without cracks, without leaps, the same twice, and as the ray-marched view has it.

use crate::marched::{PIXELS, distances, distances_of};
use crate::programs::gpu;
use crate::scenes::{above, lakes, meadow, mountains, options, view};
use weald::grid::Mask;
use weald::material::Material;
use weald::parameter::Nested;
use weald::picture::{Camera, Drape, GroundColour, Image, LitScene, RayMarcher, Scale, View};
use weald::{Error, Landscape};
use weald_gpu::{Gpu, RenderOptions, Renderer, TestLook, Timings};

pub(crate) fn renderer(gpu: &Gpu, scene: &LitScene, samples: u32) -> Renderer {
    Renderer::new(gpu, scene, options(samples)).expect("it can be drawn")
}

fn is_magenta(pixel: [u8; 3]) -> bool {
    let [r, g, b] = pixel.map(i32::from);
    r - g > 60 && b - g > 60
}

pub(crate) fn magenta(image: &Image) -> usize {
    image.rgb.chunks_exact(3).filter(|pixel| is_magenta([pixel[0], pixel[1], pixel[2]])).count()
}

#[test]
fn closed_ground_has_no_cracks_from_any_camera() {
    let Some(gpu) = gpu() else { return };
    let scene = LitScene::new(&view(), &mountains()).expect("a scene");
    let mut renderer = renderer(&gpu, &scene, 1);
    let bare = TestLook { bare: true, ..TestLook::default() };
    let up = Camera::looking([1600.0, -1600.0, 900.0], [0.0, 0.6, 0.8], scene.camera().half);
    let sky = renderer.render_for_a_test(&up, bare).expect("drawn");
    assert_eq!(magenta(&sky), 320 * 180, "what nothing drew on is seen");
    let mut levels = 0;
    for look in 0..24_u16 {
        let look = f32::from(look);
        let place =
            [1600.0 + 300.0 * f64::from((look * 2.4).sin()), 1700.0 + 300.0 * f64::from((look * 1.7).cos())];
        let camera = above(&scene, place, 15.0 + 12.0 * look, 32.0 + look, 47.0 * look);
        let image = renderer.render_for_a_test(&camera, bare).expect("drawn");
        assert_eq!(magenta(&image), 0, "cracks from camera {look}");
        levels += u32::from(renderer.triangles(&camera).expect("counted") > 20_000);
    }
    assert!(levels > 5, "the pictures have much ground");
}

/// Greatest change of a channel, and the mean of all.
fn change(a: &Image, b: &Image) -> (u8, f64) {
    let changes = a.rgb.iter().zip(&b.rgb).map(|(a, b)| a.abs_diff(*b));
    let (mut most, mut sum) = (0, 0.0);
    for change in changes {
        most = most.max(change);
        sum += f64::from(change);
    }
    (most, sum / a.rgb.len() as f64)
}

#[test]
fn a_picture_drawn_twice_is_the_same_to_the_bit() {
    let Some(gpu) = gpu() else { return };
    let scene = LitScene::new(&view(), &mountains()).expect("a scene");
    let camera = scene.camera();
    let mut renderer = renderer(&gpu, &scene, 4);
    let once = renderer.render(&camera).expect("drawn");
    let other = above(&scene, [1600.0, 1600.0], 200.0, 20.0, 30.0);
    assert_ne!(renderer.render(&other).expect("drawn"), once, "another camera sees something else");
    assert_eq!(renderer.render(&camera).expect("drawn"), once);
    let mut again = self::renderer(&gpu, &scene, 4);
    assert_eq!(again.render(&camera).expect("drawn"), once);
}

#[test]
fn two_views_that_are_encoded_before_either_is_drawn_are_those_that_are_drawn_alone() {
    let Some(gpu) = gpu() else { return };
    let landscape = meadow();
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let mut renderer = renderer(&gpu, &scene, 1);
    renderer.plant(&scene, &landscape).expect("planted");
    let [one, other] =
        [above(&scene, [60.0, 80.0], 1.6, 8.0, 0.0), above(&scene, [30.0, 40.0], 30.0, 40.0, 90.0)];
    let alone = [&one, &other].map(|camera| renderer.render(camera).expect("drawn"));
    assert_ne!(alone[0], alone[1]);
    assert_eq!(renderer.two_for_a_test([&one, &other]).expect("drawn"), alone);
}

#[test]
fn a_renderer_that_was_resized_500_times_draws_as_a_new_one_and_holds_no_more() {
    let Some(gpu) = gpu() else { return };
    // An account of its own: other tests draw at the same time.
    let gpu = gpu.with_memory(1 << 30).expect("is there");
    let scene = LitScene::new(&view(), &mountains()).expect("a scene");
    let camera = scene.camera();
    for samples in [1, 4] {
        let mut renderer = renderer(&gpu, &scene, samples);
        let at_first = renderer.render(&camera).expect("drawn");
        let held = gpu.allocated();
        for number in 0..500 {
            let size = [40 + number * 37 % 200, 30 + number * 53 % 150];
            renderer.resize(size).expect("fits");
            if number % 100 == 99 {
                let image = renderer.render(&camera).expect("drawn");
                let options = RenderOptions { size, samples };
                let mut fresh = Renderer::new(&gpu, &scene, options).expect("it can be drawn");
                assert!(image == fresh.render(&camera).expect("drawn"), "after {number} sizes");
            }
        }
        renderer.resize([320, 180]).expect("fits");
        assert!(renderer.render(&camera).expect("drawn") == at_first, "{samples} samples");
        assert_eq!(gpu.allocated(), held, "something is still held");
        assert!(renderer.resize([0, 180]).is_err() && renderer.resize([1 << 20, 180]).is_err());
        assert!(renderer.render(&camera).expect("drawn") == at_first, "what was refused changes nothing");
    }
}

#[test]
fn ground_sky_and_sides_have_the_colours_of_the_ray_marched_view() {
    let Some(gpu) = gpu() else { return };
    let landscape = mountains();
    // A sun overhead throws no shadows.
    let view = View { sun_altitude_deg: 90.0, ..view() };
    let scene = LitScene::new(&view, &landscape).expect("a scene");
    let low = above(&scene, [1500.0, 2700.0], 90.0, 4.0, 0.0);
    for camera in [None, Some(low)] {
        let (mean, worst) = distances(&gpu, &view, &landscape, camera);
        // 0.02 is about the least difference that the eye sees.
        assert!(mean < 0.006 && worst < 0.02, "mean {mean}, one in twenty {worst}");
    }
}

#[test]
fn crowns_of_far_woods_hide_those_behind_them_as_in_the_ray_marched_view() {
    let Some(gpu) = gpu() else { return };
    let landscape = mountains();
    // Through a telescope squares of the pictures are smaller than crowns, and no tree is so near that it is drawn as such.
    let view = View { sun_altitude_deg: 60.0, field_of_view_deg: 4.0, ..view() };
    let scene = LitScene::new(&view, &landscape).expect("a scene");
    let far = above(&scene, [1600.0, 3100.0], 250.0, 8.0, 0.0);
    let (mean, worst) = distances(&gpu, &view, &landscape, Some(far));
    assert!(mean < 0.004 && worst < 0.015, "mean {mean}, one in twenty {worst}");
}

/// Metres east and south of the steepest cell that is not near the border, and the angle from north of what lies uphill.
fn steepest(landscape: &Landscape) -> ([f64; 2], f32) {
    let (height, cell) = (landscape.field("height").expect("there"), landscape.domain.cell);
    let columns = height.size().columns;
    let rise = |x: usize, y: usize| {
        let at = |x: usize, y: usize| height.values()[y * columns + x];
        [at(x + 1, y) - at(x - 1, y), at(x, y - 1) - at(x, y + 1)]
    };
    let inside = (30..130).flat_map(|y| (30..130).map(move |x| (x, y)));
    let steep = |&(x, y): &(usize, usize)| rise(x, y)[0].hypot(rise(x, y)[1]);
    let (x, y) = inside.max_by(|a, b| steep(a).total_cmp(&steep(b))).expect("cells");
    let [east, north] = rise(x, y);
    ([x, y].map(|at| (at as f64 + 0.5) * cell), east.atan2(north).to_degrees())
}

/// The same of beds of unlike colours, the lowest of which begins below all ground.
fn with_beds(mut landscape: Landscape) -> Landscape {
    let (low, high) = landscape.field("height").expect("there").range(None).expect("cells");
    landscape.materials.truncate(1);
    for bed in 0..7_u8 {
        let share = f64::from(bed) / 6.0 - 0.1;
        landscape.materials.push(Material {
            name: format!("bed_{bed}"),
            bottom: Some(f64::from(low) + share * f64::from(high - low)),
            colour: if bed % 2 == 0 { [0.7, 0.3, 0.2] } else { [0.8, 0.75, 0.6] },
            ..Material::built_in("clay").expect("built in")
        });
    }
    landscape
}

#[test]
fn walls_and_bushes_of_materials_have_the_colours_of_the_ray_marched_view() {
    let Some(gpu) = gpu() else { return };
    walls_and_bushes_agree(&gpu, &mountains(), [[0.003, 0.012], [0.001, 0.003]]);
    // Edges between beds of unlike colours are less than a pixel off here and there.
    walls_and_bushes_agree(&gpu, &with_beds(mountains()), [[0.0055, 0.0245], [0.0035, 0.0175]]);
}

fn walls_and_bushes_agree(gpu: &Gpu, landscape: &Landscape, [far, near_bounds]: [[f64; 2]; 2]) {
    let (wall, uphill) = steepest(landscape);
    for sun_altitude_deg in [90.0, 50.0] {
        // A device shades a pixel once, so it is compared with one ray a pixel: many show what is finer than a pixel.
        let view = View { sun_altitude_deg, samples: 1, ground: Some(GroundColour::Materials), ..view() };
        let scene = LitScene::new(&view, landscape).expect("a scene");
        let low = above(&scene, [1500.0, 2700.0], 90.0, 4.0, 0.0);
        // From there squares of the pictures are smaller than blocks of the wall, and what stones add is not seen.
        let near = above(&scene, wall, 150.0, 55.0, uphill);
        let cragged = LitScene::with_crags(&view, landscape).expect("a scene");
        let mut marcher = RayMarcher::of(cragged, PIXELS);
        for (camera, bounds) in [(marcher.scene().camera(), far), (low, far), (near, near_bounds)] {
            marcher.look_from(camera, PIXELS);
            let (mean, worst) = distances_of(gpu, &marcher);
            assert!(
                mean < bounds[0] && worst < bounds[1],
                "sun at {sun_altitude_deg}°: mean {mean}, one in twenty {worst}, at most {bounds:?}"
            );
        }
    }
}

#[test]
fn a_draped_layer_has_the_colours_of_the_ray_marched_view() {
    let Some(gpu) = gpu() else { return };
    let drape = Some(Nested(Drape { ramp: Scale::Balance, ..Drape::of("height") }));
    let view = View { sun_altitude_deg: 90.0, drape, ..view() };
    let (mean, worst) = distances(&gpu, &view, &mountains(), None);
    assert!(mean < 0.006 && worst < 0.02, "mean {mean}, one in twenty {worst}");
    let (other, _) = distances(&gpu, &View { drape: None, ..view }, &mountains(), None);
    assert!(other < 0.006, "{other}");
}

#[test]
fn shadows_lie_where_the_ray_marched_view_has_them() {
    let Some(gpu) = gpu() else { return };
    let landscape = mountains();
    for altitude in [14.0, 30.0] {
        // One ray a pixel, as a device shades it once: many show crags that are finer than a pixel.
        let view = View { sun_altitude_deg: altitude, azimuth_deg: 120.0, samples: 1, ..view() };
        let scene = LitScene::new(&view, &landscape).expect("a scene");
        let low = above(&scene, [1500.0, 2700.0], 90.0, 4.0, 60.0);
        for camera in [None, Some(low)] {
            let (mean, worst) = distances(&gpu, &view, &landscape, camera);
            // Crags throw shadows that are finer than the texels of a cascade, edges of one ray a pixel are ragged, and the ground
            // lies off by up to one and a half pixels: 0.0055 and 0.0236, less than 0.005 and 0.022 with one.
            assert!(mean < 0.006 && worst < 0.025, "sun at {altitude}°: mean {mean}, one in twenty {worst}");
        }
    }
}

#[test]
fn lakes_lie_where_the_ray_marched_view_has_them_in_its_colours() {
    let Some(gpu) = gpu() else { return };
    let landscape = lakes();
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let low = above(&scene, [1500.0, 2700.0], 250.0, 20.0, 0.0);
    for camera in [None, Some(low)] {
        let (mean, worst) = distances(&gpu, &view(), &landscape, camera);
        // It mirrors the land at the same places, but with finer ripples: 0.0101, less than 0.010 where the ground was off by a pixel.
        assert!(mean < 0.011 && worst < 0.05, "mean {mean}, one in twenty {worst}");
    }
}

#[test]
fn water_moves_with_time_and_nothing_else_does() {
    let Some(gpu) = gpu() else { return };
    let (wet, dry) = (lakes(), mountains());
    // Over the deepest place that is not at the edge.
    let water = wet.field("water").expect("there");
    let cells = (40..120).flat_map(|y| (40..120).map(move |x| (x, y)));
    let deepest = cells.max_by(|a, b| water.at(a.0, a.1).total_cmp(&water.at(b.0, b.1))).expect("cells");
    let place = [20.0 * (deepest.0 as f64 + 0.5), 20.0 * (deepest.1 as f64 + 0.5)];
    let moved = |landscape: &Landscape| {
        let scene = LitScene::new(&view(), landscape).expect("a scene");
        let camera = above(&scene, place, 12.0, 18.0, 0.0);
        let mut renderer = renderer(&gpu, &scene, 1);
        let first = renderer.render(&camera).expect("drawn");
        renderer.set_time(0.7);
        change(&first, &renderer.render(&camera).expect("drawn"))
    };
    let (most, mean) = moved(&wet);
    assert!(most > 8 && mean > 0.2, "the water stands still: {most}, {mean}");
    assert_eq!(moved(&dry), (0, 0.0));
}

#[test]
fn what_has_no_data_is_open_and_has_walls() {
    let Some(gpu) = gpu() else { return };
    let mut landscape = mountains();
    let size = landscape.domain.size;
    let island = |cell: usize| {
        let [x, y] = [cell % size.columns, cell / size.columns].map(|at| at as f64 - 80.0);
        (15.0..70.0).contains(&x.hypot(y))
    };
    landscape.domain.valid = Mask::new(size, (0..size.cells()).map(island).collect());
    let view = View { sun_altitude_deg: 90.0, ..view() };
    let (mean, worst) = distances(&gpu, &view, &landscape, None);
    assert!(mean < 0.012 && worst < 0.05, "mean {mean}, one in twenty {worst}");
}

/// Share of the channels in which two pictures differ by more than eight bytes.
fn share_changed(a: &Image, b: &Image) -> f64 {
    let changed = a.rgb.iter().zip(&b.rgb).filter(|(a, b)| a.abs_diff(**b) > 8).count();
    changed as f64 / a.rgb.len() as f64
}

#[test]
fn grass_stands_around_the_camera_thins_out_and_sways() {
    let Some(gpu) = gpu() else { return };
    let landscape = meadow();
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let near = above(&scene, [60.0, 70.0], 1.5, 12.0, 0.0);
    let mut renderer = renderer(&gpu, &scene, 4);
    let drawn = |renderer: &mut Renderer, camera| renderer.render(camera).expect("drawn");
    let high = near.at([60.0, -70.0, 130.0]);
    let (bare, bare_high) = (drawn(&mut renderer, &near), drawn(&mut renderer, &high));
    renderer.plant(&scene, &landscape).expect("planted");
    let grown = drawn(&mut renderer, &near);
    assert!(share_changed(&bare, &grown) > 0.2, "blades stand before the ground");
    assert_eq!(drawn(&mut renderer, &high), bare_high, "from 130 m none is seen");
    assert_eq!(drawn(&mut renderer, &near), grown, "the same to the bit, in whatever order threads run");
    renderer.set_time(0.8);
    let later = drawn(&mut renderer, &near);
    let swayed = share_changed(&grown, &later);
    assert!(swayed > 0.02, "a share of {swayed} moved in the wind");
}

#[test]
fn what_is_made_with_its_plants_draws_what_is_planted_later() {
    let Some(gpu) = gpu() else { return };
    for (landscape, grows) in [(meadow(), true), (mountains(), false)] {
        let scene = LitScene::new(&View { woods: 0.0, ..view() }, &landscape).expect("a scene");
        let camera = above(&scene, [60.0, 70.0], 1.5, 12.0, 0.0);
        let mut later = renderer(&gpu, &scene, 4);
        let bare = later.render(&camera).expect("drawn");
        later.plant(&scene, &landscape).expect("planted");
        let mut planted = Renderer::planted(&gpu, (&scene, &landscape), options(4)).expect("made");
        let drawn = planted.render(&camera).expect("drawn");
        assert_eq!(drawn, later.render(&camera).expect("drawn"));
        assert_eq!(drawn != bare, grows, "plants are seen where they grow");
    }
}

#[test]
fn the_parts_of_a_picture_take_time_and_no_more_than_all_of_it() {
    let Some(gpu) = gpu() else { return };
    for landscape in [lakes(), meadow()] {
        let scene = LitScene::new(&view(), &landscape).expect("a scene");
        let mut renderer = renderer(&gpu, &scene, 4);
        renderer.plant(&scene, &landscape).expect("planted");
        let camera = above(&scene, [60.0, 70.0], 1.5, 12.0, 0.0);
        let before = renderer.render(&camera).expect("drawn");
        let timings = renderer.measure(&camera, 1).expect("lavapipe has a clock");
        let Timings { choice, shadows, ground, water, behind, grass, plants, tone_mapping, picture } =
            timings;
        assert!(
            [shadows, ground, behind, grass, plants, tone_mapping].iter().all(|part| !part.is_zero()),
            "{timings:?}"
        );
        assert!(
            choice + shadows + ground + water + behind + grass + plants + tone_mapping <= picture,
            "{timings:?}"
        );
        assert_eq!(renderer.render(&camera).expect("drawn"), before, "measuring changes nothing");
    }
}

#[test]
fn sizes_and_cameras_that_cannot_be_drawn_are_refused() {
    let Some(gpu) = gpu() else { return };
    let scene = LitScene::new(&view(), &mountains()).expect("a scene");
    // A budget that no other test takes from.
    let gpu = gpu.with_memory(1 << 30).expect("a legal budget");
    let held = gpu.allocated();
    for (size, samples) in [([0, 10], 1), ([10, 100_000], 4), ([320, 180], 3), ([320, 180], 64)] {
        let error = Renderer::new(&gpu, &scene, RenderOptions { size, samples }).expect_err("refused");
        assert!(matches!(error, Error::Limit(_)), "{error}");
        assert_eq!(gpu.allocated(), held, "nothing was allocated");
    }
    let mut renderer = renderer(&gpu, &scene, 1);
    for number in [f32::NAN, f32::INFINITY] {
        let camera = scene.camera().at([number, 0.0, 10.0]);
        assert!(renderer.render(&camera).expect_err("refused").to_string().contains("finite"));
    }
    drop(renderer);
    assert_eq!(gpu.allocated(), held, "all is given back");
}

#[test]
fn errors_of_drawing_advise_what_helps_to_draw() {
    if gpu().is_none() {
        return;
    }
    let open = || Gpu::for_drawing().expect("there is a device");
    let gpu = open().with_memory(1 << 20).expect("a legal budget");
    let scene = LitScene::new(&view(), &mountains()).expect("a scene");
    let error = Renderer::new(&gpu, &scene, options(4)).expect_err("a mebibyte is too little").to_string();
    assert!(error.contains("--gpu-memory, a smaller picture") && !error.contains("--engine"), "{error}");
    let gpu = open();
    gpu.lose();
    let error = Renderer::new(&gpu, &scene, options(4)).expect_err("it is lost").to_string();
    assert!(error.contains("was lost") && !error.contains("--engine"), "{error}");
}

//! Land and sea that go on to the horizon: as the ray-marched view has them, and without an end.

use crate::flip::flip;
use crate::marched::{PIXELS, distances_of};
use crate::programs::gpu;
use crate::render::{magenta, renderer};
use crate::scenes::{above, lakes, mountains, options, view};
use weald::Landscape;
use weald::picture::{Around, Camera, LitScene, RayMarcher, View};
use weald_gpu::{Renderer, TestLook};

/// A sun overhead, which throws no shadows: the march knows none of those that the ground around throws.
fn open() -> View {
    // One ray a pixel, as a device shades it once.
    View {
        samples: 1,
        around: Some(Around::Horizon),
        sun_altitude_deg: 90.0,
        visibility: Some(40_000.0),
        ..view()
    }
}

/// The mountains, of which a sea covers the lowest third.
fn coast() -> Landscape {
    let mut landscape = lakes();
    let (low, high) = landscape.field("height").expect("there").range(None).expect("cells");
    landscape.domain.sea_level = Some(f64::from(low + 0.35 * (high - low)));
    landscape
}

/// Cameras within near the border and beyond it, that look inward and outward.
fn cameras(scene: &LitScene) -> Vec<Camera> {
    let inward = above(scene, [1600.0, 3100.0], 150.0, 8.0, 0.0);
    let outward = above(scene, [1600.0, 3100.0], 150.0, 8.0, 180.0);
    let beyond = scene.above_ground([1600.0, 5200.0], 250.0);
    vec![inward, outward, inward.at(beyond), outward.at(beyond), scene.camera()]
}

#[test]
fn what_goes_on_to_the_horizon_looks_as_the_ray_marched_view_has_it() {
    let Some(gpu) = gpu() else { return };
    for landscape in [mountains(), coast()] {
        let scene = LitScene::with_crags(&open(), &landscape).expect("a scene");
        let cameras = cameras(&scene);
        let mut marcher = RayMarcher::of(scene, PIXELS);
        for (number, camera) in cameras.into_iter().enumerate() {
            marcher.look_from(camera, PIXELS);
            let (mean, worst) = distances_of(&gpu, &marcher);
            assert!(mean < 0.015 && worst < 0.05, "camera {number}: mean {mean}, one in twenty {worst}");
        }
    }
}

#[test]
fn the_sea_beyond_the_border_is_found_with_one_sample_as_with_four() {
    let Some(gpu) = gpu() else { return };
    let scene = LitScene::new(&open(), &coast()).expect("a scene");
    let drawn = |samples: u32, camera: &Camera| {
        let mut renderer = Renderer::new(&gpu, &scene, options(samples)).expect("it can be drawn");
        renderer.render(camera).expect("drawn")
    };
    // Of far water, and of water that is close by.
    let from_above = above(&scene, [1600.0, 3100.0], 900.0, 25.0, 180.0);
    let sea_level = coast().domain.sea_level.expect("a sea") as f32;
    let places =
        (0..1000_u16).map(|number| [f64::from(number % 20) * 200.0, 3300.0 + 50.0 * f64::from(number / 20)]);
    let mut tops = places.map(|place| scene.above_ground(place, 0.0));
    let [x, y, _] = tops.find(|top| top[2] < sea_level + 0.5).expect("some sea beyond the border");
    let low = from_above.at([x, y, sea_level + 12.0]);
    for camera in [from_above, low] {
        let found = flip(&drawn(1, &camera), &drawn(4, &camera)).mean;
        // 0.008 and 0; were none found, 0.068 and 0.335.
        assert!(found < 0.03, "{found}");
    }
}

#[test]
fn clouds_and_their_shadows_are_where_the_ray_marched_view_has_them() {
    let Some(gpu) = gpu() else { return };
    let landscape = mountains();
    let clear = LitScene::new(&open(), &landscape).expect("a scene");
    let upward = Camera {
        forward: [0.0, 0.8, 0.6],
        up: [0.0, -0.6, 0.8],
        ..above(&clear, [1600.0, 3100.0], 150.0, 8.0, 0.0)
    };
    // From below, from afar, from among them and from above.
    let among = above(&clear, [1600.0, 3100.0], 2200.0, 8.0, 0.0);
    let over = above(&clear, [1600.0, 3100.0], 4500.0, 35.0, 40.0);
    let cloudy = View { clouds: 0.6, ..open() };
    let [mut clear, mut cloudy] = [&open(), &cloudy]
        .map(|view| RayMarcher::of(LitScene::with_crags(view, &landscape).expect("a scene"), PIXELS));
    for camera in [upward, clear.scene().camera(), among, over] {
        clear.look_from(camera, PIXELS);
        cloudy.look_from(camera, PIXELS);
        let (mean, worst) = distances_of(&gpu, &cloudy);
        assert!(mean < 0.015 && worst < 0.05, "mean {mean}, one in twenty {worst}");
        let [cloudy, clear] = [&cloudy, &clear]
            .map(|marcher| renderer(&gpu, marcher.scene(), 4).render(&camera).expect("drawn"));
        let changed = cloudy.rgb.iter().zip(&clear.rgb).filter(|(a, b)| a.abs_diff(**b) > 12).count();
        assert!(changed * 10 > cloudy.rgb.len(), "{changed} of {} bytes show clouds", cloudy.rgb.len());
    }
}

#[test]
fn no_camera_sees_an_end_or_a_crack_of_what_goes_on() {
    let Some(gpu) = gpu() else { return };
    for landscape in [mountains(), coast()] {
        let scene = LitScene::new(&open(), &landscape).expect("a scene");
        let mut renderer = renderer(&gpu, &scene, 1);
        let bare = TestLook { bare: true, ..TestLook::default() };
        for look in 0..12_u16 {
            let look = f32::from(look);
            let [east, south] =
                [(look * 2.4).sin(), (look * 1.7).cos()].map(|at| 1600.0 + 4000.0 * f64::from(at));
            let (down, turn) = ((25.0 + look).to_radians(), (47.0 * look).to_radians());
            let forward = [down.cos() * turn.sin(), down.cos() * turn.cos(), -down.sin()];
            let eye = scene.above_ground([east, south], 40.0 + 20.0 * f64::from(look));
            let camera = Camera::looking(eye, forward, scene.camera().half);
            let image = renderer.render_for_a_test(&camera, bare).expect("drawn");
            assert_eq!(magenta(&image), 0, "from {east}, {south}, camera {look}");
        }
    }
}

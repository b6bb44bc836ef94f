//! Scattered plants on a device: they bend as on the CPU, are each drawn once, throw shadows, and change without leaps.

use crate::programs::gpu;
use weald::Landscape;
use weald::grow::ifs::foliage::Habit;
use weald::grow::ifs::limbs::{Limbs, wind_on};
use weald::grow::ifs::shapes;
use weald::grow::wind::push;
use weald::picture::{Camera, Image, LitScene, View};
use weald::random::{splitmix64, unit};
use weald::recipe::{Overrides, Recipe};
use weald_gpu::{Gpu, RenderOptions, Renderer, TestLook, bend_limbs};

const SIZE: [u32; 2] = [320, 180];

/// How far a point of a plant of one metre may be from the CPU's.
const APART: f32 = 2e-5;

#[test]
fn ten_thousand_points_of_plants_bend_as_on_the_cpu() {
    let Some(gpu) = gpu() else { return };
    for name in ["fern", "shrub", "fern-3d"] {
        let ifs = shapes::find(name).expect("built in").ifs();
        let plant = Limbs::of(&ifs, Habit::of(&ifs, None));
        let random = |number: u64, purpose: u64| unit(splitmix64(number ^ splitmix64(purpose))) as f32;
        let corner = |n: u64| &plant.corners[(random(n, 1) * plant.corners.len() as f32) as usize];
        let wind = |n: u64| [900.0 * random(n, 2), -900.0 * random(n, 3), 100.0 * random(n, 4)];
        let inputs = 0..10_000_u64;
        let rests: Vec<_> = inputs
            .clone()
            .map(|n| {
                let [x, y, z] = corner(n).rest;
                [x, y, z, corner(n).along]
            })
            .collect();
        let winds: Vec<_> = inputs
            .clone()
            .map(|n| {
                let [x, y, t] = wind(n);
                [x, y, t, corner(n).limb as f32]
            })
            .collect();
        let found = bend_limbs(&gpu, &plant.limbs, &rests, &winds).expect("bent");
        let (mut apart, mut pushed, mut moved) = (0.0_f32, 0.0_f32, 0);
        for (n, (point, felt)) in inputs.zip(found) {
            let ([east, north, seconds], corner) = (wind(n), corner(n));
            let by = push([east, north], seconds, 0.0);
            let breeze = wind_on(by, seconds, 0.0);
            let cpu = plant.bent(&breeze, corner.limb, corner.along, corner.rest);
            let distance = |a: [f32; 3], b: [f32; 3]| (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f32::max);
            apart = apart.max(distance(point, cpu));
            pushed = (0..2).map(|i| (felt[i] - by[i]).abs()).fold(pushed, f32::max);
            moved += usize::from(distance(cpu, corner.rest) > 0.02);
        }
        println!("{name}: points off by {apart:.1e} m, pushes by {pushed:.1e}");
        assert!(moved > 3000, "{moved} moved: else agreement would mean little");
        assert!(apart < APART && pushed < 1e-5, "{apart:e} {pushed:e}");
    }
}

/// Gentle ground, 120 m wide, with so many ferns.
fn ferns(count: u32, size: [f32; 2]) -> Landscape {
    let text = format!(
        "[landscape]\nsize = 60\ncell = 2.0\nseed = 5\n[[step]]\ndo = \"fbm\"\nrelief = 6.0\n\
         [[step]]\ndo = \"scatter\"\nplant = \"fern\"\ncount = {count}\nspacing = 0.5\nsize = {size:?}\n\
         into = \"ferns\"\n[[output]]\nlayer = \"height\"\nfile = \"a.tif\"\n"
    );
    let recipe = Recipe::parse("ferns.toml", &text, &Overrides::default()).expect("a recipe");
    recipe.landscape().expect("ferns")
}

fn view() -> View {
    let [width, height] = SIZE;
    View {
        width,
        height,
        field_of_view_deg: 50.0,
        visibility: Some(20_000.0),
        // No woods.
        tree_line: Some(-1000.0),
        ..View::default()
    }
}

fn renderer(gpu: &Gpu, scene: &LitScene) -> Renderer {
    Renderer::new(gpu, scene, RenderOptions { size: SIZE, samples: 4 }).expect("it can be drawn")
}

/// A camera so many metres above the ground of a place, looking northward and down by an angle.
fn above(scene: &LitScene, [east, south]: [f64; 2], metres: f32, down_deg: f32) -> Camera {
    let ground = scene.top_at([east, south]).expect("on the land");
    let down = down_deg.to_radians();
    let eye = [east as f32, -south as f32, ground + metres];
    Camera::looking(eye, [0.0, down.cos(), -down.sin()], scene.camera().half)
}

/// Share of the channels in which two pictures differ by more than eight bytes.
fn share_changed(a: &Image, b: &Image) -> f64 {
    let changed = a.rgb.iter().zip(&b.rgb).filter(|(a, b)| a.abs_diff(**b) > 8).count();
    changed as f64 / a.rgb.len() as f64
}

#[test]
fn plants_stand_before_the_ground_and_sway() {
    let Some(gpu) = gpu() else { return };
    let landscape = ferns(600, [0.8, 1.2]);
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let camera = above(&scene, [60.0, 70.0], 1.7, 15.0);
    let mut renderer = renderer(&gpu, &scene);
    let bare = renderer.render(&camera).expect("drawn");
    renderer.plant(&scene, &landscape).expect("planted");
    let grown = renderer.render(&camera).expect("drawn");
    assert!(share_changed(&bare, &grown) > 0.05, "{}", share_changed(&bare, &grown));
    assert_eq!(renderer.render(&camera).expect("drawn"), grown, "the same again");
    renderer.set_time(0.8);
    let later = renderer.render(&camera).expect("drawn");
    let swayed = share_changed(&grown, &later);
    assert!(swayed > 0.01, "a share of {swayed} moved in the wind");
}

#[test]
fn a_camera_that_moves_sees_what_one_does_that_comes_from_nowhere() {
    let Some(gpu) = gpu() else { return };
    let landscape = ferns(600, [0.8, 1.2]);
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let planted = || {
        let mut renderer = renderer(&gpu, &scene);
        renderer.plant(&scene, &landscape).expect("planted");
        renderer
    };
    // Its shadows are drawn for where it was, until they would have to be others.
    let mut renderer = planted();
    for step in 0..12_u8 {
        let camera = above(&scene, [60.0 + 0.17 * f64::from(step), 70.0], 1.7, 15.0);
        let seconds = if step < 8 { 0.0 } else { 0.8 };
        renderer.set_time(seconds);
        let moved = renderer.render(&camera).expect("drawn");
        if step % 3 == 1 {
            let mut fresh = planted();
            fresh.set_time(seconds);
            assert!(fresh.render(&camera).expect("drawn") == moved, "step {step}");
        }
    }
}

#[test]
fn a_plant_throws_its_shadow_where_it_is_not_itself_seen() {
    let Some(gpu) = gpu() else { return };
    let landscape = ferns(12, [3.0, 3.0]);
    // The sun in the west, low: shadows reach eastward.
    let view = View { sun_azimuth_deg: 270.0, sun_altitude_deg: 20.0, ..view() };
    let scene = LitScene::new(&view, &landscape).expect("a scene");
    let plants = &landscape.plants("ferns").expect("scattered").plants;
    let plant = plants.iter().find(|plant| (20.0..90.0).contains(&plant.place[0])).expect("inside");
    let [east, south, _] = plant.place;
    let spot = |away: f64| {
        let place = [east + away, south];
        let ground = scene.top_at(place).expect("on the land");
        let eye = [place[0] as f32, -place[1] as f32, ground + 1.0];
        Camera::looking(eye, [0.0, 0.02, -1.0], [0.12, 0.08])
    };
    let mut renderer = renderer(&gpu, &scene);
    let mean = |image: &Image| {
        image.rgb.iter().map(|&channel| f64::from(channel)).sum::<f64>() / image.rgb.len() as f64
    };
    // Beyond the reach of its fronds; and on the sunny side.
    let (shadow, light) = (spot(4.8), spot(-6.0));
    let bare = [shadow, light].map(|camera| mean(&renderer.render(&camera).expect("drawn")));
    renderer.plant(&scene, &landscape).expect("planted");
    let grown = [shadow, light].map(|camera| mean(&renderer.render(&camera).expect("drawn")));
    assert!(renderer.chosen_for_a_test().expect("read").len() == 1);
    assert!(grown[0] < 0.9 * bare[0], "{bare:?} {grown:?}");
    assert!((grown[1] - bare[1]).abs() < 1.0, "{bare:?} {grown:?}");
}

#[test]
fn plants_in_sight_are_each_drawn_once_and_none_that_is_not() {
    let Some(gpu) = gpu() else { return };
    let landscape = ferns(1200, [0.5, 1.5]);
    let scene = LitScene::new(&view(), &landscape).expect("a scene");
    let mut renderer = renderer(&gpu, &scene);
    renderer.plant(&scene, &landscape).expect("planted");
    let camera = above(&scene, [60.0, 100.0], 2.0, 10.0);
    renderer.choose_for_a_test(&camera, TestLook::default()).expect("chosen");
    let chosen = renderer.chosen_for_a_test().expect("read");
    let mut times = vec![0; 1200];
    let mut in_lists = [0; 10];
    for &[list, number] in &chosen[0] {
        times[number as usize] += 1;
        in_lists[list as usize] += 1;
    }
    assert!(times.iter().all(|&times| times <= 1), "some twice");
    assert!(in_lists.iter().filter(|&&count| count > 0).count() >= 5, "levels are used: {in_lists:?}");
    let mut must = 0;
    for (plant, times) in landscape.plants("ferns").expect("scattered").plants.iter().zip(&times) {
        let [east, south, _] = plant.place;
        let up = scene.top_at([east, south]).expect("on the land");
        let away = [east as f32 - camera.eye[0], -south as f32 - camera.eye[1], up - camera.eye[2]];
        let along = |axis: [f32; 3]| (0..3).map(|i| axis[i] * away[i]).sum::<f32>();
        let depth = along(camera.forward);
        let inside = along(camera.right).abs() < depth * camera.half[0]
            && along(camera.up).abs() < depth * camera.half[1];
        if inside {
            assert_eq!(*times, 1, "its root is in sight at {depth} m");
            must += 1;
        }
        let far = along(camera.right).abs() > depth.abs() * camera.half[0] + 4.0 * plant.size;
        assert!(!(far && *times > 0), "{depth} m ahead, {} m aside", along(camera.right));
    }
    assert!(must > 120, "{must} in sight");
}

/// Greatest share of the channels that change by more than eight bytes where detail is chosen a centimetre apart, with a fern
/// that fills the picture: nine thousandths were seen, and 7 to 28 hundredths without a passage.
const PASSED: f64 = 0.012;

/// A fern before the camera, of which detail is chosen as if it were elsewhere.
struct Lone {
    renderer: Renderer,
    camera: Camera,
    root: [f32; 3],
}

impl Lone {
    fn new(gpu: &Gpu) -> Self {
        let landscape = ferns(1, [1.0, 1.0]);
        let scene = LitScene::new(&view(), &landscape).expect("a scene");
        let [east, south, _] = landscape.plants("ferns").expect("scattered").plants[0].place;
        let up = scene.top_at([east, south]).expect("on the land");
        let camera = above(&scene, [east, south + 2.0], 1.2, 22.0);
        let mut renderer = renderer(gpu, &scene);
        renderer.plant(&scene, &landscape).expect("planted");
        Self { renderer, camera, root: [east as f32, -south as f32, up] }
    }

    fn look(&self, metres: f32) -> TestLook {
        let [east, north, up] = self.root;
        TestLook { detail_from: Some([east, north - metres, up]), ..TestLook::default() }
    }

    /// The picture where detail is chosen from so many metres.
    fn drawn(&mut self, metres: f32) -> Image {
        self.renderer.render_for_a_test(&self.camera, self.look(metres)).expect("drawn")
    }

    /// The list of the fern there.
    fn list(&mut self, metres: f32) -> u32 {
        self.renderer.choose_for_a_test(&self.camera, self.look(metres)).expect("chosen");
        let chosen = self.renderer.chosen_for_a_test().expect("read");
        chosen[0].first().map_or(u32::MAX, |&[list, _]| list)
    }

    /// The distances a centimetre apart between which the fern leaves all lists before one, and both pictures.
    fn passage(&mut self, list: u32, from: f32) -> (f32, [Image; 2]) {
        let (mut near, mut far) = (from, 400.0_f32);
        while far - near > 0.01 {
            let middle = if far > 2.0 * near { (near * far).sqrt() } else { 0.5 * (near + far) };
            if self.list(middle) < list { near = middle } else { far = middle }
        }
        (near, [near, near + 0.01].map(|metres| self.drawn(metres)))
    }
}

#[test]
fn levels_of_detail_of_a_plant_blend_into_each_other_without_leaps() {
    let Some(gpu) = gpu() else { return };
    let mut lone = Lone::new(&gpu);
    let first = lone.drawn(0.3);
    let (mut worst, mut before) = (0.0_f64, 0.3_f32);
    for list in 1..=8 {
        let (distance, [one, other]) = lone.passage(list, before);
        let within = 0.5 * (before + distance);
        let [third, fourth] = [within, within + 0.01].map(|metres| lone.drawn(metres));
        let shares = [share_changed(&one, &other), share_changed(&third, &fourth)];
        println!("list {list} from {distance} m: shares of {shares:?} change");
        worst = shares.into_iter().fold(worst, f64::max);
        before = distance;
    }
    assert!(worst < PASSED, "a share of {worst} leaps");
    let far = lone.drawn(before);
    assert!(share_changed(&first, &far) > 4.0 * PASSED, "detail did change");
}

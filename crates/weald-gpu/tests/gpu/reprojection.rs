//! Light that a window's picture takes from the one before: what is seen is what a picture shows that is lit anew.

use crate::flip::flip;
use crate::programs::gpu;
use crate::scenes::{above, lakes, meadow, options, view};
use weald::Landscape;
use weald::picture::{Around, Camera, Image, LitScene, View};
use weald_gpu::{Renderer, SceneUpdate, Screen};

/// Pictures of a camera that moves, more than light may be old.
const PICTURES: u16 = 12;

/// What is drawn, and a view of a window onto it.
struct Shown {
    scene: LitScene,
    renderer: Renderer,
    screen: Screen,
}

impl Shown {
    fn of(landscape: &Landscape) -> Option<Self> {
        Self::by(&view(), landscape)
    }

    fn by(view: &View, landscape: &Landscape) -> Option<Self> {
        let scene = LitScene::new(view, landscape).expect("a scene");
        let mut renderer = Renderer::planted(&gpu()?, (&scene, landscape), options(1)).expect("drawn");
        let screen = renderer.screen([320, 180]).expect("it fits");
        Some(Self { scene, renderer, screen })
    }

    fn draw(&mut self, camera: &Camera) -> Image {
        self.renderer.draw_on(&mut self.screen, camera).expect("drawn");
        self.screen.image().expect("read back")
    }

    /// What is seen at the end of a path, and the same lit anew.
    fn after(&mut self, path: &[Camera]) -> [Image; 2] {
        let seen = path.iter().map(|camera| self.draw(camera)).last().expect("some cameras");
        [seen, self.anew(&path[path.len() - 1])]
    }

    fn anew(&mut self, camera: &Camera) -> Image {
        self.renderer.render(camera).expect("drawn")
    }
}

/// The cameras of a movement, of which each picture is a step.
fn path(camera: impl Fn(f32) -> Camera) -> Vec<Camera> {
    (0..PICTURES).map(|number| camera(f32::from(number))).collect()
}

/// Bytes that differ, and by how much at most.
fn differing(a: &Image, b: &Image) -> (usize, u8) {
    let differences =
        a.rgb.iter().zip(&b.rgb).map(|(a, b)| a.abs_diff(*b)).filter(|difference| *difference > 0);
    differences.fold((0, 0), |(count, most), difference| (count + 1, most.max(difference)))
}

#[test]
fn a_camera_that_moves_sees_what_a_picture_shows_that_is_lit_anew() {
    let Some(mut shown) = Shown::of(&lakes()) else { return };
    let cameras =
        path(|step| above(&shown.scene, [1600.0 + 6.0 * f64::from(step), 1900.0], 300.0, 25.0, 0.4 * step));
    let [seen, anew] = shown.after(&cameras);
    let found = flip(&seen, &anew).mean;
    // Some light is that of pictures before, and nothing is seen of it.
    assert!(differing(&seen, &anew).0 > 1000, "all of it was lit anew");
    // Between texels some sharpness is lost: 0.0447; 0.031 with twice as many blocks lit anew, 0.055 of the nearest texel then.
    assert!(found < 0.047, "{found}");
    // The same camera far from where it was before sees nothing of that.
    let away = above(&shown.scene, [1000.0, 1000.0], 40.0, 10.0, 200.0);
    assert_eq!(differing(&shown.draw(&away), &shown.anew(&away)), (0, 0));
}

#[test]
fn ground_that_comes_out_from_behind_blades_has_the_light_of_what_is_beside_it() {
    let Some(mut shown) = Shown::of(&meadow()) else { return };
    // A person who walks and turns by half a degree a picture.
    let cameras =
        path(|step| above(&shown.scene, [60.0 + 0.14 * f64::from(step), 60.0], 1.7, 8.0, 40.0 + 0.5 * step));
    let [seen, anew] = shown.after(&cameras);
    let found = flip(&seen, &anew).mean;
    assert!(differing(&seen, &anew).0 > 1000, "all of it was lit anew");
    // 0.064; it was 0.077 where ground is as old as the oldest of four pixels.
    assert!(found < 0.075, "{found}");
    let step_before = flip(&shown.anew(&cameras[usize::from(PICTURES) - 2]), &anew).mean;
    assert!(3.0 * found < step_before, "{found}, {step_before} for the picture before");
}

#[test]
fn a_camera_that_stands_still_keeps_a_sharp_picture() {
    let Some(mut shown) = Shown::of(&lakes()) else { return };
    for camera in [shown.scene.camera(), above(&shown.scene, [1600.0, 1900.0], 60.0, 15.0, 20.0)] {
        let anew = shown.anew(&camera);
        for _ in 0..PICTURES {
            let seen = shown.draw(&camera);
            assert_eq!(differing(&seen, &anew), (0, 0));
        }
    }
}

#[test]
fn a_camera_that_comes_to_rest_has_a_sharp_picture_once_its_view_is_settled() {
    let Some(mut shown) = Shown::of(&lakes()) else { return };
    let cameras =
        path(|step| above(&shown.scene, [1600.0 + 6.0 * f64::from(step), 1900.0], 300.0, 25.0, 0.0));
    let last = cameras[usize::from(PICTURES) - 1];
    for (number, camera) in cameras.iter().enumerate() {
        shown.draw(camera);
        assert_eq!(shown.screen.is_settled(), number == 0, "the first is lit anew");
    }
    let anew = shown.anew(&last);
    let mut pictures = 0;
    while !shown.screen.is_settled() {
        shown.draw(&last);
        pictures += 1;
    }
    assert_eq!((pictures, differing(&shown.draw(&last), &anew)), (4, (0, 0)));
}

#[test]
fn light_of_another_scene_or_of_long_ago_is_not_taken() {
    let Some(mut shown) = Shown::of(&lakes()) else { return };
    let camera = shown.scene.camera();
    shown.draw(&camera);
    // The lakes are gone: their beds are dry at once.
    let mut dry = lakes();
    let size = dry.domain.size;
    dry.insert("water", "m", weald::Field::filled(size, 0.0));
    let changed = shown.scene.changed(&view(), &dry).expect("a scene");
    shown.renderer.update(SceneUpdate::of(&changed)).expect("it fits");
    // All of it goes over with a picture that waits; the next one of the window takes nothing of before.
    let anew = shown.anew(&camera);
    assert_eq!(differing(&shown.draw(&camera), &anew), (0, 0));
    // Water flows meanwhile.
    shown.renderer.set_time(3.0);
    let later = shown.draw(&camera);
    assert_eq!(differing(&later, &shown.anew(&camera)), (0, 0));
}

#[test]
fn clouds_before_a_camera_that_moves_are_those_of_a_picture_that_is_lit_anew() {
    let cloudy = View { clouds: 0.4, around: Some(Around::Horizon), ..view() };
    let Some(mut shown) = Shown::by(&cloudy, &lakes()) else { return };
    // Half a degree and some metres a picture, with much sky.
    let cameras =
        path(|step| above(&shown.scene, [1600.0 + 3.0 * f64::from(step), 1900.0], 30.0, -12.0, 0.5 * step));
    let last = cameras[usize::from(PICTURES) - 1];
    let [seen, anew] = shown.after(&cameras);
    let found = flip(&seen, &anew).mean;
    assert!(differing(&seen, &anew).0 > 1000, "all of it was lit anew");
    // Between texels some sharpness is lost: 0.051, where pictures a degree apart differ by 0.25.
    assert!(found < 0.055, "{found}");
    let other = flip(&shown.anew(&cameras[usize::from(PICTURES) - 3]), &anew).mean;
    assert!(4.0 * found < other, "{found}, {other} for pictures a degree apart");
    while !shown.screen.is_settled() {
        shown.draw(&last);
    }
    assert_eq!(differing(&shown.draw(&last), &anew), (0, 0));
    // Far from there nothing is taken.
    let away = above(&shown.scene, [1000.0, 1900.0], 30.0, -12.0, 5.5);
    assert_eq!(differing(&shown.draw(&away), &shown.anew(&away)), (0, 0));
}

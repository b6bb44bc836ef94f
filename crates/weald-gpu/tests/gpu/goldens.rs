//! Drawn pictures beside those that were looked at and found good, by how different they look.
//!
//! `UPDATE_GOLDENS=1 cargo test -p weald-gpu goldens` writes those anew that differ; look at each before you commit
//! it. They are drawn by software (llvmpipe), which every machine has alike.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use crate::flip::flip;
use crate::programs::gpu;
use crate::scenes::{above, lakes, meadow, mountains, options, treeless, view};
use weald::Landscape;
use weald::grow::Vegetation;
use weald::grow::grass::Meadow;
use weald::picture::{Camera, Image, LitScene, View};
use weald_gpu::{Gpu, Renderer, TestLook};

/// Greatest mean ꟻLIP of a picture and its golden: software of other versions rounds otherwise.
const ALIKE: f32 = 0.01;

/// Least that what must not pass is to be away from it.
const SEEN: f32 = 0.02;

/// A landscape and how it is looked at: place, metres above it, degrees down and turned.
struct Scene {
    name: &'static str,
    landscape: fn() -> Landscape,
    from: ([f64; 2], f32, f32, f32),
    sun_altitude_deg: f64,
    has_woods: bool,
}

const MOUNTAINS: Scene = Scene {
    name: "mountains",
    landscape: mountains,
    from: ([1500.0, 2700.0], 120.0, 10.0, 20.0),
    sun_altitude_deg: 14.0,
    has_woods: true,
};
const LAKES: Scene = Scene {
    name: "lakes",
    landscape: lakes,
    from: ([1500.0, 2700.0], 250.0, 20.0, 40.0),
    sun_altitude_deg: 28.0,
    has_woods: true,
};
const MEADOW: Scene = Scene {
    name: "meadow",
    landscape: meadow,
    from: ([60.0, 80.0], 1.6, 8.0, 0.0),
    sun_altitude_deg: 28.0,
    has_woods: false,
};

impl Scene {
    fn view(&self) -> View {
        let view = if self.has_woods { view() } else { treeless() };
        View { sun_altitude_deg: self.sun_altitude_deg, ..view }
    }
}

/// Software alone: a card draws the same to the eye, but not to a golden.
fn software() -> Option<Gpu> {
    static SOFTWARE: OnceLock<Gpu> = OnceLock::new();
    gpu().map(|_| SOFTWARE.get_or_init(|| Gpu::software().expect("mesa-vulkan-drivers is installed")).clone())
}

fn camera(scene: &Scene, lit_scene: &LitScene) -> Camera {
    let (place, metres, down, turn) = scene.from;
    above(lit_scene, place, metres, down, turn)
}

fn drawn(gpu: &Gpu, scene: &Scene, view: &View, landscape: &Landscape, look: TestLook) -> Image {
    let lit_scene = LitScene::new(view, landscape).expect("a lit_scene");
    let camera = camera(scene, &lit_scene);
    let lit_scene = lit_scene.seen_from(camera);
    let mut renderer = Renderer::new(gpu, &lit_scene, options(4)).expect("it can be drawn");
    renderer.plant(&lit_scene, landscape).expect("planted");
    renderer.render_for_a_test(&camera, look).expect("drawn")
}

fn as_it_is(gpu: &Gpu, scene: &Scene) -> Image {
    drawn(gpu, scene, &scene.view(), &(scene.landscape)(), TestLook::default())
}

fn golden(scene: &Scene) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/gpu/goldens").join(scene.name).with_extension("png")
}

fn read(path: &Path) -> Option<Image> {
    let file = std::io::BufReader::new(std::fs::File::open(path).ok()?);
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut rgb = vec![0; reader.output_buffer_size().expect("it fits")];
    let info = reader.next_frame(&mut rgb).expect("whole");
    assert_eq!(info.color_type, png::ColorType::Rgb);
    Some(Image { width: info.width as usize, height: info.height as usize, rgb })
}

/// Mean ꟻLIP of a picture and the golden of a scene.
fn distance(scene: &Scene, image: &Image) -> f32 {
    read(&golden(scene)).map_or(1.0, |golden| flip(&golden, image).mean)
}

fn compare(scene: &Scene) {
    let Some(gpu) = software() else { return };
    let image = as_it_is(&gpu, scene);
    let distance = distance(scene, &image);
    println!("{}: mean FLIP {distance}", scene.name);
    if distance <= ALIKE {
        return;
    }
    let update = std::env::var_os("UPDATE_GOLDENS").is_some_and(|value| value == "1");
    let now = Path::new(env!("CARGO_TARGET_TMPDIR")).join(scene.name).with_extension("png");
    let file = if update { golden(scene) } else { now };
    std::fs::write(&file, image.to_png(&[])).expect("it can be written");
    assert!(
        update,
        "{} looks otherwise than its golden {}: mean FLIP {distance}, at most {ALIKE}; it is now {}; where that is \
         better, UPDATE_GOLDENS=1 makes it the golden",
        scene.name,
        golden(scene).display(),
        file.display()
    );
}

#[test]
fn mountains_look_as_they_did() {
    compare(&MOUNTAINS);
}

#[test]
fn lakes_look_as_they_did() {
    compare(&LAKES);
}

#[test]
fn a_meadow_from_a_persons_height_looks_as_it_did() {
    compare(&MEADOW);
}

/// The landscape with the colours of its grass a tenth brighter.
fn brighter(mut landscape: Landscape) -> Landscape {
    let (name, meadow) = landscape.all_meadows().next().expect("a meadow");
    let (name, mut meadow): (_, Meadow) = (name.to_owned(), (*meadow).clone());
    for species in &mut meadow.species {
        for colour in [&mut species.good, &mut species.bad, &mut species.head] {
            *colour = colour.map(|light| 1.1 * light);
        }
    }
    landscape.sow(&name, meadow);
    landscape
}

#[test]
fn another_sun_grass_a_tenth_brighter_and_missing_shadows_are_seen() {
    let Some(gpu) = software() else { return };
    let look = TestLook::default();
    let unshadowed = TestLook { casts_nothing: true, ..look };
    let against = |scene: &Scene| View { sun_azimuth_deg: view().sun_azimuth_deg - 180.0, ..scene.view() };
    for (what, scene, view, landscape, look) in [
        ("sun", &MOUNTAINS, against(&MOUNTAINS), mountains(), look),
        ("sun", &LAKES, against(&LAKES), lakes(), look),
        ("sun", &MEADOW, against(&MEADOW), meadow(), look),
        ("colour", &MEADOW, MEADOW.view(), brighter(meadow()), look),
        ("shadows", &MOUNTAINS, MOUNTAINS.view(), mountains(), unshadowed),
    ] {
        let image = drawn(&gpu, scene, &view, &landscape, look);
        assert!(golden(scene).exists(), "{} has no golden", scene.name);
        let distance = distance(scene, &image);
        println!("{what} of {}: mean FLIP {distance}", scene.name);
        assert!(distance > SEEN, "{what} of {}: {distance} is not seen", scene.name);
    }
}

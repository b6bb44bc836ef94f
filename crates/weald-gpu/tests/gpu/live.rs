//! A simulation that is drawn as it runs.

use std::sync::Arc;

use crate::programs::gpu;
use weald::engine::Engine;
use weald::picture::{Camera, Image, LitScene, View};
use weald::recipe::{Options, Overrides, Recipe, Run, Silent};
use weald::{Error, Landscape, Size};
use weald_gpu::{Gpu, Live, RenderOptions, Renderer};

const SIZE: [u32; 2] = [240, 135];

fn recipe(model: &str) -> Recipe {
    let text = format!(
        "[landscape]\nsize = [96, 80]\ncell = 10.0\nseed = 7\n[[step]]\ndo = \"fbm\"\nrelief = 160.0\n\
         wavelength = 500.0\n{model}[[output]]\nlayer = \"height\"\nfile = \"a.tif\"\n"
    );
    Recipe::parse("live.toml", &text, &Overrides::default()).expect("a recipe")
}

const HAN: &str = "[[step]]\ndo = \"hydraulic\"\nmodel = \"han\"\niterations = 400\nboundary = \"closed\"\nrain = 0.06\n\
                   evaporation = 0.0\n";
const MEI: &str = "[[step]]\ndo = \"hydraulic\"\nmodel = \"mei\"\niterations = 400\nboundary = \"closed\"\nrain = 0.06\nevaporation = 0.0\n";

fn view() -> View {
    let [width, height] = SIZE;
    View { width, height, field_of_view_deg: 40.0, visibility: Some(1e6), ..View::default() }
}

fn scene(landscape: &Landscape) -> LitScene {
    LitScene::new(&view(), landscape).expect("a scene").to_follow()
}

/// A renderer, and the picture of a camera that sees the same of every scene: heights count from its lowest ground.
fn picture(gpu: &Gpu, scene: &LitScene, camera: Camera, live: Option<&Live>) -> Image {
    let mut renderer =
        Renderer::new(gpu, scene, RenderOptions { size: SIZE, samples: 1 }).expect("a renderer");
    if let Some(live) = live {
        renderer.follow(scene, live).expect("followed");
    }
    let [east, north, up] = camera.eye;
    renderer.render(&camera.at([east, north, up + scene.drawn_height(0.0)])).expect("drawn")
}

/// Mean difference of two pictures in bytes a channel.
fn apart(a: &Image, b: &Image) -> f64 {
    let sum: f64 = a.rgb.iter().zip(&b.rgb).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
    sum / a.rgb.len() as f64
}

#[test]
fn a_simulation_that_is_followed_looks_as_what_it_has_become() {
    let Some(gpu) = gpu() else { return };
    for model in [HAN, MEI] {
        let recipe = recipe(model);
        let live = Live::new(&gpu, Size::new(96, 80).expect("small")).expect("room");
        let folder = tempfile::tempdir().expect("a folder");
        let engine = Engine::Device(Arc::new(gpu.shown_in(&live)));
        let options = Options { engine, ..Options::into_folder(folder.path()) };
        let end = Run { recipe: &recipe, options }.landscape(&Silent).expect("it runs");
        assert!(live.generation() > 0, "it was shown");
        let begin = self::recipe("").landscape().expect("ground");
        let (before, after) = (scene(&begin), scene(&end));
        let eye = after.camera().eye;
        let camera = after.camera().at([eye[0], eye[1], eye[2] - after.drawn_height(0.0)]);
        let wanted = picture(&gpu, &after, camera, None);
        let followed = picture(&gpu, &before, camera, Some(&live));
        let still = picture(&gpu, &before, camera, None);
        let (off, change) = (apart(&followed, &wanted), apart(&still, &wanted));
        // What is left is the light of the sky, which stays that of the beginning, and the shores.
        assert!(change > 4.0 && off < 0.25 * change, "{off} bytes apart; it changed by {change}");
    }
}

#[test]
fn nothing_is_followed_that_has_another_size() {
    let Some(gpu) = gpu() else { return };
    let gpu = gpu.with_memory(1 << 30).expect("a legal budget");
    let live = Live::new(&gpu, Size::new(30, 20).expect("small")).expect("room");
    let held = gpu.allocated();
    let scene = scene(&recipe("").landscape().expect("ground"));
    let mut renderer =
        Renderer::new(&gpu, &scene, RenderOptions { size: SIZE, samples: 1 }).expect("a renderer");
    let error = renderer.follow(&scene, &live).expect_err("other sizes");
    assert!(matches!(error, Error::Limit(_)) && error.to_string().contains("30 × 20"), "{error}");
    drop(renderer);
    assert_eq!(gpu.allocated(), held);
    // Nor does a run of another size change what is shown.
    let engine = Engine::Device(Arc::new(gpu.shown_in(&live)));
    let folder = tempfile::tempdir().expect("a folder");
    let options = Options { engine, ..Options::into_folder(folder.path()) };
    Run { recipe: &recipe(HAN), options }.landscape(&Silent).expect("it runs");
    assert_eq!(live.generation(), 0);
}

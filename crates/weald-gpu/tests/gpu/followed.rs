//! A renderer follows a landscape that changes: on its device, and brought there.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::programs::gpu;
use crate::scenes::{above, lakes};
use weald::Field;
use weald::edit::{Area, Brush, Effect};
use weald::engine::Engine;
use weald::picture::{Around, Image, LitScene, View};
use weald::recipe::{Overrides, Recipe, Session, SessionOptions, Silent};
use weald_gpu::{Gpu, Live, RenderOptions, Renderer, SceneUpdate};

const SIZE: [u32; 2] = [96, 54];

/// A meadow with ferns, over which water runs.
const RECIPE: &str = "[landscape]\nsize = 48\ncell = 2.0\nseed = 5\n[[step]]\ndo = \"fbm\"\nrelief = 20.0\n\
    [[step]]\ndo = \"constant\"\nheight = 0.8\ninto = \"fertility\"\n\
    [[step]]\ndo = \"constant\"\nheight = 0.7\ninto = \"light\"\n\
    [[step]]\ndo = \"constant\"\nheight = 0.6\ninto = \"moisture\"\n\
    [[step]]\ndo = \"grass\"\nsets = 5.0\n\
    [[step]]\ndo = \"scatter\"\nplant = \"fern\"\ncount = 60\nspacing = 2.0\ninto = \"ferns\"\n\
    [[step]]\ndo = \"hydraulic\"\nmodel = \"stava\"\nrain = 0.02\n\
    [[output]]\nlayer = \"height\"\nfile = \"a.tif\"\n";

fn view() -> View {
    let [width, height] = SIZE;
    View { width, height, field_of_view_deg: 40.0, visibility: Some(1e6), ..View::default() }
}

/// Mean difference of two pictures in bytes a channel.
fn apart(a: &Image, b: &Image) -> f64 {
    let sum: f64 = a.rgb.iter().zip(&b.rgb).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
    sum / a.rgb.len() as f64
}

fn session(gpu: &Gpu, live: &Live) -> Session {
    let recipe = Recipe::parse("followed.toml", RECIPE, &Overrides::default()).expect("a recipe");
    let engine = Engine::Device(Arc::new(gpu.shown_in(live)));
    let options = SessionOptions { engine, ..SessionOptions::default() };
    Session::open(recipe, options, &Silent).expect("it opens")
}

/// How far roots stand off the ground under them at most, in metres.
fn off_the_ground(scene: &LitScene, roots: &[[f32; 3]]) -> f32 {
    let off = |&[east, north, up]: &[f32; 3]| {
        scene.bed_at([east.into(), (-north).into()]).map_or(0.0, |bed| (bed - up).abs())
    };
    roots.iter().map(off).fold(0.0, f32::max)
}

#[test]
fn grass_and_plants_stand_on_the_ground_of_a_simulation_that_is_followed_for_1000_steps() {
    if gpu().is_none() {
        return;
    }
    let gpu = Gpu::any().expect("an adapter");
    // What is drawn has a count of its own: the session keeps copies to go back to.
    let drawn = gpu.clone().with_memory(1 << 30).expect("a legal budget");
    let live = Live::new(&gpu, weald::Size::square(48).expect("small")).expect("room");
    let mut session = session(&gpu, &live);
    let start = session.history().simulation().start().clone();
    let scene = LitScene::new(&view(), &start).expect("a scene").to_follow();
    let camera = above(&scene, [48.0, 84.0], 9.0, 20.0, 0.0);
    let options = RenderOptions { size: SIZE, samples: 1 };
    let mut renderer = Renderer::new(&drawn, &scene, options).expect("a renderer");
    renderer.plant(&scene, &start).expect("it grows");
    let still = renderer.render(&camera).expect("drawn");
    let mut screen = renderer.screen(SIZE).expect("it fits");
    let (mut longest, mut held) = (Duration::ZERO, Vec::new());
    for slice in 0..100 {
        session.advance(10).expect("it runs");
        if slice == 50 {
            let hill = Effect::Add { material: "bedrock".into(), thickness: 6.0 };
            session.paint(Brush::dab(hill, [48.0, 48.0], 20.0)).expect("painted");
        }
        let begun = Instant::now();
        renderer.follow(&scene, &live).expect("followed");
        longest = if slice == 0 { longest } else { longest.max(begun.elapsed()) };
        if slice % 10 == 9 {
            let begun = Instant::now();
            renderer.draw_on(&mut screen, &camera).expect("drawn");
            longest = longest.max(begun.elapsed().saturating_sub(screen.submitting_for_a_test()));
            screen.image().expect("read back");
            held.push(drawn.allocated());
        }
    }
    println!("following and drawing took {longest:?} at most");
    // With the first picture the grass of the view is still being sown.
    assert!(held[1..].iter().all(|bytes| *bytes == held[1]), "{held:?}");
    let (landscape, _) = session.landscape().expect("read");
    let now = scene.changed(&view(), &landscape).expect("a scene").to_follow();
    let roots = renderer.roots_for_a_test(&camera).expect("read");
    assert!(roots.iter().all(|roots| roots.len() > 40), "{:?}", roots.each_ref().map(Vec::len));
    let [then, here] = [&scene, &now].map(|scene| roots.each_ref().map(|roots| off_the_ground(scene, roots)));
    println!("grass and plants: {then:?} m off the ground of the beginning, {here:?} m off that of the end");
    assert!(then.iter().all(|&off| off > 1.0) && here.iter().all(|&off| off < 2e-3));
    let mut fresh = Renderer::new(&gpu, &now, options).expect("a renderer");
    fresh.plant(&now, &landscape).expect("it grows");
    let wanted = fresh.render(&camera).expect("drawn");
    renderer.update(SceneUpdate::of(&now)).expect("it fits");
    let followed = renderer.render(&camera).expect("drawn");
    let (off, change) = (apart(&followed, &wanted), apart(&still, &wanted));
    println!("{off} bytes apart; it changed by {change}");
    assert!(change > 2.0 && off < 0.1 * change);
}

#[test]
fn a_scene_that_was_brought_up_to_date_is_drawn_as_a_new_one() {
    let Some(gpu) = gpu() else { return };
    let before = lakes();
    let mut after = before.clone();
    let height = before.field("height").expect("there");
    let size = height.size();
    let raised = |x: usize, y: usize| {
        let rise = if (40..120).contains(&x) && (60..100).contains(&y) { 60.0 } else { 0.0 };
        height.at(x, y) + rise
    };
    let height = Field::from_function(size, raised);
    after.insert("height", "m", height);
    let scene = LitScene::new(&view(), &before).expect("a scene");
    let changed = scene.changed(&view(), &after).expect("a scene");
    let options = RenderOptions { size: SIZE, samples: 1 };
    let mut fresh = Renderer::new(&gpu, &changed, options).expect("a renderer");
    let wanted = fresh.render(&scene.camera()).expect("drawn");
    let mut renderer = Renderer::new(&gpu, &scene, options).expect("a renderer");
    let still = renderer.render(&scene.camera()).expect("drawn");
    let mut screen = renderer.screen(SIZE).expect("it fits");
    let rows = Area { first: [0, 55], size: weald::Size::new(size.columns, 50).expect("small") };
    renderer.update(SceneUpdate::of(&changed).within(rows)).expect("it fits");
    let mut pictures = 0;
    while {
        renderer.draw_on(&mut screen, &scene.camera()).expect("drawn");
        pictures += 1;
        pictures < 30 && apart(&screen.image().expect("read back"), &wanted) > 0.12
    } {}
    let near = apart(&screen.image().expect("read back"), &wanted);
    println!(
        "rows alone, after {pictures} pictures: {near} bytes apart; it changed by {}",
        apart(&still, &wanted)
    );
    assert!(near <= 0.12 && apart(&still, &wanted) > 8.0 * near.max(0.12));
    renderer.update(SceneUpdate::of(&changed)).expect("it fits");
    assert_eq!(renderer.render(&scene.camera()).expect("drawn"), wanted, "all of it");
    let other = LitScene::new(&view(), &crate::scenes::meadow()).expect("a scene");
    assert!(renderer.update(SceneUpdate::of(&other)).is_err(), "another size");
    let around = View { around: Some(Around::Horizon), ..view() };
    let open = LitScene::new(&around, &after).expect("a scene");
    assert!(renderer.update(SceneUpdate::of(&open)).is_err(), "another surrounding");
}

#[test]
fn what_a_simulation_elsewhere_paints_is_followed_cell_by_cell() {
    let Some(gpu) = gpu() else { return };
    let recipe = Recipe::parse("followed.toml", RECIPE, &Overrides::default()).expect("a recipe");
    let mut session = Session::open(recipe, SessionOptions::default(), &Silent).expect("it opens");
    let live = Live::new(&gpu, weald::Size::square(48).expect("small")).expect("room");
    let start = session.history().simulation().start().clone();
    let scene = LitScene::new(&view(), &start).expect("a scene").to_follow();
    let options = RenderOptions { size: SIZE, samples: 1 };
    let mut renderer = Renderer::new(&gpu, &scene, options).expect("a renderer");
    session.advance(40).expect("it runs");
    let whole = session.history().simulation().whole();
    live.paint(&gpu, &session.patch(whole).expect("read")).expect("brought");
    let hill = Effect::Add { material: "bedrock".into(), thickness: 8.0 };
    session.paint(Brush::dab(hill, [60.0, 40.0], 14.0)).expect("painted");
    // The stroke reaches no further.
    let area = Area { first: [22, 12], size: weald::Size::square(17).expect("small") };
    live.paint(&gpu, &session.patch(area).expect("read")).expect("brought");
    renderer.follow(&scene, &live).expect("followed");
    let (landscape, _) = session.landscape().expect("read");
    let now = scene.changed(&view(), &landscape).expect("a scene").to_follow();
    renderer.update(SceneUpdate::of(&now)).expect("it fits");
    let wanted =
        Renderer::new(&gpu, &now, options).expect("a renderer").render(&scene.camera()).expect("drawn");
    let off = apart(&renderer.render(&scene.camera()).expect("drawn"), &wanted);
    println!("{off} bytes apart");
    assert!(off < 0.05);
    let beyond = Area { first: [40, 40], size: weald::Size::square(8).expect("small") };
    let part = session.patch(beyond).expect("read");
    let small = Live::new(&gpu, weald::Size::square(47).expect("small")).expect("room");
    assert!(small.paint(&gpu, &part).is_err(), "beyond its border");
}

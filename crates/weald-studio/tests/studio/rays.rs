//! Without a device the landscape is drawn all the same: by rays on the processor.

use std::time::{Duration, Instant};

use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use weald_studio::work::Phase;
use weald_studio::{Options, Studio};

const RECIPE: &str = r#"
[landscape]
size = 48
cell = 20.0
[[step]]
do = "diamond-square"
relief = 300.0
[[step]]
do = "hydraulic"
iterations = 400
[[output]]
layer = "height"
file = "height.tif"
"#;

/// A window of that size with the recipe, which is drawn, and the folder of both.
fn opened(size: [f32; 2]) -> (tempfile::TempDir, Harness<'static, Studio>) {
    let folder = tempfile::tempdir().expect("a folder");
    let recipe = folder.path().join("valley.toml");
    std::fs::write(&recipe, RECIPE).expect("written");
    let (what, own_files) = (Some(recipe), Some(folder.path().join("own")));
    let options = Options { what, own_files, ..Options::default() };
    // A harness that has drawn nothing yet has no device to give.
    let mut harness = Harness::builder()
        .with_size(size)
        .build_eframe(move |context| Studio::of(context, options).unwrap_or_else(|error| panic!("{error}")));
    until(&mut harness, "a picture", Studio::is_drawn);
    (folder, harness)
}

fn until(harness: &mut Harness<'static, Studio>, what: &str, holds: impl Fn(&Studio) -> bool) {
    let begun = Instant::now();
    while !holds(harness.state()) {
        harness.step();
        assert!(begun.elapsed() < Duration::from_mins(1), "{what} does not come");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Colours within the viewport, and how many different ones.
fn picture(harness: &mut Harness<'static, Studio>) -> (Vec<[u8; 4]>, usize) {
    let place = harness.get_by_label("Viewport").rect().shrink(30.0);
    let image = harness.render().expect("a picture");
    let [left, right] = [place.left(), place.right()].map(|side| side as u32);
    let [top, bottom] = [place.top(), place.bottom()].map(|side| side as u32);
    let pixels: Vec<_> = (top..bottom)
        .flat_map(|y| (left..right).map(move |x| (x, y)))
        .map(|(x, y)| image.get_pixel(x, y).0)
        .collect();
    let mut colours = pixels.clone();
    colours.sort_unstable();
    colours.dedup();
    (pixels, colours.len())
}

#[test]
fn rays_draw_the_landscape_and_follow_the_simulation() {
    let (_folder, mut harness) = opened([900.0, 600.0]);
    assert_eq!(harness.state().drawing_error(), None);
    harness.get_by_label_contains("no graphics card");
    let (first, colours) = picture(&mut harness);
    assert!(colours > 500, "{colours} colours: light and shadow on a country");
    harness.get_by_label("Play to the end").click();
    until(&mut harness, "the end", |studio| {
        let status = studio.status();
        let is_whole = status.shown.as_ref().is_some_and(|shown| shown.changes == status.changes);
        status.steps == 400 && status.phase == Phase::Idle && is_whole
    });
    until(&mut harness, "a picture of the end", Studio::is_drawn);
    let (last, _) = picture(&mut harness);
    let changed = first.iter().zip(&last).filter(|(one, other)| one != other).count();
    assert!(changed > first.len() / 20, "{changed} of {} pixels have changed", first.len());
}

#[test]
fn on_a_narrow_screen_the_landscape_has_the_width_and_one_part_lies_below() {
    let (_folder, mut harness) = opened([390.0, 760.0]);
    let alone = harness.get_by_label("Viewport").rect();
    assert!(alone.width() > 380.0 && alone.height() > 500.0, "{alone:?}");
    harness.get_by_label("Simulation").click();
    harness.run_steps(3);
    let beside = harness.get_by_label("Viewport").rect();
    assert!(beside.width() > 380.0 && (200.0..500.0).contains(&beside.height()), "{beside:?}");
    harness.get_by_label("One step").click();
    until(&mut harness, "a step", |studio| studio.status().steps == 1);
    harness.get_by_label("Recipe").click();
    harness.run_steps(3);
    assert!(harness.query_by_label("One step").is_none(), "one part at a time");
    assert!(harness.query_by_label("2. hydraulic").is_some());
}

#[test]
fn a_click_is_one_where_pictures_take_long() {
    let (_folder, mut harness) = opened([900.0, 600.0]);
    let place = harness.get_by_label("Play or pause").rect().center();
    harness.hover_at(place);
    harness.step();
    harness.drag_at(place);
    harness.step();
    // Frames of a quarter of a second.
    harness.run_steps(12);
    harness.drop_at(place);
    until(&mut harness, "a simulation that runs", |studio| studio.status().plays);
}

//! Without a device the landscape is drawn all the same: by rays on the processor.

use std::path::Path;
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

fn opened(recipe: &Path, own: &Path) -> Harness<'static, Studio> {
    let (what, own_files) = (Some(recipe.to_owned()), Some(own.to_owned()));
    let options = Options { what, own_files, ..Options::default() };
    // A harness that has drawn nothing yet has no device to give.
    Harness::builder()
        .with_size([700.0, 500.0])
        .build_eframe(move |context| Studio::of(context, options).unwrap_or_else(|error| panic!("{error}")))
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
    let folder = tempfile::tempdir().expect("a folder");
    let recipe = folder.path().join("valley.toml");
    std::fs::write(&recipe, RECIPE).expect("written");
    let mut harness = opened(&recipe, &folder.path().join("own"));
    until(&mut harness, "a picture", Studio::is_drawn);
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

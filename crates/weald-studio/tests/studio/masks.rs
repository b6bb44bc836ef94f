//! Ground that a mask protects.

use std::fs;

use weald::recipe::{Overrides, Recipe};

use super::looking::opened;

#[test]
fn what_is_masked_is_tinted_and_left_as_it_is_and_a_run_of_the_project_gives_the_same() {
    let (folder, mut window) = opened();
    let bare = window.seen();
    window.click("Mask");
    window.stroke([0.4, 0.5], [0.6, 0.5]);
    let status = window.until("the mask", |status| {
        status.surface.as_ref().is_some_and(|surface| surface.canvas.mask.sum() > 1.0)
    });
    assert_eq!(status.moments.last().expect("done").label, "mask");
    window.settle();
    let masked = window.seen();
    window.picture("masked");
    // The tint takes about a hundredth of the view.
    assert!(bare.share_that_differs(&masked) > 0.004, "{}", bare.share_that_differs(&masked));
    window.click("Add");
    window.stroke([0.5, 0.35], [0.5, 0.65]);
    let status = window.until("soil across it", |status| status.moments.len() == 2);
    let canvas = status.surface.expect("painted").canvas;
    let soil = &canvas.thickness[canvas.materials.iter().position(|name| name == "soil").expect("there") - 1];
    let cells = || canvas.mask.values().iter().zip(soil.values());
    assert!(cells().any(|(mask, _)| *mask > 0.9), "there is nearly whole mask");
    assert!(cells().all(|(mask, soil)| *soil <= 5.0 * (1.0 - mask) + 1e-4), "5 m at most of what it leaves");
    assert!(soil.sum() > 1.0, "beside the mask there is some");
    window.click("One step");
    window.until("a step", |status| status.steps == 1);
    let project = folder.path().join("project");
    let script = window.saved_script(&project);
    assert!(script.contains("\"do\": \"mask\""), "{script}");
    let shown = window.until("the steps after", |status| {
        status
            .shown
            .as_ref()
            .is_some_and(|shown| shown.changes == status.changes && shown.steps == usize::MAX)
    });
    let run = Recipe::load(&project.join("landscape.toml"), &Overrides::default()).expect("a recipe");
    let there = run.landscape().expect("it runs");
    let here = shown.shown.expect("shown").landscape;
    for name in ["height", "soil", "slope"] {
        assert_eq!(here.field(name).expect("here"), there.field(name).expect("there"), "{name}");
    }
    assert!(fs::read_to_string(project.join("landscape.toml")).is_ok());
    window.click("Undo");
    window.click("Undo");
    window.click("Undo");
    window.until("the start", |status| {
        status.moments.iter().all(|moment| !moment.is_past)
            && status.surface.as_ref().is_some_and(|surface| surface.canvas.mask.sum() == 0.0)
    });
    window.settle();
    assert_eq!(bare.share_that_differs(&window.seen()), 0.0, "no tint is left");
}

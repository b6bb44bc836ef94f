//! Each panel by what it says.

use std::fs;

use egui_kittest::kittest::Queryable;

use weald_studio::work::Shown;

use super::harness::Window;

const RECIPE: &str = "[landscape]\nsize = 64\ncell = 20.0\nseed = 3\n\n[[step]]\ndo = \"diamond-square\"\nrelief = 300.0\n\n\
    [[step]]\ndo = \"hydraulic\"\nmodel = \"stava\"\niterations = 40\n\n[[step]]\ndo = \"slope\"\n\n\
    [[output]]\nlayer = \"height\"\nfile = \"height.tif\"\n";

pub(crate) fn recipe() -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("valley.toml");
    fs::write(&file, RECIPE).expect("written");
    (folder, file)
}

#[test]
fn a_recipe_is_shown_played_painted_undone_and_redone() {
    let (_folder, file) = recipe();
    let mut window = Window::open(Some(&file));
    let status = window.settle();
    window.drawn();
    window.picture("opened");
    assert_eq!((status.held, status.written_steps), (Some(1), 40));
    window.click("One step");
    window.until("a step", |status| status.steps == 1);
    window.click("Play to the end");
    let status = window.until("the end", |status| status.steps == 40 && !status.plays);
    assert_eq!(status.moments.len(), 1, "{:?}", status.moments);
    window.click("Undo");
    window.until("the step", |status| status.steps == 0 || status.steps == 1);
    window.click("Redo");
    window.until("the end again", |status| status.steps == 40);
    window.until("the steps after", |status| {
        status.shown.as_ref().is_some_and(|shown| shown.landscape.field("slope").is_ok())
    });
}

#[test]
fn the_start_offers_templates_and_goes_on_with_what_is_shown() {
    let mut window = Window::open(None);
    window.harness.step();
    assert!(window.harness.query_by_label("Begin with").is_some());
    window.click("layers");
    window.harness.step();
    assert!(window.harness.query_by_label("Begin with").is_none());
    window.until("a landscape", |status| status.shown.is_some());
}

#[test]
fn what_is_painted_is_undone_saved_run_and_opened_again_to_the_bit() {
    let (folder, file) = recipe();
    let mut window = Window::open(Some(&file));
    window.settle();
    window.click("Play to the end");
    window.until("the end", |status| status.steps == 40 && !status.plays);
    window.settle();
    window.drawn();
    for (tool, from, to) in [("Water", [0.35, 0.5], [0.6, 0.55]), ("Add", [0.4, 0.6], [0.5, 0.4])] {
        window.click(tool);
        window.stroke(from, to);
        window.until("the stroke", |status| status.moments.len() > 1);
        window.click("One step");
    }
    let painted = window.until("a step after it", |status| status.steps == 42 && status.moments.len() == 5);
    window.settle();
    window.drawn();
    window.picture("painted");
    for _ in 0..5 {
        window.click("Undo");
    }
    window.until("the start", |status| {
        status.steps == 0 && status.moments.iter().all(|moment| !moment.is_past)
    });
    for _ in 0..5 {
        window.click("Redo");
    }
    window.until("all again", |status| status.moments == painted.moments);
    let project = folder.path().join("project");
    window.click("Save");
    window.type_over("Path", &project.display().to_string());
    window.click_last("Save");
    let file = project.join("landscape.toml");
    window.until("the file", |status| status.saved.as_ref().is_some_and(|(saved, _)| *saved == file));
    let shown = window.until("the steps after", |status| {
        let is_of_now = |shown: &&Shown| shown.changes == status.changes && shown.steps == usize::MAX;
        status.shown.as_ref().filter(is_of_now).is_some_and(|shown| shown.landscape.field("slope").is_ok())
    });
    let here = shown.shown.expect("shown").landscape;
    let run =
        weald::recipe::Recipe::load(&project.join("landscape.toml"), &weald::recipe::Overrides::default());
    let there = run.expect("a recipe").landscape().expect("it runs");
    for name in ["height", "water", "slope"] {
        assert_eq!(here.field(name).expect("here"), there.field(name).expect("there"), "{name}");
    }
    drop(window);
    let mut again = Window::open(Some(&project));
    let status = again.settle();
    assert_eq!(status.steps, 42);
    assert_eq!(status.moments.len(), 5, "{:?}", status.moments);
}

#[test]
fn ctrl_z_undoes_and_ctrl_shift_z_does_it_again() {
    let (_folder, file) = recipe();
    let mut window = Window::open(Some(&file));
    window.settle();
    window.click("One step");
    window.until("a step", |status| status.steps == 1);
    let command = eframe::egui::Modifiers::COMMAND;
    window.harness.key_press_modifiers(command, eframe::egui::Key::Z);
    window.until("the start", |status| status.steps == 0);
    window.harness.key_press_modifiers(command | eframe::egui::Modifiers::SHIFT, eframe::egui::Key::Z);
    window.until("the step again", |status| status.steps == 1);
}

#[test]
fn who_goes_back_while_it_runs_stays_there() {
    let (_folder, file) = recipe();
    let mut window = Window::open(Some(&file));
    window.settle();
    window.click("Play or pause");
    window.until("some steps", |status| status.steps > 0);
    window.harness.key_press_modifiers(eframe::egui::Modifiers::COMMAND, eframe::egui::Key::Z);
    window.until("the start", |status| status.steps == 0 && !status.plays);
    for _ in 0..20 {
        assert_eq!(window.status().steps, 0, "it stays");
    }
}

#[test]
fn a_step_that_is_switched_off_is_left_out_until_it_is_switched_on() {
    let (_folder, file) = recipe();
    let mut window = Window::open(Some(&file));
    window.settle();
    let has_slope = |status: &weald_studio::work::Status| {
        status.shown.as_ref().is_some_and(|shown| shown.landscape.field("slope").is_ok())
    };
    window.until("the slope", has_slope);
    window.click("3. slope");
    window.click_last("Switch off");
    window.until("a run without it", |status| {
        status.revision == 2 && status.shown.as_ref().is_some_and(|shown| shown.revision == 2)
    });
    window.settle();
    assert!(!has_slope(&window.status()));
    window.click_last("Switch on");
    window.until("the slope again", has_slope);
}

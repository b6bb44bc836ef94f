//! What cannot be done, or cannot run, leaves no trace and is said.

use std::fs;
use std::time::{Duration, Instant};

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;

use super::harness::Window;
use super::looking::opened;
use super::panels::recipe;

/// A recipe whose simulation has no water.
fn without_water() -> (tempfile::TempDir, Window) {
    let (folder, file) = recipe();
    let text = fs::read_to_string(&file).expect("a recipe");
    let text = text.replace("do = \"hydraulic\"\nmodel = \"stava\"\niterations = 40", "do = \"thermal\"");
    fs::write(&file, text).expect("written");
    let mut window = Window::open(Some(&file));
    window.settle();
    window.drawn();
    (folder, window)
}

#[test]
fn a_stroke_that_is_refused_takes_no_place_in_what_is_undone_and_nothing_from_what_is_redone() {
    let (_folder, mut window) = without_water();
    for steps in 1..=2 {
        window.click("One step");
        window.until("a step", |status| status.steps == steps);
    }
    window.click("Undo");
    window.until("the start", |status| status.steps == 0);
    window.click("Water");
    window.stroke([0.4, 0.5], [0.55, 0.5]);
    let status = window.until("the refusal", |status| status.refused > 0 && status.error.is_some());
    assert_eq!(status.refused, 1, "a stroke is one, however many pieces it has");
    assert!(status.error.expect("a sentence").contains("knows no water"));
    window.click("Redo");
    window.until("the steps again", |status| status.steps == 2);
    window.stroke([0.4, 0.5], [0.55, 0.5]);
    window.until("another refusal", |status| status.refused == 2);
    // What was done last is the change of the recipe, and not the stroke that left nothing.
    window.reach("3. slope");
    window.harness.run_steps(20);
    window.click_last("Switch off");
    let off = window.harness.state().text().to_owned();
    assert!(off.contains("off = true"), "{off}");
    window.stroke([0.4, 0.5], [0.55, 0.5]);
    window.until("a third refusal", |status| status.refused == 3);
    window.click("Undo");
    assert!(!window.harness.state().text().contains("off = true"), "{}", window.harness.state().text());
    assert_eq!(window.status().steps, 2, "the steps stay");
}

#[test]
fn what_went_wrong_is_still_told_when_what_is_not_saved_has_been_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("broken.tif");
    fs::write(&file, b"II*\0 no picture").expect("written");
    let mut window = Window::open(Some(&file));
    window.until("the error", |status| status.error.is_some());
    let begun = Instant::now();
    while !window.harness.state().is_kept() {
        window.harness.step();
        assert!(begun.elapsed() < Duration::from_mins(1), "nothing is kept");
    }
    let error = window.status().error.expect("it is still told");
    assert!(error.contains("broken.tif"), "{error}");
}

#[test]
fn a_text_that_has_never_run_is_saved_as_it_is_typed() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("broken.toml");
    let text = "[landscape]\nsize = 64\ncell = 20.0\n\n[[step]]\ndo = \"diamond-sqare\"\n\n\
        [[output]]\nlayer = \"height\"\nfile = \"height.tif\"\n";
    fs::write(&file, text).expect("written");
    let mut window = Window::open(Some(&file));
    window.harness.run_steps(3);
    let project = folder.path().join("project");
    window.click("Save");
    window.type_over("Path", &project.display().to_string());
    window.click_last("Save");
    assert!(window.has("saved as it is typed; it cannot run yet: line 6"), "{}", window.label_with("sa"));
    assert_eq!(fs::read_to_string(project.join("landscape.toml")).expect("saved"), text);
    window.harness.run_steps(3);
    assert!(!project.join("typed.toml").is_file(), "it is saved, and need not be kept beside itself");
}

#[test]
fn nothing_of_one_project_is_saved_in_the_place_of_another() {
    let (folder, mut window) = opened();
    let other = folder.path().join("other");
    fs::create_dir(&other).expect("made");
    let wrong = "[landscape]\nsize = 32\ncell = 20.0\n\n[[step]]\ndo = \"fbn\"\n";
    fs::write(other.join("landscape.toml"), wrong).expect("written");
    window.click("Open");
    window.type_over("Path", &other.display().to_string());
    window.click_last("Open");
    window.until("nothing is held", |status| status.held.is_none());
    window.click_last("Save");
    window.harness.run_steps(20);
    assert_eq!(fs::read_to_string(other.join("landscape.toml")).expect("there"), wrong);
    window.click("Export");
    window.type_over("Path", &other.join("out").display().to_string());
    window.click_last("Export");
    let status = window.until("a sentence", |status| status.error.is_some());
    assert!(status.error.expect("said").contains("nothing has run yet") && status.exported.is_none());
}

#[test]
fn a_brush_on_bare_rock_takes_up_its_material_again_where_there_is_some() {
    let (folder, file) = recipe();
    let text = fs::read_to_string(&file).expect("a recipe");
    let bare = folder.path().join("bare.toml");
    let rock = "[[material]]\nname = \"rock\"\n\n";
    fs::write(&bare, text.replacen("[[step]]", &format!("{rock}[[step]]"), 1)).expect("written");
    let mut window = Window::open(Some(&bare));
    window.settle();
    window.click("Add");
    let material = |window: &Window| {
        window.harness.get_by_role_and_label(Role::ComboBox, "Material").value().unwrap_or_default()
    };
    window.until("its materials", |status| status.materials == ["rock"]);
    assert_eq!(material(&window), "rock");
    window.click("Open");
    window.type_over("Path", &file.display().to_string());
    window.click_last("Open");
    window.until("its materials", |status| status.materials.len() > 1);
    window.harness.run_steps(3);
    assert_eq!(material(&window), "soil");
}

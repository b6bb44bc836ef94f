//! Lines of the guide, done word by word: the bar of a comparison, a step shown by itself, a file that is dropped, and what was
//! not saved taken up again.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use eframe::egui::{DroppedFile, vec2};
use egui_kittest::kittest::Queryable;

use super::harness::Window;
use super::looking::opened;
use super::panels::recipe;

#[test]
fn the_bar_between_two_moments_is_dragged_and_shows_more_of_what_was_pinned() {
    let (_folder, mut window) = opened();
    window.click("Compare");
    window.until_pinned();
    let bar = |window: &Window| window.harness.get_by_label("Bar between two moments").rect().center();
    let from = bar(&window);
    let middle = window.harness.get_by_label("Viewport").rect().center();
    assert!((from.x - middle.x).abs() < 2.0, "it begins in the middle");
    window.harness.hover_at(from);
    window.harness.step();
    window.harness.drag_at(from);
    window.harness.step();
    for share in [0.5, 1.0] {
        window.harness.hover_at(from + vec2(share * 150.0, 0.0));
        window.harness.step();
    }
    window.harness.drop_at(from + vec2(150.0, 0.0));
    window.harness.run_steps(3);
    let there = bar(&window).x;
    assert!((there - from.x - 150.0).abs() < 12.0, "{there} from {}", from.x);
    window.click("Compare");
    assert!(window.harness.query_by_label("Bar between two moments").is_none());
}

#[test]
fn a_step_is_shown_by_itself_until_the_end_is_wanted_again() {
    let (_folder, mut window) = opened();
    window.click("1. diamond-square");
    window.harness.run_steps(20);
    window.click("Show here");
    let status = window
        .until("the first step alone", |status| status.shown.as_ref().is_some_and(|shown| shown.steps == 1));
    assert!(
        status.shown.expect("shown").landscape.field("slope").is_err(),
        "what comes after it is not there"
    );
    assert_eq!(status.held, None, "it has no water that could run");
    window.click("Show the end");
    window.until("all steps", |status| {
        status.held == Some(1)
            && status.shown.as_ref().is_some_and(|shown| shown.landscape.field("slope").is_ok())
    });
}

#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        fs::read(&self.0).map_err(|cause| cause.to_string())
    }
}

#[test]
fn a_recipe_that_is_dropped_onto_the_window_is_opened() {
    let (folder, mut window) = opened();
    let other = folder.path().join("other.toml");
    let text = fs::read_to_string(folder.path().join("valley.toml")).expect("a recipe");
    fs::write(&other, text.replace("iterations = 40", "iterations = 7")).expect("written");
    window.harness.input_mut().dropped_files.push(Arc::new(Dropped(other)));
    window.until("the other recipe", |status| status.written_steps == 7);
    let letter = folder.path().join("letter.docx");
    fs::write(&letter, "dear").expect("written");
    window.harness.input_mut().dropped_files.push(Arc::new(Dropped(letter)));
    window.harness.run_steps(2);
    assert!(window.has("is no recipe (.toml)"), "{:?}", window.harness.state().message());
    assert_eq!(window.status().written_steps, 7, "what is open stays");
}

#[test]
fn what_was_not_saved_is_taken_up_by_the_next_start() {
    let (_folder, file) = recipe();
    let own = tempfile::tempdir().expect("a folder");
    let mut window = Window::on_machine(Some(&file), own.path());
    window.settle();
    window.click("One step");
    window.until("a step that is kept", |status| {
        status.steps == 1
            && status.autosaved.as_ref().is_some_and(|(_, state)| state.changes == status.changes)
    });
    // A window that is not closed leaves what one that is killed leaves.
    drop(window);
    let mut again = Window::on_machine(None, own.path());
    again.until("the step again", |status| status.steps == 1);
    assert!(again.has("what was not saved has been taken up again"), "{:?}", again.harness.state().message());
}

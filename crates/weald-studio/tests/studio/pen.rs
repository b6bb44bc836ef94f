//! A pen that tells how hard it is pressed, and the dialogs of the system for files.

use std::cell::RefCell;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::mpsc::channel;

use eframe::egui::{Event, Pos2, TouchDeviceId, TouchId, TouchPhase};
use weald_studio::{Chooser, Options, Wanted};

use super::harness::Window;
use super::looking::opened;
use super::panels::recipe;

impl Window {
    fn touch(&mut self, phase: TouchPhase, force: f32) {
        let (device_id, id, pos) = (TouchDeviceId(1), TouchId(1), Pos2::ZERO);
        self.harness.event(Event::Touch { device_id, id, phase, pos, force: Some(force) });
        self.harness.step();
    }
}

#[test]
fn a_stroke_of_a_pen_is_as_strong_as_it_is_pressed_unless_that_is_to_be_ignored() {
    let (folder, mut window) = opened();
    window.click("Water");
    window.touch(TouchPhase::Start, 0.5);
    window.stroke([0.4, 0.4], [0.6, 0.4]);
    window.touch(TouchPhase::End, 0.0);
    window.until("a stroke", |status| status.moments.len() == 1);
    window.choose("Pen pressure", "is ignored");
    window.touch(TouchPhase::Start, 0.5);
    window.stroke([0.4, 0.6], [0.6, 0.6]);
    window.touch(TouchPhase::End, 0.0);
    window.until("another", |status| status.moments.len() == 2);
    let script = window.saved_script(&folder.path().join("project"));
    let lines: Vec<_> = script.lines().collect();
    assert!(lines[0].contains("\"strength\": 0.5"), "{}", lines[0]);
    assert!(lines[1].contains("\"strength\": 1.0"), "{}", lines[1]);
}

/// A window whose dialogs give these answers, one after the other.
fn with_dialogs(answers: Vec<Option<PathBuf>>) -> (tempfile::TempDir, Window, Rc<RefCell<Vec<Wanted>>>) {
    let (folder, file) = recipe();
    let asked = Rc::<RefCell<Vec<Wanted>>>::default();
    let (told, answers) = (Rc::clone(&asked), RefCell::new(answers));
    let chooser: Chooser = Rc::new(move |wanted| {
        told.borrow_mut().push(wanted);
        let (sender, receiver) = channel();
        sender.send(answers.borrow_mut().remove(0)).expect("somebody waits");
        receiver
    });
    let options = Options {
        what: Some(file),
        own_files: Some(folder.path().join("own")),
        chooser: Some(chooser),
        ..Options::default()
    };
    let mut window = Window::with(options);
    window.settle();
    (folder, window, asked)
}

#[test]
fn a_file_or_a_folder_is_chosen_in_a_dialog_of_the_system_and_without_one_a_sentence_says_so() {
    let elsewhere = tempfile::tempdir().expect("a folder");
    let other = elsewhere.path().join("other.toml");
    let out = elsewhere.path().join("out");
    let (folder, mut window, asked) = with_dialogs(vec![None, Some(other.clone()), Some(out.clone())]);
    let text = std::fs::read_to_string(folder.path().join("valley.toml")).expect("a recipe");
    std::fs::write(&other, text.replace("iterations = 40", "iterations = 7")).expect("written");
    window.click("Open");
    window.click("Choose a file …");
    window.harness.run_steps(3);
    assert!(window.has("type the path"), "{:?}", window.harness.state().message());
    assert!(window.has("Choose a file …"), "the question is still there");
    window.click("Choose a file …");
    window.until("the other recipe", |status| status.written_steps == 7);
    window.click("Export");
    window.click("Choose a folder …");
    window.harness.run_steps(3);
    window.click_last("Export");
    let status = window.until("the files", |status| status.exported.is_some());
    assert_eq!(status.exported.expect("exported").0, out);
    assert_eq!(*asked.borrow(), [Wanted::File, Wanted::File, Wanted::Folder]);
}

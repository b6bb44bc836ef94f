//! Marks of springs and drains over the picture.

use std::fs;

use egui_kittest::kittest::Queryable;

use super::harness::Window;
use super::panels::recipe;

#[test]
fn a_spring_that_is_dragged_rises_elsewhere_and_its_mark_goes_with_it() {
    let (folder, file) = recipe();
    let text = fs::read_to_string(&file).expect("a recipe");
    let spring = "sources = [{ x = 640.0, y = 640.0, radius = 40.0, rate = 0.5 }] # a spring\n";
    fs::write(&file, text.replace("iterations = 40\n", &format!("iterations = 40\n{spring}")))
        .expect("written");
    let mut window = Window::open(Some(&file));
    window.settle();
    window.drawn();
    let from = window.harness.get_by_label("Spring 1").rect().center();
    window.picture("spring");
    let to = from + eframe::egui::vec2(60.0, 20.0);
    window.harness.hover_at(from);
    window.harness.step();
    window.harness.drag_at(from);
    window.harness.step();
    for share in [0.25, 0.5, 0.75, 1.0] {
        window.harness.hover_at(from + share * (to - from));
        window.harness.step();
    }
    window.harness.drop_at(to);
    window.harness.run_steps(3);
    let there = window.harness.get_by_label("Spring 1").rect().center();
    assert!((there - to).length() < 4.0, "the mark is at {there:?}, the hand at {to:?}");
    window.until("a run with it", |status| {
        status.revision == 2 && status.shown.as_ref().is_some_and(|shown| shown.revision == 2)
    });
    // What comes with the picture moves what is clicked.
    window.drawn();
    let project = folder.path().join("project");
    window.saved_script(&project);
    let text = fs::read_to_string(project.join("landscape.toml")).expect("saved");
    let line = text.lines().find(|line| line.starts_with("sources")).unwrap_or_else(|| panic!("{text}"));
    assert!(line.contains("radius = 40.0, rate = 0.5") && line.ends_with("# a spring"), "{line}");
    assert!(!line.contains("x = 640.0") && !line.contains("y = 640.0"), "{line}");
    window.click("Undo");
    window.until("the spring where it was", |status| status.revision == 3);
    window.drawn();
    let back = window.harness.get_by_label("Spring 1").rect().center();
    assert!((back - from).length() < 1.0, "{back:?} for {from:?}");
}

//! The list of what was done.

use egui_kittest::kittest::Queryable;

use super::harness::Window;
use super::looking::opened;

/// A step, a stroke, a step.
fn with_a_history() -> (tempfile::TempDir, Window) {
    let (folder, mut window) = opened();
    window.click("One step");
    window.until("a step", |status| status.steps == 1);
    window.click("Add");
    window.stroke([0.4, 0.5], [0.5, 0.55]);
    window.until("a stroke", |status| status.moments.len() == 2);
    window.click("One step");
    window.until("another step", |status| status.steps == 2 && status.moments.len() == 3);
    (folder, window)
}

impl Window {
    /// Which lines of the history lie in the past.
    fn past(&mut self) -> Vec<bool> {
        self.status().moments.iter().map(|moment| moment.is_past).collect()
    }
}

#[test]
fn a_click_on_a_line_of_the_history_goes_there_and_back_again() {
    let (_folder, mut window) = with_a_history();
    let lines: Vec<_> =
        window.status().moments.iter().map(|moment| format!("{} · {}", moment.steps, moment.label)).collect();
    assert_eq!(lines[1..], ["1 · add soil", "2 · 1 steps"].map(str::to_owned)[..]);
    window.reach(&lines[1]);
    window.until("the stroke", |status| status.steps == 1 && !status.moments[2].is_past);
    assert_eq!(window.past(), [true, true, false], "what comes after it is still there");
    window.reach("Start");
    window.until("the start", |status| status.steps == 0);
    assert_eq!(window.past(), [false; 3]);
    window.reach(&lines[2]);
    window.until("the end", |status| status.steps == 2);
    assert_eq!(window.past(), [true; 3]);
}

#[test]
fn a_moment_with_a_name_is_come_back_to_from_another_branch() {
    let (_folder, mut window) = with_a_history();
    window.type_over("Name", "levee");
    window.reach("Keep");
    window.until("the name", |status| status.names.iter().any(|(name, _)| name == "levee"));
    window.reach("Start");
    window.until("the start", |status| status.steps == 0);
    window.reach("Smooth");
    window.stroke([0.5, 0.4], [0.6, 0.5]);
    window.until("another branch", |status| status.moments.len() == 1);
    assert_eq!(window.status().moments[0].label, "smooth");
    window.reach("levee");
    let status = window.until("the named moment", |status| status.steps == 2);
    assert_eq!(status.moments.len(), 3, "{:?}", status.moments);
    assert!(window.harness.query_by_label_contains("smooth").is_none(), "the other branch is left");
    window.type_over("Name", "dam");
    window.reach("rename");
    let status = window.until("another name", |status| status.names.iter().all(|(name, _)| name == "dam"));
    assert_eq!(status.names.len(), 1, "{:?}", status.names);
}

#[test]
fn the_slider_goes_through_all_that_was_done() {
    let (_folder, mut window) = with_a_history();
    let role = eframe::egui::accesskit::Role::Slider;
    for (place, steps) in [(0.0, 0), (1.0, 1), (3.0, 2), (2.0, 1)] {
        window.harness.get_by_role_and_label(role, "Moment").set_value_accesskit(place);
        window.harness.step();
        let now = window.until("the moment", |status| {
            let past = status.moments.iter().filter(|moment| moment.is_past).count();
            past as f64 == place
        });
        assert_eq!(now.steps, steps, "after {place} stretches");
    }
}

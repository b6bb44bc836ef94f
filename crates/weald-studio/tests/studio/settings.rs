//! What is set on the right of the window is what happens: brushes, the keys of the running step, light and colours.

use std::fs;
use std::path::Path;

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;

use super::harness::Window;
use super::looking::{opened, told};

impl Window {
    fn set(&mut self, role: Role, label: &str, value: f64) {
        self.harness.get_by_role_and_label(role, label).set_value_accesskit(value);
        self.harness.step();
        self.harness.step();
    }

    fn offers(&self, role: Role, label: &str) -> bool {
        self.harness.query_by_role_and_label(role, label).is_some()
    }

    /// Saves into a folder, and gives the script of what was done.
    pub(crate) fn saved_script(&mut self, project: &Path) -> String {
        self.click("Save");
        self.type_over("Path", &project.display().to_string());
        self.click_last("Save");
        let file = project.join("landscape.toml");
        self.until("the file", |status| status.saved.as_ref().is_some_and(|(saved, _)| *saved == file));
        fs::read_to_string(project.join("landscape.edits.jsonl")).expect("a script")
    }
}

#[test]
fn a_stroke_has_the_width_strength_edge_and_amount_that_are_set() {
    let (folder, mut window) = opened();
    window.click("Water");
    window.set(Role::Slider, "Radius", 64.0);
    window.set(Role::Slider, "Strength", 0.5);
    window.choose("Falloff", "linear");
    window.set(Role::SpinButton, "Depth", 3.25);
    window.stroke([0.4, 0.5], [0.5, 0.5]);
    window.until("water", |status| status.moments.len() == 1);
    window.click("Remove");
    let material = window.status().materials[0].clone();
    window.choose("Material", &material);
    window.set(Role::SpinButton, "Thickness", 7.5);
    window.stroke([0.5, 0.6], [0.6, 0.6]);
    window.until("a ditch", |status| status.moments.len() == 2);
    let script = window.saved_script(&folder.path().join("project"));
    let lines: Vec<_> = script.lines().filter(|line| line.contains("\"path\"")).collect();
    assert_eq!(lines.len(), 2, "{script}");
    assert!(lines[0].contains("\"do\": \"add-water\", \"depth\": 3.25"), "{}", lines[0]);
    assert!(
        lines[1].contains(&format!("\"do\": \"remove\", \"material\": \"{material}\", \"thickness\": 7.5")),
        "{}",
        lines[1]
    );
    for line in lines {
        assert!(line.contains("\"radius\": 64.0, \"falloff\": \"linear\", \"strength\": 0.5"), "{line}");
    }
}

#[test]
fn each_brush_asks_for_its_own_amount_only() {
    let (_folder, mut window) = opened();
    let amounts = ["Thickness", "Depth", "Elevation", "Depth a step", "Factor on the rain"];
    for (tool, wanted) in [
        ("Add", Some("Thickness")),
        ("Remove", Some("Thickness")),
        ("Water", Some("Depth")),
        ("Dry", Some("Depth")),
        ("Flatten", Some("Elevation")),
        ("Spring", Some("Depth a step")),
        ("Drain", Some("Depth a step")),
        ("Rain", Some("Factor on the rain")),
        ("Smooth", None),
        ("Level", None),
        ("Freeze", None),
        ("Thaw", None),
        ("Mask", None),
        ("Unmask", None),
    ] {
        window.click(tool);
        for amount in amounts {
            assert_eq!(window.offers(Role::SpinButton, amount), wanted == Some(amount), "{tool}: {amount}");
        }
        let has_material = matches!(tool, "Add" | "Remove");
        assert_eq!(window.offers(Role::ComboBox, "Material"), has_material, "{tool}");
    }
    window.click("Unmask");
    window.stroke([0.4, 0.5], [0.6, 0.5]);
    assert!(window.status().moments.is_empty(), "without a brush the pointer moves the camera");
}

#[test]
fn a_key_that_is_changed_while_it_runs_holds_from_there_on() {
    let (folder, mut window) = opened();
    window.click("One step");
    window.until("a step", |status| status.steps == 1);
    window.click("Change while it runs");
    window.harness.run_steps(20);
    let more = window.label_with("More keys");
    window.reach(&more);
    window.harness.run_steps(30);
    window.harness.get_by_role_and_label(Role::SpinButton, "capacity").set_value_accesskit(0.75);
    window.harness.step();
    window.until("the setting", |status| status.moments.len() == 2);
    window.reach("One step");
    window.until("a step after it", |status| status.steps == 2);
    let script = window.saved_script(&folder.path().join("project"));
    let line = script.lines().find(|line| line.contains("0.75")).unwrap_or_else(|| panic!("{script}"));
    assert!(line.contains("\"step\": 1") && line.contains("\"capacity\""), "{line}");
}

#[test]
fn each_of_the_looks_changes_the_picture_and_can_be_set_back() {
    let (_folder, mut window) = opened();
    let plain = window.seen();
    for (slider, other, usual) in
        [("Time of day", 9.0, 17.0), ("Height factor", 2.5, 1.0), ("Exposure", -1.0, 0.0)]
    {
        window.set(Role::Slider, slider, other);
        assert!(plain.share_that_differs(&window.seen()) > 0.1, "{slider}");
        window.set(Role::Slider, slider, usual);
        assert_eq!(plain.share_that_differs(&window.seen()), 0.0, "{slider} set back");
    }
    window.choose("Ground", "materials");
    assert!(plain.share_that_differs(&window.seen()) > 0.1, "the colours of materials");
    window.choose("Ground", "as the recipe says");
    assert_eq!(plain.share_that_differs(&window.seen()), 0.0);
    window.click("Water");
    window.stroke([0.45, 0.45], [0.6, 0.45]);
    // Water at rest is drawn a little otherwise than water that was just poured.
    window.until("water at rest", |status| {
        let is_whole = status.shown.as_ref().is_some_and(|shown| shown.changes == status.changes);
        status.moments.len() == 1 && is_whole
    });
    window.click("Water");
    let wet = window.seen();
    assert!(plain.share_that_differs(&wet) > 0.01, "there is water");
    window.click("Draw water");
    assert!(wet.share_that_differs(&window.seen()) > 0.01, "the water is gone");
    window.click("Draw water");
    assert_eq!(wet.share_that_differs(&window.seen()), 0.0);
}

#[test]
fn whoever_walks_stands_on_the_land_and_a_list_is_left_by_escape() {
    let (_folder, mut window) = opened();
    let whole = window.seen();
    window.click("Walk");
    let standing = window.seen();
    assert!(whole.share_that_differs(&standing) > 0.3, "it looks ahead");
    let [east, south] = told(&mut window, [0.5, 0.97]);
    let away = (east - 640.0).hypot(south - 640.0);
    assert!(away < 60.0, "from beside the land one is put into its middle, and not {away} m from there");
    window.click("Water");
    window.harness.get_by_role_and_label(Role::ComboBox, "Falloff").click();
    window.harness.run_steps(3);
    assert!(window.harness.query_by_label("gaussian").is_some());
    window.harness.key_press(eframe::egui::Key::Escape);
    window.harness.run_steps(3);
    assert!(window.harness.query_by_label("gaussian").is_none(), "the list is gone");
    assert!(window.offers(Role::SpinButton, "Depth"), "the brush is still there");
}

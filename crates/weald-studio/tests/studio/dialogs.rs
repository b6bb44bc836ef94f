//! What lies over the window when something is asked: files, export, commands, the tour.

use std::fs;

use eframe::egui::accesskit::{Role, Toggled};
use eframe::egui::{Key, Modifiers, Rect, ViewportEvent, ViewportId};
use egui_kittest::kittest::{NodeT, Queryable};

use super::harness::{Pixels, Window};
use super::looking::opened;

impl Window {
    /// The middle of the window, where questions stand.
    fn middle(&mut self) -> Pixels {
        self.drawn();
        let whole = self.harness.ctx.viewport_rect();
        self.pixels(Rect::from_center_size(whole.center(), 0.3 * whole.size()))
    }

    fn press(&mut self, key: Key) {
        self.harness.key_press(key);
        self.harness.step();
        self.harness.step();
    }

    fn offers_path(&self) -> bool {
        self.harness.query_by_role_and_label(Role::TextInput, "Path").is_some()
    }
}

#[test]
fn a_question_lies_over_the_window_and_leaves_no_trace() {
    let (_folder, mut window) = opened();
    window.hover([0.98, 0.98]);
    let before = window.middle();
    for command in ["Open", "Save", "Export"] {
        window.click(command);
        window.hover([0.98, 0.98]);
        window.harness.run_steps(30);
        assert!(before.share_that_differs(&window.middle()) > 0.05, "{command} shows its question");
        assert!(window.offers_path());
        window.click("Cancel");
        window.hover([0.98, 0.98]);
        window.harness.run_steps(30);
        assert!(!window.offers_path());
        assert_eq!(before.share_that_differs(&window.middle()), 0.0, "{command} is gone");
    }
    window.click("Export");
    window.press(Key::Escape);
    assert!(!window.offers_path(), "Escape leaves it too");
    assert!(window.status().exported.is_none() && window.status().saved.is_none(), "nothing was written");
}

#[test]
fn export_writes_the_outputs_of_the_recipe_and_says_how_many() {
    let (folder, mut window) = opened();
    let out = folder.path().join("out");
    window.click("Export");
    window.type_over("Path", &out.display().to_string());
    window.click_last("Export");
    let status = window.until("the files", |status| status.exported.is_some());
    let (there, names) = status.exported.expect("exported");
    assert_eq!((there, names), (out.clone(), ["height.tif", "height.qml"].map(str::to_owned).to_vec()));
    assert!(out.join("height.tif").is_file());
    window.harness.step();
    assert!(window.has("2 files are in"), "the foot of the window says so");
}

#[test]
fn a_file_is_opened_by_its_path_and_enter_does_as_the_button() {
    let (folder, mut window) = opened();
    let other = folder.path().join("other.toml");
    let text = fs::read_to_string(folder.path().join("valley.toml")).expect("a recipe");
    fs::write(&other, text.replace("iterations = 40", "iterations = 7")).expect("written");
    window.harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    window.harness.step();
    window.harness.step();
    window.type_over("Path", &other.display().to_string());
    window.press(Key::Enter);
    window.until("the other recipe", |status| status.written_steps == 7);
    window.click("New landscape");
    window.harness.step();
    assert!(window.has("Open of late") && window.has("other.toml"), "it is among what was open of late");
}

#[test]
fn what_is_typed_and_cannot_run_is_kept_when_the_project_is_saved() {
    let (folder, mut window) = opened();
    let project = folder.path().join("project");
    window.click("Cards or text");
    let text = fs::read_to_string(folder.path().join("valley.toml")).expect("a recipe");
    let wrong = text.replace("relief = 300.0", "releif = 300.0");
    window.type_in((Role::MultilineTextInput, "Recipe as text"), &wrong);
    window.saved_script(&project);
    window.harness.step();
    assert!(window.has("in typed.toml, for it cannot run: line 8"), "{}", window.label_with("saved"));
    window.until("the typed text", |_| project.join("typed.toml").is_file());
    assert_eq!(fs::read_to_string(project.join("typed.toml")).expect("kept"), wrong);
    drop(window);
    let mut again = Window::open(Some(&project));
    again.harness.run_steps(3);
    assert!(again.has("releif"), "the next start has what was typed, with what is wrong");
}

#[test]
fn who_closes_what_is_not_saved_is_asked_first() {
    let (_folder, mut window) = opened();
    window.click("One step");
    window.until("a step", |status| status.steps == 1);
    let close = |window: &mut Window| {
        let root = window.harness.input_mut().viewports.entry(ViewportId::ROOT).or_default();
        root.events.push(ViewportEvent::Close);
        window.harness.step();
        let root = window.harness.input_mut().viewports.entry(ViewportId::ROOT).or_default();
        root.events.clear();
        window.harness.step();
    };
    close(&mut window);
    assert!(window.has("There is something that is not saved"));
    window.click("Cancel");
    assert!(!window.has("There is something that is not saved"));
    assert_eq!(window.status().steps, 1, "nothing is lost");
}

#[test]
fn the_palette_is_gone_through_by_keys_and_left_by_escape() {
    let (_folder, mut window) = opened();
    let open = |window: &mut Window| {
        window.harness.key_press_modifiers(Modifiers::COMMAND, Key::K);
        window.harness.step();
        window.harness.step();
    };
    open(&mut window);
    window.type_over("Find", "brush");
    // No brush, add, remove, water: the fourth of those found.
    for _ in 0..4 {
        window.press(Key::ArrowDown);
    }
    window.press(Key::ArrowUp);
    window.press(Key::Enter);
    let is_on = |tool| window.harness.get_by_label(tool).accesskit_node().toggled() == Some(Toggled::True);
    assert_eq!(["Remove", "Water", "Dry"].map(is_on), [false, true, false]);
    open(&mut window);
    assert!(window.harness.query_by_role_and_label(Role::TextInput, "Find").is_some());
    window.press(Key::Escape);
    assert!(window.harness.query_by_role_and_label(Role::TextInput, "Find").is_none());
    open(&mut window);
    window.type_over("Find", "one step");
    window.click_last("One step  .");
    window.until("a step, by a click", |status| status.steps == 1);
}

#[test]
fn the_tour_goes_on_page_by_page_and_can_be_ended_at_any() {
    let (_folder, mut window) = opened();
    window.press(Key::F1);
    let pages = ["The landscape", "The recipe", "The simulation", "The brushes"];
    for (place, page) in pages.iter().enumerate() {
        assert!(window.has(&format!("Tour, {} of 6", place + 1)) && window.has(page), "{page}");
        window.click("Next");
    }
    window.click("End the tour");
    assert!(!window.has("Tour, "));
}

#[test]
fn a_preset_says_what_it_writes_and_what_is_lost_and_writes_that() {
    let (folder, mut window) = opened();
    let out = folder.path().join("out");
    window.click("Export");
    assert!(window.has("height: nothing is lost"), "the recipe's own output");
    window.choose("Preset", "Unity");
    window.harness.run_steps(20);
    assert!(window.has("unity/height.raw") && window.has("16-bit heights of 2^n + 1 vertices"));
    window.choose("Preset", "Everything");
    window.harness.run_steps(20);
    assert!(window.has("rounded to a 65,535th") && window.has("Not of this recipe"));
    window.picture("export");
    window.choose("Preset", "GIS");
    window.harness.run_steps(20);
    window.type_over("Path", &out.display().to_string());
    window.click_last("Export");
    let status = window.until("the files", |status| status.exported.is_some());
    let (_, names) = status.exported.expect("exported");
    assert!(
        names.contains(&"gis/height.tif".to_owned()) && names.contains(&"gis/slope.tif".to_owned()),
        "{names:?}"
    );
    assert!(out.join("gis/slope.tif").is_file() && !out.join("height.tif").is_file());
    let text = fs::read_to_string(out.join("landscape.toml")).expect("how it was made");
    assert!(text.contains("preset = \"cog\"") && text.contains("do = \"hydraulic\""), "{text}");
    assert!(!window.harness.state().text().contains("cog"), "the recipe itself stays as it is");
}

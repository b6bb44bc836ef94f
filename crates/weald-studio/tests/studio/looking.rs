//! Ways to look: layers over the ground, sections, cameras that are kept, two moments beside each other, the palette.

use std::fs;

use eframe::egui::accesskit::Role;
use eframe::egui::{Key, Modifiers, Rect};
use egui_kittest::kittest::{NodeT, Queryable};

use super::harness::{Pixels, Window};
use super::panels::recipe;

/// A window with a landscape in it.
pub(crate) fn opened() -> (tempfile::TempDir, Window) {
    let (folder, file) = recipe();
    let mut window = Window::open(Some(&file));
    // The steps after the one that is held run once it rests.
    window.until("all steps", |status| {
        status.shown.as_ref().is_some_and(|shown| shown.landscape.field("slope").is_ok())
    });
    window.settle();
    window.drawn();
    (folder, window)
}

impl Window {
    pub(crate) fn choose(&mut self, list: &str, word: &str) {
        self.harness.get_by_role_and_label(Role::ComboBox, list).click();
        self.harness.step();
        self.harness.step();
        self.click_last(word);
    }

    /// What the viewport shows, without what lies over its left third.
    pub(crate) fn seen(&mut self) -> Pixels {
        self.hover([0.98, 0.98]);
        self.drawn();
        let rect = self.harness.get_by_label("Viewport").rect();
        let from = rect.min + eframe::egui::vec2(0.35 * rect.width(), 0.1 * rect.height());
        self.pixels(Rect::from_min_max(from, rect.max))
    }

    pub(crate) fn has(&self, text: &str) -> bool {
        self.harness.query_all_by_label_contains(text).next().is_some()
    }

    /// The whole label that has this in it.
    pub(crate) fn label_with(&self, text: &str) -> String {
        let node = self.harness.query_all_by_label_contains(text).next();
        // What is only read has its text as a value.
        let text_of = |node: &egui_kittest::Node<'_>| node.accesskit_node().label().or_else(|| node.value());
        node.and_then(|node| text_of(&node)).unwrap_or_else(|| panic!("no label with {text}"))
    }
}

#[test]
fn a_layer_is_draped_with_its_legend_and_let_go_again() {
    let (_folder, mut window) = opened();
    let bare = window.seen();
    window.choose("Layer", "slope");
    let draped = window.seen();
    window.picture("draped");
    assert!(bare.share_that_differs(&draped) > 0.2, "{}", bare.share_that_differs(&draped));
    window.hover([0.5, 0.43]);
    window.harness.step();
    assert!(window.has(", slope "), "its value stands under the pointer: {}", window.label_with("m east"));
    window.choose("Colours", "ember");
    let other = window.seen();
    assert!(draped.share_that_differs(&other) > 0.2);
    window.click("Colour the ground by it");
    assert_eq!(bare.share_that_differs(&window.seen()), 0.0, "the ground is as it was");
}

/// Metres east and south under the pointer, as the foot of the window says.
pub(crate) fn told(window: &mut Window, share: [f32; 2]) -> [f64; 2] {
    window.hover(share);
    window.harness.step();
    let said = window.label_with("m east");
    let number = |text: &str| text.trim().parse().expect("a number");
    let (east, rest) = said.split_once(" m east, ").expect("east");
    [number(east), number(rest.split_once(" m south").expect("south").0)]
}

#[test]
fn a_section_has_the_distance_between_its_ends() {
    let (_folder, mut window) = opened();
    let [from, to] = [[0.3, 0.46], [0.7, 0.42]].map(|share| (share, told(&mut window, share)));
    window.harness.key_press(Key::C);
    window.harness.step();
    window.stroke(from.0, to.0);
    window.harness.step();
    window.picture("section");
    let said = window.label_with("Distance");
    let distance: f64 = said.split(' ').nth(1).expect("a number").parse().expect("a number");
    let wanted = (to.1[0] - from.1[0]).hypot(to.1[1] - from.1[1]);
    // The foot of the window says whole metres.
    assert!((distance - wanted).abs() < 3.0, "{distance} for {wanted}");
    assert!(window.has("rise") && window.has("steepest"));
    assert!(window.status().moments.is_empty(), "nothing was painted");
}

#[test]
fn a_camera_that_was_kept_is_come_back_to_and_saved_with_the_project() {
    let (folder, mut window) = opened();
    window.click("From above");
    let above = window.seen();
    window.type_over("Camera", "plan");
    window.click("Keep camera");
    window.click("Show all");
    assert!(above.share_that_differs(&window.seen()) > 0.2);
    window.click("plan");
    assert_eq!(above.share_that_differs(&window.seen()), 0.0, "the camera is where it was");
    let project = folder.path().join("project");
    window.click("Save");
    window.type_over("Path", &project.display().to_string());
    window.click_last("Save");
    window.until("the file", |status| status.saved.is_some());
    drop(window);
    let text = fs::read_to_string(project.join("cameras.toml")).expect("written");
    assert!(text.contains("name = \"plan\""), "{text}");
    let mut again = Window::open(Some(&project));
    again.settle();
    again.drawn();
    again.click("plan");
    assert_eq!(above.share_that_differs(&again.seen()), 0.0, "and in another window");
}

#[test]
fn two_moments_stand_beside_each_other() {
    let (_folder, mut window) = opened();
    let before = window.seen();
    window.click("Compare");
    window.until_pinned();
    window.harness.get_by_role_and_label(Role::Slider, "Exposure").set_value_accesskit(2.0);
    window.harness.step();
    let after = window.seen();
    window.picture("compared");
    let middle = before.width * 15 / 65;
    let differs =
        |part: std::ops::Range<usize>| before.columns(part.clone()).share_that_differs(&after.columns(part));
    // What follows a simulation has its ground from another buffer: an edge or two differ.
    assert!(differs(0..middle - 8) < 1e-3, "what is pinned stays");
    assert!(differs(middle + 8..before.width) > 0.3, "what is beside it follows");
    window.click("Compare");
    assert!(before.share_that_differs(&window.seen()) > 0.6, "the bar is gone");
}

#[test]
fn any_command_is_found_in_the_palette_and_the_tour_has_an_end() {
    let (_folder, mut window) = opened();
    let whole = window.seen();
    window.harness.key_press_modifiers(Modifiers::COMMAND, Key::K);
    window.harness.step();
    window.type_over("Find", "from above");
    window.picture("palette");
    window.harness.key_press(Key::Enter);
    window.harness.step();
    assert!(whole.share_that_differs(&window.seen()) > 0.2, "it looks straight down");
    window.harness.key_press(Key::F1);
    window.harness.step();
    window.harness.step();
    assert!(window.has("Tour, 1 of"));
    let pages: usize =
        window.label_with("Tour, 1 of").rsplit(' ').next().expect("a number").parse().expect("a number");
    for _ in 0..pages {
        window.click("Next");
    }
    assert!(!window.has("Tour, "), "it has ended");
}

#[test]
fn what_is_wrong_in_the_text_is_told_with_its_line_and_a_missing_file_by_its_name() {
    let (folder, mut window) = opened();
    window.click("Cards or text");
    let text = fs::read_to_string(folder.path().join("valley.toml")).expect("a recipe");
    let wrong = text.replace("relief = 300.0", "releif = 300.0");
    window.type_in((Role::MultilineTextInput, "Recipe as text"), &wrong);
    assert!(window.has("line 8:") || window.has("line 9:"), "{}", window.label_with("line"));
    window.picture("wrong");
    window.harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    window.harness.step();
    window.harness.step();
    window.type_over("Path", "nowhere.toml");
    window.click_last("Open");
    assert!(window.has("nowhere.toml"), "the message names the file");
}

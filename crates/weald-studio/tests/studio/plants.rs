//! The hand of the brush for how densely plants stand.

use std::fs;

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;

use super::harness::Window;
use super::panels::recipe;

#[test]
fn plants_are_taken_away_and_set_by_the_brush_and_the_simulation_is_not_run_again() {
    let (_folder, file) = recipe();
    let text = fs::read_to_string(&file).expect("a recipe");
    let ferns = "[[step]]\ndo = \"scatter\"\nspacing = 20.0\n\n[[output]]";
    fs::write(&file, text.replacen("[[output]]", ferns, 1)).expect("written");
    let mut window = Window::open(Some(&file));
    let grown = |window: &mut Window, revision: u64| {
        let status = window.until("plants", |status| {
            status.shown.as_ref().is_some_and(|shown| {
                shown.revision == revision && shown.steps == usize::MAX && shown.changes == status.changes
            })
        });
        let plants = status.shown.expect("shown").landscape;
        plants.plants("plants").expect("there").plants.len()
    };
    grown(&mut window, 1);
    window.click("One step");
    window.until("a step", |status| status.steps == 1);
    let all = grown(&mut window, 1);
    window.type_over("Name", "before");
    window.reach("Keep");
    window.until("the name", |status| status.names.len() == 1);
    window.drawn();
    window.reach("Clear");
    assert!(window.harness.query_by_role_and_label(Role::ComboBox, "Plants").is_some());
    let slider = window.harness.get_by_role_and_label(Role::Slider, "Radius");
    slider.set_value_accesskit(200.0);
    window.harness.run_steps(3);
    window.stroke([0.4, 0.5], [0.6, 0.5]);
    let fewer = grown(&mut window, 2);
    assert!(fewer + 50 < all, "{fewer} of {all}");
    assert!(window.harness.state().text().contains("do = \"paint-layer\""));
    assert_eq!(window.status().steps, 1, "what was simulated stays");
    assert_eq!(window.status().moments.len(), 1);
    assert_eq!(window.status().names.len(), 1, "it goes on, and does not begin anew");
    window.picture("cleared");
    window.click("Plant");
    window.stroke([0.4, 0.5], [0.6, 0.5]);
    let again = grown(&mut window, 3);
    assert!(again > fewer && again <= all, "{again} of {all}");
    window.click("Undo");
    window.click("Undo");
    assert_eq!(grown(&mut window, 5), all);
    assert!(!window.harness.state().text().contains("do = \"paint-layer\""));
    assert_eq!(window.status().steps, 1);
}

//! Controls, all of them made from the declarations of the catalogue.

use std::collections::BTreeSet;

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use weald::recipe::catalog::CATALOG;
use weald::recipe::parameter::{Kind, Parameter};
use weald::recipe::source::{self, Table, Value};
use weald_studio::controls_for_a_test as controls;

/// Keys of a step that stand in its controls: those that have an effect as it is by default, without the script, which the
/// window keeps.
fn expected(parameters: &[Parameter], table: &Table, keys: &mut BTreeSet<&'static str>) {
    let all: Vec<_> = parameters.iter().collect();
    for parameter in parameters.iter().filter(|parameter| !["do", "edits"].contains(&parameter.name)) {
        if !parameter.needs.iter().all(|needs| needs.is_met(table, &all)) {
            continue;
        }
        keys.insert(parameter.name);
        if let Kind::Variants(variants) = &parameter.kind {
            let word = parameter.default.as_deref().unwrap_or_default().trim_matches('"');
            let chosen = variants.iter().find(|variant| variant.word == word);
            expected(chosen.map_or(&[][..], |variant| &variant.parameters), table, keys);
        }
    }
}

#[test]
fn every_key_of_every_step_has_a_control_by_its_name() {
    let mut count = 0;
    for entry in CATALOG {
        let table = Table::default();
        let mut keys = BTreeSet::new();
        expected(&(entry.parameters)(), &table, &mut keys);
        let mut harness = egui_kittest::Harness::builder().with_size([500.0, 4000.0]).build_ui(move |ui| {
            controls(ui, &Table::default(), &(entry.parameters)());
        });
        harness.step();
        let folds = harness.query_all_by_label_contains("More keys").count();
        for fold in 0..folds {
            harness.query_all_by_label_contains("More keys").nth(fold).expect("a fold").click();
            harness.run_ok();
        }
        for key in &keys {
            assert!(harness.query_all_by_label(key).next().is_some(), "{}: {key} has no control", entry.name);
        }
        count += keys.len();
    }
    assert!(count > 200, "{count} keys");
}

#[test]
fn what_a_control_gives_is_what_the_recipe_reads() {
    let table = source::parse("", "relief = 200.0").expect("a table");
    let step = CATALOG.iter().find(|entry| entry.name == "diamond-square").expect("there");
    let mut harness = egui_kittest::Harness::builder().with_size([500.0, 600.0]).build_ui_state(
        move |ui, given: &mut Option<(String, Option<String>)>| {
            if let Some(turned) = controls(ui, &table, &(step.parameters)()) {
                *given = Some(turned);
            }
        },
        None,
    );
    harness.step();
    harness.get_by_role_and_label(Role::SpinButton, "relief").set_value_accesskit(350.0);
    harness.run_ok();
    let (key, value) = harness.state().clone().expect("it was turned");
    assert_eq!(key, "relief");
    let text = format!("relief = {}", value.expect("a value"));
    let read = source::parse("", &text).expect("TOML");
    assert_eq!(read.get("relief").map(|node| node.value.clone()), Some(Value::Number(350.0)));
}

//! What a step makes gets another name in its card.

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;

use super::harness::Window;
use super::looking::opened;

fn has_layer(window: &mut Window, layer: &'static str) {
    window.until(layer, |status| {
        status.shown.as_ref().is_some_and(|shown| shown.landscape.field(layer).is_ok())
    });
}

#[test]
fn a_result_is_renamed_in_its_card_and_all_that_speaks_of_it_follows() {
    let (_folder, mut window) = opened();
    window.click("Cards or text");
    let text = window.harness.state().text().to_owned();
    let more =
        "[[step]]\ndo = \"select\"\nwhere = [{ layer = \"slope\", above = 20.0 }] # steep\n\n[[output]]";
    let longer = text.replacen("[[output]]", more, 1);
    window.type_in((Role::MultilineTextInput, "Recipe as text"), &longer);
    has_layer(&mut window, "mask");
    window.click("Cards or text");
    window.reach("3. slope");
    window.harness.run_steps(20);
    window.reach("Rename");
    window.type_over("New name", "two words");
    window.reach("Give this name");
    assert!(window.has("is no name"), "{:?}", window.harness.state().message());
    assert_eq!(window.harness.state().text(), longer);
    window.type_over("New name", "steepness");
    window.reach("Give this name");
    assert!(window.harness.query_by_role_and_label(Role::TextInput, "New name").is_none(), "it is done");
    let expected = longer
        .replace("do = \"slope\"\n", "do = \"slope\"\ninto = \"steepness\"\n")
        .replace("layer = \"slope\"", "layer = \"steepness\"");
    assert_eq!(window.harness.state().text(), expected);
    has_layer(&mut window, "steepness");
    window.click("Undo");
    assert_eq!(window.harness.state().text(), longer, "it was one change");
}

//! Landscapes of several seeds beside each other.

use std::fs;

use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;

use super::looking::opened;

#[test]
fn many_seeds_are_made_beside_each_other_and_one_is_taken() {
    let (folder, mut window) = opened();
    let before = window.harness.state().text().to_owned();
    let pictures = folder.path().join("seeds");
    window.click("Many seeds");
    window.type_over("Pictures into", &pictures.display().to_string());
    window.harness.get_by_role_and_label(Role::SpinButton, "First seed").set_value_accesskit(5.0);
    window.harness.get_by_role_and_label(Role::SpinButton, "Seeds").set_value_accesskit(3.0);
    window.harness.run_steps(2);
    window.click("Make them");
    let status = window.until("three seeds", |status| {
        status.seeds.as_ref().is_some_and(|seeds| seeds.sheet.is_some() && !seeds.runs)
    });
    let seeds = status.seeds.expect("made");
    assert_eq!(seeds.done.iter().map(|(seed, _)| *seed).collect::<Vec<_>>(), [5, 6, 7]);
    let files: Vec<_> =
        seeds.done.iter().map(|(_, file)| fs::read(file.as_ref().expect("drawn")).expect("there")).collect();
    assert!(files[0] != files[1] && files[1] != files[2], "each its own");
    assert!(fs::metadata(pictures.join("contact-sheet.png")).expect("a sheet").len() > 1000);
    window.harness.run_steps(3);
    window.picture("seeds");
    window.click("picture of seed 6");
    assert!(window.harness.query_by_label("Make them").is_none(), "the sheet is gone");
    assert_eq!(window.harness.state().text(), before.replace("seed = 3", "seed = 6"));
    window.until("the landscape of that seed", |status| {
        status.shown.as_ref().is_some_and(|shown| shown.revision == 2)
    });
    window.click("Undo");
    assert_eq!(window.harness.state().text(), before);
}

#[test]
fn the_seeds_are_stopped_before_all_are_there() {
    let (folder, mut window) = opened();
    window.click("Many seeds");
    window.type_over("Pictures into", &folder.path().join("seeds").display().to_string());
    window.harness.get_by_role_and_label(Role::SpinButton, "Seeds").set_value_accesskit(60.0);
    window.harness.run_steps(2);
    window.click("Make them");
    window.until("some", |status| status.seeds.as_ref().is_some_and(|seeds| !seeds.done.is_empty()));
    window.click("Stop");
    let status = window.until("the end", |status| status.seeds.as_ref().is_some_and(|seeds| !seeds.runs));
    let seeds = status.seeds.expect("some");
    assert!(seeds.done.len() < 60 && seeds.sheet.is_none(), "{}", seeds.done.len());
}

use super::*;

const TEXT: &str = "# a valley\n[landscape]\nsize = 64 # cells\ncell = 20.0\n\n\
    # ground\n[[step]]\ndo = \"diamond-square\"\nrelief = 200.0 # metres\n\n\
    # carve\n[[step]]\ndo = \"thermal\"\n\n[[output]]\nlayer = \"height\"\nfile = \"height.tif\"\n";

#[test]
fn a_control_changes_one_line_and_leaves_comments_and_order() {
    let mut document = Document::new("valley.toml", TEXT);
    document.set_step_key(0, "relief", Some("300.0")).expect("there");
    assert_eq!(document.text(), TEXT.replace("200.0", "300.0"));
    document.set_landscape_key("seed", Some("5")).expect("there");
    assert!(document.text().contains("seed = 5"));
    assert!(document.diagnostics().is_empty(), "{:?}", document.diagnostics());
    assert!(document.undo() && document.undo() && !document.undo());
    assert_eq!(document.text(), TEXT);
    assert!(document.redo());
    assert_eq!(document.changes().collect::<Vec<_>>(), ["step 1: relief = 300.0"]);
}

#[test]
fn steps_move_with_their_comments_and_come_before_the_outputs() {
    let mut document = Document::new("valley.toml", TEXT);
    document.duplicate_step(1).expect("there");
    document.add_step("slope", 9).expect("at the end");
    let words = |document: &Document| {
        document.steps().iter().map(|step| Document::word(step).to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(words(&document), ["diamond-square", "thermal", "thermal", "slope"]);
    assert!(document.text().ends_with("file = \"height.tif\"\n"), "{}", document.text());
    document.move_step(3, 1).expect("there");
    document.remove_step(3).expect("there");
    assert_eq!(words(&document), ["diamond-square", "slope", "thermal"]);
    assert!(document.text().contains("# carve\n[[step]]\ndo = \"thermal\""), "{}", document.text());
    assert!(document.diagnostics().is_empty(), "{:?}\n{}", document.diagnostics(), document.text());
    assert!(document.remove_step(7).is_err());
}

#[test]
fn what_is_wrong_is_told_with_its_line_and_the_cards_stay() {
    let mut document = Document::new("valley.toml", TEXT);
    document.type_text(&TEXT.replace("relief", "releif"));
    assert_eq!(document.diagnostics()[0].line, 9);
    document.type_text("[landscape\n");
    assert_eq!(document.diagnostics()[0].line, 1);
    assert_eq!(document.steps().len(), 2, "as they were last understood");
    assert!(document.set_step_key(0, "relief", Some("1.0")).is_err(), "the text is no TOML");
    document.type_text(TEXT);
    assert!(document.set_step_key(0, "relief", Some("no toml")).is_err());
    assert!(document.undo(), "all that was typed is one change");
    assert_eq!(document.text(), TEXT);
}

#[test]
fn a_key_within_a_table_is_set_and_taken_out_with_its_table() {
    let mut document = Document::new("valley.toml", TEXT);
    document.set_step_key(1, "a.b", Some("2.0")).expect("a table within");
    assert!(document.text().contains("a = { b = 2.0 }"), "{}", document.text());
    document.set_step_key(1, "a.b", None).expect("there");
    assert_eq!(document.text(), TEXT);
}

//! What is renamed is renamed everywhere, or nowhere.

use super::*;

const TEXT: &str = "[landscape]\nsize = 32\ncell = 20.0\n\n[[step]]\ndo = \"diamond-square\"\n\n[[step]]\ndo = \"slope\"\n\n\
    [[step]]\ndo = \"fbm\"\ninto = \"noise\" # bumps\n\n[[step]]\ndo = \"add\"\nwith = \"noise\"\n\n\
    [[step]]\ndo = \"select\"\nwhere = [{ layer = \"slope\", above = 20.0 }, { layer = \"noise\", below = 0.5 }] # steep\n\n\
    [[step]]\ndo = \"slope\"\n\n[[output]]\nlayer = \"noise\"\nfile = \"noise.tif\"\n\n\
    [[output]]\nlayer = \"slope\"\nfile = \"slope.tif\"\n\n[[output]]\nlayer = \"mask\"\nfile = \"mask.tif\"\n";

fn document() -> Document {
    let document = Document::new("valley.toml", TEXT);
    assert!(document.diagnostics().is_empty(), "{:?}", document.diagnostics());
    document
}

#[test]
fn all_that_speaks_of_a_result_follows_and_it_is_one_change() {
    let mut document = document();
    assert_eq!(document.result_of(2).as_deref(), Some("noise"));
    document.rename_result(2, "bumps").expect("renamed");
    assert_eq!(document.text(), TEXT.replace("\"noise\"", "\"bumps\""), "comments and all else stay");
    assert!(document.diagnostics().is_empty());
    assert!(document.undo() && !document.undo());
    assert_eq!(document.text(), TEXT);
}

#[test]
fn what_another_step_makes_anew_under_the_old_name_keeps_it() {
    let mut document = document();
    document.rename_result(1, "early").expect("renamed");
    let text = document.text();
    assert!(text.contains("do = \"slope\"\ninto = \"early\""), "{text}");
    assert!(text.contains("where = [{ layer = \"early\", above = 20.0 }"), "{text}");
    assert!(text.contains("[[output]]\nlayer = \"slope\""), "the file shows the last one: {text}");
}

#[test]
fn keys_that_name_it_by_their_defaults_say_it_then() {
    let mut document = document();
    document.rename_result(0, "land").expect("renamed");
    let text = document.text();
    assert!(text.contains("do = \"diamond-square\"\ninto = \"land\""), "{text}");
    assert_eq!(text.matches("of = \"land\"").count(), 2, "both slopes: {text}");
    assert!(text.contains("with = \"noise\"\nlayer = \"land\""), "{text}");
}

#[test]
fn a_name_that_is_none_or_is_taken_is_refused_with_a_sentence() {
    let mut document = document();
    for (name, said) in [("slope", "has already"), ("two words", "is no name"), ("", "is no name")] {
        let refused = document.rename_result(2, name).expect_err(name);
        assert!(refused.contains(said), "{refused}");
    }
    assert!(document.rename_result(3, "sum").expect_err("it adds in place").contains("makes nothing"));
    assert_eq!(document.text(), TEXT);
    let pond = TEXT
        .replace("\"noise\"", "\"water\"")
        .replace("do = \"slope\"\n\n[[output]]", "do = \"scatter\"\n\n[[output]]");
    document.type_text(&pond);
    let refused = document.rename_result(2, "pond").expect_err("plants look at `water` whatever is said");
    assert!(refused.contains("step 6 (scatter) knows it by its present name alone"), "{refused}");
    assert_eq!(document.text(), pond);
}

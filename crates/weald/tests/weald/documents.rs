//! The documents name all that a recipe can name, and nothing that is not there.

use std::collections::BTreeSet;
use std::path::Path;

use weald::export::EXPORTS;
use weald::io::FORMATS;
use weald::picture::PICTURES;
use weald::recipe::catalog::CATALOG;
use weald::recipe::template::TEMPLATES;

type Names = BTreeSet<String>;

/// What stands in a document of `docs` under some of its headings.
fn text_under(document: &str, headings: &[&str]) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(document);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let sections: Vec<&str> = text.split("\n## ").collect();
    let under = |heading: &&str| {
        let found = sections.iter().find(|section| section.lines().next() == Some(*heading));
        *found.unwrap_or_else(|| panic!("{document} has no heading {heading:?}"))
    };
    headings.iter().map(under).collect::<Vec<_>>().join("\n")
}

/// The rows of the tables in a text, each with its cells.
fn rows(text: &str) -> Vec<Vec<&str>> {
    text.lines().filter_map(|line| line.strip_prefix("| ")).map(|row| row.split(" | ").collect()).collect()
}

/// What stands between backticks.
fn quoted(cell: &str) -> Names {
    cell.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// The names in the first column of the tables of a text.
fn first_column(text: &str) -> Names {
    rows(text).iter().flat_map(|cells| quoted(cells[0])).collect()
}

fn with_dots(extensions: &[&str]) -> Names {
    extensions.iter().map(|extension| format!(".{extension}")).collect()
}

#[track_caller]
fn assert_same(documented: &Names, existing: &Names) {
    let missing: Vec<_> = existing.difference(documented).collect();
    let unknown: Vec<_> = documented.difference(existing).collect();
    assert!(!existing.is_empty(), "there is something to name");
    assert!(missing.is_empty(), "in no table of the documents: {missing:?}");
    assert!(unknown.is_empty(), "in the documents, and nowhere else: {unknown:?}");
}

#[test]
fn the_documents_name_every_step() {
    let headings = ["Load and generate", "Combine", "Erode", "Analyse", "Grow"];
    let existing: Names = CATALOG.iter().map(|entry| entry.name.to_owned()).collect();
    assert_same(&first_column(&text_under("steps.md", &headings)), &existing);
}

#[test]
fn the_documents_name_every_picture() {
    let existing: Names = PICTURES.iter().map(|entry| entry.name.to_owned()).collect();
    assert_same(&first_column(&text_under("steps.md", &["Pictures"])), &existing);
}

#[test]
fn the_documents_name_every_export_with_its_extensions() {
    let text = text_under("steps.md", &["Exports"]);
    let existing: Names = EXPORTS.iter().map(|entry| entry.name.to_owned()).collect();
    assert_same(&first_column(&text), &existing);
    for entry in EXPORTS {
        let row = rows(&text).into_iter().find(|cells| quoted(cells[0]).contains(entry.name));
        assert_eq!(quoted(row.expect("found above")[1]), with_dots(entry.extensions), "{}", entry.name);
    }
}

#[test]
fn the_documents_name_every_raster_format_by_its_extensions() {
    let existing: Names = FORMATS.iter().flat_map(|format| with_dots(format.extensions)).collect();
    assert_same(&first_column(&text_under("formats.md", &["# Formats"])), &existing);
}

#[test]
fn the_documents_name_every_template() {
    let existing: Names = TEMPLATES.iter().map(|template| template.name.to_owned()).collect();
    assert_same(&first_column(&text_under("commands.md", &["Templates"])), &existing);
}

#[test]
fn a_name_that_is_missing_or_unknown_is_found() {
    let text = "| step | what |\n|---|---|\n| `a` `b` | text with `c` |\n";
    assert_eq!(
        first_column(text),
        Names::from(["a", "b"].map(str::to_owned)),
        "other columns and heads do not count"
    );
    for existing in [&["a"][..], &["a", "b", "d"]] {
        let existing: Names = existing.iter().map(|name| (*name).to_owned()).collect();
        let result = std::panic::catch_unwind(|| assert_same(&first_column(text), &existing));
        assert!(result.is_err(), "{existing:?}");
    }
}

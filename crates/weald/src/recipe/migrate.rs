//! A recipe of an earlier version in the words of today, with its comments, order and layout.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::format::{self, KEY, NEWEST};
use super::parameter::Diagnostics;
use super::renamed::{RENAMED, Renamed, What};
use super::source::{self, Lines};
use weald_core::error::{Diagnostic, RecipeError};

/// A recipe as it was rewritten.
#[derive(Clone, Debug, PartialEq)]
pub struct Migrated {
    /// Its text.
    pub text: String,
    /// What was changed, with the lines of the text as it was.
    pub changes: Vec<Diagnostic>,
}

/// A stretch of the text and what comes in its place.
struct Edit {
    range: Range<usize>,
    text: String,
    change: String,
}

/// Rewrites the text of a recipe: keys and words that have other names now get them, and the recipe says its format. A
/// text that needs neither stays as it is. Whether the recipe can run is not looked at.
///
/// # Errors
/// [`RecipeError`] for a text that is no TOML, that is of a newer format, or that has a key by its old name and its new.
pub fn migrate(file: &str, text: &str) -> Result<Migrated, RecipeError> {
    migrate_by(RENAMED, file, text)
}

fn migrate_by(names: &[Renamed], file: &str, text: &str) -> Result<Migrated, RecipeError> {
    let mut diagnostics = Diagnostics::default();
    format::check(&source::parse(file, text)?, &mut diagnostics);
    let lines = Lines::of(text);
    let parsed = DeTable::parse(text).map_err(|error| RecipeError {
        file: file.to_owned(),
        diagnostics: vec![Diagnostic { line: 1, message: error.message().to_owned() }],
    })?;
    let mut edits = Vec::new();
    for renamed in names {
        for table in tables(parsed.get_ref(), renamed.section) {
            match edit(renamed, table) {
                Ok(edit) => edits.extend(edit),
                Err((at, message)) => diagnostics.add(lines.line(at), message),
            }
        }
    }
    if !diagnostics.found.is_empty() {
        return Err(RecipeError { file: file.to_owned(), diagnostics: diagnostics.found });
    }
    if parsed.get_ref().get(KEY).is_none() {
        edits.push(format_of_today(text));
    }
    edits.sort_by_key(|edit| edit.range.start);
    Ok(done(text, &edits, &lines))
}

fn done(text: &str, edits: &[Edit], lines: &Lines) -> Migrated {
    let mut new = text.to_owned();
    for edit in edits.iter().rev() {
        new.replace_range(edit.range.clone(), &edit.text);
    }
    let change =
        |edit: &Edit| Diagnostic { line: lines.line(edit.range.start), message: edit.change.clone() };
    Migrated { text: new, changes: edits.iter().map(change).collect() }
}

/// The tables of a section, whether it is one, `[[section]]`s, or a list.
fn tables<'a>(recipe: &'a DeTable<'a>, section: &str) -> Vec<&'a DeTable<'a>> {
    let as_table = |value: &'a Spanned<DeValue<'a>>| match value.get_ref() {
        DeValue::Table(table) => Some(table),
        _ => None,
    };
    match recipe.get(section).map(Spanned::get_ref) {
        Some(DeValue::Table(table)) => vec![table],
        Some(DeValue::Array(items)) => items.iter().filter_map(as_table).collect(),
        _ => Vec::new(),
    }
}

/// What has to change in a table; an error is of a byte.
fn edit(renamed: &Renamed, table: &DeTable<'_>) -> Result<Option<Edit>, (usize, String)> {
    let text_of = |key: &str| match table.get(key).map(Spanned::get_ref) {
        Some(DeValue::String(text)) => Some(&**text),
        _ => None,
    };
    if renamed.kind.is_some_and(|(key, word)| text_of(key) != Some(word)) {
        return Ok(None);
    }
    let Some((key, value)) = table.get_key_value(renamed.key()) else { return Ok(None) };
    let change = renamed.sentence();
    match renamed.what {
        What::Key { old, new } if table.get(new).is_some() => Err((
            key.span().start,
            format!("`{old}` is now called `{new}`, which is there too; remove one of them"),
        )),
        What::Key { new, .. } => Ok(Some(Edit { range: key.span(), text: new.to_owned(), change })),
        What::Word { key, old, new } => Ok((text_of(key) == Some(old)).then(|| Edit {
            range: value.span(),
            text: format!("{new:?}"),
            change,
        })),
    }
}

/// The format goes above everything but the comment at the head of the file, which a blank line ends.
fn format_of_today(text: &str) -> Edit {
    let end = if text.contains("\r\n") { "\r\n" } else { "\n" };
    let start = if text.starts_with('\u{feff}') { '\u{feff}'.len_utf8() } else { 0 };
    let (mut at, mut place) = (start, start);
    for line in text[start..].split_inclusive('\n') {
        at += line.len();
        match line.trim() {
            "" => place = at,
            comment if comment.starts_with('#') => {}
            _ => break,
        }
    }
    let before = if text[..place].ends_with('\n') || place == start { "" } else { end };
    let text = format!("{before}{KEY} = {NEWEST}{end}{end}");
    Edit { range: place..place, text, change: format!("the recipe says its format, `{KEY} = {NEWEST}`") }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: &[Renamed] = &[
        Renamed { section: "landscape", kind: None, what: What::Key { old: "sides", new: "size" } },
        Renamed {
            section: "step",
            kind: Some(("do", "lakes")),
            what: What::Key { old: "film", new: "shallowest" },
        },
        Renamed { section: "step", kind: None, what: What::Word { key: "do", old: "pools", new: "lakes" } },
    ];

    fn changed(text: &str) -> String {
        migrate_by(NAMES, "r", text).expect("it can be rewritten").text
    }

    #[test]
    fn names_change_and_all_else_stays_to_the_byte() {
        let old = "# A valley.\n# Of lakes.\n\n# where\n[landscape]  # here\n\"sides\"  =  64 # cells\n\n\n[[step]]\n\
                   film = 0.5\ndo='lakes'\n[[step]]\ndo = \"other\"\nfilm = 1\n[[step]]\n  do = 'pools' # deep\n";
        let new = "# A valley.\n# Of lakes.\n\nweald = 1\n\n# where\n[landscape]  # here\nsize  =  64 # cells\n\n\n[[step]]\n\
                   shallowest = 0.5\ndo='lakes'\n[[step]]\ndo = \"other\"\nfilm = 1\n[[step]]\n  do = \"lakes\" # deep\n";
        let migrated = migrate_by(NAMES, "r", old).expect("it can be rewritten");
        assert_eq!(migrated.text, new);
        let lines: Vec<_> = migrated.changes.iter().map(|change| change.line).collect();
        assert_eq!(lines, [4, 6, 10, 16]);
        assert_eq!(migrated.changes[2].message, "`film` is now called `shallowest`");
    }

    #[test]
    fn what_was_rewritten_stays_as_it_is() {
        let once = changed("step = [{ do = \"lakes\", film = 1 }]\r\n");
        assert_eq!(once, "weald = 1\r\n\r\nstep = [{ do = \"lakes\", shallowest = 1 }]\r\n");
        let again = migrate_by(NAMES, "r", &once).expect("it can be rewritten");
        assert_eq!((again.text.as_str(), again.changes.len()), (once.as_str(), 0));
    }

    #[test]
    fn the_format_stands_above_all_tables_and_below_the_head() {
        for (old, new) in [
            ("", "weald = 1\n\n"),
            ("# mine", "weald = 1\n\n# mine"),
            ("# mine\n[landscape]\n", "weald = 1\n\n# mine\n[landscape]\n"),
            ("# mine\n\n[landscape]\n", "# mine\n\nweald = 1\n\n[landscape]\n"),
            ("\u{feff}[landscape]\n", "\u{feff}weald = 1\n\n[landscape]\n"),
        ] {
            assert_eq!(changed(old), new);
        }
    }

    #[test]
    fn what_cannot_be_rewritten_is_told_with_its_line() {
        let told = |text: &str| migrate_by(NAMES, "r.toml", text).expect_err("a fault").to_string();
        assert!(
            told("[landscape]\nsize = 2\nsides = 4\n")
                .starts_with("r.toml:3: `sides` is now called `size`, which")
        );
        assert!(told("weald = 2\n").starts_with("r.toml:1: `weald` is 2, a newer format"));
        assert!(told("a = 1\nb = = 2\n").starts_with("r.toml:2: "));
    }
}

//! The format in which a recipe is written, and the keys that have other names than they had.

use super::parameter::Diagnostics;
use super::renamed::{RENAMED, Renamed};
use super::source::{Node, Table, Value};

/// Key at the top of a recipe that says its format. It has the program's name, so that a recipe is known as one by
/// itself, and no step or output has a key of that name.
pub const KEY: &str = "weald";

/// The format that is written, and the newest that is read. A recipe that says none is read as of this one.
///
/// It grows when a key that stays legal comes to mean something else; a key that is only renamed is known by its old
/// name, and [`migrate`](super::migrate()) renames it.
pub const NEWEST: i64 = 1;

/// Complains of a format that is not known.
pub(super) fn check(recipe: &Table, diagnostics: &mut Diagnostics) {
    let Some(Node { line, value }) = recipe.get(KEY) else { return };
    match value {
        Value::Integer(1..=NEWEST) => {}
        Value::Integer(newer) if *newer > NEWEST => diagnostics.add(
            *line,
            format!("`{KEY}` is {newer}, a newer format than {NEWEST}, the newest that this version knows; get a newer version"),
        ),
        other => {
            diagnostics.add(*line, format!("`{KEY}` is {}, but must be the format of the recipe, {NEWEST}", other.shown()));
        }
    }
}

/// The recipe with the names of today; each old one is a complaint.
pub(super) fn with_new_names(recipe: &Table, diagnostics: &mut Diagnostics) -> Table {
    with_names_of(RENAMED, recipe, diagnostics)
}

fn with_names_of(names: &[Renamed], recipe: &Table, diagnostics: &mut Diagnostics) -> Table {
    let mut recipe = recipe.clone();
    for renamed in names {
        let node = recipe.get_mut(renamed.section).map(|node| &mut node.value);
        let tables: Vec<&mut Table> = match node {
            Some(Value::Table(table)) => vec![table],
            Some(Value::List(items)) => items.iter_mut().filter_map(as_table).collect(),
            _ => Vec::new(),
        };
        for table in tables {
            rename(renamed, table, diagnostics);
        }
    }
    recipe
}

fn as_table(node: &mut Node) -> Option<&mut Table> {
    match &mut node.value {
        Value::Table(table) => Some(table),
        _ => None,
    }
}

fn rename(renamed: &Renamed, table: &mut Table, diagnostics: &mut Diagnostics) {
    let is_kind = |(key, word): (&str, &str)| matches!(table.get(key), Some(Node { value: Value::Text(text), .. }) if text == word);
    if !renamed.kind.is_none_or(is_kind) {
        return;
    }
    let subject = renamed.kind.map_or(renamed.section, |(_, word)| word);
    subject.clone_into(&mut diagnostics.subject);
    let Some((name, node)) = table.entries.iter_mut().find(|(key, _)| key == renamed.key()) else { return };
    match renamed.what {
        super::renamed::What::Key { new, .. } => new.clone_into(name),
        super::renamed::What::Word { old, new, .. } => match &mut node.value {
            Value::Text(text) if text == old => new.clone_into(text),
            _ => return,
        },
    }
    let line = node.line;
    diagnostics.add(
        line,
        format!("{}; `weald migrate` rewrites a recipe with the names of today", renamed.sentence()),
    );
}

#[cfg(test)]
mod tests {
    use super::super::renamed::What;
    use super::*;
    use crate::recipe::testing::{parse as recipe, refusal};
    use weald_core::source::parse;

    const REST: &str = "[landscape]\nsize = 4\n[[step]]\ndo = \"rough\"\n[[output]]\nlayer = \"height\"\nfile = \"a.bits\"\n";

    #[test]
    fn a_recipe_says_its_format_or_is_of_the_newest() {
        let said = recipe(&format!("weald = 1\n{REST}")).expect("known");
        let unsaid = recipe(REST).expect("today's");
        assert_eq!(said.effective(), unsaid.effective());
        assert!(said.effective().starts_with("weald = 1\n[landscape]\n"), "{}", said.effective());
    }

    #[test]
    fn another_format_is_refused_with_what_to_do() {
        let told = |format: &str| refusal(&format!("\nweald = {format}\n{REST}"));
        assert!(told("2").contains(":2: `weald` is 2, a newer format than 1"), "{}", told("2"));
        assert!(told("2").ends_with("get a newer version"), "{}", told("2"));
        for wrong in ["0", "-1", "1.0", "\"1\""] {
            assert!(told(wrong).contains(&format!(":2: `weald` is {wrong}, but must be")), "{}", told(wrong));
        }
    }

    #[test]
    fn an_old_name_is_a_complaint_at_its_line_and_means_what_the_new_one_means() {
        let names = [
            Renamed {
                section: "step",
                kind: Some(("do", "slide")),
                what: What::Key { old: "film", new: "shallowest" },
            },
            Renamed {
                section: "step",
                kind: None,
                what: What::Word { key: "do", old: "slyde", new: "slide" },
            },
            Renamed { section: "landscape", kind: None, what: What::Key { old: "sides", new: "size" } },
        ];
        let text = "[landscape]\nsides = 4\n[[step]]\ndo = \"slide\"\nfilm = 2\n[[step]]\ndo = \"other\"\nfilm = 3\n\
                    [[step]]\ndo = \"slyde\"\n";
        let mut diagnostics = Diagnostics::default();
        let renamed = with_names_of(&names, &parse("r", text).expect("TOML"), &mut diagnostics);
        let told: Vec<_> = diagnostics.found.iter().map(|one| (one.line, one.message.as_str())).collect();
        assert_eq!(told.len(), 3, "{told:?}");
        assert_eq!(told[0].0, 5);
        assert!(
            told[0].1.starts_with("slide: `film` is now called `shallowest`; `weald migrate`"),
            "{told:?}"
        );
        assert!(told[1].0 == 10 && told[1].1.contains("do = \"slyde\" is now called \"slide\""), "{told:?}");
        assert_eq!(told[2].0, 2);
        let today = text.replacen("film", "shallowest", 1).replace("slyde", "slide").replace("sides", "size");
        assert_eq!(renamed, parse("r", &today).expect("TOML"));
    }
}

//! Another name for what a step makes, in the step itself and wherever the recipe goes on to speak of it.

use toml_edit::{DocumentMut, Item, TableLike, Value as EditedValue};
use weald::export::EXPORTS;
use weald::picture::PICTURES;
use weald::recipe::parameter::{Diagnostics, Kind, LayerName, Parameter, ParameterValue, Parameters};
use weald::recipe::source::{Node, Table, Value};
use weald::recipe::{FilmKeys, Output, OutputKeys, Overrides, Recipe, catalog};
use weald::step::Step;

use super::Document;
use super::changes::{NOT_IN_TABLES, no_step, put, step_of};

/// The key that names what a step makes.
const INTO: &str = "into";

/// Names, and those that they become.
type Names = Vec<(String, String)>;

/// A place in a table, from outside inward.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Part {
    Key(String),
    At(usize),
}

/// A value that is to become another, in TOML notation.
#[derive(Debug, PartialEq, Eq)]
struct Reference {
    path: Vec<Part>,
    to: String,
}

/// The tables that speak of what was renamed, with what changes in each.
#[derive(Default)]
struct Changes {
    steps: Vec<(usize, Vec<Reference>)>,
    outputs: Vec<(usize, Vec<Reference>)>,
}

impl Document {
    /// The name of what a step makes, where the recipe can choose it.
    pub fn result_of(&self, at: usize) -> Option<String> {
        into_of(self.steps().get(at)?)
    }

    /// Gives what a step makes another name, and says so in all that speaks of it, as one change.
    ///
    /// # Errors
    /// A sentence for a name that is none or is taken, for what the recipe speaks of without a key, and where the text cannot run
    /// as it is.
    pub fn rename_result(&mut self, at: usize, to: &str) -> Result<(), String> {
        let from =
            self.result_of(at).ok_or_else(|| format!("step {} makes nothing that has a name", at + 1))?;
        if from == to {
            return Ok(());
        }
        let before = Recipe::parse(self.file(), self.text(), &Overrides::default());
        let before =
            before.map_err(|_| "the recipe cannot run as it is; mend that before you rename".to_owned())?;
        check(&before, to)?;
        let (names, changes, end) = self.changes_of(at, to)?;
        let quoted = format!("{to:?}");
        let mut text: DocumentMut = self.text().parse().map_err(|_| NOT_IN_TABLES.to_owned())?;
        put(step_of(&mut text, at)?, INTO, &quoted)?;
        for (step, references) in &changes.steps {
            let table = step_of(&mut text, *step)?;
            references.iter().try_for_each(|one| set_at(table, &one.path, &one.to))?;
        }
        let outputs = text.get_mut("output").and_then(Item::as_array_of_tables_mut);
        if let Some(outputs) = outputs {
            for (output, references) in &changes.outputs {
                let table = outputs.get_mut(*output).ok_or(NOT_IN_TABLES)?;
                references.iter().try_for_each(|one| set_at(table, &one.path, &one.to))?;
            }
        }
        let text = text.to_string();
        let after = Recipe::parse(self.file(), &text, &Overrides::default()).map_err(|error| {
            format!("{from} cannot be called {to}: {}", error.to_string().lines().last().unwrap_or_default())
        })?;
        still_reads((&before, &after), &names, (at, end))?;
        self.take(text, format!("step {}: {from} is called {to}", at + 1));
        Ok(())
    }

    /// What changes in later tables, and the step from which on the old name means something else.
    fn changes_of(&self, at: usize, to: &str) -> Result<(Names, Changes, usize), String> {
        let steps = self.steps();
        let table = *steps.get(at).ok_or_else(|| no_step(at))?;
        let names = renamed(table, to).ok_or_else(|| no_step(at))?;
        let mut changes = Changes::default();
        for (later, table) in steps.iter().enumerate().skip(at + 1) {
            let Some(entry) = catalog::find(Self::word(table)) else { continue };
            let step = (entry.read)(table, &mut Diagnostics::default());
            let is_new = makes_anew(&*step, &names) && !Self::is_off(table);
            let is_named = into_of(table).is_some_and(|into| new_name(&names, &into).is_some());
            if is_new && !is_named {
                return Ok((names, changes, later));
            }
            let found = references(table, &(entry.parameters)(), &names, &[INTO]);
            changes.steps.push((later, found));
            if is_named && !Self::is_off(table) {
                return Ok((names, changes, later));
            }
        }
        for (place, table) in self.outputs().into_iter().enumerate() {
            changes.outputs.push((place, references(table, &parameters_of_output(table), &names, &[])));
        }
        Ok((names, changes, usize::MAX))
    }

    fn outputs(&self) -> Vec<&Table> {
        let Some(Node { value: Value::List(items), .. }) = self.table.get("output") else {
            return Vec::new();
        };
        let tables = items.iter().filter_map(|item| match &item.value {
            Value::Table(table) => Some(table),
            _ => None,
        });
        tables.collect()
    }
}

/// What `into` says, or says by default.
fn into_of(table: &Table) -> Option<String> {
    let parameters = (catalog::find(Document::word(table))?.parameters)();
    let into = parameters.into_iter().find(|parameter| parameter.name == INTO)?;
    match table.get(INTO) {
        Some(Node { value: Value::Text(name), .. }) => Some(name.clone()),
        Some(_) => None,
        None => into.default.map(|name| name.trim_matches('"').to_owned()),
    }
}

/// All that a step makes under other names once `into` is another: species have names that begin with it.
fn renamed(table: &Table, to: &str) -> Option<Names> {
    let entry = catalog::find(Document::word(table))?;
    let names = |table: &Table| {
        let step = (entry.read)(table, &mut Diagnostics::default());
        let written = step.writes().into_iter().map(|(name, _)| name);
        written.chain(step.plants()).chain(step.meadows()).collect::<Vec<_>>()
    };
    let mut other = table.clone();
    other.take(INTO);
    other.entries.push((INTO.to_owned(), Node { line: 0, value: Value::Text(to.to_owned()) }));
    let pairs = names(table).into_iter().zip(names(&other));
    Some(pairs.filter(|(before, after)| before != after).collect())
}

/// Whether a name can be given to something new.
fn check(recipe: &Recipe, to: &str) -> Result<(), String> {
    let node = Node { line: 0, value: Value::Text(to.to_owned()) };
    LayerName::read(&node, (0.0, 0.0), &mut Diagnostics::default())
        .map_err(|_| format!("{to:?} is no name: it needs 1 to 64 letters, digits, `_` and `-`"))?;
    let of_steps = recipe.steps.iter().flat_map(|planned| {
        let written = planned.step.writes().into_iter().map(|(name, _)| name);
        let read = planned.step.reads().into_iter().chain(planned.step.reads_where_there());
        written.chain(read)
    });
    let of_materials = recipe.materials.iter().map(|planned| planned.material.name.clone());
    let of_outputs = recipe.outputs.iter().flat_map(Output::reads);
    if of_steps.chain(of_materials).chain(of_outputs).any(|name| name == to) {
        return Err(format!("{to} is a name that the recipe has already; choose another"));
    }
    Ok(())
}

fn new_name<'a>(names: &'a Names, name: &str) -> Option<&'a String> {
    names.iter().find(|(before, _)| before == name).map(|(_, after)| after)
}

fn all_reads(step: &dyn Step) -> Vec<String> {
    step.reads().into_iter().chain(step.reads_where_there()).collect()
}

/// Whether a step makes something of one of these names without looking at what had it before.
fn makes_anew(step: &dyn Step, names: &Names) -> bool {
    let is_one = |name: &String| new_name(names, name).is_some();
    step.writes().iter().any(|(name, _)| is_one(name)) && !all_reads(step).iter().any(is_one)
}

fn parameters_of_output(table: &Table) -> Vec<Parameter> {
    let word = |key: &str| match table.get(key) {
        Some(Node { value: Value::Text(word), .. }) => word.as_str(),
        _ => "",
    };
    let picture = PICTURES.iter().find(|entry| entry.name == word("picture"));
    let export = EXPORTS.iter().find(|entry| entry.name == word("export"));
    match (picture, export) {
        (Some(picture), _) => (picture.parameters)().into_iter().chain(FilmKeys::parameters()).collect(),
        (_, Some(export)) => (export.parameters)(),
        _ => OutputKeys::parameters(),
    }
}

/// The keys of a table that name something renamed, also by their defaults.
fn references(given: &Table, parameters: &[Parameter], names: &Names, without: &[&str]) -> Vec<Reference> {
    let all: Vec<&Parameter> = parameters.iter().collect();
    let counts = |parameter: &&Parameter| {
        let has_effect = parameter.needs.iter().all(|needs| needs.is_met(given, &all));
        !without.contains(&parameter.name) && (has_effect || given.get(parameter.name).is_some())
    };
    let mut found = Vec::new();
    for parameter in parameters.iter().filter(counts) {
        let inner = within(given, parameter, names).into_iter().map(|mut reference| {
            if !matches!(parameter.kind, Kind::Variants(_)) {
                reference.path.insert(0, Part::Key(parameter.name.to_owned()));
            }
            reference
        });
        found.extend(inner);
    }
    found
}

/// Those of one key, whose paths begin below it.
fn within(given: &Table, parameter: &Parameter, names: &Names) -> Vec<Reference> {
    let value = given.get(parameter.name).map(|node| &node.value);
    match (&parameter.kind, value) {
        (Kind::Layer, _) => {
            let name = match value {
                Some(Value::Text(name)) => Some(name.as_str()),
                Some(_) => None,
                None => parameter.default.as_deref().map(|name| name.trim_matches('"')),
            };
            let to = name.and_then(|name| new_name(names, name));
            to.map(|to| Reference { path: Vec::new(), to: format!("{to:?}") }).into_iter().collect()
        }
        (Kind::Layers, Some(Value::List(items))) => {
            let items = items.iter().enumerate().filter_map(|(at, item)| match &item.value {
                Value::Text(name) => Some((at, new_name(names, name)?)),
                _ => None,
            });
            items.map(|(at, to)| Reference { path: vec![Part::At(at)], to: format!("{to:?}") }).collect()
        }
        (Kind::Table(inner), Some(Value::Table(table))) => references(table, inner, names, &[]),
        (Kind::Tables(inner), Some(Value::List(items))) => {
            let of = |(at, item): (usize, &Node)| match &item.value {
                Value::Table(table) => numbered(at, references(table, inner, names, &[])),
                _ => Vec::new(),
            };
            items.iter().enumerate().flat_map(of).collect()
        }
        (Kind::Variants(variants), _) => {
            let word = match value {
                Some(Value::Text(word)) => word.as_str(),
                _ => parameter.default.as_deref().unwrap_or_default().trim_matches('"'),
            };
            let variant = variants.iter().find(|variant| variant.word == word);
            variant.map_or_else(Vec::new, |variant| references(given, &variant.parameters, names, &[]))
        }
        _ => Vec::new(),
    }
}

fn numbered(at: usize, mut references: Vec<Reference>) -> Vec<Reference> {
    for reference in &mut references {
        reference.path.insert(0, Part::At(at));
    }
    references
}

/// Sets a value that lies deeper in a table; comments stay.
fn set_at(table: &mut dyn TableLike, path: &[Part], to: &str) -> Result<(), String> {
    let missing = || "the text cannot be changed by a control; change the text".to_owned();
    match path {
        [Part::Key(key)] => put(table, key, to),
        [Part::Key(key), Part::At(at), rest @ ..] => match table.get_mut(key) {
            Some(Item::ArrayOfTables(tables)) => set_at(tables.get_mut(*at).ok_or_else(missing)?, rest, to),
            Some(Item::Value(EditedValue::Array(items))) if rest.is_empty() => {
                let item = items.get_mut(*at).ok_or_else(missing)?;
                let decor = item.decor().clone();
                *item = to.parse().map_err(|_| missing())?;
                *item.decor_mut() = decor;
                Ok(())
            }
            Some(Item::Value(EditedValue::Array(items))) => {
                let inner = items.get_mut(*at).and_then(EditedValue::as_inline_table_mut);
                set_at(inner.ok_or_else(missing)?, rest, to)
            }
            _ => Err(missing()),
        },
        [Part::Key(key), rest @ ..] => {
            let inner = table.get_mut(key).and_then(Item::as_table_like_mut);
            set_at(inner.ok_or_else(missing)?, rest, to)
        }
        _ => Err(missing()),
    }
}

/// Complains where something would read other layers than before: what it reads without a key cannot follow.
fn still_reads(
    (before, after): (&Recipe, &Recipe),
    names: &Names,
    (first, end): (usize, usize),
) -> Result<(), String> {
    let follows = |old: Vec<String>, new: Vec<String>| {
        let expected = old.into_iter().map(|name| new_name(names, &name).cloned().unwrap_or(name));
        expected.eq(new)
    };
    let alone = |what: String| Err(format!("{what} knows it by its present name alone, and cannot follow"));
    for (old, new) in before.steps.iter().zip(&after.steps) {
        // What stands before the step, or after another of the same name, must read what it did.
        let is_after = old.place > first && old.place <= end;
        let (was, is) = (all_reads(&*old.step), all_reads(&*new.step));
        if if is_after { !follows(was, is) } else { was != is } {
            return alone(format!("step {} ({})", old.place + 1, old.entry.name));
        }
    }
    for (old, new) in before.outputs.iter().zip(&after.outputs).filter(|_| end == usize::MAX) {
        let of = |output: &Output| [output.reads(), output.plants(), output.meadows()].concat();
        if !follows(of(old), of(new)) {
            return alone(format!("the output {}", old.file.display()));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;

//! Keys of a step that change while it runs.

use crate::edit::Setting;
use weald_core::error::Error;
use weald_core::material::Material;
use weald_core::parameter::{Diagnostics, Kind, Parameter, Parameters, nearest};
use weald_core::source::{Node, Table, Value};
use weald_engine::step::Step;

/// A step after keys of it were set, one after the other. `words` are those of its variants that are chosen; `fixed` are
/// keys of what a simulation begins with, which cannot change while it runs.
///
/// # Errors
/// [`Error::Run`] that names the key, the value and what is legal.
pub(super) fn after<T: Parameters + Clone>(
    step: &T,
    (words, fixed): (&[&str], &[&str]),
    settings: &[Setting],
) -> Result<T, Error> {
    let mut step = step.clone();
    for Setting { key, value } in settings {
        let path: Vec<_> = key.split('.').collect();
        changes(&path, fixed).and_then(|()| known(&T::parameters(), words, &path)).map_err(Error::Run)?;
        let mut diagnostics = Diagnostics::default();
        step = step.changed(&table_of(&path, value.clone()), &mut diagnostics);
        let faults: Vec<_> = diagnostics.found.into_iter().map(|found| found.message).collect();
        if !faults.is_empty() {
            return Err(Error::Run(faults.join("; ")));
        }
    }
    Ok(step)
}

/// Complains of a key that stays as it is.
fn changes(path: &[&str], fixed: &[&str]) -> Result<(), String> {
    match path.first() {
        Some(key) if fixed.contains(key) => {
            Err(format!("`{key}` cannot change while the simulation runs: it is part of what it begins with"))
        }
        _ => Ok(()),
    }
}

/// Complains of a key that there is not.
fn known(parameters: &[Parameter], words: &[&str], path: &[&str]) -> Result<(), String> {
    let mut own: Vec<&Parameter> = parameters.iter().collect();
    for parameter in parameters {
        let Kind::Variants(variants) = &parameter.kind else { continue };
        own.extend(
            variants
                .iter()
                .filter(|chosen| words.contains(&chosen.word))
                .flat_map(|chosen| &chosen.parameters),
        );
    }
    let [key, rest @ ..] = path else { return Err("a setting needs a key".to_owned()) };
    let Some(found) = own.iter().find(|parameter| parameter.name == *key) else {
        let names: Vec<_> = own.iter().map(|parameter| parameter.name).collect();
        let near = nearest(key, &names).map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
        return Err(format!("there is no key `{key}`{near}"));
    };
    match (&found.kind, rest) {
        (_, []) => Ok(()),
        (Kind::Table(inner), rest) => known(inner, words, rest),
        (_, [inner, ..]) => Err(format!("`{key}` is no table, so that there is no `{key}.{inner}`")),
    }
}

/// A table with one value, under tables for all keys of the path but the last.
fn table_of(path: &[&str], value: Value) -> Table {
    let value = match path {
        [_, rest @ ..] if !rest.is_empty() => Value::Table(table_of(rest, value)),
        _ => value,
    };
    let key = path.first().map(|key| (*key).to_owned()).unwrap_or_default();
    Table { line: 0, entries: vec![(key, Node { line: 0, value })] }
}

/// Complains of keys that do not go together after a change.
pub(super) fn no_faults(step: &dyn Step, materials: &[Material]) -> Result<(), Error> {
    let faults = step.faults().into_iter().chain(step.faults_among(materials));
    let faults: Vec<_> = faults.map(|fault| fault.message).collect();
    if faults.is_empty() { Ok(()) } else { Err(Error::Run(faults.join("; "))) }
}

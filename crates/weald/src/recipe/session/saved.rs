//! A session as a recipe and a script.

use std::path::{Path, PathBuf};

use super::super::canonical;
use super::super::catalog;
use super::super::format;
use super::super::parameter::{Kind, Parameter, Parameters};
use super::super::plan::{FractalKeys, LandscapeKeys, MaterialKeys, Recipe};
use super::super::source::{Node, Table, Value, parse};
use weald_core::error::Error;
use weald_core::files;
use weald_io::write_whole;
use weald_land::edit::Script;
use weald_land::erode::interactive::Interactive;

/// Writes the script, and then the recipe that names it.
pub(super) fn write(
    recipe: &Recipe,
    (place, step): (usize, &dyn Interactive),
    (steps, script): (u64, &Script),
    file: &Path,
) -> Result<(), Error> {
    let edits = file.with_extension("edits.jsonl");
    let name = edits.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    let mut table = parse(&recipe.file, recipe.effective())?;
    let folder = |file: &Path| absolute(file.parent().unwrap_or(Path::new("")));
    let (from, to) = (folder(Path::new(&recipe.file))?, folder(file)?);
    if from != to {
        each_table(&mut table, |table, keys| place_files(table, keys, &from));
    }
    let mut keys = step.replayed(steps);
    keys.push(("edits", Value::Text(name)));
    set_keys(&mut table, place, keys);
    let text = format!("{} = {}\n{}", format::KEY, format::NEWEST, canonical::text(&table));
    Recipe::parse(&file.display().to_string(), &text, &super::super::Overrides::default())?;
    script.save(&edits)?;
    write_whole(file, text.as_bytes())
}

fn absolute(path: &Path) -> Result<PathBuf, Error> {
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    files::absolute(path).map_err(|cause| Error::Run(format!("{}: {cause}", path.display())))
}

/// Gives a step other values of these keys.
fn set_keys(recipe: &mut Table, place: usize, keys: Vec<(&'static str, Value)>) {
    let Some(Node { value: Value::List(steps), .. }) = recipe.get_mut("step") else { return };
    let Some(Node { value: Value::Table(step), .. }) = steps.get_mut(place) else { return };
    for (key, value) in keys {
        step.set(key, Node { line: 0, value });
    }
}

/// Calls `change` with every table of a recipe that may name files, and the keys that it may have.
fn each_table(recipe: &mut Table, change: impl Fn(&mut Table, &[Parameter])) {
    let keys_of = |section: &str, table: &Table| match section {
        "landscape" => LandscapeKeys::parameters(),
        "material" => MaterialKeys::parameters(),
        "fractal" => FractalKeys::parameters(),
        _ => match table.get("do") {
            Some(Node { value: Value::Text(name), .. }) => {
                catalog::find(name).map_or_else(Vec::new, |entry| (entry.parameters)())
            }
            _ => Vec::new(),
        },
    };
    for section in ["landscape", "material", "fractal", "step"] {
        let tables: Vec<&mut Table> = match recipe.get_mut(section).map(|node| &mut node.value) {
            Some(Value::Table(table)) => vec![table],
            Some(Value::List(items)) => items.iter_mut().filter_map(as_table).collect(),
            _ => Vec::new(),
        };
        for table in tables {
            let keys = keys_of(section, table);
            change(table, &keys);
        }
    }
}

fn as_table(node: &mut Node) -> Option<&mut Table> {
    match &mut node.value {
        Value::Table(table) => Some(table),
        _ => None,
    }
}

/// Files that are named from a folder, as they are named from anywhere.
fn place_files(table: &mut Table, keys: &[Parameter], folder: &Path) {
    for key in keys {
        let files = matches!(key.kind, Kind::Raster | Kind::Script | Kind::Flame);
        if let (true, Some(Node { value: Value::Text(name), .. })) = (files, table.get_mut(key.name)) {
            *name = folder.join(&*name).to_string_lossy().into_owned();
        }
        if let Kind::Variants(variants) = &key.kind {
            for variant in variants {
                place_files(table, &variant.parameters, folder);
            }
        }
    }
}

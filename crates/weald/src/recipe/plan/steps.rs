//! The `[[step]]` tables.

use super::PlannedMaterial;
use super::files::Files;
use crate::recipe::plan::words::{Vocabulary, hint, tables};
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::parameter::{Diagnostics, Legal, read_key};
use weald_core::random::splitmix64;
use weald_core::source::{Node, Table, Value};
use weald_engine::step::{Entry, Step};

/// Key of every step: a step that is off is read past as if it did not stand there.
pub(in crate::recipe) const OFF: &str = "off";

/// A step with its place in the recipe.
#[derive(Debug)]
pub struct Planned {
    /// Its declaration.
    pub entry: &'static Entry,
    /// Line of its table.
    pub line: usize,
    /// Place of its table among all `[[step]]` tables, those that are off included, counted from 0.
    pub place: usize,
    /// How many steps of the same name come before it.
    pub occurrence: u64,
    /// The step, ready to run.
    pub step: Box<dyn Step>,
    /// Its keys as written, with the paths of files where they are.
    pub(in crate::recipe) keys: Table,
}

impl Planned {
    /// The step in a message; `number` counts from 1.
    pub(super) fn title(&self, number: usize) -> String {
        format!("step {number} (`{}`, line {})", self.entry.name, self.line)
    }

    /// The step's own seed. The first step of its kind has the landscape's seed, so that adding another kind
    /// of step does not change what a seed gives.
    pub fn seed(&self, landscape: u64) -> u64 {
        match self.occurrence {
            0 => landscape,
            occurrence => splitmix64(landscape ^ occurrence),
        }
    }
}

/// Reads all steps, and says whether each of them was understood in full.
pub(super) fn read(files: Files<'_>, recipe: &Table, diagnostics: &mut Diagnostics) -> (Vec<Planned>, bool) {
    let before = diagnostics.found.len();
    "step".clone_into(&mut diagnostics.subject);
    let mut steps: Vec<Planned> = Vec::new();
    // Those that are off count too, so that the others keep their seeds.
    let mut names: Vec<&str> = Vec::new();
    for (place, table) in tables(recipe, "step", diagnostics).into_iter().enumerate() {
        "step".clone_into(&mut diagnostics.subject);
        let Some(entry) = entry_of(files.vocabulary, table, diagnostics) else { continue };
        let occurrence = names.iter().filter(|earlier| **earlier == entry.name).count() as u64;
        names.push(entry.name);
        if read_key(table, OFF, false, Legal::ANY, diagnostics) {
            continue;
        }
        let (step, keys) = read_step(files, entry, table, diagnostics);
        steps.push(Planned { entry, line: table.line, place, occurrence, step, keys });
    }
    (steps, diagnostics.found.len() == before)
}

fn entry_of(vocabulary: &Vocabulary, table: &Table, diagnostics: &mut Diagnostics) -> Option<&'static Entry> {
    let known: Vec<_> = vocabulary.steps.iter().map(|entry| entry.name).collect();
    match table.get("do") {
        Some(Node { value: Value::Text(name), line }) => {
            let entry = vocabulary.steps.iter().find(|entry| entry.name == name);
            if entry.is_none() {
                diagnostics.add(*line, format!("there is no step {name:?}; {}", hint(name, &known)));
            }
            entry
        }
        Some(Node { value, line }) => {
            diagnostics.add(*line, format!("`do` is {}, but must be the name of a step", value.shown()));
            None
        }
        None => {
            diagnostics.add(table.line, "`do` is needed: the name of a step, as `weald steps` lists them");
            None
        }
    }
}

fn read_step(
    files: Files<'_>,
    entry: &Entry,
    table: &Table,
    diagnostics: &mut Diagnostics,
) -> (Box<dyn Step>, Table) {
    entry.name.clone_into(&mut diagnostics.subject);
    let before = diagnostics.found.len();
    let mut keys = files.placed(table, &(entry.parameters)(), diagnostics);
    keys.take("do");
    keys.take(OFF);
    let step = (entry.read)(&keys, diagnostics);
    if diagnostics.found.len() == before {
        for fault in step.faults() {
            diagnostics.add(table.line_of(&fault.key), fault);
        }
    }
    (step, keys)
}

/// Complains of steps that do not go with the materials of the recipe.
pub(super) fn check_materials(
    steps: &[Planned],
    materials: &[PlannedMaterial],
    diagnostics: &mut Diagnostics,
) {
    let materials: Vec<_> = materials.iter().map(|planned| planned.material.clone()).collect();
    for planned in steps {
        planned.entry.name.clone_into(&mut diagnostics.subject);
        for fault in planned.step.faults_among(&materials) {
            diagnostics.add(planned.keys.line_of(&fault.key), fault);
        }
    }
}

/// Refuses steps that would make a grid over the limit.
pub(super) fn check_sizes(steps: &[Planned]) -> Result<(), Error> {
    for planned in steps {
        if let Some((columns, rows)) = planned.step.resized() {
            Size::within_limits(columns as usize, rows as usize)
                .map_err(|limit| limit.of(planned.entry.name))?;
        }
    }
    Ok(())
}

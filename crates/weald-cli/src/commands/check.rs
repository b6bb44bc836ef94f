//! `weald check`: what is wrong with a recipe, or what it will do.

use std::fmt::Write;

use weald::error::bytes_in_words;
use weald::recipe::{Ground, Machine, Outlook, Overrides, Recipe, Timings};

use crate::arguments::{CheckArguments, kept_results};
use crate::failure::Failure;
use crate::stdout;

pub(crate) fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let overrides = Overrides { larger_than_memory: arguments.out_of_core, ..arguments.changes.overrides() };
    let recipe = Recipe::load(&arguments.recipe, &overrides)?;
    let outlook = if arguments.out_of_core { recipe.look_ahead_on_disk() } else { recipe.look_ahead() };
    let Outlook { notes, memory, grid } = outlook?;
    for note in notes {
        eprintln!("note: {note}");
    }
    let ground = match &recipe.ground {
        Ground::Empty { size, cell, .. } => format!("{size} cells of {cell} m"),
        Ground::File { path, .. } => format!("the ground of {}", path.display()),
    };
    let (steps, outputs) = (recipe.steps.len(), recipe.outputs.len());
    let (file, seed) = (&recipe.file, recipe.seed);
    let mut text = format!("{file}: good; {ground}, steps: {steps}, outputs: {outputs}, seed: {seed}\n");
    if arguments.out_of_core {
        let scratch = bytes_in_words(recipe.scratch()?);
        let _ = writeln!(
            text,
            "  out of core: {scratch} in the folder, beside its files; memory as --memory allows"
        );
    } else {
        let _ = writeln!(text, "  memory: {memory}");
    }
    let estimate = recipe.estimate(&grid, &machine(arguments), &timings());
    for line in estimate.to_string().lines() {
        let _ = writeln!(text, "  {line}");
    }
    for name in recipe.names() {
        let _ = writeln!(text, "  {name}");
    }
    stdout::print(&text)
}

fn machine(arguments: &CheckArguments) -> Machine {
    let all = || std::thread::available_parallelism().map_or(1, usize::from);
    Machine { engine: None, threads: arguments.threads.map_or_else(all, usize::from) }
}

/// What earlier runs took, where results of steps are kept.
fn timings() -> Timings {
    kept_results(None).map(|folder| Timings::read(&folder)).unwrap_or_default()
}

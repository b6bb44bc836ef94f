//! `weald check`: what is wrong with a recipe, or what it will do.

use std::fmt::Write;

use weald::recipe::{Ground, Recipe};

use crate::arguments::CheckArguments;
use crate::failure::Failure;
use crate::stdout;

pub(crate) fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let recipe = Recipe::load(&arguments.recipe, &arguments.changes.overrides())?;
    let (notes, memory) = recipe.look_ahead()?;
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
    let _ = writeln!(text, "  memory: {memory}");
    for name in recipe.names() {
        let _ = writeln!(text, "  {name}");
    }
    stdout::print(&text)
}

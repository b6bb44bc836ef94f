//! Running steps by their names and keys, as a recipe does.

use crate::recipe::catalog;
use crate::written;
use weald_core::error::{Error, RecipeError};
use weald_core::landscape::Landscape;
use weald_core::parameter::Diagnostics;
use weald_core::source::parse;
use weald_engine::Job;

/// Runs steps in turn, each a name and its keys in TOML: `("thermal", "talus = 1.0")`. All have the same seed.
///
/// # Errors
/// [`Error::Run`] for a step that is not in the catalogue or fails, [`Error::Recipe`] for faulty keys.
pub fn run_steps(landscape: &mut Landscape, seed: u64, steps: &[(&str, &str)]) -> Result<(), Error> {
    for (name, keys) in steps {
        run_step(landscape, seed, name, keys)?;
    }
    Ok(())
}

fn run_step(landscape: &mut Landscape, seed: u64, name: &str, keys: &str) -> Result<(), Error> {
    let entry = catalog::find(name).ok_or_else(|| Error::Run(format!("there is no step `{name}`")))?;
    let mut diagnostics = Diagnostics { subject: name.to_owned(), ..Diagnostics::default() };
    let step = (entry.read)(&parse(name, keys)?, &mut diagnostics);
    if !diagnostics.found.is_empty() {
        return Err(RecipeError { file: name.to_string(), diagnostics: diagnostics.found }.into());
    }
    step.run(landscape, &Job::unwatched(seed))?;
    written::finish(step.as_ref(), landscape)
}

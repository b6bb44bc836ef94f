//! Files that a run reads: what is wrong with them is reported before an hour of simulation, not after it.

use std::fs::File;
use std::path::Path;

use crate::recipe::ground;
use crate::recipe::plan::Recipe;
use weald_core::error::Error;

/// Opens every file that the recipe names, and lets the steps look at those that steer them.
pub(super) fn check(recipe: &Recipe) -> Result<(), Error> {
    recipe.inputs().iter().try_for_each(|path| open(path, &recipe.place_of(path)))?;
    let materials = ground::materials(recipe);
    recipe.steps.iter().try_for_each(|planned| planned.step.look_ahead(&materials))
}

fn open(path: &Path, named_at: &str) -> Result<(), Error> {
    let explain = |cause| {
        format!("cannot be read: {cause}; {named_at} names it, and paths start at the folder of the recipe")
    };
    File::open(path).map(drop).map_err(|cause| Error::input(path, explain(cause)))
}

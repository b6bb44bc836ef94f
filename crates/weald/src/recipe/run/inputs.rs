//! Files that a run reads: what is wrong with them is reported before an hour of simulation, not after it.

use std::fs::File;
use std::path::Path;

use crate::recipe::ground;
use crate::recipe::plan::Recipe;
use weald_core::error::Error;

/// Opens every file that the recipe names, and lets the steps look at those that steer them.
pub(super) fn check(recipe: &Recipe) -> Result<(), Error> {
    recipe.inputs().iter().try_for_each(|path| open(path))?;
    let materials = ground::materials(recipe);
    recipe.steps.iter().try_for_each(|planned| planned.step.look_ahead(&materials))
}

fn open(path: &Path) -> Result<(), Error> {
    let explain =
        |cause| format!("cannot be read: {cause}; the recipe names it, and its paths start at its folder");
    File::open(path).map(drop).map_err(|cause| Error::input(path, explain(cause)))
}

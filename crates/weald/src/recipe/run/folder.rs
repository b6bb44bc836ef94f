//! The output folder: what can be known to fail is found before an hour of simulation, not after it.

use std::path::Path;

use crate::recipe::plan::Recipe;
use weald_core::error::Error;
use weald_io::write_whole;

/// Makes the folder and those of the outputs, and tries to write into each.
pub(super) fn prepare(recipe: &Recipe, out: &Path) -> Result<(), Error> {
    make(out)?;
    let inputs = recipe.inputs();
    for output in &recipe.outputs {
        let path = out.join(&output.file);
        make(path.parent().unwrap_or(out))?;
        let is_store = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("zarr"));
        if path.is_dir() && !is_store {
            return Err(Error::Run(format!("cannot write {}: it is a folder", path.display())));
        }
        if inputs.iter().any(|input| same_file(input, &path)) {
            return Err(Error::Run(format!(
                "{} is an input of the recipe and would be overwritten; choose another --out folder",
                path.display()
            )));
        }
    }
    Ok(())
}

fn make(folder: &Path) -> Result<(), Error> {
    std::fs::create_dir_all(folder).map_err(|cause| Error::write(folder, &cause))?;
    let probe = folder.join("weald-was-here");
    write_whole(&probe, b"?")?;
    std::fs::remove_file(&probe).map_err(|cause| Error::write(&probe, &cause))
}

fn same_file(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}

/// Removes the checkpoint of a run that is done.
pub(super) fn remove_checkpoint(path: &Path) -> Result<(), Error> {
    match std::fs::remove_file(path) {
        Err(cause) if cause.kind() != std::io::ErrorKind::NotFound => Err(Error::Run(format!(
            "the run is done, but its checkpoint {} cannot be removed: {cause}",
            path.display()
        ))),
        _ => Ok(()),
    }
}

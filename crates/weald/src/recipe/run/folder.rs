//! The output folder: what can be known to fail is found before an hour of simulation, not after it.

use std::collections::BTreeSet;
use std::path::Path;

use super::work::WorkFolder;
use crate::recipe::plan::{Name, Recipe};
use weald_core::error::Error;
use weald_core::files;
use weald_io::{make_folders, remove_leftovers};

/// Makes the folder and those of the outputs, takes it for this run, and tries to write into each. The texts say what
/// an earlier run had left.
pub(super) fn prepare(recipe: &Recipe, out: &Path) -> Result<(WorkFolder, Vec<String>), Error> {
    make(out)?;
    let place = WorkFolder::take(out, recipe)?;
    let mut notes: Vec<_> = place.note().into_iter().collect();
    let mut left = remove_leftovers(out).len();
    let inputs = recipe.inputs();
    let mut places = BTreeSet::new();
    for name in recipe.outputs.iter().flat_map(|output| output.names(&recipe.steps)) {
        let path = out.join(name.path());
        let folder = path.parent().unwrap_or(out);
        make(folder)?;
        ensure_one_disk(out, folder)?;
        left += remove_leftovers(folder).len();
        ensure_free(&name, &path)?;
        let real =
            files::canonicalize(folder).ok().map(|folder| folder.join(path.file_name().unwrap_or_default()));
        if real.is_some_and(|real| !places.insert(real)) {
            return Err(Error::Run(format!(
                "{} is where another output is to be: a link leads from one folder to the other; choose another --out folder",
                path.display()
            )));
        }
        if inputs.iter().any(|input| same_file(input, &path)) {
            return Err(Error::Run(format!(
                "{} is an input of the recipe and would be overwritten; choose another --out folder",
                path.display()
            )));
        }
    }
    if left > 0 {
        notes.push(format!("{left} temporary files of runs that were ended before are removed"));
    }
    Ok((place, notes))
}

/// A file cannot take the place of a folder, nor a folder that of other things.
fn ensure_free(name: &Name, path: &Path) -> Result<(), Error> {
    let shown = path.display();
    match name {
        Name::Folder { holds, .. } if files::exists(path) && !files::exists(&path.join(holds)) => {
            Err(Error::Run(format!(
                "cannot write {shown}: what is there is no folder of that kind and holds other things; remove or rename it"
            )))
        }
        Name::Folder { .. } => Ok(()),
        _ if files::is_dir(path) => Err(Error::Run(format!("cannot write {shown}: it is a folder"))),
        _ => Ok(()),
    }
}

/// Makes a folder that can be written to.
fn make(folder: &Path) -> Result<(), Error> {
    make_folders(folder).and_then(|()| try_to_write(folder)).map_err(|cause| Error::write(folder, &cause))
}

/// Makes a file that never has a name.
#[cfg(not(target_arch = "wasm32"))]
fn try_to_write(folder: &Path) -> std::io::Result<()> {
    tempfile::tempfile_in(folder).map(drop)
}

/// Memory can be written to.
#[cfg(target_arch = "wasm32")]
#[expect(clippy::unnecessary_wraps, reason = "as where there is one")]
fn try_to_write(_: &Path) -> std::io::Result<()> {
    Ok(())
}

/// Files get their names by a move, which no system makes from one disk to another.
#[cfg(unix)]
fn ensure_one_disk(out: &Path, folder: &Path) -> Result<(), Error> {
    use std::os::unix::fs::MetadataExt;
    let disk = |path: &Path| path.metadata().map(|about| about.dev()).ok();
    if disk(out) == disk(folder) {
        return Ok(());
    }
    let (out, folder) = (out.display(), folder.display());
    Err(Error::Run(format!("{folder} is on another disk than {out}; give an --out folder on that disk")))
}

#[cfg(not(unix))]
#[expect(clippy::unnecessary_wraps, reason = "as where there is one")]
fn ensure_one_disk(_: &Path, _: &Path) -> Result<(), Error> {
    Ok(())
}

fn same_file(one: &Path, other: &Path) -> bool {
    matches!((files::canonicalize(one), files::canonicalize(other)), (Ok(one), Ok(other)) if one == other)
}

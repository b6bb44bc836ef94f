//! The state of a run on disk, so that an interrupted run ends with the same bits as one that was not.
//!
//! Layout, all numbers little-endian: `WEALDCP1`; the length of the header as `u64`; the header as JSON; the
//! no-data mask, one byte a cell, where there is one; each layer as `f32`; each plant as its numbers; the maps of
//! all grass; each plane as `f32`; each sum as `f64`; the BLAKE3 hash of all of that.

mod belongs;
mod grown;
mod header;
mod manifest;
mod parts;
mod planted;
mod state;
mod stream;

use std::io::Write;
use std::path::Path;

pub use belongs::CHECKPOINT_FILE;
use belongs::{MAGIC, fits};
pub(super) use header::Head;
use header::{Header, read_header};
pub(super) use manifest::{Manifest, PARTS_FOLDER};
pub(super) use parts::{KeptParts, remove_stale_parts};
pub(super) use state::State;
use stream::{HashedReader, HashedWriter};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_engine::SavedSimulation;
use weald_io::write_whole_with;
use weald_plants::Vegetation;

/// Writes the state, with `simulation` in place of the state's own.
pub(super) fn write(
    path: &Path,
    recipe: &str,
    state: &State,
    simulation: Option<&SavedSimulation>,
) -> Result<(), Error> {
    write_whole_with(path, |file| write_to(file, recipe, state, simulation))
}

fn write_to(
    out: impl Write,
    recipe: &str,
    state: &State,
    simulation: Option<&SavedSimulation>,
) -> std::io::Result<()> {
    let header = Header::of(recipe, state, simulation);
    let header = serde_json::to_vec(&header).expect("numbers, texts and lists are JSON");
    let mut out = HashedWriter::new(out);
    out.bytes(MAGIC)?;
    out.bytes(&(header.len() as u64).to_le_bytes())?;
    out.bytes(&header)?;
    if let Some(valid) = &state.landscape.domain.valid {
        out.flags(valid.flags())?;
    }
    for (_, layer) in state.landscape.layers() {
        out.singles(layer.field.values())?;
    }
    for (_, plants) in state.landscape.all_plants() {
        planted::write(plants, &mut out)?;
    }
    for (_, meadow) in state.landscape.all_meadows() {
        grown::write(&meadow, &mut out)?;
    }
    for (_, plane) in simulation.iter().flat_map(|simulation| &simulation.planes) {
        out.singles(plane)?;
    }
    for (_, sums) in simulation.iter().flat_map(|simulation| &simulation.sums) {
        out.doubles(sums)?;
    }
    out.finish()
}

/// A landscape as bytes: its grid, layers, plants and grass, to the bit. Its materials and fractals, which a recipe has, are
/// not in them.
pub fn pack_landscape(landscape: &Landscape) -> Vec<u8> {
    let (landscape, steps, notes) = (landscape.clone(), Vec::new(), Vec::new());
    let state = State { landscape, done: 0, simulation: None, steps, notes };
    let mut bytes = Vec::new();
    write_to(&mut bytes, NO_RECIPE, &state, None).expect("memory takes what is written");
    bytes
}

/// The landscape of bytes that [`pack_landscape`] has made, of the default materials.
///
/// # Errors
/// [`Error::Input`] for bytes that are damaged, or of another version of Weald.
pub fn unpack_landscape(bytes: &[u8]) -> Result<Landscape, Error> {
    let wrong = |what: String| Error::input(Path::new("a packed landscape"), what);
    read_from(HashedReader::of_bytes(bytes), NO_RECIPE, |_| Ok(()), &wrong).map(|state| state.landscape)
}

/// What stands for the recipe of a landscape that is kept alone.
const NO_RECIPE: &str = "";

/// Reads the state of a run of exactly this recipe.
pub(super) fn read(path: &Path, recipe: &str) -> Result<State, Error> {
    read_if(path, recipe, |_| Ok(()))
}

/// The same, where its head is accepted before anything else is read.
pub(super) fn read_if(
    path: &Path,
    recipe: &str,
    accept: impl FnOnce(&Head) -> Result<(), Error>,
) -> Result<State, Error> {
    let wrong = |what: String| Error::input(path, what);
    let file = HashedReader::open(path).map_err(|cause| {
        wrong(match cause.kind() {
            std::io::ErrorKind::NotFound => "there is no checkpoint; run without --resume".to_owned(),
            _ => format!("the checkpoint cannot be read: {cause}"),
        })
    })?;
    read_from(file, recipe, accept, &wrong)
}

fn read_from(
    mut file: HashedReader<'_>,
    recipe: &str,
    accept: impl FnOnce(&Head) -> Result<(), Error>,
    wrong: &impl Fn(String) -> Error,
) -> Result<State, Error> {
    let header = read_header(&mut file).map_err(wrong)?;
    fits(&header.version, &header.recipe, recipe).map_err(wrong)?;
    accept(&header.head().map_err(wrong)?)?;
    let state = header.read_state(&mut file).map_err(wrong)?;
    file.finish().map_err(wrong)?;
    Ok(state)
}

#[cfg(test)]
mod tests;

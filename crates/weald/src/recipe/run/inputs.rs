//! Files that a run reads: what is wrong with them is reported before an hour of simulation, not after it.

use std::path::Path;

use super::video;
use crate::recipe::ground;
use crate::recipe::memory::{Memory, ensure_file};
use crate::recipe::plan::{Ground, Output, Recipe};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::files::File;
use weald_core::landscape::Landscape;

/// What a run would find.
#[derive(Clone, Debug)]
pub struct Outlook {
    /// What it would tell.
    pub notes: Vec<String>,
    /// The memory that it would take.
    pub memory: Memory,
    /// The grid that it begins on.
    pub grid: Domain,
}

impl Recipe {
    /// What only files tell before a run: whether all that the recipe names are there and of use, and whether the steps and
    /// outputs can work on the grid that the elevation model has.
    ///
    /// # Errors
    /// [`Error::Input`] for a file, and as [`Recipe::parse`] for what does not go with the grid.
    pub fn look_ahead(&self) -> Result<Outlook, Error> {
        let (landscape, notes) = start(self, Some(u64::MAX))?;
        Ok(Outlook { notes, memory: self.memory(&landscape.domain), grid: landscape.domain })
    }

    /// The same for a run out of core; the memory is what it would take without.
    ///
    /// # Errors
    /// As [`Recipe::scratch`].
    pub fn look_ahead_on_disk(&self) -> Result<Outlook, Error> {
        let (grid, file) = self.start_on_disk()?;
        let materials = ground::materials(self);
        self.steps.iter().try_for_each(|planned| planned.step.look_ahead(&materials, &grid))?;
        let notes = file.map(|file| file.notes).unwrap_or_default();
        Ok(Outlook { notes, memory: self.memory(&grid), grid })
    }
}

/// The landscape before the first step, once all that can be told before it is right; the texts tell the user what had
/// to be done to the files.
pub(in crate::recipe) fn start(
    recipe: &Recipe,
    memory: Option<u64>,
) -> Result<(Landscape, Vec<String>), Error> {
    let inputs = recipe.inputs();
    inputs.iter().try_for_each(|path| open(path, &recipe.place_of(path), memory))?;
    let (landscape, mut notes) = ground::load(recipe)?;
    ground::check_outputs(recipe, &landscape)?;
    if matches!(recipe.ground, Ground::File { .. }) {
        recipe.check_on(&landscape.domain)?;
    }
    recipe.ensure_memory(&landscape.domain, memory)?;
    let (steps, _) = recipe.grids(&landscape.domain);
    steps.iter().try_for_each(|(planned, grid)| planned.step.look_ahead(&landscape.materials, grid))?;
    notes.extend(recipe.outputs.iter().filter(|output| output.is_video()).find_map(video_note));
    Ok((landscape, notes))
}

fn video_note(output: &Output) -> Option<String> {
    (!video::can_make(&output.file)).then(|| video::NO_FFMPEG.to_owned())
}

/// Whether a file can be opened and is no longer than the memory.
fn open(path: &Path, named_at: &str, memory: Option<u64>) -> Result<(), Error> {
    let explain = |cause| {
        format!("cannot be read: {cause}; {named_at} names it, and paths start at the folder of the recipe")
    };
    let there = File::open(path).and_then(|file| file.metadata());
    let there = there.map_err(|cause| Error::input(path, explain(cause)))?;
    if there.is_file() { ensure_file(path, there.len(), memory) } else { Ok(()) }
}

//! Parts of a checkpoint: each rank writes and reads its own rows, and the first publishes the manifest when all parts are on
//! disk, so that a checkpoint is whole or not there.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::manifest::{
    Manifest, PARTS_FOLDER, PartHeader, PlaneHeader, Role, SUMS, is_part, number_of, part_name,
};
use super::stream::{HashedReader, HashedWriter};
use weald_core::error::Error;
use weald_core::file_plane::AT_ONCE;
use weald_core::files;
use weald_engine::ranks::{Ranks, agreed};
use weald_engine::report::StepReport;
use weald_engine::stored::{StoredLandscape, StoredPlane};
use weald_engine::stored_state::{ResumedState, StoredState};
use weald_engine::sums::RowSums;
use weald_io::{make_folders, write_whole_with};

/// What a checkpoint by parts keeps.
pub(in crate::recipe) struct KeptParts<'a> {
    pub(in crate::recipe) recipe: &'a str,
    /// What the steps done have to report.
    pub(in crate::recipe) steps: &'a [StepReport],
    /// What there is to say of the input.
    pub(in crate::recipe) notes: &'a [String],
    /// The landscape as it was before the step that runs now, but for what that has taken out.
    pub(in crate::recipe) landscape: &'a StoredLandscape<'a>,
    /// Where that step is, if it can go on from there.
    pub(in crate::recipe) state: Option<&'a StoredState<'a>>,
}

/// This rank's rows of a plane.
enum Rows<'a> {
    Plane(&'a StoredPlane),
    Sums(Range<usize>, &'a [RowSums]),
}

impl KeptParts<'_> {
    /// Writes it into the output folder, which all ranks see. All of them call it together.
    ///
    /// # Errors
    /// [`Error::Run`] on all ranks where one cannot write its part; the checkpoint before it stands then.
    pub(in crate::recipe) fn write(&self, out: &Path) -> Result<(), Error> {
        let ranks = &*self.landscape.ranks;
        let folder = out.join(PARTS_FOLDER);
        let number = agreed(ranks, if ranks.leads() { next_number(&folder) } else { Ok(0) })?;
        let number = ranks.tell(number.to_le_bytes().to_vec())?;
        let number = number.try_into().map_or(0, u64::from_le_bytes);
        let planes = self.planes();
        let part = agreed(ranks, write_part(&folder, &part_name(number, ranks.rank()), &planes))?;
        let mut parts = Vec::with_capacity(ranks.count());
        let message = serde_json::to_vec(&part).expect("numbers and texts are JSON");
        ranks.collect(message, &mut |rank, message| {
            let part = serde_json::from_slice(&message);
            parts.push(part.map_err(|error| Error::Run(format!("rank {rank} told of no part: {error}")))?);
            Ok(())
        })?;
        let planes = planes.into_iter().map(|(header, _)| header).collect();
        agreed(ranks, if ranks.leads() { self.publish(out, planes, parts) } else { Ok(()) })
    }

    fn publish(&self, out: &Path, planes: Vec<PlaneHeader>, parts: Vec<PartHeader>) -> Result<(), Error> {
        // A rank whose output folder is another one would have written into that.
        parts.iter().try_for_each(|part| part.ensure_there(out)).map_err(|error| {
            Error::Run(format!("{error}: the output folder must be the same on the machines of all ranks"))
        })?;
        let manifest = Manifest {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            recipe: self.recipe.to_owned(),
            done: self.steps.len(),
            iteration: self.state.map(|state| state.iteration),
            steps: self.steps.to_vec(),
            notes: self.notes.to_vec(),
            planes,
            parts,
        };
        manifest.publish(out)?;
        remove_others(out, Some(&manifest))
    }

    /// All planes with this rank's rows of them.
    fn planes(&self) -> Vec<(PlaneHeader, Rows<'_>)> {
        let plane = |role, name: &str, unit: &str, plane: &'_ StoredPlane| {
            let (columns, rows) = (plane.columns(), plane.shared().count());
            PlaneHeader { role, name: name.to_owned(), unit: unit.to_owned(), columns, rows }
        };
        let layers = self.landscape.layers().map(|(name, layer)| (name, layer.unit.as_str(), &layer.plane));
        let layers = layers.chain(self.state.map(|state| state.taken));
        let layers =
            layers.map(|(name, unit, values)| (plane(Role::Layer, name, unit, values), Rows::Plane(values)));
        let states = self.state.into_iter().flat_map(|state| &state.planes);
        let states = states.map(|(name, values)| (plane(Role::State, name, "", values), Rows::Plane(values)));
        let sums = self.state.and_then(|state| {
            let shared = state.planes.first()?.1.shared();
            let (name, unit) = ("row sums".to_owned(), String::new());
            let header = PlaneHeader { role: Role::Sums, name, unit, columns: SUMS, rows: shared.count() };
            Some((header, Rows::Sums(shared.own(), state.row_sums)))
        });
        let valid = self.landscape.valid();
        let valid = valid.map(|valid| (plane(Role::Valid, "cells with data", "", valid), Rows::Plane(valid)));
        layers.chain(valid).chain(states).chain(sums).collect()
    }
}

/// The number of the next checkpoint, in a folder that is there then.
fn next_number(folder: &Path) -> Result<u64, Error> {
    make_folders(folder).map_err(|cause| Error::write(folder, &cause))?;
    Ok(part_files(folder).filter_map(|(name, _)| number_of(&name)).max().map_or(0, |number| number + 1))
}

/// Names and paths of the parts that are there.
fn part_files(folder: &Path) -> impl Iterator<Item = (String, PathBuf)> {
    let entries = files::read_dir(folder).into_iter().flatten().flatten();
    let named = entries.map(|entry| (entry.file_name().to_string_lossy().into_owned(), entry.path()));
    named.filter(|(name, _)| is_part(name))
}

fn write_part(folder: &Path, name: &str, planes: &[(PlaneHeader, Rows<'_>)]) -> Result<PartHeader, Error> {
    let path = folder.join(name);
    let (mut hash, mut rows, mut bytes) = (None, Vec::new(), 0);
    for (header, values) in planes {
        let own = values.own();
        bytes += header.row_bytes() * own.len() as u64;
        rows.push([own.start, own.end]);
    }
    write_whole_with(&path, |file| {
        let mut file = HashedWriter::new(file);
        planes.iter().try_for_each(|(_, values)| values.write(&mut file))?;
        hash = Some(file.hash());
        Ok(())
    })?;
    let blake3 = hash.map(|hash| hash.to_hex().to_string()).unwrap_or_default();
    Ok(PartHeader { file: name.to_owned(), bytes, blake3, rows })
}

impl Rows<'_> {
    fn own(&self) -> Range<usize> {
        match self {
            Self::Plane(plane) => plane.own(),
            Self::Sums(own, _) => own.clone(),
        }
    }

    fn write<W: std::io::Write>(&self, file: &mut HashedWriter<W>) -> std::io::Result<()> {
        match self {
            Self::Sums(_, sums) => sums.iter().try_for_each(|row| file.doubles(row)),
            Self::Plane(plane) => plane.runs_of_rows().try_for_each(|rows| {
                let values = plane.rows(rows).map_err(|error| std::io::Error::other(error.to_string()))?;
                file.singles(&values)
            }),
        }
    }
}

impl Manifest {
    /// Gives the manifest that the first rank has to all.
    ///
    /// # Errors
    /// [`Error::Run`] where another rank can no longer be reached, or is of another build.
    pub(in crate::recipe) fn told(manifest: Option<Self>, ranks: &dyn Ranks) -> Result<Self, Error> {
        let message = manifest.map(|manifest| serde_json::to_vec(&manifest).expect("it was read as JSON"));
        let message = ranks.tell(message.unwrap_or_default())?;
        serde_json::from_slice(&message)
            .map_err(|error| Error::Run(format!("the first rank told of no checkpoint: {error}")))
    }

    /// Puts this rank's rows of all layers into the landscape, and of the simulation that runs. All ranks call it together.
    ///
    /// # Errors
    /// [`Error::Input`] naming a part that is damaged, what was expected, and what to do; those of the disk.
    pub(in crate::recipe) fn load(
        &self,
        out: &Path,
        landscape: &mut StoredLandscape<'_>,
    ) -> Result<(), Error> {
        let mut loaded = Vec::with_capacity(self.planes.len());
        for header in &self.planes {
            let rows = landscape.rows().ringed(header.ring(landscape.domain.size));
            loaded.push(if header.role == Role::Sums {
                Loaded::Sums(rows.own(), vec![RowSums::default(); rows.own().len()])
            } else {
                Loaded::Plane(landscape.plane_of(&header.name, (header.columns, &rows))?)
            });
        }
        let read = self.parts.iter().try_for_each(|part| self.read_part(out, part, &mut loaded));
        agreed(&*landscape.ranks, read)?;
        let mut resumed =
            self.iteration.map(|iteration| ResumedState { iteration, ..ResumedState::default() });
        for (header, loaded) in self.planes.iter().zip(loaded) {
            match (loaded, &mut resumed) {
                (Loaded::Plane(plane), _) if header.role == Role::Layer => {
                    landscape.insert(&header.name, &header.unit, plane);
                }
                (Loaded::Plane(plane), _) if header.role == Role::Valid => landscape.set_valid(Some(plane)),
                (Loaded::Plane(plane), Some(resumed)) => resumed.planes.push((header.name.clone(), plane)),
                (Loaded::Sums(_, sums), Some(resumed)) => resumed.row_sums = sums,
                _ => {}
            }
        }
        landscape.resumed = resumed;
        Ok(())
    }

    /// Takes from a part what is this rank's own; one of which it needs nothing is not read.
    fn read_part(&self, out: &Path, part: &PartHeader, loaded: &mut [Loaded]) -> Result<(), Error> {
        let is_needed = |(loaded, &[start, end]): (&Loaded, &[usize; 2])| {
            let own = loaded.own();
            own.start.max(start) < own.end.min(end)
        };
        if !loaded.iter().zip(&part.rows).any(is_needed) {
            return Ok(());
        }
        part.ensure_there(out)?;
        let path = out.join(PARTS_FOLDER).join(&part.file);
        let remedy = "put the part back that belongs to the checkpoint, or run without --resume";
        let wrong = |what: String| Error::input(&path, format!("{what}; {remedy}"));
        let mut file =
            HashedReader::open(&path).map_err(|cause| wrong(format!("cannot be read: {cause}")))?;
        for ((header, &[start, end]), loaded) in self.planes.iter().zip(&part.rows).zip(loaded) {
            let run = (AT_ONCE / header.row_bytes().max(1) as usize).max(1);
            for first in (start..end).step_by(run) {
                loaded.take(first..(first + run).min(end), header.columns, &mut file, &wrong)?;
            }
        }
        let hash = file.hash().to_hex();
        if hash.as_str() == part.blake3 {
            return Ok(());
        }
        Err(wrong(format!("is damaged: its BLAKE3 hash was to be {}, and is {hash}", part.blake3)))
    }
}

/// A plane as it is read.
enum Loaded {
    Plane(StoredPlane),
    Sums(Range<usize>, Vec<RowSums>),
}

impl Loaded {
    fn own(&self) -> Range<usize> {
        match self {
            Self::Plane(plane) => plane.own(),
            Self::Sums(own, _) => own.clone(),
        }
    }

    /// Reads rows, and keeps those that are this rank's own.
    fn take(
        &mut self,
        rows: Range<usize>,
        columns: usize,
        file: &mut HashedReader<'_>,
        wrong: &impl Fn(String) -> Error,
    ) -> Result<(), Error> {
        let own = self.own();
        let kept = own.start.max(rows.start)..own.end.min(rows.end);
        let cells =
            kept.start.saturating_sub(rows.start) * columns..kept.end.saturating_sub(rows.start) * columns;
        match self {
            Self::Plane(plane) => {
                let values = file.singles(rows.len() * columns).map_err(wrong)?;
                if kept.is_empty() { Ok(()) } else { plane.set_rows(kept, &values[cells]) }
            }
            Self::Sums(_, sums) => {
                let values = file.doubles(rows.len() * columns).map_err(wrong)?;
                for (y, row) in rows.zip(values.as_chunks().0) {
                    if own.contains(&y) {
                        sums[y - own.start] = *row;
                    }
                }
                Ok(())
            }
        }
    }
}

/// Removes all parts that a manifest does not name, and the folder where none is left.
///
/// # Errors
/// [`Error::Run`] naming a part that cannot be removed.
fn remove_others(out: &Path, manifest: Option<&Manifest>) -> Result<(), Error> {
    let folder = out.join(PARTS_FOLDER);
    let named: BTreeSet<&str> =
        manifest.into_iter().flat_map(|manifest| &manifest.parts).map(|part| part.file.as_str()).collect();
    for (name, path) in part_files(&folder) {
        if !named.contains(name.as_str()) {
            files::remove_file(&path).map_err(|cause| Error::write(&path, &cause))?;
        }
    }
    weald_io::remove_leftovers(&folder);
    if named.is_empty() {
        // One that holds other things stays.
        let _ = files::remove_dir(&folder);
    }
    Ok(())
}

/// Removes parts of checkpoints that were never whole, or are no more. Those of a manifest that cannot be read stay.
///
/// # Errors
/// [`Error::Run`] naming a part that cannot be removed.
pub(in crate::recipe) fn remove_stale_parts(out: &Path) -> Result<(), Error> {
    if !files::exists(&out.join(PARTS_FOLDER)) {
        return Ok(());
    }
    match Manifest::of_folder(out) {
        Ok(manifest) => remove_others(out, manifest.as_ref()),
        Err(_) => Ok(()),
    }
}

//! The manifest of a checkpoint by parts: how far the run has come, which planes there are, and which part has which rows.
//!
//! Layout, under the name of the checkpoint: `WEALDCM1`; the length of the header as `u64`, little-endian; the header as
//! JSON; the BLAKE3 hash of all of that.

use std::io::Write;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::belongs::{CHECKPOINT_FILE, MAGIC, MAGIC_OF_PARTS, MAX_HEADER, fits};
use super::stream::{HASH_BYTES, HashedReader, HashedWriter};
use weald_core::error::Error;
use weald_core::file_plane::VALUE;
use weald_core::files;
use weald_core::grid::Size;
use weald_engine::report::StepReport;
use weald_engine::sums::RowSums;
use weald_io::write_whole_with;

/// Folder of the parts, beside the manifest.
pub(in crate::recipe) const PARTS_FOLDER: &str = "checkpoint.parts";

/// Numbers in the sums of a row.
pub(super) const SUMS: usize = size_of::<RowSums>() / size_of::<f64>();

/// What a plane is to the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Role {
    /// A layer of the landscape.
    Layer,
    /// Which cells have data, as 1 and 0.
    Valid,
    /// A plane of the simulation that runs.
    State,
    /// Sums of the rows of that simulation, of double precision.
    Sums,
}

/// A plane, of which each part has some rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PlaneHeader {
    pub(super) role: Role,
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) columns: usize,
    pub(super) rows: usize,
}

/// A file with the rows of one rank: of each plane, one after the other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PartHeader {
    /// Its name in the folder of parts.
    pub(super) file: String,
    pub(super) bytes: u64,
    pub(super) blake3: String,
    /// First row and row after the last, of each plane.
    pub(super) rows: Vec<[usize; 2]>,
}

/// How far a run has come that no process holds as a whole.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::recipe) struct Manifest {
    pub(super) version: String,
    pub(super) recipe: String,
    /// Steps done.
    pub(in crate::recipe) done: usize,
    /// Iterations of the simulation that runs, if one does.
    pub(in crate::recipe) iteration: Option<u64>,
    /// What the steps done have to report.
    pub(in crate::recipe) steps: Vec<StepReport>,
    /// What there is to say of the input.
    pub(in crate::recipe) notes: Vec<String>,
    pub(super) planes: Vec<PlaneHeader>,
    /// From north to south.
    pub(super) parts: Vec<PartHeader>,
}

impl PlaneHeader {
    /// Bytes of a row.
    pub(super) fn row_bytes(&self) -> u64 {
        self.columns as u64 * if self.role == Role::Sums { 2 * VALUE } else { VALUE }
    }

    /// Rows at the northern and southern end that a grid of that size has not.
    pub(super) fn ring(&self, grid: Size) -> usize {
        self.rows.saturating_sub(grid.rows) / 2
    }

    /// Whether it is of such a grid, with or without the ring of an open border.
    fn is_of(&self, grid: Size) -> bool {
        let ring = self.ring(grid);
        let columns = if self.role == Role::Sums { SUMS } else { grid.columns + 2 * ring };
        ring <= 1
            && (![Role::Layer, Role::Valid].contains(&self.role) || ring == 0)
            && self.rows == grid.rows + 2 * ring
            && self.columns == columns
    }
}

impl Manifest {
    /// Writes it, which makes the checkpoint that of the run.
    pub(super) fn publish(&self, out: &Path) -> Result<(), Error> {
        let header = serde_json::to_vec(self).expect("numbers, texts and lists are JSON");
        write_whole_with(&out.join(CHECKPOINT_FILE), |file| {
            let mut file = HashedWriter::new(file as &mut dyn Write);
            file.bytes(MAGIC_OF_PARTS)?;
            file.bytes(&(header.len() as u64).to_le_bytes())?;
            file.bytes(&header)?;
            file.finish()
        })
    }

    /// The manifest of a folder, of whatever recipe; none where its checkpoint is of another kind or not there.
    ///
    /// # Errors
    /// [`Error::Input`] naming the manifest where it is damaged.
    pub(in crate::recipe) fn of_folder(out: &Path) -> Result<Option<Self>, Error> {
        let path = out.join(CHECKPOINT_FILE);
        if !files::exists(&path) {
            return Ok(None);
        }
        let read = || -> Result<Option<Self>, String> {
            let mut file = HashedReader::open(&path)
                .map_err(|cause| format!("the checkpoint cannot be read: {cause}"))?;
            let magic = file.bytes(MAGIC.len())?;
            if magic == MAGIC {
                return Ok(None);
            }
            if magic != MAGIC_OF_PARTS {
                return Err("is not a checkpoint of this version of Weald; run without --resume".to_owned());
            }
            let length =
                file.bytes(8)?.try_into().map(u64::from_le_bytes).expect("eight bytes were asked for");
            if length > MAX_HEADER || length.saturating_add(HASH_BYTES) != file.left() {
                return Err(format!(
                    "is damaged: a manifest of {length} bytes and its hash were expected, and {} bytes follow; run \
                     without --resume",
                    file.left()
                ));
            }
            let header = file.bytes(length as usize)?;
            file.finish().map_err(|what| format!("{what}; run without --resume"))?;
            let manifest = serde_json::from_slice(&header);
            manifest.map(Some).map_err(|error| format!("is no manifest of this version of Weald: {error}"))
        };
        read().map_err(|what| Error::input(&path, what))
    }

    /// The manifest of a run of exactly this recipe, on such a grid, all of whose parts are there.
    ///
    /// # Errors
    /// [`Error::Input`] naming the file, what was expected, and what to do.
    pub(in crate::recipe) fn to_go_on(out: &Path, recipe: &str, grid: Size) -> Result<Self, Error> {
        let path = out.join(CHECKPOINT_FILE);
        let wrong = |what: String| Error::input(&path, what);
        let Some(manifest) = Self::of_folder(out)? else {
            return Err(wrong(if files::exists(&path) {
                "is a checkpoint of a run in memory; go on without --distributed and --out-of-core, or run without --resume"
                    .to_owned()
            } else {
                "there is no checkpoint; run without --resume".to_owned()
            }));
        };
        fits(&manifest.version, &manifest.recipe, recipe).map_err(wrong)?;
        manifest.ensure_whole(grid).map_err(wrong)?;
        manifest.parts.iter().try_for_each(|part| part.ensure_there(out))?;
        Ok(manifest)
    }

    /// The parts have all rows of all planes, once and in order.
    fn ensure_whole(&self, grid: Size) -> Result<(), String> {
        let damaged = |what: &str| format!("is damaged: {what}; run without --resume");
        if let Some(plane) = self.planes.iter().find(|plane| !plane.is_of(grid)) {
            return Err(damaged(&format!(
                "`{}` has {} × {} cells, where the landscape has {grid}",
                plane.name, plane.columns, plane.rows
            )));
        }
        if self.parts.iter().any(|part| part.rows.len() != self.planes.len() || !part.has_a_plain_name()) {
            return Err(damaged("a part has other planes than the others, or no name"));
        }
        for (number, plane) in self.planes.iter().enumerate() {
            let mut next = 0;
            for [start, end] in self.parts.iter().map(|part| part.rows[number]) {
                if start != next || end < start {
                    return Err(damaged(&format!("`{}` lacks rows from {next} on", plane.name)));
                }
                next = end;
            }
            if next != plane.rows {
                return Err(damaged(&format!("`{}` lacks rows from {next} on", plane.name)));
            }
        }
        let told = |part: &PartHeader| part.bytes == part.needed(&self.planes);
        if self.parts.iter().all(told) {
            Ok(())
        } else {
            Err(damaged("a part has not the bytes of its rows"))
        }
    }
}

impl PartHeader {
    /// Bytes of its rows.
    pub(super) fn needed(&self, planes: &[PlaneHeader]) -> u64 {
        let rows = self.rows.iter().map(|[start, end]| (end - start) as u64);
        rows.zip(planes).map(|(rows, plane)| rows * plane.row_bytes()).sum()
    }

    /// Whoever sends somebody a manifest must not have files of theirs read.
    fn has_a_plain_name(&self) -> bool {
        is_part(&self.file)
    }

    /// Whether its file is there and as long as it should be, before anything is read.
    pub(super) fn ensure_there(&self, out: &Path) -> Result<(), Error> {
        let path = out.join(PARTS_FOLDER).join(&self.file);
        let expected =
            format!("a part of {} bytes of the checkpoint {CHECKPOINT_FILE} was expected", self.bytes);
        let wrong = |found: String| {
            let remedy = "put the part back that belongs to it, or run without --resume";
            Error::input(&path, format!("{expected}, and {found}; {remedy}"))
        };
        match files::metadata(&path) {
            Err(cause) => Err(wrong(format!("cannot be read: {cause}"))),
            Ok(about) if about.len() != self.bytes => Err(wrong(format!("{} are there", about.len()))),
            Ok(_) => Ok(()),
        }
    }
}

/// The name of a rank's part of a checkpoint; those of the one before are kept until this one is whole.
pub(super) fn part_name(number: u64, rank: usize) -> String {
    format!("{number}-{rank}.part")
}

/// Whether a file is a part.
pub(super) fn is_part(name: &str) -> bool {
    number_of(name).is_some()
}

/// The number of the checkpoint of which a part is.
pub(super) fn number_of(name: &str) -> Option<u64> {
    let (number, rank) = name.strip_suffix(".part")?.split_once('-')?;
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    if is_number(rank) && is_number(number) { number.parse().ok() } else { None }
}

//! Rasters and exports of several files: a description beside the values, a set of tiles, a folder of chunks.

use std::collections::{BTreeMap, BTreeSet};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use super::Fault;
use weald_core::error::{Limit, Quantity};
use weald_core::files::{self, File};

/// One file of a raster or of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its name.
    pub name: PartName,
    /// All of it.
    pub bytes: Vec<u8>,
}

/// The name of a part, from that of the output, such as `land.raw`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum PartName {
    /// The output itself.
    Own,
    /// The whole name and more: `.json` makes `land.raw.json`.
    Beside(String),
    /// The name without its extension, and more: `_0_1.raw` makes `land_0_1.raw`.
    Sibling(String),
    /// A file in a folder of that name: `c/0/0` makes `land.zarr/c/0/0`.
    Inside(String),
}

impl Part {
    /// The output itself.
    pub fn own(bytes: Vec<u8>) -> Self {
        Self { name: PartName::Own, bytes }
    }

    /// A file beside it, as [`PartName::Beside`].
    pub fn beside(suffix: impl Into<String>, bytes: Vec<u8>) -> Self {
        Self { name: PartName::Beside(suffix.into()), bytes }
    }

    /// A file beside it, as [`PartName::Sibling`].
    pub fn sibling(suffix: impl Into<String>, bytes: Vec<u8>) -> Self {
        Self { name: PartName::Sibling(suffix.into()), bytes }
    }

    /// A file in it, as [`PartName::Inside`].
    pub fn inside(path: impl Into<String>, bytes: Vec<u8>) -> Self {
        Self { name: PartName::Inside(path.into()), bytes }
    }
}

impl PartName {
    /// Where the part lies, for an output at `path`.
    pub fn path(&self, path: &Path) -> PathBuf {
        match self {
            Self::Own => path.to_owned(),
            Self::Beside(suffix) => followed(path, suffix),
            Self::Sibling(suffix) => followed(&path.with_extension(""), suffix),
            Self::Inside(inner) => path.join(inner),
        }
    }

    /// The name, and that in capitals where it is an extension of its own, as programs of Windows write `.PRJ` and `.TFW`.
    fn spellings(&self) -> impl Iterator<Item = Self> {
        let in_capitals = |suffix: &str| suffix.starts_with('.').then(|| suffix.to_ascii_uppercase());
        let other = match self {
            Self::Beside(suffix) => in_capitals(suffix).map(Self::Beside),
            Self::Sibling(suffix) => in_capitals(suffix).map(Self::Sibling),
            Self::Own | Self::Inside(_) => None,
        };
        std::iter::once(self.clone()).chain(other)
    }
}

/// The path with text added to its name.
pub(super) fn followed(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(suffix);
    PathBuf::from(name)
}

/// Where a reader finds the files of a raster.
pub trait Parts {
    /// A file of at most `most` bytes; `None` where there is none.
    ///
    /// # Errors
    /// [`Fault::Limit`] for one that is longer, [`Fault::Damaged`] for one that cannot be read.
    fn read(&self, name: &PartName, most: u64) -> Result<Option<Vec<u8>>, Fault>;

    /// Names of the folders right inside that of the output, in order.
    ///
    /// # Errors
    /// [`Fault::Damaged`] where they cannot be listed.
    fn folders(&self) -> Result<Vec<String>, Fault>;
}

/// Parts on disk, of the raster at a path.
#[derive(Clone, Debug)]
pub(super) struct OnDisk(pub(super) PathBuf);

impl Parts for OnDisk {
    fn read(&self, name: &PartName, most: u64) -> Result<Option<Vec<u8>>, Fault> {
        let path = name.spellings().map(|name| name.path(&self.0)).find(|path| files::exists(path));
        path.map(|path| read_at_most(&path, most)).transpose()
    }

    fn folders(&self) -> Result<Vec<String>, Fault> {
        let unlisted = |cause| Fault::damaged(format!("cannot be listed: {cause}"));
        let mut folders = Vec::new();
        for entry in files::read_dir(&self.0).map_err(unlisted)? {
            let entry = entry.map_err(unlisted)?;
            let name = entry.file_name().into_string().ok().filter(|_| files::is_dir(&entry.path()));
            folders.extend(name);
        }
        folders.sort();
        Ok(folders)
    }
}

/// Parts in memory, by the paths that they have for an output without a folder.
#[derive(Clone, Debug, Default)]
pub struct InMemory {
    /// Name of the output.
    pub file: PathBuf,
    /// Its files.
    pub files: BTreeMap<PathBuf, Vec<u8>>,
}

impl InMemory {
    /// What was written, to be read again.
    pub fn of(file: impl Into<PathBuf>, parts: Vec<Part>) -> Self {
        let file = file.into();
        let files = parts.into_iter().map(|part| (part.name.path(&file), part.bytes)).collect();
        Self { file, files }
    }
}

impl Parts for InMemory {
    fn read(&self, name: &PartName, most: u64) -> Result<Option<Vec<u8>>, Fault> {
        let Some(bytes) = self.files.get(&name.path(&self.file)) else { return Ok(None) };
        if bytes.len() as u64 > most {
            return Err(Limit::new(Quantity::FileBytes, bytes.len() as u64, 0..=most).into());
        }
        Ok(Some(bytes.clone()))
    }

    fn folders(&self) -> Result<Vec<String>, Fault> {
        let folder_of = |path: &PathBuf| {
            let mut inside = path.strip_prefix(&self.file).ok()?.components();
            let first = inside.next()?.as_os_str().to_str()?.to_owned();
            inside.next().map(|_| first)
        };
        let folders: BTreeSet<String> = self.files.keys().filter_map(folder_of).collect();
        Ok(folders.into_iter().collect())
    }
}

/// All bytes of a file, where they are at most `limit`. The length is counted while reading, because a
/// device or a pipe has none to ask for.
pub fn read_at_most(path: &Path, limit: u64) -> Result<Vec<u8>, Fault> {
    let unread = |cause: std::io::Error| Fault::damaged(format!("cannot be read: {cause}"));
    let file = File::open(path).map_err(unread)?;
    let length = file.metadata().map_or(0, |there| if there.is_file() { there.len() } else { 0 });
    if length > limit {
        return Err(Limit::new(Quantity::FileBytes, length, 0..=limit).into());
    }
    let mut bytes = Vec::new();
    let no_room = |length: u64| {
        let limit = Limit::new(Quantity::MemoryBytes, length, 0..=length.saturating_sub(1));
        Fault::from(limit.remedy("the process may not have so much; free or allow it more"))
    };
    bytes.try_reserve_exact(length as usize).map_err(|_| no_room(length))?;
    file.take(limit + 1).read_to_end(&mut bytes).map_err(|cause| match cause.kind() {
        ErrorKind::OutOfMemory => no_room(bytes.len() as u64),
        _ => unread(cause),
    })?;
    if bytes.len() as u64 > limit {
        return Err(Limit::new(Quantity::FileBytes, None, 0..=limit).into());
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit_and_no_further() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("ten.tif");
        std::fs::write(&path, [7; 10]).expect("written");
        assert_eq!(read_at_most(&path, 10).expect("within"), [7; 10]);
        let error = read_at_most(&path, 9).expect_err("over").of(&path);
        assert_eq!(error.exit_code(), 5, "{error}");
        let missing = folder.path().join("none.tif");
        let error = read_at_most(&missing, 9).expect_err("missing").of(&missing);
        assert_eq!(error.exit_code(), 4, "{error}");
    }
}

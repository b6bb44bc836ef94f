//! A file system in memory, for a browser: the page keeps what is written, and takes it from [`take_changes`].
//!
//! Relative paths start from [`HOME`]. There is one user and one process, so a lock is always granted, and there are no
//! links. Names, kinds of errors and what happens to open files are as on a Unix system.

mod file;
mod tree;

use std::ffi::OsString;
use std::io;
use std::path::{Component, Path, PathBuf};
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

use web_time::SystemTime;

pub use file::{File, OpenOptions};
use tree::{Content, Entry, Tree};

/// The folder from which relative paths start.
pub const HOME: &str = "/home";

static TREE: LazyLock<Mutex<Tree>> = LazyLock::new(Mutex::default);

/// Each change of the tree is one assignment, so a panic elsewhere leaves it whole.
fn tree() -> MutexGuard<'static, Tree> {
    TREE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What is known of a file or a folder.
#[derive(Clone, Copy, Debug)]
pub struct Metadata {
    length: Option<u64>,
    modified: SystemTime,
}

impl Metadata {
    fn of(entry: &Entry) -> Self {
        Self { length: entry.bytes().map(|bytes| bytes.len() as u64), modified: entry.modified() }
    }

    /// Whether it is a file.
    pub fn is_file(&self) -> bool {
        self.length.is_some()
    }

    /// Whether it is a folder.
    pub fn is_dir(&self) -> bool {
        self.length.is_none()
    }

    /// Bytes of the file; 0 for a folder.
    #[expect(clippy::len_without_is_empty, reason = "as the standard library has it")]
    pub fn len(&self) -> u64 {
        self.length.unwrap_or(0)
    }

    /// When it was last written to.
    ///
    /// # Errors
    /// None.
    pub fn modified(&self) -> io::Result<SystemTime> {
        Ok(self.modified)
    }
}

/// Something in a folder.
#[derive(Clone, Debug)]
pub struct DirEntry {
    path: PathBuf,
}

impl DirEntry {
    /// Its path, which begins with that of the folder.
    pub fn path(&self) -> PathBuf {
        self.path.clone()
    }

    /// Its name in the folder.
    pub fn file_name(&self) -> OsString {
        self.path.file_name().unwrap_or_default().to_owned()
    }

    /// What is known of it.
    ///
    /// # Errors
    /// [`io::ErrorKind::NotFound`] where it is gone.
    pub fn metadata(&self) -> io::Result<Metadata> {
        metadata(&self.path)
    }
}

/// A file that was written, with its bytes, or `None` for one that was removed, since the last call; by paths.
pub fn take_changes() -> Vec<(PathBuf, Option<Vec<u8>>)> {
    tree().take_changes()
}

/// Counts all files as changed, for another process that has none.
pub fn mark_all_changed() {
    tree().mark_all_changed();
}

/// Takes over changes that another process has made: they are none of this one.
pub fn take_over(changes: Vec<(PathBuf, Option<Vec<u8>>)>) {
    let mut tree = tree();
    for (path, bytes) in changes {
        tree.take_over(&path, bytes);
    }
}

/// All bytes of a file.
///
/// # Errors
/// As [`File::open`].
pub fn read(path: impl AsRef<Path>) -> io::Result<Vec<u8>> {
    tree().bytes(&absolute(path.as_ref())?)
}

/// All text of a file.
///
/// # Errors
/// As [`File::open`], and [`io::ErrorKind::InvalidData`] for what is no UTF-8.
pub fn read_to_string(path: impl AsRef<Path>) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|cause| io::Error::new(io::ErrorKind::InvalidData, cause))
}

/// Writes a file whole.
///
/// # Errors
/// As [`File::create`].
pub fn write(path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    tree().put(&absolute(path.as_ref())?, Content::file(bytes.as_ref().to_vec()))
}

/// Makes a folder and those in which it lies, where they are not there.
///
/// # Errors
/// [`io::ErrorKind::NotADirectory`] where one of them is a file.
pub fn create_dir_all(path: impl AsRef<Path>) -> io::Result<()> {
    tree().make_folders(&absolute(path.as_ref())?)
}

/// What lies in a folder.
///
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is none.
pub fn read_dir(path: impl AsRef<Path>) -> io::Result<std::vec::IntoIter<io::Result<DirEntry>>> {
    let given = path.as_ref();
    let names = tree().names_in(&absolute(given)?)?;
    let entries: Vec<_> = names.into_iter().map(|name| Ok(DirEntry { path: given.join(name) })).collect();
    Ok(entries.into_iter())
}

/// What is known of a file or a folder.
///
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is none.
pub fn metadata(path: impl AsRef<Path>) -> io::Result<Metadata> {
    let path = absolute(path.as_ref())?;
    tree().entry(&path).map(Metadata::of)
}

/// Removes a file.
///
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is none, [`io::ErrorKind::IsADirectory`] for a folder.
pub fn remove_file(path: impl AsRef<Path>) -> io::Result<()> {
    tree().remove_file(&absolute(path.as_ref())?)
}

/// Removes an empty folder.
///
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is none, [`io::ErrorKind::DirectoryNotEmpty`].
pub fn remove_dir(path: impl AsRef<Path>) -> io::Result<()> {
    let path = absolute(path.as_ref())?;
    let mut tree = tree();
    if !tree.names_in(&path)?.is_empty() {
        return Err(io::ErrorKind::DirectoryNotEmpty.into());
    }
    tree.remove_folder(&path);
    Ok(())
}

/// Removes a folder with all that is in it.
///
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is none.
pub fn remove_dir_all(path: impl AsRef<Path>) -> io::Result<()> {
    let path = absolute(path.as_ref())?;
    let mut tree = tree();
    tree.names_in(&path)?;
    tree.remove_folder(&path);
    Ok(())
}

/// Gives a file or a folder another name, in place of a file that has it.
///
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is nothing of the first name.
pub fn rename(from: impl AsRef<Path>, to: impl AsRef<Path>) -> io::Result<()> {
    let (from, to) = (absolute(from.as_ref())?, absolute(to.as_ref())?);
    tree().rename(&from, &to)
}

/// Whether there is something of that name.
pub fn exists(path: &Path) -> bool {
    metadata(path).is_ok()
}

/// Whether it is a file.
pub fn is_file(path: &Path) -> bool {
    metadata(path).is_ok_and(|about| about.is_file())
}

/// Whether it is a folder.
pub fn is_dir(path: &Path) -> bool {
    metadata(path).is_ok_and(|about| about.is_dir())
}

/// The path from the root, without `.` and `..`.
///
/// # Errors
/// [`io::ErrorKind::InvalidInput`] for an empty path.
pub fn absolute(path: &Path) -> io::Result<PathBuf> {
    if path.as_os_str().is_empty() {
        return Err(io::ErrorKind::InvalidInput.into());
    }
    let mut whole = PathBuf::from("/");
    // What is absolute takes the place of what is before it.
    for part in Path::new(HOME).join(path).components() {
        match part {
            Component::Normal(name) => whole.push(name),
            Component::ParentDir => drop(whole.pop()),
            Component::RootDir | Component::CurDir | Component::Prefix(_) => {}
        }
    }
    Ok(whole)
}

/// The path from the root.
///
/// # Errors
/// [`io::ErrorKind::NotFound`] where there is nothing of that name.
pub fn canonicalize(path: &Path) -> io::Result<PathBuf> {
    let path = absolute(path)?;
    tree().entry(&path).map(|_| path.clone())
}

/// The folder from which relative paths start.
pub fn current_dir() -> PathBuf {
    PathBuf::from(HOME)
}

/// The number of this process among those that may write into the same folders: there is one.
pub fn process_id() -> u32 {
    1
}

#[cfg(test)]
mod tests;

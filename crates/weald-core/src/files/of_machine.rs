//! The file system of the machine.

use std::path::{Path, PathBuf};

pub use std::fs::{
    File, Metadata, create_dir_all, metadata, read, read_dir, read_to_string, remove_dir, remove_dir_all,
    remove_file, rename, write,
};

/// Whether there is something of that name.
pub fn exists(path: &Path) -> bool {
    path.exists()
}

/// Whether it is a file.
pub fn is_file(path: &Path) -> bool {
    path.is_file()
}

/// Whether it is a folder.
pub fn is_dir(path: &Path) -> bool {
    path.is_dir()
}

/// The path from the root.
///
/// # Errors
/// Those of the system, for an empty path and where the current folder is gone.
pub fn absolute(path: &Path) -> std::io::Result<PathBuf> {
    std::path::absolute(path)
}

/// The path from the root without links.
///
/// # Errors
/// Those of the system, where there is nothing of that name.
pub fn canonicalize(path: &Path) -> std::io::Result<PathBuf> {
    path.canonicalize()
}

/// The folder from which relative paths start.
pub fn current_dir() -> PathBuf {
    std::env::current_dir().unwrap_or_default()
}

/// The number of this process among those that may write into the same folders.
pub fn process_id() -> u32 {
    std::process::id()
}

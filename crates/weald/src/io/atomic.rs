//! Files that are whole or not there.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::error::Error;

/// Writes `bytes` under a temporary name beside `path`, syncs, and renames. On failure the temporary file is
/// removed and an older file under `path` stays as it was.
///
/// # Errors
/// [`Error::Run`] naming the file and the cause.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    write_whole_with(path, |file| file.write_all(bytes))
}

/// As [`write_whole`], for a file that is too large to stand in memory a second time.
///
/// # Errors
/// As [`write_whole`].
pub fn write_whole_with(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
) -> Result<(), Error> {
    let temporary = temporary_name(path);
    let written = write_and_sync(&temporary, write).and_then(|()| std::fs::rename(&temporary, path));
    written.map_err(|cause| {
        // The write has failed already; that the leftover cannot be removed either adds nothing.
        let _ = std::fs::remove_file(&temporary);
        Error::write(path, &cause)
    })
}

fn write_and_sync(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
) -> std::io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    write(&mut file)?;
    file.into_inner().map_err(std::io::IntoInnerError::into_error)?.sync_all()
}

fn temporary_name(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.tmp-weald", std::process::id()));
    path.with_file_name(name)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    /// `/dev/full` refuses every byte as a full disk does; a link puts it in the temporary file's place.
    #[test]
    fn a_full_disk_leaves_no_half_file_and_keeps_the_old_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("height.tif");
        std::fs::write(&path, "old").expect("written");
        std::os::unix::fs::symlink("/dev/full", temporary_name(&path)).expect("linked");
        let error = write_whole(&path, b"new").expect_err("no space");
        assert!(error.to_string().contains("height.tif: No space left on device"), "{error}");
        assert_eq!(std::fs::read(&path).expect("kept"), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).expect("lists").count(), 1);
    }
}

//! Files that are whole or not there.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::parts::{Part, PartName, followed};
use weald_core::error::Error;

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

/// Has another program write a file: it gets the temporary name.
///
/// # Errors
/// As [`write_whole`], and those of `write`.
pub fn write_through(path: &Path, write: impl FnOnce(&Path) -> Result<(), Error>) -> Result<(), Error> {
    let temporary = temporary_name(path);
    let renamed = || std::fs::rename(&temporary, path).map_err(|cause| Error::write(path, &cause));
    write(&temporary).and_then(|()| renamed()).inspect_err(|_| {
        // The write has failed already; that there may be no leftover to remove adds nothing.
        let _ = std::fs::remove_file(&temporary);
    })
}

/// Writes all files of a raster or an export: none of them has its name before all of them are whole. Parts
/// in a folder replace an older folder of that name.
///
/// # Errors
/// As [`write_whole`]; names are those of the parts.
pub fn write_parts(path: &Path, parts: &[Part]) -> Result<(), Error> {
    if parts.iter().any(|part| matches!(part.name, PartName::Inside(_))) {
        return write_folder(path, parts);
    }
    let named: Vec<_> = parts.iter().map(|part| (part.name.path(path), &part.bytes)).collect();
    let discard = |error| {
        // What failed is reported; that a leftover cannot be removed either adds nothing.
        for (path, _) in &named {
            let _ = std::fs::remove_file(temporary_name(path));
        }
        error
    };
    for (path, bytes) in &named {
        let written = write_and_sync(&temporary_name(path), |file| file.write_all(bytes));
        written.map_err(|cause| discard(Error::write(path, &cause)))?;
    }
    // The file itself comes last, so that whoever sees it finds what lies beside it.
    for (path, _) in named.iter().rev() {
        std::fs::rename(temporary_name(path), path).map_err(|cause| discard(Error::write(path, &cause)))?;
    }
    Ok(())
}

/// Writes a folder under a temporary name and puts it in the place of the older one.
fn write_folder(path: &Path, parts: &[Part]) -> Result<(), Error> {
    if path.is_dir() && !parts.iter().any(|part| part.name.path(path).exists()) {
        let path = path.display();
        let message =
            format!("cannot write {path}: the folder there holds other things; remove or rename it");
        return Err(Error::Run(message));
    }
    let (fresh, stale) = (temporary_name(path), temporary_name(&followed(path, ".old")));
    let swapped = fill(&fresh, parts).and_then(|()| {
        if path.exists() {
            std::fs::rename(path, &stale)?;
        }
        std::fs::rename(&fresh, path)
    });
    // Both are leftovers by now; that one of them is not there is the usual case.
    let _ = std::fs::remove_dir_all(&fresh);
    swapped.map_err(|cause| Error::write(path, &cause))?;
    let _ = std::fs::remove_dir_all(&stale);
    Ok(())
}

fn fill(folder: &Path, parts: &[Part]) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    for part in parts {
        let path = part.name.path(folder);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent)?;
        }
        write_and_sync(&path, |file| file.write_all(&part.bytes))?;
    }
    Ok(())
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

    #[test]
    fn a_failed_part_leaves_none_of_the_others() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("height.raw");
        let side = folder.path().join("height.raw.json");
        std::os::unix::fs::symlink("/dev/full", temporary_name(&side)).expect("linked");
        let error =
            write_parts(&path, &[Part::own(b"heights".to_vec()), Part::beside(".json", b"{}".to_vec())])
                .expect_err("no space");
        assert!(error.to_string().contains("height.raw.json: No space left on device"), "{error}");
        assert_eq!(std::fs::read_dir(folder.path()).expect("lists").count(), 0);
    }

    #[test]
    fn a_folder_of_other_things_is_left_alone() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("height.zarr");
        std::fs::create_dir(&path).expect("made");
        std::fs::write(path.join("letters.txt"), "dear").expect("written");
        let error = write_parts(&path, &[Part::inside("zarr.json", b"{}".to_vec())]).expect_err("taken");
        assert!(error.to_string().contains("holds other things"), "{error}");
        assert_eq!(std::fs::read(path.join("letters.txt")).expect("kept"), b"dear");
    }

    #[test]
    fn a_folder_takes_the_place_of_the_older_one_with_all_it_held() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("height.zarr");
        let part = |name, bytes: &[u8]| Part::inside(name, bytes.to_vec());
        write_parts(&path, &[part("c/0/0", b"old"), part("c/0/1", b"old")]).expect("written");
        write_parts(&path, &[part("c/0/0", b"new")]).expect("written");
        assert_eq!(std::fs::read(path.join("c/0/0")).expect("there"), b"new");
        assert!(!path.join("c/0/1").exists());
        assert_eq!(std::fs::read_dir(folder.path()).expect("lists").count(), 1);
    }
}

//! Files that are whole or not there.

use std::collections::BTreeSet;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use super::parts::{Part, PartName, followed};
use weald_core::error::Error;
use weald_core::files::{self, File};

/// How names of temporary files end, behind the number of the process that writes.
const TEMPORARY: &str = ".tmp-weald";

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
    let written = write_and_sync(&temporary, write).and_then(|()| rename(&temporary, path));
    written.map_err(|cause| {
        // The write has failed already; that the leftover cannot be removed either adds nothing.
        let _ = files::remove_file(&temporary);
        Error::write(path, &cause)
    })
}

/// Has another program write a file: it gets the temporary name.
///
/// # Errors
/// As [`write_whole`], and those of `write`.
pub fn write_through(path: &Path, write: impl FnOnce(&Path) -> Result<(), Error>) -> Result<(), Error> {
    let temporary = temporary_name(path);
    // The other program has closed its file, and may have left the bytes to the system.
    let synced = || File::options().write(true).open(&temporary)?.sync_all();
    let renamed =
        || synced().and_then(|()| rename(&temporary, path)).map_err(|cause| Error::write(path, &cause));
    write(&temporary).and_then(|()| renamed()).inspect_err(|_| {
        // The write has failed already; that there may be no leftover to remove adds nothing.
        let _ = files::remove_file(&temporary);
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
            let _ = files::remove_file(temporary_name(path));
        }
        error
    };
    for (path, bytes) in &named {
        let written = write_and_sync(&temporary_name(path), |file| file.write_all(bytes));
        written.map_err(|cause| discard(Error::write(path, &cause)))?;
    }
    // The file itself comes last, so that whoever sees it finds what lies beside it.
    for (path, _) in named.iter().rev() {
        rename(&temporary_name(path), path).map_err(|cause| discard(Error::write(path, &cause)))?;
    }
    Ok(())
}

/// Writes a folder under a temporary name and puts it in the place of the older one.
fn write_folder(path: &Path, parts: &[Part]) -> Result<(), Error> {
    if files::is_dir(path) && !parts.iter().any(|part| files::exists(&part.name.path(path))) {
        let path = path.display();
        let message =
            format!("cannot write {path}: the folder there holds other things; remove or rename it");
        return Err(Error::Run(message));
    }
    let (fresh, stale) = (temporary_name(path), temporary_name(&followed(path, ".old")));
    let swapped = fill(&fresh, parts).and_then(|()| replace_folder(&fresh, path, &stale));
    // Both are leftovers by now; that one of them is not there is the usual case.
    let _ = files::remove_dir_all(&fresh);
    swapped.map_err(|cause| Error::write(path, &cause))?;
    let _ = files::remove_dir_all(&stale);
    Ok(())
}

/// Gives a folder the name of an older one, which has the name `stale` then. Where the system can exchange two names, there
/// is a folder of that name at every moment.
///
/// # Errors
/// Those of the file system.
pub fn replace_folder(fresh: &Path, path: &Path, stale: &Path) -> std::io::Result<()> {
    if !files::exists(path) {
        return rename(fresh, path);
    }
    if exchange(fresh, path).is_ok() {
        rename(fresh, stale)?;
        return sync_folder_of(path);
    }
    files::rename(path, stale)?;
    rename(fresh, path)
}

#[cfg(target_os = "linux")]
fn exchange(one: &Path, other: &Path) -> std::io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE)?)
}

#[cfg(not(target_os = "linux"))]
fn exchange(_: &Path, _: &Path) -> std::io::Result<()> {
    Err(std::io::ErrorKind::Unsupported.into())
}

/// Gives a file another name, which is on disk when this returns.
///
/// # Errors
/// Those of the file system.
pub fn rename(from: &Path, to: &Path) -> std::io::Result<()> {
    files::rename(from, to)?;
    sync_folder_of(to)
}

/// Makes a folder and those in which it lies, where they are not there: their names are on disk when this returns.
///
/// # Errors
/// Those of the file system.
pub fn make_folders(path: &Path) -> std::io::Result<()> {
    let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !files::exists(folder);
    let made: Vec<_> = path.ancestors().take_while(is_missing).collect();
    files::create_dir_all(path)?;
    made.into_iter().rev().try_for_each(sync_folder_of)
}

fn sync_folder_of(path: &Path) -> std::io::Result<()> {
    sync_folder(path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new(".")))
}

/// Brings the names in a folder to disk: a power cut could undo a rename that is only in memory.
#[cfg(unix)]
fn sync_folder(folder: &Path) -> std::io::Result<()> {
    use std::io::ErrorKind::{InvalidInput, Unsupported};
    match File::open(folder)?.sync_all() {
        // Some file systems of networks cannot, and keep names by themselves.
        Err(cause) if [InvalidInput, Unsupported].contains(&cause.kind()) => Ok(()),
        other => other,
    }
}

/// Other systems have no such call.
#[cfg(not(unix))]
#[expect(clippy::unnecessary_wraps, reason = "as where there is one")]
fn sync_folder(_: &Path) -> std::io::Result<()> {
    Ok(())
}

/// Removes temporary files of programs that were killed while they wrote into a folder, and gives their names.
pub fn remove_leftovers(folder: &Path) -> Vec<PathBuf> {
    let entries = files::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let left: Vec<_> = entries.filter(|path| is_leftover(path)).collect();
    // What cannot be removed is in nobody's way.
    let removed = |path: &PathBuf| {
        if files::is_dir(path) { files::remove_dir_all(path) } else { files::remove_file(path) }.is_ok()
    };
    left.into_iter().filter(removed).collect()
}

/// Whether a name is that of a temporary file whose writer is no more.
fn is_leftover(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let writer = name.strip_suffix(TEMPORARY).and_then(|name| name.rsplit_once('.'));
    writer.and_then(|(_, number)| number.parse::<u32>().ok()).is_some_and(|number| is_gone(path, number))
}

#[cfg(target_os = "linux")]
fn is_gone(_: &Path, process: u32) -> bool {
    !Path::new("/proc").join(process.to_string()).exists()
}

/// Elsewhere a file that nobody has written to for an hour has no writer.
#[cfg(not(target_os = "linux"))]
fn is_gone(path: &Path, _: u32) -> bool {
    let changed = files::metadata(path).and_then(|about| about.modified());
    changed.ok().and_then(|at| at.elapsed().ok()).is_some_and(|age| age.as_secs() > 3600)
}

/// Writes files into a folder that others write into as well, and that has no name yet by which anyone knows it: each is on
/// disk when this returns, and has its name from the start.
///
/// # Errors
/// [`Error::Run`] naming the folder and the cause.
pub fn write_into(folder: &Path, parts: &[Part]) -> Result<(), Error> {
    fill(folder, parts).map_err(|cause| Error::write(folder, &cause))
}

fn fill(folder: &Path, parts: &[Part]) -> std::io::Result<()> {
    make_folders(folder)?;
    let mut folders = BTreeSet::new();
    for part in parts {
        let path = part.name.path(folder);
        if let Some(parent) = path.parent() {
            make_folders(parent)?;
            folders.insert(parent.to_owned());
        }
        write_and_sync(&path, |file| file.write_all(&part.bytes))?;
    }
    folders.iter().try_for_each(|folder| sync_folder(folder))
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
    name.push(format!(".{}{TEMPORARY}", files::process_id()));
    path.with_file_name(name)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicBool, Ordering};

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
    fn temporary_files_of_the_dead_are_removed_and_those_of_the_living_are_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let [dead, live] =
            [u32::MAX, std::process::id()].map(|process| format!("h.tif.{process}{TEMPORARY}"));
        for name in [dead.as_str(), live.as_str(), "h.tif"] {
            std::fs::write(folder.path().join(name), "x").expect("written");
        }
        assert_eq!(remove_leftovers(folder.path()), [folder.path().join(&dead)]);
        assert!(folder.path().join(&live).exists() && folder.path().join("h.tif").exists());
    }

    /// Looks at a folder all the time while it is replaced.
    #[test]
    fn a_folder_that_is_replaced_is_there_at_every_moment() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("height.zarr");
        let write = |bytes: &[u8]| write_parts(&path, &[Part::inside("zarr.json", bytes.to_vec())]);
        write(b"old").expect("written");
        let (done, seen) = (AtomicBool::new(false), AtomicBool::new(true));
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while !done.load(Ordering::Relaxed) {
                    seen.fetch_and(path.join("zarr.json").exists(), Ordering::Relaxed);
                }
            });
            for _ in 0..200 {
                write(b"new").expect("written");
            }
            done.store(true, Ordering::Relaxed);
        });
        assert!(seen.into_inner(), "it was gone at a moment");
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

//! The folder `.weald` inside the output folder, in which a run makes its files before it gives all of them their names.
//!
//! It holds `lock`, which the system holds for the one run that may write into the output folder and lets go when that
//! ends, however it ends; `new`, the files under the names that they will have; and `journal.json`, which is there from
//! the moment when all files are whole until all have their names. A run that is killed before leaves the files of the
//! run before it as they were; one that is killed after is finished by the next.

use std::fs::{self, File, TryLockError};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::recipe::REPORT_FILE;
use crate::recipe::plan::WORK_FOLDER;
use weald_core::error::Error;
use weald_io::{rename, replace_folder, write_whole};

const LOCK: &str = "lock";
const NEW: &str = "new";
const OLD: &str = "old";
const JOURNAL: &str = "journal.json";

/// Where a run into a folder makes its files.
pub(super) fn new_files(out: &Path) -> PathBuf {
    out.join(WORK_FOLDER).join(NEW)
}

/// Paths inside the output folder that are about to have their names; the report is the last of them.
#[derive(Debug, Serialize, Deserialize)]
struct Journal {
    files: Vec<PathBuf>,
}

/// An output folder that belongs to this run until it ends.
#[derive(Debug)]
pub(super) struct WorkFolder {
    out: PathBuf,
    /// Held until this is dropped.
    #[expect(dead_code, reason = "the system lets the lock go when the file is closed")]
    lock: File,
    /// Whether what was made so far stays when this is dropped, for a run that goes on from a checkpoint.
    pub(super) keeps: bool,
}

impl WorkFolder {
    /// Takes the folder, and finishes what a killed run began; the texts say what was done.
    ///
    /// # Errors
    /// [`Error::Run`] where another run has it, or where it cannot be written to.
    pub(super) fn take(out: &Path, goes_on: bool) -> Result<(Self, Vec<String>), Error> {
        let lock = locked(out)?;
        let mut this = Self { out: out.to_owned(), lock, keeps: true };
        let notes = this.finish_journal()?;
        if !goes_on {
            this.remove(NEW)?;
        }
        this.remove(OLD)?;
        this.keeps = false;
        Ok((this, notes))
    }

    fn inside(&self, name: &str) -> PathBuf {
        self.out.join(WORK_FOLDER).join(name)
    }

    fn remove(&self, name: &str) -> Result<(), Error> {
        let path = self.inside(name);
        match fs::remove_dir_all(&path) {
            Err(cause) if cause.kind() != std::io::ErrorKind::NotFound => Err(Error::write(&path, &cause)),
            _ => Ok(()),
        }
    }

    /// Gives all files of the run their names, the report last. An older report goes first: who finds a report finds the
    /// files that it names.
    ///
    /// # Errors
    /// [`Error::Run`] where a file cannot get its name; the next run goes on with the journal.
    pub(super) fn publish(&self, mut files: Vec<PathBuf>) -> Result<(), Error> {
        if self.inside(NEW).join(REPORT_FILE).exists() {
            files.push(PathBuf::from(REPORT_FILE));
        }
        let journal = serde_json::to_vec(&Journal { files }).expect("paths are text");
        write_whole(&self.inside(JOURNAL), &journal)?;
        self.finish_journal().map(drop)
    }

    fn finish_journal(&self) -> Result<Vec<String>, Error> {
        let path = self.inside(JOURNAL);
        let Ok(text) = fs::read(&path) else { return Ok(Vec::new()) };
        let journal: Journal = serde_json::from_slice(&text).map_err(|cause| {
            let folder = self.out.join(WORK_FOLDER);
            Error::input(&path, format!("is damaged: {cause}; remove {} and run again", folder.display()))
        })?;
        let report = self.out.join(REPORT_FILE);
        if self.inside(NEW).join(REPORT_FILE).exists() && report.exists() {
            fs::remove_file(&report).map_err(|cause| Error::write(&report, &cause))?;
        }
        for file in &journal.files {
            let target = self.out.join(file);
            self.name(file, &target).map_err(|cause| Error::write(&target, &cause))?;
        }
        fs::remove_file(&path).map_err(|cause| Error::write(&path, &cause))?;
        Ok(vec!["a run that was ended before had all its files whole; they have their names now".to_owned()])
    }

    /// Gives one file its name, unless it has it already.
    fn name(&self, file: &Path, target: &Path) -> std::io::Result<()> {
        let made = self.inside(NEW).join(file);
        if !made.exists() {
            return Ok(());
        }
        if let Some(folder) = target.parent() {
            fs::create_dir_all(folder)?;
        }
        if !made.is_dir() {
            return rename(&made, target);
        }
        let stale = self.inside(OLD).join(file);
        if stale.exists() {
            fs::remove_dir_all(&stale)?;
        }
        fs::create_dir_all(stale.parent().unwrap_or(&self.out))?;
        replace_folder(&made, target, &stale)
    }
}

impl Drop for WorkFolder {
    fn drop(&mut self) {
        let is_finished = !self.inside(JOURNAL).exists();
        // What cannot be removed now is removed by the next run.
        if is_finished && !self.keeps {
            let _ = fs::remove_dir_all(self.inside(NEW));
        }
        if is_finished {
            let _ = fs::remove_dir_all(self.inside(OLD));
        }
        let _ = fs::remove_file(self.inside(LOCK));
        let _ = fs::remove_dir(self.out.join(WORK_FOLDER));
    }
}

/// The lock of an output folder, held.
fn locked(out: &Path) -> Result<File, Error> {
    let folder = out.join(WORK_FOLDER);
    let path = folder.join(LOCK);
    loop {
        fs::create_dir_all(&folder).map_err(|cause| Error::write(out, &cause))?;
        let opened = File::options().read(true).write(true).create(true).truncate(false).open(&path);
        let mut file = match opened {
            // Another run has just ended and taken its folder away.
            Err(cause) if cause.kind() == std::io::ErrorKind::NotFound => continue,
            other => other.map_err(|cause| Error::write(&path, &cause))?,
        };
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(held(out, &mut file)),
            Err(TryLockError::Error(cause)) => return Err(Error::write(&path, &cause)),
        }
        if is_still_there(&file, &path) {
            let holder = format!("process {}", std::process::id());
            let written = file.set_len(0).and_then(|()| file.write_all(holder.as_bytes()));
            written.map_err(|cause| Error::write(&path, &cause))?;
            return Ok(file);
        }
    }
}

fn held(out: &Path, file: &mut File) -> Error {
    let mut holder = String::new();
    // Who holds it may not be readable; that somebody does is what matters.
    let _ = file.take(200).read_to_string(&mut holder);
    let holder = if holder.is_empty() { "another run".to_owned() } else { format!("another run ({holder})") };
    let out = out.display();
    Error::Run(format!("{holder} writes into {out}; wait until it has ended, or choose another --out folder"))
}

/// Whether a file that was locked is the one that has the name: the run that held it may have removed it.
#[cfg(unix)]
fn is_still_there(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |about: &fs::Metadata| (about.dev(), about.ino());
    matches!((file.metadata(), fs::metadata(path)), (Ok(one), Ok(other)) if place(&one) == place(&other))
}

#[cfg(not(unix))]
fn is_still_there(_: &File, path: &Path) -> bool {
    path.exists()
}

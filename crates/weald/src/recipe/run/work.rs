//! The folder `.weald` inside the output folder, in which a run makes its files before it gives all of them their names.
//!
//! It holds `lock`, which the system holds for the one run that may write into the output folder and lets go when that
//! ends, however it ends; a folder of each recipe with its files under the names that they will have; and `journal.json`, which is there from
//! the moment when all files are whole until all have their names. A run that is killed before leaves the files of the
//! run before it as they were; one that is killed after is finished by the next.

use std::fs::TryLockError;
use std::io::{Read, Write};
use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::recipe::checkpoint::remove_stale_parts;
use crate::recipe::plan::{Recipe, WORK_FOLDER};
use crate::recipe::{CHECKPOINT_FILE, REPORT_FILE};
use weald_core::error::Error;
use weald_core::files::{self, File};
use weald_io::{make_folders, rename, replace_folder, write_whole};

const LOCK: &str = "lock";
const OLD: &str = "old";
const JOURNAL: &str = "journal.json";

/// Where a run of this recipe makes its files.
pub(super) fn new_files(out: &Path, recipe: &Recipe) -> PathBuf {
    out.join(WORK_FOLDER).join(&recipe.hash()[..16])
}

/// Paths inside the output folder that are about to have their names; the report is the last of them.
#[derive(Debug, Serialize, Deserialize)]
struct Journal {
    /// Folder in the work folder in which they are.
    made_in: String,
    files: Vec<PathBuf>,
}

impl Journal {
    /// A name that leads out of the folders: whoever sends somebody an output folder must not move files of theirs.
    fn outside(&self) -> Option<&Path> {
        let mut names = self.files.iter().map(PathBuf::as_path).chain([Path::new(&self.made_in)]);
        let is_within = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        names.find(|name| !name.components().all(is_within))
    }
}

/// An output folder that belongs to this run until it ends.
#[derive(Debug)]
pub(super) struct WorkFolder {
    out: PathBuf,
    new: PathBuf,
    /// Held until this is dropped.
    #[expect(dead_code, reason = "the system lets the lock go when the file is closed")]
    lock: File,
    /// What of it is left behind.
    pub(super) leaves: Leaves,
    /// The folder of the run whose files had no names yet, and have them now.
    finished: Option<PathBuf>,
}

/// What a run leaves in the work folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Leaves {
    /// Nothing.
    Nothing,
    /// What belongs to a checkpoint of another recipe.
    Others,
    /// That, and the frames with which a run goes on from its checkpoint.
    Frames,
}

impl WorkFolder {
    /// Takes the folder, and finishes what a killed run began.
    ///
    /// # Errors
    /// [`Error::Run`] where another run has it, or where it cannot be written to.
    pub(super) fn take(out: &Path, recipe: &Recipe) -> Result<Self, Error> {
        let lock = locked(out)?;
        let new = new_files(out, recipe);
        let mut this = Self { out: out.to_owned(), new, lock, leaves: Leaves::Frames, finished: None };
        this.finished = this.finish_journal()?;
        this.remove(OLD)?;
        this.remove_half_written()?;
        // Frames go with a checkpoint; what a fresh run draws of the same recipe are the same frames.
        if !files::exists(&out.join(CHECKPOINT_FILE)) {
            this.remove_all_made()?;
        }
        remove_stale_parts(out)?;
        this.leaves = Leaves::Others;
        Ok(this)
    }

    fn inside(&self, name: &str) -> PathBuf {
        self.out.join(WORK_FOLDER).join(name)
    }

    /// Removes what a run was writing here when it was killed: a journal that was not whole.
    fn remove_half_written(&self) -> Result<(), Error> {
        let folder = self.out.join(WORK_FOLDER);
        let entries = files::read_dir(&folder).map_err(|cause| Error::write(&folder, &cause))?;
        let files =
            entries.flatten().filter(|entry| files::is_file(&entry.path()) && entry.file_name() != LOCK);
        files.into_iter().try_for_each(|entry| {
            files::remove_file(entry.path()).map_err(|cause| Error::write(&entry.path(), &cause))
        })
    }

    /// Removes what runs made that did not come to their ends.
    fn remove_all_made(&self) -> Result<(), Error> {
        let folder = self.out.join(WORK_FOLDER);
        let entries = files::read_dir(&folder).map_err(|cause| Error::write(&folder, &cause))?;
        let folders = entries.flatten().filter(|entry| files::is_dir(&entry.path()));
        folders.into_iter().try_for_each(|entry| self.remove(&entry.file_name().to_string_lossy()))
    }

    fn remove(&self, name: &str) -> Result<(), Error> {
        let path = self.inside(name);
        let mut left = Ok(());
        // A program that a killed run had started may put a last file there meanwhile.
        for _ in 0..5 {
            left = match files::remove_dir_all(&path) {
                Err(cause) if cause.kind() != std::io::ErrorKind::NotFound => {
                    Err(Error::write(&path, &cause))
                }
                _ => return Ok(()),
            };
        }
        left
    }

    /// Gives all files of the run their names, the report last. An older report goes first: who finds a report finds the
    /// files that it names.
    ///
    /// # Errors
    /// [`Error::Run`] where a file cannot get its name; the next run goes on with the journal.
    pub(super) fn publish(&self, mut files: Vec<PathBuf>) -> Result<(), Error> {
        if files::exists(&self.new.join(REPORT_FILE)) {
            files.push(PathBuf::from(REPORT_FILE));
        }
        let made_in = self.new.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let journal = serde_json::to_vec(&Journal { made_in, files }).expect("paths are text");
        write_whole(&self.inside(JOURNAL), &journal)?;
        self.finish_journal().map(drop)
    }

    /// Whether the run that was finished is of the same recipe.
    pub(super) fn has_finished_this(&self) -> bool {
        self.finished.as_ref() == Some(&self.new)
    }

    /// What there is to say of an earlier run.
    pub(super) fn note(&self) -> Option<String> {
        let note = "a run that was ended before had all its files whole; they have their names now";
        self.finished.as_ref().map(|_| note.to_owned())
    }

    /// Gives files their names, and takes away the checkpoint with which their run could have gone on.
    fn finish_journal(&self) -> Result<Option<PathBuf>, Error> {
        let path = self.inside(JOURNAL);
        let Ok(text) = files::read(&path) else { return Ok(None) };
        let damaged = |cause: String| {
            let folder = self.out.join(WORK_FOLDER);
            Error::input(&path, format!("is damaged: {cause}; remove {} and run again", folder.display()))
        };
        let journal: Journal = serde_json::from_slice(&text).map_err(|cause| damaged(cause.to_string()))?;
        if let Some(outside) = journal.outside() {
            return Err(damaged(format!("{} is no name within this folder", outside.display())));
        }
        let (made, report) = (self.inside(&journal.made_in), self.out.join(REPORT_FILE));
        if files::exists(&made.join(REPORT_FILE)) && files::exists(&report) {
            files::remove_file(&report).map_err(|cause| Error::write(&report, &cause))?;
        }
        for file in &journal.files {
            let target = self.out.join(file);
            self.name(&made, file, &target).map_err(|cause| Error::write(&target, &cause))?;
        }
        remove_checkpoint(&self.out.join(CHECKPOINT_FILE))?;
        remove_stale_parts(&self.out)?;
        files::remove_file(&path).map_err(|cause| Error::write(&path, &cause))?;
        Ok(Some(made))
    }

    /// Gives one file its name, unless it has it already.
    fn name(&self, folder: &Path, file: &Path, target: &Path) -> std::io::Result<()> {
        let made = folder.join(file);
        if !files::exists(&made) {
            return Ok(());
        }
        if let Some(folder) = target.parent() {
            make_folders(folder)?;
        }
        if !files::is_dir(&made) {
            return rename(&made, target);
        }
        let stale = self.inside(OLD).join(file);
        if files::exists(&stale) {
            files::remove_dir_all(&stale)?;
        }
        make_folders(stale.parent().unwrap_or(&self.out))?;
        replace_folder(&made, target, &stale)
    }
}

impl Drop for WorkFolder {
    /// What cannot be removed now is removed by the next run.
    fn drop(&mut self) {
        let is_finished = !files::exists(&self.inside(JOURNAL));
        let _ = match self.leaves {
            Leaves::Nothing if is_finished => self.remove_all_made(),
            Leaves::Others if is_finished => files::remove_dir_all(&self.new).or(Ok(())),
            _ => Ok(()),
        };
        let _ = files::remove_file(self.inside(LOCK));
        let _ = files::remove_dir(self.out.join(WORK_FOLDER));
    }
}

/// Removes the checkpoint of a run that is done.
pub(super) fn remove_checkpoint(path: &Path) -> Result<(), Error> {
    match files::remove_file(path) {
        Err(cause) if cause.kind() != std::io::ErrorKind::NotFound => Err(Error::Run(format!(
            "the run is done, but its checkpoint {} cannot be removed: {cause}",
            path.display()
        ))),
        _ => Ok(()),
    }
}

/// The lock of an output folder, held.
fn locked(out: &Path) -> Result<File, Error> {
    let folder = out.join(WORK_FOLDER);
    let path = folder.join(LOCK);
    loop {
        make_folders(&folder).map_err(|cause| Error::write(out, &cause))?;
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
            let holder = format!("process {}", files::process_id());
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
    let place = |about: &files::Metadata| (about.dev(), about.ino());
    matches!((file.metadata(), files::metadata(path)), (Ok(one), Ok(other)) if place(&one) == place(&other))
}

#[cfg(not(unix))]
fn is_still_there(_: &File, path: &Path) -> bool {
    files::exists(path)
}

//! Results as files of a folder, named by the hash of their text.

use std::path::{Path, PathBuf};
use std::time::Duration;

use web_time::SystemTime;

use super::kept::Kept;
use crate::recipe::checkpoint::{self, State};
use crate::recipe::timings::TIMINGS_FILE;
use weald_core::error::Error;
use weald_core::files;

/// Extension of a result.
const EXTENSION: &str = "weald";

/// Age after which what a killed program left half-written is removed.
const ABANDONED: Duration = Duration::from_hours(1);

fn file(folder: &Path, text: &str) -> PathBuf {
    folder.join(blake3::hash(text.as_bytes()).to_hex().as_str()).with_extension(EXTENSION)
}

/// The result of a text. A file that does not hold it whole is removed, and counts as none.
pub(super) fn read(folder: &Path, text: &str) -> Option<Kept> {
    let path = file(folder, text);
    if !files::exists(&path) {
        return None;
    }
    let Ok(State { landscape: changed, done, mut steps, .. }) = checkpoint::read(&path, text) else {
        // Where it cannot be removed it will be overwritten, or fail again.
        let _ = files::remove_file(&path);
        return None;
    };
    let used = files::File::options().append(true).open(&path);
    // What cannot be marked as used only goes sooner.
    let _ = used.and_then(|file| file.set_modified(SystemTime::now()));
    Some(Kept { changed, whole: done == 1, report: steps.pop()? })
}

/// Writes the result of a text, and removes what was used longest ago until all results take `limit` bytes at most.
pub(super) fn write(folder: &Path, text: &str, kept: &Kept, limit: u64) -> Result<(), Error> {
    files::create_dir_all(folder).map_err(|cause| Error::Run(format!("{}: {cause}", folder.display())))?;
    let state = State {
        landscape: kept.changed.clone(),
        done: usize::from(kept.whole),
        simulation: None,
        steps: vec![kept.report.clone()],
        notes: Vec::new(),
    };
    checkpoint::write(&file(folder, text), text, &state, None)?;
    make_room(folder, limit);
    Ok(())
}

/// What another program removes at the same time is gone all the same.
fn make_room(folder: &Path, limit: u64) {
    let mut results = Vec::new();
    for entry in files::read_dir(folder).into_iter().flatten().flatten() {
        let Ok(about) = entry.metadata() else { continue };
        let used = about.modified().unwrap_or(SystemTime::UNIX_EPOCH);
        let path = entry.path();
        if path.extension().is_some_and(|extension| extension == EXTENSION) {
            results.push((used, about.len(), path));
        } else if !path.ends_with(TIMINGS_FILE)
            && about.is_file()
            && used.elapsed().is_ok_and(|age| age > ABANDONED)
        {
            let _ = files::remove_file(path);
        }
    }
    results.sort();
    let mut all: u64 = results.iter().map(|(_, bytes, _)| bytes).sum();
    for (_, bytes, path) in results {
        if all <= limit {
            break;
        }
        if files::remove_file(path).is_ok() {
            all -= bytes;
        }
    }
}

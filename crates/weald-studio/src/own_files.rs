//! What the program keeps for itself on a machine: names of what was open of late, and landscapes that were not saved when it
//! was killed.

use std::path::{Path, PathBuf};

use weald::files;
use web_time::{SystemTime, UNIX_EPOCH};

/// Most names in the list of what was open of late.
const MOST_RECENT: usize = 12;

/// The folder for it; without one nothing is kept.
#[derive(Clone, Debug, Default)]
pub(crate) struct OwnFiles {
    folder: Option<PathBuf>,
}

impl OwnFiles {
    /// In this folder, or where the system keeps such.
    pub(crate) fn new(folder: Option<PathBuf>) -> Self {
        Self { folder: folder.or_else(usual_folder) }
    }

    fn recent_file(&self) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join("recent.txt"))
    }

    /// What was open of late and is still there, the last first.
    pub(crate) fn recent(&self) -> Vec<PathBuf> {
        let text = self.recent_file().and_then(|file| files::read_to_string(file).ok()).unwrap_or_default();
        text.lines().map(PathBuf::from).filter(|path| files::exists(path)).take(MOST_RECENT).collect()
    }

    /// Remembers that this was open; a list that cannot be written is none.
    pub(crate) fn remember(&self, path: &Path) {
        let (Some(file), Ok(path)) = (self.recent_file(), files::absolute(path)) else { return };
        let others = self.recent().into_iter().filter(|other| *other != path);
        let all: Vec<_> = std::iter::once(path.clone()).chain(others).take(MOST_RECENT).collect();
        let text = all.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join("\n");
        let _ = file.parent().map_or(Ok(()), files::create_dir_all).and_then(|()| files::write(&file, text));
    }

    fn unsaved(&self) -> Option<PathBuf> {
        Some(self.folder.as_ref()?.join("unsaved"))
    }

    /// Folders of landscapes that were not saved, the last first.
    pub(crate) fn left_behind(&self) -> Vec<PathBuf> {
        let Some(Ok(entries)) = self.unsaved().map(files::read_dir) else { return Vec::new() };
        let mut folders: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
        folders.sort();
        folders.reverse();
        folders
    }

    /// A new folder for a landscape that has none; their names are in the order of time.
    pub(crate) fn new_folder(&self) -> Option<PathBuf> {
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let folder = self.unsaved()?.join(format!("{:020}-{}", since.as_millis(), files::process_id()));
        files::create_dir_all(&folder).ok()?;
        Some(folder)
    }
}

/// Where the system keeps such.
#[cfg(not(target_arch = "wasm32"))]
fn usual_folder() -> Option<PathBuf> {
    Some(dirs::state_dir().or_else(dirs::data_local_dir)?.join("weald"))
}

/// Among what the browser keeps.
#[cfg(target_arch = "wasm32")]
#[expect(clippy::unnecessary_wraps, reason = "as where there may be none")]
fn usual_folder() -> Option<PathBuf> {
    Some(files::current_dir().join(".weald"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn what_was_open_is_remembered_once_and_the_last_comes_first() {
        let folder = tempfile::tempdir().expect("a folder");
        let own = OwnFiles::new(Some(folder.path().join("own")));
        assert!(own.recent().is_empty());
        let files = ["a.toml", "b.toml"].map(|name| folder.path().join(name));
        for file in [&files[0], &files[1], &files[0], &folder.path().join("gone.toml")] {
            fs::write(&files[0], "").and_then(|()| fs::write(&files[1], "")).expect("written");
            own.remember(file);
        }
        assert_eq!(own.recent(), files);
    }

    #[test]
    fn folders_of_what_was_not_saved_come_the_last_first() {
        let folder = tempfile::tempdir().expect("a folder");
        let own = OwnFiles::new(Some(folder.path().to_owned()));
        let one = own.new_folder().expect("a folder");
        std::thread::sleep(std::time::Duration::from_millis(5));
        let other = own.new_folder().expect("a folder");
        assert_eq!(own.left_behind(), [other, one]);
        assert!(OwnFiles::default().new_folder().is_none(), "nowhere to keep it");
    }
}

//! Files and folders by their absolute paths.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use web_time::SystemTime;

/// The bytes of a file, which live as long as somebody has it open.
#[derive(Clone, Debug)]
pub(super) struct Content(Arc<Mutex<Written>>);

#[derive(Debug)]
struct Written {
    bytes: Arc<Vec<u8>>,
    modified: SystemTime,
}

impl Content {
    pub(super) fn file(bytes: Vec<u8>) -> Self {
        Self(Arc::new(Mutex::new(Written { bytes: Arc::new(bytes), modified: SystemTime::now() })))
    }

    /// Bytes are replaced whole, so a panic elsewhere leaves them whole.
    fn written(&self) -> MutexGuard<'_, Written> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn bytes(&self) -> Arc<Vec<u8>> {
        Arc::clone(&self.written().bytes)
    }

    pub(super) fn change(&self, change: impl FnOnce(&mut Vec<u8>)) {
        let mut written = self.written();
        change(Arc::make_mut(&mut written.bytes));
        written.modified = SystemTime::now();
    }

    pub(super) fn set_modified(&self, at: SystemTime) {
        self.written().modified = at;
    }
}

/// A file or a folder.
#[derive(Clone, Debug)]
pub(super) enum Entry {
    File(Content),
    Folder(SystemTime),
}

impl Entry {
    pub(super) fn bytes(&self) -> Option<Arc<Vec<u8>>> {
        match self {
            Self::File(content) => Some(content.bytes()),
            Self::Folder(_) => None,
        }
    }

    pub(super) fn modified(&self) -> SystemTime {
        match self {
            Self::File(content) => content.written().modified,
            Self::Folder(made) => *made,
        }
    }
}

/// All of them.
#[derive(Debug, Default)]
pub(super) struct Tree {
    entries: BTreeMap<PathBuf, Entry>,
    /// Files that were written or removed since it was last asked.
    changed: BTreeSet<PathBuf>,
}

impl Tree {
    pub(super) fn entry(&self, path: &Path) -> io::Result<&Entry> {
        self.entries.get(path).ok_or_else(|| ErrorKind::NotFound.into())
    }

    pub(super) fn content(&self, path: &Path) -> io::Result<Content> {
        match self.entry(path)? {
            Entry::File(content) => Ok(content.clone()),
            Entry::Folder(_) => Err(ErrorKind::IsADirectory.into()),
        }
    }

    pub(super) fn bytes(&self, path: &Path) -> io::Result<Vec<u8>> {
        Ok(self.content(path)?.bytes().to_vec())
    }

    /// Puts a file where none or another is, in a folder that is there.
    pub(super) fn put(&mut self, path: &Path, content: Content) -> io::Result<()> {
        let folder = path.parent().ok_or(ErrorKind::IsADirectory)?;
        if folder != Path::new("/") {
            self.ensure_folder(folder)?;
        }
        if matches!(self.entries.get(path), Some(Entry::Folder(_))) {
            return Err(ErrorKind::IsADirectory.into());
        }
        self.entries.insert(path.to_owned(), Entry::File(content));
        self.changed.insert(path.to_owned());
        Ok(())
    }

    /// Notes that a file that is open was written to, where it still has the name.
    pub(super) fn touch(&mut self, path: &Path) {
        if self.entries.contains_key(path) {
            self.changed.insert(path.to_owned());
        }
    }

    fn ensure_folder(&self, path: &Path) -> io::Result<()> {
        match self.entry(path)? {
            Entry::Folder(_) => Ok(()),
            Entry::File(_) => Err(ErrorKind::NotADirectory.into()),
        }
    }

    pub(super) fn make_folders(&mut self, path: &Path) -> io::Result<()> {
        let folders: Vec<_> = path.ancestors().filter(|folder| folder.parent().is_some()).collect();
        for folder in folders.into_iter().rev() {
            match self.entries.get(folder) {
                Some(Entry::Folder(_)) => {}
                Some(Entry::File(_)) => return Err(ErrorKind::NotADirectory.into()),
                None => {
                    self.entries.insert(folder.to_owned(), Entry::Folder(SystemTime::now()));
                }
            }
        }
        Ok(())
    }

    pub(super) fn names_in(&self, path: &Path) -> io::Result<Vec<OsString>> {
        if path != Path::new("/") {
            self.ensure_folder(path)?;
        }
        let inside = self.entries.keys().filter(|other| other.parent() == Some(path));
        Ok(inside.filter_map(|other| Some(other.file_name()?.to_owned())).collect())
    }

    pub(super) fn remove_file(&mut self, path: &Path) -> io::Result<()> {
        self.content(path)?;
        self.entries.remove(path);
        self.changed.insert(path.to_owned());
        Ok(())
    }

    pub(super) fn remove_folder(&mut self, path: &Path) {
        for (path, entry) in self.taken(path) {
            if matches!(entry, Entry::File(_)) {
                self.changed.insert(path);
            }
        }
    }

    /// Takes a file, or a folder with all that is in it, out of the tree.
    fn taken(&mut self, path: &Path) -> Vec<(PathBuf, Entry)> {
        let inside: Vec<_> = self.entries.keys().filter(|other| other.starts_with(path)).cloned().collect();
        inside.into_iter().filter_map(|path| self.entries.remove_entry(&path)).collect()
    }

    pub(super) fn rename(&mut self, from: &Path, to: &Path) -> io::Result<()> {
        self.entry(from)?;
        if to.starts_with(from) {
            return if to == from { Ok(()) } else { Err(ErrorKind::InvalidInput.into()) };
        }
        if let Some(folder) = to.parent().filter(|folder| folder.parent().is_some()) {
            self.ensure_folder(folder)?;
        }
        if matches!(self.entries.get(to), Some(Entry::Folder(_))) && !self.names_in(to)?.is_empty() {
            return Err(ErrorKind::DirectoryNotEmpty.into());
        }
        for (path, entry) in self.taken(from) {
            let inside = path.strip_prefix(from).unwrap_or(Path::new(""));
            let named = if inside.as_os_str().is_empty() { to.to_owned() } else { to.join(inside) };
            if matches!(entry, Entry::File(_)) {
                self.changed.extend([path, named.clone()]);
            }
            self.entries.insert(named, entry);
        }
        Ok(())
    }

    pub(super) fn take_changes(&mut self) -> Vec<(PathBuf, Option<Vec<u8>>)> {
        let changed = std::mem::take(&mut self.changed);
        changed.into_iter().map(|path| (path.clone(), self.bytes(&path).ok())).collect()
    }

    pub(super) fn mark_all_changed(&mut self) {
        let files = self.entries.iter().filter(|(_, entry)| matches!(entry, Entry::File(_)));
        self.changed.extend(files.map(|(path, _)| path.clone()));
    }

    pub(super) fn take_over(&mut self, path: &Path, bytes: Option<Vec<u8>>) {
        let Some(bytes) = bytes else {
            self.entries.remove(path);
            return;
        };
        // A folder in the place of the file, or a file in that of a folder, is of an older state of the other.
        if let Some(folder) = path.parent() {
            let _ = self.make_folders(folder);
        }
        self.entries.insert(path.to_owned(), Entry::File(Content::file(bytes)));
    }
}

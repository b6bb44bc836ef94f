//! An open file.

use std::fs::TryLockError;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use web_time::SystemTime;

use super::tree::{Content, Entry};
use super::{Metadata, absolute, tree};

/// A file that is open. It goes on where another has taken its name.
#[derive(Debug)]
pub struct File {
    path: PathBuf,
    content: Content,
    at: u64,
    appends: bool,
}

/// How a file is to be opened.
#[derive(Clone, Copy, Debug, Default)]
pub struct OpenOptions {
    creates: bool,
    empties: bool,
    appends: bool,
}

impl OpenOptions {
    /// For reading, which every file is open for.
    #[must_use]
    pub fn read(self, _: bool) -> Self {
        self
    }

    /// For writing, which every file is open for.
    #[must_use]
    pub fn write(self, _: bool) -> Self {
        self
    }

    /// Whether it is made where it is not there.
    #[must_use]
    pub fn create(self, creates: bool) -> Self {
        Self { creates, ..self }
    }

    /// Whether it is emptied.
    #[must_use]
    pub fn truncate(self, empties: bool) -> Self {
        Self { empties, ..self }
    }

    /// Whether what is written goes to its end.
    #[must_use]
    pub fn append(self, appends: bool) -> Self {
        Self { appends, ..self }
    }

    /// Opens it.
    ///
    /// # Errors
    /// As [`File::open`], or as [`File::create`] where it is made.
    pub fn open(self, path: impl AsRef<Path>) -> io::Result<File> {
        let path = absolute(path.as_ref())?;
        let there = tree().content(&path);
        let content = match there {
            Err(cause) if cause.kind() == ErrorKind::NotFound && self.creates => {
                let content = Content::file(Vec::new());
                tree().put(&path, content.clone())?;
                content
            }
            there => there?,
        };
        if self.empties {
            content.change(Vec::clear);
            tree().touch(&path);
        }
        Ok(File { path, content, at: 0, appends: self.appends })
    }
}

impl File {
    /// Opens a file that is there.
    ///
    /// # Errors
    /// [`ErrorKind::NotFound`] where it is not, [`ErrorKind::IsADirectory`] for a folder.
    pub fn open(path: impl AsRef<Path>) -> io::Result<Self> {
        Self::options().open(path)
    }

    /// Opens a file that is empty, in a folder that is there.
    ///
    /// # Errors
    /// [`ErrorKind::NotFound`] where the folder is not there, [`ErrorKind::NotADirectory`] where it is a file.
    pub fn create(path: impl AsRef<Path>) -> io::Result<Self> {
        Self::options().create(true).truncate(true).open(path)
    }

    /// How it is to be opened.
    pub fn options() -> OpenOptions {
        OpenOptions::default()
    }

    /// What is known of it.
    ///
    /// # Errors
    /// None.
    pub fn metadata(&self) -> io::Result<Metadata> {
        Ok(Metadata::of(&Entry::File(self.content.clone())))
    }

    /// Memory is in no need of it.
    ///
    /// # Errors
    /// None.
    pub fn sync_all(&self) -> io::Result<()> {
        Ok(())
    }

    /// Nobody else can have it.
    ///
    /// # Errors
    /// None.
    pub fn try_lock(&self) -> Result<(), TryLockError> {
        Ok(())
    }

    /// Cuts it, or fills it with zeros.
    ///
    /// # Errors
    /// None.
    pub fn set_len(&self, length: u64) -> io::Result<()> {
        self.content.change(|bytes| bytes.resize(length as usize, 0));
        tree().touch(&self.path);
        Ok(())
    }

    /// Says when it was written to.
    ///
    /// # Errors
    /// None.
    pub fn set_modified(&self, at: SystemTime) -> io::Result<()> {
        self.content.set_modified(at);
        Ok(())
    }
}

impl Read for File {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let bytes = self.content.bytes();
        let left = bytes.get(self.at as usize..).unwrap_or_default();
        let count = left.len().min(into.len());
        into[..count].copy_from_slice(&left[..count]);
        self.at += count as u64;
        Ok(count)
    }
}

impl Write for File {
    fn write(&mut self, from: &[u8]) -> io::Result<usize> {
        let (at, appends) = (self.at as usize, self.appends);
        let mut end = at;
        self.content.change(|bytes| {
            let at = if appends { bytes.len() } else { at };
            end = at + from.len();
            if bytes.len() < end {
                bytes.resize(end, 0);
            }
            bytes[at..end].copy_from_slice(from);
        });
        self.at = end as u64;
        tree().touch(&self.path);
        Ok(from.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for File {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let length = self.content.bytes().len() as u64;
        let (from, by) = match to {
            SeekFrom::Start(at) => (at, 0),
            SeekFrom::End(by) => (length, by),
            SeekFrom::Current(by) => (self.at, by),
        };
        self.at = from.checked_add_signed(by).ok_or(ErrorKind::InvalidInput)?;
        Ok(self.at)
    }
}

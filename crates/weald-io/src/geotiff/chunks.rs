//! Where the packed chunks of a file come from: its bytes in memory, or the file, of which no more is read than is needed.

use std::borrow::Cow;
use std::io::{Read, Seek, SeekFrom};
use std::sync::{Mutex, PoisonError};

use super::super::Fault;
use super::directory::{Directory, relocated};
use weald_core::files::File;

/// The bytes of a file.
pub(super) trait Chunks: Sync {
    /// Their number.
    fn length(&self) -> u64;

    /// Some of them, which lie within.
    fn bytes(&self, start: u64, length: usize) -> Result<Cow<'_, [u8]>, Fault>;
}

/// A file in memory.
pub(super) struct Whole<'a>(pub(super) &'a [u8]);

impl Chunks for Whole<'_> {
    fn length(&self) -> u64 {
        self.0.len() as u64
    }

    fn bytes(&self, start: u64, length: usize) -> Result<Cow<'_, [u8]>, Fault> {
        ensure_within(self.length(), start, length as u64)?;
        Ok(Cow::Borrowed(&self.0[start as usize..][..length]))
    }
}

/// A file on disk.
#[derive(Debug)]
pub(super) struct OnDisk {
    file: Mutex<File>,
    length: u64,
}

impl OnDisk {
    pub(super) fn open(path: &std::path::Path) -> Result<Self, Fault> {
        let unread = |cause: std::io::Error| Fault::damaged(format!("cannot be read: {cause}"));
        let file = File::open(path).map_err(unread)?;
        let length = file.metadata().map_err(unread)?.len();
        Ok(Self { file: Mutex::new(file), length })
    }

    /// The directories with the values of their tags, as a file of their own, in which the chunks lie where they did.
    pub(super) fn head(&self) -> Result<Vec<u8>, Fault> {
        let head = relocated(&mut |start, length| {
            self.bytes(start, usize::try_from(length).unwrap_or(usize::MAX)).map(Cow::into_owned)
        })?;
        Directory::parse(&head)?;
        Ok(head)
    }
}

impl Chunks for OnDisk {
    fn length(&self) -> u64 {
        self.length
    }

    fn bytes(&self, start: u64, length: usize) -> Result<Cow<'_, [u8]>, Fault> {
        ensure_within(self.length, start, length as u64)?;
        let mut bytes = vec![0; length];
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let read = file.seek(SeekFrom::Start(start)).and_then(|_| file.read_exact(&mut bytes));
        read.map_err(|cause| Fault::damaged(format!("cannot be read: {cause}")))?;
        Ok(Cow::Owned(bytes))
    }
}

/// Whether a file of so many bytes has these.
pub(super) fn ensure_within(file: u64, start: u64, length: u64) -> Result<(), Fault> {
    if start.checked_add(length).is_some_and(|end| end <= file) {
        return Ok(());
    }
    Err(Fault::damaged(format!(
        "{length} bytes from byte {start} on are missing: the file ends at byte {file}; it is truncated or damaged"
    )))
}

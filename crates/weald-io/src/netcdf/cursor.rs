//! Numbers and names of a header, one after the other.

use super::super::Fault;

/// How far a header is read.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Whether counts are of 64 bits.
    is_wide: bool,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8], is_wide: bool) -> Self {
        Self { bytes, at: 4, is_wide }
    }

    pub(super) fn take(&mut self, length: usize) -> Result<&'a [u8], Fault> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let taken = rest.get(..length).ok_or_else(|| {
            Fault::damaged(format!(
                "the header needs {length} bytes at byte {}, but the file ends at byte {}; it is cut off or \
                 damaged",
                self.at,
                self.bytes.len()
            ))
        })?;
        self.at += length;
        Ok(taken)
    }

    /// Bytes that are padded to a multiple of four.
    pub(super) fn padded(&mut self, length: usize) -> Result<&'a [u8], Fault> {
        let taken = self.take(length)?;
        self.take(length.wrapping_neg() % 4)?;
        Ok(taken)
    }

    /// Four bytes: a tag or a type.
    pub(super) fn word(&mut self) -> Result<u32, Fault> {
        self.take(4).map(|bytes| bytes.iter().fold(0, |number, byte| number << 8 | u32::from(*byte)))
    }

    /// Eight bytes.
    pub(super) fn long(&mut self) -> Result<u64, Fault> {
        self.take(8).map(|bytes| bytes.iter().fold(0, |number, byte| number << 8 | u64::from(*byte)))
    }

    /// A count or a length, never below 0.
    pub(super) fn count(&mut self) -> Result<usize, Fault> {
        let count = if self.is_wide { self.long()? as i64 } else { i64::from(self.word()? as i32) };
        usize::try_from(count).map_err(|_| {
            Fault::damaged(format!("the header holds a count of {count} before byte {}", self.at))
        })
    }

    /// A count that is not looked at.
    pub(super) fn pass_count(&mut self) -> Result<(), Fault> {
        self.take(if self.is_wide { 8 } else { 4 }).map(drop)
    }

    pub(super) fn name(&mut self) -> Result<String, Fault> {
        let length = self.count()?;
        Ok(String::from_utf8_lossy(self.padded(length)?).into_owned())
    }

    /// The byte up to which the header is read.
    pub(super) fn at(&self) -> usize {
        self.at
    }
}

//! Numbers as the bytes of messages, little-endian, so that ranks may be machines of any kind.

use weald_core::error::Error;

/// A message in the making.
#[derive(Debug, Default)]
pub struct Writer(pub Vec<u8>);

impl Writer {
    /// Adds a count.
    pub fn count(&mut self, count: usize) {
        self.0.extend((count as u64).to_le_bytes());
    }

    /// Adds counts.
    pub fn counts(&mut self, counts: &[usize]) {
        for &count in counts {
            self.count(count);
        }
    }

    /// Adds numbers of single precision.
    pub fn singles(&mut self, values: &[f32]) {
        let start = self.0.len();
        self.0.resize(start + size_of_val(values), 0);
        for (bytes, value) in self.0[start..].as_chunks_mut().0.iter_mut().zip(values) {
            *bytes = value.to_le_bytes();
        }
    }

    /// Adds numbers of double precision.
    pub fn doubles(&mut self, values: &[f64]) {
        self.0.extend(values.iter().flat_map(|value| value.to_le_bytes()));
    }

    /// Adds words.
    pub fn words(&mut self, words: &[u32]) {
        self.0.extend(words.iter().flat_map(|word| word.to_le_bytes()));
    }
}

/// What is left of a message.
#[derive(Debug)]
pub struct Reader<'a>(pub &'a [u8]);

impl<'a> Reader<'a> {
    fn bytes(&mut self, count: usize) -> Result<&'a [u8], Error> {
        let (bytes, rest) = self.0.split_at_checked(count).ok_or_else(damaged)?;
        self.0 = rest;
        Ok(bytes)
    }

    /// A count.
    ///
    /// # Errors
    /// [`Error::Run`] at the end of the message, as all of these.
    pub fn count(&mut self) -> Result<usize, Error> {
        let bytes = self.bytes(8)?.try_into().map_err(|_| damaged())?;
        Ok(u64::from_le_bytes(bytes) as usize)
    }

    /// Numbers of single precision.
    ///
    /// # Errors
    /// As [`Reader::count`].
    pub fn singles(&mut self, into: &mut [f32]) -> Result<(), Error> {
        let bytes = self.bytes(size_of_val(into))?.as_chunks().0;
        into.iter_mut().zip(bytes).for_each(|(value, bytes)| *value = f32::from_le_bytes(*bytes));
        Ok(())
    }

    /// Numbers of double precision.
    ///
    /// # Errors
    /// As [`Reader::count`].
    pub fn doubles(&mut self, into: &mut [f64]) -> Result<(), Error> {
        let bytes = self.bytes(size_of_val(into))?.as_chunks().0;
        into.iter_mut().zip(bytes).for_each(|(value, bytes)| *value = f64::from_le_bytes(*bytes));
        Ok(())
    }

    /// Whether nothing is left.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// So many words.
    ///
    /// # Errors
    /// As [`Reader::count`].
    pub fn words(&mut self, count: usize) -> Result<Vec<u32>, Error> {
        let bytes = self.bytes(count.checked_mul(4).ok_or_else(damaged)?)?.as_chunks().0;
        Ok(bytes.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect())
    }
}

/// A message that is not what this rank expects.
pub(super) fn damaged() -> Error {
    let message = "a message from another rank cannot be read: all ranks must run the same build of Weald";
    Error::Run(message.to_owned())
}

//! Numbers to and from a file, little-endian, hashed on their way.

use std::io::{BufReader, Read, Write};
use std::path::Path;

use weald_core::files::File;

pub(super) const HASH_BYTES: u64 = 32;

/// Numbers that are turned into bytes at a time.
const CHUNK: usize = 1 << 14;

/// Writes and hashes.
pub(super) struct HashedWriter<W> {
    inner: W,
    hasher: blake3::Hasher,
}

impl<W: Write> HashedWriter<W> {
    pub(super) fn new(inner: W) -> Self {
        Self { inner, hasher: blake3::Hasher::new() }
    }

    pub(super) fn bytes(&mut self, bytes: &[u8]) -> std::io::Result<()> {
        self.hasher.update(bytes);
        self.inner.write_all(bytes)
    }

    pub(super) fn flags(&mut self, flags: &[bool]) -> std::io::Result<()> {
        self.in_chunks(flags, |&flag| [u8::from(flag)])
    }

    pub(super) fn singles(&mut self, numbers: &[f32]) -> std::io::Result<()> {
        self.in_chunks(numbers, |number| number.to_le_bytes())
    }

    pub(super) fn doubles(&mut self, numbers: &[f64]) -> std::io::Result<()> {
        self.in_chunks(numbers, |number| number.to_le_bytes())
    }

    /// Items, each as so many bytes.
    pub(super) fn in_chunks<T, const N: usize>(
        &mut self,
        items: &[T],
        to_bytes: impl Fn(&T) -> [u8; N],
    ) -> std::io::Result<()> {
        items.chunks(CHUNK).try_for_each(|chunk| {
            let bytes: Vec<u8> = chunk.iter().flat_map(&to_bytes).collect();
            self.bytes(&bytes)
        })
    }

    /// The hash of all that was written.
    pub(super) fn hash(&self) -> blake3::Hash {
        self.hasher.finalize()
    }

    /// Appends the hash of all that was written.
    pub(super) fn finish(mut self) -> std::io::Result<()> {
        self.inner.write_all(self.hasher.finalize().as_bytes())
    }
}

/// Reads and hashes, and never asks for memory beyond what the file holds.
pub(super) struct HashedReader<'a> {
    inner: Box<dyn Read + 'a>,
    hasher: blake3::Hasher,
    left: u64,
}

impl<'a> HashedReader<'a> {
    pub(super) fn open(path: &Path) -> std::io::Result<Self> {
        let file = File::open(path)?;
        let left = file.metadata()?.len();
        Ok(Self { inner: Box::new(BufReader::new(file)), hasher: blake3::Hasher::new(), left })
    }

    pub(super) fn of_bytes(bytes: &'a [u8]) -> Self {
        Self { inner: Box::new(bytes), hasher: blake3::Hasher::new(), left: bytes.len() as u64 }
    }

    /// Bytes that were not read yet.
    pub(super) fn left(&self) -> u64 {
        self.left
    }

    pub(super) fn bytes(&mut self, count: usize) -> Result<Vec<u8>, String> {
        if count as u64 > self.left {
            return Err(format!("ends early: {count} bytes are missing from its last {}", self.left));
        }
        let mut bytes = vec![0; count];
        self.inner.read_exact(&mut bytes).map_err(|cause| format!("cannot be read: {cause}"))?;
        self.left -= count as u64;
        self.hasher.update(&bytes);
        Ok(bytes)
    }

    pub(super) fn flags(&mut self, count: usize) -> Result<Vec<bool>, String> {
        self.in_chunks(count, |[byte]: [u8; 1]| byte != 0)
    }

    pub(super) fn singles(&mut self, count: usize) -> Result<Vec<f32>, String> {
        self.in_chunks(count, f32::from_le_bytes)
    }

    pub(super) fn doubles(&mut self, count: usize) -> Result<Vec<f64>, String> {
        self.in_chunks(count, f64::from_le_bytes)
    }

    /// So many items, each of so many bytes.
    pub(super) fn in_chunks<T, const N: usize>(
        &mut self,
        count: usize,
        from_bytes: impl Fn([u8; N]) -> T,
    ) -> Result<Vec<T>, String> {
        if (count as u64).saturating_mul(N as u64) > self.left {
            return Err(format!("ends early: {count} numbers do not fit into its last {} bytes", self.left));
        }
        let mut items = Vec::with_capacity(count);
        while items.len() < count {
            let bytes = self.bytes(N * CHUNK.min(count - items.len()))?;
            items.extend(bytes.as_chunks().0.iter().map(|&chunk| from_bytes(chunk)));
        }
        Ok(items)
    }

    /// The hash of all that was read.
    pub(super) fn hash(&self) -> blake3::Hash {
        self.hasher.finalize()
    }

    /// Compares the hash at the end of the file with that of all that was read.
    pub(super) fn finish(mut self) -> Result<(), String> {
        let hash = self.hasher.finalize();
        let kept = self.bytes(HASH_BYTES as usize)?;
        if kept != hash.as_bytes() {
            return Err("is damaged: its hash is not that of its content".to_owned());
        }
        Ok(())
    }
}

//! The start of a file that is written: its header and the directories of its images, as TIFF or `BigTIFF`.
//!
//! Places in a file are 32 bits wide in TIFF (Adobe 1992, revision 6.0), which so ends at 4 GiB, and 64 bits in `BigTIFF`
//! (Aware Systems 2007). Which of the two a file is depends on the number of its tiles alone and not on how well they pack, so
//! that it is known before the first of them is.

use super::directory::tag;
use super::tiles::{Samples, TILE};
use weald_core::error::Error;

/// An image of a file.
pub(super) struct Image {
    /// All tags but those that place the tiles.
    pub(super) tags: Vec<Entry>,
    /// Bytes of each tile.
    pub(super) lengths: Vec<u64>,
}

/// A tag with its values in little-endian order.
#[derive(Clone)]
pub(super) struct Entry {
    tag: u16,
    kind: u16,
    count: usize,
    values: Vec<u8>,
}

impl Entry {
    pub(super) fn shorts(tag: u16, numbers: &[u16]) -> Self {
        let values = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        Self { tag, kind: 3, count: numbers.len(), values }
    }

    pub(super) fn longs(tag: u16, numbers: &[u32]) -> Self {
        let values = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        Self { tag, kind: 4, count: numbers.len(), values }
    }

    fn long_longs(tag: u16, numbers: &[u64]) -> Self {
        let values = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        Self { tag, kind: 16, count: numbers.len(), values }
    }

    pub(super) fn doubles(tag: u16, numbers: &[f64]) -> Self {
        let values = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        Self { tag, kind: 12, count: numbers.len(), values }
    }

    pub(super) fn text(tag: u16, text: &str) -> Self {
        let values: Vec<u8> = text.bytes().chain([0]).collect();
        Self { tag, kind: 2, count: values.len(), values }
    }
}

/// How wide the places of a file are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Variant {
    Tiff,
    BigTiff,
}

impl Variant {
    /// What surely holds so many tiles.
    pub(super) fn holding(tiles: usize, samples: Samples) -> Self {
        let tile = (TILE * TILE * usize::from(samples.bits() / 8)) as u64;
        // What Deflate cannot pack becomes less than a hundredth longer, and each tile has two places in a directory.
        let longest = tiles as u64 * (tile + tile / 100 + 16) + (1 << 20);
        if longest > u64::from(u32::MAX) { Self::BigTiff } else { Self::Tiff }
    }

    /// Bytes of the header and of all directories, with the values of their tags.
    pub(super) fn length(self, images: &[Image]) -> usize {
        self.header().len() + images.iter().map(|image| self.directory_length(image)).sum::<usize>()
    }

    /// Header and directories of images whose tiles have these lengths.
    ///
    /// # Errors
    /// [`Error::Run`] where places are too narrow for the tiles.
    pub(super) fn directories(self, images: &[Image]) -> Result<Vec<u8>, Error> {
        let mut next = self.length(images) as u64;
        let mut placed = Vec::with_capacity(images.len());
        for image in images.iter().rev() {
            placed.push(self.placed(image, next)?);
            next += image.lengths.iter().sum::<u64>();
        }
        let mut bytes = self.header().to_vec();
        for (number, tags) in placed.iter().rev().enumerate() {
            let is_last = number + 1 == images.len();
            bytes.extend(self.directory(tags, bytes.len(), is_last));
        }
        Ok(bytes)
    }

    /// Little-endian; the first directory follows.
    fn header(self) -> &'static [u8] {
        match self {
            Self::Tiff => b"II\x2a\0\x08\0\0\0",
            Self::BigTiff => b"II\x2b\0\x08\0\0\0\x10\0\0\0\0\0\0\0",
        }
    }

    /// Bytes of a place, and of the count of a tag's values.
    fn place(self) -> usize {
        match self {
            Self::Tiff => 4,
            Self::BigTiff => 8,
        }
    }

    /// Bytes of the number of tags of a directory.
    fn tag_count(self) -> usize {
        match self {
            Self::Tiff => 2,
            Self::BigTiff => 8,
        }
    }

    /// All tags of an image in their order, with its tiles from a place of the file on.
    fn placed(self, image: &Image, mut next: u64) -> Result<Vec<Entry>, Error> {
        let mut offsets = Vec::with_capacity(image.lengths.len());
        for length in &image.lengths {
            offsets.push(next);
            next += length;
        }
        let mut tags = image.tags.clone();
        tags.push(Entry::longs(tag::TILE_BYTE_COUNTS, &narrow(&image.lengths)?));
        tags.push(match self {
            Self::Tiff => Entry::longs(tag::TILE_OFFSETS, &narrow(&offsets)?),
            Self::BigTiff => Entry::long_longs(tag::TILE_OFFSETS, &offsets),
        });
        tags.sort_by_key(|entry| entry.tag);
        Ok(tags)
    }

    fn directory_length(self, image: &Image) -> usize {
        let count = image.lengths.len();
        let lengths = Entry::longs(tag::TILE_BYTE_COUNTS, &vec![0; count]);
        let offsets = match self {
            Self::Tiff => Entry::longs(tag::TILE_OFFSETS, &vec![0; count]),
            Self::BigTiff => Entry::long_longs(tag::TILE_OFFSETS, &vec![0; count]),
        };
        self.length_of(image.tags.iter().chain([&lengths, &offsets]))
    }

    /// Bytes of a directory of these tags, and of the values behind it.
    fn length_of<'a>(self, tags: impl Iterator<Item = &'a Entry>) -> usize {
        let table: usize = tags.map(|tag| 4 + 2 * self.place() + self.outside_length(tag)).sum();
        self.tag_count() + table + self.place()
    }

    /// Bytes that a tag takes behind the directory: none where its values fit in the directory itself.
    fn outside_length(self, entry: &Entry) -> usize {
        if entry.values.len() <= self.place() { 0 } else { entry.values.len().next_multiple_of(2) }
    }

    /// The low bytes of a number, as many as a field has.
    fn field(number: usize, width: usize) -> impl Iterator<Item = u8> {
        (number as u64).to_le_bytes().into_iter().take(width)
    }

    /// A directory that stands at a place of the file, where the next one follows it unless it is the last.
    fn directory(self, tags: &[Entry], at: usize, is_last: bool) -> Vec<u8> {
        let place = self.place();
        let mut values_at = at + self.tag_count() + (4 + 2 * place) * tags.len() + place;
        let mut bytes: Vec<u8> = Self::field(tags.len(), self.tag_count()).collect();
        let mut outside = Vec::new();
        for entry in tags {
            bytes.extend(entry.tag.to_le_bytes());
            bytes.extend(entry.kind.to_le_bytes());
            bytes.extend(Self::field(entry.count, place));
            let length = self.outside_length(entry);
            if length == 0 {
                let mut inline = entry.values.clone();
                inline.resize(place, 0);
                bytes.extend(inline);
            } else {
                bytes.extend(Self::field(values_at, place));
                outside.extend(&entry.values);
                outside.resize(outside.len().next_multiple_of(2), 0);
                values_at += length;
            }
        }
        let next = if is_last { 0 } else { at + self.length_of(tags.iter()) };
        bytes.extend(Self::field(next, place));
        bytes.extend(outside);
        bytes
    }
}

/// Numbers in the 32 bits of a TIFF.
fn narrow(numbers: &[u64]) -> Result<Vec<u32>, Error> {
    let too_long = |_| Error::Run("the file would be longer than the 4 GiB of a TIFF".to_owned());
    numbers.iter().map(|&number| u32::try_from(number).map_err(too_long)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_may_pass_four_gibibytes_have_wide_places() {
        let float = Samples::Float(f32::NAN);
        // 2²⁸ cells are 4,096 tiles, 2³⁰ are 16,384; smaller images are a third more.
        assert_eq!(Variant::holding(4096 * 4 / 3, float), Variant::Tiff);
        assert_eq!(Variant::holding(16_384, float), Variant::BigTiff);
    }
}

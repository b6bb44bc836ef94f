//! PIZ: the 16-bit words of a block, renumbered to those that occur, as wavelets in a Huffman code.
//!
//! Source: OpenEXR File Layout and the description of PIZ in the Technical Introduction; Bogart, Kainz and
//! Hess 2003, OpenEXR image file format, GPU Gems chapter 26.

use super::{huffman, wavelet};

/// The channels of a block.
#[derive(Clone, Debug)]
pub(super) struct Planes {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// 16-bit words of a sample of each channel: 1 or 2.
    pub(super) words: Vec<usize>,
}

impl Planes {
    /// Bytes of all samples.
    pub(super) fn bytes(&self) -> usize {
        2 * self.columns * self.rows * self.words.iter().sum::<usize>()
    }
}

/// Words there are.
const WORDS: usize = 1 << 16;

/// The bytes of a block, row after row and in a row channel after channel.
pub(super) fn expand(packed: &[u8], planes: &Planes) -> Result<Vec<u8>, String> {
    let (occurring, packed) = occurring(packed)?;
    let (length, packed) = packed.split_first_chunk::<4>().ok_or("it ends before its code")?;
    let packed = packed.get(..u32::from_le_bytes(*length) as usize).ok_or("its code is not whole")?;
    let mut words = huffman::decode(packed, planes.bytes() / 2)?;
    let greatest = (occurring.len() - 1) as u16;
    let mut first = 0;
    for &samples in &planes.words {
        // The halves of 32-bit samples are planes of their own, word beside word.
        for half in 0..samples {
            let plane = wavelet::Plane {
                first: first + half,
                columns: planes.columns,
                rows: planes.rows,
                step: samples,
            };
            plane.undo(&mut words, greatest);
        }
        first += planes.columns * planes.rows * samples;
    }
    for word in &mut words {
        // The wavelets of a damaged block give numbers beyond the last word that occurs.
        *word = occurring.get(usize::from(*word)).copied().unwrap_or_default();
    }
    Ok(in_rows(&words, planes))
}

/// The words that occur in a block, with 0, in rising order, from the bits of a map; and what follows it.
fn occurring(packed: &[u8]) -> Result<(Vec<u16>, &[u8]), String> {
    let (bounds, packed) = packed.split_first_chunk::<4>().ok_or("it ends before its map of words")?;
    let [first, last] =
        [[bounds[0], bounds[1]], [bounds[2], bounds[3]]].map(u16::from_le_bytes).map(usize::from);
    if last >= WORDS / 8 {
        return Err(format!("its map of words goes to byte {last} of {}", WORDS / 8));
    }
    let length = (last + 1).saturating_sub(first);
    let (map, packed) = packed.split_at_checked(length).ok_or("its map of words is not whole")?;
    let occurs = |&word: &usize| map[word / 8 - first] >> (word % 8) & 1 == 1;
    let words = (8 * first..8 * (first + length)).filter(occurs).filter(|&word| word != 0);
    Ok(([0].into_iter().chain(words.map(|word| word as u16)).collect(), packed))
}

/// From channel after channel to row after row.
fn in_rows(words: &[u16], planes: &Planes) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(planes.bytes());
    for y in 0..planes.rows {
        let mut first = 0;
        for samples in &planes.words {
            let row = planes.columns * samples;
            bytes.extend(words[first + y * row..][..row].iter().flat_map(|word| word.to_le_bytes()));
            first += planes.rows * row;
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_map_of_words_lists_those_that_occur_and_nought() {
        let (words, rest) = occurring(&[1, 0, 2, 0, 0b101, 0x80, 9]).expect("whole");
        assert_eq!((words, rest), (vec![0, 8, 10, 23], [9].as_slice()));
        let (words, _) = occurring(&[0xff, 0x1f, 0, 0]).expect("an empty map");
        assert_eq!(words, [0]);
        assert!(occurring(&[0, 0, 0, 0x20]).is_err(), "beyond the last word");
        assert!(occurring(&[0, 0, 3, 0, 1]).is_err(), "cut off");
    }

    #[test]
    fn channels_come_together_row_by_row() {
        let planes = Planes { columns: 2, rows: 2, words: vec![1, 2] };
        let words: Vec<u16> = (0..12).collect();
        let rows: Vec<u8> = in_rows(&words, &planes).chunks(2).map(|two| two[0]).collect();
        assert_eq!(rows, [0, 1, 4, 5, 6, 7, 2, 3, 8, 9, 10, 11]);
        assert_eq!(planes.bytes(), 24);
    }
}

//! The compressions of blocks that lose nothing: none, RLE, ZIPS, ZIP and PIZ.

use std::io::{Read, Write};

use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

use super::super::Fault;
use super::piz::{self, Planes};

/// How the blocks of a file are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    RunLength,
    /// Deflate of single rows.
    Zips,
    /// Deflate of sixteen rows.
    Zip,
    /// Wavelets and a Huffman code.
    Piz,
}

/// Number of ZIP, which is written.
pub(super) const ZIP: u8 = 3;
/// Rows of a block of ZIP.
pub(super) const ZIP_ROWS: usize = 16;

impl Compression {
    pub(super) fn of(number: u8) -> Result<Self, Fault> {
        let name = match number {
            0 => return Ok(Self::None),
            1 => return Ok(Self::RunLength),
            2 => return Ok(Self::Zips),
            ZIP => return Ok(Self::Zip),
            4 => return Ok(Self::Piz),
            5 => "PXR24, which rounds floats to 24 bits",
            6 | 7 => "B44, which rounds",
            8 | 9 => "DWA, which rounds",
            _ => "unknown",
        };
        Err(Fault::damaged(format!(
            "compression {number} ({name}); none, RLE, ZIPS, ZIP and PIZ are read: choose ZIP where the file is \
             made"
        )))
    }

    /// Rows of a block of a file without tiles.
    pub(super) fn rows(self) -> usize {
        match self {
            Self::None | Self::RunLength | Self::Zips => 1,
            Self::Zip => ZIP_ROWS,
            Self::Piz => 32,
        }
    }

    /// The bytes of a block, row after row and in a row channel after channel. A block that would not shrink
    /// is stored as it is.
    pub(super) fn expand(self, packed: &[u8], planes: &Planes) -> Result<Vec<u8>, String> {
        let wanted = planes.bytes();
        if packed.len() == wanted {
            return Ok(packed.to_vec());
        }
        match self {
            Self::None => Err(format!("it has {} of {wanted} bytes", packed.len())),
            Self::RunLength => run_lengths(packed, wanted).map(merged),
            Self::Zips | Self::Zip => inflated(packed, wanted).map(merged),
            Self::Piz => piz::expand(packed, planes),
        }
    }
}

fn inflated(packed: &[u8], wanted: usize) -> Result<Vec<u8>, String> {
    let mut bytes = vec![0; wanted];
    let inflating = ZlibDecoder::new(packed).read_exact(&mut bytes);
    inflating.map_err(|cause| format!("it does not inflate to {wanted} bytes ({cause})"))?;
    Ok(bytes)
}

/// A count below 0 stands before as many bytes, another before a byte that comes once more often.
fn run_lengths(mut packed: &[u8], wanted: usize) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::with_capacity(wanted);
    let ends = || "a run is not whole".to_owned();
    while let Some((&count, rest)) = packed.split_first() {
        let count = count as i8;
        let length = if count < 0 { usize::from(count.unsigned_abs()) } else { count as usize + 1 };
        if bytes.len() + length > wanted {
            return Err(format!("it holds more than {wanted} bytes"));
        }
        if count < 0 {
            let (run, rest) = rest.split_at_checked(length).ok_or_else(ends)?;
            bytes.extend(run);
            packed = rest;
        } else {
            let (&byte, rest) = rest.split_first().ok_or_else(ends)?;
            bytes.extend(std::iter::repeat_n(byte, length));
            packed = rest;
        }
    }
    if bytes.len() == wanted {
        Ok(bytes)
    } else {
        Err(format!("it ends after {} of {wanted} bytes", bytes.len()))
    }
}

/// Undoes what RLE and ZIP do before they pack: the bytes at even places first, then those at odd ones, and of
/// all the differences, kept around 128.
fn merged(mut differences: Vec<u8>) -> Vec<u8> {
    for at in 1..differences.len() {
        differences[at] = differences[at].wrapping_add(differences[at - 1]).wrapping_sub(128);
    }
    let (even, odd) = differences.split_at(differences.len().div_ceil(2));
    let at = |index: usize| if index.is_multiple_of(2) { even[index / 2] } else { odd[index / 2] };
    (0..differences.len()).map(at).collect()
}

/// The bytes of a block in ZIP, or as they are where they would not shrink.
pub(super) fn zipped(bytes: Vec<u8>) -> Vec<u8> {
    let (even, odd) = (bytes.iter().step_by(2), bytes.iter().skip(1).step_by(2));
    let mut split: Vec<u8> = even.chain(odd).copied().collect();
    for at in (1..split.len()).rev() {
        split[at] = split[at].wrapping_sub(split[at - 1]).wrapping_add(128);
    }
    let mut encoder = ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    encoder.write_all(&split).expect("memory takes every byte");
    let packed = encoder.finish().expect("memory takes every byte");
    if packed.len() < bytes.len() { packed } else { bytes }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_both_kinds_expand_and_damage_is_told() {
        assert_eq!(run_lengths(&[2, 7, 0xfe, 1, 2], 5), Ok(vec![7, 7, 7, 1, 2]));
        assert!(run_lengths(&[2, 7], 2).is_err_and(|what| what.contains("more than 2")));
        assert!(run_lengths(&[2, 7], 4).is_err_and(|what| what.contains("ends after 3 of 4")));
        assert!(run_lengths(&[0xfe, 7], 4).is_err_and(|what| what.contains("not whole")));
    }

    #[test]
    fn what_is_zipped_merges_again() {
        for length in [1, 2, 15, 64, 1001] {
            let bytes: Vec<u8> = (0..length).map(|at: u32| (at * at / 40) as u8).collect();
            let packed = zipped(bytes.clone());
            let again = if packed.len() == bytes.len() {
                packed
            } else {
                merged(inflated(&packed, bytes.len()).expect("ours"))
            };
            assert_eq!(again, bytes);
        }
    }
}

//! Blosc (c-blosc 1, its `README_CHUNK_FORMAT`): blocks of a chunk, each compressed with LZ4, zlib or Zstandard, where bytes
//! of the same rank may stand together.
//!
//! A header of 16 bytes, where each block begins, and blocks; a block is one stream, or one for each byte of a number. Not
//! read: Blosc's own `BloscLZ`, Snappy, and bits that stand together.

use std::io::Read;

use super::super::Fault;

/// Bytes of the header.
const HEADER: usize = 16;

/// Most bytes of a number for which a block is cut into streams, and least numbers in it.
const MOST_STREAMS: usize = 16;
const LEAST_NUMBERS: usize = 128;

/// What the header says.
struct Header {
    flags: u8,
    /// Bytes of a number.
    width: usize,
    length: usize,
    block: usize,
}

impl Header {
    const SHUFFLED: u8 = 1;
    const STORED: u8 = 2;
    const BITS_SHUFFLED: u8 = 4;
    const WHOLE: u8 = 16;

    fn of(packed: &[u8], most: u64) -> Result<Self, Fault> {
        let header = packed.get(..HEADER).ok_or_else(|| damaged("it is shorter than its header"))?;
        let number = |at: usize| le(&header[at..at + 4]);
        let (flags, width) = (header[2], usize::from(header[3]).max(1));
        let (length, block) = (number(4), number(8));
        if length as u64 > most || (block == 0 && length > 0) || block > length.max(1) {
            return Err(damaged(&format!("{length} bytes in blocks of {block}, of at most {most}")));
        }
        Ok(Self { flags, width, length, block })
    }

    fn is(&self, flag: u8) -> bool {
        self.flags & flag != 0
    }

    /// Streams in a block.
    fn streams(&self, is_whole_block: bool) -> usize {
        let is_cut = !self.is(Self::WHOLE) && is_whole_block;
        let fits = self.width <= MOST_STREAMS && self.block / self.width >= LEAST_NUMBERS;
        if is_cut && fits { self.width } else { 1 }
    }
}

/// The bytes of a chunk, at most so many.
pub(super) fn decode(packed: &[u8], most: u64) -> Result<Vec<u8>, Fault> {
    let header = Header::of(packed, most)?;
    if header.is(Header::STORED) {
        let bytes = packed[HEADER..].get(..header.length);
        return bytes.map(<[u8]>::to_vec).ok_or_else(|| damaged("it is cut off"));
    }
    if header.is(Header::BITS_SHUFFLED) {
        return Err(Fault::damaged(
            "blosc with bits that stand together (bitshuffle) is not read; write it with shuffle or without blosc",
        ));
    }
    let mut bytes = vec![0; header.length];
    let mut expanded = Vec::new();
    for (number, block) in bytes.chunks_mut(header.block.max(1)).enumerate() {
        let start = packed.get(HEADER + 4 * number..HEADER + 4 * number + 4).map(le);
        let rest =
            start.and_then(|start| packed.get(start..)).ok_or_else(|| damaged("a block lies outside"))?;
        expanded.resize(block.len(), 0);
        expand_block(&header, rest, &mut expanded)?;
        unshuffle(&header, &expanded, block);
    }
    Ok(bytes)
}

fn expand_block(header: &Header, mut rest: &[u8], block: &mut [u8]) -> Result<(), Fault> {
    let streams = header.streams(block.len() == header.block);
    let length = block.len() / streams;
    for stream in block.chunks_mut(length.max(1)) {
        let cut = || damaged("a block is cut off");
        let (size, behind) = rest.split_first_chunk::<4>().ok_or_else(cut)?;
        let packed = behind.get(..le(size)).ok_or_else(cut)?;
        rest = &behind[packed.len()..];
        if packed.len() == stream.len() {
            stream.copy_from_slice(packed);
        } else {
            expand(header.flags >> 5, packed, stream)?;
        }
    }
    Ok(())
}

/// Fills a stream by the compression of that number.
fn expand(compression: u8, packed: &[u8], stream: &mut [u8]) -> Result<(), Fault> {
    let done = match compression {
        1 => {
            let written = lz4_flex::block::decompress_into(packed, stream);
            written.map(|written| written == stream.len()).map_err(|cause| cause.to_string())
        }
        3 => {
            let read = flate2::read::ZlibDecoder::new(packed).read_exact(stream);
            read.map(|()| true).map_err(|cause| cause.to_string())
        }
        #[cfg(feature = "zstd")]
        4 => {
            let window = (stream.len() as u64).next_power_of_two().max(8 << 20);
            let decoder = ruzstd::decoding::StreamingDecoder::new_with_max_window_size(packed, window);
            let read = decoder.map(|mut decoder| decoder.read_exact(stream));
            read.map_err(|cause| cause.to_string())
                .and_then(|read| read.map(|()| true).map_err(|cause| cause.to_string()))
        }
        other => {
            let name = ["BloscLZ", "LZ4", "Snappy", "zlib", "Zstandard"]
                .get(usize::from(other))
                .unwrap_or(&"unknown");
            return Err(Fault::damaged(format!(
                "blosc with {name} is not read; LZ4, zlib and Zstandard are: write it with cname='zstd'"
            )));
        }
    };
    match done {
        Ok(true) => Ok(()),
        Ok(false) => Err(damaged("a stream ends early")),
        Err(cause) => Err(damaged(&cause)),
    }
}

/// Puts the bytes of each number beside each other again.
fn unshuffle(header: &Header, shuffled: &[u8], block: &mut [u8]) {
    let (width, numbers) = (header.width, block.len() / header.width);
    if !header.is(Header::SHUFFLED) || width == 1 {
        block.copy_from_slice(shuffled);
        return;
    }
    for (number, bytes) in block.chunks_exact_mut(width).enumerate() {
        for (rank, byte) in bytes.iter_mut().enumerate() {
            *byte = shuffled[rank * numbers + number];
        }
    }
    block[numbers * width..].copy_from_slice(&shuffled[numbers * width..]);
}

fn le(bytes: impl AsRef<[u8]>) -> usize {
    bytes.as_ref().iter().rev().fold(0, |number, byte| number << 8 | usize::from(*byte))
}

fn damaged(what: &str) -> Fault {
    Fault::damaged(format!("a chunk is damaged: blosc: {what}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chunk of three numbers of two bytes, shuffled and stored in one stream.
    fn packed() -> Vec<u8> {
        let mut packed = vec![2, 1, Header::SHUFFLED | Header::WHOLE | 1 << 5, 2];
        for number in [6_u32, 6, 30, 20, 6] {
            packed.extend(number.to_le_bytes());
        }
        packed.extend([1, 2, 3, 10, 20, 30]);
        packed
    }

    #[test]
    fn bytes_of_a_number_come_together_again() {
        assert_eq!(decode(&packed(), 6), Ok(vec![1, 10, 2, 20, 3, 30]));
    }

    #[test]
    fn a_damaged_chunk_is_refused_and_takes_no_memory() {
        for length in 0..packed().len() {
            assert!(decode(&packed()[..length], 6).is_err(), "{length} bytes");
        }
        assert!(decode(&packed(), 5).is_err(), "more than it may");
        for at in 0..packed().len() {
            for byte in [0, 1, 127, 255] {
                let mut damaged = packed();
                damaged[at] = byte;
                let _ = decode(&damaged, 6);
            }
        }
    }
}

//! Deflate on all cores: bands of the data are packed by themselves and joined to one stream (RFC 1950, RFC 1951).
//!
//! A band ends with an empty block that brings it to a whole byte, so that bands follow one another as they are. Bands are
//! of one length, whatever the number of threads, and so are the bytes that come of them.

use flate2::{Compress, Compression, FlushCompress};
use rayon::prelude::*;

/// Bytes of a band: many times the 32 KiB within which Deflate looks for what it has seen.
const BAND: usize = 512 << 10;

/// What a zlib stream of the usual level begins with.
const HEADER: [u8; 2] = [0x78, 0x9c];

/// The largest prime below 2^16.
const ADLER: u32 = 65521;

/// A zlib stream of these bytes.
pub(super) fn zlib(bytes: &[u8]) -> Vec<u8> {
    let bands: Vec<_> = if bytes.is_empty() { vec![bytes] } else { bytes.chunks(BAND).collect() };
    let last = bands.len() - 1;
    let packed: Vec<_> = bands
        .par_iter()
        .enumerate()
        .map(|(number, band)| (packed(band, number == last), Checksum::of(band)))
        .collect();
    let mut stream = HEADER.to_vec();
    for (band, _) in &packed {
        stream.extend(band);
    }
    let checksum = packed.iter().map(|(_, checksum)| *checksum).reduce(Checksum::before);
    stream.extend(checksum.map_or(1, Checksum::number).to_be_bytes());
    stream
}

/// The blocks of a band.
fn packed(band: &[u8], is_last: bool) -> Vec<u8> {
    let mut packer = Compress::new(Compression::default(), false);
    let mut blocks = Vec::with_capacity(band.len() / 2 + 1024);
    let flush = if is_last { FlushCompress::Finish } else { FlushCompress::Sync };
    loop {
        let taken = packer.total_in() as usize;
        // There is nothing that packing could fail for: memory ends a program.
        packer.compress_vec(&band[taken..], &mut blocks, flush).expect("packing knows no bad data");
        if packer.total_in() as usize == band.len() && blocks.len() < blocks.capacity() {
            return blocks;
        }
        blocks.reserve(band.len() / 2 + 1024);
    }
}

/// The checksum Adler-32 of some bytes, in its two halves, and how many they are.
#[derive(Clone, Copy, Debug)]
struct Checksum {
    sum: u32,
    sums: u32,
    bytes: usize,
}

impl Checksum {
    fn of(bytes: &[u8]) -> Self {
        /// Bytes after which the sums still fit into 32 bits.
        const RUN: usize = 5552;
        let (mut sum, mut sums) = (1_u32, 0_u32);
        for run in bytes.chunks(RUN) {
            for byte in run {
                sum += u32::from(*byte);
                sums += sum;
            }
            (sum, sums) = (sum % ADLER, sums % ADLER);
        }
        Self { sum, sums, bytes: bytes.len() }
    }

    /// That of these bytes and others behind them.
    fn before(self, next: Self) -> Self {
        let length = (next.bytes % ADLER as usize) as u64;
        // The sums of the others begin with 1, where these leave off.
        let carried = u64::from(self.sum + ADLER - 1) * length;
        let sums = (u64::from(self.sums) + u64::from(next.sums) + carried) % u64::from(ADLER);
        let sum = (self.sum + next.sum + ADLER - 1) % ADLER;
        Self { sum, sums: sums as u32, bytes: self.bytes + next.bytes }
    }

    fn number(self) -> u32 {
        self.sums << 16 | self.sum
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;

    use super::*;
    use weald_core::random::splitmix64;

    #[test]
    fn what_was_packed_in_bands_comes_back_with_its_checksum() {
        let plain = |length: usize| (0..length).map(|at| (at / 37 % 251) as u8);
        let noise = |length: usize| (0..length as u64).map(|at| splitmix64(at) as u8);
        for length in [0, 1, 1000, BAND - 1, BAND, BAND + 1, 3 * BAND + 4567] {
            for bytes in [plain(length).collect::<Vec<_>>(), noise(length).collect()] {
                let stream = zlib(&bytes);
                let mut back = Vec::new();
                // The reader fails where the checksum is another.
                flate2::read::ZlibDecoder::new(&stream[..]).read_to_end(&mut back).expect("a whole stream");
                assert!(back == bytes, "{length} bytes");
            }
        }
    }
}

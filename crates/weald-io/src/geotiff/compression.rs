//! The compressions of chunks: none, LZW, Deflate.

use std::io::Read;

use flate2::read::ZlibDecoder;
use weezl::BitOrder;

use super::super::Fault;

/// How the chunks of a file are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Lzw,
    Deflate,
}

impl Compression {
    /// The compression behind tag 259.
    pub(super) fn of(number: u64) -> Result<Self, Fault> {
        match number {
            1 => Ok(Self::None),
            5 => Ok(Self::Lzw),
            // 32946 is the number from before Deflate was registered.
            8 | 32946 => Ok(Self::Deflate),
            _ => Err(Fault::damaged(format!(
                "compression {number}; 1 (none), 5 (LZW) and 8 (Deflate) are read: gdal_translate -co \
                 COMPRESS=DEFLATE"
            ))),
        }
    }

    /// Fills `expanded` from the bytes of a chunk. What a chunk holds beyond that is left unread.
    pub(super) fn expand(self, chunk: &[u8], expanded: &mut [u8]) -> Result<(), String> {
        match self {
            Self::None => {
                let stored = chunk.get(..expanded.len());
                expanded.copy_from_slice(stored.ok_or_else(|| ends_after(chunk.len(), expanded.len()))?);
                Ok(())
            }
            Self::Deflate => {
                let wanted = expanded.len();
                ZlibDecoder::new(chunk)
                    .read_exact(expanded)
                    .map_err(|cause| format!("it does not inflate to {wanted} bytes ({cause})"))
            }
            Self::Lzw => expand_lzw(chunk, expanded),
        }
    }
}

fn expand_lzw(mut chunk: &[u8], expanded: &mut [u8]) -> Result<(), String> {
    let mut decoder = weezl::decode::Decoder::with_tiff_size_switch(BitOrder::Msb, 8);
    let mut filled = 0;
    while filled < expanded.len() {
        let result = decoder.decode_bytes(chunk, &mut expanded[filled..]);
        (filled, chunk) = (filled + result.consumed_out, &chunk[result.consumed_in..]);
        let status = result.status.map_err(|cause| cause.to_string())?;
        if filled < expanded.len() && !matches!(status, weezl::LzwStatus::Ok) {
            return Err(ends_after(filled, expanded.len()));
        }
    }
    Ok(())
}

fn ends_after(bytes: usize, wanted: usize) -> String {
    format!("it ends after {bytes} of {wanted} bytes")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_numbers_of_deflate_are_known_and_others_name_what_is_read() {
        assert_eq!(Compression::of(8), Ok(Compression::Deflate));
        assert_eq!(Compression::of(32946), Ok(Compression::Deflate));
        assert!(Compression::of(7).is_err_and(|fault| fault.to_string().contains("compression 7; 1 (none)")));
    }

    #[test]
    fn a_chunk_that_ends_early_says_how_early() {
        let mut expanded = [0; 8];
        let error = Compression::None.expand(&[1, 2, 3], &mut expanded).expect_err("too short");
        assert_eq!(error, "it ends after 3 of 8 bytes");
        let packed = weezl::encode::Encoder::with_tiff_size_switch(BitOrder::Msb, 8).encode(&[7; 5]);
        let error = Compression::Lzw.expand(&packed.expect("packs"), &mut expanded).expect_err("too short");
        assert_eq!(error, "it ends after 5 of 8 bytes");
    }
}

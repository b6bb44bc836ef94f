//! The compressions of chunks: none, LZW, Deflate, `PackBits`, Zstandard.

use std::io::Read;

use flate2::read::ZlibDecoder;
use weezl::BitOrder;

use super::super::Fault;
use super::super::limits::MAX_EXPANSION;

/// How the chunks of a file are compressed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compression {
    None,
    Lzw,
    Deflate,
    PackBits,
    #[cfg(feature = "zstd")]
    Zstd,
}

impl Compression {
    /// The compression behind tag 259.
    pub(super) fn of(number: u64) -> Result<Self, Fault> {
        match number {
            1 => Ok(Self::None),
            5 => Ok(Self::Lzw),
            // 32946 is the number from before Deflate was registered.
            8 | 32946 => Ok(Self::Deflate),
            32773 => Ok(Self::PackBits),
            #[cfg(feature = "zstd")]
            50000 => Ok(Self::Zstd),
            #[cfg(not(feature = "zstd"))]
            50000 => Err(Fault::damaged(format!(
                "compression 50000; {}",
                weald_core::error::left_out("Zstandard", "zstd")
            ))),
            _ => Err(Fault::damaged(format!(
                "compression {number}{}; 1 (none), 5 (LZW), 8 (Deflate), 32773 (PackBits) and 50000 (Zstandard) are \
                 read: gdal_translate -co COMPRESS=DEFLATE in.tif out.tif makes one of them",
                name_of(number)
            ))),
        }
    }

    /// How many times the bytes of a chunk its values may take.
    pub(super) fn expansion(self) -> usize {
        match self {
            // A block of 128 KiB of the same byte takes four.
            #[cfg(feature = "zstd")]
            Self::Zstd => 1 << 15,
            _ => MAX_EXPANSION,
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
            Self::PackBits => expand_pack_bits(chunk, expanded),
            #[cfg(feature = "zstd")]
            Self::Zstd => {
                let window = (expanded.len() as u64).next_power_of_two().max(8 << 20);
                let decoder = ruzstd::decoding::StreamingDecoder::new_with_max_window_size(chunk, window);
                let mut decoder = decoder.map_err(|cause| format!("zstd: {cause}"))?;
                decoder.read_exact(expanded).map_err(|cause| format!("zstd: {cause}"))
            }
        }
    }
}

/// The name of a compression that is not read.
fn name_of(number: u64) -> &'static str {
    match number {
        2..=4 => " (CCITT, for documents)",
        6 | 7 => " (JPEG, which loses digits)",
        32767 | 34677 => " (JBIG)",
        33003 | 33005 | 34712 => " (JPEG 2000)",
        34887 => " (LERC)",
        34925 => " (LZMA)",
        50001 => " (WebP)",
        50002 | 52546 => " (JPEG XL)",
        _ => "",
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

/// Apple's `PackBits` (TIFF 6.0, section 9): a count below 128 of bytes as they are, or one above of the same byte.
fn expand_pack_bits(chunk: &[u8], expanded: &mut [u8]) -> Result<(), String> {
    let (mut rest, mut filled) = (chunk, 0);
    let wanted = expanded.len();
    while filled < wanted {
        let ends = || ends_after(filled, wanted);
        let (count, behind) = rest.split_first().ok_or_else(ends)?;
        rest = behind;
        let left = &mut expanded[filled..];
        match *count as i8 {
            -128 => {}
            count @ 0.. => {
                let length = usize::from(count.unsigned_abs()) + 1;
                let bytes = rest.get(..length).ok_or_else(ends)?;
                let length = length.min(left.len());
                left[..length].copy_from_slice(&bytes[..length]);
                (rest, filled) = (&rest[bytes.len()..], filled + length);
            }
            count => {
                let (byte, behind) = rest.split_first().ok_or_else(ends)?;
                let length = (usize::from(count.unsigned_abs()) + 1).min(left.len());
                left[..length].fill(*byte);
                (rest, filled) = (behind, filled + length);
            }
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
        assert!(Compression::of(7).is_err_and(|fault| {
            fault.to_string().contains("compression 7 (JPEG, which loses digits); 1 (none)")
        }));
    }

    /// The example of TIFF 6.0, section 9.
    #[test]
    fn pack_bits_unpack_as_the_specification_shows() {
        let packed =
            [0xfe, 0xaa, 0x02, 0x80, 0x00, 0x2a, 0xfd, 0xaa, 0x03, 0x80, 0x00, 0x2a, 0x22, 0x80, 0xf7, 0xaa];
        let mut expanded = [0; 24];
        Compression::PackBits.expand(&packed, &mut expanded).expect("unpacks");
        let whole = [
            [0xaa, 0xaa, 0xaa, 0x80, 0x00, 0x2a, 0xaa, 0xaa, 0xaa, 0xaa, 0x80, 0x00],
            [0x2a, 0x22, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa, 0xaa],
        ];
        assert_eq!(expanded, *whole.as_flattened());
        assert!(Compression::PackBits.expand(&packed[..7], &mut expanded).is_err());
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

//! Codecs: what was done to the bytes of a chunk, undone.

use std::io::Read;

use flate2::read::{MultiGzDecoder, ZlibDecoder};
use serde_json::Value;

use super::super::Fault;
use super::blosc;

/// Largest window of Zstandard that is given memory for a chunk that is no larger itself.
#[cfg(feature = "zstd")]
const WINDOW: u64 = 8 << 20;

/// Codecs of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Codecs {
    /// Whether the most significant byte of a number comes first.
    pub(super) is_big: bool,
    /// Which axis of a chunk its numbers have at each place, the slowest first, where that is not their own order.
    pub(super) order: Option<Vec<usize>>,
    /// In the order of encoding.
    packings: Vec<Packing>,
}

/// A codec from bytes to bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Packing {
    Gzip,
    Zlib,
    Lz4,
    Blosc,
    #[cfg(feature = "zstd")]
    Zstd,
    Crc32c,
}

impl Codecs {
    /// # Errors
    /// [`Fault::Damaged`] naming a codec that is not read, or where `bytes` is not the first.
    pub(super) fn of(array: &str, codecs: &Value) -> Result<Self, Fault> {
        let mut listed = codecs.as_array().map(Vec::as_slice).unwrap_or_default();
        let order = match listed.split_first() {
            Some((codec, rest)) if name(codec) == "transpose" => {
                listed = rest;
                let order = lengths(&codec["configuration"]["order"]);
                Some(
                    order
                        .ok_or_else(|| Fault::damaged(format!("`{array}`: a transpose without an order")))?,
                )
            }
            _ => None,
        };
        let [first, rest @ ..] = listed else {
            return Err(Fault::damaged(format!("`{array}` has no codecs; `bytes` is needed at least")));
        };
        if name(first) != "bytes" {
            return Err(unread(array, name(first)));
        }
        let is_big = match first["configuration"]["endian"].as_str() {
            None | Some("little") => false,
            Some("big") => true,
            Some(endian) => return Err(Fault::damaged(format!("`{array}`: bytes in {endian:?} order"))),
        };
        let packing = |codec: &Value| match name(codec) {
            "gzip" => Ok(Packing::Gzip),
            "zlib" => Ok(Packing::Zlib),
            "lz4" => Ok(Packing::Lz4),
            "blosc" => Ok(Packing::Blosc),
            #[cfg(feature = "zstd")]
            "zstd" => Ok(Packing::Zstd),
            #[cfg(not(feature = "zstd"))]
            "zstd" => Err(Fault::damaged(format!(
                "`{array}` is packed with codec `zstd`; {}",
                weald_core::error::left_out("Zstandard", "zstd")
            ))),
            "crc32c" => Ok(Packing::Crc32c),
            other => Err(unread(array, other)),
        };
        Ok(Self { is_big, order, packings: rest.iter().map(packing).collect::<Result<_, _>>()? })
    }

    /// Bytes that sums add to what is encoded; `None` where a codec changes its length in ways of its own.
    pub(super) fn length_of_sums(&self) -> Option<usize> {
        let is_plain =
            self.order.is_none() && self.packings.iter().all(|packing| *packing == Packing::Crc32c);
        is_plain.then_some(4 * self.packings.len())
    }

    /// Most bytes that a chunk of `length` bytes has in a file: packing what cannot be packed adds a little.
    pub(super) fn most(length: usize) -> u64 {
        length as u64 + length as u64 / 64 + 4096
    }

    /// The numbers' bytes, exactly `length` of them.
    ///
    /// # Errors
    /// [`Fault::Damaged`] for bytes that do not unpack to that.
    pub(super) fn decode(&self, packed: Vec<u8>, length: usize) -> Result<Vec<u8>, Fault> {
        let mut bytes = packed;
        for (position, packing) in self.packings.iter().enumerate().rev() {
            // Only the last step has to give the numbers; what stood before it may be a little longer.
            let most = if position == 0 { length as u64 } else { Self::most(length) };
            bytes = packing.undo(&bytes, most)?;
        }
        if bytes.len() != length {
            return Err(Fault::damaged(format!("{} bytes in a chunk of {length}", bytes.len())));
        }
        Ok(bytes)
    }
}

/// Numbers of a list, where it is one of lengths.
pub(super) fn lengths(list: &Value) -> Option<Vec<usize>> {
    list.as_array()?.iter().map(|length| usize::try_from(length.as_u64()?).ok()).collect()
}

fn name(codec: &Value) -> &str {
    // A codec without configuration may stand as its name alone.
    codec["name"].as_str().or_else(|| codec.as_str()).unwrap_or("?")
}

fn unread(array: &str, codec: &str) -> Fault {
    Fault::damaged(format!(
        "`{array}` is packed with codec `{codec}`; bytes, gzip, zlib, zstd, lz4, blosc, crc32c, transpose and shards of these are read: with xarray \
         ds.to_zarr(path, encoding={{'{array}': {{'compressors': None, 'shards': None}}}})"
    ))
}

impl Packing {
    fn undo(self, bytes: &[u8], most: u64) -> Result<Vec<u8>, Fault> {
        match self {
            Self::Gzip => at_most(MultiGzDecoder::new(bytes), most, "gzip"),
            Self::Zlib => at_most(ZlibDecoder::new(bytes), most, "zlib"),
            Self::Lz4 => lz4(bytes, most),
            Self::Blosc => blosc::decode(bytes, most),
            #[cfg(feature = "zstd")]
            Self::Zstd => {
                let window = most.next_power_of_two().max(WINDOW);
                let decoder = ruzstd::decoding::StreamingDecoder::new_with_max_window_size(bytes, window);
                let decoder = decoder.map_err(|cause| Fault::damaged(format!("zstd: {cause}")))?;
                at_most(decoder, most, "zstd")
            }
            Self::Crc32c => {
                let parts = bytes.split_last_chunk::<4>();
                let whole = parts.filter(|(bytes, sum)| crc32c(bytes).to_le_bytes() == **sum);
                let (bytes, _) = whole.ok_or_else(|| Fault::damaged("a chunk does not match its crc32c"))?;
                Ok(bytes.to_vec())
            }
        }
    }
}

/// What a decoder gives, if that is not more than `most`. Memory grows with what is really there.
fn at_most(decoder: impl Read, most: u64, codec: &str) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    let read = decoder.take(most + 1).read_to_end(&mut bytes);
    read.map_err(|cause| Fault::damaged(format!("a chunk is damaged: {codec}: {cause}")))?;
    if bytes.len() as u64 > most {
        return Err(Fault::damaged(format!("a chunk unpacks to more than its {most} bytes")));
    }
    Ok(bytes)
}

/// A block of LZ4 behind its length, as `numcodecs` writes it.
fn lz4(bytes: &[u8], most: u64) -> Result<Vec<u8>, Fault> {
    let damaged = |cause: &str| Fault::damaged(format!("a chunk is damaged: lz4: {cause}"));
    let (length, block) = bytes.split_first_chunk::<4>().ok_or_else(|| damaged("it has no length"))?;
    let length = u32::from_le_bytes(*length);
    if u64::from(length) > most {
        return Err(damaged(&format!("{length} bytes, of at most {most}")));
    }
    let mut expanded = vec![0; length as usize];
    match lz4_flex::block::decompress_into(block, &mut expanded) {
        Ok(written) if written == expanded.len() => Ok(expanded),
        Ok(_) => Err(damaged("it ends early")),
        Err(cause) => Err(damaged(&cause.to_string())),
    }
}

/// Castagnoli's cyclic redundancy check (RFC 3720, appendix B.4), reflected.
pub(super) fn crc32c(bytes: &[u8]) -> u32 {
    let step = |sum: u32, _| if sum & 1 == 1 { sum >> 1 ^ 0x82f6_3b78 } else { sum >> 1 };
    !bytes.iter().fold(u32::MAX, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), step))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// RFC 3720, appendix B.4.
    #[test]
    fn the_check_sum_is_that_of_the_specification() {
        assert_eq!(crc32c(&[0; 32]), 0x8a91_36aa);
        assert_eq!(crc32c(b"123456789"), 0xe306_9283);
    }

    #[test]
    fn codecs_that_are_not_read_are_named() {
        let of = |codecs: Value| Codecs::of("height", &codecs).map_err(|fault| fault.to_string());
        assert!(of(json!([{ "name": "bytes" }, { "name": "gzip" }, "crc32c"])).is_ok());
        let turned =
            json!([{ "name": "transpose", "configuration": { "order": [1, 0] } }, { "name": "bytes" }]);
        assert!(of(turned).is_ok_and(|codecs| codecs.order == Some(vec![1, 0])));
        for codec in ["lzma", "sharding_indexed", "transpose"] {
            let error = of(json!([{ "name": "bytes" }, { "name": codec }])).expect_err("unread");
            assert!(error.contains(&format!("codec `{codec}`")), "{error}");
            assert!(of(json!([{ "name": codec }, { "name": "bytes" }])).is_err());
        }
        assert!(of(json!([])).is_err() && of(json!(null)).is_err());
    }

    #[test]
    fn a_chunk_that_does_not_match_its_sum_or_its_length_is_refused() {
        let codecs = Codecs::of("a", &json!([{ "name": "bytes" }, { "name": "crc32c" }])).expect("read");
        let sum = crc32c(&[1, 2, 3, 4]).to_le_bytes();
        let packed = [[1, 2, 3, 4], sum].concat();
        assert_eq!(codecs.decode(packed.clone(), 4), Ok(vec![1, 2, 3, 4]));
        assert!(codecs.decode(packed.clone(), 8).is_err(), "too short");
        assert!(codecs.decode(packed[..7].to_vec(), 3).is_err(), "another sum");
        assert!(codecs.decode(vec![1], 0).is_err(), "no sum");
    }

    #[test]
    #[cfg(not(feature = "zstd"))]
    fn a_build_without_zstandard_names_its_feature() {
        let fault =
            Codecs::of("height", &json!([{ "name": "bytes" }, { "name": "zstd" }])).expect_err("left out");
        let expected = "`height` is packed with codec `zstd`; Zstandard is not part of this build: build with the \
                        feature `zstd`";
        assert_eq!(fault.to_string(), expected);
    }
}

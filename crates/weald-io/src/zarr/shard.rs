//! Shards (Zarr enhancement proposal 2, codec `sharding_indexed`): many chunks in one file, which an index finds.
//!
//! The index is 16 bytes a chunk in row-major order, where it begins and how long it is, both of all bits where there is
//! none. It stands at the end of the file or at its start, packed by codecs that do not change its length but for sums.

use std::ops::Range;

use serde_json::{Value, json};

use super::super::Fault;
use super::codec::{Codecs, crc32c, lengths};

/// Bytes of a chunk in the index.
const ENTRY: usize = 16;

/// How the chunks of an array lie in shards.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Shards {
    /// Chunks of a shard along each dimension.
    pub(super) counts: Vec<usize>,
    index: Codecs,
    is_at_start: bool,
}

/// A codec of an array that makes shards, taken apart: the shape of a chunk, its codecs, and where it lies.
pub(super) struct Sharded<'a> {
    pub(super) chunk: Vec<usize>,
    pub(super) codecs: &'a Value,
    pub(super) shards: Shards,
}

impl<'a> Sharded<'a> {
    /// The only codec of an array, where it is that of shards of this shape; `None` where it is another.
    ///
    /// # Errors
    /// [`Fault::Damaged`] for chunks that do not fill a shard, and for an index that is not read.
    pub(super) fn of(array: &str, codecs: &'a Value, shard: &[usize]) -> Result<Option<Self>, Fault> {
        let [codec] = codecs.as_array().map(Vec::as_slice).unwrap_or_default() else { return Ok(None) };
        if codec["name"] != "sharding_indexed" {
            return Ok(None);
        }
        let keys = &codec["configuration"];
        let chunk = lengths(&keys["chunk_shape"]).filter(|chunk| {
            let fills = |(shard, chunk): (&usize, &usize)| *chunk > 0 && shard.is_multiple_of(*chunk);
            chunk.len() == shard.len() && shard.iter().zip(chunk).all(fills)
        });
        let chunk = chunk.ok_or_else(|| {
            Fault::damaged(format!("`{array}`: chunks of {} in shards of {shard:?}", keys["chunk_shape"]))
        })?;
        let is_at_start = match keys["index_location"].as_str() {
            None | Some("end") => false,
            Some("start") => true,
            Some(other) => return Err(Fault::damaged(format!("`{array}`: an index of shards at {other:?}"))),
        };
        let index = Codecs::of(array, &keys["index_codecs"])?;
        let counts = shard.iter().zip(&chunk).map(|(shard, chunk)| shard / chunk).collect();
        let shards = Shards { counts, index, is_at_start };
        shards.index_length().ok_or_else(|| {
            Fault::damaged(format!(
                "`{array}`: its shards have an index that is packed; bytes and crc32c are read"
            ))
        })?;
        Ok(Some(Self { chunk, codecs: &keys["codecs"], shards }))
    }
}

/// The codecs of an array of shards, which are written with the index at the end.
pub(super) fn codecs(chunk: &Value, packed: &Value) -> Value {
    json!([{ "name": "sharding_indexed", "configuration": {
        "chunk_shape": chunk,
        "codecs": packed,
        "index_codecs": [{ "name": "bytes", "configuration": { "endian": "little" } }, { "name": "crc32c" }],
        "index_location": "end",
    } }])
}

/// The bytes of a shard with room for so many chunks, of which these are the first; `None` where there are none.
pub(super) fn joined(chunks: &[Option<Vec<u8>>], room: usize) -> Option<Vec<u8>> {
    let mut bytes = chunks.iter().flatten().flatten().copied().collect::<Vec<u8>>();
    let mut index = Vec::with_capacity(room * ENTRY);
    let mut first = 0;
    for chunk in (0..room).map(|place| chunks.get(place).and_then(Option::as_ref)) {
        let length = chunk.map_or(0, Vec::len) as u64;
        let entry = if chunk.is_some() { [first, length] } else { [u64::MAX; 2] };
        index.extend(entry.iter().flat_map(|number| number.to_le_bytes()));
        first += length;
    }
    let sum = crc32c(&index).to_le_bytes();
    bytes.extend(index.into_iter().chain(sum));
    chunks.iter().any(Option::is_some).then_some(bytes)
}

impl Shards {
    /// Most bytes of a shard with chunks of so many.
    pub(super) fn most(&self, chunk: usize) -> u64 {
        let chunks = self.chunks() as u64;
        chunks.saturating_mul(Codecs::most(chunk)).saturating_add(self.index_length().unwrap_or(0) as u64)
    }

    /// Where each chunk lies in a shard, in row-major order.
    ///
    /// # Errors
    /// [`Fault::Damaged`] for an index that is cut off or leads out of the shard.
    pub(super) fn places(&self, shard: &[u8]) -> Result<Vec<Option<Range<usize>>>, Fault> {
        let cut = || Fault::damaged(format!("a shard of {} bytes is shorter than its index", shard.len()));
        let length = self.index_length().ok_or_else(cut)?;
        let start = if self.is_at_start { Some(0) } else { shard.len().checked_sub(length) };
        let packed = start.and_then(|start| shard.get(start..start + length)).ok_or_else(cut)?;
        let index = self.index.decode(packed.to_vec(), ENTRY * self.chunks())?;
        index.chunks_exact(ENTRY).map(|entry| self.place(entry, shard.len())).collect()
    }

    fn place(&self, entry: &[u8], length: usize) -> Result<Option<Range<usize>>, Fault> {
        let number = |bytes: &[u8]| {
            let bytes = bytes.try_into().expect("an entry has two numbers of eight bytes");
            if self.index.is_big { u64::from_be_bytes(bytes) } else { u64::from_le_bytes(bytes) }
        };
        let [first, bytes] = [&entry[..8], &entry[8..]].map(number);
        if (first, bytes) == (u64::MAX, u64::MAX) {
            return Ok(None);
        }
        let end = first.checked_add(bytes).filter(|end| *end <= length as u64);
        let end = end.ok_or_else(|| {
            Fault::damaged(format!("a chunk of {bytes} bytes from {first} in a shard of {length}"))
        })?;
        Ok(Some(first as usize..end as usize))
    }

    fn chunks(&self) -> usize {
        self.counts.iter().product()
    }

    /// Bytes of the packed index; `None` where its codecs do not tell, or beyond all numbers.
    fn index_length(&self) -> Option<usize> {
        let plain = self.counts.iter().try_fold(ENTRY, |bytes, count| bytes.checked_mul(*count))?;
        self.index.length_of_sums()?.checked_add(plain)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn sharded(location: &str, codecs: &Value) -> Result<Option<Shards>, Fault> {
        let listed = json!([{ "name": "sharding_indexed", "configuration": { "chunk_shape": [2, 3],
            "codecs": [{ "name": "bytes" }], "index_codecs": codecs, "index_location": location } }]);
        Ok(Sharded::of("height", &listed, &[2, 6])?.map(|sharded| sharded.shards))
    }

    #[test]
    fn an_index_at_either_end_says_where_chunks_lie() {
        let index = [[4_u64, 3], [u64::MAX, u64::MAX]].as_flattened().iter().flat_map(|it| it.to_le_bytes());
        let index: Vec<u8> = index.collect();
        let plain = json!([{ "name": "bytes" }]);
        for (location, shard) in [("end", [&[0; 7], &index[..]].concat()), ("start", index.clone())] {
            let shards = sharded(location, &plain).expect("read").expect("shards");
            assert_eq!(shards.places(&shard).expect("whole"), [Some(4..7), None]);
            assert!(shards.places(&shard[..20]).is_err_and(|fault| fault.to_string().contains("shorter")));
        }
        let shards = sharded("end", &plain).expect("read").expect("shards");
        let outside = shards.places(&[&[0; 6], &index[..]].concat());
        assert_eq!(
            outside.expect("within the file"),
            [Some(4..7), None],
            "a chunk may lie anywhere in the file"
        );
        let far = [[u64::MAX - 1, 3], [0, 99]].map(|entry| entry.map(u64::to_le_bytes).concat());
        assert!(far.iter().all(|entry| shards.place(entry, 40).is_err()));
    }

    #[test]
    fn shards_that_are_not_read_are_refused_with_a_reason() {
        let error = sharded("end", &json!([{ "name": "bytes" }, { "name": "gzip" }])).expect_err("packed");
        assert!(error.to_string().contains("index that is packed"), "{error}");
        assert!(sharded("middle", &json!([{ "name": "bytes" }])).is_err());
        let odd = json!([{ "name": "sharding_indexed", "configuration": { "chunk_shape": [2, 4],
            "codecs": [{ "name": "bytes" }], "index_codecs": [{ "name": "bytes" }] } }]);
        assert!(Sharded::of("height", &odd, &[2, 6]).is_err(), "chunks must fill a shard");
        assert!(
            Sharded::of("height", &json!([{ "name": "bytes" }]), &[2, 6]).is_ok_and(|none| none.is_none())
        );
    }
}

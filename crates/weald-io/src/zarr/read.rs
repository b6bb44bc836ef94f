//! Numbers out of a group or a single array.

use serde_json::Value;

use super::super::cf::{self, Attributes, Described, Source};
use super::super::{Fault, Limits, PartName, Parts, Raster};
use super::attributes;
use super::codec::Codecs;
use super::metadata::{Array, DESCRIPTION, MAX_DIMENSIONS, Storage};
use super::version2;
use weald_core::error::{Limit, Quantity};

/// Longest description that is read.
const DESCRIPTION_BYTES: u64 = 16 << 20;

/// Most arrays of a group.
const MAX_ARRAYS: usize = 1000;

/// Reads the layer of a group, or a single array; see [`Zarr`](super).
///
/// # Errors
/// [`Fault`] for a folder that is damaged, of a kind that is not read, or over the limits.
pub fn decode(parts: &dyn Parts, limits: Limits) -> Result<Raster, Fault> {
    let root = description(parts, "")?.ok_or_else(|| {
        Fault::damaged(
            "the folder has neither zarr.json nor .zgroup or .zarray, so it is no Zarr or not whole",
        )
    })?;
    let arrays = match root["node_type"].as_str() {
        Some("group") => arrays_of_group(parts, &root)?,
        Some("array") => vec![Array::of("", &root)?],
        _ => return Err(Fault::damaged("its description is neither that of a group nor of an array")),
    };
    let described = arrays.iter().map(Array::described).collect();
    cf::read(
        &Folder { parts, limits, attributes: attributes::of_json(root.get("attributes")), arrays, described },
        limits,
    )
}

/// The description in the folder of that name.
fn description(parts: &dyn Parts, folder: &str) -> Result<Option<Value>, Fault> {
    let name = PartName::Inside(within(folder, DESCRIPTION));
    let Some(bytes) = parts.read(&name, DESCRIPTION_BYTES)? else {
        return version2::description(parts, folder, DESCRIPTION_BYTES);
    };
    let json: Value = serde_json::from_slice(&bytes)
        .map_err(|cause| Fault::damaged(format!("{}: {cause}", within(folder, DESCRIPTION))))?;
    if json["zarr_format"] != 3 {
        return Err(Fault::damaged(format!("zarr_format is {}; 2 and 3 are read", json["zarr_format"])));
    }
    Ok(Some(json))
}

fn within(folder: &str, name: &str) -> String {
    if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") }
}

/// The arrays right below a group: as its description lists them, or else as its folders are there.
fn arrays_of_group(parts: &dyn Parts, root: &Value) -> Result<Vec<Array>, Fault> {
    let listed = root["consolidated_metadata"]["metadata"].as_object();
    let mut nodes: Vec<(String, Value)> = Vec::new();
    if let Some(listed) = listed {
        let right_below = listed.iter().filter(|(name, _)| !name.contains('/'));
        nodes.extend(right_below.map(|(name, node)| (name.clone(), node.clone())));
    } else {
        for folder in parts.folders()?.into_iter().take(MAX_ARRAYS) {
            nodes.extend(description(parts, &folder)?.map(|node| (folder, node)));
        }
    }
    let is_array = |(_, node): &&(String, Value)| node["node_type"] == "array";
    nodes.iter().filter(is_array).take(MAX_ARRAYS).map(|(name, node)| Array::of(plain(name)?, node)).collect()
}

/// The name, where it leads to a folder within that of the group.
fn plain(name: &str) -> Result<&str, Fault> {
    let leads_away = ["", ".", ".."].contains(&name) || name.contains(['/', '\\', '\0', ':']);
    if leads_away { Err(Fault::damaged(format!("an array is called {name:?}"))) } else { Ok(name) }
}

/// A folder of arrays.
struct Folder<'a> {
    parts: &'a dyn Parts,
    limits: Limits,
    attributes: Attributes,
    arrays: Vec<Array>,
    described: Vec<Described>,
}

impl Source for Folder<'_> {
    fn attributes(&self) -> &Attributes {
        &self.attributes
    }

    fn variables(&self) -> &[Described] {
        &self.described
    }

    fn each(&self, described: &Described, take: &mut dyn FnMut(usize, f64)) -> Result<(), Fault> {
        let found = self.arrays.iter().find(|array| array.name == described.name);
        let array = found.expect("descriptions are made from the arrays");
        let storage = array.storage()?;
        let length = self.chunk_length(array, &storage)?;
        let (files, strides) = (storage.files(&array.shape), storage.strides()?);
        for number in 0..files.iter().product() {
            let at = place(number, &files);
            let key = within(&array.name, &storage.key(&at[..files.len()]));
            let most = storage.shards.as_ref().map_or(Codecs::most(length), |shards| shards.most(length));
            let packed = self.parts.read(&PartName::Inside(key.clone()), most)?;
            let file = File { array, storage: &storage, strides: &strides, length, at };
            let taken = file.each(packed, take);
            taken.map_err(|fault| Fault::damaged(format!("{key}: {fault}")))?;
        }
        Ok(())
    }
}

impl Storage {
    /// Files of chunks along each dimension.
    fn files(&self, shape: &[usize]) -> Vec<usize> {
        let chunks = shape.iter().zip(&self.chunk).enumerate();
        chunks.map(|(axis, (all, chunk))| all.div_ceil(chunk * self.chunks_of_file(axis))).collect()
    }
}

/// A file of one chunk or of many.
struct File<'a> {
    array: &'a Array,
    storage: &'a Storage,
    /// Numbers of a chunk from one to the next along each dimension.
    strides: &'a [usize],
    /// Bytes of a chunk.
    length: usize,
    /// Place among the files.
    at: Place,
}

impl File<'_> {
    /// Hands over its numbers, or the fill value where there is no such file.
    fn each(&self, packed: Option<Vec<u8>>, take: &mut dyn FnMut(usize, f64)) -> Result<(), Fault> {
        let Some(shards) = &self.storage.shards else {
            let chunk = packed.map(|packed| self.storage.codecs.decode(packed, self.length)).transpose()?;
            self.numbers(&self.at, chunk.as_deref(), take);
            return Ok(());
        };
        let places = packed.as_ref().map(|packed| shards.places(packed)).transpose()?;
        for number in 0..shards.counts.iter().product() {
            let mut at = place(number, &shards.counts);
            for (axis, count) in shards.counts.iter().enumerate() {
                at[axis] += self.at[axis] * count;
            }
            let packed = packed.as_ref().zip(places.as_ref().and_then(|places| places[number].clone()));
            let packed = packed.map(|(shard, place)| shard[place].to_vec());
            // What lies beyond the array is in no cell, but its chunk may be there.
            if self.is_within(&at) {
                let chunk =
                    packed.map(|packed| self.storage.codecs.decode(packed, self.length)).transpose()?;
                self.numbers(&at, chunk.as_deref(), take);
            }
        }
        Ok(())
    }

    /// Whether the chunk at a place has cells of the array.
    fn is_within(&self, at: &Place) -> bool {
        let axes = self.array.shape.iter().zip(&self.storage.chunk).zip(at);
        axes.fold(true, |within, ((all, chunk), at)| within && at * chunk < *all)
    }

    /// Hands over the numbers of the chunk at a place, or the fill value where there is none.
    fn numbers(&self, at: &Place, chunk: Option<&[u8]>, take: &mut dyn FnMut(usize, f64)) {
        let rows = Rows::of(&self.array.shape, (&self.storage.chunk, self.strides), at);
        numbers_of(&rows, self.storage, chunk, take);
    }
}

impl Folder<'_> {
    /// Bytes of a chunk, as far as those of all chunks of a file are within the limits.
    fn chunk_length(&self, array: &Array, storage: &Storage) -> Result<usize, Fault> {
        let most = self.limits.cells.saturating_mul(8);
        let bytes = storage.chunk_bytes();
        let of_file = (0..storage.chunk.len()).try_fold(bytes.unwrap_or(usize::MAX), |bytes, axis| {
            bytes.checked_mul(storage.chunks_of_file(axis))
        });
        bytes.filter(|_| of_file.is_some_and(|bytes| bytes <= most)).ok_or_else(|| {
            let asked = bytes.map(|bytes| bytes as u64);
            let limit = Limit::new(Quantity::MemoryBytes, asked, 0..=most as u64);
            let subject = format!("a chunk of {:?} numbers of `{}`", storage.chunk, array.name);
            limit.of(subject).remedy("write it in smaller chunks").into()
        })
    }
}

/// Hands over the numbers of a chunk, or the fill value where there is none.
fn numbers_of(rows: &Rows<'_>, storage: &Storage, chunk: Option<&[u8]>, take: &mut dyn FnMut(usize, f64)) {
    let bytes = storage.number.bytes;
    let step = rows.strides.last().copied().unwrap_or(1);
    for (in_array, in_chunk) in rows.starts() {
        for column in 0..rows.length() {
            let number = chunk.map_or(storage.fill, |chunk| {
                let first = (in_chunk + column * step) * bytes;
                storage.number.value(&chunk[first..][..bytes], storage.codecs.is_big)
            });
            take(in_array + column, number);
        }
    }
}

/// Positions along each dimension; those beyond the last are 0.
type Place = [usize; MAX_DIMENSIONS];

/// The place of the element at a row-major position.
fn place(mut position: usize, shape: &[usize]) -> Place {
    let mut place = [0; MAX_DIMENSIONS];
    for (axis, length) in shape.iter().enumerate().rev() {
        place[axis] = position % length;
        position /= length;
    }
    place
}

/// The row-major position of an element.
fn position(place: &Place, shape: &[usize]) -> usize {
    shape.iter().zip(place).fold(0, |position, (length, at)| position * length + at)
}

/// The part of a chunk that lies within its array, row by row along the last dimension.
struct Rows<'a> {
    shape: &'a [usize],
    /// Numbers of the chunk from one to the next along each dimension.
    strides: &'a [usize],
    /// First element of the chunk.
    origin: Place,
    /// Elements of the chunk within the array along each dimension.
    extent: Vec<usize>,
}

impl<'a> Rows<'a> {
    /// Of the chunk of that shape and those strides at `place` among the chunks.
    fn of(shape: &'a [usize], (chunk, strides): (&[usize], &'a [usize]), place: &Place) -> Self {
        let mut origin = [0; MAX_DIMENSIONS];
        for (axis, length) in chunk.iter().enumerate() {
            origin[axis] = place[axis] * length;
        }
        let extent =
            shape.iter().zip(chunk).zip(&origin).map(|((all, chunk), first)| (*chunk).min(all - first));
        Self { shape, strides, origin, extent: extent.collect() }
    }

    /// Elements in a row.
    fn length(&self) -> usize {
        self.extent.last().copied().unwrap_or(1)
    }

    /// Where each row begins: its position in the array and in the chunk.
    fn starts(&self) -> impl Iterator<Item = (usize, usize)> {
        let rows = self.extent.len().saturating_sub(1);
        let (across, count) = (&self.extent[..rows], self.extent[..rows].iter().product());
        (0..count).map(move |row| {
            let inside = place(row, across);
            let mut whole = inside;
            whole.iter_mut().zip(&self.origin).for_each(|(at, first)| *at += first);
            let in_chunk = inside.iter().zip(self.strides).map(|(at, stride)| at * stride).sum();
            (position(&whole, self.shape), in_chunk)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chunk_at_the_edge_has_only_the_rows_within_the_array() {
        let rows = Rows::of(&[5, 7], (&[3, 4], &[4, 1]), &place(3, &[2, 2]));
        assert_eq!(rows.length(), 3);
        // Rows 3 and 4 from column 4.
        assert_eq!(rows.starts().collect::<Vec<_>>(), [(25, 0), (32, 4)]);
        let turned = Rows::of(&[5, 7], (&[3, 4], &[1, 3]), &place(3, &[2, 2]));
        assert_eq!(turned.starts().collect::<Vec<_>>(), [(25, 0), (32, 1)], "columns first");
    }

    #[test]
    fn a_single_number_is_a_row_of_one() {
        let rows = Rows::of(&[], (&[], &[]), &place(0, &[]));
        assert_eq!((rows.length(), rows.starts().collect::<Vec<_>>()), (1, vec![(0, 0)]));
    }
}

//! Numbers out of a group or a single array.

use serde_json::Value;

use super::super::cf::{self, Attributes, Described, Source};
use super::super::{Fault, Limits, PartName, Parts, Raster};
use super::attributes;
use super::chunks::{Rows, place};
use super::codec::Codecs;
use super::metadata::{Array, DESCRIPTION, Storage};
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
    let root = description(parts, "")?.ok_or_else(|| no_description(parts))?;
    let arrays = match root["node_type"].as_str() {
        Some("group") => arrays_of_group(parts, &root)?,
        Some("array") => vec![Array::of("", &root)?],
        _ => return Err(Fault::damaged("zarr.json describes neither a group nor an array")),
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
    let Some(bytes) = parts.read(&name, DESCRIPTION_BYTES)? else { return Ok(None) };
    let json: Value = serde_json::from_slice(&bytes)
        .map_err(|cause| Fault::damaged(format!("{}: {cause}", within(folder, DESCRIPTION))))?;
    if json["zarr_format"] != 3 {
        return Err(Fault::damaged(format!("zarr_format is {}; 3 is read", json["zarr_format"])));
    }
    Ok(Some(json))
}

fn within(folder: &str, name: &str) -> String {
    if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") }
}

fn no_description(parts: &dyn Parts) -> Fault {
    let is_old = [".zgroup", ".zarray", ".zmetadata"].iter().any(|name| {
        let part = PartName::Inside((*name).to_owned());
        parts.read(&part, DESCRIPTION_BYTES).is_ok_and(|part| part.is_some())
    });
    Fault::damaged(if is_old {
        "Zarr version 2; version 3 is read: with xarray ds.to_zarr(path, zarr_format=3)"
    } else {
        "the folder has no zarr.json, so it is not Zarr version 3 or not whole"
    })
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
        let counts: Vec<usize> =
            array.shape.iter().zip(&storage.chunk).map(|(all, chunk)| all.div_ceil(*chunk)).collect();
        for number in 0..counts.iter().product() {
            let at = place(number, &counts);
            let key = within(&array.name, &storage.key(&at[..counts.len()]));
            let packed = self.parts.read(&PartName::Inside(key.clone()), Codecs::most(length))?;
            let chunk = packed.map(|packed| storage.codecs.decode(packed, length)).transpose();
            let chunk = chunk.map_err(|fault| Fault::damaged(format!("{key}: {fault}")))?;
            let rows = Rows::of(&array.shape, &storage.chunk, &at);
            numbers_of(&rows, &storage, chunk.as_deref(), take);
        }
        Ok(())
    }
}

impl Folder<'_> {
    /// Bytes of a chunk, as far as they are within the limits.
    fn chunk_length(&self, array: &Array, storage: &Storage) -> Result<usize, Fault> {
        let most = self.limits.cells.saturating_mul(8);
        let bytes = storage.chunk_bytes();
        bytes.filter(|bytes| *bytes <= most).ok_or_else(|| {
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
    for (in_array, in_chunk) in rows.starts() {
        let row = chunk.map(|chunk| &chunk[in_chunk * bytes..][..rows.length() * bytes]);
        for column in 0..rows.length() {
            let number = row.map_or(storage.fill, |row| {
                storage.number.value(&row[column * bytes..][..bytes], storage.codecs.is_big)
            });
            take(in_array + column, number);
        }
    }
}

//! The files of a group: descriptions, then chunk after chunk.

use std::io::Write;

use flate2::Compression;
use flate2::write::GzEncoder;
use rayon::prelude::*;
use serde_json::{Map, Value, json};

use super::super::Part;
use super::super::cf::{Cells, Dataset, NO_CLASS, Order, Values, Variable};
use super::attributes;
use super::metadata::DESCRIPTION;
use super::shard;
use weald_core::grid::Size;

/// Cells along each side of a chunk of a layer.
pub(super) const CHUNK: usize = 256;

/// Level of gzip: beyond it, heights get hardly smaller and take far longer.
const LEVEL: u32 = 6;

/// Which chunks of a layer share a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Files {
    /// None.
    OfChunks,
    /// So many that lie side by side: a shard.
    OfShards(usize),
}

/// All files of a group.
pub(super) fn parts(dataset: &Dataset<'_>, files: Files) -> Vec<Part> {
    let mut parts = descriptions(dataset, files);
    parts.extend(layers(dataset, 0, files));
    parts
}

/// The files without values of layers: what describes the group and its arrays, and the coordinates.
pub(super) fn descriptions(dataset: &Dataset<'_>, files: Files) -> Vec<Part> {
    let described: Vec<(&Variable<'_>, Value)> =
        dataset.variables.iter().map(|variable| (variable, array(variable, dataset.size, files))).collect();
    let listed: Map<String, Value> =
        described.iter().map(|(variable, array)| (variable.name.clone(), array.clone())).collect();
    let group = json!({
        "zarr_format": 3,
        "node_type": "group",
        "attributes": attributes::to_json(&dataset.attributes),
        "consolidated_metadata": { "kind": "inline", "must_understand": false, "metadata": listed },
    });
    let mut parts = vec![description(DESCRIPTION, &group)];
    for (variable, array) in &described {
        parts.push(description(&format!("{}/{DESCRIPTION}", variable.name), array));
        if let Values::Along(_, centres) = &variable.values {
            let bytes: Vec<u8> = centres.iter().flat_map(|centre| centre.to_le_bytes()).collect();
            parts.push(Part::inside(format!("{}/c/0", variable.name), gzip(&bytes)));
        }
    }
    parts
}

/// The chunks of all layers, whose first row is this one of the grid.
pub(super) fn layers(dataset: &Dataset<'_>, first: usize, files: Files) -> Vec<Part> {
    let of_variable = |variable: &Variable<'_>| match &variable.values {
        Values::Cells(cells) => {
            chunks(&variable.name, &Strip { cells: *cells, first, whole: dataset.size }, files)
        }
        Values::Nothing | Values::Along(..) => Vec::new(),
    };
    dataset.variables.iter().flat_map(of_variable).collect()
}

fn description(path: &str, json: &Value) -> Part {
    Part::inside(path, format!("{json:#}\n").into_bytes())
}

/// The description of an array.
fn array(variable: &Variable<'_>, size: Size, files: Files) -> Value {
    let axes = variable.values.axes();
    let shape: Vec<usize> = axes.iter().map(|axis| axis.length(size)).collect();
    let packed = json!([
        { "name": "bytes", "configuration": { "endian": "little" } },
        { "name": "gzip", "configuration": { "level": LEVEL } },
    ]);
    let of_cells = |size: Size| json!([size.rows, size.columns]);
    let chunk = chunk_of(size);
    let (chunks, codecs) = match (&variable.values, files) {
        (Values::Nothing, _) => (json!([]), packed),
        (Values::Along(..), _) => (json!(shape), packed),
        (Values::Cells(..), Files::OfChunks) => (of_cells(chunk), packed),
        (Values::Cells(..), Files::OfShards(most)) => {
            let shard = Size { columns: chunk.columns * across(size).min(most), rows: chunk.rows };
            (of_cells(shard), shard::codecs(&of_cells(chunk), &packed))
        }
    };
    let (data_type, fill) = match &variable.values {
        Values::Nothing => ("int32", json!(0)),
        Values::Along(..) => ("float64", json!("NaN")),
        Values::Cells(cells) if cells.are_whole() => ("int32", json!(NO_CLASS)),
        Values::Cells(..) => ("float32", json!("NaN")),
    };
    json!({
        "zarr_format": 3,
        "node_type": "array",
        "shape": shape,
        "data_type": data_type,
        "chunk_grid": { "name": "regular", "configuration": { "chunk_shape": chunks } },
        "chunk_key_encoding": { "name": "default", "configuration": { "separator": "/" } },
        "fill_value": fill,
        "codecs": codecs,
        "attributes": attributes::to_json(&variable.attributes),
        "dimension_names": axes.iter().map(|axis| axis.name()).collect::<Vec<_>>(),
        "storage_transformers": [],
    })
}

/// Columns and rows of a chunk.
fn chunk_of(size: Size) -> Size {
    Size { columns: CHUNK.min(size.columns), rows: CHUNK.min(size.rows) }
}

/// Chunks side by side.
fn across(size: Size) -> usize {
    size.columns.div_ceil(CHUNK)
}

/// Rows of a layer that begin with a row of chunks.
struct Strip<'a> {
    cells: Cells<'a>,
    /// Its first row in the whole.
    first: usize,
    whole: Size,
}

/// The files of a layer; chunks that hold the fill value alone are left out.
fn chunks(name: &str, strip: &Strip<'_>, files: Files) -> Vec<Part> {
    let across = across(strip.whole);
    let (first, count) = (strip.first / CHUNK, across * strip.cells.size().rows.div_ceil(CHUNK));
    let packed = (0..count).into_par_iter().map(|number| {
        let chunk = [number % across, first + number / across];
        strip.chunk(chunk).map(|bytes| gzip(&bytes))
    });
    let packed: Vec<Option<Vec<u8>>> = packed.collect();
    let (files, across) = match files {
        Files::OfChunks => (packed, across),
        Files::OfShards(most) => {
            let most = across.min(most);
            let shards = packed.chunks(across).flat_map(|row| row.chunks(most));
            (shards.map(|chunks| shard::joined(chunks, most)).collect(), across.div_ceil(most))
        }
    };
    let part = |(number, bytes): (usize, Option<Vec<u8>>)| {
        let (x, y) = (number % across, first + number / across);
        Some(Part::inside(format!("{name}/c/{y}/{x}"), bytes?))
    };
    files.into_iter().enumerate().filter_map(part).collect()
}

impl Strip<'_> {
    /// The bytes of a chunk, filled up with NaN beyond the edges; `None` where no cell has data.
    fn chunk(&self, [chunk_x, chunk_y]: [usize; 2]) -> Option<Vec<u8>> {
        let Size { columns: width, rows: height } = chunk_of(self.whole);
        let mut bytes = Vec::with_capacity(width * height * 4);
        let mut has_data = false;
        for y in chunk_y * height..(chunk_y + 1) * height {
            for x in chunk_x * width..(chunk_x + 1) * width {
                let is_inside = x < self.whole.columns && y < self.whole.rows;
                let value = if is_inside { self.cells.at(x, y - self.first) } else { f32::NAN };
                has_data |= !value.is_nan();
                bytes.extend(self.cells.bytes(value, Order::Little));
            }
        }
        has_data.then_some(bytes)
    }
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::new(LEVEL));
    let packed = encoder.write_all(bytes).and_then(|()| encoder.finish());
    packed.expect("writing to memory does not fail")
}

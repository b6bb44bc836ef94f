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
use weald_core::grid::Size;

/// Cells along each side of a chunk of a layer.
const CHUNK: usize = 256;

/// Level of gzip: beyond it, heights get hardly smaller and take far longer.
const LEVEL: u32 = 6;

/// All files of a group.
pub(super) fn parts(dataset: &Dataset<'_>) -> Vec<Part> {
    let described: Vec<(&Variable<'_>, Value)> =
        dataset.variables.iter().map(|variable| (variable, array(variable, dataset.size))).collect();
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
        parts.extend(chunks(variable));
    }
    parts
}

fn description(path: &str, json: &Value) -> Part {
    Part::inside(path, format!("{json:#}\n").into_bytes())
}

/// The description of an array.
fn array(variable: &Variable<'_>, size: Size) -> Value {
    let axes = variable.values.axes();
    let shape: Vec<usize> = axes.iter().map(|axis| axis.length(size)).collect();
    let (data_type, chunk, fill) = match &variable.values {
        Values::Nothing => ("int32", Vec::new(), json!(0)),
        Values::Along(..) => ("float64", shape.clone(), json!("NaN")),
        Values::Cells(cells) if cells.are_whole() => {
            ("int32", shape.iter().map(|side| CHUNK.min(*side)).collect(), json!(NO_CLASS))
        }
        Values::Cells(..) => ("float32", shape.iter().map(|side| CHUNK.min(*side)).collect(), json!("NaN")),
    };
    json!({
        "zarr_format": 3,
        "node_type": "array",
        "shape": shape,
        "data_type": data_type,
        "chunk_grid": { "name": "regular", "configuration": { "chunk_shape": chunk } },
        "chunk_key_encoding": { "name": "default", "configuration": { "separator": "/" } },
        "fill_value": fill,
        "codecs": [
            { "name": "bytes", "configuration": { "endian": "little" } },
            { "name": "gzip", "configuration": { "level": LEVEL } },
        ],
        "attributes": attributes::to_json(&variable.attributes),
        "dimension_names": axes.iter().map(|axis| axis.name()).collect::<Vec<_>>(),
        "storage_transformers": [],
    })
}

/// The chunks of an array; those that hold the fill value alone are left out.
fn chunks(variable: &Variable<'_>) -> Vec<Part> {
    let part = |key: &str, bytes: &[u8]| Part::inside(format!("{}/{key}", variable.name), gzip(bytes));
    match &variable.values {
        Values::Nothing => Vec::new(),
        Values::Along(_, centres) => {
            let bytes: Vec<u8> = centres.iter().flat_map(|centre| centre.to_le_bytes()).collect();
            vec![part("c/0", &bytes)]
        }
        Values::Cells(cells) => {
            let across = cells.size().columns.div_ceil(CHUNK);
            let count = across * cells.size().rows.div_ceil(CHUNK);
            let chunk = |number: usize| {
                let (x, y) = (number % across, number / across);
                Some(part(&format!("c/{y}/{x}"), &chunk_of(cells, (x, y))?))
            };
            (0..count).into_par_iter().filter_map(chunk).collect()
        }
    }
}

/// The bytes of a chunk of cells, filled up with NaN beyond the edges; `None` where no cell has data.
fn chunk_of(cells: &Cells<'_>, (chunk_x, chunk_y): (usize, usize)) -> Option<Vec<u8>> {
    let size = cells.size();
    let (width, height) = (CHUNK.min(size.columns), CHUNK.min(size.rows));
    let mut bytes = Vec::with_capacity(width * height * 4);
    let mut has_data = false;
    for y in chunk_y * height..(chunk_y + 1) * height {
        for x in chunk_x * width..(chunk_x + 1) * width {
            let value = if x < size.columns && y < size.rows { cells.at(x, y) } else { f32::NAN };
            has_data |= !value.is_nan();
            bytes.extend(cells.bytes(value, Order::Little));
        }
    }
    has_data.then_some(bytes)
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::new(LEVEL));
    let packed = encoder.write_all(bytes).and_then(|()| encoder.finish());
    packed.expect("writing to memory does not fail")
}

//! What the `zarr.json` of an array says.

use serde_json::Value;

use super::super::Fault;
use super::super::cf::{Attributes, Described};
use super::super::number::Number;
use super::attributes;
use super::codec::{Codecs, lengths};
use super::shard::{Sharded, Shards};

/// Name of the description in a group's or an array's folder.
pub(super) const DESCRIPTION: &str = "zarr.json";

/// Most dimensions of an array.
pub(super) const MAX_DIMENSIONS: usize = 8;

/// An array as described.
#[derive(Clone, Debug)]
pub(super) struct Array {
    pub(super) name: String,
    /// Length of each dimension.
    pub(super) shape: Vec<usize>,
    json: Value,
}

/// How the numbers of an array are stored.
#[derive(Clone, Debug)]
pub(super) struct Storage {
    pub(super) number: Number,
    /// Length of a chunk along each dimension.
    pub(super) chunk: Vec<usize>,
    /// What stands where no chunk is.
    pub(super) fill: f64,
    pub(super) codecs: Codecs,
    /// How the chunks lie in files, where each file has many.
    pub(super) shards: Option<Shards>,
    /// Key of the chunks but for their numbers, and what stands between those.
    keys: (&'static str, &'static str),
}

impl Array {
    /// # Errors
    /// [`Fault::Damaged`] for a description without a shape of up to eight dimensions.
    pub(super) fn of(name: &str, json: &Value) -> Result<Self, Fault> {
        let shape = lengths(&json["shape"]).filter(|shape| shape.len() <= MAX_DIMENSIONS);
        let shape = shape.ok_or_else(|| damaged(name, "shape", &json["shape"]))?;
        Ok(Self { name: name.to_owned(), shape, json: json.clone() })
    }

    /// The array as CF sees it.
    pub(super) fn described(&self) -> Described {
        let named = self.json["dimension_names"].as_array();
        let dimension = |axis: usize| {
            let name = named.and_then(|names| names.get(axis)?.as_str());
            name.map_or_else(|| format!("dimension_{axis}"), str::to_owned)
        };
        let data_type = self.json["data_type"].as_str();
        Described {
            name: self.name.clone(),
            dimensions: (0..self.shape.len()).map(dimension).collect(),
            shape: self.shape.clone(),
            attributes: self.attributes(),
            stored: data_type.and_then(Number::of).map_or("unknown", |number| number.name),
            is_number: data_type
                .is_some_and(|name| ["float", "int", "uint"].iter().any(|kind| name.starts_with(kind))),
            default_fill: None,
        }
    }

    fn attributes(&self) -> Attributes {
        attributes::of_json(self.json.get("attributes"))
    }

    /// How its numbers are stored.
    ///
    /// # Errors
    /// [`Fault::Damaged`] for a type, a chunk grid or a codec that is not read, with its name.
    pub(super) fn storage(&self) -> Result<Storage, Fault> {
        let wrong = |key: &str| damaged(&self.name, key, &self.json[key]);
        let number = self.json["data_type"].as_str().and_then(Number::of).ok_or_else(|| {
            Fault::damaged(format!(
                "`{}` holds numbers of type {}; float32, float64 and integers of 8 to 64 bits are read",
                self.name, self.json["data_type"]
            ))
        })?;
        let grid = &self.json["chunk_grid"];
        let chunk = lengths(&grid["configuration"]["chunk_shape"]).filter(|chunk| {
            grid["name"] == "regular" && chunk.len() == self.shape.len() && !chunk.contains(&0)
        });
        let file = chunk.ok_or_else(|| wrong("chunk_grid"))?;
        let (chunk, codecs, shards) = match Sharded::of(&self.name, &self.json["codecs"], &file)? {
            Some(Sharded { chunk, codecs, shards }) => (chunk, codecs, Some(shards)),
            None => (file, &self.json["codecs"], None),
        };
        Ok(Storage {
            number,
            chunk,
            fill: fill(&self.json["fill_value"], number).ok_or_else(|| wrong("fill_value"))?,
            codecs: Codecs::of(&self.name, codecs)?,
            shards,
            keys: keys(&self.json["chunk_key_encoding"]).ok_or_else(|| wrong("chunk_key_encoding"))?,
        })
    }
}

impl Storage {
    /// Bytes of a chunk without codecs; `None` beyond all numbers.
    pub(super) fn chunk_bytes(&self) -> Option<usize> {
        self.chunk.iter().try_fold(self.number.bytes, |bytes, length| bytes.checked_mul(*length))
    }

    /// How many numbers of a chunk lie from one to the next along each dimension.
    ///
    /// # Errors
    /// [`Fault::Damaged`] for a transpose that is no order of the dimensions.
    pub(super) fn strides(&self) -> Result<Vec<usize>, Fault> {
        let axes: Vec<usize> = (0..self.chunk.len()).collect();
        let order = self.codecs.order.as_ref().unwrap_or(&axes);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        if sorted != axes {
            return Err(Fault::damaged(format!("a transpose of {} dimensions by {order:?}", axes.len())));
        }
        let (mut strides, mut next) = (vec![0; axes.len()], 1);
        for &axis in order.iter().rev() {
            strides[axis] = next;
            next *= self.chunk[axis];
        }
        Ok(strides)
    }

    /// Chunks of a file along a dimension.
    pub(super) fn chunks_of_file(&self, axis: usize) -> usize {
        self.shards.as_ref().map_or(1, |shards| shards.counts[axis])
    }

    /// The key of a file of chunks, such as `c/0/0`.
    pub(super) fn key(&self, place: &[usize]) -> String {
        let (prefix, between) = self.keys;
        let numbers: Vec<String> = place.iter().map(usize::to_string).collect();
        let first = (!prefix.is_empty()).then(|| prefix.to_owned());
        first.into_iter().chain(numbers).collect::<Vec<_>>().join(between)
    }
}

fn damaged(name: &str, key: &str, value: &Value) -> Fault {
    let shown: String = value.to_string().chars().take(200).collect();
    Fault::damaged(format!("`{name}`: `{key}` is {shown}, which Zarr does not have or Weald not read"))
}

/// The number behind a `fill_value`: as such, by name, or as the digits of its bits.
fn fill(value: &Value, number: Number) -> Option<f64> {
    match value.as_str() {
        None => value.as_f64(),
        Some("NaN") => Some(f64::NAN),
        Some("Infinity") => Some(f64::INFINITY),
        Some("-Infinity") => Some(f64::NEG_INFINITY),
        Some(text) => {
            let bits = u64::from_str_radix(text.strip_prefix("0x")?, 16).ok()?;
            Some(number.value(&bits.to_be_bytes()[8 - number.bytes..], true))
        }
    }
}

/// Prefix and separator of the keys of chunks.
fn keys(encoding: &Value) -> Option<(&'static str, &'static str)> {
    let (prefix, usual) = match encoding["name"].as_str()? {
        "default" => ("c", "/"),
        "v2" => ("", "."),
        _ => return None,
    };
    let separator = encoding["configuration"]["separator"].as_str().unwrap_or(usual);
    ["/", "."].into_iter().find(|known| *known == separator).map(|separator| (prefix, separator))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn chunks_have_keys_as_the_specification_gives_them() {
        let key = |encoding: Value| {
            let array = json!({ "shape": [9, 9], "data_type": "int16", "fill_value": 0, "codecs": [{ "name": "bytes",
                "configuration": { "endian": "little" } }], "chunk_key_encoding": encoding,
                "chunk_grid": { "name": "regular", "configuration": { "chunk_shape": [4, 4] } } });
            Array::of("a", &array).and_then(|array| array.storage()).map(|storage| storage.key(&[1, 2]))
        };
        assert_eq!(key(json!({ "name": "default" })), Ok("c/1/2".to_owned()));
        let dots = json!({ "name": "default", "configuration": { "separator": "." } });
        assert_eq!(key(dots), Ok("c.1.2".to_owned()));
        assert_eq!(key(json!({ "name": "v2" })), Ok("1.2".to_owned()));
        assert!(key(json!({ "name": "own" })).is_err());
    }

    #[test]
    fn fill_values_are_numbers_names_or_bits() {
        let of = |value: Value, kind: &str| fill(&value, Number::of(kind).expect("known"));
        assert_eq!(of(json!(-9999), "int16"), Some(-9999.0));
        assert!(of(json!("NaN"), "float32").is_some_and(f64::is_nan));
        assert_eq!(of(json!("-Infinity"), "float32"), Some(f64::NEG_INFINITY));
        assert_eq!(of(json!("0x3fc00000"), "float32"), Some(1.5));
        assert!(of(json!("0x7fc00001"), "float32").is_some_and(f64::is_nan));
        assert_eq!(of(json!("a lot"), "float32"), None);
        assert_eq!(of(Value::Null, "float32"), None);
    }
}

//! Zarr version 2 (Zarr storage specification 2), by bringing its descriptions into the form of version 3.
//!
//! An array lies in `.zarray`, its attributes in `.zattrs`, and `.zmetadata` may repeat those of a whole group. Names of
//! dimensions are xarray's attribute `_ARRAY_DIMENSIONS`; `fill_value` stands for no-data as well, as xarray and GDAL
//! take it.

use serde_json::{Map, Value, json};

use super::super::{Fault, PartName, Parts};

/// Names of the descriptions.
const ARRAY: &str = ".zarray";
const ATTRIBUTES: &str = ".zattrs";
const ALL: &str = ".zmetadata";

/// The description of a folder as version 3 has it; `None` where the folder is none of version 2.
///
/// # Errors
/// [`Fault`] for a description that is damaged.
pub(super) fn description(parts: &dyn Parts, folder: &str, most: u64) -> Result<Option<Value>, Fault> {
    let within = |name: &str| if folder.is_empty() { name.to_owned() } else { format!("{folder}/{name}") };
    let read = |name: &str| -> Result<Option<Value>, Fault> {
        let Some(bytes) = parts.read(&PartName::Inside(within(name)), most)? else { return Ok(None) };
        let json = serde_json::from_slice(&bytes);
        json.map(Some).map_err(|cause| Fault::damaged(format!("{}: {cause}", within(name))))
    };
    if let Some(array) = read(ARRAY)? {
        return Ok(Some(array_of(&array, read(ATTRIBUTES)?.as_ref())));
    }
    if let Some(all) = read(ALL)? {
        return Ok(Some(group_of(&all["metadata"])));
    }
    let Some(_) = read(".zgroup")? else { return Ok(None) };
    let attributes = read(ATTRIBUTES)?.unwrap_or_else(|| json!({}));
    Ok(Some(json!({ "zarr_format": 2, "node_type": "group", "attributes": attributes })))
}

/// A group with the arrays that consolidated metadata list.
fn group_of(listed: &Value) -> Value {
    let none = Map::new();
    let listed = listed.as_object().unwrap_or(&none);
    let mut nodes = Map::new();
    for (key, array) in listed {
        if let Some(name) = key.strip_suffix(ARRAY).and_then(|name| name.strip_suffix('/')) {
            let attributes = listed.get(&format!("{name}/{ATTRIBUTES}"));
            nodes.insert(name.to_owned(), array_of(array, attributes));
        }
    }
    let attributes = listed.get(ATTRIBUTES).cloned().unwrap_or_else(|| json!({}));
    json!({
        "zarr_format": 2, "node_type": "group", "attributes": attributes,
        "consolidated_metadata": { "metadata": nodes },
    })
}

/// An array as version 3 describes it.
fn array_of(array: &Value, attributes: Option<&Value>) -> Value {
    let (data_type, endian) = data_type(array["dtype"].as_str().unwrap_or_default());
    let dimensions = array["shape"].as_array().map_or(0, Vec::len);
    let backwards: Vec<usize> = (0..dimensions).rev().collect();
    let turned = (array["order"] == "F" && dimensions > 1)
        .then(|| json!({ "name": "transpose", "configuration": { "order": backwards } }));
    let filters = array["filters"].as_array().map(Vec::as_slice).unwrap_or_default();
    let packings = filters.iter().chain(Some(&array["compressor"]).filter(|it| !it.is_null())).map(codec);
    let bytes = json!({ "name": "bytes", "configuration": { "endian": endian } });
    let codecs: Vec<Value> = turned.into_iter().chain([bytes]).chain(packings).collect();
    let separator = array["dimension_separator"].as_str().unwrap_or(".");
    let mut attributes = attributes.cloned().unwrap_or_else(|| json!({}));
    let fill = &array["fill_value"];
    let absent = if fill.is_null() { Value::from(0) } else { fill.clone() };
    if fill.is_number() && attributes.get("_FillValue").is_none() {
        attributes["_FillValue"] = fill.clone();
    }
    json!({
        "zarr_format": 2, "node_type": "array",
        "shape": array["shape"], "data_type": data_type,
        "chunk_grid": { "name": "regular", "configuration": { "chunk_shape": array["chunks"] } },
        "chunk_key_encoding": { "name": "v2", "configuration": { "separator": separator } },
        "fill_value": absent,
        "codecs": codecs,
        "dimension_names": attributes["_ARRAY_DIMENSIONS"], "attributes": attributes,
    })
}

/// A compressor or filter, `{"id": "zlib", "level": 1}`, under its name.
fn codec(codec: &Value) -> Value {
    json!({ "name": codec["id"].as_str().unwrap_or("?"), "configuration": codec })
}

/// The type and the order of bytes behind NumPy's name for it, such as `<f4`; a type that there is not stays its name.
fn data_type(name: &str) -> (String, &'static str) {
    let endian = if name.starts_with('>') { "big" } else { "little" };
    let kind = name.trim_start_matches(['<', '>', '|']);
    let (family, bytes) = kind.split_at_checked(1).unwrap_or_default();
    let family = match family {
        "f" => "float",
        "i" => "int",
        "u" => "uint",
        _ => return (name.to_owned(), endian),
    };
    let bits = bytes.parse::<u32>().ok().and_then(|bytes| bytes.checked_mul(8));
    (bits.map_or_else(|| name.to_owned(), |bits| format!("{family}{bits}")), endian)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_array_of_version_2_is_described_as_one_of_version_3() {
        let array = json!({ "shape": [5, 7], "chunks": [2, 3], "dtype": ">i2", "order": "C", "fill_value": -7,
            "compressor": { "id": "zlib", "level": 1 }, "filters": null, "zarr_format": 2 });
        let attributes = json!({ "_ARRAY_DIMENSIONS": ["y", "x"] });
        let new = array_of(&array, Some(&attributes));
        assert_eq!((&new["data_type"], &new["dimension_names"]), (&json!("int16"), &json!(["y", "x"])));
        assert_eq!(new["codecs"][0]["configuration"]["endian"], "big");
        assert_eq!(
            (&new["codecs"][1]["name"], &new["attributes"]["_FillValue"]),
            (&json!("zlib"), &json!(-7))
        );
        let turned = array_of(&json!({ "shape": [5, 7], "order": "F", "dtype": "<f4" }), None);
        assert_eq!(turned["codecs"][0]["configuration"]["order"], json!([1, 0]));
        for odd in ["", "<", "é", "|S3", "<f999999999999"] {
            assert_eq!(data_type(odd).0, odd);
        }
    }
}

//! The JSON Schema of recipes, for editors that complete and check TOML: `weald schema`.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

use super::catalog::CATALOG;
use super::parameter::{Kind, Parameter, Parameters};
use super::plan::{FILM_EXTENSIONS, FilmKeys, FractalKeys, LandscapeKeys, MaterialKeys};
use weald_core::material::MOST;
use weald_export::EXPORTS;
use weald_io::FORMATS;
use weald_picture::PICTURES;

/// The schema, in the dialect of 2020-12.
pub fn schema() -> Value {
    let steps = CATALOG.iter().map(|entry| {
        let summary = format!("{} Source: {}.", entry.summary, entry.source);
        alternative("do", entry.name, &summary, &(entry.parameters)())
    });
    let pictures = PICTURES.iter().map(|entry| {
        let mut object = alternative("picture", entry.name, entry.summary, &(entry.parameters)());
        let extensions: Vec<_> = entry.extensions.iter().chain(FILM_EXTENSIONS).copied().collect();
        add_property(&mut object, "file", &file(&extensions));
        for key in FilmKeys::parameters() {
            object["properties"][key.name] = property(&key);
        }
        object
    });
    let exports = EXPORTS.iter().map(|entry| {
        let summary = format!("{} Source: {}.", entry.summary, entry.source);
        let mut object = alternative("export", entry.name, &summary, &(entry.parameters)());
        add_property(&mut object, "file", &file(entry.extensions));
        object
    });
    let outputs: Vec<_> = std::iter::once(layer_output()).chain(pictures).chain(exports).collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Weald recipe",
        "type": "object",
        "required": ["output"],
        "properties": {
            "landscape": landscape(),
            "material": {
                "type": "array",
                "maxItems": MOST,
                "items": table(&MaterialKeys::parameters()),
            },
            "fractal": { "type": "array", "items": table(&FractalKeys::parameters()) },
            "step": { "type": "array", "items": one_of(&steps.collect::<Vec<_>>()) },
            "output": {
                "type": "array",
                "minItems": 1,
                "items": one_of(&outputs),
            },
        },
        "additionalProperties": false,
    })
}

/// A size and an elevation model exclude each other.
fn landscape() -> Value {
    let mut object = table(&LandscapeKeys::parameters());
    object["not"] = json!({ "required": ["size", "from"] });
    object
}

fn one_of(alternatives: &[Value]) -> Value {
    json!({ "oneOf": alternatives })
}

fn file(extensions: &[&str]) -> Value {
    // Extensions count in upper and in lower case.
    let letter = |letter: char| format!("[{letter}{}]", letter.to_ascii_uppercase());
    let spelt = |word: &&str| word.chars().map(letter).collect::<String>();
    let pattern = extensions.iter().map(spelt).collect::<Vec<_>>().join("|");
    json!({
        "type": "string",
        "pattern": format!("\\.({pattern})$"),
        "description": "Name in the output folder; the extension chooses the format.",
    })
}

fn layer_output() -> Value {
    let mut layer = of_kind(&Kind::Layer);
    layer["description"] = "The layer that is written.".into();
    let extensions: Vec<_> = FORMATS.iter().flat_map(|format| format.extensions).copied().collect();
    json!({
        "type": "object",
        "properties": { "layer": layer, "file": file(&extensions), "preset": preset() },
        "required": ["layer", "file"],
        "additionalProperties": false,
    })
}

/// The readers that a layer can be written for, of all formats.
fn preset() -> Value {
    let presets: Vec<_> = FORMATS.iter().flat_map(|format| format.presets).collect();
    let names: BTreeSet<_> = presets.iter().map(|preset| preset.name).collect();
    let told: Vec<_> = presets.iter().map(|preset| format!("{}: {}", preset.name, preset.summary)).collect();
    json!({ "enum": names, "description": told.join(". ") })
}

/// A table that is told from others by the word under `key`.
fn alternative(key: &str, word: &str, summary: &str, parameters: &[Parameter]) -> Value {
    let mut object = table(parameters);
    object["description"] = summary.into();
    add_property(&mut object, key, &json!({ "const": word }));
    object
}

fn add_property(object: &mut Value, key: &str, schema: &Value) {
    object["properties"][key] = schema.clone();
    if let Some(required) = object["required"].as_array_mut() {
        required.push(key.into());
    }
}

fn table(parameters: &[Parameter]) -> Value {
    let properties: Map<String, Value> =
        parameters.iter().map(|parameter| (parameter.name.to_owned(), property(parameter))).collect();
    let required: Vec<_> =
        parameters.iter().filter(|parameter| parameter.required).map(|parameter| parameter.name).collect();
    json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    })
}

fn property(parameter: &Parameter) -> Value {
    let mut schema = of_kind(&parameter.kind);
    let doc = parameter.doc.split_whitespace().collect::<Vec<_>>().join(" ");
    let unit = if parameter.unit == "1" { String::new() } else { format!(" Unit: {}.", parameter.unit) };
    schema["description"] = format!("{doc}{unit}").into();
    // Defaults are written in TOML, of which numbers, flags, texts and lists are JSON too.
    let default = parameter.default.as_ref().and_then(|default| serde_json::from_str::<Value>(default).ok());
    if let Some(default) = default {
        schema["default"] = default;
    }
    schema
}

fn of_kind(kind: &Kind) -> Value {
    match kind {
        Kind::Number(low, high) => bounded("number", *low, *high),
        Kind::Integer(low, high) => bounded("integer", low.max(0.0), *high),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Choice(words) => json!({ "enum": words }),
        Kind::Text | Kind::Raster | Kind::Script | Kind::Flame => json!({ "type": "string" }),
        Kind::Colour => json!({ "type": "string", "pattern": "^#[0-9A-Fa-f]{6}$" }),
        Kind::Layer => json!({ "type": "string", "pattern": "^[A-Za-z0-9_-]{1,64}$" }),
        Kind::Layers => json!({ "type": "array", "items": of_kind(&Kind::Layer), "uniqueItems": true }),
        Kind::Numbers(low, high) => json!({ "type": "array", "items": bounded("number", *low, *high) }),
        Kind::Rows => {
            json!({ "type": "array", "items": of_kind(&Kind::Numbers(f64::NEG_INFINITY, f64::INFINITY)) })
        }
        Kind::Choices(words) => json!({ "type": "array", "items": of_kind(&Kind::Choice(words)) }),
        Kind::Sides => {
            let side = json!({ "type": "integer", "minimum": 1 });
            json!({ "oneOf": [side, { "type": "array", "items": side, "minItems": 2, "maxItems": 2 }] })
        }
        Kind::Places => {
            let place = json!({
                "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2,
            });
            json!({ "oneOf": [place, { "type": "array", "items": place, "minItems": 1 }] })
        }
        Kind::Table(parameters) => table(parameters),
        Kind::Tables(parameters) => json!({ "type": "array", "items": table(parameters) }),
    }
}

/// A number type with the bounds that are finite.
fn bounded(kind: &str, low: f64, high: f64) -> Value {
    let mut schema = json!({ "type": kind });
    for (key, bound) in [("minimum", low), ("maximum", high)] {
        if bound.is_finite() {
            schema[key] = if kind == "integer" { (bound as u64).into() } else { bound.into() };
        }
    }
    schema
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_schema_tells_ranges_and_defaults_of_the_landscape() {
        let schema = schema();
        let landscape = &schema["properties"]["landscape"]["properties"];
        assert_eq!(landscape["cell"]["maximum"], 100_000.0);
        assert_eq!(landscape["seed"]["default"], 0);
        assert_eq!(landscape["seed"]["type"], "integer");
        assert_eq!(schema["properties"]["landscape"]["not"]["required"], json!(["size", "from"]));
    }

    #[test]
    fn files_and_layers_that_a_run_would_refuse_are_refused() {
        let schema = schema();
        let output = &schema["properties"]["output"]["items"]["oneOf"][0]["properties"];
        assert_eq!(output["layer"]["pattern"], "^[A-Za-z0-9_-]{1,64}$");
        let pattern = output["file"]["pattern"].as_str().expect("a pattern");
        assert!(pattern.starts_with(r"\.([tT][iI][fF]|") && pattern.contains("|[nN][pP][yY]"), "{pattern}");
    }

    #[test]
    fn materials_are_described_and_counted() {
        let materials = &schema()["properties"]["material"];
        assert_eq!(materials["maxItems"], 8);
        assert_eq!(materials["items"]["required"], json!(["name"]));
        assert_eq!(materials["items"]["properties"]["colour"]["pattern"], "^#[0-9A-Fa-f]{6}$");
        assert_eq!(materials["items"]["properties"]["like"]["enum"][0], "rock");
    }

    #[test]
    fn every_step_picture_and_export_is_an_alternative() {
        let schema = schema();
        let count =
            |section: &str| schema["properties"][section]["items"]["oneOf"].as_array().map_or(0, Vec::len);
        assert_eq!(count("step"), CATALOG.len());
        assert_eq!(count("output"), PICTURES.len() + EXPORTS.len() + 1);
    }
}

//! The JSON Schema of recipes, for editors that complete and check TOML: `weald schema`.

use std::collections::BTreeSet;

use serde_json::{Map, Value, json};

use super::catalog::CATALOG;
use super::format;
use super::parameter::{Kind, Needs, Parameter, Parameters, Variant};
use super::plan::{FILM_EXTENSIONS, FilmKeys, FractalKeys, LandscapeKeys, MaterialKeys, OFF};
use weald_core::material::MAX_MATERIALS;
use weald_export::EXPORTS;
use weald_io::FORMATS;
use weald_picture::PICTURES;

/// The schema, in the dialect of 2020-12.
pub fn schema() -> Value {
    let steps = CATALOG.iter().flat_map(|entry| {
        let summary = format!("{} Source: {}.", entry.summary, entry.source);
        alternatives(("do", entry.name), &summary, &(entry.parameters)()).into_iter().map(with_off)
    });
    let pictures = PICTURES.iter().flat_map(|entry| {
        let extensions: Vec<_> = entry.extensions.iter().chain(FILM_EXTENSIONS).copied().collect();
        let parameters: Vec<_> = (entry.parameters)().into_iter().chain(FilmKeys::parameters()).collect();
        let objects = alternatives(("picture", entry.name), entry.summary, &parameters);
        with_file(objects, &extensions)
    });
    let exports = EXPORTS.iter().flat_map(|entry| {
        let summary = format!("{} Source: {}.", entry.summary, entry.source);
        let objects = alternatives(("export", entry.name), &summary, &(entry.parameters)());
        with_file(objects, entry.extensions)
    });
    let outputs: Vec<_> = std::iter::once(layer_output()).chain(pictures).chain(exports).collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Weald recipe",
        "type": "object",
        "required": ["output"],
        "properties": {
            format::KEY: {
                "type": "integer",
                "minimum": 1,
                "maximum": format::NEWEST,
                "description": "The format of the recipe.",
            },
            "landscape": landscape(),
            "material": {
                "type": "array",
                "maxItems": MAX_MATERIALS,
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

/// A step that can be off.
fn with_off(mut step: Value) -> Value {
    step["properties"][OFF] = json!({
        "type": "boolean",
        "default": false,
        "description": "Whether the step is left out, as if it did not stand there.",
    });
    step
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
    let descriptions: Vec<_> =
        presets.iter().map(|preset| format!("{}: {}", preset.name, preset.summary)).collect();
    json!({ "enum": names, "description": descriptions.join(". ") })
}

/// A table that is told from others by the word under `key`: one schema, or one for each of its variants.
fn alternatives((key, word): (&str, &str), summary: &str, parameters: &[Parameter]) -> Vec<Value> {
    let mut objects = branches(parameters);
    for object in &mut objects {
        let variant = object["description"].as_str().map_or(String::new(), |doc| format!(" {doc}"));
        object["description"] = format!("{summary}{variant}").into();
        add_property(object, key, &json!({ "const": word }));
    }
    objects
}

fn with_file(mut objects: Vec<Value>, extensions: &[&str]) -> Vec<Value> {
    for object in &mut objects {
        add_property(object, "file", &file(extensions));
    }
    objects
}

fn add_property(object: &mut Value, key: &str, schema: &Value) {
    object["properties"][key] = schema.clone();
    if let Some(required) = object["required"].as_array_mut() {
        required.push(key.into());
    }
}

fn table(parameters: &[Parameter]) -> Value {
    let mut all = branches(parameters);
    if all.len() == 1 { all.remove(0) } else { one_of(&all) }
}

/// The schemas of a table, which exclude each other: one for each word of a key with variants, or just one.
fn branches(parameters: &[Parameter]) -> Vec<Value> {
    let variants = parameters.iter().find_map(|by| match &by.kind {
        Kind::Variants(variants) => Some(variants.iter().map(move |variant| branch(parameters, by, variant))),
        _ => None,
    });
    variants.map_or_else(|| vec![plain_table(&parameters.iter().collect::<Vec<_>>())], Iterator::collect)
}

/// A table whose key `by` has the word of a variant.
fn branch(parameters: &[Parameter], by: &Parameter, variant: &Variant) -> Value {
    let all: Vec<_> = parameters.iter().chain(&variant.parameters).collect();
    let mut object = plain_table(&all);
    object["description"] = spaced(variant.doc).into();
    object["properties"][by.name] = json!({ "const": variant.word, "description": spaced(by.doc) });
    let is_default = by.default == Some(format!("{:?}", variant.word));
    if let Some(required) = object["required"].as_array_mut().filter(|_| !is_default) {
        required.push(by.name.into());
    }
    object
}

fn plain_table(parameters: &[&Parameter]) -> Value {
    let properties: Map<String, Value> =
        parameters.iter().map(|parameter| (parameter.name.to_owned(), property(parameter))).collect();
    let required: Vec<_> =
        parameters.iter().filter(|parameter| parameter.required).map(|parameter| parameter.name).collect();
    let mut object = json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    });
    let dependent = parameters.iter().filter(|parameter| !parameter.needs.is_empty()).map(|parameter| {
        let mut all: Vec<_> = parameter.needs.iter().map(|needs| dependence(needs, parameters)).collect();
        let whole = if all.len() == 1 { all.remove(0) } else { json!({ "allOf": all }) };
        (parameter.name.to_owned(), whole)
    });
    let dependent: Map<String, Value> = dependent.collect();
    if !dependent.is_empty() {
        object["dependentSchemas"] = dependent.into();
    }
    object
}

/// What a table must have beside a key.
fn dependence(needs: &Needs, parameters: &[&Parameter]) -> Value {
    let in_json = |values: &[&str]| values.iter().map(|value| as_json(value)).collect::<Vec<_>>();
    // An absent key has its default, which may be one of the values.
    let by_default = |key: &str, values: &[&str]| {
        let parameter = parameters.iter().find(|parameter| parameter.name == key);
        let default = parameter.and_then(|parameter| parameter.default.as_deref());
        default.is_some_and(|default| values.contains(&default))
    };
    let required = |is_required: bool, key| if is_required { json!([key]) } else { json!([]) };
    match needs {
        Needs::Value(key, values) => json!({
            "properties": { *key: { "enum": in_json(values) } },
            "required": required(!by_default(key, values), key),
        }),
        Needs::OtherValue(key, values) => json!({
            "properties": { *key: { "not": { "enum": in_json(values) } } },
            "required": required(by_default(key, values), key),
        }),
        Needs::Given(keys) => {
            json!({ "anyOf": keys.iter().map(|key| json!({ "required": [key] })).collect::<Vec<_>>() })
        }
        Needs::Absent(key) => json!({ "not": { "required": [key] } }),
        Needs::File(extensions) => json!({ "properties": { "file": file(extensions) } }),
    }
}

/// A value in TOML, of which numbers, flags, texts and lists are JSON too.
fn as_json(toml: &str) -> Option<Value> {
    serde_json::from_str(toml).ok()
}

fn spaced(doc: &str) -> String {
    doc.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn property(parameter: &Parameter) -> Value {
    let mut schema = of_kind(&parameter.kind);
    let unit = if parameter.unit == "1" { String::new() } else { format!(" Unit: {}.", parameter.unit) };
    let default = parameter.default.as_deref().and_then(as_json);
    let in_words = parameter.default_in_words.as_ref().filter(|_| default.is_none());
    let in_words = in_words.map_or(String::new(), |default| format!(" Default: {default}."));
    let needs: Vec<_> =
        parameter.needs.iter().map(|needs| format!(" It goes {}.", needs.in_words())).collect();
    let needs = needs.concat();
    schema["description"] = format!("{}{unit}{in_words}{needs}", spaced(parameter.doc)).into();
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
        Kind::Crs => json!({ "type": "string", "pattern": "^EPSG:[0-9]{1,9}$" }),
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
        Kind::Variants(variants) => {
            json!({ "enum": variants.iter().map(|variant| variant.word).collect::<Vec<_>>() })
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
        let of = |parameters: fn() -> Vec<Parameter>| branches(&parameters()).len();
        assert_eq!(count("step"), CATALOG.iter().map(|entry| of(entry.parameters)).sum::<usize>());
        assert_eq!(count("output"), PICTURES.len() + EXPORTS.len() + 1);
    }

    #[test]
    fn each_model_is_a_branch_with_its_own_keys() {
        let schema = schema();
        let all = schema["properties"]["step"]["items"]["oneOf"].as_array().expect("a list");
        let is_hydraulic = |step: &&Value| step["properties"]["do"]["const"] == "hydraulic";
        let models: Vec<_> = all.iter().filter(is_hydraulic).map(|step| &step["properties"]).collect();
        let words: Vec<_> = models.iter().map(|model| &model["model"]["const"]).collect();
        assert_eq!(words, ["han", "mei", "stava"]);
        let most: Vec<_> = models.iter().map(|model| &model["evaporation"]["maximum"]).collect();
        assert_eq!(most, [100.0, 1.0, 100.0]);
        assert!(models[0].get("law").is_some() && models[1].get("law").is_none());
        let needs: Vec<_> = all.iter().filter(is_hydraulic).map(|step| &step["required"]).collect();
        assert_eq!(needs, [&json!(["do"]), &json!(["model", "do"]), &json!(["model", "do"])]);
    }

    #[test]
    fn a_key_without_effect_is_refused_by_what_it_needs() {
        let schema = schema();
        let all = schema["properties"]["step"]["items"]["oneOf"].as_array().expect("a list");
        let needs = |step: &str, key: &str| {
            let of = |one: &&Value| one["properties"]["do"]["const"] == step;
            all.iter().find(of).expect("it is there")["dependentSchemas"][key].clone()
        };
        let mfd = json!({ "properties": { "method": { "enum": ["mfd"] } }, "required": ["method"] });
        assert_eq!(needs("flow", "exponent"), mfd);
        assert_eq!(needs("transport", "conserve")["required"], json!([]), "its default will do");
        assert_eq!(needs("rivers", "runoff"), json!({ "not": { "required": ["discharge"] } }));
        assert_eq!(needs("soil", "old"), json!({ "anyOf": [{ "required": ["deposition"] }] }));
    }
}

//! What there is: steps, pictures and exports with their parameters, from which Python makes methods and documents.

use pyo3::prelude::*;
use serde_json::{Value, json};
use weald::export::EXPORTS;
use weald::picture::PICTURES;
use weald::recipe::catalog::CATALOG;
use weald::recipe::parameter::{Diagnostics, Kind, Parameter};
use weald::recipe::source::Table;
use weald::step::{Entry, Layered};

/// All steps, pictures and exports, as JSON.
#[pyfunction]
pub(crate) fn catalogue() -> String {
    let pictures = PICTURES.iter().map(|entry| {
        file_kind([entry.name, entry.summary, entry.source], entry.extensions, &(entry.parameters)())
    });
    let exports = EXPORTS.iter().map(|entry| {
        file_kind([entry.name, entry.summary, entry.source], entry.extensions, &(entry.parameters)())
    });
    json!({
        "steps": CATALOG.iter().map(step).collect::<Vec<_>>(),
        "pictures": pictures.collect::<Vec<_>>(),
        "exports": exports.collect::<Vec<_>>(),
    })
    .to_string()
}

/// A kind of picture or export, which writes a file.
fn file_kind([name, summary, source]: [&str; 3], extensions: &[&str], keys: &[Parameter]) -> Value {
    json!({
        "name": name,
        "summary": summary,
        "source": source,
        "extensions": extensions,
        "parameters": parameters(keys),
    })
}

fn step(entry: &Entry) -> Value {
    // Keys that must be given are missing, which is of no matter to what a step writes by its other keys.
    let usual = (entry.read)(&Table::default(), &mut Diagnostics::default());
    let writes = usual.writes();
    json!({
        "name": entry.name,
        "stage": entry.stage.title(),
        "summary": entry.summary,
        "source": entry.source,
        "reads": usual.reads(),
        "writes": writes,
        "changes_materials": usual.layered() == Layered::Changes,
        "measures": usual.measures(),
        "parameters": parameters(&(entry.parameters)()),
    })
}

fn parameters(all: &[Parameter]) -> Vec<Value> {
    all.iter().map(parameter).collect()
}

fn parameter(parameter: &Parameter) -> Value {
    json!({
        "name": parameter.name,
        "doc": parameter.doc,
        "unit": parameter.unit,
        "kind": kind(&parameter.kind),
        "kind_in_words": parameter.kind.in_words(),
        "default": parameter.default,
        "default_in_words": parameter.default_in_words,
        "required": parameter.required,
        "needs": parameter.needs.iter().map(|needs| format!("{needs:?}")).collect::<Vec<_>>(),
    })
}

fn kind(kind: &Kind) -> Value {
    // JSON has no infinities: an end without a bound is null.
    let bounds = |low: &f64, high: &f64| json!([low, high]);
    match kind {
        Kind::Number(low, high) => json!({ "type": "number", "range": bounds(low, high) }),
        Kind::Integer(low, high) => json!({ "type": "integer", "range": bounds(low, high) }),
        Kind::Flag => json!({ "type": "flag" }),
        Kind::Choice(words) => json!({ "type": "choice", "words": words }),
        Kind::Text => json!({ "type": "text" }),
        Kind::Raster | Kind::Script | Kind::Flame => json!({ "type": "file" }),
        Kind::Colour => json!({ "type": "colour" }),
        Kind::Crs => json!({ "type": "crs" }),
        Kind::Sides => json!({ "type": "sides" }),
        Kind::Layer => json!({ "type": "layer" }),
        Kind::Layers => json!({ "type": "layers" }),
        Kind::Places => json!({ "type": "places" }),
        Kind::Numbers(low, high) => json!({ "type": "numbers", "range": bounds(low, high) }),
        Kind::Rows => json!({ "type": "rows" }),
        Kind::Choices(words) => json!({ "type": "choices", "words": words }),
        Kind::Table(inner) => json!({ "type": "table", "parameters": parameters(inner) }),
        Kind::Tables(inner) => json!({ "type": "tables", "parameters": parameters(inner) }),
        Kind::Variants(variants) => {
            let variants = variants.iter().map(|variant| {
                json!({
                    "word": variant.word,
                    "doc": variant.doc,
                    "parameters": parameters(&variant.parameters),
                })
            });
            json!({ "type": "variants", "variants": variants.collect::<Vec<_>>() })
        }
    }
}

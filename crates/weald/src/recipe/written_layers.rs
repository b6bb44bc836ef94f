//! Which layers the steps of the catalogue write.

use super::catalog::CATALOG;
use super::parameter::{Diagnostics, Kind, Parameter};
use super::source::{Node, Table, Value};
use weald_engine::step::{Entry, Layered, Step};

/// Names and units of layers.
pub(super) type Written = Vec<(String, &'static str)>;

/// Layers that a step writes with its defaults, without those whose names a recipe must give.
pub(super) fn by_default(entry: &Entry) -> Written {
    let all = with(entry, &Table::default()).writes();
    all.into_iter().filter(|(name, _)| !name.is_empty()).collect()
}

/// Keys, each with the layers that the step writes only beside it. A layer that the key names is called as the key.
pub(super) fn by_key(entry: &Entry) -> Vec<(&'static str, Written)> {
    let usual = by_default(entry);
    let optional = |key: &Parameter| {
        matches!(key.kind, Kind::Layer | Kind::Table(_)) && key.default.is_none() && !key.required
    };
    let keys = (entry.parameters)().into_iter().filter(optional).map(|key| {
        let value = match key.kind {
            Kind::Layer => Value::Text(key.name.to_owned()),
            _ => Value::Table(Table::default()),
        };
        let table = Table { line: 0, entries: vec![(key.name.to_owned(), Node { line: 0, value })] };
        let written = with(entry, &table).writes();
        (key.name, written.into_iter().filter(|layer| !usual.contains(layer)).collect::<Written>())
    });
    keys.filter(|(_, written)| !written.is_empty()).collect()
}

/// Whether the step writes the layers of all materials, with its defaults or with one of its words.
pub(super) fn materials(entry: &Entry) -> Option<String> {
    if with(entry, &Table::default()).layered() == Layered::Changes {
        return Some(String::new());
    }
    let words = (entry.parameters)().into_iter().filter_map(|key| match key.kind {
        Kind::Variants(words) => Some(words.into_iter().map(move |variant| (key.name, variant.word))),
        _ => None,
    });
    words.flatten().find_map(|(key, word)| {
        let node = Node { line: 0, value: Value::Text(word.to_owned()) };
        let table = Table { line: 0, entries: vec![(key.to_owned(), node)] };
        (with(entry, &table).layered() == Layered::Changes).then(|| format!(" with {key} = {word:?}"))
    })
}

/// What writes a layer of this name by itself: a step, or a step with a key; other than the one that reads it.
pub(super) fn writer_of(layer: &str, reader: &str) -> Option<String> {
    let is = |written: &Written| written.iter().any(|(name, _)| name == layer);
    let others = || CATALOG.iter().filter(|entry| entry.name != reader);
    let by_itself = others().find(|entry| is(&by_default(entry)));
    by_itself.map(|entry| format!("`{}`", entry.name)).or_else(|| {
        others().find_map(|entry| {
            let keys = by_key(entry);
            let (key, _) = keys.iter().find(|(key, written)| *key != layer && is(written))?;
            Some(format!("`{}` with `{key}`", entry.name))
        })
    })
}

/// A step with these keys; what is wrong with them is of no interest here.
fn with(entry: &Entry, table: &Table) -> Box<dyn Step> {
    (entry.read)(table, &mut Diagnostics::default())
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::layer_words::meaning;

    #[test]
    fn every_layer_that_a_step_writes_by_itself_has_a_meaning_and_stands_in_the_documents() {
        let documents = include_str!("../../../../docs/steps.md");
        for entry in CATALOG {
            for (layer, _) in by_default(entry) {
                assert!(
                    meaning(&layer).is_some(),
                    "{}: what `{layer}` is stands in `layer_words`",
                    entry.name
                );
                assert!(
                    documents.contains(&format!("`{layer}`")),
                    "{}: docs/steps.md names `{layer}`",
                    entry.name
                );
            }
        }
    }

    #[test]
    fn the_step_and_the_key_are_found_that_write_a_layer() {
        let writers = ["flow_direction", "discharge", "filled", "no-such"].map(|layer| writer_of(layer, ""));
        assert_eq!(writers.each_ref().map(Option::as_deref), [Some("`flow`"), Some("`rivers`"), None, None]);
        assert_eq!(writer_of("discharge", "rivers").as_deref(), Some("`flow` with `weight`"));
    }

    #[test]
    fn keys_that_add_layers_are_found() {
        let flow = CATALOG.iter().find(|entry| entry.name == "flow").expect("it is there");
        let weight = ("weight", vec![("discharge".to_owned(), "m³/s")]);
        assert_eq!(by_key(flow), [weight, ("filled", vec![("filled".to_owned(), "m")])]);
        let hydraulic = CATALOG.iter().find(|entry| entry.name == "hydraulic").expect("it is there");
        assert_eq!(materials(hydraulic).as_deref(), Some(" with model = \"stava\""));
    }
}

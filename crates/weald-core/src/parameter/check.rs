//! Which keys a table may have.

use super::diagnostics::Diagnostics;
use super::kind::{Kind, Needs, Parameter, Variant};
use crate::source::{Node, Table};

/// Complains of every key of a table that is unknown, or that has no effect beside the others: one of a variant that is
/// not chosen, or one whose [needs](super::Needs) are not met.
pub fn check_keys(table: &Table, parameters: &[Parameter], diagnostics: &mut Diagnostics) {
    let mut known: Vec<&Parameter> = parameters.iter().collect();
    let mut others = Vec::new();
    for parameter in parameters {
        let Kind::Variants(variants) = &parameter.kind else { continue };
        match chosen(table, parameter, variants) {
            Some(chosen) => known.extend(&chosen.parameters),
            // What the word should be is told where it is read.
            None => known.extend(variants.iter().flat_map(|variant| &variant.parameters)),
        }
        others.push((parameter, variants.as_slice()));
    }
    let mut strange = Table { line: table.line, entries: Vec::new() };
    for (key, node) in &table.entries {
        match known.iter().copied().find(|parameter| parameter.name == key) {
            Some(parameter) => check_needs(table, (parameter, node), &known, diagnostics),
            None => match others.iter().find_map(|&other| of_another(table, key, other)) {
                Some(problem) => diagnostics.add(node.line, format!("`{key}` {problem}")),
                None => strange.entries.push((key.clone(), node.clone())),
            },
        }
    }
    let names: Vec<_> = known.iter().map(|parameter| parameter.name).collect();
    diagnostics.unknown_keys(&strange, &names);
}

/// Complains of keys of an output that have no effect in a file of its kind.
pub fn check_file(table: &Table, parameters: &[Parameter], diagnostics: &mut Diagnostics) {
    let known: Vec<&Parameter> = parameters.iter().collect();
    for parameter in parameters {
        let unmet = |needs: &&Needs| matches!(needs, Needs::File(_)) && !needs.is_met(table, &known);
        if let (Some(node), Some(needs)) = (table.get(parameter.name), parameter.needs.iter().find(unmet)) {
            diagnostics.add(node.line, format!("`{}` {}", parameter.name, needs.diagnostic(table, &known)));
        }
    }
}

/// The keys of a table that have no effect beside the others.
pub fn without_effect(table: &Table, parameters: &[Parameter]) -> Vec<&'static str> {
    let known: Vec<&Parameter> = parameters.iter().collect();
    let unmet = |parameter: &&Parameter| {
        table.get(parameter.name).is_some()
            && !parameter.needs.iter().all(|needs| needs.is_met(table, &known))
    };
    parameters.iter().filter(unmet).map(|parameter| parameter.name).collect()
}

/// The variant that a table chooses, by its word or by default.
fn chosen<'a>(table: &Table, by: &Parameter, variants: &'a [Variant]) -> Option<&'a Variant> {
    let word = match table.get(by.name) {
        Some(node) => Some(node.value.shown()),
        None => by.default.clone(),
    }?;
    variants.iter().find(|variant| format!("{:?}", variant.word) == word)
}

fn check_needs(
    table: &Table,
    (parameter, node): (&Parameter, &Node),
    known: &[&Parameter],
    diagnostics: &mut Diagnostics,
) {
    if let Some(needs) = parameter.needs.iter().find(|needs| !needs.is_met(table, known)) {
        diagnostics.add(node.line, format!("`{}` {}", parameter.name, needs.diagnostic(table, known)));
    }
}

/// What is wrong with a key that only variants have that are not chosen.
fn of_another(table: &Table, key: &str, (by, variants): (&Parameter, &[Variant])) -> Option<String> {
    let has = |variant: &&Variant| variant.parameters.iter().any(|parameter| parameter.name == key);
    let words: Vec<_> = variants.iter().filter(has).map(|variant| format!("{:?}", variant.word)).collect();
    if words.is_empty() {
        return None;
    }
    let (name, chosen) = (by.name, chosen(table, by, variants)?.word);
    let words = words.join(" or ");
    Some(format!(
        "has no effect with {name} = {chosen:?}: it is a key of {name} = {words}; set that, or remove it"
    ))
}

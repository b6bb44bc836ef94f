//! As much of JSON Schema (2020-12) as the schema of recipes uses; a keyword that it does not know is a panic.

use serde_json::Value;

/// What is wrong with a value, one sentence a fault.
pub(crate) fn faults(schema: &Value, value: &Value) -> Vec<String> {
    let keywords = schema.as_object().expect("a schema is an object");
    keywords.iter().flat_map(|(keyword, rule)| of_keyword(keyword, rule, schema, value)).collect()
}

fn is_valid(schema: &Value, value: &Value) -> bool {
    faults(schema, value).is_empty()
}

fn of_keyword(keyword: &str, rule: &Value, schema: &Value, value: &Value) -> Vec<String> {
    let said = |is_fault: bool| {
        if is_fault { vec![format!("{value} against {keyword} {rule}")] } else { Vec::new() }
    };
    let beyond = |bound: fn(f64, f64) -> bool| {
        value.as_f64().zip(rule.as_f64()).is_some_and(|(value, limit)| bound(value, limit))
    };
    let length = value.as_array().map(Vec::len);
    match keyword {
        "$schema" | "title" | "description" | "default" | "pattern" => Vec::new(),
        "const" => said(value != rule),
        "enum" => said(!list(rule).contains(value)),
        "type" => said(!is_of_type(value, rule.as_str().expect("one type"))),
        "minimum" => said(beyond(|value, limit| value < limit)),
        "maximum" => said(beyond(|value, limit| value > limit)),
        "minItems" => said(length.is_some_and(|length| (length as u64) < rule.as_u64().expect("a count"))),
        "maxItems" => said(length.is_some_and(|length| length as u64 > rule.as_u64().expect("a count"))),
        "uniqueItems" => {
            let items = value.as_array().map_or(&[][..], Vec::as_slice);
            said((1..items.len()).any(|at| items[..at].contains(&items[at])))
        }
        "items" => value.as_array().into_iter().flatten().flat_map(|item| faults(rule, item)).collect(),
        "allOf" => list(rule).iter().flat_map(|rule| faults(rule, value)).collect(),
        "anyOf" => said(!list(rule).iter().any(|rule| is_valid(rule, value))),
        "oneOf" => said(list(rule).iter().filter(|rule| is_valid(rule, value)).count() != 1),
        "not" => said(is_valid(rule, value)),
        _ => of_object(keyword, rule, schema, value),
    }
}

/// Keywords that are about tables.
fn of_object(keyword: &str, rule: &Value, schema: &Value, value: &Value) -> Vec<String> {
    let Some(table) = value.as_object() else { return Vec::new() };
    let given = |key: &str| table.contains_key(key);
    match keyword {
        "required" => {
            let missing = list(rule).iter().filter_map(Value::as_str).filter(|key| !given(key));
            missing.map(|key| format!("`{key}` is missing in {value}")).collect()
        }
        "properties" => {
            let rules = rule.as_object().expect("rules by key").iter();
            rules.filter_map(|(key, rule)| Some(faults(rule, table.get(key)?))).flatten().collect()
        }
        "additionalProperties" => {
            assert_eq!(rule, false, "only closed tables are known");
            let strange = table.keys().filter(|key| schema["properties"].get(key).is_none());
            strange.map(|key| format!("`{key}` is unknown in {value}")).collect()
        }
        "dependentSchemas" => {
            let rules = rule.as_object().expect("rules by key").iter();
            rules.filter(|(key, _)| given(key)).flat_map(|(_, rule)| faults(rule, value)).collect()
        }
        other => panic!("the keyword {other:?} is not known here"),
    }
}

fn list(rule: &Value) -> &[Value] {
    rule.as_array().expect("a list")
}

fn is_of_type(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        other => panic!("the type {other:?} is not known here"),
    }
}

//! Attributes as JSON.

use serde_json::{Map, Value, json};

use super::super::cf::{Attribute, Attributes};

/// Where GDAL keeps the CRS of an array.
const CRS: &str = "_CRS";

/// The object that stands under `attributes`.
pub(super) fn to_json(attributes: &Attributes) -> Value {
    let value = |attribute: &Attribute| match attribute {
        Attribute::Text(text) => json!(text),
        Attribute::Float(number) => json!(number),
        Attribute::Doubles(numbers) => match numbers.as_slice() {
            [number] => json!(number),
            numbers => json!(numbers),
        },
        Attribute::Integers(numbers) => json!(numbers),
    };
    // xarray takes one number there and no list.
    let value = |name: &str, attribute: &Attribute| match (name, attribute) {
        ("_FillValue", Attribute::Integers(numbers)) if numbers.len() == 1 => json!(numbers[0]),
        _ => value(attribute),
    };
    let entries = attributes.0.iter().map(|(name, attribute)| (name.clone(), value(name, attribute)));
    Value::Object(entries.collect())
}

/// Texts, numbers and lists of numbers; what else an attribute can be tells nothing of a grid.
pub(super) fn of_json(attributes: Option<&Value>) -> Attributes {
    let none = Map::new();
    let entries = attributes.and_then(Value::as_object).unwrap_or(&none);
    let called = |name: &str| if name == CRS { "crs_wkt" } else { name }.to_owned();
    let known = entries.iter().filter_map(|(name, value)| Some((called(name), attribute(name, value)?)));
    Attributes(known.collect())
}

fn attribute(name: &str, value: &Value) -> Option<Attribute> {
    match value {
        Value::String(text) if name == "_FillValue" => {
            fill(text).map(|number| Attribute::Doubles(vec![number]))
        }
        Value::String(text) => Some(Attribute::Text(text.clone())),
        // GDAL's definition of the CRS.
        Value::Object(entries) if name == CRS => {
            Some(Attribute::Text(entries.get("wkt")?.as_str()?.to_owned()))
        }
        Value::Number(_) => numbers(std::slice::from_ref(value)),
        Value::Array(items) => numbers(items),
        _ => None,
    }
}

/// Numbers; whole ones where all are written so.
fn numbers(items: &[Value]) -> Option<Attribute> {
    let numbers = items.iter().map(Value::as_f64).collect::<Option<_>>()?;
    let are_whole = !items.iter().any(Value::is_f64);
    Some(if are_whole { Attribute::of_whole(numbers) } else { Attribute::Doubles(numbers) })
}

/// xarray spells the fill value of floats as the Base64 of a little-endian `float64`.
fn fill(text: &str) -> Option<f64> {
    let digit = |letter: u8| match letter {
        b'A'..=b'Z' => Some(letter - b'A'),
        b'a'..=b'z' => Some(letter - b'a' + 26),
        b'0'..=b'9' => Some(letter - b'0' + 52),
        b'+' => Some(62),
        b'/' => Some(63),
        _ => None,
    };
    // Eleven letters of six bits are eight bytes and two bits over.
    let letters = text.strip_suffix('=').filter(|letters| letters.len() == 11)?.bytes();
    let bits = letters.map(digit).collect::<Option<Vec<_>>>()?;
    let joined = bits.iter().fold(0_u128, |joined, six| joined << 6 | u128::from(*six)) >> 2;
    Some(f64::from_bits((joined as u64).swap_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Texts that xarray 2026.9 wrote.
    #[test]
    fn fill_values_of_xarray_are_numbers() {
        assert_eq!(fill("AAAAAICHw8A="), Some(-9999.0));
        assert!(fill("AAAAAAAA+H8=").is_some_and(f64::is_nan));
        for text in ["", "AAAAAICHw8A", "AAAAAICHw8AA=", "AAAA AICHw8="] {
            assert_eq!(fill(text), None, "{text:?}");
        }
    }

    #[test]
    fn attributes_come_back_from_json() {
        let mut attributes = Attributes::default();
        attributes.add("units", "m");
        attributes.add("WEALD_CELL_METRES", 0.1);
        attributes.0.push(("standard_parallel".to_owned(), Attribute::Doubles(vec![49.0, 44.0])));
        let again = of_json(Some(&to_json(&attributes)));
        for (name, value) in &attributes.0 {
            assert_eq!(again.get(name), Some(value));
        }
    }
}

//! Places in a recipe or a script.

use super::declaration::ParameterValue;
use super::diagnostics::Diagnostics;
use super::kind::Kind;
use super::values::wrong;
use crate::source::{Node, Value};

/// Places in metres from the north-western corner of a landscape, `[x, y]` or a list of them: east and south.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places(pub Vec<[f64; 2]>);

impl Places {
    /// The default of a key that must be given.
    pub fn needed() -> Self {
        Self::default()
    }
}

impl ParameterValue for Places {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Places
    }

    fn read(node: &Node, _: (f64, f64), _: &mut Diagnostics) -> Result<Self, String> {
        let fault = || wrong(node, "a place `[x, y]` of finite numbers, or a list of such places");
        let Value::List(items) = &node.value else { return Err(fault()) };
        if let Some(place) = place(items) {
            return Ok(Self(vec![place]));
        }
        let is_number = |item: &Node| matches!(item.value, Value::Integer(_) | Value::Number(_));
        if items.len() != 2 && !items.is_empty() && items.iter().all(is_number) {
            let count = items.len();
            return Err(format!(
                "has {count} numbers, but a place has two, `[x, y]`: metres east and south of the north-western corner"
            ));
        }
        let places = items.iter().map(|item| match &item.value {
            Value::List(numbers) => place(numbers),
            _ => None,
        });
        let places: Option<Vec<_>> = places.collect();
        places.filter(|places| !places.is_empty()).map(Self).ok_or_else(fault)
    }

    fn shown(&self) -> Option<String> {
        (!self.must_be_given()).then(|| format!("{:?}", self.0))
    }

    fn must_be_given(&self) -> bool {
        self.0.is_empty()
    }
}

fn place(numbers: &[Node]) -> Option<[f64; 2]> {
    let number = |node: &Node| match node.value {
        Value::Integer(number) => Some(number as f64),
        Value::Number(number) => Some(number).filter(|number| number.is_finite()),
        _ => None,
    };
    match numbers {
        [x, y] => number(x).zip(number(y)).map(|(x, y)| [x, y]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_shown_as_a_recipe_writes_them_and_those_that_must_be_given_are_not() {
        assert_eq!(Places(vec![[1.0, 2.5]]).shown().as_deref(), Some("[[1.0, 2.5]]"));
        assert_eq!(Places::needed().shown(), None);
    }
}

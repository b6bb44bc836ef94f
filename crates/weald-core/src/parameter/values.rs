//! The types that parameters can have, but for the [size of a grid](super::Sides).

use super::declaration::{Choice, ParameterValue, Parameters};
use super::diagnostics::Diagnostics;
use super::kind::{Kind, range_in_words};
use crate::source::{Node, Table, Value};

fn within<T: Into<f64> + Copy + std::fmt::Display>(number: T, range: (f64, f64)) -> Result<T, String> {
    let wide: f64 = number.into();
    if wide.is_finite() && wide >= range.0 && wide <= range.1 {
        return Ok(number);
    }
    Err(format!("is {number}, outside its range: {}", range_in_words(range.0, range.1)))
}

pub(super) fn wrong(node: &Node, wanted: &str) -> String {
    format!("is {}, but must be {wanted}", node.value.shown())
}

impl ParameterValue for f64 {
    fn kind(range: (f64, f64)) -> Kind {
        Kind::Number(range.0, range.1)
    }

    fn read(node: &Node, range: (f64, f64), _: &mut Diagnostics) -> Result<Self, String> {
        match node.value {
            Value::Number(number) => within(number, range),
            Value::Integer(number) => within(number as Self, range),
            _ => Err(wrong(node, &format!("a {}", Self::kind(range).in_words()))),
        }
    }

    fn shown(&self) -> Option<String> {
        (!self.must_be_given()).then(|| format!("{self:?}"))
    }

    /// A default that is no number means that the recipe must give one.
    fn must_be_given(&self) -> bool {
        self.is_nan()
    }
}

macro_rules! whole_number {
    ($($type:ty),*) => {$(
        impl ParameterValue for $type {
            fn kind(range: (f64, f64)) -> Kind {
                Kind::Integer(range.0, range.1)
            }

            fn read(node: &Node, range: (f64, f64), _: &mut Diagnostics) -> Result<Self, String> {
                let wanted = || format!("a {}", Self::kind(range).in_words());
                let Value::Integer(number) = node.value else { return Err(wrong(node, &wanted())) };
                // The message shows the number as it was written: `f64` cannot hold all of them.
                within(number as f64, range).map_err(|_| {
                    format!("is {number}, outside its range: {}", range_in_words(range.0, range.1))
                })?;
                Self::try_from(number).map_err(|_| wrong(node, &wanted()))
            }

            fn shown(&self) -> Option<String> {
                Some(self.to_string())
            }
        }
    )*};
}
whole_number!(u32, u64);

impl ParameterValue for bool {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Flag
    }

    fn read(node: &Node, _: (f64, f64), _: &mut Diagnostics) -> Result<Self, String> {
        let Value::Flag(flag) = node.value else { return Err(wrong(node, "true or false")) };
        Ok(flag)
    }

    fn shown(&self) -> Option<String> {
        Some(self.to_string())
    }
}

impl ParameterValue for String {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Text
    }

    fn read(node: &Node, _: (f64, f64), _: &mut Diagnostics) -> Result<Self, String> {
        let Value::Text(text) = &node.value else { return Err(wrong(node, "text in quotes")) };
        Ok(text.clone())
    }

    fn shown(&self) -> Option<String> {
        Some(format!("{self:?}"))
    }
}

impl ParameterValue for Vec<f64> {
    fn kind(range: (f64, f64)) -> Kind {
        Kind::Numbers(range.0, range.1)
    }

    fn read(node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        let Value::List(items) = &node.value else { return Err(wrong(node, "a list of numbers")) };
        items.iter().map(|item| f64::read(item, range, diagnostics)).collect()
    }

    fn shown(&self) -> Option<String> {
        Some(format!("{self:?}"))
    }
}

impl ParameterValue for Vec<Vec<f64>> {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Rows
    }

    fn read(node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        let Value::List(items) = &node.value else { return Err(wrong(node, "a list of lists of numbers")) };
        if let Some(other) = items.iter().find(|item| !matches!(item.value, Value::List(_))) {
            let shown = other.value.shown();
            return Err(format!("has {shown} as an item, but each must be a list of numbers"));
        }
        items.iter().map(|item| Vec::read(item, range, diagnostics)).collect()
    }

    fn shown(&self) -> Option<String> {
        Some(format!("{self:?}"))
    }
}

/// The name of a layer that a step reads or writes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LayerName(pub String);

impl LayerName {
    /// A default that is a layer's name.
    pub fn of(name: &str) -> Self {
        Self(name.to_owned())
    }

    /// The default of a key that must be given.
    pub fn needed() -> Self {
        Self::default()
    }
}

impl ParameterValue for LayerName {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Layer
    }

    fn read(node: &Node, _: (f64, f64), _: &mut Diagnostics) -> Result<Self, String> {
        let wanted = "the name of a layer: letters, digits, `_` and `-`";
        let Value::Text(name) = &node.value else { return Err(wrong(node, wanted)) };
        let legal = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if name.is_empty() || name.len() > 64 || !name.chars().all(legal) {
            return Err(wrong(node, wanted));
        }
        Ok(Self(name.clone()))
    }

    fn shown(&self) -> Option<String> {
        (!self.0.is_empty()).then(|| format!("{:?}", self.0))
    }

    fn must_be_given(&self) -> bool {
        self.0.is_empty()
    }
}

impl<T: ParameterValue> ParameterValue for Option<T> {
    fn kind(range: (f64, f64)) -> Kind {
        T::kind(range)
    }

    fn read(node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        T::read(node, range, diagnostics).map(Some)
    }

    fn change(&self, node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        match self {
            Some(now) => now.change(node, range, diagnostics).map(Some),
            None => Self::read(node, range, diagnostics),
        }
    }

    fn with_changed_keys(self, table: &Table, diagnostics: &mut Diagnostics) -> Self {
        self.map(|value| value.with_changed_keys(table, diagnostics))
    }

    fn with_keys_of(self, table: &Table, diagnostics: &mut Diagnostics) -> Self {
        self.map(|value| value.with_keys_of(table, diagnostics))
    }

    fn shown(&self) -> Option<String> {
        self.as_ref().and_then(T::shown)
    }

    fn in_words(&self) -> Option<String> {
        self.as_ref().and_then(T::in_words)
    }
}

/// A nested table of parameters, as in `thermal = { talus = 0.6 }`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Nested<T>(pub T);

impl<T: Parameters + Clone> ParameterValue for Nested<T> {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Table(T::parameters())
    }

    fn read(node: &Node, _: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        let Value::Table(table) = &node.value else { return Err(wrong(node, "a table { … }")) };
        Ok(Self(T::read(table, diagnostics)))
    }

    fn change(&self, node: &Node, _: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        let Value::Table(table) = &node.value else { return Err(wrong(node, "a table { … }")) };
        Ok(Self(self.0.changed(table, diagnostics)))
    }

    fn shown(&self) -> Option<String> {
        None
    }
}

/// Most tables in a list.
const MAX_TABLES: usize = 1000;

impl<T: Parameters + Clone> ParameterValue for Vec<Nested<T>> {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Tables(T::parameters())
    }

    fn read(node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        let Value::List(items) = &node.value else {
            return Err(wrong(node, "a list of tables [{ … }, …]"));
        };
        if items.len() > MAX_TABLES {
            return Err(format!("has {} tables, but at most {MAX_TABLES} are read", items.len()));
        }
        if let Some(other) = items.iter().find(|item| !matches!(item.value, Value::Table(_))) {
            return Err(format!("has the item {}, but each must be a table {{ … }}", other.value.shown()));
        }
        // Counted from 1, as in the paths of `--set`.
        let numbered = (1..).map(|number: usize| number.to_string()).zip(items);
        numbered
            .map(|(number, item)| {
                diagnostics.within(&number, item, |diagnostics| Nested::read(item, range, diagnostics))
            })
            .collect()
    }

    fn shown(&self) -> Option<String> {
        self.is_empty().then(|| "[]".to_owned())
    }
}

impl<T: Choice> ParameterValue for Vec<T> {
    fn kind(range: (f64, f64)) -> Kind {
        let Kind::Choice(words) = T::kind(range) else { return Kind::Text };
        Kind::Choices(words)
    }

    fn read(node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        let Value::List(items) = &node.value else {
            return Err(format!("is {}, but must be a {}", node.value.shown(), Self::kind(range).in_words()));
        };
        items.iter().map(|item| T::read(item, range, diagnostics)).collect()
    }

    fn shown(&self) -> Option<String> {
        let words: Vec<_> = self.iter().map(|choice| format!("{:?}", choice.as_word())).collect();
        Some(format!("[{}]", words.join(", ")))
    }
}

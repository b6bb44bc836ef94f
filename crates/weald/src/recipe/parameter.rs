//! The one declaration of a step's parameters, from which parsing, range errors, `weald steps`, the JSON
//! Schema and user interfaces follow. See the [`parameters!`](crate::parameters) macro.

mod sides;

pub use sides::Sides;

use super::source::{Node, Table, Value};
use crate::error::Complaint;

/// What a user can be told of one parameter.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Key in the recipe.
    pub name: &'static str,
    /// What it does.
    pub doc: &'static str,
    /// Unit of a number; `1` where it has none.
    pub unit: &'static str,
    /// Type and range.
    pub kind: Kind,
    /// Default in TOML notation; `None` where the key is needed or its absence means something.
    pub default: Option<String>,
    /// Whether a recipe must give the key.
    pub required: bool,
}

/// Type and range of a parameter.
#[derive(Clone, Debug)]
pub enum Kind {
    /// A number within both bounds.
    Number(f64, f64),
    /// A whole number within both bounds.
    Integer(f64, f64),
    /// `true` or `false`.
    Flag,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// Any text.
    Text,
    /// Cells a side, or a list of columns and rows.
    Sides,
    /// The name of a layer.
    Layer,
    /// A list of numbers, each within both bounds.
    Numbers(f64, f64),
    /// A table with parameters of its own.
    Table(Vec<Parameter>),
}

impl Kind {
    /// The kind in words, for `weald steps` and errors.
    pub fn in_words(&self) -> String {
        match self {
            Self::Number(low, high) => format!("number, {}", range_in_words(*low, *high)),
            Self::Integer(low, high) => format!("whole number, {}", range_in_words(low.max(0.0), *high)),
            Self::Flag => "true or false".to_owned(),
            Self::Choice(names) => {
                names.iter().map(|name| format!("{name:?}")).collect::<Vec<_>>().join(" | ")
            }
            Self::Text => "text".to_owned(),
            Self::Sides => "whole number from 1, or [columns, rows]".to_owned(),
            Self::Layer => "layer name".to_owned(),
            Self::Numbers(low, high) => format!("list of numbers, {}", range_in_words(*low, *high)),
            Self::Table(_) => "table".to_owned(),
        }
    }
}

fn range_in_words(low: f64, high: f64) -> String {
    match (low.is_finite(), high.is_finite()) {
        (true, true) => format!("{low} to {high}"),
        (true, false) => format!("at least {low}"),
        (false, true) => format!("at most {high}"),
        (false, false) => "any finite".to_owned(),
    }
}

/// A struct declared by [`parameters!`](crate::parameters).
pub trait Parameters: Sized + Default {
    /// All parameters in the order of their declaration.
    fn parameters() -> Vec<Parameter>;

    /// Reads the keys of a table; faults go to `complaints`, and their keys keep their defaults.
    fn read(table: &Table, complaints: &mut Complaints) -> Self;
}

/// Collects the faults of a recipe while it is read.
#[derive(Debug, Default)]
pub struct Complaints {
    /// What the keys belong to, for the message: `thermal`, `landscape`.
    pub subject: String,
    /// All faults so far.
    pub found: Vec<Complaint>,
}

impl Complaints {
    /// Adds a fault, prefixed with its subject.
    pub fn add(&mut self, line: usize, message: impl std::fmt::Display) {
        let message = if self.subject.is_empty() {
            message.to_string()
        } else {
            format!("{}: {message}", self.subject)
        };
        self.found.push(Complaint { line, message });
    }

    /// Complains of every key of `table` that is not among `known`, with the nearest known name.
    pub fn unknown_keys(&mut self, table: &Table, known: &[&str]) {
        for (key, node) in &table.entries {
            if !known.contains(&key.as_str()) {
                let hint = match nearest(key, known) {
                    Some(name) => format!("; did you mean `{name}`?"),
                    None => format!("; the keys here are: {}", known.join(", ")),
                };
                self.add(node.line, format!("unknown key `{key}`{hint}"));
            }
        }
    }
}

/// The known name that was probably meant.
pub fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let scored = known.iter().map(|name| (strsim::jaro_winkler(word, name), *name));
    scored.filter(|(score, _)| *score > 0.8).max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, name)| name)
}

/// A type that a parameter can have.
pub trait ParameterValue: Sized + Clone {
    /// Type and range.
    fn kind(range: (f64, f64)) -> Kind;

    /// Reads a value; an error says what is wrong with it and what is legal.
    fn read(node: &Node, range: (f64, f64), complaints: &mut Complaints) -> Result<Self, String>;

    /// The value in TOML notation; `None` where it stands for an absent key.
    fn shown(&self) -> Option<String>;

    /// Whether this default means that the recipe must give the key.
    fn must_be_given(&self) -> bool {
        false
    }
}

fn within<T: Into<f64> + Copy + std::fmt::Display>(number: T, range: (f64, f64)) -> Result<T, String> {
    let wide: f64 = number.into();
    if wide.is_finite() && wide >= range.0 && wide <= range.1 {
        return Ok(number);
    }
    Err(format!("is {number}, outside its range: {}", range_in_words(range.0, range.1)))
}

fn wrong(node: &Node, wanted: &str) -> String {
    format!("is {}, but must be {wanted}", node.value.shown())
}

impl ParameterValue for f64 {
    fn kind(range: (f64, f64)) -> Kind {
        Kind::Number(range.0, range.1)
    }

    fn read(node: &Node, range: (f64, f64), _: &mut Complaints) -> Result<Self, String> {
        match node.value {
            Value::Number(number) => within(number, range),
            Value::Integer(number) => within(number as Self, range),
            _ => Err(wrong(node, &format!("a {}", Self::kind(range).in_words()))),
        }
    }

    fn shown(&self) -> Option<String> {
        Some(format!("{self:?}"))
    }
}

macro_rules! whole_number {
    ($($type:ty),*) => {$(
        impl ParameterValue for $type {
            fn kind(range: (f64, f64)) -> Kind {
                Kind::Integer(range.0, range.1)
            }

            fn read(node: &Node, range: (f64, f64), _: &mut Complaints) -> Result<Self, String> {
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

    fn read(node: &Node, _: (f64, f64), _: &mut Complaints) -> Result<Self, String> {
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

    fn read(node: &Node, _: (f64, f64), _: &mut Complaints) -> Result<Self, String> {
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

    fn read(node: &Node, range: (f64, f64), complaints: &mut Complaints) -> Result<Self, String> {
        let Value::List(items) = &node.value else { return Err(wrong(node, "a list of numbers")) };
        items.iter().map(|item| f64::read(item, range, complaints)).collect()
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

    fn read(node: &Node, _: (f64, f64), _: &mut Complaints) -> Result<Self, String> {
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

    fn read(node: &Node, range: (f64, f64), complaints: &mut Complaints) -> Result<Self, String> {
        T::read(node, range, complaints).map(Some)
    }

    fn shown(&self) -> Option<String> {
        self.as_ref().and_then(T::shown)
    }
}

/// A nested table of parameters, as in `thermal = { talus = 0.6 }`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Nested<T>(pub T);

impl<T: Parameters + Clone> ParameterValue for Nested<T> {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Table(T::parameters())
    }

    fn read(node: &Node, _: (f64, f64), complaints: &mut Complaints) -> Result<Self, String> {
        let Value::Table(table) = &node.value else { return Err(wrong(node, "a table { … }")) };
        Ok(Self(T::read(table, complaints)))
    }

    fn shown(&self) -> Option<String> {
        None
    }
}

/// Reads one key of a table, or takes its default.
pub fn read_key<T: ParameterValue>(
    table: &Table,
    name: &str,
    default: T,
    range: (f64, f64),
    complaints: &mut Complaints,
) -> T {
    let Some(node) = table.get(name) else {
        if default.must_be_given() {
            complaints.add(table.line, format!("`{name}` is needed: {}", T::kind(range).in_words()));
        }
        return default;
    };
    T::read(node, range, complaints).unwrap_or_else(|problem| {
        complaints.add(node.line, format!("`{name}` {problem}"));
        default
    })
}

/// Declares a struct of parameters: `name: Type = default, range low..=high, unit "m";` with a doc comment
/// each. Gives the struct, its `Default` and [`Parameters`].
#[macro_export]
macro_rules! parameters {
    ($(#[$meta:meta])* pub struct $Struct:ident { $(
        $(#[doc = $doc:literal])+
        $name:ident: $Type:ty = $default:expr $(, range $low:literal ..= $high:literal)? $(, unit $unit:literal)?;
    )* }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub struct $Struct { $( $(#[doc = $doc])+ pub $name: $Type, )* }

        impl Default for $Struct {
            fn default() -> Self {
                Self { $( $name: $default, )* }
            }
        }

        impl $crate::recipe::parameter::Parameters for $Struct {
            fn parameters() -> Vec<$crate::recipe::parameter::Parameter> {
                use $crate::recipe::parameter::ParameterValue;
                vec![$( {
                    let default: $Type = $default;
                    $crate::recipe::parameter::Parameter {
                        name: stringify!($name),
                        doc: concat!($($doc, "\n",)+).trim_ascii(),
                        unit: $crate::parameters!(@unit $($unit)?),
                        kind: <$Type as ParameterValue>::kind($crate::parameters!(@range $($low, $high)?)),
                        required: default.must_be_given(),
                        default: default.shown(),
                    }
                }, )*]
            }

            fn read(
                table: &$crate::recipe::source::Table,
                complaints: &mut $crate::recipe::parameter::Complaints,
            ) -> Self {
                complaints.unknown_keys(table, &[$(stringify!($name)),*]);
                Self { $( $name: $crate::recipe::parameter::read_key(
                    table, stringify!($name), $default, $crate::parameters!(@range $($low, $high)?), complaints,
                ), )* }
            }
        }
    };
    (@unit) => { "1" };
    (@unit $unit:literal) => { $unit };
    (@range) => { (f64::NEG_INFINITY, f64::INFINITY) };
    (@range $low:literal, $high:literal) => { ($low as f64, $high as f64) };
}

/// Declares an enum whose variants are words of a recipe.
#[macro_export]
macro_rules! choices {
    ($(#[$meta:meta])* pub enum $Enum:ident { $( $(#[$doc:meta])+ $Variant:ident = $word:literal, )+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $Enum { $( $(#[$doc])+ $Variant, )+ }

        impl $Enum {
            /// The word in a recipe.
            pub const fn word(self) -> &'static str {
                match self { $( Self::$Variant => $word, )+ }
            }
        }

        impl $crate::recipe::parameter::ParameterValue for $Enum {
            fn kind(_: (f64, f64)) -> $crate::recipe::parameter::Kind {
                $crate::recipe::parameter::Kind::Choice(&[$($word),+])
            }

            fn read(
                node: &$crate::recipe::source::Node,
                range: (f64, f64),
                _: &mut $crate::recipe::parameter::Complaints,
            ) -> Result<Self, String> {
                if let $crate::recipe::source::Value::Text(text) = &node.value {
                    $( if text == $word { return Ok(Self::$Variant); } )+
                }
                let legal = Self::kind(range).in_words();
                Err(format!("is {}, but must be one of {legal}", node.value.shown()))
            }

            fn shown(&self) -> Option<String> {
                Some(format!("{:?}", self.word()))
            }
        }
    };
}

//! The one declaration of a step's parameters, from which parsing, range errors, `weald steps`, the JSON
//! Schema and user interfaces follow. See the [`parameters!`](crate::parameters) macro.

use crate::error::Complaint;
use crate::source::{Node, Table};

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
    /// A raster file that is read; its path starts at the folder of the recipe.
    Raster,
    /// A script of edits that is read; its path starts at the folder of the recipe.
    Script,
    /// A file of flames that is read; its path starts at the folder of the recipe.
    Flame,
    /// A colour as `"#rrggbb"`.
    Colour,
    /// Cells a side, or a list of columns and rows.
    Sides,
    /// The name of a layer.
    Layer,
    /// A list of names of layers.
    Layers,
    /// A place as a list of two numbers, or a list of places.
    Places,
    /// A list of numbers, each within both bounds.
    Numbers(f64, f64),
    /// A list of lists of numbers.
    Rows,
    /// A list of these words.
    Choices(&'static [&'static str]),
    /// A table with parameters of its own.
    Table(Vec<Parameter>),
    /// A list of such tables.
    Tables(Vec<Parameter>),
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
            Self::Raster => "raster file".to_owned(),
            Self::Script => "script of edits".to_owned(),
            Self::Flame => ".flame file".to_owned(),
            Self::Colour => "colour \"#rrggbb\"".to_owned(),
            Self::Sides => "whole number from 1, or [columns, rows]".to_owned(),
            Self::Layer => "layer name".to_owned(),
            Self::Layers => "list of layer names".to_owned(),
            Self::Numbers(low, high) => format!("list of numbers, {}", range_in_words(*low, *high)),
            Self::Rows => "list of lists of numbers".to_owned(),
            Self::Choices(names) => format!("list of {}", Self::Choice(names).in_words()),
            Self::Places => "[x, y], or a list of places".to_owned(),
            Self::Table(_) => "table".to_owned(),
            Self::Tables(_) => "list of tables".to_owned(),
        }
    }
}

pub(super) fn range_in_words(low: f64, high: f64) -> String {
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

/// The keys of a table that are parameters of `T`, for a table that holds those of several.
pub fn keys_of<T: Parameters>(table: &Table) -> Table {
    let own: Vec<_> = T::parameters().iter().map(|parameter| parameter.name).collect();
    let entries = table.entries.iter().filter(|(key, _)| own.contains(&key.as_str()));
    Table { line: table.line, entries: entries.cloned().collect() }
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

/// An enum declared by [`choices!`](crate::choices).
pub trait Choice: ParameterValue + Copy {
    /// The word in a recipe.
    fn as_word(self) -> &'static str;
}

/// The key of a field: its name, without the mark of those that are words of Rust, as in `r#where`.
pub fn key(field: &'static str) -> &'static str {
    field.strip_prefix("r#").unwrap_or(field)
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

        impl $crate::parameter::Parameters for $Struct {
            fn parameters() -> Vec<$crate::parameter::Parameter> {
                use $crate::parameter::ParameterValue;
                vec![$( {
                    let default: $Type = $default;
                    $crate::parameter::Parameter {
                        name: $crate::parameter::key(stringify!($name)),
                        doc: concat!($($doc, "\n",)+).trim_ascii(),
                        unit: $crate::parameters!(@unit $($unit)?),
                        kind: <$Type as ParameterValue>::kind($crate::parameters!(@range $($low, $high)?)),
                        required: default.must_be_given(),
                        default: default.shown(),
                    }
                }, )*]
            }

            fn read(
                table: &$crate::source::Table,
                complaints: &mut $crate::parameter::Complaints,
            ) -> Self {
                use $crate::parameter::{key, read_key};
                complaints.unknown_keys(table, &[$(key(stringify!($name))),*]);
                Self { $( $name: read_key(
                    table, key(stringify!($name)), $default, $crate::parameters!(@range $($low, $high)?), complaints,
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

        impl $crate::parameter::Choice for $Enum {
            fn as_word(self) -> &'static str {
                self.word()
            }
        }

        impl $crate::parameter::ParameterValue for $Enum {
            fn kind(_: (f64, f64)) -> $crate::parameter::Kind {
                $crate::parameter::Kind::Choice(&[$($word),+])
            }

            fn read(
                node: &$crate::source::Node,
                range: (f64, f64),
                _: &mut $crate::parameter::Complaints,
            ) -> Result<Self, String> {
                if let $crate::source::Value::Text(text) = &node.value {
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

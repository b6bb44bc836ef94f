//! The one declaration of a step's parameters, from which parsing, range errors, `weald steps`, the JSON
//! Schema and user interfaces follow. See the [`parameters!`](crate::parameters) macro.

use super::check::check_keys;
use super::diagnostics::Diagnostics;
use super::kind::{Kind, Parameter};
use crate::source::{Node, Table};

/// A struct declared by [`parameters!`](crate::parameters).
pub trait Parameters: Sized + Default {
    /// All parameters in the order of their declaration.
    fn parameters() -> Vec<Parameter>;

    /// Reads the values of the keys that are parameters, and leaves all other keys of the table alone.
    fn read_values(table: &Table, diagnostics: &mut Diagnostics) -> Self;

    /// Reads the keys of a table; faults go to `diagnostics`, and their keys keep their defaults. A key that is
    /// unknown, or that has no effect beside the others, is a fault.
    fn read(table: &Table, diagnostics: &mut Diagnostics) -> Self {
        check_keys(table, &Self::parameters(), diagnostics);
        Self::read_values(table, diagnostics)
    }
}

/// The keys of a table that are parameters of `T`, for a table that holds those of several.
pub fn keys_of<T: Parameters>(table: &Table) -> Table {
    let own: Vec<_> = T::parameters().iter().map(|parameter| parameter.name).collect();
    let entries = table.entries.iter().filter(|(key, _)| own.contains(&key.as_str()));
    Table { line: table.line, entries: entries.cloned().collect() }
}

/// A type that a parameter can have.
pub trait ParameterValue: Sized + Clone {
    /// Type and range.
    fn kind(range: (f64, f64)) -> Kind;

    /// Reads a value; an error says what is wrong with it and what is legal.
    fn read(node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String>;

    /// The value with what else the table of its key says about it: the keys of a chosen variant.
    #[must_use]
    fn with_keys_of(self, table: &Table, diagnostics: &mut Diagnostics) -> Self {
        let _ = (table, diagnostics);
        self
    }

    /// The value in TOML notation; `None` where it stands for an absent key.
    fn shown(&self) -> Option<String>;

    /// The value in words, as a default is shown.
    fn in_words(&self) -> Option<String> {
        self.shown()
    }

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
    diagnostics: &mut Diagnostics,
) -> T {
    let value = if let Some(node) = table.get(name) {
        T::read(node, range, diagnostics).unwrap_or_else(|problem| {
            diagnostics.add(node.line, format!("`{name}` {problem}"));
            default
        })
    } else {
        if default.must_be_given() {
            diagnostics.add(table.line, format!("`{name}` is needed: {}", T::kind(range).in_words()));
        }
        default
    };
    value.with_keys_of(table, diagnostics)
}

/// Declares a struct of parameters: `name: Type = default, range low..=high, unit "m";` with a doc comment
/// each. Gives the struct, its `Default` and [`Parameters`].
///
/// A key that has an effect only beside certain others says so at its end: `when method = "mfd"` or `unless method =
/// "d8"`, with several values as `"a" | "b"`; `with lakes` where one of these keys must be given, `without lakes` where
/// that key must not; `for "glb"` where the output must be such a file. Keys that each word of a choice has for itself
/// are declared by [`variants!`](crate::variants).
#[macro_export]
macro_rules! parameters {
    ($(#[$meta:meta])* pub struct $Struct:ident { $(
        $(#[doc = $doc:literal])+
        $name:ident: $Type:ty = $default:expr
            $(, range $low:literal ..= $high:literal)? $(, unit $unit:literal)?
            $(, when $when:ident = $($value:literal)|+)* $(, unless $unless:ident = $($other:literal)|+)*
            $(, with $($with:ident)|+)* $(, without $without:ident)* $(, for $($extension:literal)|+)?;
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
                        default_in_words: default.in_words(),
                        needs: $crate::parameters!(@needs
                            $(when $when $($value)+;)* $(unless $unless $($other)+;)*
                            $(with $($with)+;)* $(without $without;)* $(for $($extension)+;)?),
                    }
                }, )*]
            }

            fn read_values(
                table: &$crate::source::Table,
                diagnostics: &mut $crate::parameter::Diagnostics,
            ) -> Self {
                use $crate::parameter::{key, read_key};
                Self { $( $name: read_key(
                    table, key(stringify!($name)), $default, $crate::parameters!(@range $($low, $high)?), diagnostics,
                ), )* }
            }
        }
    };
    (@unit) => { "1" };
    (@unit $unit:literal) => { $unit };
    (@needs
        $(when $when:ident $($value:literal)+;)* $(unless $unless:ident $($other:literal)+;)*
        $(with $($with:ident)+;)* $(without $without:ident;)* $(for $($extension:literal)+;)?
    ) => {
        vec![
            $($crate::parameter::Needs::Value(stringify!($when), &[$(stringify!($value)),+]),)*
            $($crate::parameter::Needs::OtherValue(stringify!($unless), &[$(stringify!($other)),+]),)*
            $($crate::parameter::Needs::Given(&[$(stringify!($with)),+]),)*
            $($crate::parameter::Needs::Absent(stringify!($without)),)*
            $($crate::parameter::Needs::File(&[$($extension),+]),)?
        ]
    };
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
                _: &mut $crate::parameter::Diagnostics,
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

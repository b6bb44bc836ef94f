//! The one declaration of a step's parameters, from which parsing, range errors, `weald steps`, the JSON
//! Schema and user interfaces follow. See the [`parameters!`](crate::parameters) macro.

use super::check::check_keys;
use super::diagnostics::Diagnostics;
use super::kind::{Kind, Parameter};
use crate::source::{Node, Table, Value};

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

    /// The same with those of its keys that the table has; all others stay as they are.
    #[must_use]
    fn changed(&self, table: &Table, diagnostics: &mut Diagnostics) -> Self;
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

    /// The value after a change: that of the node, or in a table what stands in it with all else as it was.
    ///
    /// # Errors
    /// As [`ParameterValue::read`].
    fn change(&self, node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        Self::read(node, range, diagnostics)
    }

    /// The value after a change of the keys of a chosen variant.
    #[must_use]
    fn with_changed_keys(self, table: &Table, diagnostics: &mut Diagnostics) -> Self {
        let _ = (table, diagnostics);
        self
    }

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

/// What numbers a key may hold.
#[derive(Clone, Copy, Debug)]
pub struct Legal {
    /// Least and greatest.
    pub range: (f64, f64),
    /// Their unit; `1` where they have none.
    pub unit: &'static str,
}

impl Legal {
    /// Any number without unit, and whatever is no number.
    pub const ANY: Self = Self { range: (f64::NEG_INFINITY, f64::INFINITY), unit: "1" };

    /// The end of a message that ends with the range of a number: its unit, and how a number is written.
    fn in_words<T: ParameterValue>(self, node: Option<&Node>) -> String {
        let (Kind::Number(low, high) | Kind::Integer(low, high) | Kind::Numbers(low, high)) =
            T::kind(self.range)
        else {
            return String::new();
        };
        let has_unit = self.unit != "1" && (low.is_finite() || high.is_finite());
        let unit = if has_unit { format!(" {}", self.unit) } else { String::new() };
        let quoted = matches!(node, Some(Node { value: Value::Text(text), .. })
            if text.starts_with(|first: char| first.is_ascii_digit() || first == '-'));
        let alone = if quoted { "; write the number alone, without quotes and unit" } else { "" };
        unit + alone
    }
}

/// Reads one key of a table, or takes its default.
pub fn read_key<T: ParameterValue>(
    table: &Table,
    name: &str,
    default: T,
    legal: Legal,
    diagnostics: &mut Diagnostics,
) -> T {
    let Some(node) = table.get(name) else {
        if default.must_be_given() {
            let wanted = T::kind(legal.range).in_words() + &legal.in_words::<T>(None);
            diagnostics.add(table.line, format!("`{name}` is needed: {wanted}"));
        }
        return with_keys_of(default, (table, name), diagnostics);
    };
    let value = diagnostics.within(name, node, |diagnostics| T::read(node, legal.range, diagnostics));
    let value = value.unwrap_or_else(|problem| {
        let problem = problem + &legal.in_words::<T>(Some(node));
        diagnostics.add(node.line, format!("`{name}` {problem}"));
        default
    });
    with_keys_of(value, (table, name), diagnostics)
}

/// Reads one key of a table into a value that stays as it is where the table does not have it.
pub fn change_key<T: ParameterValue>(
    table: &Table,
    name: &str,
    now: &T,
    legal: Legal,
    diagnostics: &mut Diagnostics,
) -> T {
    let Some(node) = table.get(name) else { return now.clone().with_changed_keys(table, diagnostics) };
    let value = diagnostics.within(name, node, |diagnostics| now.change(node, legal.range, diagnostics));
    value.unwrap_or_else(|problem| {
        let problem = problem + &legal.in_words::<T>(Some(node));
        diagnostics.add(node.line, format!("`{name}` {problem}"));
        now.clone()
    })
}

/// A value with its own keys; faults of their values name it, for ranges differ from variant to variant.
fn with_keys_of<T: ParameterValue>(
    value: T,
    (table, name): (&Table, &str),
    diagnostics: &mut Diagnostics,
) -> T {
    let before = diagnostics.found.len();
    let value = value.with_keys_of(table, diagnostics);
    if let Some(word) = value.shown().filter(|_| diagnostics.found.len() > before) {
        diagnostics.append_to_ranges(before, &format!(" with {name} = {word}"));
    }
    value
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
                    table,
                    key(stringify!($name)),
                    $default,
                    $crate::parameter::Legal {
                        range: $crate::parameters!(@range $($low, $high)?),
                        unit: $crate::parameters!(@unit $($unit)?),
                    },
                    diagnostics,
                ), )* }
            }

            fn changed(
                &self,
                table: &$crate::source::Table,
                diagnostics: &mut $crate::parameter::Diagnostics,
            ) -> Self {
                use $crate::parameter::{change_key, key};
                Self { $( $name: change_key(
                    table,
                    key(stringify!($name)),
                    &self.$name,
                    $crate::parameter::Legal {
                        range: $crate::parameters!(@range $($low, $high)?),
                        unit: $crate::parameters!(@unit $($unit)?),
                    },
                    diagnostics,
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

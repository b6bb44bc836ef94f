//! A word that brings keys of its own into the table in which it stands.

/// Declares an enum whose variants are words of a recipe, each with a struct of the parameters that stand beside the
/// word in the same table: `Mfd(MfdKeys) = "mfd",` with a doc comment each.
#[macro_export]
macro_rules! variants {
    ($(#[$meta:meta])* pub enum $Enum:ident {
        $( $(#[doc = $doc:literal])+ $Variant:ident($Keys:ty) = $word:literal, )+
    }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq)]
        pub enum $Enum { $( $(#[doc = $doc])+ $Variant($Keys), )+ }

        impl $Enum {
            /// The word in a recipe.
            pub const fn word(&self) -> &'static str {
                match self { $( Self::$Variant(_) => $word, )+ }
            }
        }

        $( impl From<$Keys> for $Enum {
            fn from(keys: $Keys) -> Self {
                Self::$Variant(keys)
            }
        } )+

        impl $crate::parameter::ParameterValue for $Enum {
            fn kind(_: (f64, f64)) -> $crate::parameter::Kind {
                use $crate::parameter::{Kind, Parameters, Variant};
                Kind::Variants(vec![$( Variant {
                    word: $word,
                    doc: concat!($($doc, "\n",)+).trim_ascii(),
                    parameters: <$Keys as Parameters>::parameters(),
                } ),+])
            }

            fn read(
                node: &$crate::source::Node,
                range: (f64, f64),
                _: &mut $crate::parameter::Diagnostics,
            ) -> Result<Self, String> {
                if let $crate::source::Value::Text(text) = &node.value {
                    $( if text == $word { return Ok(Self::$Variant(Default::default())); } )+
                }
                let legal = Self::kind(range).in_words();
                Err(format!("is {}, but must be one of {legal}", node.value.shown()))
            }

            fn with_keys_of(
                self,
                table: &$crate::source::Table,
                diagnostics: &mut $crate::parameter::Diagnostics,
            ) -> Self {
                match self { $(
                    Self::$Variant(_) => Self::$Variant(
                        <$Keys as $crate::parameter::Parameters>::read_values(table, diagnostics),
                    ),
                )+ }
            }

            fn with_changed_keys(
                self,
                table: &$crate::source::Table,
                diagnostics: &mut $crate::parameter::Diagnostics,
            ) -> Self {
                match self { $(
                    Self::$Variant(keys) => Self::$Variant(
                        $crate::parameter::Parameters::changed(&keys, table, diagnostics),
                    ),
                )+ }
            }

            fn shown(&self) -> Option<String> {
                Some(format!("{:?}", self.word()))
            }
        }
    };
}

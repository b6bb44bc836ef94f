//! The parameters of a step: its [declaration](Parameter), and the types that [values](ParameterValue) can have, one
//! file a type.

mod check;
mod colour;
mod declaration;
mod diagnostics;
mod fault;
mod file;
mod kind;
mod layer_names;
mod length;
mod needs;
mod places;
mod sides;
mod values;
mod variants;

pub use check::{check_file, check_keys, without_effect};
pub use colour::Colour;
pub use declaration::{Choice, Legal, ParameterValue, Parameters, change_key, key, keys_of, read_key};
pub use diagnostics::{Diagnostics, nearest, synonym};
pub use fault::Fault;
pub use file::{CrsCode, FlameFile, RasterFile, ScriptFile};
pub use kind::{Kind, Needs, Parameter, Variant};
pub use layer_names::LayerNames;
pub use length::Length;
pub use places::Places;
pub use sides::Sides;
pub use values::{LayerName, Nested};

//! What a step can be told: its [declaration](Parameter), and the types that [values](ParameterValue) can have, one file a
//! type.

mod colour;
mod declaration;
mod file;
mod layer_names;
mod places;
mod sides;
mod values;

pub use colour::Colour;
pub use declaration::{
    Choice, Complaints, Kind, Parameter, ParameterValue, Parameters, key, keys_of, nearest, read_key,
};
pub use file::{FlameFile, RasterFile, ScriptFile};
pub use layer_names::LayerNames;
pub use places::Places;
pub use sides::Sides;
pub use values::{LayerName, Nested};

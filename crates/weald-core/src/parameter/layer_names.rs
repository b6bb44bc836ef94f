//! Lists of layer names.

use super::values::wrong;
use super::{Diagnostics, Kind, LayerName, ParameterValue};
use crate::source::{Node, Value};

/// Names of layers, each once.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LayerNames(pub Vec<String>);

impl ParameterValue for LayerNames {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Layers
    }

    fn read(node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        let wanted = "a list of names of layers";
        let Value::List(items) = &node.value else { return Err(wrong(node, wanted)) };
        let mut names = Vec::new();
        for item in items {
            let LayerName(name) = LayerName::read(item, range, diagnostics)?;
            if names.contains(&name) {
                return Err(format!("names layer `{name}` twice"));
            }
            names.push(name);
        }
        Ok(Self(names))
    }

    fn shown(&self) -> Option<String> {
        Some(format!("{:?}", self.0))
    }
}

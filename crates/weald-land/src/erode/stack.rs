//! Materials in working units: thicknesses in cells on a bedrock whose top is the ground less all that lies on
//! it, and back into layers.

use super::material_planes::Planes;
use weald_core::grid::Field;
use weald_core::material::Material;
use weald_core::parameter::{LayerName, nearest};
use weald_engine::stencil::rows::Rows;

/// Layer of the regolith.
pub(crate) const REGOLITH: &str = "regolith";

/// Where the materials of a process stand in its state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Column {
    pub(crate) planes: Planes,
    /// Plane of the regolith, where there is any.
    pub(crate) regolith: Option<usize>,
}

/// What lies on the bedrock at the start.
pub(crate) struct Stack {
    pub(super) column: Column,
    /// Names of the materials above the bedrock.
    pub(super) names: Vec<String>,
    /// Their thicknesses, in metres; what earlier steps left of regolith is the last, where it stays regolith.
    pub(super) metres: Vec<Field>,
    /// The same in cells, with the ring of the working grid.
    pub(super) start: Vec<Vec<f32>>,
    /// Whether an earlier step left regolith.
    pub(super) had_regolith: bool,
}

impl Column {
    /// Names of the planes of the regolith and of the materials above the bedrock.
    pub(crate) fn names(self, materials: &[Material]) -> impl Iterator<Item = String> + '_ {
        let directions: &[&str] =
            if self.regolith.is_some() { &["", "_east", "_west", "_south", "_north"] } else { &[] };
        let regolith = directions.iter().map(|direction| format!("{REGOLITH}{direction}"));
        regolith.chain(materials[1..].iter().map(|material| format!("thickness_{}", material.name)))
    }
}

/// Names of the state planes of a process that begins with the change of the bedrock and has a column behind it.
pub(in crate::erode) fn plane_names(column: Column, materials: &[Material]) -> Vec<String> {
    std::iter::once("change".to_owned()).chain(column.names(materials)).collect()
}

/// Names of materials, bedrock first.
pub(in crate::erode) fn names(materials: &[Material]) -> Vec<String> {
    materials.iter().map(|material| material.name.clone()).collect()
}

impl Stack {
    /// The planes of the state that [`Stack::start`] fills.
    pub(super) fn planes(&self) -> impl Iterator<Item = usize> + '_ {
        let Column { planes, regolith } = self.column;
        (1..planes.materials).map(move |material| planes.of(material)).chain(regolith)
    }

    /// Fills the planes of a state.
    pub(crate) fn scatter(&self, rows: &mut Rows) {
        for (plane, thickness) in self.planes().zip(&self.start) {
            rows.scatter(plane, thickness);
        }
    }

    /// All that lies on the bedrock in a cell, in metres.
    pub(super) fn loose_at(&self, x: usize, y: usize) -> f64 {
        self.metres.iter().map(|layer| f64::from(layer.at(x, y))).sum()
    }
}

/// Number of the material that settles: the one named, or the last; else a sentence for the user.
pub(in crate::erode) fn deposit_of(
    name: Option<&LayerName>,
    materials: &[Material],
) -> Result<usize, String> {
    let Some(last) = materials.len().checked_sub(1) else {
        return Err("the landscape has no materials; it needs a bedrock at least".to_owned());
    };
    let Some(LayerName(name)) = name else { return Ok(last) };
    materials.iter().position(|material| material.name == *name).ok_or_else(|| {
        let known: Vec<_> = materials.iter().map(|material| material.name.as_str()).collect();
        let near = nearest(name, &known).map(|near| format!("; did you mean `{near}`?"));
        let near = near.unwrap_or_default();
        format!("`deposit` is {name:?}, but must be a material of the landscape: {}{near}", known.join(", "))
    })
}

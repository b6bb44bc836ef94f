//! What ground is made of: materials in layers, bedrock first.
//!
//! A material above the bedrock is as thick as the layer of its name says. Before there is such a layer,
//! [`strata`](crate::strata) make it from the declaration: an even `thickness`, or a `bottom` from which the material
//! fills the ground up to what lies on it, so that several bottoms are strata that lie level inside mountains.

use crate::grid::Field;

/// Most materials of a landscape.
pub const MAX_MATERIALS: usize = 8;

/// One material. Its thickness is a layer of the landscape that bears its name; the bedrock, the first of
/// all, has no thickness: the layer `bedrock` is the height of its top.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name, and that of its layer.
    pub name: String,
    /// Share of the unused transport capacity of the water that an iteration takes from this material (0 to 1).
    pub erodibility: f64,
    /// Share of the regolith still missing that standing water makes of it in an iteration (0 to 1).
    pub solubility: f64,
    /// Steepest slope that rests, in degrees (0 to 90).
    pub talus_deg: f64,
    /// Colour in pictures: red, green, blue from 0 to 1, sRGB.
    pub colour: [f32; 3],
    /// Thickness at the start, in metres, where no layer of this name says it cell by cell; for the bedrock
    /// of no meaning.
    pub thickness: f64,
    /// Elevation in metres at which the material begins, in place of a thickness: it fills the ground from
    /// there up to the material on it.
    pub bottom: Option<f64>,
}

/// Name of the layer that holds the height of the bedrock's top.
pub const BEDROCK: &str = "bedrock";

/// Names of layers that no material may have, because steps or tools write something else under them.
pub const RESERVED: &[&str] = &[
    "height",
    BEDROCK,
    "water",
    "sediment",
    "regolith",
    "material",
    "erosion",
    "deposition",
    "slope",
    "flow",
    "flux_x",
    "flux_y",
    "velocity",
    "velocity_x",
    "velocity_y",
    "source",
    "rain",
    "frozen",
];

impl Material {
    /// A built-in material: `rock`, `soil`, `sand`, `gravel` or `clay`, hardest first in the order of erosion.
    pub fn built_in(name: &str) -> Option<Self> {
        let (erodibility, solubility, talus_deg, colour) = match name {
            // Erodibilities within the source's bounds of 0.0001 (rock) and 0.1 (sand); taluses are angles of
            // repose, of clay and rock those at which they stand by cohesion.
            "rock" => (0.0005, 0.002, 75.0, [0.47, 0.44, 0.41]),
            "clay" => (0.005, 0.05, 40.0, [0.62, 0.42, 0.32]),
            "soil" => (0.02, 0.2, 32.0, [0.38, 0.29, 0.19]),
            "gravel" => (0.01, 0.02, 36.0, [0.58, 0.56, 0.53]),
            "sand" => (0.05, 0.1, 30.0, [0.85, 0.74, 0.52]),
            _ => return None,
        };
        let name = name.to_owned();
        Some(Self { name, erodibility, solubility, talus_deg, colour, thickness: 0.0, bottom: None })
    }

    /// The materials of a landscape that names none: rock, and soil where water lays it down.
    pub fn default_stack() -> Vec<Self> {
        ["rock", "soil"].iter().filter_map(|name| Self::built_in(name)).collect()
    }

    /// Thickness where the ground above the material is taken away and ends at `roof`.
    pub(crate) fn under(&self, roof: &Field) -> Field {
        let Some(bottom) = self.bottom else { return Field::filled(roof.size(), self.thickness as f32) };
        let thickness = |&roof: &f32| (roof - bottom as f32).max(0.0);
        Field::from_values(roof.size(), roof.values().iter().map(thickness).collect())
    }
}

/// Names of the layers that hold the ground in pieces: the height of the bedrock, then the thickness of each
/// material on it.
pub fn layer_names(materials: &[Material]) -> impl Iterator<Item = &str> {
    std::iter::once(BEDROCK).chain(materials.iter().skip(1).map(|material| material.name.as_str()))
}

/// The material at the surface of each cell, counted from the bedrock as 0: the topmost one that is at least
/// `thinnest` metres thick.
pub fn topmost(stack: &[Field], cell: usize, thinnest: f32) -> usize {
    stack.iter().rposition(|layer| layer.values()[cell] >= thinnest).map_or(0, |place| place + 1)
}

//! What ground is made of: materials in layers, bedrock first.

/// Most materials of a landscape.
pub const MOST: usize = 8;

/// One material. Its thickness is a layer of the landscape that bears its name; the bedrock, the first of
/// all, has no thickness: the layer `bedrock` is the height of its top.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name, and that of its layer.
    pub name: String,
    /// Share of the free capacity of the water that is taken from this material in a step (0 to 1).
    pub erodibility: f64,
    /// Share of the regolith still missing that standing water makes of it in a step (0 to 1).
    pub solubility: f64,
    /// Steepest slope that rests, in degrees (0 to 90).
    pub talus_deg: f64,
    /// Colour in pictures: red, green, blue from 0 to 1, sRGB.
    pub colour: [f32; 3],
    /// Thickness at the start, in metres, where no layer of this name says it cell by cell; for the bedrock
    /// of no meaning.
    pub thickness: f64,
}

impl Material {
    /// A built-in material: `rock`, `soil`, `sand`, `gravel` or `clay`, hardest first in the order of erosion.
    pub fn built_in(name: &str) -> Option<Self> {
        let (erodibility, solubility, talus_deg, colour) = match name {
            "rock" => (0.0005, 0.002, 75.0, [0.47, 0.44, 0.41]),
            "clay" => (0.005, 0.05, 40.0, [0.62, 0.42, 0.32]),
            "soil" => (0.02, 0.2, 32.0, [0.38, 0.29, 0.19]),
            "gravel" => (0.01, 0.02, 36.0, [0.58, 0.56, 0.53]),
            "sand" => (0.05, 0.1, 30.0, [0.85, 0.74, 0.52]),
            _ => return None,
        };
        let (name, thickness) = (name.to_owned(), 0.0);
        Some(Self { name, erodibility, solubility, talus_deg, colour, thickness })
    }

    /// The materials of a landscape that names none: rock, and soil where water lays it down.
    pub fn default_stack() -> Vec<Self> {
        ["rock", "soil"].iter().filter_map(|name| Self::built_in(name)).collect()
    }
}

//! Grass on a device: its functions in WGSL, and what they are given.
//!
//! [`FUNCTIONS`] is the twin of this module's CPU side. A shader that draws grass is put together of it, of a binding
//! `var<uniform> grasses: Grasses`, and of its own entry points; [`GROW`] is such a shader, by which the two are compared.

use super::blade::Vertex;
use super::growth::Bend;
use super::species::{MAX_SPECIES, ROWS, Species};
use crate::ifs::shader::Shader;
use weald_engine::uniform::Uniform;

/// From an instance, a blade, and a place along and across it, to its vertex: to be joined with a binding of [`Grasses`].
pub const FUNCTIONS: &str = include_str!("grass.wgsl");

/// Vertices of blades: for each of the `corners`, that of the instance of the same number in `sets`. A corner is twice
/// the number of a blade, and one more on its right side; how far along; and the push of the wind. A vertex is its
/// place and share of the good colour, then its normal and share of the head's colour.
pub const GROW: Shader = Shader {
    name: "grow",
    text: &[include_str!("grass.wgsl"), include_str!("grow.wgsl")],
    group: 64,
    uniforms: &["grasses", "range"],
    buffers: &[("sets", false), ("corners", false), ("places", true), ("normals", true)],
};

/// What a device knows of all grass.
#[derive(Clone, Debug, PartialEq)]
pub struct Grasses {
    species: [[f32; 4]; MAX_SPECIES * ROWS],
    level_turn: f32,
}

impl Grasses {
    /// These species, by their numbers.
    ///
    /// # Panics
    /// With more than [`MAX_SPECIES`]: a bug of the caller.
    pub fn new<'a>(species: impl IntoIterator<Item = &'a Species>, bend: Bend) -> Self {
        let mut rows = [[0.0; 4]; MAX_SPECIES * ROWS];
        for (number, species) in species.into_iter().enumerate() {
            rows[number * ROWS..(number + 1) * ROWS].copy_from_slice(&species.rows());
        }
        Self { species: rows, level_turn: bend.of_a_level() }
    }
}

impl Uniform for Grasses {
    const NAME: &'static str = "Grasses";

    fn fields() -> Vec<(&'static str, &'static str)> {
        const _: () = assert!(MAX_SPECIES * ROWS == 144, "the type of the field below");
        vec![("species", "array<vec4<f32>, 144>"), ("level_turn", "f32")]
    }

    fn words(&self) -> Vec<u32> {
        let numbers = self.species.as_flattened().iter().chain([&self.level_turn]);
        numbers.map(|number| number.to_bits()).collect()
    }
}

impl Species {
    /// The species as a device is given it.
    fn rows(&self) -> [[f32; 4]; ROWS] {
        let [soil, between, rich] = self.curves.soil.values();
        let [a, b, c, d, e] = self.curves.width.values();
        let [f, g, h, i, j] = self.curves.height.values();
        let colour = |[red, green, blue]: [f32; 3], fourth| [red, green, blue, fourth];
        [
            [soil, between, rich, self.height],
            [a, b, c, d],
            [e, self.width, self.spread, self.stiffness],
            [f, g, h, i],
            [j, self.taper, self.fold, self.variation],
            colour(self.good, self.bending),
            colour(self.bad, self.stalk),
            colour(self.head, self.heads as f32),
            [self.head_length, self.head_width, self.splay, 0.0],
        ]
    }
}

impl Vertex {
    /// A vertex that stands in the two buffers that [`GROW`] writes; `along` is as it was asked.
    pub fn of_a_device([east, up, south, blend]: [f32; 4], [a, b, c, head]: [f32; 4], along: f32) -> Self {
        Self { place: [east, up, south], normal: [a, b, c], blend, head, along }
    }
}

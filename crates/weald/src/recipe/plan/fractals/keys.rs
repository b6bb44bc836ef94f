//! The keys of a `[[fractal]]` table, and what they are.

use std::path::PathBuf;
use weald_core::parameter::{FlameFile, LayerName, Nested};
use weald_core::source::Table;
use weald_plants::ifs::deform::DeformKeys;
use weald_plants::ifs::{Ifs, Role};

weald_core::choices! {
    /// What a map makes of a plant.
    pub enum PlantRole {
        /// The stem between two joints.
        Stem = "stem",
        /// What goes on along the axis.
        Trunk = "trunk",
        /// A branch, frond or leaf.
        Branch = "branch",
    }
}

weald_core::parameters! {
    /// The keys of `[[fractal]]`. It is made of one of `of`, `maps` and `flame`.
    pub struct FractalKeys {
        /// Name by which outputs call it.
        name: LayerName = LayerName::needed();
        /// Name of a built-in fractal.
        of: Option<String> = None;
        /// Affine maps in the order of their digits, from 0: six numbers [a, b, c, d, e, f] in 2D, for (a x + b y + e,
        /// c x + d y + f), or twelve in 3D, three rows of a matrix, each followed by its part of the translation.
        maps: Vec<Vec<f64>> = Vec::new();
        /// Share of the points that each map gets; they sum to 1. By default by how much area or volume it keeps.
        probabilities: Vec<f64> = Vec::new(), with maps;
        /// What each map makes of a plant, for colours and wind: by default all are branches.
        roles: Vec<PlantRole> = Vec::new(), with maps;
        /// File of flames, of which the affine parts are taken.
        flame: Option<FlameFile> = None;
        /// Which flame of the file.
        flame_number: u32 = 1, range 1..=10_000, with flame;
        /// Digits of the codes of its points. By default what a ten-thousandth of its size needs.
        code_digits: Option<u64> = None, range 1..=256;
        /// Deformations.
        deform: Vec<Nested<DeformKeys>> = Vec::new();
    }
}

/// A fractal of a recipe.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedFractal {
    /// Line of its table.
    pub line: usize,
    /// Its name.
    pub name: String,
    /// What it is made of.
    pub fractal_source: FractalSource,
    /// Its deformations.
    pub deform: Vec<DeformKeys>,
}

/// What a fractal is made of.
#[derive(Clone, Debug, PartialEq)]
pub enum FractalSource {
    /// Maps that are known; boxed because they are many numbers.
    Known(Box<Ifs>),
    /// A file that is read when the recipe runs.
    Flame {
        /// Where it is.
        path: PathBuf,
        /// Which of its flames, counted from 1.
        number: usize,
    },
}

pub(super) fn line_of(table: &Table, key: &str) -> usize {
    table.get(key).map_or(table.line, |node| node.line)
}

impl PlantRole {
    pub(super) fn role(self) -> Role {
        match self {
            Self::Stem => Role::Stem,
            Self::Trunk => Role::Trunk,
            Self::Branch => Role::Branch,
        }
    }
}

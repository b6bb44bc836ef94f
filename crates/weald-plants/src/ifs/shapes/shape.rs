//! A built-in fractal as its source writes it.

use crate::ifs::map::Map;
use crate::ifs::system::{Draft, Ifs, Role, Weighted};

/// A built-in fractal. 3D shapes have `y` up, as 2D ones do.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    /// Its name in recipes and on the command line.
    pub name: &'static str,
    /// What it is, in one sentence.
    pub summary: &'static str,
    /// Where its numbers come from.
    pub source: &'static str,
    /// Digits of its points' codes.
    pub code_digits: usize,
    /// Its maps.
    pub maps: Maps,
}

/// Maps in the notation of their sources, each with its probability and what it makes of a plant.
#[derive(Clone, Copy, Debug)]
pub enum Maps {
    /// a b c d e f of `(a x + b y + e, c x + d y + f)`.
    Planar(&'static [([f64; 6], f64, Role)]),
    /// Three rows of `A`, each followed by its part of `t`.
    Spatial(&'static [([[f64; 4]; 3], f64, Role)]),
}

impl Shape {
    /// The fractal.
    ///
    /// # Panics
    /// Never: a test makes all of them.
    pub fn ifs(&self) -> Ifs {
        Ifs::new(self.draft()).expect("a test checks all built-in shapes")
    }

    pub(super) fn draft(&self) -> Draft {
        let planar = |&(numbers, probability, role): &([f64; 6], f64, Role)| Weighted {
            map: Map::planar(numbers),
            probability,
            role,
        };
        let spatial = |&(rows, probability, role): &([[f64; 4]; 3], f64, Role)| Weighted {
            map: Map::spatial(rows),
            probability,
            role,
        };
        let maps = match self.maps {
            Maps::Planar(maps) => maps.iter().map(planar).collect(),
            Maps::Spatial(maps) => maps.iter().map(spatial).collect(),
        };
        Draft { name: self.name.to_owned(), maps, code_digits: Some(self.code_digits) }
    }
}

//! The built-in fractals. [`SHAPES`] is the registry; `weald fractal list` prints it.

mod ferns;
mod leaves;
mod sets;
mod solids;
mod trees;

use super::map::Map;
use super::system::{Draft, Ifs, Role, Weighted};

/// A built-in fractal. Shapes of space have `y` up, like those of the plane.
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

/// All built-in fractals. Adding one is one line here.
pub const SHAPES: &[Shape] = &[
    sets::GASKET,
    ferns::FERN,
    ferns::CYCLOSORUS,
    ferns::CULCITA,
    ferns::FISHBONE,
    trees::TREE,
    trees::SHRUB,
    leaves::MAPLE,
    leaves::SKELETON,
    sets::DRAGON,
    sets::CARPET,
    sets::SPIRAL,
    solids::FERN,
    solids::CONIFER,
    solids::CROWN,
    solids::TETRAHEDRON,
];

/// The built-in fractal of that name.
pub fn find(name: &str) -> Option<&'static Shape> {
    SHAPES.iter().find(|shape| shape.name == name)
}

impl Shape {
    /// The fractal.
    ///
    /// # Panics
    /// Never: a test makes all of them.
    pub fn ifs(&self) -> Ifs {
        Ifs::new(self.draft()).expect("a test checks all built-in shapes")
    }

    fn draft(&self) -> Draft {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shape_is_a_fractal_whose_codes_leave_two_thousandths_at_most() {
        for shape in SHAPES {
            let ifs = Ifs::new(shape.draft()).unwrap_or_else(|fault| panic!("{}: {fault}", shape.name));
            let share = ifs.ratio_of(ifs.code_digits());
            assert!(share < 2e-3, "{}: {} digits leave {share}", shape.name, ifs.code_digits());
        }
    }

    #[test]
    fn names_are_words_for_the_command_line_and_no_two_are_the_same() {
        for (place, shape) in SHAPES.iter().enumerate() {
            assert!(shape.name.chars().all(|c| c.is_ascii_lowercase() || c == '-' || c.is_ascii_digit()));
            assert!(SHAPES[..place].iter().all(|other| other.name != shape.name));
            assert!(shape.summary.len() > 10 && !shape.source.is_empty());
        }
    }
}

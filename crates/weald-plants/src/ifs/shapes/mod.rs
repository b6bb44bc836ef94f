//! The built-in fractals. [`SHAPES`] is the registry; `weald fractal list` prints it.

mod ferns;
mod leaves;
mod sets;
mod shape;
mod solids;
mod trees;

pub use shape::{Maps, Shape};

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
    solids::SPRUCE,
    solids::CROWN,
    solids::TETRAHEDRON,
];

/// The built-in fractal of that name.
pub fn find(name: &str) -> Option<&'static Shape> {
    SHAPES.iter().find(|shape| shape.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ifs::system::Ifs;

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

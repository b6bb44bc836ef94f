//! The unit square in which the source states its fields and vectors.

use crate::ifs::map::Point;
use crate::ifs::system::Ifs;

/// A change of units, `x → scale x + shift`, from those of a fractal to the unit square (or cube).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Units of the square for one unit of the fractal.
    pub scale: f64,
    /// Where the fractal's origin comes to lie.
    pub shift: Point,
}

impl Frame {
    /// The fractal's own units.
    pub const UNIT: Self = Self { scale: 1.0, shift: [0.0; 3] };

    /// The source's frame for Barnsley's fern: `(x/10 + 0.5, y/10)`.
    pub const FERN: Self = Self { scale: 0.1, shift: [0.5, 0.0, 0.5] };

    /// What is fit for a fractal: its own units if it lies in the unit square, else a square as wide as the longest
    /// side of its box, the box standing in the middle of the square's floor.
    pub fn of(ifs: &Ifs) -> Self {
        let [low, high] = ifs.bounds();
        let slack = 1e-6;
        if low.iter().all(|&x| x >= -slack) && high.iter().all(|&x| x <= 1.0 + slack) {
            return Self::UNIT;
        }
        let side = (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max);
        let scale = 1.0 / side;
        let middle = |i: usize| 0.5 - scale * 0.5 * (low[i] + high[i]);
        let shift = [middle(0), -scale * low[1], if ifs.is_planar() { 0.0 } else { middle(2) }];
        Self { scale, shift }
    }

    /// A point of the fractal in the square.
    pub fn unit(&self, point: Point) -> Point {
        std::array::from_fn(|i| self.scale * point[i] + self.shift[i])
    }

    /// A length in the square as one of the fractal.
    pub fn length(&self, difference: Point) -> Point {
        difference.map(|x| x / self.scale)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ifs::shapes::SHAPES;

    #[test]
    fn the_box_of_a_fractal_stands_in_the_middle_of_the_floor_and_fills_the_square() {
        for shape in SHAPES {
            let ifs = shape.ifs();
            let frame = Frame::of(&ifs);
            let [low, high] = ifs.bounds().map(|corner| frame.unit(corner));
            let inside = |x: f64| (-1e-5..=1.0 + 1e-5).contains(&x);
            assert!(low.into_iter().chain(high).all(inside), "{}: {low:?} to {high:?}", shape.name);
            if frame != Frame::UNIT {
                assert!(low[1].abs() < 1e-9 && (low[0] + high[0] - 1.0).abs() < 1e-9, "{}", shape.name);
            }
        }
    }
}

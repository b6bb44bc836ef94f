//! Displacement by a continuous field (Han and Kim 2007, eq. 5 and 6, figs. 3 and 4).
//!
//! `x → x + V(x)` with `V(x, y) = (5 A (y - 0.3)³, A x (x² - 1.5 x + y + 0.5))`. A is lost in the source; 0.4 bends as its
//! figures do. Other fields are polynomials given term by term.

use super::frame::Frame;
use crate::ifs::map::Point;

/// A polynomial: `factor · x^i y^j z^k`, summed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polynomial(pub Vec<Term>);

/// One term of a polynomial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Its factor.
    pub factor: f64,
    /// Powers of x, y and z, 0 to 9 each.
    pub powers: [u8; 3],
}

impl Polynomial {
    /// From a list of fours: factor, power of x, power of y, power of z.
    ///
    /// # Errors
    /// A sentence for the user.
    pub fn of(numbers: &[f64]) -> Result<Self, String> {
        if !numbers.len().is_multiple_of(4) {
            return Err(format!(
                "a polynomial is a list of fours, factor and powers of x, y and z; {} numbers are no such list",
                numbers.len()
            ));
        }
        let power = |power: f64| {
            let whole = power.fract() == 0.0 && (0.0..=9.0).contains(&power);
            whole
                .then_some(power as u8)
                .ok_or(format!("{power} is no power; they are whole numbers from 0 to 9"))
        };
        let terms = numbers.chunks_exact(4).map(|four| {
            let powers = [power(four[1])?, power(four[2])?, power(four[3])?];
            Ok(Term { factor: four[0], powers })
        });
        terms.collect::<Result<_, String>>().map(Self)
    }

    fn at(&self, point: Point) -> f64 {
        let raised = |base: f64, power: u8| (0..power).fold(1.0, |product, _| product * base);
        let term =
            |term: &Term| (0..3).fold(term.factor, |product, i| product * raised(point[i], term.powers[i]));
        self.0.iter().map(term).sum()
    }
}

/// A vector field in the unit square (or cube) of a [`Frame`].
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its components along x, y and z.
    pub along: [Polynomial; 3],
    /// Units of the field.
    pub frame: Frame,
}

impl Field {
    /// The field of the source, eq. 6, with its A.
    pub fn of_the_source(amplitude: f64, frame: Frame) -> Self {
        let a = amplitude;
        let term = |factor: f64, x: u8, y: u8| Term { factor, powers: [x, y, 0] };
        // 5 A (y - 0.3)³, multiplied out.
        let across =
            vec![term(5.0 * a, 0, 3), term(-4.5 * a, 0, 2), term(1.35 * a, 0, 1), term(-0.135 * a, 0, 0)];
        let along = vec![term(a, 3, 0), term(-1.5 * a, 2, 0), term(a, 1, 1), term(0.5 * a, 1, 0)];
        Self { along: [Polynomial(across), Polynomial(along), Polynomial::default()], frame }
    }

    /// How far a point at `point` is moved, both in the units of the fractal.
    pub fn at(&self, point: Point) -> Point {
        let unit = self.frame.unit(point);
        self.frame.length([0, 1, 2].map(|axis| self.along[axis].at(unit)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_field_of_the_source_is_its_equation(x in 0.0..1.0_f64, y in 0.0..1.0_f64, a in 0.0..2.0_f64) {
            let [across, along, _] = Field::of_the_source(a, Frame::UNIT).at([x, y, 0.0]);
            prop_assert!((across - 5.0 * a * (y - 0.3).powi(3)).abs() < 1e-12);
            prop_assert!((along - a * x * (x * x - 1.5 * x + y + 0.5)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_polynomial_of_three_numbers_or_half_powers_is_refused() {
        assert!(Polynomial::of(&[1.0, 0.0, 0.0]).is_err_and(|fault| fault.contains("3 numbers")));
        assert!(
            Polynomial::of(&[1.0, 0.5, 0.0, 0.0]).is_err_and(|fault| fault.starts_with("0.5 is no power"))
        );
    }
}

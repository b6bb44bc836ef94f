//! Displacement vectors (Han and Kim 2007, eq. 15, figs. 11 and 12): every digit of the interval pushes the point by a
//! vector of its own, finer digits less by the factor delta each.
//!
//! `x → x + Σ_{i = k_b}^{k_e} δ^{i - k_b} d_{m_i}`; the shift is at most `max |d| (1 - δ^length) / (1 - δ)`.

use super::change::digit_fault;
use super::frame::Frame;
use super::interval::Interval;
use crate::ifs::code::{Code, Digits};
use crate::ifs::map::{Point, distance};

/// A vector for each digit.
#[derive(Clone, Debug, PartialEq)]
pub struct Displacement {
    /// Where.
    pub interval: Interval,
    /// Factor from a digit to the next finer one, δ.
    pub delta: f64,
    /// The vectors d₀, d₁, … in units of the frame.
    pub vectors: Vec<Point>,
    /// Units of the vectors.
    pub frame: Frame,
}

impl Displacement {
    /// The vectors of the source, for up to four maps.
    pub const OF_THE_SOURCE: [Point; 4] =
        [[0.1, 0.1, 0.0], [0.1, 0.2, 0.0], [0.2, 0.0, 0.0], [-0.3, -0.1, 0.0]];

    /// How far a point of that code is moved, in the units of the fractal.
    pub fn of(&self, code: &Code) -> Point {
        let mut factor = 1.0;
        let mut sum = [0.0; 3];
        for place in self.interval.places() {
            let vector = self.vectors[usize::from(code.digit(place))];
            for (total, part) in sum.iter_mut().zip(vector) {
                *total += factor * part;
            }
            factor *= self.delta;
        }
        self.frame.length(sum)
    }

    /// The longest shift, in the units of the fractal.
    pub fn bound(&self) -> f64 {
        let lengths = self.vectors.iter().map(|&vector| distance(self.frame.length(vector), [0.0; 3]));
        let longest = lengths.fold(0.0, f64::max);
        let mut factor = 1.0;
        let mut sum = 0.0;
        for _ in self.interval.places() {
            sum += factor;
            factor *= self.delta;
        }
        longest * sum
    }

    pub(super) fn fault(&self, digits: Digits) -> Option<String> {
        let (vectors, maps) = (self.vectors.len(), digits.maps());
        if vectors < maps {
            return Some(format!(
                "{vectors} displacement vectors are too few; each of the {maps} maps needs one"
            ));
        }
        digit_fault(0, digits)
    }
}

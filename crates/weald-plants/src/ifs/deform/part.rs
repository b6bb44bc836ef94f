//! Part-wise linear maps (Han and Kim 2007, eq. 17 to 20, fig. 16): what has a prefix P turns, grows or shears about its
//! joint, `x → x_f + A (x - x_f)`, where `x_f` is the point of P followed by zeros.
//!
//! The test is on codes, so parts that overlap in the picture can be moved apart, and every other point keeps its bits.

use crate::ifs::code::Code;
use crate::ifs::map::{Map, Point};

/// A linear map of one part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The prefix P of the part's codes.
    pub prefix: Code,
    /// `A`, row by row.
    pub linear: [[f64; 3]; 3],
}

impl Part {
    /// Turns in the plane by an angle, counter-clockwise, and grows by a factor.
    pub fn turned(prefix: Code, angle: f64, factor: f64) -> Self {
        let (sine, cosine) = (factor * libm::sin(angle), factor * libm::cos(angle));
        Self { prefix, linear: [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, factor]] }
    }

    /// Where a point of the part comes to lie, its joint being at `joint`.
    pub fn about(&self, joint: Point, point: Point) -> Point {
        let map = Map { linear: self.linear, offset: joint };
        map.at(std::array::from_fn(|i| point[i] - joint[i]))
    }
}

//! Permutation, `m → (m + 1) mod N` (Han and Kim 2007, eq. 8 and 9, fig. 5): a bijection of codes of order N.

use super::change::CodeChange;
use super::interval::Interval;
use crate::ifs::code::{Code, Digits};

/// Every digit of the interval becomes the next one, the last the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Permutation(pub Interval);

impl CodeChange for Permutation {
    fn change(&self, code: &Code, digits: Digits) -> Code {
        let next = |digit: u8| ((usize::from(digit) + 1) % digits.maps()) as u8;
        self.0.places().fold(*code, |code, place| code.replaced(place, next(code.digit(place))))
    }

    fn interval(&self) -> Interval {
        self.0
    }

    fn is_bijective(&self) -> bool {
        true
    }
}

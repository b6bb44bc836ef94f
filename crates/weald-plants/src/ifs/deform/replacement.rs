//! Replacement of a digit by another (Han and Kim 2007, eq. 13 and 14, fig. 10): idempotent and not injective. Of all
//! codes, `((N - 1) / N)^length` are left.

use super::change::{CodeChange, digit_fault};
use super::interval::Interval;
use crate::ifs::code::{Code, Digits};

/// A digit becomes another wherever it stands in the interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Replacement {
    /// Where.
    pub interval: Interval,
    /// The digit that goes, p of the source.
    pub digit: u8,
    /// The digit that comes, q of the source.
    pub with: u8,
}

impl CodeChange for Replacement {
    fn change(&self, code: &Code, _: Digits) -> Code {
        let goes = |code: &Code, place| code.digit(place) == self.digit;
        self.interval.places().fold(*code, |code, place| {
            if goes(&code, place) { code.replaced(place, self.with) } else { code }
        })
    }

    fn interval(&self) -> Interval {
        self.interval
    }

    fn is_bijective(&self) -> bool {
        self.digit == self.with
    }

    fn fault(&self, digits: Digits) -> Option<String> {
        [self.digit, self.with].iter().find_map(|&digit| digit_fault(digit, digits))
    }
}

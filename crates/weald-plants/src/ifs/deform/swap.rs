//! Swap of two digits (Han and Kim 2007, eq. 10 and 11, figs. 6 and 7): an involution of codes.

use super::change::{CodeChange, digit_fault};
use super::interval::Interval;
use crate::ifs::code::{Code, Digits};

/// Two digits take each other's places in the interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Swap {
    /// Where.
    pub interval: Interval,
    /// The two digits.
    pub between: [u8; 2],
}

impl CodeChange for Swap {
    fn change(&self, code: &Code, _: Digits) -> Code {
        let [one, other] = self.between;
        let swapped = |digit: u8| match digit {
            digit if digit == one => other,
            digit if digit == other => one,
            digit => digit,
        };
        self.interval.places().fold(*code, |code, place| code.replaced(place, swapped(code.digit(place))))
    }

    fn interval(&self) -> Interval {
        self.interval
    }

    fn is_bijective(&self) -> bool {
        true
    }

    fn fault(&self, digits: Digits) -> Option<String> {
        self.between.iter().find_map(|&digit| digit_fault(digit, digits))
    }
}

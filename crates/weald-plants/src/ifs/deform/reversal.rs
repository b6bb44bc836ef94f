//! Reversal of the digits of an interval (Fujimoto 2002, as Han and Kim 2007 state it): an involution of codes.

use super::change::CodeChange;
use super::interval::Interval;
use crate::ifs::code::{Code, Digits};

/// The digits of the interval stand in the opposite order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reversal(pub Interval);

impl CodeChange for Reversal {
    fn change(&self, code: &Code, _: Digits) -> Code {
        let from = self.0.places();
        let backward = from.clone().rev();
        from.zip(backward).fold(*code, |changed, (to, from)| changed.replaced(to, code.digit(from)))
    }

    fn interval(&self) -> Interval {
        self.0
    }

    fn is_bijective(&self) -> bool {
        true
    }
}

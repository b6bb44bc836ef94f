//! What a change of codes is. Digits outside of the interval stay, so that a point moves no further than the part
//! of `k_b - 1` digits is wide in which it lies (the bound of Han and Kim 2007, section 3).

use std::fmt::Debug;

use super::interval::Interval;
use crate::ifs::code::{Code, Digits};

/// A rule that gives each code another.
pub trait CodeChange: Debug + Send + Sync {
    /// The other code.
    fn change(&self, code: &Code, digits: Digits) -> Code;

    /// The places that it changes; for an insertion, those between which it inserts.
    fn interval(&self) -> Interval;

    /// Digits that it adds.
    fn lengthens(&self) -> usize {
        0
    }

    /// Whether every code is the other of exactly one.
    fn is_bijective(&self) -> bool;

    /// What is wrong with its digits.
    fn fault(&self, digits: Digits) -> Option<String> {
        let _ = digits;
        None
    }
}

pub(super) fn digit_fault(digit: u8, digits: Digits) -> Option<String> {
    let last = digits.maps() - 1;
    (usize::from(digit) > last)
        .then(|| format!("digit {digit} names no map; the digits here are 0 to {last}"))
}

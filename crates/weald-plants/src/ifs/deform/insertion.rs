//! Insertion of a digit between digits (Han and Kim 2007, eq. 12, figs. 8 and 9): injective on codes without end, and
//! not onto, since parts without that digit are left empty.

use super::change::{CodeChange, digit_fault};
use super::interval::Interval;
use crate::ifs::code::{Code, Digits};

/// A digit comes between any two neighbours in the interval; what follows moves on by that many places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Insertion {
    /// Where.
    pub interval: Interval,
    /// The digit, 0 in the source.
    pub digit: u8,
}

impl CodeChange for Insertion {
    fn change(&self, code: &Code, digits: Digits) -> Code {
        let within = self.interval.places();
        let longer = code.digits().enumerate().flat_map(|(place, digit)| {
            let apart = within.contains(&place) && place > within.start;
            apart.then_some(self.digit).into_iter().chain([digit])
        });
        Code::packed(digits, longer)
    }

    fn interval(&self) -> Interval {
        self.interval
    }

    fn lengthens(&self) -> usize {
        self.interval.count() - 1
    }

    fn is_bijective(&self) -> bool {
        self.lengthens() == 0
    }

    fn fault(&self, digits: Digits) -> Option<String> {
        digit_fault(self.digit, digits)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_digit_that_no_map_has_is_refused() {
        let inserted = |digit| Insertion { interval: Interval { from: 1, to: 3 }, digit };
        let three = Digits::of(3).expect("three");
        assert_eq!(inserted(2).fault(three), None);
        assert!(inserted(3).fault(three).is_some_and(|what| what.contains('3')));
    }
}

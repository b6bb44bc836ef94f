//! Places of a code, counted from 1 as in the source: only digits within them change.

/// Places `from` to `to`, both included, counted from 1, coarsest first: `k_b` and `k_e` of the source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Interval {
    /// The first, `k_b`.
    pub from: usize,
    /// The last, `k_e`.
    pub to: usize,
}

impl Interval {
    /// The places in numbers from 0, as codes count.
    pub(super) fn places(self) -> std::ops::Range<usize> {
        self.from - 1..self.to
    }

    /// How many there are.
    pub fn count(self) -> usize {
        self.to + 1 - self.from
    }

    /// What is wrong with it for codes of so many digits.
    pub(super) fn fault(self, code_digits: usize) -> Option<String> {
        let Self { from, to } = self;
        if from == 0 {
            return Some("`from` is 0, but places of a code are counted from 1".to_owned());
        }
        if from > to {
            return Some(format!(
                "`from` is {from} and `to` is {to}; the first place must not lie after the last"
            ));
        }
        (to > code_digits)
            .then(|| format!("`to` is {to}, but codes of this fractal have {code_digits} digits"))
    }
}

//! What a source claims, and what became of it here. Verdicts follow from numbers of the very run that made the
//! figure, so that the page cannot state what was not measured.

use std::fmt;

/// What became of a claim.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The figure shows it.
    Shown,
    /// The figure shows it where a condition holds, and the contrary elsewhere.
    ShownIf(String),
    /// The figure does not show it.
    NotReproduced,
}

impl Verdict {
    /// Shown where it `holds`.
    pub fn of(holds: bool) -> Self {
        if holds { Self::Shown } else { Self::NotReproduced }
    }

    /// Shown where it holds always, under a condition where it holds then.
    pub fn under(condition: &str, holds_then: bool, holds_always: bool) -> Self {
        match (holds_always, holds_then) {
            (true, _) => Self::Shown,
            (false, true) => Self::ShownIf(condition.to_owned()),
            (false, false) => Self::NotReproduced,
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shown => write!(formatter, "**shown**"),
            Self::ShownIf(condition) => write!(formatter, "**shown under a condition**: {condition}"),
            Self::NotReproduced => write!(formatter, "**not reproduced**"),
        }
    }
}

/// A claim of a source, judged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Claim {
    /// What the source says.
    pub says: String,
    /// Whether the figure shows it.
    pub verdict: Verdict,
    /// The numbers that decide.
    pub measure: String,
}

impl Claim {
    /// A claim with the numbers that decide it.
    pub fn new(says: &str, verdict: Verdict, measure: impl Into<String>) -> Self {
        Self { says: says.to_owned(), verdict, measure: measure.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_that_holds_always_needs_no_condition_and_one_that_never_holds_has_none() {
        assert_eq!(Verdict::under("slow", true, true), Verdict::Shown);
        assert_eq!(Verdict::under("slow", true, false).to_string(), "**shown under a condition**: slow");
        assert_eq!(Verdict::under("slow", false, false), Verdict::of(false));
    }
}

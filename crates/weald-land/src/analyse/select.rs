//! A mask from ranges of layers.
//!
//! Each range of a layer is a [`Condition`]. Their masks meet as fuzzy sets: "all" is their least, "any" their
//! greatest, "not" is 1 - m (Zadeh 1965, doi 10.1016/S0019-9958(65)90241-X), which keeps the laws of De Morgan and
//! leaves a mask met with itself as it is.

use std::cell::Cell;

use super::cells::field_of;
use weald_core::condition::{self, Condition, turned};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Fault, LayerName, Nested};
use weald_core::{choices, parameters};
use weald_engine::Job;
use weald_engine::local::{self, LocalWork, Reach};
use weald_engine::ranks::any;
use weald_engine::step::{Entry, Outcome, Stage, Step};
use weald_engine::stored::StoredLandscape;

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Select>(
    "select",
    Stage::Analyse,
    "a mask from ranges of any layers, with soft edges",
    "Zadeh 1965, doi 10.1016/S0019-9958(65)90241-X",
);

choices! {
    /// How several conditions make one mask.
    pub enum Combine {
        /// A cell must fulfil all of them.
        All = "all",
        /// One of them is enough.
        Any = "any",
    }
}

parameters! {
    /// A selection: 1 inside, 0 outside.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size, parameter::LayerName};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_core::{condition::Condition, parameter::Nested};
    /// # use weald_land::analyse::select::Select;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// landscape.insert("slope", "deg", Field::from_function(landscape.domain.size, |x, _| 10.0 * x as f32));
    /// let steep = Condition { layer: LayerName::of("slope"), above: Some(45.0), ..Condition::default() };
    /// Select { r#where: vec![Nested(steep)], ..Select::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let mask = landscape.field("mask")?;
    /// assert_eq!((mask.at(4, 0), mask.at(5, 0)), (0.0, 1.0), "40° is outside, 50° inside");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Select {
        /// Conditions, each a layer and a range: `[{ layer = "slope", above = 20, below = 45, soft = 5 }, …]`. A
        /// mask is a layer too, so that a selection can go into another one.
        r#where: Vec<Nested<Condition>> = Vec::new();
        /// Whether all conditions must be fulfilled or any of them.
        combine: Combine = Combine::All;
        /// Whether the mask is turned over.
        not: bool = false;
        /// Layer that is written.
        into: LayerName = LayerName::of("mask");
    }
}

impl Step for Select {
    fn reads(&self) -> Vec<String> {
        self.r#where.iter().map(|Nested(condition)| condition.layer.0.clone()).collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.into.0.clone(), "1")]
    }

    fn range(&self, _: &str) -> Option<(f64, f64)> {
        Some((0.0, 1.0))
    }

    fn faults(&self) -> Vec<Fault> {
        let none = self.r#where.is_empty().then(|| {
            let message = "`where` is empty: it needs a condition, such as { layer = \"slope\", above = 30 }";
            Fault::of("where", message)
        });
        none.into_iter().chain(condition::faults(&self.r#where)).collect()
    }

    fn reach(&self) -> Option<Reach> {
        Some(Reach::default())
    }

    fn run_on_disk(&self, landscape: &mut StoredLandscape<'_>, job: &Job<'_>) -> Result<Outcome, Error> {
        let work = LocalWork::of((self.reads(), self.writes()), (Reach::default(), self.bytes_per_cell()));
        let found = Cell::new(false);
        let select = |part: &mut Landscape| {
            found.set(found.get() | self.select(part)?);
            Ok(())
        };
        local::run(&work, landscape, job, &select)?;
        Ok(self.outcome(any(&*landscape.ranks, found.get())?))
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        self.select(landscape).map(|found| self.outcome(found))
    }
}

impl Select {
    /// Writes the mask; says whether any cell is selected.
    fn select(&self, landscape: &mut Landscape) -> Result<bool, Error> {
        let conditions: Vec<(&Condition, &Field)> = self
            .r#where
            .iter()
            .map(|Nested(condition)| Ok((condition, landscape.field(&condition.layer.0)?)))
            .collect::<Result<_, Error>>()?;
        let mask = field_of(&landscape.domain, |x, y| {
            let masks = conditions.iter().map(|(condition, field)| condition.mask(f64::from(field.at(x, y))));
            turned(self.combine.of(masks), self.not)
        });
        let found = mask.values().iter().any(|&share| share != 0.0);
        landscape.insert(&self.into.0, "1", mask);
        Ok(found)
    }

    fn outcome(&self, found: bool) -> Outcome {
        let note = format!("nothing is selected: `{}` is 0 in every cell", self.into.0);
        Outcome { iterations: 1, notes: (!found).then_some(note).into_iter().collect(), ..Outcome::default() }
    }
}

impl Combine {
    fn of(self, masks: impl Iterator<Item = f64>) -> f64 {
        match self {
            Self::All => masks.fold(1.0, f64::min),
            Self::Any => masks.fold(0.0, f64::max),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn condition(above: f64, below: f64, soft: f64) -> Condition {
        Condition { above: Some(above), below: Some(below), soft, ..Condition::default() }
    }

    #[test]
    fn not_all_is_any_of_not() {
        let (a, b) = (condition(0.0, 1.0, 0.8), condition(0.4, 2.0, 0.5));
        let (not_a, not_b) = (Condition { not: true, ..a.clone() }, Condition { not: true, ..b.clone() });
        for value in (-10..30).map(|tenth| f64::from(tenth) / 10.0) {
            let all = Combine::All.of([a.mask(value), b.mask(value)].into_iter());
            let any = Combine::Any.of([not_a.mask(value), not_b.mask(value)].into_iter());
            assert!((turned(all, true) - any).abs() < 1e-12, "at {value}");
        }
    }

    #[test]
    fn a_selection_of_nothing_is_a_fault() {
        assert!(Select::default().faults()[0].message.contains("`where` is empty"));
    }
}

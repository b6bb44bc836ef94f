//! A mask from ranges of layers.
//!
//! ```text
//! m = smooth((v - above) / soft + ½) · smooth((below - v) / soft + ½)          smooth(t) = 3 t² - 2 t³, t in 0 to 1
//! ```
//!
//! so that a mask is ½ at a bound and turns over a width of `soft` around it. Masks meet as fuzzy sets: "all" is
//! their least, "any" their greatest, "not" is 1 - m (Zadeh 1965, doi 10.1016/S0019-9958(65)90241-X), which keeps the
//! laws of De Morgan and leaves a mask met with itself as it is.

use super::cells::field_of;
use crate::engine::Job;
use crate::error::Error;
use crate::grid::Field;
use crate::landscape::Landscape;
use crate::recipe::parameter::{LayerName, Nested};
use crate::step::{Entry, Outcome, Stage, Step};
use crate::{choices, parameters};

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
    /// A range of a layer.
    pub struct Condition {
        /// Layer that is looked at.
        layer: LayerName = LayerName::needed();
        /// Lower bound, in the unit of the layer. Without it, there is none.
        above: Option<f64> = None, range -1.0e12..=1.0e12;
        /// Upper bound, in the unit of the layer. Without it, there is none.
        below: Option<f64> = None, range -1.0e12..=1.0e12;
        /// Width around a bound over which the mask goes from 0 to 1, in the unit of the layer. With 0 the edge is
        /// hard, and a bound itself is inside.
        soft: f64 = 0.0, range 0.0..=1.0e12;
        /// Whether all but the range is meant.
        not: bool = false;
    }
}

parameters! {
    /// A selection: 1 inside, 0 outside.
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

    fn faults(&self) -> Vec<String> {
        let none = self.r#where.is_empty().then(|| {
            "`where` is empty: it needs a condition, such as { layer = \"slope\", above = 30 }".to_owned()
        });
        none.into_iter()
            .chain(self.r#where.iter().filter_map(|Nested(condition)| condition.fault()))
            .collect()
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let conditions: Vec<(&Condition, &Field)> = self
            .r#where
            .iter()
            .map(|Nested(condition)| Ok((condition, landscape.field(&condition.layer.0)?)))
            .collect::<Result<_, Error>>()?;
        let mask = field_of(&landscape.domain, |x, y| {
            let masks = conditions.iter().map(|(condition, field)| condition.mask(f64::from(field.at(x, y))));
            turned(self.combine.of(masks), self.not)
        });
        landscape.insert(&self.into.0, "1", mask);
        Ok(Outcome { iterations: 1, ..Outcome::default() })
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

impl Condition {
    fn fault(&self) -> Option<String> {
        let name = &self.layer.0;
        match (self.above, self.below) {
            (None, None) => Some(format!("the condition on `{name}` has neither `above` nor `below`")),
            (Some(above), Some(below)) if above > below => Some(format!(
                "the condition on `{name}` has `above` = {above} over `below` = {below}, which nothing fulfils; for \
                 what lies outside a range turn it over with `not`"
            )),
            _ => None,
        }
    }

    fn mask(&self, value: f64) -> f64 {
        let above = self.above.map_or(1.0, |above| self.edge(value - above));
        let below = self.below.map_or(1.0, |below| self.edge(below - value));
        turned(above * below, self.not)
    }

    /// From 0 to 1 by the way past a bound.
    fn edge(&self, beyond: f64) -> f64 {
        if self.soft == 0.0 {
            return f64::from(u8::from(beyond >= 0.0));
        }
        let way = (beyond / self.soft + 0.5).clamp(0.0, 1.0);
        way * way * (3.0 - 2.0 * way)
    }
}

fn turned(mask: f64, not: bool) -> f64 {
    if not { 1.0 - mask } else { mask }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn condition(above: f64, below: f64, soft: f64) -> Condition {
        Condition { above: Some(above), below: Some(below), soft, ..Condition::default() }
    }

    #[test]
    fn an_edge_is_soft_over_its_width_and_half_at_its_bound() {
        let slopes = condition(20.0, 45.0, 5.0);
        let masks = [17.5, 20.0, 22.5, 30.0, 42.5, 45.0, 47.5].map(|slope| slopes.mask(slope));
        assert_eq!(masks, [0.0, 0.5, 1.0, 1.0, 1.0, 0.5, 0.0]);
        assert!((slopes.mask(21.0) - 0.784).abs() < 1e-9, "3 · 0.7² - 2 · 0.7³");
    }

    #[test]
    fn a_hard_edge_holds_its_bounds() {
        let hard = condition(1.0, 2.0, 0.0);
        assert_eq!([0.999, 1.0, 2.0, 2.001].map(|value| hard.mask(value)), [0.0, 1.0, 1.0, 0.0]);
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
    fn a_range_that_holds_nothing_and_one_without_bounds_are_faults() {
        assert!(condition(5.0, 3.0, 0.0).fault().expect("a fault").contains("nothing fulfils"));
        assert!(Condition::default().fault().expect("a fault").contains("neither"));
        assert!(Select::default().faults()[0].contains("`where` is empty"));
    }
}

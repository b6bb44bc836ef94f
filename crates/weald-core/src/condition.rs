//! Ranges of layers with soft edges, by which masks are made and plants find their ground.
//!
//! ```text
//! m = smooth((v - above) / soft + ½) · smooth((below - v) / soft + ½)          smooth(t) = 3 t² - 2 t³, t in 0 to 1
//! ```
//!
//! so that a mask is ½ at a bound and turns over a width of `soft` around it.

use crate::parameter::{Fault, LayerName, Nested};
use crate::parameters;

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

impl Condition {
    /// What is wrong with its bounds.
    pub fn fault(&self) -> Option<Fault> {
        let name = &self.layer.0;
        match (self.above, self.below) {
            (None, None) => {
                let message = format!("the condition on `{name}` has neither `above` nor `below`");
                Some(Fault::of("layer", message))
            }
            (Some(above), Some(below)) if above > below => {
                let message = format!(
                    "the condition on `{name}` has `above` = {above} over `below` = {below}, which nothing fulfils; \
                     for what lies outside a range turn it over with `not`"
                );
                Some(Fault::of("above", message))
            }
            _ => None,
        }
    }

    /// How far a value fulfils it, from 0 to 1.
    #[inline]
    pub fn mask(&self, value: f64) -> f64 {
        let above = self.above.map_or(1.0, |above| self.edge(value - above));
        let below = self.below.map_or(1.0, |below| self.edge(below - value));
        turned(above * below, self.not)
    }

    /// Bounds, from 0 to 1, on the mask of all values between two.
    #[inline]
    pub fn between(&self, [least, most]: [f64; 2]) -> [f64; 2] {
        let above = |value: f64| self.above.map_or(1.0, |above| self.edge(value - above));
        let below = |value: f64| self.below.map_or(1.0, |below| self.edge(below - value));
        let bounds = [above(least) * below(most), above(most) * below(least)];
        if self.not { [turned(bounds[1], true), turned(bounds[0], true)] } else { bounds }
    }

    /// From 0 to 1 by the way past a bound.
    #[inline]
    fn edge(&self, beyond: f64) -> f64 {
        if self.soft == 0.0 {
            return f64::from(u8::from(beyond >= 0.0));
        }
        let fraction = (beyond / self.soft + 0.5).clamp(0.0, 1.0);
        fraction * fraction * (3.0 - 2.0 * fraction)
    }
}

/// The mask, or what it leaves of 1.
#[inline]
pub fn turned(mask: f64, not: bool) -> f64 {
    if not { 1.0 - mask } else { mask }
}

/// What is wrong with the conditions of a key `where`.
pub fn faults(conditions: &[Nested<Condition>]) -> impl Iterator<Item = Fault> + '_ {
    let numbered = conditions.iter().zip(1..);
    numbered.filter_map(|(Nested(one), number)| Some(one.fault()?.within(&format!("where.{number}"))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

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
    fn a_range_that_holds_nothing_and_one_without_bounds_are_faults() {
        assert!(condition(5.0, 3.0, 0.0).fault().expect("a fault").message.contains("nothing fulfils"));
        assert!(Condition::default().fault().expect("a fault").message.contains("neither"));
    }

    proptest! {
        #[test]
        fn no_value_between_two_has_a_mask_outside_their_bounds(
            (above, width, soft, not) in (-2.0..2.0_f64, 0.0..3.0_f64, 0.0..2.0_f64, any::<bool>()),
            (least, span, share) in (-4.0..4.0_f64, 0.0..4.0_f64, 0.0..=1.0_f64),
        ) {
            let condition = Condition { not, ..condition(above, above + width, soft) };
            let [low, high] = condition.between([least, least + span]);
            let mask = condition.mask(least + share * span);
            prop_assert!(low <= mask && mask <= high, "{mask} is outside {low} to {high}");
        }
    }
}

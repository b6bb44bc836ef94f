//! Water that comes and goes: rain and evaporation of a step; springs and drains, places where water comes or goes, `q exp(-r² / R²)` per iteration at distance `r` (Šťava et al.
//! 2008). Where less than a millionth of the peak is left, nothing is.

use std::ops::Range;

use weald_core::domain::Domain;
use weald_core::grid::Field;
use weald_core::parameter::Nested;
use weald_core::parameters;
use weald_engine::uniform;

uniform! {
    /// Rain and evaporation of one step, in cells.
    pub(crate) struct Forcing {
        pub(crate) rain: f32,
        pub(crate) evaporation: f32,
    }
}

parameters! {
    /// A place where a river or a spring enters a flood.
    pub struct Source {
        /// Distance from the western edge.
        x: f64 = f64::NAN, range -10_000_000.0..=10_000_000.0, unit "m";
        /// Distance from the northern edge.
        y: f64 = f64::NAN, range -10_000_000.0..=10_000_000.0, unit "m";
        /// Distance at which 1/e of the inflow a square metre is left.
        radius: f64 = f64::NAN, range 0.001..=10_000_000.0, unit "m";
        /// What flows in, in all.
        discharge: f64 = f64::NAN, range 0.0..=1_000_000.0, unit "m³/s";
    }
}

impl Source {
    /// As a spring that gives a depth a second, in metres, so that its cells have the discharge in all.
    pub(crate) fn spring(&self, domain: &Domain) -> Spring {
        let Self { x, y, radius, discharge } = *self;
        let mut shares = Field::filled(domain.size, 0.0);
        let spring = Spring { x, y, radius, rate: 1.0 };
        spring.add_to(&mut shares, domain, 1.0);
        let there = |cell: usize| domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
        let shares = shares.values().iter().enumerate().filter(|&(cell, _)| there(cell));
        let all = shares.map(|(_, &share)| f64::from(share)).sum::<f64>() * domain.cell * domain.cell;
        Spring { rate: if all > 0.0 { discharge / all } else { 0.0 }, ..spring }
    }
}

parameters! {
    /// A place where water springs or drains.
    pub struct Spring {
        /// Distance from the western edge.
        x: f64 = f64::NAN, range -10_000_000.0..=10_000_000.0, unit "m";
        /// Distance from the northern edge.
        y: f64 = f64::NAN, range -10_000_000.0..=10_000_000.0, unit "m";
        /// Distance at which 1/e of the rate is left (R).
        radius: f64 = f64::NAN, range 0.001..=10_000_000.0, unit "m";
        /// Depth of water that comes or goes in an iteration at the centre (q). In all it is π R² q, in m³ per
        /// iteration.
        rate: f64 = f64::NAN, range 0.0..=1000.0, unit "m/iteration";
    }
}

/// Least share of the peak that counts.
const MIN_SHARE: f64 = 1e-6;

impl Spring {
    /// Columns and rows that it can reach.
    fn reached(&self, domain: &Domain) -> [Range<usize>; 2] {
        let widest = self.radius * libm::sqrt(-libm::log(MIN_SHARE));
        let cells = |middle: f64, side: usize| {
            let first = ((middle - widest) / domain.cell - 0.5).ceil().clamp(0.0, side as f64);
            let end = ((middle + widest) / domain.cell + 0.5).floor().clamp(first, side as f64);
            first as usize..end as usize
        };
        [cells(self.x, domain.size.columns), cells(self.y, domain.size.rows)]
    }

    /// Adds `sign` times its water to a field on a domain, in metres per iteration.
    pub(crate) fn add_to(&self, field: &mut Field, domain: &Domain, sign: f64) {
        let [columns, rows] = self.reached(domain);
        for y in rows {
            for x in columns.clone() {
                let [east, south] =
                    [(x, self.x), (y, self.y)].map(|(at, middle)| (at as f64 + 0.5) * domain.cell - middle);
                let share = libm::exp(-(east * east + south * south) / (self.radius * self.radius));
                if share >= MIN_SHARE {
                    field.set(x, y, field.at(x, y) + (sign * self.rate * share) as f32);
                }
            }
        }
    }
}

/// What all springs give, less what all drains take, in metres per iteration, on top of a painted field.
pub(crate) fn field_of(
    domain: &Domain,
    painted: Option<&Field>,
    springs: &[Nested<Spring>],
    drains: &[Nested<Spring>],
) -> Field {
    let mut field = painted.cloned().unwrap_or_else(|| Field::filled(domain.size, 0.0));
    for (all, sign) in [(springs, 1.0), (drains, -1.0)] {
        for Nested(spring) in all {
            spring.add_to(&mut field, domain, sign);
        }
    }
    field
}

/// Says which of the springs under a key of the recipe reach no cell of the landscape.
pub(crate) fn out_of_reach(domain: &Domain, key: &str, springs: &[Nested<Spring>]) -> Vec<String> {
    let far = |spring: &&Nested<Spring>| spring.0.reached(domain).iter().any(Range::is_empty);
    let [width, height] = [domain.size.columns, domain.size.rows].map(|cells| cells as f64 * domain.cell);
    let notes = |Nested(Spring { x, y, .. }): &Nested<Spring>| {
        format!(
            "`{key}`: the one at x = {x}, y = {y} reaches no cell of the landscape, which is {width} m \
             from west to east and {height} m from north to south"
        )
    };
    springs.iter().filter(far).map(notes).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Size;

    #[test]
    fn a_spring_gives_pi_r_squared_times_its_rate_in_all() {
        let domain = Domain::new(Size::square(64).expect("small"), 10.0);
        let spring = Spring { x: 320.0, y: 300.0, radius: 40.0, rate: 0.5 };
        let field = field_of(&domain, None, &[Nested(spring.clone())], &[]);
        let volume = field.sum() * 100.0;
        let expected = std::f64::consts::PI * 40.0 * 40.0 * 0.5;
        assert!((volume / expected - 1.0).abs() < 1e-5, "{volume} m³ per iteration, not {expected}");
        let both = field_of(&domain, None, &[Nested(spring.clone())], &[Nested(spring)]);
        assert!(both.values().iter().all(|&left| left == 0.0), "a drain takes what a spring gives");
    }

    #[test]
    fn a_spring_beside_the_landscape_is_told_and_one_whose_rim_reaches_it_is_not() {
        let domain = Domain::new(Size::square(64).expect("small"), 10.0);
        let at = |x: f64| [Nested(Spring { x, y: 300.0, radius: 40.0, rate: 0.5 })];
        for (x, notes) in [(320.0, 0), (-100.0, 0), (-200.0, 1), (740.0, 0), (900.0, 1)] {
            assert_eq!(out_of_reach(&domain, "sources", &at(x)).len(), notes, "at {x}");
            let given = field_of(&domain, None, &at(x), &[]).sum();
            assert_eq!(given == 0.0, notes == 1, "at {x} it gives {given}");
        }
    }
}

//! Springs and drains: places where water comes or goes, `q exp(-r² / R²)` a step at distance `r` (Šťava et al.
//! 2008). Where less than a millionth of the peak is left, nothing is.

use crate::domain::Domain;
use crate::grid::Field;
use crate::parameters;
use crate::recipe::parameter::Nested;

parameters! {
    /// A place where water springs or drains.
    pub struct Spring {
        /// Distance from the western edge.
        x: f64 = f64::NAN, range -10_000_000.0..=10_000_000.0, unit "m";
        /// Distance from the northern edge.
        y: f64 = f64::NAN, range -10_000_000.0..=10_000_000.0, unit "m";
        /// Distance at which 1/e of the rate is left (R).
        radius: f64 = f64::NAN, range 0.001..=10_000_000.0, unit "m";
        /// Depth of water at the middle that comes or goes in a step (q).
        rate: f64 = f64::NAN, range 0.0..=1000.0, unit "m/step";
    }
}

/// Least share of the peak that counts.
const LEAST_SHARE: f64 = 1e-6;

impl Spring {
    /// Adds `sign` times its water to a field on a domain, in metres a step.
    pub(crate) fn add_to(&self, field: &mut Field, domain: &Domain, sign: f64) {
        let widest = self.radius * libm::sqrt(-libm::log(LEAST_SHARE));
        let cells = |middle: f64, side: usize| {
            let first = ((middle - widest) / domain.cell - 0.5).ceil().clamp(0.0, side as f64);
            let end = ((middle + widest) / domain.cell + 0.5).floor().clamp(first, side as f64);
            first as usize..end as usize
        };
        for y in cells(self.y, domain.size.rows) {
            for x in cells(self.x, domain.size.columns) {
                let [east, south] =
                    [(x, self.x), (y, self.y)].map(|(at, middle)| (at as f64 + 0.5) * domain.cell - middle);
                let share = libm::exp(-(east * east + south * south) / (self.radius * self.radius));
                if share >= LEAST_SHARE {
                    field.set(x, y, field.at(x, y) + (sign * self.rate * share) as f32);
                }
            }
        }
    }
}

/// What all springs give, less what all drains take, in metres a step, on top of a painted field.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Size;

    #[test]
    fn a_spring_gives_pi_r_squared_times_its_rate_in_all() {
        let domain = Domain::new(Size::square(64).expect("small"), 10.0);
        let spring = Spring { x: 320.0, y: 300.0, radius: 40.0, rate: 0.5 };
        let field = field_of(&domain, None, &[Nested(spring.clone())], &[]);
        let volume = field.sum() * 100.0;
        let expected = std::f64::consts::PI * 40.0 * 40.0 * 0.5;
        assert!((volume / expected - 1.0).abs() < 1e-5, "{volume} m³ a step, not {expected}");
        let both = field_of(&domain, None, &[Nested(spring.clone())], &[Nested(spring)]);
        assert!(both.values().iter().all(|&left| left == 0.0), "a drain takes what a spring gives");
    }
}

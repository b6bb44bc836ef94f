//! Rivers that cut down: a step of dh/dt = U − K Aᵐ Sⁿ + deposits, implicit in time.
//!
//! From the base level upstream the new height of the receiver is known, so that each cell has one unknown, its drop x to
//! the receiver (Braun and Willett 2013, doi 10.1016/j.geomorph.2012.10.008):
//!
//! ```text
//! x + F xⁿ = h + U dt + deposit − receiver          F = K Aᵐ dt / Lⁿ
//! ```
//!
//! which has a closed form for n = 1 and 2, and one root that Newton's method nears from one side for any other n. What is
//! steeper than the critical slope, or than the talus of its material, slides down to that. Under water nothing is taken up.
//!
//! In lakes and in the sea a share of the flux settles in each cell, up to the level of the water: deltas grow. Rivers above
//! see the level of the water alone, so that one sweep downstream finds it all.
//!
//! Deposits of rivers are those of Yuan, Braun, Guerit, Rouby and Cordonnier 2019 (doi 10.1029/2018JF004867), G Q / A with the
//! flux Q of all that was taken up upstream: they depend on the new heights, and sweeps over the rivers go on until they agree.

use super::mesh::Mesh;
use super::order::Order;
use super::receivers::Receivers;

/// How rivers cut and lay down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Law {
    /// n.
    pub(super) slope_exponent: f64,
    /// G.
    pub(super) deposition: f64,
    /// Steepest slope that stands, as a tangent.
    pub(super) critical: f64,
    /// Share of the flux that settles in a cell under water.
    pub(super) trapped: f64,
    /// Water whose level is above this lets sediment pass.
    pub(super) passing_above: f64,
}

/// The rivers of a step and the ground that they run over.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rivers<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) receivers: &'a Receivers,
    pub(super) order: &'a Order,
    /// Upslope area of each cell, with its own, in m².
    pub(super) area: &'a [f64],
    /// Ground after uplift and creep, in metres.
    pub(super) raised: &'a [f64],
    /// What has crept into each river, in metres over its cell.
    pub(super) crept: &'a [f64],
    /// Level of lakes and sea over each cell; far below the ground where there is none.
    pub(super) water: Option<&'a [f64]>,
    /// K Aᵐ dt of each cell.
    pub(super) power: &'a [f32],
    /// Steepest slope that stands in each cell, as a tangent, where it is not the same in all.
    pub(super) steepest: Option<&'a [f32]>,
}

/// Sweeps after which deposits count as found; they need 5 to 60.
const MOST_SWEEPS: u32 = 200;

/// Greatest change of a deposit between the last two sweeps, as a share of the greatest.
const CLOSED: f64 = 1e-7;

impl Law {
    /// The heights after the step. Gives the number of sweeps. Nothing is kept in `spare`.
    pub(super) fn incise(&self, rivers: &Rivers<'_>, after: &mut [f64], spare: &mut [f64]) -> u32 {
        rivers.cut(self, None, after);
        if self.deposition == 0.0 {
            if self.trapped > 0.0 && rivers.water.is_some() {
                rivers.silt_up(self, after, spare);
            }
            return 1;
        }
        let mut deposits = vec![0.0; after.len()];
        for sweep in 2..=MOST_SWEEPS {
            let [change, greatest] = rivers.lay_down(self, after, (&mut deposits, spare));
            rivers.cut(self, Some(&deposits), after);
            if change <= CLOSED * greatest {
                return sweep;
            }
        }
        MOST_SWEEPS
    }

    /// The drop to the receiver that is left of one before the step.
    fn drop_left(&self, before: f64, power: f64) -> f64 {
        let n = self.slope_exponent;
        if n == 1.0 {
            before / (1.0 + power)
        } else if n == 2.0 {
            2.0 * before / (1.0 + libm::sqrt(1.0 + 4.0 * power * before))
        } else {
            root(before, power, n)
        }
    }
}

/// The root of x + F xⁿ = b between 0 and b.
fn root(before: f64, power: f64, n: f64) -> f64 {
    // Between the root and where one of the two terms is half of the sum or all of it, the function bends one way.
    let of_power = |share: f64| libm::pow(share * before / power, 1.0 / n);
    let mut x = if n > 1.0 { before.min(of_power(1.0)) } else { (0.5 * before).min(of_power(0.5)) };
    for _ in 0..MOST_NEWTON {
        let taken = power * libm::pow(x, n);
        let change = (x + taken - before) / (1.0 + n * taken / x);
        x -= change;
        if change.abs() <= 1e-12 * x {
            break;
        }
    }
    x
}

/// Newton's method needs 3 to 8 steps.
const MOST_NEWTON: u32 = 60;

impl Rivers<'_> {
    fn level(&self, cell: usize) -> f64 {
        self.water.map_or(f64::NEG_INFINITY, |water| water[cell])
    }

    /// Solves from the base level upstream.
    fn cut(&self, law: &Law, deposits: Option<&[f64]>, after: &mut [f64]) {
        for &cell in self.order.downstream.iter().rev() {
            let cell = cell as usize;
            let receiver = self.receivers.of[cell] as usize;
            after[cell] = if receiver == cell {
                self.raised[cell]
            } else {
                let below = after[receiver].max(self.level(receiver));
                self.new_height(law, cell, below, deposits.map_or(0.0, |deposits| deposits[cell]))
            };
        }
    }

    /// The new height of a cell whose receiver, or the water on it, stands at `below`.
    fn new_height(&self, law: &Law, cell: usize, below: f64, deposit: f64) -> f64 {
        let (raised, level) = (self.raised[cell], self.level(cell));
        if raised < level {
            return (raised + deposit).min(level);
        }
        let before = raised + deposit - below;
        if before <= 0.0 {
            return raised + deposit;
        }
        let inverse = f64::from(self.receivers.inverse[cell]);
        let steepness =
            if law.slope_exponent == 1.0 { inverse } else { libm::pow(inverse, law.slope_exponent) };
        let left = law.drop_left(before, f64::from(self.power[cell]) * steepness);
        let steepest = self.steepest.map_or(law.critical, |steepest| f64::from(steepest[cell]));
        below + left.min(steepest / inverse)
    }

    /// Lets settle in lakes and sea what the rivers that have cut down bring.
    fn silt_up(&self, law: &Law, after: &mut [f64], arriving: &mut [f64]) {
        arriving.fill(0.0);
        for &cell in &self.order.downstream {
            let cell = cell as usize;
            let receiver = self.receivers.of[cell] as usize;
            if receiver != cell {
                if let Some(share) = self.share_trapped(law, cell) {
                    after[cell] = (self.raised[cell] + share * arriving[cell]).min(self.level(cell));
                }
                arriving[receiver] += arriving[cell] + self.crept[cell] + self.raised[cell] - after[cell];
            }
        }
    }

    /// The deposits of what is taken up where the ground becomes `after`; gives the greatest change of one, and the
    /// greatest.
    fn lay_down(&self, law: &Law, after: &[f64], (deposits, arriving): (&mut [f64], &mut [f64])) -> [f64; 2] {
        arriving.fill(0.0);
        let mut found = [0.0_f64; 2];
        for &cell in &self.order.downstream {
            let cell = cell as usize;
            let receiver = self.receivers.of[cell] as usize;
            if receiver == cell {
                continue;
            }
            let (before, raised) = (deposits[cell], self.raised[cell]);
            let taken = if let Some(share) = self.share_trapped(law, cell) {
                deposits[cell] = share * arriving[cell];
                raised - (raised + deposits[cell]).min(self.level(cell))
            } else {
                let share = self.share_laid_down(law, cell);
                // Ground that is higher by some amount all over sends down less, and so much less is laid down that a
                // whole step would overshoot by this factor.
                let answer = share * (self.area[cell] / self.mesh.area - 1.0);
                deposits[cell] += (arriving[cell].max(0.0) * share - before) / (1.0 + answer);
                raised - after[cell]
            };
            arriving[receiver] += arriving[cell] + self.crept[cell] + taken;
            found = [found[0].max((deposits[cell] - before).abs()), found[1].max(deposits[cell])];
        }
        found
    }

    /// The share of what arrives that settles, where the ground lies under water.
    fn share_trapped(&self, law: &Law, cell: usize) -> Option<f64> {
        let level = self.level(cell);
        let share = if level > law.passing_above { 0.0 } else { law.trapped };
        (self.raised[cell] < level).then_some(share)
    }

    fn share_laid_down(&self, law: &Law, cell: usize) -> f64 {
        (law.deposition * self.mesh.area / self.area[cell]).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drop_that_is_left_solves_its_equation_for_any_exponent() {
        for n in [0.3, 0.7, 1.0, 1.3, 2.0, 2.5, 4.0] {
            let law =
                Law { slope_exponent: n, deposition: 0.0, critical: 9.0, trapped: 0.0, passing_above: 0.0 };
            for before in [1e-9, 0.01, 3.0, 4000.0] {
                for power in [1e-8, 0.1, 1.0, 50.0, 1e9] {
                    let left = law.drop_left(before, power);
                    let sum = left + power * left.powf(n);
                    assert!((sum / before - 1.0).abs() < 1e-9, "n {n}, {before} m, F {power}: {left} m");
                }
            }
        }
    }
}

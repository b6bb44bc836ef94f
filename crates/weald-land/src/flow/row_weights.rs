//! What the inner cells of a row give to their neighbours where flow divides, worked out for all of them side by side.

use super::multiple::{MultipleFlow, weight};
use crate::flow::directions::STEPS;
use weald_core::grid::Size;
use weald_core::vectors;

/// Weights of the neighbours of the inner cells of a row, by the drop to each.
pub(crate) struct RowWeights {
    /// By direction from east over south, of the second cell of the row to the last but one.
    by_direction: [Vec<f64>; 8],
    totals: Vec<f64>,
}

/// How water leaves the inner cells of a row, on the average of its shares.
pub(crate) struct RowOutflow {
    /// Cells that it moves on eastward and southward.
    pub(crate) to: [Vec<f64>; 2],
    /// Metres that it falls.
    pub(crate) fall: Vec<f64>,
}

impl RowWeights {
    /// Those of a row; `None` of the first and the last, of a single column or two, and where some cells have no data.
    pub(crate) fn of(flow: &MultipleFlow<'_>, y: usize) -> Option<Self> {
        let Size { columns, rows } = flow.routed.surface.size();
        if y == 0 || y + 1 >= rows || columns < 3 || flow.valid.is_some() {
            return None;
        }
        let by_direction = std::array::from_fn(|direction| toward(flow, y, direction));
        let mut totals = vec![0.0; columns - 2];
        for weights in &by_direction {
            totals.iter_mut().zip(weights).for_each(|(total, weight)| *total += weight);
        }
        Some(Self { by_direction, totals })
    }

    /// Sums of the weights of each cell; 0 of those that drain over flat ground.
    pub(crate) fn totals(&self) -> &[f64] {
        &self.totals
    }

    /// The neighbours that get something of each cell, as bits.
    pub(crate) fn receivers(&self) -> Vec<u8> {
        let mut receivers = vec![0; self.totals.len()];
        for (direction, weights) in self.by_direction.iter().enumerate() {
            let of_cells = receivers.iter_mut().zip(weights);
            of_cells.for_each(|(bits, weight)| *bits |= u8::from(*weight > 0.0) << direction);
        }
        receivers
    }

    /// How water leaves each cell that has lower neighbours; without meaning for others.
    pub(crate) fn outflow(&self, flow: &MultipleFlow<'_>, y: usize) -> RowOutflow {
        let cells = || vec![0.0; self.totals.len()];
        let (mut east, mut south, mut fall) = (cells(), cells(), cells());
        for (direction, weights) in self.by_direction.iter().enumerate() {
            let (eastward, southward) = (STEPS[direction].0 as f64, STEPS[direction].1 as f64);
            let [own, other] = levels(flow, y, direction);
            vectors::widest(
                #[inline(always)]
                || {
                    let moves = east.iter_mut().zip(&mut south).zip(&mut fall);
                    let shares = weights.iter().zip(&self.totals);
                    for ((((east, south), fall), (own, other)), (weight, total)) in
                        moves.zip(own.iter().zip(other)).zip(shares)
                    {
                        let share = weight / total;
                        *east += share * eastward;
                        *south += share * southward;
                        *fall += share * (f64::from(*own) - f64::from(*other));
                    }
                },
            );
        }
        RowOutflow { to: [east, south], fall }
    }
}

/// Weights of the neighbours in a direction.
fn toward(flow: &MultipleFlow<'_>, y: usize, direction: usize) -> Vec<f64> {
    let [own, other] = levels(flow, y, direction);
    let nearness = MultipleFlow::nearness(direction);
    let mut weights = vec![0.0; own.len()];
    vectors::widest(
        #[inline(always)]
        || {
            for ((found, own), other) in weights.iter_mut().zip(own).zip(other) {
                *found = weight((f64::from(*own) - f64::from(*other)) * nearness, flow.exponent);
            }
        },
    );
    weights
}

/// Levels of the inner cells of a row, and of their neighbours in a direction.
fn levels<'a>(flow: &MultipleFlow<'a>, y: usize, direction: usize) -> [&'a [f32]; 2] {
    let columns = flow.routed.surface.size().columns;
    let (east, south) = STEPS[direction];
    let first = y * columns + 1;
    let beside = first.wrapping_add_signed(south * columns as isize + east);
    [first, beside].map(|start| &flow.routed.surface.values()[start..start + columns - 2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::{Routing, route};
    use weald_core::grid::Field;

    #[test]
    fn rows_give_what_each_of_their_cells_does() {
        let size = Size::new(23, 17).expect("small");
        let rough = Field::from_function(size, |x, y| {
            3.0 * x as f32 + 0.7 * y as f32 + ((x * 7 + y * 13) % 11) as f32
        });
        let routed = route(&rough, None, &Routing::default());
        let flow = MultipleFlow { routed: &routed, valid: None, exponent: 1.1 };
        let mut compared = 0;
        for y in 1..16 {
            let row = RowWeights::of(&flow, y).expect("an inner row");
            let (outflow, receivers) = (row.outflow(&flow, y), row.receivers());
            for at in (0..21).filter(|&at| row.totals()[at] > 0.0) {
                let (cell, shares) = (y * 23 + at + 1, flow.shares(y * 23 + at + 1));
                let mut expected = [0.0; 3];
                for (share, (east, south)) in shares.into_iter().zip(STEPS).filter(|(share, _)| *share > 0.0)
                {
                    let other = cell.wrapping_add_signed(south * 23 + east);
                    let fall =
                        f64::from(routed.surface.values()[cell]) - f64::from(routed.surface.values()[other]);
                    let parts = [east as f64, south as f64, fall];
                    expected = std::array::from_fn(|part| expected[part] + share * parts[part]);
                }
                assert_eq!(
                    [outflow.to[0][at], outflow.to[1][at], outflow.fall[at]],
                    expected,
                    "cell {at} of row {y}"
                );
                let bits = (0..8)
                    .filter(|&direction| shares[direction] > 0.0)
                    .fold(0, |bits, direction| bits | 1 << direction);
                assert_eq!(receivers[at], bits);
                compared += 1;
            }
        }
        assert!(compared > 250, "{compared}");
        assert!([0, 16].iter().all(|&y| RowWeights::of(&flow, y).is_none()));
    }
}

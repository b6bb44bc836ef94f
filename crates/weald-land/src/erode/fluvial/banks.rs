//! The wear of banks, by which a river that is wider than a cell becomes as wide as its discharge asks for; [`super`] has the
//! equation and its source.

use super::edges::{AXIS, DIAGONAL, larger};
use weald_engine::kernel;

/// Most by which the ground across a channel levels in a step, as a share of the step between two cells: what creeps
/// and slides besides is stable with it.
const MOST_LEVELLED: f32 = 0.2;

/// Share of the step between two cells that levels across a channel which is wider than they are, for a
/// discharge, what it takes up, and its depth.
#[inline(always)]
pub(super) fn levelled(discharge: f32, uptake: f32, depth: f32, channel_width: f32) -> f32 {
    let width = channel_width * channel_width * discharge;
    // Channels come to be wider than a cell evenly.
    let wider = (width - 1.0).clamp(0.0, 1.0);
    (uptake * (width * width) * wider / depth).min(MOST_LEVELLED)
}

/// What comes over an edge from the next cell by the wear of banks; `here` and `next` are ground, what levels across channels, and
/// depth of water on its two sides. Water wears a bank no higher than it stands.
#[inline(always)]
fn washed(here: [f32; 3], next: [f32; 3], movable: [f32; 2]) -> f32 {
    let step = next[0] - here[0];
    let deep = larger(here[2], next[2]);
    let worn = larger(-deep, if step < deep { step } else { deep });
    0.5 * (here[1] + next[1]) * worn * (movable[0] * movable[1])
}

kernel! {
    /// What the wear of banks brings over the eastern, southern, south-eastern and south-western edge, between cells that water may
    /// change: a border that holds the base level is not filled from its banks.
    pub(crate) struct Banks {
        reads {
            ground, ground_east, ground_south, ground_south_east, ground_south_west,
            across, across_east, across_south, across_south_east, across_south_west,
            water, water_east, water_south, water_south_east, water_south_west,
            movable, movable_east, movable_south, movable_south_east, movable_south_west,
        }
        writes { bank_east, bank_south, bank_diagonal, bank_antidiagonal }
    }
    fn cell() {
        let here = [ground, across, water];
        bank_east = AXIS * washed(here, [ground_east, across_east, water_east], [movable, movable_east]);
        bank_south = AXIS * washed(here, [ground_south, across_south, water_south], [movable, movable_south]);
        let next = [ground_south_east, across_south_east, water_south_east];
        bank_diagonal = DIAGONAL * washed(here, next, [movable, movable_south_east]);
        let next = [ground_south_west, across_south_west, water_south_west];
        bank_antidiagonal = DIAGONAL * washed(here, next, [movable, movable_south_west]);
    }
}

kernel! {
    /// Change of the ground after the wear of banks.
    pub(crate) struct Washed {
        reads {
            settled, bank_east, bank_east_west, bank_south, bank_south_north, bank_diagonal,
            bank_diagonal_north_west, bank_antidiagonal, bank_antidiagonal_north_east,
        }
        writes { washed }
    }
    fn cell() {
        let axes = (bank_east - bank_east_west) + (bank_south - bank_south_north);
        let diagonals =
            (bank_diagonal - bank_diagonal_north_west) + (bank_antidiagonal - bank_antidiagonal_north_east);
        washed = settled + (axes + diagonals);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_channel_levels_where_it_is_wider_than_a_cell() {
        let at = |discharge: f32| levelled(discharge, 0.01, 0.5, 2.0);
        // One cell wide by 0.25, two by 0.5.
        assert_eq!([0.0, 0.25].map(at), [0.0; 2]);
        assert!((at(0.5) - 0.01 * 4.0 / 0.5).abs() < 1e-6 && at(0.375) < 0.6 * at(0.5));
        assert_eq!(at(1e6), MOST_LEVELLED);
    }

    #[test]
    fn water_wears_a_bank_no_higher_than_it_stands_and_takes_what_it_gives() {
        let river = [10.0, 0.1, 0.5];
        for (bank, worn) in [(10.2, 0.2), (30.0, 0.5), (9.0, -0.5)] {
            let bank = [bank, 0.0, 0.0];
            let into = washed(river, bank, [1.0; 2]);
            assert!((into - 0.05 * worn).abs() < 1e-6, "{into} from a bank of {bank:?}");
            assert_eq!(washed(bank, river, [1.0; 2]), -into);
            assert_eq!(washed(river, bank, [1.0, 0.0]), 0.0, "nothing comes from where ground is held");
        }
    }
}

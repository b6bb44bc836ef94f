//! Heads and orders of the channels: where a hundred cells drain through a cell, a channel is.
//!
//! A channel into which no other runs begins at a head and has order 1; where two of the greatest order meet, the
//! order rises by one. Source: Strahler 1957, "Quantitative analysis of watershed geomorphology",
//! doi 10.1029/TR038i006p00913.

use super::drainage::Drainage;
use super::input::CHANNEL_AREA;

/// Heads and orders.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Channels {
    /// Channel cells into which no channel runs.
    pub(super) heads: usize,
    /// Greatest Strahler order; 0 without a channel.
    pub(super) order: u32,
}

/// The channels of a drainage.
pub(super) fn channels(drainage: &Drainage) -> Channels {
    let mut tributaries = vec![Tributaries::default(); drainage.area.len()];
    let mut found = Channels::default();
    let channel = |&&cell: &&usize| drainage.area[cell] >= CHANNEL_AREA;
    for &cell in drainage.order.iter().rev().filter(channel) {
        let order = tributaries[cell].order();
        found.heads += usize::from(tributaries[cell].greatest == 0);
        found.order = found.order.max(order);
        if let Some(next) = drainage.next(cell) {
            tributaries[next].join(order);
        }
    }
    found
}

/// What runs into a cell.
#[derive(Clone, Copy, Default)]
struct Tributaries {
    /// Greatest order among them.
    greatest: u32,
    /// How many have it.
    count: u32,
}

impl Tributaries {
    fn join(&mut self, order: u32) {
        if order > self.greatest {
            *self = Self { greatest: order, count: 1 };
        } else if order == self.greatest {
            self.count += 1;
        }
    }

    fn order(self) -> u32 {
        if self.count >= 2 { self.greatest + 1 } else { self.greatest.max(1) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::drainage::tests::dry;
    use super::super::ground::Ground;
    use super::*;
    use weald_core::grid::{Mask, Size};

    #[test]
    fn two_rivers_of_the_same_order_make_one_of_the_next_and_a_smaller_one_does_not() {
        let mut tributaries = Tributaries::default();
        assert_eq!(tributaries.order(), 1);
        tributaries.join(2);
        tributaries.join(1);
        assert_eq!(tributaries.order(), 2);
        tributaries.join(2);
        assert_eq!(tributaries.order(), 3);
    }

    #[test]
    fn rivers_side_by_side_have_a_head_each_and_stay_of_the_first_order() {
        let parallel = dry(12, 300, |_, y| -y);
        assert_eq!(channels(&parallel), Channels { heads: 12, order: 1 });
    }

    #[test]
    fn two_valleys_that_meet_have_two_heads_and_make_a_river_of_the_second_order() {
        // Land is nothing but a Y of single cells, whose arms are longer than the hundred cells of a channel.
        let size = Size::new(41, 260).expect("legal");
        let [meeting, apart] = [140_usize, 10];
        let from_middle = |y: usize| meeting.saturating_sub(y).min(apart);
        let on_y = |cell: usize| (cell % 41).abs_diff(20) == from_middle(cell / 41);
        let valid = Mask::new(size, (0..size.cells()).map(on_y).collect());
        let height = (0..size.cells()).map(|cell| -((cell / 41) as f64)).collect();
        let ground = Ground { size, valid: valid.as_ref(), height, depth: vec![0.0; size.cells()] };
        let drainage = Drainage::new(&ground, &vec![false; size.cells()]);
        assert_eq!(channels(&drainage), Channels { heads: 2, order: 2 });
    }
}

//! When a front that starts at some cells reaches the others: |∇T| = 1 / speed, by fast marching (Sethian 1996, doi
//! 10.1073/pnas.93.4.1591), so that a round coast stays round.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use weald_core::grid::Size;

/// Where a front comes from and how far it goes.
pub(super) struct March<'a> {
    pub(super) size: Size,
    /// Side of a cell in metres.
    pub(super) cell: f64,
    /// Cells that it starts at, at time 0.
    pub(super) starts: &'a [u32],
    /// Time after which it is followed no further.
    pub(super) until: f64,
}

/// What the front has reached.
pub(super) struct Reached {
    /// When, for each cell; infinite where it does not come.
    pub(super) time: Vec<f64>,
    /// The start from which it came to each cell, [`March::NOWHERE`] where it does not come.
    pub(super) origin: Vec<u32>,
}

/// A cell that the front may reach next.
#[derive(PartialEq)]
struct Next {
    time: f64,
    cell: u32,
}

impl Eq for Next {}

impl Ord for Next {
    /// The earliest is the greatest, of equal ones the lowest number, so that there is one order.
    fn cmp(&self, other: &Self) -> Ordering {
        other.time.total_cmp(&self.time).then(other.cell.cmp(&self.cell))
    }
}

impl PartialOrd for Next {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl March<'_> {
    /// No start.
    pub(super) const NOWHERE: u32 = u32::MAX;

    /// Follows the front over all cells where `speed` is above 0, in metres per unit of time.
    pub(super) fn follow(&self, speed: impl Fn(usize) -> f64) -> Reached {
        let cells = self.size.cells();
        let mut reached = Reached { time: vec![f64::INFINITY; cells], origin: vec![Self::NOWHERE; cells] };
        let mut is_final = vec![false; cells];
        let mut open = BinaryHeap::new();
        for &start in self.starts {
            reached.time[start as usize] = 0.0;
            reached.origin[start as usize] = start;
            open.push(Next { time: 0.0, cell: start });
        }
        while let Some(Next { time, cell }) = open.pop() {
            if time > self.until {
                break;
            }
            if std::mem::replace(&mut is_final[cell as usize], true) {
                continue;
            }
            let origin = reached.origin[cell as usize];
            for beside in self.beside(cell as usize).into_iter().flatten().filter(|&beside| !is_final[beside])
            {
                let speed = speed(beside);
                if speed > 0.0 {
                    let then = self.arrival(&reached.time, beside, self.cell / speed);
                    if then < reached.time[beside] {
                        reached.time[beside] = then;
                        reached.origin[beside] = origin;
                        open.push(Next { time: then, cell: beside as u32 });
                    }
                }
            }
        }
        reached
    }

    /// Neighbours in the west, east, north and south.
    fn beside(&self, cell: usize) -> [Option<usize>; 4] {
        let Size { columns, rows } = self.size;
        let (x, y) = (cell % columns, cell / columns);
        [
            (x > 0).then(|| cell - 1),
            (x + 1 < columns).then(|| cell + 1),
            (y > 0).then(|| cell - columns),
            (y + 1 < rows).then(|| cell + columns),
        ]
    }

    /// When the front comes to a cell that takes it so long to cross, from the times of its neighbours.
    fn arrival(&self, time: &[f64], cell: usize, crossing: f64) -> f64 {
        let [west, east, north, south] =
            self.beside(cell).map(|beside| beside.map_or(f64::INFINITY, |beside| time[beside]));
        let (along, across) = (west.min(east), north.min(south));
        let apart = (along - across).abs();
        if apart < crossing {
            0.5 * (along + across + (2.0 * crossing * crossing - apart * apart).sqrt())
        } else {
            along.min(across) + crossing
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_from_a_point_is_round_and_late_in_slow_ground() {
        let size = Size { columns: 61, rows: 61 };
        let middle = size.index(30, 30) as u32;
        let march = March { size, cell: 2.0, starts: &[middle], until: f64::INFINITY };
        let reached = march.follow(|_| 0.5);
        for (x, y) in [(60, 30), (30, 5), (50, 50), (45, 10)] {
            let distance = 2.0 * ((x as f64 - 30.0).powi(2) + (y as f64 - 30.0).powi(2)).sqrt();
            let time = reached.time[size.index(x, y)];
            assert!((time * 0.5 / distance - 1.0).abs() < 0.06, "{time} for {distance} m");
        }
        let slow = march.follow(|cell| if cell % 61 > 30 { 0.05 } else { 0.5 });
        assert!(slow.time[size.index(60, 30)] > 9.0 * slow.time[size.index(0, 30)]);
    }
}

//! When a front that starts at some cells reaches the others: |∇T| = 1 / speed, by fast marching (Sethian 1996, doi
//! 10.1073/pnas.93.4.1591), so that a round coast stays round; and what it carries along from where it starts, constant along
//! its path: ∇v · ∇T = 0 (Adalsteinsson and Sethian 1999, doi 10.1006/jcph.1998.6090).

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
    /// What it carries from each of these.
    pub(super) values: &'a [f64],
    /// Time after which it is followed no further.
    pub(super) until: f64,
}

/// What the front has reached.
pub(super) struct Reached {
    /// When, for each cell; infinite where it does not come.
    pub(super) time: Vec<f64>,
    /// What it carried there; 0 where it does not come.
    pub(super) value: Vec<f64>,
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
    /// Follows the front over all cells where `speed` is above 0, in metres per unit of time.
    pub(super) fn follow(&self, speed: impl Fn(usize) -> f64) -> Reached {
        let cells = self.size.cells();
        let mut reached = Reached { time: vec![f64::INFINITY; cells], value: vec![0.0; cells] };
        let mut is_final = vec![false; cells];
        let mut open = BinaryHeap::new();
        for (&start, &value) in self.starts.iter().zip(self.values) {
            reached.time[start as usize] = 0.0;
            reached.value[start as usize] = value;
            open.push(Next { time: 0.0, cell: start });
        }
        while let Some(Next { time, cell }) = open.pop() {
            if time > self.until {
                break;
            }
            if std::mem::replace(&mut is_final[cell as usize], true) {
                continue;
            }
            for beside in self.beside(cell as usize).into_iter().flatten().filter(|&beside| !is_final[beside])
            {
                let speed = speed(beside);
                if speed > 0.0 {
                    let (then, value) = self.arrival(&reached, beside, self.cell / speed);
                    if then < reached.time[beside] {
                        (reached.time[beside], reached.value[beside]) = (then, value);
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

    /// When the front comes to a cell that takes it so long to cross, and with what, from the neighbours that it has reached.
    fn arrival(&self, reached: &Reached, cell: usize, crossing: f64) -> (f64, f64) {
        let of = |beside: Option<usize>| {
            beside.map_or((f64::INFINITY, 0.0), |beside| (reached.time[beside], reached.value[beside]))
        };
        let earlier = |a: (f64, f64), b: (f64, f64)| if b.0 < a.0 { b } else { a };
        let [west, east, north, south] = self.beside(cell).map(of);
        let (along, across) = (earlier(west, east), earlier(north, south));
        let apart = (along.0 - across.0).abs();
        if apart >= crossing {
            let first = earlier(along, across);
            return (first.0 + crossing, first.1);
        }
        let time = 0.5 * (along.0 + across.0 + (2.0 * crossing * crossing - apart * apart).sqrt());
        let shares = [time - along.0, time - across.0];
        (time, (shares[0] * along.1 + shares[1] * across.1) / (shares[0] + shares[1]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_front_from_a_point_is_round_and_late_in_slow_ground() {
        let size = Size { columns: 61, rows: 61 };
        let middle = size.index(30, 30) as u32;
        let march = March { size, cell: 2.0, starts: &[middle], values: &[7.0], until: f64::INFINITY };
        let reached = march.follow(|_| 0.5);
        for (x, y) in [(60, 30), (30, 5), (50, 50), (45, 10)] {
            let distance = 2.0 * ((x as f64 - 30.0).powi(2) + (y as f64 - 30.0).powi(2)).sqrt();
            let time = reached.time[size.index(x, y)];
            assert!((time * 0.5 / distance - 1.0).abs() < 0.06, "{time} for {distance} m");
        }
        assert!(reached.value.iter().all(|value| (value - 7.0).abs() < 1e-9), "carried everywhere");
        let slow = march.follow(|cell| if cell % 61 > 30 { 0.05 } else { 0.5 });
        assert!(slow.time[size.index(60, 30)] > 9.0 * slow.time[size.index(0, 30)]);
    }

    #[test]
    fn what_a_front_carries_is_constant_along_its_path_and_not_along_rows_of_cells() {
        // A straight coast that no row or column follows, and a value that grows along it.
        let size = Size { columns: 120, rows: 120 };
        let (east, south) = (0.9, 0.43);
        let off = |cell: usize| (cell % 120) as f64 * -south + (cell / 120) as f64 * east;
        let along = |cell: usize| (cell % 120) as f64 * east + (cell / 120) as f64 * south;
        let starts: Vec<u32> =
            (0..14_400).filter(|&cell| off(cell).abs() < 0.7).map(|cell| cell as u32).collect();
        let values: Vec<f64> = starts.iter().map(|&cell| along(cell as usize)).collect();
        let march = March { size, cell: 1.0, starts: &starts, values: &values, until: f64::INFINITY };
        let reached = march.follow(|_| 1.0);
        for cell in (0..14_400)
            .filter(|&cell| (20.0..40.0).contains(&off(cell)) && (40.0..80.0).contains(&along(cell)))
        {
            let error = reached.value[cell] - along(cell);
            assert!(error.abs() < 2.0, "{error} cells off along the coast, {} off it", off(cell));
        }
    }
}

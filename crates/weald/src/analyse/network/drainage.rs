//! Where each cell drains to: the steepest of eight ways down the flooded ground, into lakes and over the rim.
//!
//! Pits are filled by priority-flood. On filled ground, which is level, water takes the way by which the flood
//! came. Source: O'Callaghan and Mark 1984, "The extraction of drainage networks from digital elevation data",
//! doi 10.1016/S0734-189X(84)80011-0 (D8). Differs: diagonal falls are divided by √2, and pits are filled.

use super::ground::Ground;
use crate::analyse::priority_flood::{Flooded, priority_flood};
use crate::grid::Size;

/// The tree of ways to the outlets.
pub(super) struct Drainage {
    size: Size,
    /// Land cells from the outlets upwards: each comes after the one that it drains to.
    pub(super) order: Vec<usize>,
    /// The next cell on the way down; the cell itself for an outlet.
    pub(super) next: Vec<usize>,
    /// Height in cells at which water runs off, and the way by which the flood came.
    pub(super) flood: Vec<Flooded>,
    /// How deep the ground lies below that height, in cells.
    pub(super) filled: Vec<f64>,
    /// Cells that drain through each cell, itself included.
    pub(super) area: Vec<f64>,
}

impl Drainage {
    /// The drainage of a ground into `lakes` and over its rim.
    pub(super) fn new(ground: &Ground<'_>, lakes: &[bool]) -> Self {
        let surface = |cell: usize| match (ground.is_land(cell), lakes[cell]) {
            (false, _) => f64::INFINITY,
            (true, true) => ground.height[cell] + ground.depth[cell],
            (true, false) => ground.height[cell],
        };
        let size = ground.size;
        let surface: Vec<f64> = (0..size.cells()).map(surface).collect();
        let outlets: Vec<bool> = (0..size.cells())
            .map(|cell| ground.is_land(cell) && (lakes[cell] || ground.on_rim(cell)))
            .collect();
        let (order, flood) = priority_flood(size, &surface, &outlets);
        let order: Vec<usize> = order.into_iter().filter(|&cell| ground.is_land(cell)).collect();
        let next: Vec<usize> = (0..size.cells()).map(|cell| steepest(size, &flood, cell)).collect();
        let area = accumulated(&order, &next);
        let filled = flood.iter().zip(&surface).map(|(flood, surface)| flood.level - surface).collect();
        Self { size, order, next, flood, filled, area }
    }

    /// Whether water ends in a cell.
    pub(super) fn is_outlet(&self, cell: usize) -> bool {
        self.next[cell] == cell
    }

    /// Length in cells of the way from a cell to the next.
    pub(super) fn step(&self, cell: usize) -> f64 {
        distance(self.size, cell, self.next[cell])
    }
}

/// Distance of the centres of two neighbours, in cells.
fn distance(size: Size, cell: usize, other: usize) -> f64 {
    let diagonal = cell % size.columns != other % size.columns && cell / size.columns != other / size.columns;
    if diagonal { std::f64::consts::SQRT_2 } else { 1.0 }
}

/// An outlet is its own next; elsewhere what lies strictly lower was flooded before, so the ways never close.
fn steepest(size: Size, flood: &[Flooded], cell: usize) -> usize {
    let Flooded { level, next } = flood[cell];
    if next == cell {
        return cell;
    }
    let mut best = (0.0, next);
    for other in size.neighbours(cell) {
        let fall = (level - flood[other].level) / distance(size, cell, other);
        if fall > best.0 {
            best = (fall, other);
        }
    }
    best.1
}

fn accumulated(order: &[usize], next: &[usize]) -> Vec<f64> {
    let mut area = vec![0.0; next.len()];
    for &cell in order.iter().rev() {
        area[cell] += 1.0;
        if next[cell] != cell {
            area[next[cell]] += area[cell];
        }
    }
    area
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// The drainage of dry ground of `columns` × `rows` cells.
    pub(in crate::analyse::network) fn dry(
        columns: usize,
        rows: usize,
        height: impl Fn(f64, f64) -> f64,
    ) -> Drainage {
        let size = Size::new(columns, rows).expect("legal");
        let place = |cell: usize| ((cell % columns) as f64, (cell / columns) as f64);
        let height = (0..size.cells()).map(place).map(|(x, y)| height(x, y)).collect();
        let depth = vec![0.0; size.cells()];
        let ground = Ground { size, land: None, height, depth };
        Drainage::new(&ground, &vec![false; size.cells()])
    }

    #[test]
    fn every_cell_of_rough_ground_with_pits_drains_over_the_rim_and_none_is_counted_twice() {
        let rough = |x: f64, y: f64| crate::random::signed2(5, x as i64, y as i64) + 0.01 * x;
        let drainage = dry(40, 30, rough);
        assert!(drainage.filled.iter().any(|&filled| filled > 0.1), "there are pits");
        let outlets = (0..1200).filter(|&cell| drainage.is_outlet(cell));
        assert_eq!(outlets.map(|cell| drainage.area[cell]).sum::<f64>(), 1200.0);
    }

    #[test]
    fn a_slope_drains_straight_down_and_gathers_a_cell_a_row() {
        let drainage = dry(9, 20, |_, y| -y);
        let area: Vec<f64> = (0..20).map(|y| drainage.area[y * 9 + 4]).collect();
        // The first row is an outlet too, being at the border.
        assert_eq!(area[1..], (1..20).map(f64::from).collect::<Vec<_>>());
    }
}

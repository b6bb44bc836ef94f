//! Where the land drains to, into lakes and over its rim, by [`flow`](crate::analyse::flow): pits filled, D8.

use super::ground::Ground;
use crate::flow::directions::Directions;
use crate::flow::{Routing, accumulate, route};
use weald_core::grid::{Field, Mask, Size};

/// The flow paths of the land outside lakes.
pub(super) struct Drainage {
    size: Size,
    directions: Directions,
    /// Heights with pits filled, in cells.
    surface: Field,
    /// Land outside lakes from the outlets upwards: each cell comes after the one that it drains to.
    pub(super) order: Vec<usize>,
    /// Cells that drain through each cell, itself included; 0 in lakes and where there is no land.
    pub(super) area: Vec<f64>,
}

impl Drainage {
    /// The drainage of a ground. What reaches a lake has arrived.
    pub(super) fn new(ground: &Ground<'_>, lakes: &[bool]) -> Self {
        let size = ground.size;
        let height = Field::from_values(size, ground.height.iter().map(|&height| height as f32).collect());
        let dry = (0..size.cells()).map(|cell| ground.is_valid(cell) && !lakes[cell]).collect();
        let dry = Mask::new(size, dry);
        let routed = route(&height, dry.as_ref(), &Routing::default());
        let area = accumulate(&routed.directions, dry.as_ref(), None);
        let order = routed.directions.upward(|cell| dry.as_ref().is_none_or(|dry| dry.is_valid_at(cell)));
        Self { size, directions: routed.directions, surface: routed.surface, order, area }
    }

    /// The cell to which a cell drains; `None` where water has arrived.
    pub(super) fn next(&self, cell: usize) -> Option<usize> {
        self.directions.downstream(cell)
    }

    /// Length in cells of the way from a cell to a neighbour.
    pub(super) fn step(&self, cell: usize, next: usize) -> f64 {
        let columns = self.size.columns;
        let diagonal = cell % columns != next % columns && cell / columns != next / columns;
        if diagonal { std::f64::consts::SQRT_2 } else { 1.0 }
    }

    /// How far water falls from a cell to a neighbour, in cells.
    pub(super) fn fall(&self, cell: usize, next: usize) -> f64 {
        f64::from(self.surface.values()[cell]) - f64::from(self.surface.values()[next])
    }
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
        let ground = Ground { size, valid: None, height, depth };
        Drainage::new(&ground, &vec![false; size.cells()])
    }

    #[test]
    fn what_drains_to_a_lake_has_arrived() {
        let size = Size::new(9, 20).expect("legal");
        let height = (0..180).map(|cell| -f64::from(cell / 9)).collect();
        let ground = Ground { size, valid: None, height, depth: vec![0.0; 180] };
        let lakes: Vec<bool> = (0..180).map(|cell| (90..108).contains(&cell)).collect();
        let drainage = Drainage::new(&ground, &lakes);
        let area = |y: usize| drainage.area[y * 9 + 4];
        assert_eq!([area(9), area(10), area(11), area(12)], [10.0, 0.0, 0.0, 1.0]);
        assert_eq!(drainage.next(9 * 9 + 4), None);
    }
}

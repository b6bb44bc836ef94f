//! Where the water of each cell goes, and how many cells' runoff passes it.
//!
//! Every cell drains to the neighbour of greatest discharge among the three nearest its direction of flow,
//! so that a flow many cells wide gathers in its deepest line. What passes a cell is the number of cells above
//! it or, where more has come by other ways, such as out of a lake, its discharge over the runoff of a cell.

use weald_core::domain::Domain;
use weald_core::grid::{Field, Size};

/// Cosine of 67.5°, half-way between the third and the fourth nearest of eight neighbours.
const NEAREST_THREE: f32 = 0.382_683_43;

/// A landscape's drainage.
#[derive(Debug)]
pub(super) struct Drainage {
    /// Mean flow through each cell, in the unit of the fluxes.
    pub(super) discharge: Vec<f32>,
    /// The cell that each drains to.
    pub(super) downstream: Vec<Option<usize>>,
    /// Cells whose runoff passes.
    pub(super) area: Vec<f32>,
}

impl Drainage {
    /// From mean fluxes through the eastern and southern faces of the cells.
    pub(super) fn of([east, south]: [&Field; 2], domain: &Domain) -> Self {
        let flow = Flow::of(east, south, domain);
        let downstream: Vec<_> = (0..flow.size.cells()).map(|cell| flow.downstream(cell)).collect();
        let mut area = vec![1.0; flow.size.cells()];
        for cell in flow_order(&downstream) {
            if let Some(next) = downstream[cell] {
                area[next] += area[cell];
            }
        }
        let runoff = median(flow.discharge.iter().zip(&area).map(|(discharge, area)| discharge / area));
        for (area, discharge) in area.iter_mut().zip(&flow.discharge) {
            *area = area.max(discharge / runoff.max(f32::MIN_POSITIVE));
        }
        Self { discharge: flow.discharge, downstream, area }
    }
}

/// The middle of the positive numbers; 0 without any.
pub(super) fn median(numbers: impl Iterator<Item = f32>) -> f32 {
    let mut sorted: Vec<f32> = numbers.filter(|&number| number > 0.0).collect();
    sorted.sort_unstable_by(f32::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

/// Cells from the heads downward, each after all that drain to it; whirls and what they feed are left out.
pub(super) fn flow_order(downstream: &[Option<usize>]) -> Vec<usize> {
    let mut waiting = vec![0_u32; downstream.len()];
    for &next in downstream.iter().flatten() {
        waiting[next] += 1;
    }
    let mut order: Vec<usize> = (0..downstream.len()).filter(|&cell| waiting[cell] == 0).collect();
    let mut done = 0;
    while let Some(&cell) = order.get(done) {
        done += 1;
        let Some(next) = downstream[cell] else { continue };
        waiting[next] -= 1;
        if waiting[next] == 0 {
            order.push(next);
        }
    }
    order
}

/// Flow vectors at the cell centres: half-sums of the fluxes through the two faces of each axis.
struct Flow {
    size: Size,
    vector: Vec<[f32; 2]>,
    discharge: Vec<f32>,
}

impl Flow {
    fn of(east: &Field, south: &Field, domain: &Domain) -> Self {
        let size = domain.size;
        let vector: Vec<_> = (0..size.cells()).map(|cell| vector(east, south, cell)).collect();
        let strength = |(cell, &[x, y]): (usize, &[f32; 2])| {
            let land = domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
            let strength = (x * x + y * y).sqrt();
            if land && strength.is_finite() { strength } else { 0.0 }
        };
        let discharge = vector.iter().enumerate().map(strength).collect();
        Self { size, vector, discharge }
    }

    fn downstream(&self, cell: usize) -> Option<usize> {
        let [along_x, along_y] = self.vector[cell];
        let column = |cell: usize| (cell % self.size.columns) as f32;
        let row = |cell: usize| (cell / self.size.columns) as f32;
        let cosine = |other: usize| {
            let (x, y) = (column(other) - column(cell), row(other) - row(cell));
            (x * along_x + y * along_y) / ((x * x + y * y).sqrt() * self.discharge[cell])
        };
        let ahead = self.size.neighbours(cell).map(|other| (self.discharge[other], cosine(other), other));
        let wet = ahead.filter(|&(discharge, cosine, _)| discharge > 0.0 && cosine > NEAREST_THREE);
        // Of two neighbours that carry the same, the one straight ahead.
        let best = wet.max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        best.map(|(.., other)| other)
    }
}

fn vector(east: &Field, south: &Field, cell: usize) -> [f32; 2] {
    let columns = east.size().columns;
    let west = if cell.is_multiple_of(columns) { 0.0 } else { east.values()[cell - 1] };
    let north = if cell < columns { 0.0 } else { south.values()[cell - columns] };
    [0.5 * (west + east.values()[cell]), 0.5 * (north + south.values()[cell])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flow_many_cells_wide_gathers_in_its_deepest_line() {
        let size = Size::square(40).expect("legal");
        let still = Field::filled(size, 0.0);
        let south = Field::from_function(size, |x, y| (y as f32 + 1.0) / (1.0 + (x as f32 - 20.0).abs()));
        let drainage = Drainage::of([&still, &south], &Domain::new(size, 1.0));
        let at = |x, y| drainage.area[size.index(x, y)];
        assert!(at(20, 38) > 1000.0, "{}", at(20, 38));
        assert!(at(12, 38) < 60.0, "{}", at(12, 38));
    }

    #[test]
    fn a_sheet_of_water_keeps_straight_on() {
        let size = Size::square(20).expect("legal");
        let still = Field::filled(size, 0.0);
        let south = Field::from_function(size, |_, y| y as f32 + 1.0);
        let drainage = Drainage::of([&still, &south], &Domain::new(size, 1.0));
        assert_eq!(drainage.downstream[size.index(7, 7)], Some(size.index(7, 8)));
    }
}

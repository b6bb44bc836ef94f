//! Where the water of each cell goes, and how many cells' runoff passes it.
//!
//! Every cell drains to the neighbour of greatest flow among the three nearest its direction, so that a flow many cells
//! wide gathers in its deepest line; flow is smoothed over two cells first, so that a staircase has the direction of the
//! slope on which it lies. What passes a cell is what its own runoff and the cells above bring or, where more has come by
//! other ways, such as out of a lake, its discharge; and no less than passes any cell above.

use super::flow_field::FlowField;
use weald_core::domain::Domain;
use weald_core::grid::{Field, Size};

/// Cosine of 67.5°, half-way between the third and the fourth nearest of eight neighbours.
const NEAREST_THREE: f32 = 0.382_683_43;

/// A landscape's drainage.
#[derive(Debug)]
pub(super) struct Drainage {
    /// Mean flow, smoothed.
    pub(super) flow: FlowField,
    /// The cell that each drains to.
    pub(super) downstream: Vec<Option<usize>>,
    /// Cells whose runoff passes.
    pub(super) area: Vec<f32>,
}

impl Drainage {
    /// From mean fluxes through the eastern and southern faces of the cells.
    pub(super) fn of(flux: [&Field; 2], domain: &Domain) -> Self {
        let raw = FlowField::of(flux, domain);
        let flow = raw.smoothed();
        let downstream: Vec<_> = (0..flow.size.cells()).map(|cell| downstream(&flow, cell)).collect();
        let area = areas(&raw, &flow_order(&downstream), &downstream, &runoffs(flux));
        Self { flow, downstream, area }
    }
}

/// Cells whose runoff passes each.
fn areas(flow: &FlowField, order: &[usize], downstream: &[Option<usize>], runoff: &[f32]) -> Vec<f32> {
    let (mut count, mut sum) = (vec![1.0_f32; runoff.len()], runoff.to_vec());
    let mut passing = flow.strength.clone();
    for &cell in order {
        passing[cell] = passing[cell].max(sum[cell]);
        if let Some(next) = downstream[cell] {
            count[next] += count[cell];
            sum[next] += passing[cell];
            passing[next] = passing[next].max(passing[cell]);
        }
    }
    let of_a_cell = median(passing.iter().zip(&count).map(|(passing, count)| passing / count));
    passing.iter().map(|passing| passing / of_a_cell.max(f32::MIN_POSITIVE)).collect()
}

/// What each cell adds to the flow.
fn runoffs([east, south]: [&Field; 2]) -> Vec<f32> {
    let columns = east.size().columns;
    let added = |cell: usize| {
        let west = if cell.is_multiple_of(columns) { 0.0 } else { east.values()[cell - 1] };
        let north = if cell < columns { 0.0 } else { south.values()[cell - columns] };
        (east.values()[cell] - west) + (south.values()[cell] - north)
    };
    (0..east.size().cells())
        .map(|cell| Some(added(cell)).filter(|it| it.is_finite()).unwrap_or(0.0))
        .collect()
}

/// The middle of the positive numbers; 0 without any.
fn median(numbers: impl Iterator<Item = f32>) -> f32 {
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

/// The cell that one drains to; none where its water leaves the grid or runs dry.
fn downstream(flow: &FlowField, cell: usize) -> Option<usize> {
    let [along_x, along_y] = flow.vector[cell];
    if outward(flow, cell) > NEAREST_THREE * flow.strength[cell] {
        return None;
    }
    let column = |cell: usize| (cell % flow.size.columns) as f32;
    let row = |cell: usize| (cell / flow.size.columns) as f32;
    let cosine = |other: usize| {
        let (x, y) = (column(other) - column(cell), row(other) - row(cell));
        (x * along_x + y * along_y) / ((x * x + y * y).sqrt() * flow.strength[cell])
    };
    let ahead = flow.size.neighbours(cell).map(|other| (flow.strength[other], cosine(other), other));
    let wet = ahead.filter(|&(strength, cosine, _)| strength > 0.0 && cosine > NEAREST_THREE);
    // Of two neighbours that carry the same, the one straight ahead.
    let best = wet.max_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    best.map(|(.., other)| other)
}

/// Flow of a cell over the border of the grid.
fn outward(flow: &FlowField, cell: usize) -> f32 {
    let axis = |place: usize, count: usize, along: f32| {
        let over_first = if place == 0 { -along } else { 0.0 };
        if place + 1 == count { over_first.max(along) } else { over_first }
    };
    let [along_x, along_y] = flow.vector[cell];
    let Size { columns, rows } = flow.size;
    axis(cell % columns, columns, along_x).max(axis(cell / columns, rows, along_y))
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
        assert!(at(20, 38) > 10.0 * at(12, 38), "{} beside {}", at(20, 38), at(12, 38));
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

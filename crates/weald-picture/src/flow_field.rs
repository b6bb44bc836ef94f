//! Mean flow as a vector a cell, and where it is concentrated in a channel.
//!
//! A channel is a crest of the flow: on both sides, within some cells, less than a quarter of it flows. So a sheet of water on
//! a slope or a fan has none, however much water it carries; channels begin where flow gathers from the contour (the
//! area over contour width of Montgomery and Dietrich 1988, "Where do channels begin?", doi 10.1038/336232a0). What
//! differs: the contrast with what flows beside it decides, not the slope, which the water knows already.

use super::texture::smoothed;
use weald_core::domain::Domain;
use weald_core::grid::{Field, Size};

/// Cells to either side within which the flow of a channel falls.
pub(super) const SIDE: i32 = 12;

/// Share of its flow below which that beside it falls.
const BESIDE: f32 = 0.25;

/// Flow vectors at the centres of cells, eastward and southward.
#[derive(Debug)]
pub(super) struct FlowField {
    pub(super) size: Size,
    pub(super) vector: Vec<[f32; 2]>,
    /// Their lengths.
    pub(super) strength: Vec<f32>,
}

impl FlowField {
    /// Half-sums of the mean fluxes through the two faces of each axis; none where there is no data.
    pub(super) fn of([east, south]: [&Field; 2], domain: &Domain) -> Self {
        let columns = domain.size.columns;
        let vector = |cell: usize| {
            let west = if cell.is_multiple_of(columns) { 0.0 } else { east.values()[cell - 1] };
            let north = if cell < columns { 0.0 } else { south.values()[cell - columns] };
            let [x, y] = [0.5 * (west + east.values()[cell]), 0.5 * (north + south.values()[cell])];
            let land = domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
            if land && x.is_finite() && y.is_finite() { [x, y] } else { [0.0; 2] }
        };
        Self::new(domain.size, (0..domain.size.cells()).map(vector).collect())
    }

    fn new(size: Size, vector: Vec<[f32; 2]>) -> Self {
        let strength = vector.iter().map(|[x, y]| (x * x + y * y).sqrt()).collect();
        Self { size, vector, strength }
    }

    /// Means with weights that fall off over two cells.
    pub(super) fn smoothed(&self) -> Self {
        let axis = |axis: usize| {
            let values = self.vector.iter().map(|vector| vector[axis]).collect();
            smoothed(&Field::from_values(self.size, values), 1).into_values()
        };
        let [east, south] = [axis(0), axis(1)];
        Self::new(self.size, east.into_iter().zip(south).map(|(east, south)| [east, south]).collect())
    }

    /// Strength at a place in cells from the western and the northern edge, linear between the centres.
    pub(super) fn at(&self, [x, y]: [f32; 2]) -> f32 {
        let [(left, right, across), (above, below, down)] =
            [span(x, self.size.columns), span(y, self.size.rows)];
        let row = |y: usize| {
            let row = &self.strength[y * self.size.columns..];
            row[left] + (row[right] - row[left]) * across
        };
        row(above) + (row(below) - row(above)) * down
    }

    /// Whether a place is within the grid.
    pub(super) fn contains(&self, [x, y]: [f32; 2]) -> bool {
        x >= 0.0 && y >= 0.0 && x <= self.size.columns as f32 && y <= self.size.rows as f32
    }

    /// Whether a cell lies on a crest of the flow or next to one.
    pub(super) fn is_channel(&self, cell: usize) -> bool {
        let strength = self.strength[cell];
        if strength <= 0.0 {
            return false;
        }
        let profile = |offset| self.beside(cell, offset);
        let crest = [0, -1, 1].into_iter().filter_map(|offset| Some((offset, profile(offset)?)));
        let (middle, highest) = crest.fold((0, 0.0), |best, it| if it.1 > best.1 { it } else { best });
        [-1, 1].into_iter().all(|side| {
            let beside = (1..=SIDE).map_while(|away| profile(middle + side * away));
            // Flow that rises again belongs to another channel.
            beside.take_while(|&it| it <= highest).any(|it| it < BESIDE * highest)
        })
    }

    /// Flow so many cells to the left of a cell where water flows, or to the right; none beyond the grid.
    fn beside(&self, cell: usize, offset: i32) -> Option<f32> {
        let (strength, [x, y]) = (self.strength[cell], self.vector[cell]);
        let [column, row] = [cell % self.size.columns, cell / self.size.columns].map(|it| it as f32 + 0.5);
        let away = offset as f32 / strength;
        let place = [column - away * y, row + away * x];
        self.contains(place).then(|| self.at(place))
    }

    /// All that flows past a cell within so many cells to both sides.
    pub(super) fn passing(&self, cell: usize, cells: i32) -> f32 {
        if self.strength[cell] <= 0.0 {
            return 0.0;
        }
        (-cells..=cells).filter_map(|offset| self.beside(cell, offset)).sum()
    }

    /// How far the crest of the flow lies from a place along a unit vector, in cells; at most half a cell.
    pub(super) fn crest(&self, place: [f32; 2], across: [f32; 2]) -> f32 {
        let beside = |side: f32| self.at([0, 1].map(|axis| place[axis] + side * across[axis]));
        let [left, here, right] = [beside(-1.0), beside(0.0), beside(1.0)];
        let bend = 2.0 * here - left - right;
        if bend <= 0.0 { 0.0 } else { (0.5 * (right - left) / bend).clamp(-0.5, 0.5) }
    }
}

/// The two centres around a place on an axis, and the share of the way between them.
fn span(place: f32, count: usize) -> (usize, usize, f32) {
    let place = (place - 0.5).clamp(0.0, (count - 1) as f32);
    let first = place as usize;
    (first, (first + 1).min(count - 1), place - first as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Southward flow in 40 columns.
    fn southward(flow: impl Fn(f32) -> f32) -> FlowField {
        let size = Size::square(40).expect("small");
        let south = Field::from_function(size, |x, _| flow(x as f32));
        FlowField::of([&Field::filled(size, 0.0), &south], &Domain::new(size, 1.0)).smoothed()
    }

    fn channels(flow: &FlowField) -> Vec<usize> {
        (0..40).filter(|x| flow.is_channel(flow.size.index(*x, 20))).collect()
    }

    #[test]
    fn a_channel_is_where_less_flows_on_both_sides() {
        let single = |x: f32| if x == 17.0 { 9.0 } else { 0.1 };
        assert_eq!(channels(&southward(single)), [16, 17, 18], "the crest and what lies next to it");
        let step = |x: f32| if x > 17.0 { 9.0 } else { 0.1 };
        assert_eq!(channels(&southward(step)), [0; 0]);
        let threads = |x: f32| if x % 3.0 == 0.0 { 9.0 } else { 0.1 };
        assert_eq!(channels(&southward(threads)), [0; 0], "a comb is a sheet");
        assert_eq!(channels(&southward(|_| 9.0)), [0; 0]);
    }

    #[test]
    fn the_crest_of_a_flow_lies_between_the_cells() {
        let flow = southward(|x| libm::expf(-(x - 17.3) * (x - 17.3) / 4.0));
        let off = flow.crest([17.5, 20.0], [1.0, 0.0]);
        assert!((off - 0.3).abs() < 0.03, "{off}");
    }
}

//! River lines from a field of mean discharge.
//!
//! A cell is channel where its discharge stands out from the film of rain on dry land. Every channel cell
//! hands on to the neighbour of greatest discharge among the three nearest its direction of flow, which makes
//! a forest of streams; the longest way up from each mouth is a river, what joins it a tributary, and spurs of
//! a few cells, which are banks of a wide river, are left out. Lines widen with the logarithm of discharge.

use super::lakes::Lakes;
use super::sheet::Sheet;
use super::strokes::{Point, Strokes};
use crate::domain::Domain;
use crate::grid::{Field, Size};

/// Share of the land outside lakes that may be channel.
const CHANNEL_SHARE: f64 = 0.10;

/// A channel carries at least this many times the discharge of the median cell.
const ABOVE_MEDIAN: f32 = 5.0;

/// Shortest stream that is drawn, in cells.
const SHORTEST: u32 = 7;

/// Width of the finest stream in lines, and its growth with each doubling of the discharge.
const FINEST: f32 = 1.0;
const GROWTH: f32 = 0.45;

/// Draws the rivers of a landscape; `None` where nothing flows.
pub(super) fn draw(
    flux: [&Field; 2],
    domain: &Domain,
    lakes: Option<&Lakes>,
    sheet: &Sheet,
) -> Option<Strokes> {
    let flow = Flow::new(flux, domain, lakes)?;
    let mut strokes = Strokes::new(sheet.width, sheet.height);
    for stream in Forest::of(&flow).streams() {
        let points: Vec<_> = stream.iter().map(|&cell| flow.point(cell, sheet)).collect();
        strokes.draw(&points);
    }
    Some(strokes)
}

/// Mean flow through the cells: half-sums of the fluxes through the two faces of each axis.
struct Flow {
    size: Size,
    vector: Vec<[f32; 2]>,
    discharge: Vec<f32>,
    /// Discharge at which channels start.
    threshold: f32,
}

impl Flow {
    fn new([east, south]: [&Field; 2], domain: &Domain, lakes: Option<&Lakes>) -> Option<Self> {
        let size = domain.size;
        let vector = cell_flow(east, south);
        let on_land = |cell: usize| domain.land.as_ref().is_none_or(|land| land.is_land_at(cell));
        let strength = |(cell, &[x, y]): (usize, &[f32; 2])| {
            let strength = (x * x + y * y).sqrt();
            if on_land(cell) && strength.is_finite() { strength } else { 0.0 }
        };
        let discharge: Vec<f32> = vector.iter().enumerate().map(strength).collect();
        let mut sorted: Vec<f32> = (0..size.cells())
            .filter(|&cell| on_land(cell) && !lakes.is_some_and(|lakes| lakes.cells[cell]))
            .map(|cell| discharge[cell])
            .collect();
        sorted.sort_unstable_by(f32::total_cmp);
        let quantile =
            |share: f64| sorted.get((share * sorted.len() as f64) as usize).copied().unwrap_or(0.0);
        let threshold = quantile(1.0 - CHANNEL_SHARE).max(ABOVE_MEDIAN * quantile(0.5));
        (threshold > 0.0).then_some(Self { size, vector, discharge, threshold })
    }

    fn is_channel(&self, cell: usize) -> bool {
        self.discharge[cell] >= self.threshold
    }

    /// The channel cell that this one flows into.
    fn downstream(&self, cell: usize) -> Option<usize> {
        let [along_x, along_y] = self.vector[cell];
        let column = |cell: usize| (cell % self.size.columns) as f32;
        let row = |cell: usize| (cell / self.size.columns) as f32;
        let ahead = |&other: &usize| {
            let (x, y) = (column(other) - column(cell), row(other) - row(cell));
            let cosine = (x * along_x + y * along_y) / ((x * x + y * y).sqrt() * self.discharge[cell]);
            cosine > NEAREST_THREE && self.is_channel(other)
        };
        let candidates = self.size.neighbours(cell).filter(ahead);
        candidates.max_by(|&a, &b| self.discharge[a].total_cmp(&self.discharge[b]))
    }

    fn point(&self, cell: usize, sheet: &Sheet) -> Point {
        let doublings = (libm::log2f(self.discharge[cell] / self.threshold)).max(0.0);
        Point {
            x: ((cell % self.size.columns) as f64 + 0.5) as f32 * sheet.across() as f32,
            y: ((cell / self.size.columns) as f64 + 0.5) as f32 * sheet.down() as f32,
            width: sheet.line() * (FINEST + GROWTH * doublings),
            opacity: (0.65 + 0.12 * doublings).min(1.0),
        }
    }
}

/// Cosine of 67.5°, half-way between the third and the fourth nearest of eight neighbours.
const NEAREST_THREE: f32 = 0.382_683_43;

/// Flow vectors at cell centres from fluxes through the eastern and southern faces.
pub(super) fn cell_flow(east: &Field, south: &Field) -> Vec<[f32; 2]> {
    let size = east.size();
    let flow = |cell: usize| {
        let west = if cell.is_multiple_of(size.columns) { 0.0 } else { east.values()[cell - 1] };
        let north = if cell < size.columns { 0.0 } else { south.values()[cell - size.columns] };
        [0.5 * (west + east.values()[cell]), 0.5 * (north + south.values()[cell])]
    };
    (0..size.cells()).map(flow).collect()
}

/// Channel cells linked downstream.
struct Forest {
    downstream: Vec<Option<usize>>,
    /// Cells on the longest way up, counting itself; 0 outside channels and in whirls.
    length: Vec<u32>,
    /// Where the longest way up comes from.
    upstream: Vec<Option<usize>>,
}

impl Forest {
    fn of(flow: &Flow) -> Self {
        let cells = flow.size.cells();
        let link = |cell: usize| if flow.is_channel(cell) { flow.downstream(cell) } else { None };
        let downstream: Vec<_> = (0..cells).map(link).collect();
        let mut waiting = vec![0_u32; cells];
        downstream.iter().flatten().for_each(|&next| waiting[next] += 1);
        let mut ready: Vec<usize> =
            (0..cells).filter(|&cell| flow.is_channel(cell) && waiting[cell] == 0).collect();
        let (mut length, mut upstream) = (vec![0; cells], vec![None; cells]);
        let mut done = 0;
        while let Some(&cell) = ready.get(done) {
            done += 1;
            length[cell] += 1;
            let Some(next) = downstream[cell] else { continue };
            if length[cell] > length[next] {
                (length[next], upstream[next]) = (length[cell], Some(cell));
            }
            waiting[next] -= 1;
            if waiting[next] == 0 {
                ready.push(next);
            }
        }
        Self { downstream, length, upstream }
    }

    /// Streams that are long enough, each from its mouth or confluence up to its head.
    fn streams(&self) -> impl Iterator<Item = Vec<usize>> {
        let ends = (0..self.length.len()).filter(|&cell| self.length[cell] >= SHORTEST && self.is_end(cell));
        ends.map(|end| {
            let up = std::iter::successors(Some(end), |&cell| self.upstream[cell]);
            self.downstream[end].into_iter().chain(up).collect()
        })
    }

    fn is_end(&self, cell: usize) -> bool {
        self.downstream[cell].is_none_or(|next| self.upstream[next] != Some(cell))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Water that gathers from both banks in column 32 and leaves to the south.
    fn valley() -> [Field; 2] {
        let size = Size::square(64).expect("legal");
        let east = Field::from_function(size, |x, _| if x < 32 { x as f32 } else { x as f32 - 63.0 } * 0.01);
        let south = Field::from_function(size, |x, y| if x == 32 { y as f32 } else { 0.0 });
        [east, south]
    }

    #[test]
    fn a_valley_with_one_river_is_one_stream_from_head_to_mouth() {
        let [east, south] = valley();
        let domain = Domain::new(east.size(), 1.0);
        let flow = Flow::new([&east, &south], &domain, None).expect("water flows");
        let streams: Vec<_> = Forest::of(&flow).streams().collect();
        assert_eq!(streams.len(), 1);
        assert!(streams[0].iter().all(|cell| cell % 64 == 32), "{:?}", streams[0]);
        assert!(streams[0].len() > 50);
    }

    #[test]
    fn a_river_three_cells_wide_is_one_stream_along_its_deepest_cells() {
        let size = Size::square(64).expect("legal");
        let still = Field::filled(size, 0.0);
        let south = Field::from_function(size, |x, y| match x {
            32 => 10.0 + y as f32,
            31 | 33 => 5.0 + 0.5 * y as f32,
            _ => 0.01,
        });
        let flow = Flow::new([&still, &south], &Domain::new(size, 1.0), None).expect("water flows");
        let streams: Vec<_> = Forest::of(&flow).streams().collect();
        assert_eq!(streams.len(), 1);
        assert!(streams[0].len() == 64 && streams[0][..60].iter().all(|cell| cell % 64 == 32));
    }

    #[test]
    fn still_water_has_no_rivers() {
        let size = Size::square(16).expect("legal");
        let still = Field::filled(size, 0.0);
        let domain = Domain::new(size, 1.0);
        let sheet = Sheet::new(&domain, None).expect("legal");
        assert!(draw([&still, &still], &domain, None, &sheet).is_none());
    }
}

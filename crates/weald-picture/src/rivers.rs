//! River lines from mean fluxes.
//!
//! A cell is channel where it carries the runoff of many cells. Channels form a forest of streams: the longest
//! way up from each mouth is a river, what joins it a tributary, and spurs of a few cells, which are banks of a
//! wide river, are left out. Lines widen with the logarithm of the area that is drained.

use super::drainage::{Drainage, flow_order, median};
use super::sheet::Sheet;
use super::strokes::{Point, Strokes};
use weald_core::domain::Domain;
use weald_core::grid::{Field, Size};

/// A channel drains at least this many cells, and this share of the grid: a picture bears only so many lines.
const MIN_AREA: f32 = 40.0;
const MIN_SHARE: f32 = 1.0 / 900.0;

/// And carries this many times the discharge of the median cell: a slope under a sheet of rain has no channel.
const ABOVE_MEDIAN: f32 = 2.5;

/// Shortest stream that is drawn, in cells.
const SHORTEST: u32 = 7;

/// Width of the finest stream in lines, and its growth with each doubling of the area.
const FINEST: f32 = 1.0;
const GROWTH: f32 = 0.45;

/// Draws the rivers of a landscape; `None` where nothing flows.
pub(super) fn draw(flux: [&Field; 2], domain: &Domain, sheet: &Sheet) -> Option<Strokes> {
    strokes(flux, domain, [sheet.width, sheet.height], |reach| Point {
        x: reach.x * sheet.across() as f32,
        y: reach.y * sheet.down() as f32,
        width: sheet.line() * (FINEST + GROWTH * reach.doublings),
        opacity: (0.65 + 0.12 * reach.doublings).min(1.0),
    })
}

/// A cell of a river.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Cells from the western and the northern edge to its middle.
    pub(super) x: f32,
    pub(super) y: f32,
    /// Cells that it drains.
    pub(super) area: f32,
    /// How often the area has doubled since the river began.
    pub(super) doublings: f32,
}

/// Draws the rivers on a canvas of so many pixels, each reach as `point` says; `None` where nothing flows.
pub(super) fn strokes(
    flux: [&Field; 2],
    domain: &Domain,
    [width, height]: [usize; 2],
    point: impl Fn(Reach) -> Point,
) -> Option<Strokes> {
    let channels = Channels::of(Drainage::of(flux, domain), domain.size)?;
    let mut strokes = Strokes::new(width, height);
    for stream in Forest::of(&channels).streams() {
        let points: Vec<_> = stream.iter().map(|&cell| point(channels.reach(cell))).collect();
        strokes.draw(&points);
    }
    Some(strokes)
}

/// The cells that are drawn as channels.
struct Channels {
    size: Size,
    drainage: Drainage,
    least_area: f32,
    least_discharge: f32,
}

impl Channels {
    fn of(drainage: Drainage, size: Size) -> Option<Self> {
        let least_discharge = ABOVE_MEDIAN * median(drainage.discharge.iter().copied());
        let least_area = MIN_AREA.max(MIN_SHARE * size.cells() as f32);
        (least_discharge > 0.0).then_some(Self { size, drainage, least_area, least_discharge })
    }

    fn contains(&self, cell: usize) -> bool {
        self.drainage.area[cell] >= self.least_area && self.drainage.discharge[cell] >= self.least_discharge
    }

    fn reach(&self, cell: usize) -> Reach {
        let area = self.drainage.area[cell];
        Reach {
            x: ((cell % self.size.columns) as f64 + 0.5) as f32,
            y: ((cell / self.size.columns) as f64 + 0.5) as f32,
            area,
            doublings: libm::log2f(area / self.least_area).max(0.0),
        }
    }
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
    fn of(channels: &Channels) -> Self {
        let cells = channels.size.cells();
        let link = |cell: usize| {
            channels.drainage.downstream[cell]
                .filter(|&next| channels.contains(cell) && channels.contains(next))
        };
        let downstream: Vec<_> = (0..cells).map(link).collect();
        let (mut length, mut upstream) = (vec![0; cells], vec![None; cells]);
        for cell in flow_order(&downstream).into_iter().filter(|&cell| channels.contains(cell)) {
            length[cell] += 1;
            let Some(next) = downstream[cell] else { continue };
            if length[cell] > length[next] {
                (length[next], upstream[next]) = (length[cell], Some(cell));
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

    fn streams(flux: [&Field; 2], domain: &Domain) -> Vec<Vec<usize>> {
        let channels = Channels::of(Drainage::of(flux, domain), domain.size).expect("water flows");
        Forest::of(&channels).streams().collect()
    }

    #[test]
    fn a_valley_with_one_river_is_one_stream_from_head_to_mouth() {
        let [east, south] = valley();
        let domain = Domain::new(east.size(), 1.0);
        let streams = streams([&east, &south], &domain);
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
        let streams = streams([&still, &south], &Domain::new(size, 1.0));
        assert_eq!(streams.len(), 1);
        assert!(streams[0].len() == 64 && streams[0][..60].iter().all(|cell| cell % 64 == 32));
    }

    #[test]
    fn still_water_has_no_rivers() {
        let size = Size::square(16).expect("legal");
        let still = Field::filled(size, 0.0);
        let domain = Domain::new(size, 1.0);
        let sheet = Sheet::new(&domain, None).expect("legal");
        assert!(draw([&still, &still], &domain, &sheet).is_none());
    }
}

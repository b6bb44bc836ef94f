//! How far a landscape has formed a network of rivers, in four numbers.
//!
//! Lengths, heights and depths are in cells. Common measures of digital elevation models, chosen so that they
//! tell connected river networks from scattered gullies; they depend on the grid, so only landscapes of the
//! same size compare.

use super::component::{components, geodesic_length};
use super::gaussian::{Grid, gaussian};
use super::priority_flood::priority_flood;
use crate::grid::{Field, Size};

/// Cells whose runoff makes a channel.
const CHANNEL_AREA: f64 = 100.0;

/// Standard deviation, in cells, of the mean that valleys lie below.
const SURROUNDINGS: f64 = 3.0;

/// Share of the cells, those that lie deepest below their surroundings, that count as valley.
const VALLEY_SHARE: f64 = 0.05;

/// A lake is deeper than this, in cells.
const LAKE_DEPTH: f64 = 0.5;

/// And has at least this many cells.
const LAKE_CELLS: usize = 64;

/// A pit deeper than this, in cells, cuts off the land above it.
const PIT_DEPTH: f64 = 0.5;

/// A landscape at the end of a dry period.
#[derive(Clone, Copy, Debug)]
pub struct NetworkInput<'a> {
    /// Height of the ground in metres.
    pub ground: &'a Field,
    /// Depth of water in metres.
    pub depth: &'a Field,
    /// Mean flux through the eastern face of each cell over whole rain cycles, in cell areas of cell height
    /// a step (the volume with cells of size 1).
    pub mean_flux_x: &'a Field,
    /// The same through the southern face.
    pub mean_flux_y: &'a Field,
    /// Mean rain over the same time, in cells a step.
    pub mean_rain: f64,
    /// Side of a cell in metres.
    pub cell: f64,
}

/// The measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NetworkMeasures {
    /// Share of cells whose mean flow carries the rain of at least 100 cells.
    pub chan: f64,
    /// Length of the longest connected valley over the longer side of the grid.
    pub reach: f64,
    /// Share of the valley cells that belong to the largest connected valley.
    pub valley_largest: f64,
    /// Share of the land outside lakes from which water reaches a lake or the border without crossing a pit
    /// deeper than half a cell.
    pub drains: f64,
    /// Inner cells without a lower neighbour among eight.
    pub pits: usize,
}

/// Measures a landscape.
///
/// # Panics
/// If the fields differ in size: a bug of the caller.
pub fn measure(input: &NetworkInput<'_>) -> NetworkMeasures {
    let size = input.ground.size();
    for field in [input.depth, input.mean_flux_x, input.mean_flux_y] {
        assert_eq!(field.size(), size, "all fields have the size of the ground");
    }
    let ground = in_cells(input.ground, input.cell);
    let depth = in_cells(input.depth, input.cell);
    let valley = valleys(size, &ground);
    NetworkMeasures {
        chan: channel_share(input),
        reach: valley.length as f64 / size.columns.max(size.rows) as f64,
        valley_largest: valley.share,
        drains: draining_share(size, &ground, &depth),
        pits: pits(size, &ground),
    }
}

fn in_cells(field: &Field, cell: f64) -> Vec<f64> {
    field.values().iter().map(|&value| f64::from(value) / cell).collect()
}

/// The flow vector of a cell is the half-sum of the fluxes through its two faces of each axis; none passes the
/// border.
fn channel_share(input: &NetworkInput<'_>) -> f64 {
    let size = input.ground.size();
    let (east, south) = (input.mean_flux_x, input.mean_flux_y);
    let carries = |x: usize, y: usize| {
        let west = if x > 0 { f64::from(east.at(x - 1, y)) } else { 0.0 };
        let north = if y > 0 { f64::from(south.at(x, y - 1)) } else { 0.0 };
        let flow_x = 0.5 * (west + f64::from(east.at(x, y)));
        let flow_y = 0.5 * (north + f64::from(south.at(x, y)));
        (flow_x * flow_x + flow_y * flow_y).sqrt() >= CHANNEL_AREA * input.mean_rain
    };
    let channels =
        (0..size.rows).flat_map(|y| (0..size.columns).map(move |x| (x, y))).filter(|&(x, y)| carries(x, y));
    channels.count() as f64 / size.cells() as f64
}

/// The largest connected valley.
struct Valley {
    length: usize,
    share: f64,
}

fn valleys(size: Size, ground: &[f64]) -> Valley {
    let mean = gaussian(&Grid { columns: size.columns, values: ground.to_vec() }, SURROUNDINGS);
    let below: Vec<f64> = mean.values.iter().zip(ground).map(|(mean, ground)| mean - ground).collect();
    let mut sorted = below.clone();
    let place = ((1.0 - VALLEY_SHARE) * sorted.len() as f64) as usize;
    let least = *sorted.select_nth_unstable_by(place, f64::total_cmp).1;
    let member: Vec<bool> = below.iter().map(|&below| below >= least && below > 0.0).collect();
    let components = components(size, &member);
    let Some(largest) = components.iter().max_by_key(|component| component.len()) else {
        return Valley { length: 0, share: 0.0 };
    };
    let cells: usize = components.iter().map(Vec::len).sum();
    Valley { length: geodesic_length(size, largest), share: largest.len() as f64 / cells as f64 }
}

fn draining_share(size: Size, ground: &[f64], depth: &[f64]) -> f64 {
    let lakes = lakes(size, depth);
    let surface: Vec<f64> =
        (0..size.cells()).map(|c| if lakes[c] { ground[c] + depth[c] } else { ground[c] }).collect();
    let outlets: Vec<bool> = (0..size.cells()).map(|cell| lakes[cell] || on_border(size, cell)).collect();
    let (order, flood) = priority_flood(size, &surface, &outlets);
    let mut passes = vec![true; size.cells()];
    for cell in order {
        let filled = flood[cell].level - surface[cell];
        passes[cell] = passes[flood[cell].next] && filled <= PIT_DEPTH;
    }
    let land = || (0..size.cells()).filter(|&cell| !lakes[cell]);
    land().filter(|&cell| passes[cell]).count() as f64 / land().count().max(1) as f64
}

fn lakes(size: Size, depth: &[f64]) -> Vec<bool> {
    let deep: Vec<bool> = depth.iter().map(|&depth| depth > LAKE_DEPTH).collect();
    let mut lakes = vec![false; size.cells()];
    for lake in components(size, &deep).into_iter().filter(|lake| lake.len() >= LAKE_CELLS) {
        for cell in lake {
            lakes[cell] = true;
        }
    }
    lakes
}

fn on_border(size: Size, cell: usize) -> bool {
    let (x, y) = (cell % size.columns, cell / size.columns);
    x == 0 || y == 0 || x + 1 == size.columns || y + 1 == size.rows
}

fn pits(size: Size, ground: &[f64]) -> usize {
    let inner = (0..size.cells()).filter(|&cell| !on_border(size, cell));
    inner.filter(|&cell| size.neighbours(cell).all(|other| ground[other] >= ground[cell])).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIDE: usize = 80;

    fn size() -> Size {
        Size::square(SIDE).expect("legal")
    }

    fn dry(ground: &Field, cell: f64) -> NetworkMeasures {
        let none = Field::filled(size(), 0.0);
        let (depth, mean_flux_x, mean_flux_y) = (&none, &none, &none);
        measure(&NetworkInput { ground, depth, mean_flux_x, mean_flux_y, mean_rain: 0.005, cell })
    }

    #[test]
    fn a_plane_drains_everywhere_and_has_no_pit() {
        let plane = Field::from_function(size(), |x, y| 3.0 * x as f32 + y as f32);
        let measures = dry(&plane, 1.0);
        assert_eq!((measures.drains, measures.pits, measures.chan), (1.0, 0, 0.0));
    }

    #[test]
    fn a_straight_valley_reaches_from_border_to_border() {
        let valley = Field::from_function(size(), |x, y| {
            y as f32 * 0.1 + if (38..42).contains(&x) { 0.0 } else { 20.0 }
        });
        let measures = dry(&valley, 1.0);
        assert_eq!(measures.reach, (SIDE - 1) as f64 / SIDE as f64);
        assert_eq!(measures.valley_largest, 1.0);
    }

    #[test]
    fn measures_do_not_depend_on_the_unit_of_length() {
        let rough = |scale: f32| {
            Field::from_function(size(), |x, y| {
                scale * (20.0 * crate::random::signed2(3, x as i64 / 3, y as i64 / 5) as f32)
            })
        };
        assert_eq!(dry(&rough(1.0), 1.0), dry(&rough(16.0), 16.0));
        assert!(dry(&rough(1.0), 1.0).drains < 0.9);
    }

    #[test]
    fn a_pit_cuts_off_its_own_cells_and_those_above_if_it_is_deep() {
        let tilted = |depth: f32| {
            Field::from_function(size(), |x, y| if (x, y) == (40, 40) { 40.0 - depth } else { x as f32 })
        };
        let (shallow, deep) = (dry(&tilted(1.4), 1.0), dry(&tilted(3.0), 1.0));
        assert_eq!((shallow.pits, deep.pits), (1, 1));
        assert_eq!(shallow.drains, 1.0);
        assert!(deep.drains < 1.0 && deep.drains > 0.9, "{}", deep.drains);
    }

    #[test]
    fn a_lake_is_an_outlet_for_the_land_around_it() {
        let bowl = Field::from_function(size(), |x, y| {
            let (x, y) = (x as f32 - 40.0, y as f32 - 40.0);
            (x * x + y * y).sqrt().min(30.0)
        });
        let water = Field::from_values(size(), bowl.values().iter().map(|h| (8.0 - h).max(0.0)).collect());
        let none = Field::filled(size(), 0.0);
        let with = |depth| {
            let flux = &none;
            measure(&NetworkInput {
                ground: &bowl,
                depth,
                mean_flux_x: flux,
                mean_flux_y: flux,
                mean_rain: 1.0,
                cell: 1.0,
            })
        };
        assert_eq!(with(&water).drains, 1.0);
        assert!(with(&none).drains < 0.6);
    }

    #[test]
    fn a_river_that_carries_the_rain_of_a_hundred_cells_is_channel() {
        let ground = Field::filled(size(), 0.0);
        let south = Field::from_function(size(), |x, y| if x == 40 { y as f32 * 2.0 * 0.005 } else { 0.0 });
        let none = Field::filled(size(), 0.0);
        let input = NetworkInput {
            ground: &ground,
            depth: &none,
            mean_flux_x: &none,
            mean_flux_y: &south,
            mean_rain: 0.005,
            cell: 1.0,
        };
        let channel = measure(&input).chan * (SIDE * SIDE) as f64;
        assert_eq!(channel.round(), 29.0, "half-sums 2y - 1 from row 51 to row 79");
    }
}

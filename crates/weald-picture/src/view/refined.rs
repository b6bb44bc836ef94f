//! The ground on finer cells than a landscape has: crags stand on what is steep, so that skylines break and ridges and
//! gullies throw shade. What is gentle, wet or beside water stays as smooth as its cells.
//!
//! Between cells, gentle ground is their cubic B-spline; steep ground is the cubic convolution of Keys 1981,
//! doi 10.1109/TASSP.1981.1163711, which keeps the heights of crests that the spline rounds off.

use rayon::prelude::*;

use super::crags;
use super::ground_kinds::Limits;
use super::ground_noise::{bed_spot, broad_values};
use super::rock::{BedSpot, stepped};
use super::surface::{FinerCells, Surface, middle};
use super::vector::ramp;
use crate::texture::smoothed;
use weald_core::grid::{Field, Size};

/// Usual longest side of the finer ground in cells, and most of them along the side of a cell.
const LONGEST: usize = 3072;
const FINEST: usize = 4;

/// Slope, as a share of that from which rock is bare, from which crags stand, and stand whole.
const STANDS: [f32; 2] = [0.75, 1.15];

/// Share of the crags of a cell that a crest beside it has.
const BESIDE: f32 = 0.85;

/// Height of a crest above its surroundings of some cells, in cells, from which it has crags, and has them whole.
const CREST: [f32; 2] = [-0.02, 0.1];

/// Side of a cell in metres up to which cells show all crags themselves, and from which they show none.
const SHOWN: [f32; 2] = [2.0, 6.0];

/// Height of crags beside that which they are drawn with; level beds stand as walls, which crags hardly flute.
const HIGH: f32 = 1.3;
const HIGH_OF_MATERIALS: f32 = 0.4;

/// Beds from one ledge to the next, and the share of its height that ground takes back on a ledge.
const LEDGES: f32 = 2.0;
const STEP: f32 = 0.4;

/// Steps along a wall with their weights, and cells in a step.
const WALL: [(f32, f32); 7] =
    [(-3.0, 0.0625), (-2.0, 0.125), (-1.0, 0.1875), (0.0, 0.25), (1.0, 0.1875), (2.0, 0.125), (3.0, 0.0625)];
const WALL_STEP: f32 = 1.2;

/// Finer cells that are as wide as the finest crag is blurred.
const BLUR: f32 = 1.2;

/// What is refined: heights as they are drawn.
pub(super) struct Coarse<'a> {
    pub(super) ground: &'a Field,
    /// Levels of lakes, below the ground where it is dry.
    pub(super) level: Option<&'a Field>,
    pub(super) spacing: [f32; 2],
    pub(super) limits: Limits,
    pub(super) exaggeration: f32,
    /// Whether its rock has the beds of materials, which lie level.
    pub(super) is_material: bool,
}

/// A finer cell of which a share is crags.
struct Steep {
    /// Its column.
    x: usize,
    /// Height without crags, as it is drawn.
    height: f32,
    /// Rise over run eastward and northward.
    rise: [f32; 2],
    share: f32,
    /// How much the spline rounds off there.
    crest: f32,
}

/// A field on finer cells, as smooth as it was.
pub(super) fn finer(field: &Field, fineness: usize) -> Field {
    let surface = Surface::new(field);
    let cells = FinerCells::of(&surface, fineness);
    by_rows(field.size(), fineness, |y, values| {
        let row = cells.row(&surface, y);
        for (x, value) in values.iter_mut().enumerate() {
            *value = cells.at(&row, x);
        }
    })
}

/// A field of finer cells than there are of a size, whose rows are filled one by one.
fn by_rows(size: Size, fineness: usize, fill: impl Fn(usize, &mut [f32]) + Sync) -> Field {
    let fine = Size { columns: size.columns * fineness, rows: size.rows * fineness };
    let mut values = vec![0.0; fine.cells()];
    values.par_chunks_mut(fine.columns).enumerate().for_each(|(y, row)| fill(y, row));
    Field::from_values(fine, values)
}

/// Most cells that are drawn for a landscape of so many.
pub(crate) fn most_cells(cells: u64) -> u64 {
    let fineness = fineness(cells.isqrt() as usize) as u64;
    cells * fineness * fineness
}

/// On how many cells along the side of one ground is drawn that has so many along its longer side.
fn fineness(longer: usize) -> usize {
    ((LONGEST + longer / 2) / longer.max(1)).clamp(1, FINEST)
}

impl Coarse<'_> {
    /// Share of crags by cell, and on how many cells along the side of one the ground is to be drawn; `None` where there are
    /// none, or where cells are fine as they are.
    pub(super) fn crags(&self) -> Option<(Field, usize)> {
        let size = self.ground.size();
        let fineness = fineness(size.columns.max(size.rows));
        let craggy = if fineness > 1 { self.craggy() } else { return None };
        craggy.values().iter().any(|&share| share > 0.0).then_some((craggy, fineness))
    }

    /// The ground on finer cells, with such shares of crags.
    pub(super) fn refined(&self, craggy: &Field, fineness: usize) -> Field {
        let (ground, craggy) = (Surface::new(self.ground), Surface::new(craggy));
        let broad = self.is_material.then(|| broad(self.ground));
        let cells = FinerCells::of(&ground, fineness);
        by_rows(self.ground.size(), fineness, |y, heights| {
            let (shares, row) = (cells.row(&craggy, y), cells.row(&ground, y));
            let mut steep = Vec::new();
            for (x, height) in heights.iter_mut().enumerate() {
                *height = cells.at(&row, x);
                let share = cells.at(&shares, x);
                if share > 0.0 {
                    let [_, east, south] = cells.with_slope(&row, x);
                    let [along, down] = [x, y].map(|cell| middle(cell, fineness));
                    let crest = match &broad {
                        Some(broad) => along_wall(&ground, broad, [along, down]),
                        None => ground.keys_at([along, down]),
                    } - *height;
                    steep.push(Steep { x, height: *height, rise: self.rise([east, south]), share, crest });
                }
            }
            let points = self.points(&steep, y, fineness);
            for (steep, stands) in steep.iter().zip(self.stand(&steep, &points, fineness)) {
                heights[steep.x] = steep.height + steep.share * (steep.crest + stands * self.exaggeration);
            }
        })
    }

    /// Rise over run eastward and northward of ground that rises so by the cell.
    fn rise(&self, [east, south]: [f32; 2]) -> [f32; 2] {
        [east / self.spacing[0] / self.exaggeration, -south / self.spacing[1] / self.exaggeration]
    }

    /// The points of finer cells of a row, in metres eastward, northward and up.
    fn points(&self, steep: &[Steep], y: usize, fineness: usize) -> Vec<[f32; 3]> {
        let north = (0.5 - middle(y, fineness)) * self.spacing[1];
        let point = |steep: &Steep| {
            let east = (middle(steep.x, fineness) - 0.5) * self.spacing[0];
            [east, north, steep.height / self.exaggeration]
        };
        steep.iter().map(point).collect()
    }

    /// How much higher ground stands for its crags and the ledges of its beds.
    fn stand(&self, steep: &[Steep], points: &[[f32; 3]], fineness: usize) -> Vec<f32> {
        let axes = || [0, 1, 2].map(|axis| points.iter().map(|point| point[axis]).collect::<Vec<f32>>());
        let cell = self.limits.cell;
        let [mut east, mut north, mut up] = axes();
        let crags = crags::heights([&mut east, &mut north, &mut up], cell, BLUR * cell / fineness as f32);
        // Walls of materials are a few cells wide, on which ledges would be flutes.
        let broad = (!self.is_material).then(|| {
            let [mut east, mut north, _] = axes();
            broad_values([&mut east, &mut north], cell)
        });
        let high = if self.is_material { HIGH_OF_MATERIALS } else { HIGH };
        let stands = |at: usize| {
            let [east, north] = steep[at].rise;
            // What stands out of a slope is higher by its steepness.
            let upward = (1.0 + east * east + north * north).sqrt();
            let ledges = broad.as_ref().map_or(0.0, |broad| self.ledges(points[at], broad[at], fineness));
            high * crags[at] * cell * upward.min(2.0) + ledges
        };
        (0..steep.len()).map(stands).collect()
    }

    /// How much higher ground stands for the ledges of its beds, where patches have such a value.
    fn ledges(&self, point: [f32; 3], broad: f32, fineness: usize) -> f32 {
        let spot = bed_spot(point, &self.limits, broad);
        let thickness = LEDGES * spot.thickness;
        let spot = BedSpot { thickness, fold: spot.fold / LEDGES, ..spot };
        let seen = ramp(thickness * fineness as f32 / self.limits.cell, 2.0, 5.0);
        STEP * seen * thickness * stepped(&spot)
    }

    /// Share of crags by cell: on what is steep and on crests beside it, not beside water.
    fn craggy(&self) -> Field {
        let size = self.ground.size();
        let unseen = ramp(self.limits.cell, SHOWN[0], SHOWN[1]);
        let mut steep = Field::filled(size, 0.0);
        steep.values_mut().par_chunks_mut(size.columns).enumerate().for_each(|(y, row)| {
            for (x, steep) in row.iter_mut().enumerate() {
                *steep = unseen * ramp(self.slope(x, y) / self.limits.rock, STANDS[0], STANDS[1]);
            }
        });
        let beside = spread(&spread(&steep));
        let mean = smoothed(&smoothed(self.ground, 1), 2);
        let share = |cell: usize| {
            let above =
                (self.ground.values()[cell] - mean.values()[cell]) / (self.limits.cell * self.exaggeration);
            steep.values()[cell].max(beside.values()[cell] * ramp(above, CREST[0], CREST[1]))
        };
        let shares = smoothed(&Field::from_values(size, (0..size.cells()).map(share).collect()), 1);
        let dry = |(cell, &share): (usize, &f32)| if self.is_wet(cell) { 0.0 } else { share };
        Field::from_values(size, shares.values().iter().enumerate().map(dry).collect())
    }

    /// Whether there is water at a cell or beside it.
    fn is_wet(&self, cell: usize) -> bool {
        let is_wet =
            |cell: usize| self.level.is_some_and(|level| level.values()[cell] > self.ground.values()[cell]);
        is_wet(cell) || self.ground.size().neighbours(cell).any(is_wet)
    }

    /// Rise over run, without exaggeration.
    fn slope(&self, x: usize, y: usize) -> f32 {
        let size = self.ground.size();
        let rise = |from: [usize; 2], to: [usize; 2], spacing: f32| {
            let run = (to[0] - from[0] + to[1] - from[1]).max(1) as f32 * spacing;
            (self.ground.at(to[0], to[1]) - self.ground.at(from[0], from[1])) / run
        };
        let east = rise([x.saturating_sub(1), y], [(x + 1).min(size.columns - 1), y], self.spacing[0]);
        let south = rise([x, y.saturating_sub(1)], [x, (y + 1).min(size.rows - 1)], self.spacing[1]);
        (east * east + south * south).sqrt() / self.exaggeration
    }
}

/// Ground without what is only some cells wide.
fn broad(ground: &Field) -> Surface {
    Surface::new(&smoothed(&smoothed(&smoothed(ground, 1), 2), 4))
}

/// The mean height along a wall at a place, in the direction in which broad ground is level: rivers that end in single cells leave
/// flutes in a wall, cell by cell.
fn along_wall(ground: &Surface, broad: &Surface, place: [f32; 2]) -> f32 {
    let [_, east, south] = broad.with_slope(place);
    let steep = (east * east + south * south).sqrt().max(1e-6);
    let step = [-south, east].map(|part| WALL_STEP * part / steep);
    let share =
        |(at, weight): (f32, f32)| weight * ground.keys_at([0, 1].map(|axis| place[axis] + at * step[axis]));
    WALL.map(share).into_iter().sum()
}

/// The greatest of each cell and most of those beside it.
fn spread(field: &Field) -> Field {
    let size = field.size();
    let value = |cell: usize| {
        let beside = size.neighbours(cell).map(|other| BESIDE * field.values()[other]);
        beside.fold(field.values()[cell], f32::max)
    };
    Field::from_values(size, (0..size.cells()).map(value).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits =
        Limits { rock: 0.7, trees: 500.0, woods: 0.5, snow: f32::INFINITY, relief: 400.0, cell: 20.0 };

    fn of<'a>(ground: &'a Field, level: Option<&'a Field>) -> Coarse<'a> {
        Coarse { ground, level, spacing: [20.0; 2], limits: LIMITS, exaggeration: 1.0, is_material: false }
    }

    /// A plain of 20 columns, then a slope of 45°.
    fn slope() -> Field {
        Field::from_function(Size::new(60, 40).expect("small"), |x, _| 20.0 * x.saturating_sub(20) as f32)
    }

    #[test]
    fn cells_of_two_metres_show_their_crags_themselves() {
        let ground = slope();
        let limits = Limits { cell: 2.0, ..LIMITS };
        assert!(Coarse { limits, ..of(&ground, None) }.crags().is_none());
    }

    #[test]
    fn gentle_ground_has_no_crags_and_fine_grids_stay_as_they_are() {
        let gentle =
            Field::from_function(Size::new(30, 30).expect("small"), |x, y| 4.0 * x as f32 + 2.0 * y as f32);
        assert!(of(&gentle, None).crags().is_none());
        let fine =
            Field::from_function(Size::new(2 * LONGEST / 3 + 1, 4).expect("small"), |x, _| 20.0 * x as f32);
        assert!(of(&fine, None).crags().is_none());
    }

    #[test]
    fn crags_stand_on_the_slope_and_not_on_the_plain() {
        let ground = slope();
        let (craggy, fineness) = of(&ground, None).crags().expect("it is steep");
        let [crags, smooth] = [of(&ground, None).refined(&craggy, fineness), finer(&ground, fineness)];
        let most = |columns: std::ops::Range<usize>| {
            let off = |x: usize, y: usize| (crags.at(x, y) - smooth.at(x, y)).abs();
            columns
                .flat_map(|x| (0..crags.size().rows).map(move |y| (x, y)))
                .map(|(x, y)| off(x, y))
                .fold(0.0, f32::max)
        };
        assert_eq!((fineness, crags.size().columns), (FINEST, 60 * FINEST));
        assert_eq!(most(0..13 * FINEST), 0.0);
        assert!(
            (6.0..60.0).contains(&most(30 * FINEST..60 * FINEST)),
            "{} m",
            most(30 * FINEST..60 * FINEST)
        );
    }

    #[test]
    fn there_are_none_under_water_nor_beside_it() {
        let ground = slope();
        let level = Field::filled(ground.size(), 400.0);
        let (craggy, _) = of(&ground, Some(&level)).crags().expect("it is steep above the water");
        assert!((0..41).all(|x| craggy.at(x, 20) == 0.0) && craggy.at(50, 20) > 0.9);
    }

    #[test]
    fn a_crest_between_steep_sides_has_crags_and_keeps_its_height() {
        let ridge =
            Field::from_function(Size::new(60, 40).expect("small"), |x, _| -20.0 * (x as f32 - 30.0).abs());
        let craggy = of(&ridge, None).craggy();
        assert!(craggy.at(30, 20) > 0.6, "{}", craggy.at(30, 20));
        let surface = Surface::new(&ridge);
        assert!(surface.at([31.0, 20.0]) < -1.0 && surface.keys_at([31.0, 20.0]).abs() < 1e-4);
    }

    #[test]
    fn walls_lose_their_flutes_and_keep_their_profile() {
        let size = Size::new(40, 40).expect("small");
        // A wall that falls eastward by 50 m a cell, with flutes of 20 m from row to row.
        let wall = |flutes: f32| {
            Field::from_function(size, |x, y| {
                let deep = flutes * if y % 2 == 0 { 1.0 } else { -1.0 };
                (400.0 - 50.0 * (x as f32 - 16.0)).clamp(0.0, 400.0)
                    + if (16..24).contains(&x) { deep } else { 0.0 }
            })
        };
        let along = |field: &Field, y: f32| along_wall(&Surface::new(field), &broad(field), [20.5, y]);
        let (fluted, plain) = (wall(20.0), wall(0.0));
        for y in [18.0, 19.0, 20.0, 21.0] {
            let expected = Surface::new(&plain).keys_at([20.5, y]);
            assert!((along(&plain, y) - expected).abs() < 1.0, "{} for {expected} m", along(&plain, y));
            assert!((along(&fluted, y) - expected).abs() < 5.0, "{} for {expected} m", along(&fluted, y));
        }
    }
}

//! Light of the sky on the ground, with what mountains hide of it.
//!
//! For each cell the horizon is sought in sixteen directions, in steps that grow with the distance over ground that
//! is averaged over wider squares as it is further away. The visible sky above the horizons is summed to the vector
//!
//! ```text
//! A = ∫ L(ω) V(ω) ω dω          E(n) = n · A
//! ```
//!
//! which gives the light on any normal `n` from which no visible direction is hidden by the ground itself, as is so on
//! the ground's own normal. Horizons: Nelson Max 1988, "Horizon mapping: shadows for bump-mapped surfaces",
//! doi 10.1007/BF01905562. What is hidden sends back light of the sunlit ground around (`Light::bounce`).

use rayon::prelude::*;

use super::sky::Sky;
use super::surface::Surface;
use super::vector::{Vector, add, dot, scale};
use weald_core::grid::{Field, Size};

/// Directions in which horizons are sought.
const DIRECTIONS: usize = 16;

/// Pieces of the table over the sine of the horizon's elevation.
const PIECES: usize = 64;

/// Distance of the first look in cells, and how much further each next one is.
const FIRST: f32 = 0.75;
const FURTHER: f32 = 1.22;

/// Light of the visible sky: `A` for red, green and blue, and for an even sky of radiance 1.
pub(super) type Seen = [Vector; 4];

/// Visible sky at the cells of a grid.
#[derive(Debug)]
pub(super) struct Skylight {
    pub(super) size: Size,
    pub(super) seen: Vec<Seen>,
}

/// Light of the sky above an elevation, by direction and elevation.
struct Sectors {
    above: Vec<[Seen; PIECES + 1]>,
}

impl Sectors {
    fn new(sky: &Sky) -> Self {
        Self { above: (0..DIRECTIONS).map(|sector| sector_above(sky, sector)).collect() }
    }

    /// The visible sky of a place whose horizons rise so steeply.
    fn seen(&self, steepness: &[f32; DIRECTIONS]) -> Seen {
        let mut seen = Seen::default();
        for (above, rise) in self.above.iter().zip(steepness) {
            let sine = rise / (1.0 + rise * rise).sqrt();
            let place = sine.clamp(0.0, 1.0) * PIECES as f32;
            let piece = (place as usize).min(PIECES - 1);
            let share = place - piece as f32;
            for channel in 0..4 {
                let low = scale(above[piece][channel], 1.0 - share);
                seen[channel] = add(seen[channel], add(low, scale(above[piece + 1][channel], share)));
            }
        }
        seen
    }
}

/// Clockwise from north.
fn direction_of(sector: usize) -> [f32; 2] {
    let turn = std::f32::consts::TAU * (sector as f32 + 0.5) / DIRECTIONS as f32;
    [libm::sinf(turn), libm::cosf(turn)]
}

fn sector_above(sky: &Sky, sector: usize) -> [Seen; PIECES + 1] {
    let mut above = [Seen::default(); PIECES + 1];
    let across = direction_of(sector);
    // The solid angle between two elevations is the difference of their sines times the width of the sector.
    let angle = std::f32::consts::TAU / DIRECTIONS as f32 / PIECES as f32;
    for piece in (0..PIECES).rev() {
        let up = (piece as f32 + 0.5) / PIECES as f32;
        let run = (1.0 - up * up).sqrt();
        let direction = [across[0] * run, across[1] * run, up];
        let light = sky.radiance(direction);
        above[piece] = above[piece + 1];
        for (channel, light) in [light[0], light[1], light[2], 1.0].into_iter().enumerate() {
            above[piece][channel] = add(above[piece][channel], scale(direction, light * angle));
        }
    }
    above
}

/// Heights averaged over squares of 1, 2, 4 … cells.
struct Averages {
    levels: Vec<Field>,
    highest: f32,
}

impl Averages {
    fn new(height: Field) -> Self {
        let highest = height.values().iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let mut levels = vec![height];
        while let Some(finer) = levels.last().filter(|field| field.size().columns.min(field.size().rows) > 3)
        {
            levels.push(halved(finer));
        }
        Self { levels, highest }
    }

    /// The height at a place in cells from the north-western corner; `None` beyond the border.
    fn at(&self, place: [f32; 2], level: usize) -> Option<f32> {
        let size = self.levels[0].size();
        if place[0] < 0.0 || place[1] < 0.0 || place[0] > size.columns as f32 || place[1] > size.rows as f32 {
            return None;
        }
        let level = level.min(self.levels.len() - 1);
        let side = (1_u32 << level) as f32;
        Some(between(&self.levels[level], [place[0] / side, place[1] / side]))
    }
}

fn halved(finer: &Field) -> Field {
    let from = finer.size();
    let size = Size { columns: from.columns.div_ceil(2), rows: from.rows.div_ceil(2) };
    Field::from_function(size, |x, y| {
        let (right, below) = ((2 * x + 1).min(from.columns - 1), (2 * y + 1).min(from.rows - 1));
        0.25 * (finer.at(2 * x, 2 * y)
            + finer.at(right, 2 * y)
            + finer.at(2 * x, below)
            + finer.at(right, below))
    })
}

/// The value between the four nearest cell centres; places count cells from the corner.
fn between(field: &Field, place: [f32; 2]) -> f32 {
    let size = field.size();
    let (left, right, across) = neighbours(place[0], size.columns);
    let (above, below, down) = neighbours(place[1], size.rows);
    let upper = field.at(left, above) * (1.0 - across) + field.at(right, above) * across;
    let lower = field.at(left, below) * (1.0 - across) + field.at(right, below) * across;
    upper * (1.0 - down) + lower * down
}

/// The two cells whose centres a place lies between, and its share of the way.
#[inline(always)]
fn neighbours(place: f32, count: usize) -> (usize, usize, f32) {
    let centred = (place - 0.5).clamp(0.0, (count - 1) as f32);
    let first = centred as usize;
    (first, (first + 1).min(count - 1), centred - first as f32)
}

impl Skylight {
    /// The light of `sky` on a surface of heights over cells of `spacing` metres, no finer than `finest` cells a
    /// side; places without land hide nothing.
    pub(super) fn new(sky: &Sky, top: &Surface, spacing: [f32; 2], finest: usize) -> Self {
        let whole = top.size();
        let step = whole.columns.max(whole.rows).div_ceil(finest).max(1);
        let size = Size { columns: whole.columns.div_ceil(step), rows: whole.rows.div_ceil(step) };
        let stretch = [whole.columns as f32 / size.columns as f32, whole.rows as f32 / size.rows as f32];
        let centre = |cell: usize, axis: usize| 0.5 + (cell as f32 + 0.5) * stretch[axis];
        let height = Field::from_function(size, |x, y| top.at([centre(x, 0), centre(y, 1)]));
        let spacing = [spacing[0] * stretch[0], spacing[1] * stretch[1]];
        let (averages, sectors) = (Averages::new(height), Sectors::new(sky));
        let cells = (0..size.cells()).into_par_iter();
        let seen = cells.map(|cell| {
            let (x, y) = (cell % size.columns, cell / size.columns);
            let [_, east, south] = top.with_slope([centre(x, 0), centre(y, 1)]);
            let rise = [east * stretch[0] / spacing[0], -south * stretch[1] / spacing[1]];
            sectors.seen(&horizons(&averages, [x, y], spacing, rise))
        });
        Self { size, seen: seen.collect() }
    }

    /// Visible sky at a place that is counted in shares of the whole landscape from its north-western corner.
    #[inline]
    pub(super) fn at(&self, share: [f32; 2]) -> Seen {
        let (left, right, across) = neighbours(share[0] * self.size.columns as f32, self.size.columns);
        let (above, below, down) = neighbours(share[1] * self.size.rows as f32, self.size.rows);
        let corners = [
            (self.size.index(left, above), (1.0 - across) * (1.0 - down)),
            (self.size.index(right, above), across * (1.0 - down)),
            (self.size.index(left, below), (1.0 - across) * down),
            (self.size.index(right, below), across * down),
        ];
        let mut seen = Seen::default();
        for (cell, weight) in corners {
            for (sum, part) in seen.iter_mut().zip(&self.seen[cell]) {
                *sum = add(*sum, scale(*part, weight));
            }
        }
        seen
    }
}

/// How steeply the ground rises to the horizon in each direction, at least with the slope of the place itself.
fn horizons(averages: &Averages, [x, y]: [usize; 2], spacing: [f32; 2], rise: [f32; 2]) -> [f32; DIRECTIONS] {
    let start = [x as f32 + 0.5, y as f32 + 0.5];
    let height = averages.levels[0].at(x, y);
    let cell = spacing[0].min(spacing[1]);
    std::array::from_fn(|sector| {
        let across = direction_of(sector);
        let mut steepest = (across[0] * rise[0] + across[1] * rise[1]).max(0.0);
        let mut cells = FIRST;
        loop {
            let ray_length = cells * cell;
            let place = [
                start[0] + across[0] * ray_length / spacing[0],
                start[1] - across[1] * ray_length / spacing[1],
            ];
            // Squares grow to a sixth of the distance.
            let level = (cells / 6.0).max(1.0).to_bits() >> 23;
            let Some(there) = averages.at(place, level as usize - 127) else { break };
            steepest = steepest.max((there - height) / ray_length);
            if averages.highest - height < steepest * ray_length {
                break;
            }
            cells *= FURTHER;
        }
        steepest
    })
}

/// What falls on a normal: light of the visible sky, and light that the hidden part of it sends back from sunlit
/// ground of radiance `ground`.
#[inline]
pub(super) fn on(seen: &Seen, normal: Vector, ground: Vector) -> Vector {
    let open = dot(normal, seen[3]).clamp(0.0, std::f32::consts::PI);
    let hidden = std::f32::consts::PI - open;
    std::array::from_fn(|c| dot(normal, seen[c]).max(0.0) + hidden * ground[c])
}

/// What is seen where nothing hides the sky.
pub(super) fn open(sky: &Sky) -> Seen {
    Sectors::new(sky).seen(&[0.0; DIRECTIONS])
}

#[cfg(test)]
mod tests {
    use super::super::vector::towards;
    use super::*;

    #[test]
    fn a_plain_sees_the_whole_sky_and_a_pit_little_of_it() {
        let sky = Sky::new(towards(200.0, 40.0), 0.53);
        let size = Size::square(33).expect("small");
        let open = open(&sky);
        assert!((open[3][2] - std::f32::consts::PI).abs() < 0.02, "{:?}", open[3]);
        let flat = Skylight::new(&sky, &Surface::new(&Field::filled(size, 5.0)), [10.0; 2], 512);
        let seen = flat.at([0.5; 2]);
        assert!(seen.iter().flatten().zip(open.iter().flatten()).all(|(a, b)| (a - b).abs() < 1e-3));
        let pit = Field::from_function(size, |x, y| {
            if (14..19).contains(&x) && (14..19).contains(&y) { -100.0 } else { 0.0 }
        });
        let pit = Skylight::new(&sky, &Surface::new(&pit), [10.0; 2], 512);
        assert!(pit.at([0.5; 2])[3][2] < 0.25 * open[3][2], "{:?}", pit.at([0.5; 2])[3]);
    }

    #[test]
    fn heights_lie_between_the_middles_of_cells_and_there_are_none_beyond_the_border() {
        assert_eq!(neighbours(2.75, 10), (2, 3, 0.25));
        assert_eq!((neighbours(0.1, 10), neighbours(9.9, 10)), ((0, 1, 0.0), (9, 9, 0.0)));
        let heights = Averages::new(Field::filled(Size::square(4).expect("small"), 7.0));
        assert_eq!([[0.0, 0.0], [4.0, 4.0]].map(|place| heights.at(place, 0)), [Some(7.0); 2]);
        for beyond in [[-0.1, 1.0], [1.0, -0.1], [4.1, 1.0], [1.0, 4.1]] {
            assert_eq!(heights.at(beyond, 0), None, "{beyond:?}");
        }
    }
}

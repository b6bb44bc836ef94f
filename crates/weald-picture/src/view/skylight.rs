//! Light of the sky on the ground, with what mountains hide of it.
//!
//! The visible sky above the horizons (`horizons.rs`) is summed to the vector
//!
//! ```text
//! A = ∫ L(ω) V(ω) ω dω          E(n) = n · A
//! ```
//!
//! which gives the light on any normal `n` from which no visible direction is hidden by the ground itself, as is so on
//! the ground's own normal. What is hidden sends back light of the sunlit ground around (`Light::bounce`).

use rayon::prelude::*;

use super::horizons::{DIRECTIONS, Horizons, direction_of, neighbours};
use super::sky::Sky;
use super::surface::Surface;
use super::vector::{Vector, add, dot, scale};
use weald_core::grid::{Field, Size};

/// Pieces of the table over the sine of the horizon's elevation.
const PIECES: usize = 64;

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
        let (horizons, sectors) = (Horizons::new(height, spacing), Sectors::new(sky));
        let mut seen = vec![Seen::default(); size.cells()];
        seen.par_chunks_mut(size.columns).enumerate().for_each(|(y, row)| {
            let rise = |x: usize| {
                let [_, east, south] = top.with_slope([centre(x, 0), centre(y, 1)]);
                [east * stretch[0] / spacing[0], -south * stretch[1] / spacing[1]]
            };
            let rises: Vec<[f32; 2]> = (0..size.columns).map(rise).collect();
            let steepest = horizons.row(y, &rises);
            for (x, seen) in row.iter_mut().enumerate() {
                *seen = sectors.seen(&std::array::from_fn(|sector| steepest[sector][x]));
            }
        });
        Self { size, seen }
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
}

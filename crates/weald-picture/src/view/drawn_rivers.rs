//! Rivers as pictures of the land draw them: a map of the share of water in each of its pixels, several a cell, and their banks.
//!
//! They are the lines of the relief picture, as wide as the usual bankfull width of a river of their basin,
//! `2.7 m · (area in km²)^0.4` (after Leopold and Maddock 1953, USGS PP 252), times a factor.

use super::vector::{Vector, ramp};
use crate::rivers;
use crate::strokes::{Point, Strokes};
use weald_core::grain::Octaves;
use weald_core::landscape::Landscape;

/// Pixels a cell of the map of rivers, and its longest side.
const RIVER_PIXELS: usize = 4;
const RIVER_SIDE: usize = 4096;

/// Pixels of the map than which no river is drawn thinner.
const THINNEST: f32 = 2.0;

/// Widths over that between which rivers come into sight.
const BROOKS: [f32; 2] = [0.2, 0.6];

/// Bankfull width in metres of a river that drains a square kilometre, and its growth with the area.
const BANKFULL: f32 = 2.7;
const BANKFULL_GROWTH: f32 = 0.4;

/// Metres of water in the middle of a river that is drawn as a line.
const RIVER_DEPTH: f32 = 1.2;

/// Least width of a river's edge in pixels of the map, and the share of water at which the bank lies then: a thread that is
/// thinner is none from close by.
const SHARPEST: f32 = 0.05;
const BANK: f32 = 0.3;

/// How ragged banks are: by how much the share of water differs, and the longest wavelength in pixels of the map.
const RAGGED: f32 = 0.35;
const RAGGED_LENGTH: f32 = 1.6;

/// Height above the water, in metres, to which ground rises beside a river, and how soon, as the inverse of the share of the map's
/// water at the bank over which it does: over a stream that is thinner than the map tells, woods close.
const BANK_HEIGHT: f32 = 3.0;
const BANK_RISE: f32 = 3.0;

/// Cells by which a river winds about its line.
const WINDING: f32 = 0.6;

/// The share of river in each spot of a landscape.
#[derive(Debug)]
pub(super) struct Rivers {
    pub(super) strokes: Strokes,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Rivers {
    /// Rivers of the mean fluxes of a landscape, `broader` times as wide as is usual; `None` without them.
    pub(super) fn of(landscape: &Landscape, broader: f64) -> Option<Self> {
        let domain = &landscape.domain;
        let flux = [landscape.field("flux_x").ok()?, landscape.field("flux_y").ok()?];
        let longer = domain.size.columns.max(domain.size.rows);
        let scale = (RIVER_SIDE as f32 / longer as f32).min(RIVER_PIXELS as f32);
        let pixels = |cells: usize| ((cells as f32 * scale) as usize).max(1);
        let (width, height) = (pixels(domain.size.columns), pixels(domain.size.rows));
        let canvas = rivers::Canvas { pixels: [width, height], least_area: None };
        let square_kilometres = domain.cell_area() as f32 * 1e-6;
        let strokes = rivers::strokes(flux, domain, canvas, |reach| {
            // Where springs feed it, a river may carry more than all of the land would: it is drawn as draining that.
            let area = reach.area.min(domain.size.cells() as f32) * square_kilometres;
            let metres = BANKFULL * libm::powf(area, BANKFULL_GROWTH) * broader as f32;
            // It grows from its head, as where water that has spread on a fan gathers again.
            let even = reach.share * metres / domain.cell as f32 * scale;
            let width = even * unevenly_wide(reach.place);
            let [x, y] = winding(reach.place).map(|along| along * scale);
            // A thinner line would come and go as it runs through pixels or between them. It grows downstream alone: by its narrows and
            // pools a brook would be seen in pieces.
            let [drawn, opacity] = [width.max(THINNEST), ramp(even / THINNEST, BROOKS[0], BROOKS[1])];
            Point { x, y, width: drawn, opacity }
        })?;
        Some(Self { strokes, width, height })
    }

    /// Share of river at a place that is counted in shares of the landscape.
    pub(super) fn at(&self, share: [f32; 2]) -> f32 {
        let x = (share[0] * self.width as f32 - 0.5).clamp(0.0, (self.width - 1) as f32);
        let y = (share[1] * self.height as f32 - 0.5).clamp(0.0, (self.height - 1) as f32);
        let (left, above) = (x as usize, y as usize);
        let (right, below) = ((left + 1).min(self.width - 1), (above + 1).min(self.height - 1));
        let (across, down) = (x - left as f32, y - above as f32);
        let row = |y: usize| {
            let row = self.strokes.row(y);
            row[left] * (1.0 - across) + row[right] * across
        };
        row(above) * (1.0 - down) + row(below) * down
    }
}

/// What a river that is drawn as a line is at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct RiverSpot {
    /// Share of water.
    pub(super) share: f32,
    /// Depth in metres.
    pub(super) depth: f32,
    /// Height of the ground above it in metres; infinite where there is no river.
    pub(super) above: f32,
}

/// The river at a point where the map, whose pixels are so many metres wide, says such a share, for a pixel of the picture of
/// that footprint: from close by a bank is an edge, ragged and no blur of the map's.
pub(super) fn with_banks(share: f32, point: Vector, [pixel, footprint]: [f32; 2]) -> RiverSpot {
    if share <= 0.0 {
        return RiverSpot { above: f32::INFINITY, ..RiverSpot::default() };
    }
    let ragged = Octaves { wavelength: RAGGED_LENGTH * pixel, count: 6, gain: 0.6, seed: 0x66 };
    let off = RAGGED * 4.0 * share * (1.0 - share) * ragged.at(point, footprint).value;
    let share = (share + off).clamp(0.0, 1.0);
    let softness = (footprint / pixel).clamp(SHARPEST, 1.0);
    let bank = BANK + (0.5 - BANK) * (softness - SHARPEST) / (1.0 - SHARPEST);
    let out = (BANK_RISE * (1.0 - share / bank)).clamp(0.0, 1.0);
    RiverSpot {
        share: ((share - bank) / softness + 0.5).clamp(0.0, 1.0),
        depth: RIVER_DEPTH * share,
        above: BANK_HEIGHT * out * out,
    }
}

/// Noise along rivers at a place in cells.
fn along_rivers([x, y]: [f32; 2], seed: u32) -> f32 {
    Octaves { wavelength: 5.0, count: 3, gain: 0.6, seed }.at([x, y, 0.0], 0.0).value
}

/// Width of a river there over that which is usual: it has narrows and pools.
fn unevenly_wide(place: [f32; 2]) -> f32 {
    (1.0 + 1.3 * along_rivers(place, 0x62)).clamp(0.5, 1.9)
}

/// Where a river runs whose line leads by a place, in cells: bends that are finer than cells. All rivers wind alike where
/// they meet, so that none ends beside another.
fn winding(place: [f32; 2]) -> [f32; 2] {
    [0, 1].map(|axis| place[axis] + WINDING * along_rivers(place, 0x63 + axis as u32))
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;
    use weald_core::grid::{Field, Size};

    /// A valley of such cells: water gathers from both banks in column 32 and leaves to the south.
    fn valley(cell: f64) -> Landscape {
        let size = Size::square(64).expect("small");
        let mut landscape = Landscape::new(Domain::new(size, cell));
        let east = |x: usize, _| if x < 32 { x as f32 } else { x as f32 - 63.0 } * 0.01;
        let south = |x: usize, y: usize| if x == 32 { y as f32 } else { 0.0 };
        landscape.insert("flux_x", "m³/step", Field::from_function(size, east));
        landscape.insert("flux_y", "m³/step", Field::from_function(size, south));
        landscape
    }

    #[test]
    fn a_river_lies_along_its_valley_and_nowhere_else() {
        let rivers = Rivers::of(&valley(10.0), 4.0).expect("a river");
        let across = |y: f32| (0..64).map(move |x| [(31.0 + x as f32 / 20.0) / 64.0, y / 64.0]);
        let along = |y: f32| across(y).map(|place| rivers.at(place)).fold(0.0, f32::max);
        assert!(along(40.0) > 0.9 && along(60.0) > 0.9, "{} and {}", along(40.0), along(60.0));
        let width = |y: f32| across(y).map(|place| rivers.at(place)).sum::<f32>();
        let widths: Vec<f32> = (30..60).map(|y| width(y as f32)).collect();
        let [least, most] =
            widths.iter().fold([f32::MAX, 0.0], |[a, b], &width| [a.min(width), b.max(width)]);
        assert!(most > 1.3 * least, "narrows and pools: {widths:?}");
        assert_eq!([8.0, 24.0, 40.0, 56.0].map(|x| rivers.at([x / 64.0, 40.0 / 64.0])), [0.0; 4]);
    }

    #[test]
    fn a_river_begins_as_a_thread() {
        let landscape = valley(100.0);
        let rivers = Rivers::of(&landscape, 40.0).expect("a river");
        let width = |y: f32| (0..256).map(|x| rivers.at([x as f32 / 256.0, y / 64.0])).sum::<f32>();
        let widths: Vec<f32> = (0..256).map(|y| width(0.25 * y as f32)).collect();
        let head = widths.iter().position(|&width| width > 0.0).expect("a river");
        // Over the twelve cells in which it grows, of which its source has two thirds of the area.
        let grown = widths[head + 48];
        assert!(grown > 10.0 && widths[head + 4] < 0.35 * grown, "{:?}", &widths[head..head + 60]);
    }

    #[test]
    fn banks_are_ragged_edges_from_close_by_and_what_the_map_says_from_afar() {
        let shares: Vec<f32> = (0_u8..=100).map(|at| f32::from(at) / 100.0).collect();
        let at =
            |share: f32, pixels: f32| with_banks(share, [300.0 * share, 70.0, 0.0], [10.0, 10.0 * pixels]);
        assert!(shares.iter().all(|&share| (at(share, 1.5).share - share).abs() < 1e-6));
        let soft = |pixels: f32| {
            let between = shares.iter().filter(|&&share| (0.01..0.99).contains(&at(share, pixels).share));
            between.count()
        };
        assert!(soft(0.01) < 12 && soft(0.5) > 40, "{} and {}", soft(0.01), soft(0.5));
        let [none, whole] = [0.0, 1.0].map(|share| at(share, 0.01));
        assert_eq!((none.share, whole), (0.0, RiverSpot { share: 1.0, depth: RIVER_DEPTH, above: 0.0 }));
        let edge = |along: u8| with_banks(BANK, [f32::from(along), 40.0, 0.0], [10.0, 0.1]).share > 0.5;
        let wet = (0..200).filter(|&along| edge(along)).count();
        assert!((40..160).contains(&wet), "{wet} of 200 metres of a bank are wet");
    }

    #[test]
    fn a_river_thinner_than_the_maps_pixels_does_not_come_and_go() {
        // Less than a pixel wide, as it winds through pixels and between them.
        let rivers = Rivers::of(&valley(100.0), 1.8).expect("a river");
        let there = |y: f32| {
            let across = (0..120).map(|x| rivers.at([(29.5 + x as f32 / 20.0) / 64.0, y / 64.0]));
            across.fold(0.0, f32::max)
        };
        let shares: Vec<f32> = (0..400).map(|y| there(40.0 + 0.05 * y as f32)).collect();
        assert!(shares.iter().all(|&share| (0.05..0.9).contains(&share)), "{shares:?}");
        // Over a third of a cell and over a whole one it does not become fainter and stronger again.
        let dips = [8, 24].map(|length| {
            let falls = |along: &&[f32]| {
                let least = along.iter().copied().fold(1.0, f32::min);
                along[0].min(along[length - 1]) > 1.3 * least
            };
            shares.windows(length).filter(falls).count()
        });
        assert_eq!(dips, [0; 2], "{shares:?}");
        // Nor does it by narrows and pools, which are some cells long.
        let [least, most] =
            shares.iter().fold([f32::MAX, 0.0_f32], |[a, b], &share| [a.min(share), b.max(share)]);
        assert!(most < 2.0 * least, "{least} to {most}");
    }
}

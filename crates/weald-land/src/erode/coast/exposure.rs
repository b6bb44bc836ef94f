//! How open a coast lies to waves: fetch, the way that wind has over water, in all directions by how often wind blows
//! from there and how squarely its waves meet the coast.

use rayon::prelude::*;

use weald_core::grid::Size;

/// Directions in which fetch is measured.
const DIRECTIONS: u32 = 36;

/// Metres around in which it is seen where a coast faces, and cells at least and at most.
const REACH: f64 = 200.0;
const REACH_IN_CELLS: [f64; 2] = [4.0, 32.0];

/// Metres along the coast over which exposure is evened out, as a standard deviation: waves bend round corners.
const EVENED: f64 = 200.0;

/// Passes of means of three cells of a coast that do so, at least and at most; each adds two thirds of a cell².
const PASSES: [f64; 2] = [4.0, 1000.0];

/// Wind over the sea.
pub(super) struct Wind<'a> {
    pub(super) size: Size,
    /// Side of a cell in metres.
    pub(super) cell: f64,
    /// Cells of the sea.
    pub(super) sea: &'a [bool],
    /// Direction from which it mostly blows, clockwise from north, and how far it varies.
    pub(super) from_deg: f64,
    pub(super) spread_deg: f64,
    /// Fetch beyond which waves grow no more, in metres: that of water beyond the border.
    pub(super) fetch: f64,
}

impl Wind<'_> {
    /// Exposure of each cell of `coast`, in their order: 1 where it faces the wind over the full fetch, 0 where no waves come.
    pub(super) fn exposure(&self, coast: &[u32]) -> Vec<f64> {
        let mut exposure = vec![0.0; self.size.cells()];
        let found: Vec<f64> = coast.par_iter().map(|&cell| self.at(cell as usize)).collect();
        coast.iter().zip(found).for_each(|(&cell, found)| exposure[cell as usize] = found);
        let mut is_coast = vec![false; exposure.len()];
        for &cell in coast {
            is_coast[cell as usize] = true;
        }
        let passes = (1.5 * (EVENED / self.cell) * (EVENED / self.cell)).clamp(PASSES[0], PASSES[1]);
        for _ in 0..passes as usize {
            let even = |&cell: &u32| {
                let around = self.size.neighbours(cell as usize).chain([cell as usize]);
                let (sum, count) = around
                    .filter(|&beside| is_coast[beside])
                    .fold((0.0, 0.0), |(sum, count), beside| (sum + exposure[beside], count + 1.0));
                sum / count
            };
            let evened: Vec<f64> = coast.iter().map(even).collect();
            coast.iter().zip(evened).for_each(|(&cell, evened)| exposure[cell as usize] = evened);
        }
        coast.iter().map(|&cell| exposure[cell as usize]).collect()
    }

    fn at(&self, cell: usize) -> f64 {
        let [east, north] = self.facing(cell);
        let (mut sum, mut most) = (0.0, 0.0);
        for direction in 0..DIRECTIONS {
            let off = 360.0 * f64::from(direction) / f64::from(DIRECTIONS) - 180.0;
            let azimuth = self.from_deg + off;
            let weight = libm::exp(-0.5 * (off / self.spread_deg) * (off / self.spread_deg));
            let (sin, cos) = (libm::sin(azimuth.to_radians()), libm::cos(azimuth.to_radians()));
            let squarely = (east * sin + north * cos).max(0.0);
            if squarely > 0.0 {
                sum += weight * squarely * (self.fetch_from(cell, azimuth) / self.fetch).min(1.0);
            }
            most += weight * libm::cos(off.to_radians()).max(0.0);
        }
        (sum / most).min(1.0)
    }

    /// Where the sea lies off a cell of the coast: a unit vector east and north, or 0 where it lies all around alike.
    fn facing(&self, cell: usize) -> [f64; 2] {
        let Size { columns, rows } = self.size;
        let (x, y) = (cell % columns, cell / columns);
        let (mut east, mut north) = (0.0, 0.0);
        let reach = (REACH / self.cell).clamp(REACH_IN_CELLS[0], REACH_IN_CELLS[1]) as isize;
        for (right, down) in
            (-reach..=reach).flat_map(|down| (-reach..=reach).map(move |right| (right, down)))
        {
            let place = x.checked_add_signed(right).zip(y.checked_add_signed(down));
            // Beyond the border lies the sea.
            let is_sea =
                place.is_none_or(|(x, y)| x >= columns || y >= rows || self.sea[self.size.index(x, y)]);
            if is_sea && right * right + down * down <= reach * reach {
                (east, north) = (east + right as f64, north - down as f64);
            }
        }
        let length = libm::sqrt(east * east + north * north);
        if length > 0.0 { [east / length, north / length] } else { [0.0; 2] }
    }

    /// Metres of water from a cell in a direction.
    fn fetch_from(&self, cell: usize, azimuth_deg: f64) -> f64 {
        let (x, y) = ((cell % self.size.columns) as f64, (cell / self.size.columns) as f64);
        let (east, south) = (libm::sin(azimuth_deg.to_radians()), -libm::cos(azimuth_deg.to_radians()));
        let most = self.fetch / self.cell;
        let mut gone = 0.0;
        while gone < most {
            gone += 1.0;
            let (x, y) = ((x + gone * east).round(), (y + gone * south).round());
            let outside = x < 0.0 || y < 0.0 || x >= self.size.columns as f64 || y >= self.size.rows as f64;
            if outside {
                return self.fetch;
            }
            if !self.sea[self.size.index(x as usize, y as usize)] {
                break;
            }
        }
        gone * self.cell
    }
}

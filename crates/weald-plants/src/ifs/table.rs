//! A fractal in the numbers of random iteration: single precision, and probabilities as bounds of a 16-bit draw.

use super::system::Ifs;

/// Maps and bounds, of the same bits for every machine that plays.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Three rows of four numbers for each map: a row of `A`, and its part of `t`.
    pub maps: Vec<[[f32; 4]; 3]>,
    /// Map `m` is taken by draws from `bounds[m]` to below `bounds[m + 1]`; the first is 0, the last 65536.
    pub bounds: Vec<u32>,
    /// Whether the third coordinate is 0 for all points.
    pub planar: bool,
}

/// Values that a draw can have.
const DRAWS: u32 = 1 << 16;

impl Table {
    /// The table of a fractal.
    pub fn of(ifs: &Ifs) -> Self {
        let row = |linear: [f64; 3], offset: f64| [linear[0], linear[1], linear[2], offset].map(|x| x as f32);
        let maps = ifs.maps().iter().map(|weighted| {
            let map = weighted.map;
            std::array::from_fn(|i| row(map.linear[i], map.offset[i]))
        });
        Self { maps: maps.collect(), bounds: bounds(ifs), planar: ifs.is_planar() }
    }

    /// How many of the 65536 draws take each map.
    pub fn shares(&self) -> Vec<u32> {
        self.bounds.windows(2).map(|pair| pair[1] - pair[0]).collect()
    }
}

/// Sums of probabilities rounded to draws, each map with one draw at least.
fn bounds(ifs: &Ifs) -> Vec<u32> {
    let count = ifs.maps().len() as u32;
    let mut bounds = vec![0_u32];
    let mut sum = 0.0;
    for (map, weighted) in ifs.maps().iter().enumerate() {
        sum += weighted.probability;
        let after = count - 1 - map as u32;
        let nearest = (sum * f64::from(DRAWS)).round() as u32;
        bounds.push(nearest.clamp(bounds[map] + 1, DRAWS - after));
    }
    bounds[count as usize] = DRAWS;
    bounds
}

//! How many points fall into each cell of a picture: counts that are quick to raise.
//!
//! Raising a count is a read and a write at a random place, so what matters is that the counts fit into a cache. They have
//! eight bits; each time one runs over, 256 is added to a second count of 32 bits, which is rare. A picture of 1024² then
//! works in 1 MiB instead of 4.

use super::game::{BLOCK_STEPS, Block};
use super::lanes::{LANES, Row};
use weald_core::vectors::widest;

/// A rectangle of the plane cut into cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Least x and y of the rectangle.
    pub low: [f32; 2],
    /// Cells for one unit of length.
    pub scale: [f32; 2],
    /// Columns and rows, below 2²² each.
    pub size: [u32; 2],
}

/// Counts of points in a window, row by row, the lowest first.
#[derive(Clone, Debug)]
pub struct Histogram {
    window: Window,
    low: Vec<u8>,
    high: Vec<u32>,
}

impl Histogram {
    /// No points yet.
    pub fn new(window: Window) -> Self {
        // One more cell takes what falls outside, so that no point needs a branch.
        let cells = window.size[0] as usize * window.size[1] as usize + 1;
        Self { window, low: vec![0; cells], high: vec![0; cells] }
    }

    /// Counts the points of a block.
    pub fn count(&mut self, block: &Block) {
        let mut cells = [[0_u32; LANES]; BLOCK_STEPS];
        let rows = block.rows();
        cells_of(&self.window, rows, &mut cells[..rows.len()]);
        for &cell in &cells.as_flattened()[..block.len()] {
            let count = &mut self.low[cell as usize];
            *count = count.wrapping_add(1);
            if *count == 0 {
                self.high[cell as usize] += 256;
            }
        }
    }

    /// Adds the counts of another histogram of the same window.
    pub fn add(&mut self, other: &Self) {
        for (cell, (low, high)) in other.low.iter().zip(&other.high).enumerate() {
            let sum = u32::from(self.low[cell]) + u32::from(*low);
            self.low[cell] = sum as u8;
            self.high[cell] += high + (sum & 256);
        }
    }

    /// The count of each cell.
    pub fn counts(&self) -> impl Iterator<Item = u32> + '_ {
        let inside = self.low.len() - 1;
        self.low[..inside].iter().zip(&self.high).map(|(&low, &high)| high + u32::from(low))
    }

    /// Points that fell outside of the window.
    pub fn outside(&self) -> u32 {
        let last = self.low.len() - 1;
        self.high[last] + u32::from(self.low[last])
    }
}

/// The cells of rows of points; what lies outside gets the one beyond the last.
fn cells_of(window: &Window, points: &[[Row; 3]], cells: &mut [[u32; LANES]]) {
    let Window { low, scale, size: [columns, rows] } = *window;
    let (width, height) = (columns as f32, rows as f32);
    let beyond = columns * rows;
    widest(
        #[inline(always)]
        || {
            let (low, scale, columns, width, height, beyond) = (low, scale, columns, width, height, beyond);
            for ([x, y, _], cells) in points.iter().zip(cells.iter_mut()) {
                // Copies, which nothing that is written can be: so whole vectors are read and written.
                let (x, y, mut found) = (*x, *y, [0; LANES]);
                for lane in 0..LANES {
                    let column = (x[lane] - low[0]) * scale[0];
                    let row = (y[lane] - low[1]) * scale[1];
                    let inside = column >= 0.0 && row >= 0.0 && column < width && row < height;
                    let cell = floor(row).wrapping_mul(columns).wrapping_add(floor(column));
                    found[lane] = if inside { cell } else { beyond };
                }
                *cells = found;
            }
        },
    );
}

/// The whole number below a number from 0 to below 2²²; anything for others. A cast saturates, which vectors cannot do:
/// adding 2²³ rounds to the nearest whole number and leaves it in the low bits.
#[inline(always)]
fn floor(number: f32) -> u32 {
    const SHIFT: f32 = 8_388_608.0;
    let nearest = number + SHIFT;
    let above = nearest - SHIFT > number;
    (nearest.to_bits() & 0x007f_ffff).wrapping_sub(u32::from(above))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ifs::game::Game;
    use crate::ifs::shapes;

    #[test]
    fn counts_are_those_of_one_by_one_also_where_they_run_over() {
        let ifs = shapes::find("gasket").expect("built in").ifs();
        let window = Window { low: [0.0, 0.25], scale: [8.0, 8.0], size: [8, 6] };
        let points = 300_000;
        let (mut whole, mut half) = (Histogram::new(window), Histogram::new(window));
        let mut expected = [0_u32; 49];
        Game::new(&ifs, 1).points(points, |block| {
            let into = if block.first % 8192 == 0 { &mut whole } else { &mut half };
            into.count(block);
            for i in 0..block.len() {
                let [x, y, _] = block.point(i);
                let (column, row) = ((x * 8.0).floor(), ((y - 0.25) * 8.0).floor());
                let inside = (0.0..8.0).contains(&column) && (0.0..6.0).contains(&row);
                expected[if inside { (row * 8.0 + column) as usize } else { 48 }] += 1;
            }
        });
        whole.add(&half);
        assert_eq!(whole.counts().collect::<Vec<_>>(), expected[..48]);
        assert_eq!(whole.outside(), expected[48]);
        assert!(expected.iter().any(|&count| count > 5_000) && expected[48] > 1000);
    }
}

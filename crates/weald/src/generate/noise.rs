//! Gradient noise on a square lattice, row by row.
//!
//! Each lattice point holds a gradient `g` from a hash of (seed, octave, point). Between four points the noise is
//! the quintic blend of the four planes through them:
//!
//! ```text
//! n(p) = Σ w(dx) w(dy) g · (p - corner)        w = 1 - f, f(t) = t³ (6 t² - 15 t + 10)
//! ```
//!
//! Perlin 1985, doi 10.1145/325165.325247, and 2002, doi 10.1145/566654.566636.
//!
//! What differs: the direction of a gradient is a whole 32-bit hash, not one of a few, so no direction is
//! preferred; it comes from the parabola `4 t (1 - |t|)` in place of sine and cosine (lengths 1 to 1.061), so that
//! additions and multiplications alone give the bits. Every lattice is moved by a random part of its step, since
//! the noise is 0 at lattice points and octaves would be so at the same places.
//!
//! Noise is within [-1, 1]: at the middle of a square the four planes add up to at most 3/4 for these gradients,
//! nowhere to more, and gradients are scaled by 4/3. Its variance is [`VARIANCE`].
//!
//! A row of cells has one lattice row and one `dy`. There the two gradients of a lattice column come down to one
//! line `slope * dx + rise`, and a cell is the blend of two lines. Wide lattice squares take the lines from a
//! table; narrow ones compute them for every cell, in full-width vectors. Both do the same operations on the same
//! numbers, and so does a shader that is given the tables of [`Axis`].

use super::hash::{Plane, RowKey};
use crate::random::{splitmix64, unit};

/// Mean of the noise squared over all places and hashes: `8 E[g_x²] ∫w² ∫w²x²` over the unit interval, with
/// `E[g_x²] = (4/3)² 8/15`.
pub const VARIANCE: f64 = 0.088_237;

/// Cells a lattice square must span, on average, for a table of lines to pay.
const WIDE: usize = 24;

/// A window of the endless grid of cells: noise does not know where a landscape ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Column and row of its first cell.
    pub first: [i64; 2],
    /// Columns and rows.
    pub count: [usize; 2],
    /// Side of a cell in metres.
    pub cell: f64,
}

/// Cells along one axis as the lattice of one octave sees them.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Lattice point before each cell.
    lattice: Vec<i32>,
    /// Way from that point to the next, 0 to 1.
    fraction: Vec<f32>,
    /// `f(fraction)`.
    fade: Vec<f32>,
    /// Numbers of neighbouring cells after the same lattice point.
    spans: Vec<usize>,
}

impl Axis {
    /// Cell `k` lies at `(first + k + 1/2) * step + shift` lattice steps. Lattice points are counted in 32 bits
    /// and repeat after 2^32.
    fn new(first: i64, count: usize, step: f64, shift: f64) -> Self {
        let places = (0..count).map(|k| ((first + k as i64) as f64 + 0.5) * step + shift);
        let lattice: Vec<i32> = places.clone().map(|place| libm::floor(place) as i64 as i32).collect();
        let fraction: Vec<f32> = places.map(|place| (place - libm::floor(place)) as f32).collect();
        let fade = fraction.iter().map(|&t| fade(t)).collect();
        let spans = lattice.chunk_by(|a, b| a == b).map(<[i32]>::len).collect();
        Self { lattice, fraction, fade, spans }
    }
}

/// Noise of one wavelength over a window.
#[derive(Clone, Debug)]
pub struct Octave {
    plane: Plane,
    columns: Axis,
    rows: Axis,
    /// Lattice steps a metre.
    frequency: f64,
}

/// Memory that rows share.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    lines: Vec<Line>,
}

/// What a lattice column contributes along one row: `slope * dx + rise`.
#[derive(Clone, Copy, Debug)]
struct Line {
    slope: f32,
    rise: f32,
}

impl Octave {
    /// Octave `index` of a seed: lattice steps of `wavelength` metres.
    pub fn new(window: &Window, wavelength: f64, seed: u64, index: u64) -> Self {
        let step = window.cell / wavelength;
        let shift = |axis: u64| unit(splitmix64(splitmix64(seed ^ index.rotate_left(32)) ^ axis));
        let axis = |k: usize| Axis::new(window.first[k], window.count[k], step, shift(k as u64));
        Self { plane: Plane::new(seed, index), columns: axis(0), rows: axis(1), frequency: 1.0 / wavelength }
    }

    /// Adds `amplitude` times the noise of row `y` to `out`.
    #[inline(always)]
    pub fn add_row(&self, y: usize, amplitude: f32, out: &mut [f32], scratch: &mut Scratch) {
        let row = self.row(y);
        let squares = self.columns.spans.len();
        if squares * WIDE > out.len() {
            return self.add_narrow(&row, amplitude, out);
        }
        let first = self.columns.lattice[0];
        scratch.lines.clear();
        scratch.lines.extend((0..=squares).map(|k| row.line(first.wrapping_add(k as i32))));
        self.add_wide(&scratch.lines, amplitude, out);
    }

    /// As [`Octave::add_row`], with every cell looked up `dx`, `dy` metres away from its place.
    #[inline(always)]
    pub fn add_displaced_row(&self, y: usize, amplitude: f32, [dx, dy]: [&[f32]; 2], out: &mut [f32]) {
        let Axis { lattice, fraction, .. } = &self.columns;
        let (row, along) = (self.rows.lattice[y], self.rows.fraction[y]);
        let frequency = self.frequency as f32;
        let count = out.len();
        let (lattice, fraction, dx, dy) = (&lattice[..count], &fraction[..count], &dx[..count], &dy[..count]);
        for x in 0..count {
            let (column, to_x) = moved(lattice[x], fraction[x] + dx[x] * frequency);
            let (row, to_y) = moved(row, along + dy[x] * frequency);
            let row = self.lattice_row(row, to_y, fade(to_y));
            out[x] += amplitude * blend(row.line(column), row.line(column.wrapping_add(1)), to_x, fade(to_x));
        }
    }

    #[inline(always)]
    fn row(&self, y: usize) -> LatticeRow {
        self.lattice_row(self.rows.lattice[y], self.rows.fraction[y], self.rows.fade[y])
    }

    #[inline(always)]
    fn lattice_row(&self, row: i32, fraction: f32, fade: f32) -> LatticeRow {
        LatticeRow { north: self.plane.row(row), south: self.plane.row(row.wrapping_add(1)), fraction, fade }
    }

    #[inline(always)]
    fn add_narrow(&self, row: &LatticeRow, amplitude: f32, out: &mut [f32]) {
        let count = out.len();
        let Axis { lattice, fraction, fade, .. } = &self.columns;
        let (lattice, fraction, fade) = (&lattice[..count], &fraction[..count], &fade[..count]);
        for x in 0..count {
            let [west, east] = [row.line(lattice[x]), row.line(lattice[x].wrapping_add(1))];
            out[x] += amplitude * blend(west, east, fraction[x], fade[x]);
        }
    }

    #[inline(always)]
    fn add_wide(&self, lines: &[Line], amplitude: f32, out: &mut [f32]) {
        let Axis { fraction, fade, spans, .. } = &self.columns;
        let (mut out, mut fraction, mut fade) = (out, &fraction[..], &fade[..]);
        for (&count, pair) in spans.iter().zip(lines.windows(2)) {
            let (cells, rest) = out.split_at_mut(count);
            for ((cell, &to_x), &fade) in cells.iter_mut().zip(&fraction[..count]).zip(&fade[..count]) {
                *cell += amplitude * blend(pair[0], pair[1], to_x, fade);
            }
            (out, fraction, fade) = (rest, &fraction[count..], &fade[count..]);
        }
    }
}

/// A row of cells between two rows of lattice points.
struct LatticeRow {
    north: RowKey,
    south: RowKey,
    fraction: f32,
    fade: f32,
}

impl LatticeRow {
    #[inline(always)]
    fn line(&self, column: i32) -> Line {
        let [north, south] = [gradient(self.north.bits(column)), gradient(self.south.bits(column))];
        let (above, below) = (north[1] * self.fraction, south[1] * (self.fraction - 1.0));
        Line { slope: mix(north[0], south[0], self.fade), rise: mix(above, below, self.fade) }
    }
}

#[inline(always)]
fn blend(west: Line, east: Line, to_x: f32, fade: f32) -> f32 {
    mix(west.slope * to_x + west.rise, east.slope * (to_x - 1.0) + east.rise, fade)
}

#[inline(always)]
fn mix(a: f32, b: f32, share: f32) -> f32 {
    a + share * (b - a)
}

#[inline(always)]
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// The lattice point before a place, and the way from there.
#[inline(always)]
fn moved(lattice: i32, way: f32) -> (i32, f32) {
    let whole = way.floor();
    (lattice.wrapping_add(whole as i32), way - whole)
}

/// A gradient in a random direction, 4/3 to 1.414 long.
#[inline(always)]
fn gradient(bits: u32) -> [f32; 2] {
    // Half a turn is 2^31, so a quarter turn on wraps like the angle does.
    [wave(bits.wrapping_add(1 << 30) as i32), wave(bits as i32)]
}

/// `4/3 sin(π t)` for `t` = `turn` / 2^31, as two parabolas.
#[inline(always)]
fn wave(turn: i32) -> f32 {
    let t = turn as f32 * (1.0 / 2_147_483_648.0);
    t * (16.0 / 3.0 - 16.0 / 3.0 * t.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vectors;

    fn window(first: [i64; 2], count: [usize; 2], cell: f64) -> Window {
        Window { first, count, cell }
    }

    fn filled(window: &Window, wavelength: f64, seed: u64) -> Vec<f32> {
        let octave = Octave::new(window, wavelength, seed, 0);
        let mut out = vec![0.0; window.count[0] * window.count[1]];
        for (y, row) in out.chunks_exact_mut(window.count[0]).enumerate() {
            octave.add_row(y, 1.0, row, &mut Scratch::default());
        }
        out
    }

    #[test]
    fn a_table_of_lines_gives_the_bits_of_lines_made_for_every_cell() {
        let window = window([-30, 5], [301, 1], 1.0);
        for wavelength in [31.0, 45.2, 100.0, 1000.0] {
            let octave = Octave::new(&window, wavelength, 3, 1);
            assert!(octave.columns.spans.len() * WIDE <= 301, "the table is used at {wavelength}");
            let [mut wide, mut narrow] = [vec![0.0; 301], vec![0.0; 301]];
            octave.add_row(0, 0.7, &mut wide, &mut Scratch::default());
            octave.add_narrow(&octave.row(0), 0.7, &mut narrow);
            assert_eq!(wide, narrow);
            assert!(wide.iter().any(|&value| value.abs() > 0.01));
        }
    }

    #[test]
    fn the_widest_vectors_give_the_bits_of_plain_code() {
        let window = window([0, 0], [97, 1], 1.0);
        for wavelength in [3.3, 40.0] {
            let octave = Octave::new(&window, wavelength, 3, 1);
            let [mut plain, mut vectors] = [vec![0.0; 97], vec![0.0; 97]];
            octave.add_row(0, 0.7, &mut plain, &mut Scratch::default());
            vectors::widest(
                #[inline(always)]
                || octave.add_row(0, 0.7, &mut vectors, &mut Scratch::default()),
            );
            assert_eq!(plain, vectors);
        }
    }

    #[test]
    fn a_row_displaced_by_nothing_is_the_row() {
        let window = window([0, 0], [64, 1], 1.0);
        let octave = Octave::new(&window, 7.7, 3, 1);
        let [mut plain, mut displaced] = [vec![0.0; 64], vec![0.0; 64]];
        octave.add_row(0, 1.0, &mut plain, &mut Scratch::default());
        octave.add_displaced_row(0, 1.0, [&[0.0; 64], &[0.0; 64]], &mut displaced);
        assert_eq!(plain, displaced);
    }

    #[test]
    fn a_displacement_by_whole_cells_moves_the_row() {
        let window = window([0, 0], [64, 9], 1.0);
        let octave = Octave::new(&window, 16.0, 3, 1);
        let [mut there, mut moved] = [vec![0.0; 64], vec![0.0; 64]];
        octave.add_row(8, 1.0, &mut there, &mut Scratch::default());
        octave.add_displaced_row(3, 1.0, [&[-7.0; 64], &[5.0; 64]], &mut moved);
        for x in 7..64 {
            assert!((moved[x] - there[x - 7]).abs() < 1e-5, "f32 adds the way in another order");
        }
    }

    #[test]
    fn a_tile_has_the_values_of_the_whole() {
        let whole = filled(&window([0, 0], [200, 120], 10.0), 370.0, 8);
        let tile = filled(&window([131, 57], [69, 63], 10.0), 370.0, 8);
        for (y, row) in tile.chunks_exact(69).enumerate() {
            assert_eq!(row, &whole[(57 + y) * 200 + 131..][..69], "row {y}");
        }
    }

    #[test]
    fn far_from_the_origin_noise_is_as_smooth_as_near_it() {
        let steepest = |first: i64| {
            let row = filled(&window([first, first], [4000, 1], 0.25), 100.0, 8);
            row.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f32::max)
        };
        assert!(steepest(0) > 0.001);
        assert!(steepest(1 << 40) < 0.02, "a quarter metre of a wave of 100 m cannot change more");
    }

    #[test]
    fn noise_stays_within_one_and_has_the_stated_variance() {
        let values = filled(&window([0, 0], [1500, 1500], 1.0), 5.37, 21);
        assert!(values.iter().all(|value| value.abs() <= 1.0));
        let mean = values.iter().map(|&v| f64::from(v)).sum::<f64>() / values.len() as f64;
        let variance = values.iter().map(|&v| f64::from(v).powi(2)).sum::<f64>() / values.len() as f64;
        assert!(mean.abs() < 0.004, "{mean}");
        assert!((variance / VARIANCE - 1.0).abs() < 0.02, "{variance}");
    }

    #[test]
    fn no_gradients_can_pass_one() {
        let longest_towards = |x: f32, y: f32| {
            let turns = (0..4096_u32).map(|k| gradient(k << 20));
            turns.map(|[gx, gy]| gx * x + gy * y).fold(0.0, f32::max)
        };
        for step in 0..=40 {
            for other in 0..=40 {
                let [x, y] = [step, other].map(|k| k as f32 / 40.0);
                let north = mix(longest_towards(x, y), longest_towards(x - 1.0, y), fade(x));
                let south = mix(longest_towards(x, y - 1.0), longest_towards(x - 1.0, y - 1.0), fade(x));
                assert!(mix(north, south, fade(y)) <= 1.0 + 1e-6, "at {x}, {y}");
            }
        }
    }
}

//! Gradient noise on a square lattice, row by row.
//!
//! Each lattice point holds a gradient `g` from a hash of (seed, octave, point). Between four points the
//! noise is the quintic blend of the four planes through them:
//!
//! ```text
//! n(p) = Σ w(dx) w(dy) g · (p - corner)        w = 1 - f, f(t) = t³ (6 t² - 15 t + 10)
//! ```
//!
//! Perlin 1985, doi 10.1145/325165.325247, and 2002, doi 10.1145/566654.566636.
//!
//! What differs: the direction of a gradient is a whole 32-bit hash, not one of a few, so no direction is
//! preferred; it comes from the parabola `4 t (1 - |t|)` in place of sine and cosine (lengths 1 to 1.061), so
//! that additions and multiplications alone give the bits. The noise is 0 at lattice points and its forms
//! lean on the lattice's axes; so that octaves do not do it together, each one's lattice is turned by the
//! angle of the 3-4-5 triangle against the one before and moved by a random part of its step.
//!
//! Noise is within [-1, 1]: at the middle of a square the four planes add up to at most 3/4 for these
//! gradients, nowhere to more, and gradients are scaled by 4/3. Its variance is [`VARIANCE`].
//!
//! A place on the turned lattice is the sum of one part that depends on the column and one that depends on
//! the row, each a whole number and a fraction (`Axis`), so that far from the origin nothing is lost. A
//! shader that is given these tables makes the same bits.

mod table;

use super::hash::{EAST, Plane, SOUTH};
use weald_core::random::{splitmix64, unit};

/// Mean of the noise squared over all places and hashes: `8 E[g_x²] ∫w² ∫w²x²` over the unit interval, with
/// `E[g_x²] = (4/3)² 8/15`.
pub const VARIANCE: f64 = 0.088_237;

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

/// What the columns, or the rows, of the grid add to places on the lattice of one octave.
#[derive(Clone, Debug, PartialEq)]
struct Axis {
    /// Whole lattice steps along the lattice's own two directions.
    whole: [Vec<i32>; 2],
    /// The rest, 0 to 1.
    rest: [Vec<f32>; 2],
}

impl Axis {
    /// Cell `k` lies at `(first + k + 1/2) * step + shift` in both directions. Lattice points are counted in
    /// 32 bits and repeat after 2^32.
    fn new(first: i64, count: usize, step: [f64; 2], shift: [f64; 2]) -> Self {
        let places =
            |k: usize| (0..count).map(move |n| ((first + n as i64) as f64 + 0.5) * step[k] + shift[k]);
        let whole = |place: f64| libm::floor(place) as i64 as i32;
        let rest = |place: f64| (place - libm::floor(place)) as f32;
        Self {
            whole: [0, 1].map(|k| places(k).map(whole).collect()),
            rest: [0, 1].map(|k| places(k).map(rest).collect()),
        }
    }

    #[inline(always)]
    fn first(&self, count: usize) -> ([&[i32]; 2], [&[f32]; 2]) {
        ([0, 1].map(|k| &self.whole[k][..count]), [0, 1].map(|k| &self.rest[k][..count]))
    }

    #[inline(always)]
    fn at(&self, index: usize) -> ([i32; 2], [f32; 2]) {
        ([0, 1].map(|k| self.whole[k][index]), [0, 1].map(|k| self.rest[k][index]))
    }
}

/// Noise of one wavelength over a window.
#[derive(Clone, Debug)]
pub struct Octave {
    plane: Plane,
    columns: Axis,
    rows: Axis,
    /// Lattice steps a metre, times the cosine and the sine of the lattice's turn.
    turn: [f64; 2],
}

impl Octave {
    /// Octave `index` of a seed: lattice steps of `wavelength` metres.
    pub fn new(window: &Window, wavelength: f64, seed: u64, index: u32) -> Self {
        let turn = turned(index).map(|part| part / wavelength);
        let [cos, sin] = turn.map(|part| part * window.cell);
        let bits = splitmix64(seed ^ u64::from(index).rotate_left(32));
        let shift = [1, 2].map(|direction| unit(splitmix64(bits ^ direction)));
        let columns = Axis::new(window.first[0], window.count[0], [cos, sin], shift);
        let rows = Axis::new(window.first[1], window.count[1], [-sin, cos], [0.0, 0.0]);
        Self { plane: Plane::new(seed, u64::from(index)), columns, rows, turn }
    }

    /// Adds `amplitude` times the noise of row `y` to `out`.
    #[inline(always)]
    pub fn add_row(&self, y: usize, amplitude: f32, out: &mut [f32]) {
        let count = out.len();
        let ([whole_u, whole_v], [rest_u, rest_v]) = self.columns.first(count);
        let (whole, rest) = self.rows.at(y);
        for x in 0..count {
            let u = carried(whole_u[x].wrapping_add(whole[0]), rest_u[x] + rest[0]);
            let v = carried(whole_v[x].wrapping_add(whole[1]), rest_v[x] + rest[1]);
            out[x] += amplitude * self.noise(u, v);
        }
    }

    /// As [`Octave::add_row`], with every cell looked up `dx`, `dy` metres away from its place.
    #[inline(always)]
    pub fn add_displaced_row(&self, y: usize, amplitude: f32, [dx, dy]: [&[f32]; 2], out: &mut [f32]) {
        let count = out.len();
        let ([whole_u, whole_v], [rest_u, rest_v]) = self.columns.first(count);
        let (whole, rest) = self.rows.at(y);
        let ([cos, sin], dx, dy) = (self.turn.map(|part| part as f32), &dx[..count], &dy[..count]);
        for x in 0..count {
            let (du, dv) = (cos * dx[x] - sin * dy[x], sin * dx[x] + cos * dy[x]);
            let u = stepped(whole_u[x].wrapping_add(whole[0]), rest_u[x] + rest[0] + du);
            let v = stepped(whole_v[x].wrapping_add(whole[1]), rest_v[x] + rest[1] + dv);
            out[x] += amplitude * self.noise(u, v);
        }
    }

    #[inline(always)]
    fn noise(&self, (column, x): (i32, f32), (row, y): (i32, f32)) -> f32 {
        let north_west = self.plane.point(column, row);
        let south_west = north_west.wrapping_add(SOUTH);
        let share = fade(x);
        let north =
            mix(self.height(north_west, x, y), self.height(north_west.wrapping_add(EAST), x - 1.0, y), share);
        let south = mix(
            self.height(south_west, x, y - 1.0),
            self.height(south_west.wrapping_add(EAST), x - 1.0, y - 1.0),
            share,
        );
        mix(north, south, fade(y))
    }

    /// Height of the plane through a lattice point, at a place relative to it.
    #[inline(always)]
    fn height(&self, point: u32, x: f32, y: f32) -> f32 {
        let gradient = gradient(self.plane.bits(point));
        gradient[0] * x + gradient[1] * y
    }
}

/// As [`stepped`] for a `offset` from 0 to 2.
#[inline(always)]
fn carried(whole: i32, offset: f32) -> (i32, f32) {
    if offset >= 1.0 { (whole.wrapping_add(1), offset - 1.0) } else { (whole, offset) }
}

/// The lattice point before a place that is `offset` steps beyond `whole`, and the way from there.
#[inline(always)]
fn stepped(whole: i32, offset: f32) -> (i32, f32) {
    // Adding 1.5 × 2^23 leaves no bits for a fraction, so the sum's last bits count whole steps. A cast to
    // `i32` would saturate, which the compiler does not vectorise.
    const ROUND: f32 = 12_582_912.0;
    let offset = offset.clamp(-4_000_000.0, 4_000_000.0);
    let nearest = offset + ROUND;
    let rest = offset - (nearest - ROUND);
    let beyond = rest < 0.0;
    let steps =
        (nearest.to_bits() as i32).wrapping_sub(ROUND.to_bits() as i32).wrapping_sub(i32::from(beyond));
    (whole.wrapping_add(steps), if beyond { rest + 1.0 } else { rest })
}

/// Cosine and sine of `index` turns by the angle of the 3-4-5 triangle, which is no part of a whole turn.
fn turned(index: u32) -> [f64; 2] {
    (0..index).fold([1.0, 0.0], |[cos, sin], _| [0.8 * cos - 0.6 * sin, 0.6 * cos + 0.8 * sin])
}

#[inline(always)]
fn mix(a: f32, b: f32, share: f32) -> f32 {
    a + share * (b - a)
}

#[inline(always)]
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// A gradient in a random direction, 4/3 to 1.414 long.
#[inline(always)]
fn gradient(bits: u32) -> [f32; 2] {
    // Half a turn is 2^31, so a quarter turn on wraps like the angle does.
    [wave(bits.wrapping_add(1 << 30) as i32), wave(bits as i32)]
}

/// `4/3 sin(π t)` for `t` = `turn` / 2^31, as two parabolas: `16/3 t (1 - |t|)`.
#[inline(always)]
fn wave(turn: i32) -> f32 {
    const HALF_TURN: f32 = 2_147_483_648.0;
    const RISE: f32 = 16.0 / 3.0 / HALF_TURN;
    let turn = turn as f32;
    turn * (RISE - RISE / HALF_TURN * turn.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::vectors;

    fn window(first: [i64; 2], count: [usize; 2], cell: f64) -> Window {
        Window { first, count, cell }
    }

    fn filled(window: &Window, wavelength: f64, seed: u64) -> Vec<f32> {
        let octave = Octave::new(window, wavelength, seed, 2);
        let mut out = vec![0.0; window.count[0] * window.count[1]];
        for (y, row) in out.chunks_exact_mut(window.count[0]).enumerate() {
            octave.add_row(y, 1.0, row);
        }
        out
    }

    #[test]
    fn the_widest_vectors_give_the_bits_of_plain_code() {
        let window = window([0, 0], [97, 1], 1.0);
        for wavelength in [3.3, 40.0] {
            let octave = Octave::new(&window, wavelength, 3, 1);
            let [mut plain, mut vectors] = [vec![0.0; 97], vec![0.0; 97]];
            octave.add_row(0, 0.7, &mut plain);
            vectors::widest(
                #[inline(always)]
                || octave.add_row(0, 0.7, &mut vectors),
            );
            assert_eq!(plain, vectors);
        }
    }

    #[test]
    fn a_row_displaced_by_nothing_is_the_row() {
        let window = window([0, 0], [64, 1], 1.0);
        let octave = Octave::new(&window, 7.7, 3, 1);
        let [mut plain, mut displaced] = [vec![0.0; 64], vec![0.0; 64]];
        octave.add_row(0, 1.0, &mut plain);
        octave.add_displaced_row(0, 1.0, [&[0.0; 64], &[0.0; 64]], &mut displaced);
        assert_eq!(plain, displaced);
    }

    #[test]
    fn a_displacement_by_whole_cells_moves_the_row() {
        let window = window([0, 0], [64, 9], 1.0);
        let octave = Octave::new(&window, 16.0, 3, 1);
        let [mut there, mut moved] = [vec![0.0; 64], vec![0.0; 64]];
        octave.add_row(8, 1.0, &mut there);
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

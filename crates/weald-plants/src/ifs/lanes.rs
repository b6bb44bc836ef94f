//! The inner loop of random iteration: one map for each of 64 lanes, in the widest vectors of the machine.
//!
//! A draw is a hash of (key, step): two words of key enter a 32-bit hash that multiplies twice (after Wellons 2018,
//! "Prospecting for hash functions"), and its halves are the draws of two steps. Coefficients are chosen by comparing
//! the draw with the bounds of all maps: a chain of selections is what vectors can do, a look-up is not.

use super::system::Ifs;
use super::table::Table;
use weald_core::vectors::widest;

/// Points that run side by side.
pub const LANES: usize = 64;

/// One coordinate of all lanes.
pub type Row = [f32; LANES];

/// Where the lanes of a chunk stand.
#[derive(Clone, Debug)]
pub(super) struct Lanes {
    /// Their points.
    pub(super) at: [Row; 3],
    /// Two words of a key for each.
    pub(super) keys: [[u32; LANES]; 2],
    /// Steps done.
    pub(super) step: u32,
}

impl Lanes {
    pub(super) fn at_root(ifs: &Ifs, keys: &[[u32; LANES]; 2]) -> Self {
        Self { at: ifs.root().map(|x| [x as f32; LANES]), keys: *keys, step: 0 }
    }
}

/// Plays as many steps as `points` has rows.
pub(super) fn play(table: &Table, lanes: &mut Lanes, points: &mut [[Row; 3]], taken: &mut [[u8; LANES]]) {
    match (table.maps.len(), table.planar) {
        (2, true) => steps::<2, true>(table, lanes, points, taken),
        (3, true) => steps::<3, true>(table, lanes, points, taken),
        (4, true) => steps::<4, true>(table, lanes, points, taken),
        (5, true) => steps::<5, true>(table, lanes, points, taken),
        (8, true) => steps::<8, true>(table, lanes, points, taken),
        (4, false) => steps::<4, false>(table, lanes, points, taken),
        (5, false) => steps::<5, false>(table, lanes, points, taken),
        (6, false) => steps::<6, false>(table, lanes, points, taken),
        _ => steps_by_table(table, lanes, points, taken),
    }
}

fn steps<const N: usize, const PLANAR: bool>(
    table: &Table,
    lanes: &mut Lanes,
    points: &mut [[Row; 3]],
    taken: &mut [[u8; LANES]],
) {
    // Coefficient by coefficient, so that each is chosen by itself.
    let coefficients: [[[f32; N]; 4]; 3] = std::array::from_fn(|row| {
        std::array::from_fn(|column| std::array::from_fn(|map| table.maps[map][row][column]))
    });
    let bounds: [u32; N] = std::array::from_fn(|map| table.bounds[map]);
    widest(
        #[inline(always)]
        || {
            // Copies, which nothing that is written can be: so they stay in registers.
            let (coefficients, bounds) = (coefficients, bounds);
            for (points, taken) in points.iter_mut().zip(taken.iter_mut()) {
                step::<N, PLANAR>(&coefficients, &bounds, lanes, points, taken);
                lanes.step += 1;
            }
        },
    );
}

/// One step of all lanes.
#[inline(always)]
fn step<const N: usize, const PLANAR: bool>(
    coefficients: &[[[f32; N]; 4]; 3],
    bounds: &[u32; N],
    lanes: &mut Lanes,
    points: &mut [Row; 3],
    taken: &mut [u8; LANES],
) {
    let [xs, ys, zs] = &mut lanes.at;
    let [keys, other_keys] = &lanes.keys;
    let [out_x, out_y, out_z] = points;
    let [[a, b, c, t], [d, e, f, u], [g, h, i, v]] = coefficients;
    for lane in 0..LANES {
        let draw = draw(keys[lane], other_keys[lane], lanes.step);
        let (x, y) = (xs[lane], ys[lane]);
        if PLANAR {
            xs[lane] = chosen(draw, bounds, a) * x + chosen(draw, bounds, b) * y + chosen(draw, bounds, t);
            ys[lane] = chosen(draw, bounds, d) * x + chosen(draw, bounds, e) * y + chosen(draw, bounds, u);
        } else {
            let z = zs[lane];
            xs[lane] = chosen(draw, bounds, a) * x
                + chosen(draw, bounds, b) * y
                + chosen(draw, bounds, c) * z
                + chosen(draw, bounds, t);
            ys[lane] = chosen(draw, bounds, d) * x
                + chosen(draw, bounds, e) * y
                + chosen(draw, bounds, f) * z
                + chosen(draw, bounds, u);
            zs[lane] = chosen(draw, bounds, g) * x
                + chosen(draw, bounds, h) * y
                + chosen(draw, bounds, i) * z
                + chosen(draw, bounds, v);
            out_z[lane] = zs[lane];
        }
        out_x[lane] = xs[lane];
        out_y[lane] = ys[lane];
        taken[lane] = digit(draw, bounds);
    }
}

/// The value of the map that a draw takes.
#[inline(always)]
fn chosen<const N: usize>(draw: u32, bounds: &[u32; N], values: &[f32; N]) -> f32 {
    let mut value = values[0];
    for map in 1..N {
        value = if draw >= bounds[map] { values[map] } else { value };
    }
    value
}

/// The map that a draw takes.
#[inline(always)]
fn digit<const N: usize>(draw: u32, bounds: &[u32; N]) -> u8 {
    let mut digit = 0;
    for &bound in &bounds[1..] {
        digit += u32::from(draw >= bound);
    }
    digit as u8
}

/// The same for any number of maps, by looking them up: the same bits, more slowly.
fn steps_by_table(table: &Table, lanes: &mut Lanes, points: &mut [[Row; 3]], taken: &mut [[u8; LANES]]) {
    for (points, taken) in points.iter_mut().zip(taken.iter_mut()) {
        for lane in 0..LANES {
            let draw = draw(lanes.keys[0][lane], lanes.keys[1][lane], lanes.step);
            let digit = table.bounds.partition_point(|&bound| bound <= draw) - 1;
            let at = [lanes.at[0][lane], lanes.at[1][lane], lanes.at[2][lane]];
            let map = &table.maps[digit];
            let image = if table.planar { planar(map, at) } else { spatial(map, at) };
            for axis in 0..3 {
                lanes.at[axis][lane] = image[axis];
                points[axis][lane] = image[axis];
            }
            taken[lane] = digit as u8;
        }
        lanes.step += 1;
    }
}

#[inline(always)]
fn planar(map: &[[f32; 4]; 3], [x, y, _]: [f32; 3]) -> [f32; 3] {
    let row = |[a, b, _, t]: [f32; 4]| a * x + b * y + t;
    [row(map[0]), row(map[1]), 0.0]
}

#[inline(always)]
fn spatial(map: &[[f32; 4]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    let row = |[a, b, c, t]: [f32; 4]| a * x + b * y + c * z + t;
    [row(map[0]), row(map[1]), row(map[2])]
}

/// 16 random bits for a step of a lane.
#[inline(always)]
fn draw(key: u32, other_key: u32, step: u32) -> u32 {
    let mut bits = (step >> 1).wrapping_mul(0x9e37_79b9).wrapping_add(key);
    bits = (bits ^ (bits >> 16)).wrapping_mul(0x7feb_352d);
    bits = (bits ^ (bits >> 15)).wrapping_add(other_key).wrapping_mul(0x846c_a68b);
    bits ^= bits >> 16;
    (bits >> (16 * (!step & 1))) & 0xffff
}

/// Points of both ways to choose maps, for a test.
#[cfg(test)]
pub(super) fn both(table: &Table, start: &Lanes, steps: usize) -> [Vec<[Row; 3]>; 2] {
    let rows = || (vec![[[0.0; LANES]; 3]; steps], vec![[0; LANES]; steps]);
    let (mut chosen, mut taken) = rows();
    play(table, &mut start.clone(), &mut chosen, &mut taken);
    let (mut looked_up, mut taken) = rows();
    steps_by_table(table, &mut start.clone(), &mut looked_up, &mut taken);
    [chosen, looked_up]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_bits_are_the_same_for_ever_and_two_steps_share_a_word() {
        assert_eq!([0, 1, 2, 3, 1000].map(|step| draw(1, 2, step)), [29027, 13372, 43050, 48720, 48036]);
    }
}

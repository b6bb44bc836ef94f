//! Heights of a landscape and of its border, by which what is around it is made.

use rayon::prelude::*;

use super::surface::Surface;

/// Directions for which the height of the border is known.
pub(super) const DIRECTIONS: usize = 24;

/// Share of the relief by which the ground around a sea lies below it at least.
const SUNK: f32 = 0.02;

/// Share of the relief above the sea from which the ground around is as uneven as the landscape.
const UNEVEN: f32 = 0.05;

/// Heights of a ground.
pub(super) struct Heights {
    pub(super) low: f32,
    pub(super) high: f32,
    pub(super) mean: f32,
    /// Root mean square about the mean.
    pub(super) deviation: f32,
}

impl Heights {
    /// Of the middles of all cells, the same whatever the threads.
    pub(super) fn of(bed: &Surface) -> Self {
        let size = bed.size();
        let row = |y: usize| (0..size.columns).map(move |x| f64::from(bed.at(centre(x, y))));
        let rows = || (0..size.rows).into_par_iter();
        let of_row = |y: usize| {
            let nothing = [f64::INFINITY, f64::NEG_INFINITY, 0.0];
            row(y).fold(nothing, |[low, high, sum], z| [low.min(z), high.max(z), sum + z])
        };
        let parts: Vec<[f64; 3]> = rows().map(of_row).collect();
        let low = parts.iter().fold(f64::INFINITY, |low, part| low.min(part[0])) as f32;
        let high = parts.iter().fold(f64::NEG_INFINITY, |high, part| high.max(part[1])) as f32;
        let mean = parts.iter().map(|part| part[2]).sum::<f64>() / size.cells() as f64;
        let squares: Vec<f64> = rows().map(|y| row(y).map(|z| (z - mean) * (z - mean)).sum()).collect();
        let deviation = (squares.iter().sum::<f64>() / size.cells() as f64).sqrt() as f32;
        Self { low, high, mean: mean as f32, deviation }
    }
}

fn centre(x: usize, y: usize) -> [f32; 2] {
    [x as f32 + 1.0, y as f32 + 1.0]
}

/// Heights along the border, each with its direction from the middle in turns, clockwise from north.
pub(super) fn border(bed: &Surface) -> Vec<(f32, f32)> {
    let size = bed.size();
    let (last_x, last_y) = (size.columns - 1, size.rows - 1);
    let across = (0..size.columns).flat_map(|x| [(x, 0), (x, last_y)]);
    let down = (0..size.rows).flat_map(|y| [(0, y), (last_x, y)]);
    let at = |(x, y): (usize, usize)| {
        let place = centre(x, y);
        let east = place[0] - 0.5 - 0.5 * size.columns as f32;
        let south = place[1] - 0.5 - 0.5 * size.rows as f32;
        (libm::atan2f(east, -south) / std::f32::consts::TAU, bed.at(place))
    };
    across.chain(down).map(at).collect()
}

/// Height far away in each direction, and how uneven the ground is there.
pub(super) fn far(border: &[(f32, f32)], sea: Option<f32>, relief: f32) -> [[f32; 2]; DIRECTIONS] {
    std::array::from_fn(|direction| {
        let middle = direction as f32 / DIRECTIONS as f32;
        let (mut sum, mut weights) = (0.0, 0.0);
        for &(turn, height) in border {
            let away = turn - middle - (turn - middle).round();
            // A bell an eighth of a turn wide.
            let weight = libm::expf(-256.0 * away * away);
            sum += weight * height;
            weights += weight;
        }
        let mean = sum / weights.max(1e-9);
        let Some(sea) = sea else { return [mean, 1.0] };
        let uneven = ((mean - sea) / (UNEVEN * relief).max(1e-6)).clamp(0.0, 1.0);
        let sunk = sea - SUNK * relief;
        [if uneven > 0.0 { mean } else { mean.min(sunk) }, uneven]
    })
}

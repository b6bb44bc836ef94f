//! Texture shading: how far each place stands above or below its surroundings, at all scales alike.
//!
//! Hill shading hides ridges and valleys that run towards the light; this term shows them in every direction.
//! The height is split by the à trous wavelet, `c_{j+1} = c_j * (1, 4, 6, 4, 1)/16` with `2^j - 1` cells
//! between the taps, and the details are summed as `T = Σ 2^{-αj} (c_j - c_{j+1})`. Idea: Leland Brown,
//! "Texture shading: a new technique for depicting terrain relief" (2010), who takes a fractional Laplacian by
//! Fourier transform; transform: Holschneider et al. 1989, Starck and Murtagh. Differs: octaves stand in for
//! the continuous spectrum, so no transform of the whole grid is needed.

use rayon::prelude::*;

use weald_core::grid::Field;

/// Exponent α. Natural relief has details that grow about as scale^0.9; a little less flattens the octaves
/// and lets the large forms lead.
const FLATTENING: f64 = 0.75;

/// Largest number of octaves: the broadest form that is set off is 2^7 cells wide.
const OCTAVES: u32 = 7;

/// The sum of weighted details, in units of the height. Zero on every plane.
pub(super) fn texture(height: &Field) -> Field {
    let size = height.size();
    let mut sum = Field::filled(size, 0.0);
    let mut coarse = height.clone();
    for octave in 0..OCTAVES {
        let gap = 1_usize << octave;
        if 4 * gap >= size.columns.min(size.rows) {
            break;
        }
        let coarser = smoothed(&coarse, gap);
        let weight = libm::exp2(-FLATTENING * f64::from(octave)) as f32;
        for ((sum, fine), smooth) in sum.values_mut().iter_mut().zip(coarse.values()).zip(coarser.values()) {
            *sum += weight * (fine - smooth);
        }
        coarse = coarser;
    }
    sum
}

/// One step of the transform: the field smoothed by five taps along each axis, `gap` cells apart.
pub(super) fn smoothed(field: &Field, gap: usize) -> Field {
    smooth_columns(&smooth_rows(field, gap), gap)
}

const KERNEL: [f32; 5] = [1.0 / 16.0, 4.0 / 16.0, 6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0];

/// The cell to read for a tap, and the border cell it is point-reflected at, if it lies outside.
fn reflect(position: isize, count: usize) -> (usize, Option<usize>) {
    let last = count as isize - 1;
    let border = position.clamp(0, last);
    if border == position {
        return (position as usize, None);
    }
    ((2 * border - position).clamp(0, last) as usize, Some(border as usize))
}

fn smooth_rows(field: &Field, gap: usize) -> Field {
    let size = field.size();
    let mut out = Field::filled(size, 0.0);
    out.values_mut().par_chunks_mut(size.columns).enumerate().for_each(|(y, out)| {
        let row = field.row(y);
        for (x, out) in out.iter_mut().enumerate() {
            *out = (-2..)
                .zip(KERNEL)
                .map(|(tap, weight)| weight * along(row, x as isize + tap * gap as isize))
                .sum();
        }
    });
    out
}

fn along(row: &[f32], position: isize) -> f32 {
    match reflect(position, row.len()) {
        (cell, None) => row[cell],
        (cell, Some(border)) => 2.0 * row[border] - row[cell],
    }
}

fn smooth_columns(field: &Field, gap: usize) -> Field {
    let size = field.size();
    let mut out = Field::filled(size, 0.0);
    out.values_mut().par_chunks_mut(size.columns).enumerate().for_each(|(y, out)| {
        for (tap, weight) in (-2..).zip(KERNEL) {
            let (cell, border) = reflect(y as isize + tap * gap as isize, size.rows);
            match border {
                None => add(out, weight, field.row(cell)),
                Some(border) => {
                    add(out, 2.0 * weight, field.row(border));
                    add(out, -weight, field.row(cell));
                }
            }
        }
    });
    out
}

fn add(out: &mut [f32], weight: f32, row: &[f32]) {
    for (out, value) in out.iter_mut().zip(row) {
        *out += weight * value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Size;

    #[test]
    fn a_plane_has_no_texture_and_a_ridge_stands_out() {
        let size = Size::new(64, 48).expect("legal");
        let plane = texture(&Field::from_function(size, |x, y| 2.0 * x as f32 - 3.0 * y as f32));
        assert!(plane.values().iter().all(|value| value.abs() < 1e-3));
        let ridge = texture(&Field::from_function(size, |x, _| -(x as f32 - 32.0).abs()));
        assert!(ridge.at(32, 20) > 1.0 && ridge.at(10, 20) < ridge.at(32, 20) / 4.0);
    }
}

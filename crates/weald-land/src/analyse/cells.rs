//! Layers made cell by cell or row by row, rows in parallel.

use std::slice::ChunksMut;

use rayon::prelude::*;

use weald_core::domain::Domain;
use weald_core::grid::{Field, Size};

/// A field from column and row. Cells without data hold 0.
pub(super) fn field_of(domain: &Domain, value: impl Fn(usize, usize) -> f64 + Sync) -> Field {
    let [field] = fields_of(domain, |x, y| [value(x, y)]);
    field
}

/// Several fields at once, from column and row. Cells without data hold 0.
pub(super) fn fields_of<const N: usize>(
    domain: &Domain,
    values: impl Fn(usize, usize) -> [f64; N] + Sync,
) -> [Field; N] {
    fields_by_rows(domain.size, |y, rows| {
        for x in 0..domain.size.columns {
            if domain.valid.as_ref().is_none_or(|valid| valid.is_valid(x, y)) {
                put(rows, x, values(x, y));
            }
        }
    })
}

/// Several fields at once: `fill` is given the number of a row and that row of each field, which holds zeros.
pub(super) fn fields_by_rows<const N: usize>(
    size: Size,
    fill: impl Fn(usize, &mut [&mut [f32]; N]) + Sync,
) -> [Field; N] {
    let mut fields: [Vec<f32>; N] = std::array::from_fn(|_| vec![0.0; size.cells()]);
    let mut rest = fields.each_mut().map(|field| field.chunks_mut(size.columns));
    let mut rows: Vec<_> = (0..size.rows).map(|_| rest.each_mut().map(next_row)).collect();
    rows.par_iter_mut().enumerate().for_each(|(y, rows)| fill(y, rows));
    fields.map(|values| Field::from_values(size, values))
}

fn next_row<'a>(rows: &mut ChunksMut<'a, f32>) -> &'a mut [f32] {
    rows.next().expect("as many rows as the size has")
}

/// Puts the values of a cell into a row of each field.
pub(super) fn put<const N: usize>(rows: &mut [&mut [f32]; N], x: usize, values: [f64; N]) {
    for (row, value) in rows.iter_mut().zip(values) {
        row[x] = value as f32;
    }
}

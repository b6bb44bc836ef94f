//! Layers made cell by cell, rows in parallel.

use rayon::prelude::*;

use weald_core::domain::Domain;
use weald_core::grid::Field;

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
    let columns = domain.size.columns;
    let mut cells = vec![[0.0_f32; N]; domain.size.cells()];
    cells.par_chunks_mut(columns).enumerate().for_each(|(y, row)| {
        for (x, cell) in row.iter_mut().enumerate() {
            if domain.valid.as_ref().is_none_or(|valid| valid.is_valid(x, y)) {
                *cell = values(x, y).map(|value| value as f32);
            }
        }
    });
    std::array::from_fn(|n| Field::from_values(domain.size, cells.iter().map(|cell| cell[n]).collect()))
}

//! Smaller images of a raster, for programs that show it from afar.

use super::super::Raster;
use super::tiles::TILE;
use weald_core::grid::{Field, Mask, Size};

/// Images of half the sides of the one before, until one fits into a tile.
pub(super) fn overviews(raster: &Raster) -> Vec<Raster> {
    let mut smaller: Vec<Raster> = Vec::new();
    loop {
        let last = smaller.last().unwrap_or(raster);
        let Size { columns, rows } = last.field.size();
        if columns.max(rows) <= TILE {
            return smaller;
        }
        smaller.push(halved(last));
    }
}

/// A cell for four: their mean, or of classes the first that holds data. It has data where one of them has.
pub(super) fn halved(raster: &Raster) -> Raster {
    let old = raster.field.size();
    let size = Size { columns: old.columns.div_ceil(2), rows: old.rows.div_ceil(2) };
    let (mut values, mut has_data) = (Vec::with_capacity(size.cells()), Vec::with_capacity(size.cells()));
    for cell in 0..size.cells() {
        let (x, y) = (2 * (cell % size.columns), 2 * (cell / size.columns));
        let four = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
        let inside = four.into_iter().filter(|(x, y)| *x < old.columns && *y < old.rows);
        let held: Vec<f32> = inside
            .map(|(x, y)| old.index(x, y))
            .filter(|&index| raster.is_valid_at(index))
            .map(|index| raster.field.values()[index])
            .collect();
        let mean = held.iter().map(|&value| f64::from(value)).sum::<f64>() / held.len() as f64;
        values.push(match held.first() {
            None => 0.0,
            Some(first) if raster.classes.is_some() => *first,
            Some(_) => mean as f32,
        });
        has_data.push(!held.is_empty());
    }
    let valid = raster.valid.as_ref().and_then(|_| Mask::new(size, has_data));
    Raster { valid, classes: raster.classes.clone(), ..Raster::from(Field::from_values(size, values)) }
}

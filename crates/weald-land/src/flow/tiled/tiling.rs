//! A grid cut into tiles, the cells on their borders, and visits of tiles until none has news for another.

use std::collections::VecDeque;

use weald_core::error::{Error, Limit, Quantity};
use weald_core::grid::{MAX_CELLS, Size};
use weald_core::plane::Window;

/// A grid cut into tiles of one size; the last of a row or a column of tiles may be smaller.
#[derive(Clone, Debug)]
pub struct Tiling {
    size: Size,
    tile: Size,
    /// The number of the first border cell of each tile, and of all border cells.
    first: Vec<usize>,
}

impl Tiling {
    /// Tiles of up to so many columns and rows. The grid may have more cells than one landscape holds in memory.
    ///
    /// # Errors
    /// [`Error::Limit`] for tiles without cells, or of more than [`MAX_CELLS`].
    pub fn new(size: Size, tile: Size) -> Result<Self, Error> {
        let tile = Size { columns: tile.columns.min(size.columns), rows: tile.rows.min(size.rows) };
        let cells = tile.columns as u64 * tile.rows as u64;
        let allowed = 1..=MAX_CELLS as u64;
        if !allowed.contains(&cells) {
            let limit = Limit::new(Quantity::Cells, cells, allowed);
            return Err(limit.of(format!("a tile of {tile} cells")).remedy("choose another tile").into());
        }
        let mut tiling = Self { size, tile, first: Vec::new() };
        let mut cells = 0;
        for tile in 0..tiling.count() {
            tiling.first.push(cells);
            cells += border_cells(tiling.window(tile).size());
        }
        tiling.first.push(cells);
        Ok(tiling)
    }

    /// Columns and rows of the grid.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Number of tiles.
    pub fn count(&self) -> usize {
        self.across() * self.size.rows.div_ceil(self.tile.rows)
    }

    /// Number of border cells: those of a tile that lie at its border.
    pub fn border_cells(&self) -> usize {
        self.first[self.count()]
    }

    /// Where a tile lies.
    pub fn window(&self, tile: usize) -> Window {
        let side =
            |number: usize, length: usize, end: usize| number * length..((number + 1) * length).min(end);
        Window {
            columns: side(tile % self.across(), self.tile.columns, self.size.columns),
            rows: side(tile / self.across(), self.tile.rows, self.size.rows),
        }
    }

    /// Tiles from west to east.
    fn across(&self) -> usize {
        self.size.columns.div_ceil(self.tile.columns)
    }

    /// The tile of a cell, given by column and row.
    pub(super) fn tile_of(&self, [x, y]: [usize; 2]) -> usize {
        y / self.tile.rows * self.across() + x / self.tile.columns
    }

    /// The number of a border cell.
    pub(super) fn border(&self, cell: [usize; 2]) -> usize {
        let tile = self.tile_of(cell);
        let window = self.window(tile);
        let (x, y) = (cell[0] - window.columns.start, cell[1] - window.rows.start);
        let (columns, rows) = (window.columns.len(), window.rows.len());
        let place = match (x, y) {
            (x, 0) => x,
            (x, y) if y + 1 == rows => columns + x,
            (0, y) => 2 * columns + y - 1,
            (_, y) => 2 * columns + rows - 2 + y - 1,
        };
        self.first[tile] + place
    }

    /// The border cells of a tile.
    pub(super) fn border_of(&self, tile: usize) -> Vec<[usize; 2]> {
        rim(&self.window(tile))
    }

    /// The cells of other tiles around a tile.
    pub(super) fn ring_of(&self, tile: usize) -> Vec<[usize; 2]> {
        let window = self.window(tile);
        let ring = rim(&window.grown(1, self.size)).into_iter();
        let is_inside = |&[x, y]: &[usize; 2]| window.columns.contains(&x) && window.rows.contains(&y);
        ring.filter(|cell| !is_inside(cell)).collect()
    }

    /// The neighbours of a cell that belong to other tiles.
    pub(super) fn across_from(&self, [x, y]: [usize; 2]) -> impl Iterator<Item = [usize; 2]> {
        let own = self.tile_of([x, y]);
        let rows = y.saturating_sub(1)..(y + 2).min(self.size.rows);
        let columns = x.saturating_sub(1)..(x + 2).min(self.size.columns);
        let around = rows.flat_map(move |y| columns.clone().map(move |x| [x, y]));
        around.filter(move |&cell| self.tile_of(cell) != own)
    }
}

/// Visits every tile, and again each that a later visit of another names, until none is left. A visit gives the tiles for
/// which something changed.
pub(super) fn settle(
    tiling: &Tiling,
    mut visit: impl FnMut(usize) -> Result<Vec<usize>, Error>,
) -> Result<(), Error> {
    let mut queue: VecDeque<usize> = (0..tiling.count()).collect();
    let mut is_queued = vec![true; tiling.count()];
    while let Some(tile) = queue.pop_front() {
        is_queued[tile] = false;
        for woken in visit(tile)? {
            if !std::mem::replace(&mut is_queued[woken], true) {
                queue.push_back(woken);
            }
        }
    }
    Ok(())
}

/// The tiles beside which these border cells lie.
pub(super) fn beside(tiling: &Tiling, cells: impl IntoIterator<Item = [usize; 2]>) -> Vec<usize> {
    let mut tiles: Vec<usize> = cells
        .into_iter()
        .flat_map(|cell| tiling.across_from(cell))
        .map(|cell| tiling.tile_of(cell))
        .collect();
    tiles.sort_unstable();
    tiles.dedup();
    tiles
}

fn border_cells(Size { columns, rows }: Size) -> usize {
    columns * rows - columns.saturating_sub(2) * rows.saturating_sub(2)
}

/// The outermost cells of a window.
fn rim(window: &Window) -> Vec<[usize; 2]> {
    let (west, east) = (window.columns.start, window.columns.end - 1);
    let (north, south) = (window.rows.start, window.rows.end - 1);
    let mut cells: Vec<_> = window.columns.clone().map(|x| [x, north]).collect();
    if south > north {
        cells.extend(window.columns.clone().map(|x| [x, south]));
    }
    for y in north + 1..south {
        cells.push([west, y]);
        cells.extend((east > west).then_some([east, y]));
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn border_cells_are_numbered_once_and_know_who_lies_across() {
        for (size, tile) in
            [([1, 1], [1, 1]), ([7, 5], [3, 2]), ([9, 4], [1, 4]), ([8, 8], [4, 1]), ([6, 6], [9, 9])]
        {
            let of = |[columns, rows]: [usize; 2]| Size { columns, rows };
            let tiling = Tiling::new(of(size), of(tile)).expect("legal");
            let cells: Vec<_> = (0..tiling.count()).flat_map(|tile| tiling.border_of(tile)).collect();
            let mut numbers: Vec<_> = cells.iter().map(|&cell| tiling.border(cell)).collect();
            numbers.sort_unstable();
            assert_eq!(numbers, (0..tiling.border_cells()).collect::<Vec<_>>(), "{size:?} by {tile:?}");
            for tile in 0..tiling.count() {
                let ring = tiling.ring_of(tile);
                let mut across: Vec<_> =
                    tiling.border_of(tile).into_iter().flat_map(|cell| tiling.across_from(cell)).collect();
                across.sort_unstable();
                across.dedup();
                assert_eq!(across.len(), ring.len());
                assert!(ring.iter().all(|cell| across.contains(cell)));
            }
        }
    }

    #[test]
    fn tiles_without_cells_are_refused() {
        let size = Size { columns: 5, rows: 5 };
        let error = Tiling::new(size, Size { columns: 0, rows: 3 }).expect_err("no cells").to_string();
        assert!(error.contains("a tile of 0 × 3"), "{error}");
    }
}

//! A grid cut into tiles, which ranks may share, and the cells on their borders.

use std::ops::Range;
use std::sync::Arc;

use weald_core::error::{Error, Limit, Quantity};
use weald_core::grid::{MAX_CELLS, Size};
use weald_core::plane::Window;
use weald_engine::ranks::{Alone, Ranks, SharedRows};

/// Cells on a side of the tiles of [`Tiling::finer`], at most.
pub const SMALL_TILE: usize = 256;

/// A grid cut into tiles of one size; the last of a row or a column of tiles may be smaller. No tile has rows of two ranks.
#[derive(Clone, Debug)]
pub struct Tiling {
    size: Size,
    tile: Size,
    /// The first row of each row of tiles, and the end of the last.
    cuts: Vec<usize>,
    /// The number of the first border cell of each tile, and of all border cells.
    first: Vec<usize>,
    rows: SharedRows,
    ranks: Arc<dyn Ranks>,
}

impl Tiling {
    /// Tiles of up to so many columns and rows. The grid may have more cells than one landscape holds in memory.
    ///
    /// # Errors
    /// [`Error::Limit`] for tiles without cells, or of more than [`MAX_CELLS`].
    pub fn new(size: Size, tile: Size) -> Result<Self, Error> {
        Self::over(
            (size.columns, &SharedRows::of((0, 1), size.rows)),
            tile,
            &(Arc::new(Alone) as Arc<dyn Ranks>),
        )
    }

    /// The same of a grid whose rows are shared among ranks, each of which visits the tiles of its own.
    ///
    /// # Errors
    /// As [`Tiling::new`].
    pub fn over(
        (columns, rows): (usize, &SharedRows),
        tile: Size,
        ranks: &Arc<dyn Ranks>,
    ) -> Result<Self, Error> {
        let tile = Size { columns: tile.columns.min(columns), rows: tile.rows.min(rows.most()) };
        let cells = tile.columns as u64 * tile.rows as u64;
        let allowed = 1..=MAX_CELLS as u64;
        if !allowed.contains(&cells) {
            let limit = Limit::new(Quantity::Cells, cells, allowed);
            return Err(limit.of(format!("a tile of {tile} cells")).remedy("choose another tile").into());
        }
        let own = (0..ranks.count()).map(|rank| rows.of_rank(rank).own());
        let cuts = own.flat_map(|own| own.step_by(tile.rows)).chain([rows.count()]).collect();
        let size = Size { columns, rows: rows.count() };
        let (rows, ranks) = (rows.clone(), Arc::clone(ranks));
        let mut tiling = Self { size, tile, cuts, first: Vec::new(), rows, ranks };
        let mut cells = 0;
        for tile in 0..tiling.count() {
            tiling.first.push(cells);
            cells += border_cells(tiling.window(tile).size());
        }
        tiling.first.push(cells);
        Ok(tiling)
    }

    /// The same grid and ranks in tiles for what passes tiles until it settles; as it is where a rank has one tile.
    ///
    /// A river that crosses a border has the tiles on both sides visited once for each crossing. The number of visits of a tile
    /// hardly depends on its size, and small ones fit into the caches of a processor.
    #[must_use]
    pub fn finer(&self) -> Self {
        if self.count() == self.ranks.count() {
            return self.clone();
        }
        // Sixteen of them are no larger than one of the others.
        let side = |of: usize| (of / 4).clamp(1, SMALL_TILE);
        let tile = Size { columns: side(self.tile.columns), rows: side(self.tile.rows) };
        Self::over((self.size.columns, &self.rows), tile, &self.ranks)
            .expect("smaller than those that were legal")
    }

    /// The ranks that share the grid.
    pub(super) fn ranks(&self) -> &dyn Ranks {
        &*self.ranks
    }

    /// The tiles of this rank.
    pub fn own(&self) -> Range<usize> {
        self.tiles_of(&self.rows)
    }

    /// The tiles of another rank.
    pub(super) fn own_of(&self, rank: usize) -> Range<usize> {
        self.tiles_of(&self.rows.of_rank(rank))
    }

    fn tiles_of(&self, rows: &SharedRows) -> Range<usize> {
        let own = rows.own();
        let band = |row: usize| self.cuts.partition_point(|&cut| cut < row);
        band(own.start) * self.across()..band(own.end) * self.across()
    }

    /// Numbers of the border cells of some tiles that follow each other.
    pub(super) fn borders_of(&self, tiles: &Range<usize>) -> Range<usize> {
        self.first[tiles.start]..self.first[tiles.end]
    }

    /// Numbers of the border cells that a rank knows: those of its tiles, and of the tiles beside those.
    pub(super) fn known(&self) -> Range<usize> {
        let (own, across) = (self.own(), self.across());
        self.borders_of(&(own.start.saturating_sub(across)..(own.end + across).min(self.count())))
    }

    /// The ranks to the north and to the south, each with this rank's row beside its own and with its row beside those.
    pub(super) fn neighbours(&self) -> impl Iterator<Item = (usize, [usize; 2])> + use<> {
        let own = self.rows.own();
        let north = self.rows.north().map(|rank| (rank, [own.start, own.start - 1]));
        let south = self.rows.south().map(|rank| (rank, [own.end - 1, own.end]));
        north.into_iter().chain(south)
    }

    /// Columns and rows of the grid.
    pub fn size(&self) -> Size {
        self.size
    }

    /// Number of tiles.
    pub fn count(&self) -> usize {
        self.across() * (self.cuts.len() - 1)
    }

    /// Number of border cells: those of a tile that lie at its border.
    pub fn border_cells(&self) -> usize {
        self.first[self.count()]
    }

    /// Where a tile lies.
    pub fn window(&self, tile: usize) -> Window {
        let (west, band) = (tile % self.across() * self.tile.columns, tile / self.across());
        Window {
            columns: west..(west + self.tile.columns).min(self.size.columns),
            rows: self.cuts[band]..self.cuts[band + 1],
        }
    }

    /// Tiles from west to east.
    fn across(&self) -> usize {
        self.size.columns.div_ceil(self.tile.columns)
    }

    /// The tile of a cell, given by column and row.
    pub(super) fn tile_of(&self, [x, y]: [usize; 2]) -> usize {
        (self.cuts.partition_point(|&cut| cut <= y) - 1) * self.across() + x / self.tile.columns
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

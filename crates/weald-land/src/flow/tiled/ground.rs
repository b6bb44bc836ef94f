//! The ground of one tile with the cells around it, the sea in it found.

use super::borders::Borders;
use super::settle::{Passed, settle};
use super::tiling::{Tiling, beside};
use crate::flow::surface::{NO_DATA, SEA_LEVEL, Surface};
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::plane::{Plane, Window, read_around};

/// Ground that is read tile by tile.
#[derive(Clone, Copy)]
pub struct TiledGround<'a> {
    /// The tiles.
    pub tiling: &'a Tiling,
    /// Heights in metres, of the size of the tiling.
    pub height: &'a dyn Plane<f32>,
    /// 0 where a cell has no data; every cell has without it.
    pub valid: Option<&'a (dyn Plane<u8> + Sync)>,
}

impl TiledGround<'_> {
    /// Heights of a window with one more cell on every side, [`NO_DATA`] where there is none and beyond the grid.
    fn levels(&self, window: &Window) -> Result<Vec<f32>, Error> {
        let mut levels = read_around(self.height, window, 1, NO_DATA)?;
        let columns = window.columns.len() + 2;
        let inside = window.grown(1, self.tiling.size());
        let place = |cell: [usize; 2]| place(window, 1, cell);
        let valid = self.valid.map(|valid| valid.read(&inside)).transpose()?;
        for (at, (x, y)) in cells(&inside).enumerate() {
            let level = &mut levels[place([x, y])];
            if valid.as_ref().is_some_and(|valid| valid[at] == 0) {
                *level = NO_DATA;
            } else if !level.is_finite() {
                return Err(Error::Run(format!(
                    "the height in column {x}, row {y} is {level}, but must be a finite number; mend it, or mark the cell \
                     as no-data"
                )));
            }
        }
        debug_assert_eq!(levels.len(), columns * (window.rows.len() + 2));
        Ok(levels)
    }

    /// The surface of a tile, the sea at its level. Cells of other tiles are apart, as those without data.
    pub(super) fn surface(&self, tile: usize, sea: Option<&Sea>) -> Result<Surface, Error> {
        let window = self.tiling.window(tile);
        let mut level = self.levels(&window)?;
        if let Some(sea) = sea {
            sea.flood(self.tiling, tile, &mut level);
        }
        let mut elsewhere = vec![false; level.len()];
        for cell in self.tiling.ring_of(tile) {
            let place = place(&window, 1, cell);
            elsewhere[place] = level[place] != NO_DATA;
            level[place] = NO_DATA;
        }
        let stride = window.columns.len() + 2;
        Ok(Surface { size: window.size(), stride, level, elsewhere })
    }
}

/// The place of a cell of the grid in what was read around a window.
pub(super) fn place(window: &Window, margin: usize, [x, y]: [usize; 2]) -> usize {
    (y + margin - window.rows.start) * (window.columns.len() + 2 * margin) + x + margin - window.columns.start
}

/// Column and row of each cell of a window, row by row.
pub(super) fn cells(window: &Window) -> impl Iterator<Item = (usize, usize)> + use<> {
    let columns = window.columns.clone();
    window.rows.clone().flat_map(move |y| columns.clone().map(move |x| (x, y)))
}

/// The sea as far as it is known: which border cells it reaches.
pub(super) struct Sea {
    level: f32,
    reached: Borders<bool>,
}

impl Sea {
    /// Lets the sea in from the borders of the grid and of the data, tile by tile.
    pub(super) fn of(ground: &TiledGround<'_>, level: f64, passed: Passed<'_>) -> Result<Self, Error> {
        let (tiling, level) = (ground.tiling, level as f32);
        let mut reached = Borders::filled(tiling, false);
        settle(tiling, &mut reached, |tile, reached| {
            let window = tiling.window(tile);
            let mut levels = ground.levels(&window)?;
            flood((level, reached), tiling, tile, &mut levels);
            let is_new = |&cell: &[usize; 2]| {
                levels[place(&window, 1, cell)] == SEA_LEVEL && !reached.at(tiling.border(cell))
            };
            let new: Vec<_> = tiling.border_of(tile).into_iter().filter(is_new).collect();
            for &cell in &new {
                reached.set(tiling.border(cell), true);
            }
            passed(window.size().cells())?;
            Ok(beside(tiling, new))
        })?;
        Ok(Self { level, reached })
    }

    fn flood(&self, tiling: &Tiling, tile: usize, levels: &mut [f32]) {
        flood((self.level, &self.reached), tiling, tile, levels);
    }
}

/// Takes what the sea reaches of a tile, and of the cells around it, to its level.
fn flood((sea_level, reached): (f32, &Borders<bool>), tiling: &Tiling, tile: usize, levels: &mut [f32]) {
    let window = tiling.window(tile);
    let Size { columns, rows } = window.size();
    let stride = columns + 2;
    let around = |cell: usize| [cell - stride - 1, cell - 1, cell + stride - 1].map(|first| first..first + 3);
    let is_low = |level: f32| level.is_finite() && level <= sea_level;
    let ring = tiling.ring_of(tile).into_iter();
    for cell in ring.filter(|&cell| reached.at(tiling.border(cell))) {
        levels[place(&window, 1, cell)] = SEA_LEVEL;
    }
    let inner = (1..=rows).flat_map(|y| y * stride + 1..y * stride + 1 + columns);
    let comes_in = |level: &f32| *level == NO_DATA || *level == SEA_LEVEL;
    let is_shore = |cell: usize| around(cell).into_iter().any(|row| levels[row].iter().any(comes_in));
    let mut open: Vec<usize> = inner.filter(|&cell| is_low(levels[cell]) && is_shore(cell)).collect();
    for &cell in &open {
        levels[cell] = SEA_LEVEL;
    }
    let is_inner = |cell: usize| {
        let (x, y) = (cell % stride, cell / stride);
        (1..=columns).contains(&x) && (1..=rows).contains(&y)
    };
    while let Some(cell) = open.pop() {
        for other in around(cell).into_iter().flatten() {
            if is_low(levels[other]) && is_inner(other) {
                levels[other] = SEA_LEVEL;
                open.push(other);
            }
        }
    }
}

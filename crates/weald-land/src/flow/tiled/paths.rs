//! Directions of least deviation, tile by tile.
//!
//! A cell takes its direction when all that may drain to it have theirs. A tile finds what it can by the paths of the cells
//! around it that are known, and is visited again when one is found across its border, as for sums and in tiles as small.

use super::borders::{Borders, Sent};
use super::ground::{cells, place};
use super::planes::{MARGIN, SharedPlane};
use super::settle::{Passed, Visited, settle_side_by_side};
use super::tiling::{Tiling, beside};
use crate::flow::accumulate::set_directions;
use crate::flow::directions::{OUTLET, SEA, opposite};
use crate::flow::fall_lines::FallLines;
use crate::flow::least_deviation::Path;
use crate::flow::surface::{NO_DATA, Surface};
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::plane::{Window, read_around};
use weald_engine::ranks::{Reader, Writer, agreed};

/// The direction of a cell and the path that leaves it, where they are known.
type Found = Option<(u8, Path)>;

impl Sent for u8 {
    fn write(&self, writer: &mut Writer) {
        writer.words(&[u32::from(*self)]);
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, Error> {
        reader.words(1).map(|words| words[0] as u8)
    }
}

/// Only what is known is told.
impl Sent for Found {
    fn write(&self, writer: &mut Writer) {
        let (code, path) = self.unwrap_or_default();
        let bits = path.bits();
        writer.words(&[u32::from(self.is_some()), code.into(), (bits >> 32) as u32, bits as u32]);
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, Error> {
        let words = reader.words(4)?;
        let path = Path::from_bits(u64::from(words[2]) << 32 | u64::from(words[3]));
        Ok((words[0] == 1).then_some((words[1] as u8, path)))
    }
}

/// Puts directions of least deviation in place of those of steepest descent.
pub(super) fn lead(
    tiling: &Tiling,
    filled: &dyn SharedPlane<f32>,
    mut directions: &mut dyn SharedPlane<u8>,
    passed: Passed<'_>,
) -> Result<(), Error> {
    let mut steepest = Borders::filled(tiling, OUTLET);
    let noted = tiling.own().try_for_each(|tile| {
        let window = tiling.window(tile);
        let codes = directions.read(&window)?;
        for cell in tiling.border_of(tile) {
            steepest.set(tiling.border(cell), codes[place(&window, 0, cell)]);
        }
        passed(window.size().cells())
    });
    agreed(tiling.ranks(), noted)?;
    steepest.swap(tiling)?;
    // The directions of a tile stay those of steepest descent until it is done.
    let look = |tile, known: &Borders<Found>, directions: &&mut dyn SharedPlane<u8>| {
        let codes = directions.read(&tiling.window(tile))?;
        let ground = TileOfPaths::read((tiling, &steepest), tile, filled, codes)?;
        Ok(ground.seen(tiling, known))
    };
    let mut found = Borders::filled(tiling, None);
    settle_side_by_side(
        (tiling, &mut found, &mut directions),
        look,
        |tile, seen: Seen, known, directions| {
            let mut changed = Vec::new();
            for (cell, found) in tiling.border_of(tile).into_iter().zip(seen.border) {
                let border = tiling.border(cell);
                if known.at(border).is_none() && found.is_some() {
                    known.set(border, found);
                    changed.push(cell);
                }
            }
            let window = tiling.window(tile);
            if let Some(codes) = &seen.codes {
                directions.write(&window, codes)?;
            }
            passed(window.size().cells())?;
            Ok(Visited { woken: beside(tiling, changed), is_done: seen.codes.is_some() })
        },
    )?;
    Ok(())
}

/// What a look at a tile finds.
struct Seen {
    /// Of its border cells, in their order.
    border: Vec<Found>,
    /// Its codes, where all are known.
    codes: Option<Vec<u8>>,
}

/// A tile and the cells around it.
struct TileOfPaths {
    tile: usize,
    window: Window,
    surface: Surface,
    /// Directions of steepest descent, those of the sea included.
    steepest: Vec<u8>,
    /// Those of cells of the tile and beside it.
    lines: FallLines,
    /// The neighbours from which each cell may receive.
    donors: Vec<u8>,
}

/// Directions and paths of a tile and of the cells around it, as far as they are known.
struct TilePaths {
    /// [`UNKNOWN`] where a cell has none yet.
    codes: Vec<u8>,
    paths: Vec<Path>,
    /// Cells of the tile that wait for others.
    open: usize,
}

/// In place of the code of a cell that waits for others.
const UNKNOWN: u8 = u8::MAX;

impl TilePaths {
    fn at(&self, at: usize) -> Found {
        (self.codes[at] != UNKNOWN).then(|| (self.codes[at], self.paths[at]))
    }

    fn set(&mut self, at: usize, found: Found) {
        if let Some((code, path)) = found {
            (self.codes[at], self.paths[at]) = (code, path);
        }
    }
}

impl TileOfPaths {
    fn read(
        (tiling, steepest_of_borders): (&Tiling, &Borders<u8>),
        tile: usize,
        filled: &dyn SharedPlane<f32>,
        codes: Vec<u8>,
    ) -> Result<Self, Error> {
        let window = tiling.window(tile);
        let level = read_around(filled, &window, MARGIN, NO_DATA)?;
        let Size { columns, rows } = window.size();
        let size = Size { columns: columns + 2, rows: rows + 2 };
        let surface = Surface { size, stride: columns + 2 * MARGIN, level, elsewhere: Vec::new() };
        let mut steepest = vec![OUTLET; surface.cells()];
        let own = cells(&window).map(|(x, y)| [x, y]).zip(codes);
        let ring = tiling.ring_of(tile).into_iter();
        let ring = ring.map(|cell| (cell, steepest_of_borders.at(tiling.border(cell))));
        for (cell, code) in own.chain(ring) {
            steepest[place(&window, MARGIN, cell)] = code;
        }
        let on_land: Vec<u8> = steepest.iter().map(|&code| if code == SEA { OUTLET } else { code }).collect();
        let lines = FallLines::of(&surface, &on_land);
        let donors = lines.donors(&surface);
        Ok(Self { tile, window, surface, steepest, lines, donors })
    }

    fn place(&self, cell: [usize; 2]) -> usize {
        place(&self.window, MARGIN, cell)
    }

    fn seen(&self, tiling: &Tiling, known: &Borders<Found>) -> Seen {
        let paths = self.paths(tiling, known);
        let border = tiling.border_of(self.tile).into_iter().map(|cell| paths.at(self.place(cell)));
        let code = |(x, y)| self.code(self.place([x, y]), &paths);
        let codes = (paths.open == 0).then(|| cells(&self.window).map(code).collect());
        Seen { border: border.collect(), codes }
    }

    /// The code as it is written.
    fn code(&self, at: usize, paths: &TilePaths) -> u8 {
        if self.steepest[at] == SEA { SEA } else { paths.codes[at] }
    }

    /// What is known of the tile, by what is known of the border cells around it.
    fn paths(&self, tiling: &Tiling, known: &Borders<Found>) -> TilePaths {
        let cells_in_all = self.steepest.len();
        let (codes, open) = (vec![UNKNOWN; cells_in_all], self.window.size().cells());
        let mut paths = TilePaths { codes, paths: vec![Path::default(); cells_in_all], open };
        for cell in tiling.ring_of(self.tile) {
            paths.set(self.place(cell), known.at(tiling.border(cell)));
        }
        let (mut waiting, mut ready) = (vec![u8::MAX; cells_in_all], Vec::new());
        for at in cells(&self.window).map(|(x, y)| self.place([x, y])) {
            let waits = |&direction: &usize| paths.codes[self.beside(at, direction)] == UNKNOWN;
            waiting[at] = set_directions(self.donors[at]).filter(waits).count() as u8;
            ready.extend((waiting[at] == 0).then_some(at));
        }
        while let Some(at) = ready.pop() {
            paths.set(at, Some(self.through(at, &paths)));
            paths.open -= 1;
            for next in set_directions(self.lines.receivers[at]).map(|direction| self.beside(at, direction)) {
                // Cells of other tiles keep their mark.
                if waiting[next] != u8::MAX {
                    waiting[next] -= 1;
                    ready.extend((waiting[next] == 0).then_some(next));
                }
            }
        }
        paths
    }

    /// The code and the path of a cell to which all that may drain are known.
    fn through(&self, at: usize, paths: &TilePaths) -> (u8, Path) {
        let arriving = set_directions(self.donors[at]).filter_map(|direction| {
            let donor = self.beside(at, direction);
            let (code, path) = paths.at(donor)?;
            (code == opposite(direction as u8) + 1).then_some((path, donor))
        });
        Path::through(&self.lines, at, arriving, |donor| self.surface.level[donor])
    }

    fn beside(&self, at: usize, direction: usize) -> usize {
        self.surface.neighbour(at, direction as u8 + 1)
    }
}

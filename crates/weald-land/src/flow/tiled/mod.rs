//! Flow routing over ground that is not in memory: tile by tile, to the bit as [`route`](super::route()) and the sums do it
//! with the whole.
//!
//! That is possible since nothing in the whole depends on an order of cells. The level of a filled cell is the least height
//! that its way out must pass, whoever finds it. Its direction follows from the levels of its neighbours and, over flat
//! ground, from two lengths of shortest ways; with least deviation also from the paths that come. Its sum adds those of its
//! donors in the order of directions. Tiles are read one after another, each with the cells around it:
//!
//! | file | what is known at the borders of tiles | tiles are read |
//! |---|---|---|
//! | `ground` | where the sea is | until it reaches no further |
//! | `spills` | how high each basin at a border fills, by a graph of saddles (Barnes 2016) | twice |
//! | `flats` | distances over flat ground | until none is shorter, and once more |
//! | `paths` | finished paths of least deviation | in small tiles, until all are finished |
//! | `sums` | finished sums | in small tiles, until all are finished |
//!
//! Over ranks each visits the tiles of its own rows, with the rows around them from its neighbours. The first has the graph of
//! all borders, and tells each the levels of its own; what settles goes from rank to rank after each has done what it can.
//!
//! Barnes, R. 2016, "Parallel priority-flood depression filling for trillion cell DEMs on desktops or clusters", doi
//! 10.1016/j.cageo.2016.07.001; 2017, "Parallel non-divergent flow accumulation for trillion cell digital elevation models on
//! desktops or clusters", doi 10.1016/j.envsoft.2017.02.022. Differs: basins are found by descent as in the whole, not by a
//! queue; flats, paths and sums pass tiles until they settle, since a graph of the distances within a flat is larger than a tile,
//! and since sums of weights that are no whole numbers depend on their order.

mod borders;
mod flats;
mod ground;
mod paths;
mod planes;
mod settle;
mod spills;
mod sums;
mod tiling;

pub use ground::TiledGround;
pub use planes::{MARGIN, SharedPlane, StoredCodes, StoredFlags};
pub use settle::Passed;
pub use sums::{PutSums, TiledFlow, accumulate_tiled};
pub use tiling::{SMALL_TILE, Tiling};

use super::{Depressions, DirectionRule, Routing};
use flats::FlatDistances;
use ground::Sea;
use spills::{SpillGraph, TileBasins};
use weald_core::error::Error;
use weald_core::plane::{Plane, Window};
use weald_engine::ranks::agreed;

/// Leads water over the ground, to the bit as [`route`](super::route()): writes the surface without depressions and the codes
/// of [`directions`](super::directions). All ranks that share the tiling call it together.
///
/// Memory: some 40 bytes for a cell of a tile, and up to 100 for each border cell of all tiles, which is where the graph is.
/// Each tile is read and its basins found twice; the other visits, of which flats and a sea that cross many tiles need
/// several, are cheaper. Paths pass the small tiles of [`Tiling::finer`], with 30 bytes for each border cell of those.
///
/// # Errors
/// Those of the planes and of `passed`; [`Error::Run`] for a height that is not finite, and for [`Depressions::Breach`], which
/// cuts channels across any number of tiles.
pub fn route_tiled(
    ground: &TiledGround<'_>,
    routing: &Routing,
    (filled, directions): (&mut dyn SharedPlane<f32>, &mut dyn SharedPlane<u8>),
    passed: Passed<'_>,
) -> Result<(), Error> {
    if routing.depressions == Depressions::Breach {
        return Err(Error::Run(
            "channels through the rims of depressions are not cut tile by tile; choose `depressions = \"fill\"`, or a \
             landscape that fits into memory"
                .to_owned(),
        ));
    }
    let (tiling, ranks) = (ground.tiling, ground.tiling.ranks());
    fill(ground, routing, filled, passed)?;
    filled.swap(ranks)?;
    let distances = FlatDistances::of(tiling, filled, passed)?;
    let led = each_tile(tiling, |tile, window| {
        directions.write(window, &distances.directions(tile, filled)?)?;
        passed(window.size().cells())
    });
    agreed(ranks, led)?;
    drop(distances);
    if routing.directions == DirectionRule::LeastDeviation {
        paths::lead(&tiling.finer(), filled, directions, passed)?;
    }
    directions.swap(ranks)?;
    let finished = each_tile(tiling, |_, window| {
        finish(ground, window, filled)?;
        passed(window.size().cells())
    });
    agreed(ranks, finished)?;
    filled.swap(ranks)
}

/// Visits each tile of this rank once.
fn each_tile(
    tiling: &Tiling,
    mut visit: impl FnMut(usize, &Window) -> Result<(), Error>,
) -> Result<(), Error> {
    tiling.own().try_for_each(|tile| visit(tile, &tiling.window(tile)))
}

/// Writes the levels of all cells, those of the sea and without data as infinite ones.
fn fill(
    ground: &TiledGround<'_>,
    routing: &Routing,
    filled: &mut dyn Plane<f32>,
    passed: Passed<'_>,
) -> Result<(), Error> {
    let (tiling, ranks) = (ground.tiling, ground.tiling.ranks());
    let sea = routing.sea_level.map(|level| Sea::of(ground, level, passed)).transpose()?;
    let basins = |tile| ground.surface(tile, sea.as_ref()).map(TileBasins::of);
    let mut graph = SpillGraph::new(tiling);
    let added = each_tile(tiling, |tile, window| {
        graph.add(tile, &basins(tile)?);
        passed(window.size().cells())
    });
    agreed(ranks, added)?;
    let spills = graph.solved()?;
    let written = each_tile(tiling, |tile, window| {
        let surface = spills.filled(tile, basins(tile)?);
        filled.write(window, &surface.inner(&surface.level, |_, level| level))?;
        passed(window.size().cells())
    });
    agreed(ranks, written)
}

/// Puts heights where levels of a tile are infinite.
fn finish(ground: &TiledGround<'_>, window: &Window, filled: &mut dyn Plane<f32>) -> Result<(), Error> {
    let mut levels = filled.read(window)?;
    if levels.iter().all(|level| level.is_finite()) {
        return Ok(());
    }
    let heights = ground.height.read(window)?;
    for (level, height) in levels.iter_mut().zip(heights) {
        *level = if level.is_infinite() { height } else { *level };
    }
    filled.write(window, &levels)
}

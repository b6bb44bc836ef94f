//! The `[landscape]` table: what the ground starts from.

use std::path::PathBuf;

use super::super::layer_file::{FileUnit, said};
use super::files::Files;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::parameter::{CrsCode, Diagnostics, Parameters, RasterFile, Sides};
use weald_core::source::{Node, Table, Value};
use weald_io::Said;

weald_core::parameters! {
    /// The keys of `[landscape]`.
    pub struct LandscapeKeys {
        /// Cells a side, or [columns, rows]; at most 2^28 cells in all, but for runs out of core. Not with `from`.
        size: Option<Sides> = None;
        /// Side of a cell; 1 m where none is given. With `from`, only for a file that does not say it.
        cell: Option<f64> = None, range 0.001..=100_000.0, unit "m";
        /// Cells a side, or [columns, rows], of the finest grid on which this landscape will be made. The first steps, as
        /// long as they generate or combine layers, run on it and a cell has the mean, so that a coarse landscape is the
        /// mean of a fine one. `--size` and `--preview` set it to the recipe's own size where they make that coarser.
        finest: Option<Sides> = None, with size;
        /// Seed of all random numbers. Steps of the same kind draw from different numbers.
        seed: u64 = 0, range 0..=9_007_199_254_740_991_u64;
        /// Height of the sea. Ground no higher that is connected to the border by such ground is under water: rivers and
        /// erosion end there, and it stands in the layer `water`. Default: there is no sea.
        sea_level: Option<f64> = None, range -20_000.0..=20_000.0, unit "m";
        /// An elevation model to start from instead of a size, relative to the recipe's folder. It becomes the
        /// layer `height`; its cell size, georeferencing and no-data cells are kept.
        from: Option<RasterFile> = None;
        /// Coordinate reference system of a file that names none.
        crs: Option<CrsCode> = None, with from;
        /// Unit of the heights of a file that names none; without it they are metres.
        unit: Option<FileUnit> = None, with from;
        /// Number of the cells without data, as `weald info` shows it, in a file that does not say it.
        nodata: Option<f64> = None, with from;
    }
}

/// What a landscape starts from.
#[derive(Clone, Debug, PartialEq)]
pub enum Ground {
    /// Nothing yet: a generator makes the ground.
    Empty {
        /// Columns and rows.
        size: Size,
        /// Side of a cell in metres.
        cell: f64,
        /// The grid on which ground is generated, where that is a finer one.
        finest: Option<Size>,
    },
    /// An elevation model, which becomes the layer `height`.
    File {
        /// The file.
        path: PathBuf,
        /// Side of a cell in metres, for a file that does not say it.
        cell: Option<f64>,
        /// What else it does not say.
        said: Said,
    },
}

/// The table as read; a ground over the size limit is an error of its own.
pub(super) struct Start {
    pub(super) ground: Result<Ground, Error>,
    pub(super) seed: u64,
    pub(super) sea_level: Option<f64>,
}

pub(super) fn read(files: Files<'_>, recipe: &Table, diagnostics: &mut Diagnostics) -> Start {
    "landscape".clone_into(&mut diagnostics.subject);
    let absent = Table { line: 1, entries: Vec::new() };
    let table = match recipe.get("landscape").map(|node| (&node.value, node.line)) {
        Some((Value::Table(table), _)) => table,
        Some((other, line)) => {
            diagnostics.add(line, format!("is {}, but must be a table: [landscape]", other.shown()));
            let size = Size { columns: 1, rows: 1 };
            return Start {
                ground: Ok(Ground::Empty { size, cell: 1.0, finest: None }),
                seed: 0,
                sea_level: None,
            };
        }
        None if is_needless(recipe) => {
            let size = Size { columns: 1, rows: 1 };
            return Start {
                ground: Ok(Ground::Empty { size, cell: 1.0, finest: None }),
                seed: 0,
                sea_level: None,
            };
        }
        None => &absent,
    };
    let table = files.placed(table, &LandscapeKeys::parameters(), diagnostics);
    let keys = LandscapeKeys::read(&table, diagnostics);
    Start { seed: keys.seed, sea_level: keys.sea_level, ground: ground(&table, &keys, diagnostics) }
}

/// Whether a recipe of fractals alone has nothing to do with a landscape.
fn is_needless(recipe: &Table) -> bool {
    let is_of_a_fractal =
        |node: &Node| matches!(&node.value, Value::Table(table) if table.get("fractal").is_some());
    let outputs = match recipe.get("output").map(|node| &node.value) {
        Some(Value::List(items)) => items.as_slice(),
        _ => &[],
    };
    recipe.get("step").is_none() && !outputs.is_empty() && outputs.iter().all(is_of_a_fractal)
}

fn ground(table: &Table, keys: &LandscapeKeys, diagnostics: &mut Diagnostics) -> Result<Ground, Error> {
    let Some(from) = &keys.from else {
        if table.get("size").is_none() && table.get("from").is_none() {
            diagnostics.add(table.line, "`size` is needed (cells a side, or [columns, rows]), or `from`");
        }
        let sides = keys.size.unwrap_or(Sides { columns: 1, rows: 1 });
        let [columns, rows] = sides_of(sides);
        let size = Size::on_disk(columns, rows)?;
        let finest = keys.finest.map(|finest| finest_of(size, finest)).transpose()?;
        if let Some(problem) = finest.and_then(|finest| unfit(size, finest)) {
            diagnostics.add(table.get("finest").map_or(table.line, |node| node.line), problem);
        }
        return Ok(Ground::Empty { size, cell: keys.cell.unwrap_or(1.0), finest });
    };
    if keys.size.is_some() {
        let message = "`size` does not go with `from`: it comes from the file; a `resample` step changes it";
        diagnostics.add(table.get("size").map_or(table.line, |node| node.line), message);
    }
    Ok(Ground::File { path: from.path(), cell: keys.cell, said: said(keys.crs, keys.unit, keys.nodata) })
}

fn sides_of(sides: Sides) -> [usize; 2] {
    [sides.columns, sides.rows].map(|side| usize::try_from(side).unwrap_or(usize::MAX))
}

/// The finest grid; one number is its longer side.
fn finest_of(size: Size, finest: Sides) -> Result<Size, Error> {
    let longer = size.columns.max(size.rows) as f64;
    let finest = if finest.columns == finest.rows {
        let scaled = |side: usize| (side as f64 * finest.columns as f64 / longer).round().max(1.0) as u64;
        Sides { columns: scaled(size.columns), rows: scaled(size.rows) }
    } else {
        finest
    };
    let [columns, rows] = sides_of(finest);
    Size::new(columns, rows)
}

/// What is wrong with a finest grid.
fn unfit(size: Size, finest: Size) -> Option<String> {
    let factor = finest.columns as f64 / size.columns as f64;
    if factor < 1.0 {
        return Some(format!("`finest` is {finest} cells, but must be at least `size`, {size}"));
    }
    let rows = size.rows as f64 * factor;
    let oblong = (rows - finest.rows as f64).abs() >= factor.max(1.0);
    oblong.then(|| {
        format!("`finest` is {finest} cells, but must have the proportion of `size`, {size}: {rows:.0} rows")
    })
}

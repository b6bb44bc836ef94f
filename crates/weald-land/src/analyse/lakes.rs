//! Lakes: where water stands, how high and deep, and as outlines with islands.
//!
//! A depression fills to its lowest rim; one that is large and deep enough holds a lake. Or a lake is where a
//! simulation left water.

mod outline;
mod step;

pub use step::{ENTRY, LakesStep, Source};

pub use outline::Polygon;
use std::collections::BTreeMap;

use crate::flow::directions::Directions;
use crate::flow::{Routing, accumulate, route};
use outline::outlines;
use weald_core::error::Error;
use weald_core::landscape::Landscape;

/// The lakes of a landscape.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lakes {
    /// All lakes in the order of their numbers.
    pub lakes: Vec<Lake>,
}

/// A lake.
#[derive(Clone, Debug, PartialEq)]
pub struct Lake {
    /// Its number in the layer `lake`, from 1, the largest first.
    pub number: u32,
    /// Height of its surface in metres.
    pub level: f64,
    /// Area in m².
    pub area: f64,
    /// Volume in m³.
    pub volume: f64,
    /// Greatest depth in metres.
    pub deepest: f64,
    /// Column and row of the cell over which it drains: the first beyond the lake on its flow path, or
    /// the last of the lake where that is at the border. `None` where no water leaves.
    pub outlet: Option<[usize; 2]>,
    /// Its outline along the edges of cells.
    pub polygons: Vec<Polygon>,
}

impl Lakes {
    /// Reads the lakes out of the layers that the step `lakes` writes: `lake`, `lake_level` and `lake_depth`.
    /// Where they drain is read from the layer `flow_direction`, or found from `height` where it is missing.
    ///
    /// # Errors
    /// [`Error::Run`] for a layer that is missing, a number of a lake that is none, or directions that lead
    /// nowhere.
    pub fn of(landscape: &Landscape) -> Result<Self, Error> {
        let domain = &landscape.domain;
        let numbers = numbers(landscape)?;
        let (level, depth) = (landscape.field("lake_level")?, landscape.field("lake_depth")?);
        let mut cells: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (cell, &number) in numbers.iter().enumerate().filter(|(_, number)| **number > 0) {
            cells.entry(number).or_default().push(cell);
        }
        if cells.is_empty() {
            return Ok(Self::default());
        }
        let outlets = Outlets::of(landscape)?;
        let mut polygons = outlines(domain.size, domain.cell, &numbers);
        let lakes = cells.into_iter().map(|(number, cells)| {
            let depths = || cells.iter().map(|&cell| f64::from(depth.values()[cell]));
            Lake {
                number,
                level: f64::from(level.values()[cells[0]]),
                area: cells.len() as f64 * domain.cell_area(),
                volume: depths().sum::<f64>() * domain.cell_area(),
                deepest: depths().fold(0.0, f64::max),
                outlet: outlets.of_lake(&numbers, &cells),
                polygons: polygons.remove(&number).unwrap_or_default(),
            }
        });
        Ok(Self { lakes: lakes.collect() })
    }
}

/// The number of the lake in each cell; 0 where there is none or no data.
pub(super) fn numbers(landscape: &Landscape) -> Result<Vec<u32>, Error> {
    let land = landscape.domain.valid.as_ref();
    let field = landscape.field("lake")?;
    let number = |(cell, &value): (usize, &f32)| match value {
        _ if land.is_some_and(|valid| !valid.is_valid_at(cell)) => Ok(0),
        value if value >= 0.0 && value <= MAX_LAKES as f32 && value.fract() == 0.0 => Ok(value as u32),
        value => {
            let (x, y) = (cell % field.size().columns, cell / field.size().columns);
            Err(Error::Run(format!(
                "the layer `lake` is {value} in column {x}, row {y}, but must be the number of a lake, 0 to \
                 {MAX_LAKES}; make it with the step `lakes`"
            )))
        }
    };
    field.values().iter().enumerate().map(number).collect()
}

/// Most lakes that a layer can number: whole numbers of `f32` are exact up to here.
pub(super) const MAX_LAKES: u32 = 1 << 24;

/// Which way water takes, and how much.
struct Outlets {
    directions: Directions,
    upslope: Vec<f64>,
}

impl Outlets {
    fn of(landscape: &Landscape) -> Result<Self, Error> {
        let land = landscape.domain.valid.as_ref();
        let directions = match landscape.field("flow_direction") {
            Ok(layer) => Directions::of(layer, land)?,
            Err(_) => route(landscape.field("height")?, land, &Routing::default()).directions,
        };
        let upslope = accumulate(&directions, land, None);
        Ok(Self { directions, upslope })
    }

    /// Of all ways out of a lake the one that most water takes.
    fn of_lake(&self, numbers: &[u32], cells: &[usize]) -> Option<[usize; 2]> {
        let number = numbers[cells[0]];
        let leaves = |cell: usize| match self.directions.downstream(cell) {
            None if self.directions.is_sea(cell) => None,
            None => Some((self.upslope[cell], cell)),
            Some(next) => (numbers[next] != number).then(|| (self.upslope[cell], next)),
        };
        // Of two that carry the same, the one further north and west.
        let most = cells.iter().rev().filter_map(|&cell| leaves(cell)).max_by(|a, b| a.0.total_cmp(&b.0))?;
        let columns = self.directions.size().columns;
        Some([most.1 % columns, most.1 / columns])
    }
}

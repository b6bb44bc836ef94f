//! The step `lakes`.

use std::collections::BTreeMap;

use rayon::prelude::*;

use super::MAX_LAKES;
use crate::analyse::stages::Stages;
use crate::analyse::{CELLS_PER_TASK, ensure_finite};
use crate::flow::{Routing, STAGES, route_watched};
use weald_core::connected::components;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::{choices, parameters};
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<LakesStep>(
    "lakes",
    Stage::Analyse,
    "finds lakes, their levels and depths",
    "Barnes, Lehman and Mulla 2014",
);

choices! {
    /// Where the water of lakes comes from.
    pub enum Source {
        /// Depressions are full to the lowest point of their rims.
        Depressions = "depressions",
        /// A simulation left it.
        Water = "water",
    }
}

parameters! {
    /// Lakes.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::lakes::LakesStep;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(12, 12)?, 10.0)); // columns, rows, metres
    /// let hollow = |x, y| if (3..9).contains(&x) && (3..9).contains(&y) { 40.0 } else { 45.0 };
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, hollow));
    /// LakesStep::default().run(&mut landscape, &Job::unwatched(0))?;
    /// let depth = landscape.field("lake_depth")?;
    /// assert_eq!((depth.at(5, 5), depth.at(1, 1)), (5.0, 0.0), "full to the rim, and no further");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct LakesStep {
        /// Layer of the height of the ground.
        of: LayerName = LayerName::of("height");
        /// Whether depressions are full to their rims, or hold the water that a simulation left.
        from: Source = Source::Depressions;
        /// Layer of the depth of water.
        water: LayerName = LayerName::of("water"), when from = "water";
        /// Shallower water counts as overland flow, not as a lake.
        shallowest: f64 = 0.1, range 0.0..=1000.0, unit "m", when from = "water";
        /// Least greatest depth: shallower lakes are left out.
        depth: f64 = 1.0, range 0.0..=1.0e6, unit "m";
        /// Least area: smaller lakes are left out. Without it, those of fewer than 12 cells.
        area: Option<f64> = None, range 0.0..=1.0e15, unit "m²";
        /// Height of the sea, which is no lake. Default: that of the landscape.
        sea_level: Option<f64> = None, range -1.0e6..=1.0e6, unit "m";
    }
}

/// Fewer cells than this are a puddle, unless `area` says otherwise.
const MIN_LAKE_CELLS: f64 = 12.0;

impl Step for LakesStep {
    fn reads(&self) -> Vec<String> {
        let water = (self.from == Source::Water).then(|| self.water.0.clone());
        std::iter::once(self.of.0.clone()).chain(water).collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![("lake".to_owned(), "1"), ("lake_level".to_owned(), "m"), ("lake_depth".to_owned(), "m")]
    }

    fn range(&self, layer: &str) -> Option<(f64, f64)> {
        Some(match layer {
            "lake" => (0.0, f64::from(MAX_LAKES)),
            "lake_depth" => (0.0, f64::INFINITY),
            _ => (f64::NEG_INFINITY, f64::INFINITY),
        })
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        for name in self.reads() {
            ensure_finite(landscape, &name)?;
        }
        let ground = landscape.field(&self.of.0)?;
        let mut stages = Stages::of(job, STAGES + 1, ground.size().cells());
        let surface = self.surface(landscape, &mut stages)?;
        let lakes = self.large_enough(landscape, ground, &surface);
        stages.passed()?;
        let mut number = Field::filled(ground.size(), 0.0);
        let (mut level, mut depth) = (ground.clone(), number.clone());
        for (at, cells) in lakes.iter().enumerate().take(MAX_LAKES as usize) {
            let mean = mean_level(cells, &surface);
            for &cell in cells {
                number.values_mut()[cell] = (at + 1) as f32;
                level.values_mut()[cell] = mean;
                depth.values_mut()[cell] = (mean - ground.values()[cell]).max(0.0);
            }
        }
        landscape.insert("lake", "1", number);
        landscape.insert("lake_level", "m", level);
        landscape.insert("lake_depth", "m", depth);
        let measures = BTreeMap::from([("lakes", lakes.len() as f64)]);
        Ok(Outcome { iterations: 1, measures, ..Outcome::default() })
    }
}

impl LakesStep {
    /// Height of the surface of standing water in each cell; that of the ground where there is none.
    fn surface(&self, landscape: &Landscape, stages: &mut Stages<'_>) -> Result<Vec<f32>, Error> {
        let land = landscape.domain.valid.as_ref();
        let ground = landscape.field(&self.of.0)?;
        let routing =
            Routing { sea_level: self.sea_level.or(landscape.domain.sea_level), ..Routing::default() };
        let routed = route_watched(ground, land, &routing, &mut || stages.passed())?;
        let water = match self.from {
            Source::Depressions => None,
            Source::Water => Some(landscape.field(&self.water.0)?.values()),
        };
        let surface = |(cell, &ground): (usize, &f32)| match water {
            _ if routed.directions.is_sea(cell) || land.is_some_and(|valid| !valid.is_valid_at(cell)) => {
                ground
            }
            None => routed.surface.values()[cell],
            Some(depth) if f64::from(depth[cell]) > self.shallowest => ground + depth[cell],
            Some(_) => ground,
        };
        let cells = ground.values().par_iter().enumerate().with_min_len(CELLS_PER_TASK);
        Ok(cells.map(surface).collect())
    }

    /// Connected water that is a lake, the largest first.
    fn large_enough(&self, landscape: &Landscape, ground: &Field, surface: &[f32]) -> Vec<Vec<usize>> {
        let domain = &landscape.domain;
        let least_cells = self.area.map_or(MIN_LAKE_CELLS, |area| area / domain.cell_area());
        let cells = surface.par_iter().zip(ground.values()).with_min_len(CELLS_PER_TASK);
        let depth: Vec<f32> = cells.map(|(surface, ground)| surface - ground).collect();
        let wet: Vec<bool> =
            depth.par_iter().with_min_len(CELLS_PER_TASK).map(|depth| *depth > 0.0).collect();
        let mut lakes = components(domain.size, &wet);
        lakes.retain(|cells| {
            let deepest = cells.iter().map(|&cell| depth[cell]).fold(0.0, f32::max);
            cells.len() as f64 >= least_cells && f64::from(deepest) > self.depth
        });
        // Of two of the same size, the one further north and west.
        lakes.sort_by_key(|cells| std::cmp::Reverse(cells.len()));
        lakes
    }
}

/// Height of the surface of a lake: that of its water on average, which is the same in all cells of a full
/// depression.
fn mean_level(cells: &[usize], surface: &[f32]) -> f32 {
    let first = f64::from(surface[cells[0]]);
    let above_first: f64 = cells.iter().map(|&cell| f64::from(surface[cell]) - first).sum();
    (first + above_first / cells.len() as f64) as f32
}

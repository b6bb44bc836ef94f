//! The step `flow` on a landscape of which this process has its own rows: tile by tile, to the bit as in memory.

use std::collections::BTreeSet;
use std::sync::Arc;

use super::{FlowStep, MILLIMETRES_PER_YEAR, Method};
use crate::flow::directions::SEA;
use crate::flow::tiled::{
    MARGIN, Passed, SMALL_TILE, SharedPlane, StoredCodes, StoredFlags, TiledFlow, TiledGround, Tiling,
    accumulate_tiled, route_tiled,
};
use crate::flow::{Depressions, DirectionRule};
use weald_core::error::{Error, Limit, Quantity};
use weald_core::file_plane::VALUE;
use weald_core::grid::{MAX_CELLS, Size};
use weald_core::plane::{Plane, Window};
use weald_engine::Job;
use weald_engine::ranks::{agreed, any};
use weald_engine::step::{Outcome, Step};
use weald_engine::stored::{StoredLandscape, StoredPlane};

/// Bytes of memory for a cell of a tile, and for a border cell of all tiles, as measured.
const A_CELL: u64 = 100;
const A_BORDER_CELL: u64 = 100;

/// Bytes for a border cell of small tiles.
const A_SMALL_BORDER_CELL: u64 = 40;

/// Visits that every cell has before the sums: two for basins, one for flats, one for directions, one for heights.
const VISITS: u64 = 5;

/// Visits that cells have for paths of least deviation and for each sum, in small tiles: as measured on eroded ground.
const VISITS_OF_PATHS: u64 = 9;
const VISITS_OF_SUMS: u64 = 6;

/// Square tiles as large as the memory holds them, with the borders of all.
fn tiling(landscape: &StoredLandscape<'_>) -> Result<Tiling, Error> {
    let (memory, columns, rows) = (landscape.memory, landscape.domain.size.columns, landscape.rows());
    let of = |side: Size| Tiling::over((columns, rows), side, &landscape.ranks);
    let cells = columns as u64 * rows.most() as u64;
    let whole =
        A_CELL * cells + A_BORDER_CELL * (2 * (columns + rows.most()) * landscape.ranks.count()) as u64;
    if whole <= memory && cells <= MAX_CELLS as u64 {
        return of(Size { columns, rows: rows.most() });
    }
    let side = ((memory / (2 * A_CELL)).min(MAX_CELLS as u64) as f64).sqrt() as usize;
    let tiling = of(Size { columns: side.max(1), rows: side.max(1) })?;
    let needed = A_CELL * (side * side) as u64 + A_BORDER_CELL * tiling.border_cells() as u64;
    // Large tiles are done when small ones are visited.
    let needed = needed.max(A_SMALL_BORDER_CELL * tiling.finer().border_cells() as u64);
    if needed <= memory {
        return Ok(tiling);
    }
    let limit = Limit::new(Quantity::MemoryBytes, needed, 0..=memory)
        .of(format!("`flow` over {} cells in tiles", landscape.domain.size));
    Err(limit.remedy("allow more memory").into())
}

impl FlowStep {
    /// Bytes on disk for a cell beside the layers, or what of the keys needs the whole in memory.
    pub(super) fn scratch(&self, wanted: &BTreeSet<String>) -> Result<u64, String> {
        match self.depressions {
            Depressions::Breach => Err("`depressions = \"breach\"` needs the landscape in memory".to_owned()),
            Depressions::Fill => {
                // All of them are made, whether or not anything needs them later.
                let filled = self.filled.as_ref().map(|name| name.0.as_str());
                let discharge = self.weight.as_ref().map(|_| Some("discharge"));
                let made =
                    [filled, Some("flow_direction"), Some("accumulation")].into_iter().chain(discharge);
                let unwanted = made.filter(|name| name.is_none_or(|name| !wanted.contains(name)));
                Ok(VALUE * unwanted.count() as u64)
            }
        }
    }

    /// Runs on a landscape on disk.
    pub(super) fn run_by_tiles(
        &self,
        landscape: &mut StoredLandscape<'_>,
        job: &Job<'_>,
    ) -> Result<Outcome, Error> {
        let ranks = Arc::clone(&landscape.ranks);
        let tiling = tiling(landscape)?;
        let by_paths = u64::from(self.directions == DirectionRule::LeastDeviation);
        let summed = 1 + u64::from(self.weight.is_some());
        let own = (landscape.domain.size.columns * landscape.rows().own().len()) as u64;
        let (least, mut visits) = ((VISITS + VISITS_OF_PATHS * by_paths + VISITS_OF_SUMS * summed) * own, 0);
        let passed = &mut |cells: usize| {
            visits += cells as u64;
            // Tiles that flats or rivers cross often are visited again, how often is not known before: then all seem to be
            // left once more.
            let all = if visits < least { least } else { visits + own };
            let small_tiles = |cells: u64| cells.div_ceil((SMALL_TILE * SMALL_TILE) as u64);
            job.watcher.progress(small_tiles(visits), small_tiles(all), 0);
            if job.watcher.cancelled() {
                Err(Error::Interrupted("interrupted between two tiles".to_owned()))
            } else {
                Ok(())
            }
        };
        for name in self.reads() {
            landscape.layer_mut(&name)?.plane.swap(&*ranks)?;
        }
        let flags = landscape.valid_around(MARGIN)?;
        let flags = flags.as_deref().map(StoredFlags);
        let valid = flags.as_ref().map(|flags| flags as &(dyn Plane<u8> + Sync));
        let mut filled = landscape.plane("filled")?;
        let mut codes = StoredCodes(landscape.plane("flow_direction")?);
        let height = &landscape.layer(&self.of.0)?.plane;
        let ground = TiledGround { tiling: &tiling, height, valid };
        route_tiled(&ground, &self.routing(&landscape.domain), (&mut filled, &mut codes), passed)?;
        let shared =
            (self.method == Method::Multiple).then_some((&filled as &(dyn Plane<f32> + Sync), self.exponent));
        let flow = TiledFlow { tiling: &tiling, directions: &codes, valid, weight: None, shared };
        let area = landscape.domain.cell_area();
        let areas = summed_layer(landscape, ("accumulation", area), &flow, passed)?;
        let discharge = match &self.weight {
            None => None,
            Some(runoff) => {
                let weight = Some(&landscape.layer(&runoff.0)?.plane as &(dyn Plane<f32> + Sync));
                let unit = area * MILLIMETRES_PER_YEAR;
                Some(summed_layer(landscape, ("discharge", unit), &TiledFlow { weight, ..flow }, passed)?)
            }
        };
        let note = self.note_of_sea(landscape, &codes.0)?;
        landscape.insert("flow_direction", "1", codes.0);
        landscape.insert("accumulation", "m²", areas);
        if let Some(discharge) = discharge {
            landscape.insert("discharge", "m³/s", discharge);
        }
        if let Some(name) = &self.filled {
            landscape.insert(&name.0, "m", filled);
        }
        Ok(Outcome { iterations: 1, notes: note.into_iter().collect(), ..Outcome::default() })
    }

    /// What is reported where all ground is sea.
    fn note_of_sea(
        &self,
        landscape: &StoredLandscape<'_>,
        codes: &StoredPlane,
    ) -> Result<Option<String>, Error> {
        let Some(level) = self.sea_level(&landscape.domain) else { return Ok(None) };
        let ranks = &*landscape.ranks;
        let has_land = any(ranks, agreed(ranks, has_land(codes, landscape.valid()))?)?;
        Ok((!has_land).then(|| super::all_sea(level)))
    }
}

/// A layer of sums, each of which is so much in its unit.
fn summed_layer(
    landscape: &StoredLandscape<'_>,
    (name, unit): (&str, f64),
    flow: &TiledFlow<'_>,
    passed: Passed<'_>,
) -> Result<StoredPlane, Error> {
    let mut layer = landscape.plane(name)?;
    let put = &mut |window: &Window, sums: &[f64]| {
        layer.write(window, &sums.iter().map(|sum| (sum * unit) as f32).collect::<Vec<_>>())
    };
    accumulate_tiled(flow, put, passed)?;
    Ok(layer)
}

/// Whether any of its own cells is no sea.
fn has_land(codes: &StoredPlane, valid: Option<&StoredPlane>) -> Result<bool, Error> {
    for rows in codes.runs_of_rows() {
        let valid = valid.map(|valid| valid.rows(rows.clone())).transpose()?;
        let has_data = |at: usize| valid.as_ref().is_none_or(|valid| valid[at] > 0.0);
        let mut codes = codes.rows(rows)?.into_iter().enumerate();
        if codes.any(|(at, code)| has_data(at) && code != f32::from(SEA)) {
            return Ok(true);
        }
    }
    Ok(false)
}

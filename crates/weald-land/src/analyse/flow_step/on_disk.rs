//! The step `flow` on a landscape that lies on disk: tile by tile, to the bit as in memory.

use std::collections::BTreeSet;

use super::{FlowStep, MILLIMETRES_PER_YEAR, Method};
use crate::flow::directions::SEA;
use crate::flow::tiled::{TiledFlow, TiledGround, Tiling, accumulate_tiled, route_tiled};
use crate::flow::{Depressions, DirectionRule};
use weald_core::error::{Error, Limit, Quantity};
use weald_core::file_plane::{FilePlane, VALUE};
use weald_core::grid::{MAX_CELLS, Size};
use weald_core::plane::{Plane, Window};
use weald_engine::Job;
use weald_engine::step::Outcome;
use weald_engine::stored::StoredLandscape;

/// Bytes of memory for a cell of a tile, and for a border cell of all tiles, as measured.
const A_CELL: u64 = 100;
const A_BORDER_CELL: u64 = 100;

/// Visits that every tile has before the sums: two for basins, one for flats, one for directions, one for heights; paths of
/// least deviation have one more.
const VISITS: u64 = 5;

/// Codes of directions as a layer has them.
struct CodesOnDisk(FilePlane);

impl Plane<u8> for CodesOnDisk {
    fn size(&self) -> Size {
        self.0.size()
    }

    fn read(&self, window: &Window) -> Result<Vec<u8>, Error> {
        Ok(self.0.read(window)?.into_iter().map(|code| code as u8).collect())
    }

    fn write(&mut self, window: &Window, codes: &[u8]) -> Result<(), Error> {
        self.0.write(window, &codes.iter().map(|&code| f32::from(code)).collect::<Vec<_>>())
    }
}

/// Square tiles as large as the memory holds them, with the borders of all.
fn tiling(size: Size, memory: u64) -> Result<Tiling, Error> {
    let cells = size.columns as u64 * size.rows as u64;
    let whole = A_CELL * cells + A_BORDER_CELL * 2 * (size.columns + size.rows) as u64;
    if whole <= memory && cells <= MAX_CELLS as u64 {
        return Tiling::new(size, size);
    }
    let side = ((memory / (2 * A_CELL)).min(MAX_CELLS as u64) as f64).sqrt() as usize;
    let tiling = Tiling::new(size, Size { columns: side.max(1), rows: side.max(1) })?;
    let needed = A_CELL * (side * side) as u64 + A_BORDER_CELL * tiling.border_cells() as u64;
    if needed <= memory {
        return Ok(tiling);
    }
    let limit = Limit::new(Quantity::MemoryBytes, needed, 0..=memory)
        .of(format!("`flow` over {size} cells in tiles"));
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
        let (domain, size) = (landscape.domain.clone(), landscape.domain.size);
        let tiling = tiling(size, landscape.memory)?;
        let by_paths = u64::from(self.directions == DirectionRule::LeastDeviation);
        let visits_of_sums = 1 + u64::from(self.weight.is_some());
        // Tiles that flats or rivers cross often are visited again, which is not known before.
        let (all, mut visits) = ((VISITS + by_paths + visits_of_sums) * tiling.count() as u64, 0);
        let passed = &mut || {
            visits += 1;
            job.watcher.progress(visits.min(all - 1), all, 0);
            if job.watcher.cancelled() {
                Err(Error::Interrupted("interrupted between two tiles".to_owned()))
            } else {
                Ok(())
            }
        };
        let mut filled = landscape.plane("filled", size)?;
        let mut codes = CodesOnDisk(landscape.plane("flow_direction", size)?);
        let height = &landscape.layer(&self.of.0)?.plane;
        let ground = TiledGround { tiling: &tiling, height, valid: None };
        route_tiled(&ground, &self.routing(&domain), (&mut filled, &mut codes), passed)?;
        let shared = (self.method == Method::Multiple).then_some((&filled as &dyn Plane<f32>, self.exponent));
        let flow = TiledFlow { tiling: &tiling, directions: &codes, valid: None, weight: None, shared };
        let mut sums = |weight: Option<&FilePlane>, unit: f64, name: &str| {
            let mut layer = landscape.plane(name, size)?;
            let put = &mut |window: &Window, sums: &[f64]| {
                layer.write(window, &sums.iter().map(|sum| (sum * unit) as f32).collect::<Vec<_>>())
            };
            let weight = weight.map(|weight| weight as &dyn Plane<f32>);
            accumulate_tiled(&TiledFlow { weight, ..flow }, put, passed)?;
            Ok::<_, Error>(layer)
        };
        let area = domain.cell_area();
        let areas = sums(None, area, "accumulation")?;
        let runoff = self.weight.as_ref().map(|name| landscape.layer(&name.0)).transpose()?;
        let discharge = runoff
            .map(|runoff| sums(Some(&runoff.plane), area * MILLIMETRES_PER_YEAR, "discharge"))
            .transpose()?;
        let is_all_sea = self.sea_level(&domain).is_some() && is_all_sea(&codes)?;
        let sea_level = self.sea_level(&domain).filter(|_| is_all_sea);
        landscape.insert("flow_direction", "1", codes.0);
        landscape.insert("accumulation", "m²", areas);
        if let Some(discharge) = discharge {
            landscape.insert("discharge", "m³/s", discharge);
        }
        if let Some(name) = &self.filled {
            landscape.insert(&name.0, "m", filled);
        }
        Ok(Outcome {
            iterations: 1,
            notes: sea_level.map(super::all_sea).into_iter().collect(),
            ..Outcome::default()
        })
    }
}

fn is_all_sea(codes: &CodesOnDisk) -> Result<bool, Error> {
    for rows in codes.0.runs_of_rows() {
        if codes.0.rows(rows)?.iter().any(|&code| code != f32::from(SEA)) {
            return Ok(false);
        }
    }
    Ok(true)
}

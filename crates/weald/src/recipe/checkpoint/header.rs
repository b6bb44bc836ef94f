//! The header of a checkpoint: what it is of, and the names and lengths of all that follows.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use super::belongs::{MAGIC, MAGIC_OF_PARTS, MAX_HEADER};
use super::grown::MeadowHeader;
use super::planted::PlantsHeader;
use super::state::State;
use super::stream::{HASH_BYTES, HashedReader};
use weald_core::domain::{Domain, Georeference};
use weald_core::grid::{Field, Mask, Size};
use weald_core::landscape::Landscape;
use weald_engine::SavedSimulation;
use weald_engine::report::StepReport;
use weald_plants::Vegetation;

/// What the head of a checkpoint says of the run.
#[derive(Debug)]
pub(in crate::recipe) struct Head {
    /// Steps done.
    pub(in crate::recipe) done: usize,
    /// The grid, without the cells that hold no data.
    pub(in crate::recipe) domain: Domain,
    /// Names of the layers.
    pub(in crate::recipe) layers: BTreeSet<String>,
}

/// All but the planes.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Header {
    pub(super) version: String,
    pub(super) recipe: String,
    done: usize,
    columns: usize,
    rows: usize,
    cell: f64,
    georeference: Option<Georeference>,
    masked: bool,
    finest: Option<[usize; 2]>,
    #[serde(default)]
    sea_level: Option<f64>,
    /// Names and units.
    layers: Vec<(String, String)>,
    plants: Vec<PlantsHeader>,
    meadows: Vec<MeadowHeader>,
    simulation: Option<SimulationHeader>,
    steps: Vec<StepReport>,
    notes: Vec<String>,
}

/// Names and lengths.
#[derive(Debug, Serialize, Deserialize)]
struct SimulationHeader {
    iteration: u64,
    planes: Vec<(String, u64)>,
    sums: Vec<(String, u64)>,
}

/// Reads a header, and holds what it claims against the length of the file.
pub(super) fn read_header(file: &mut HashedReader<'_>) -> Result<Header, String> {
    let magic = file.bytes(MAGIC.len())?;
    if magic == MAGIC_OF_PARTS {
        let what = "is the manifest of a checkpoint by parts; go on with --distributed or --out-of-core as its run \
                    had, or run without --resume";
        return Err(what.to_owned());
    }
    if magic != MAGIC {
        return Err("is not a checkpoint of this version of Weald".to_owned());
    }
    let length = file.bytes(8)?.try_into().map(u64::from_le_bytes).expect("eight bytes were asked for");
    if length > MAX_HEADER {
        return Err(format!("the header claims {length} bytes; at most {MAX_HEADER} are read"));
    }
    let header = file.bytes(length as usize)?;
    let header: Header =
        serde_json::from_slice(&header).map_err(|error| format!("damaged header: {error}"))?;
    let needed = header.body_bytes()?;
    if needed != u128::from(file.left()) {
        return Err(format!("is damaged: the header asks for {needed} bytes, but {} follow", file.left()));
    }
    Ok(header)
}

impl Header {
    pub(super) fn of(recipe: &str, state: &State, simulation: Option<&SavedSimulation>) -> Self {
        let Domain { size, cell, georeference, valid, finest, sea_level } = &state.landscape.domain;
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            recipe: recipe.to_owned(),
            done: state.done,
            columns: size.columns,
            rows: size.rows,
            cell: *cell,
            georeference: georeference.clone(),
            masked: valid.is_some(),
            finest: finest.map(|finest| [finest.columns, finest.rows]),
            sea_level: *sea_level,
            layers: state
                .landscape
                .layers()
                .map(|(name, layer)| (name.to_owned(), layer.unit.clone()))
                .collect(),
            plants: state
                .landscape
                .all_plants()
                .map(|(name, plants)| PlantsHeader::of(name, plants))
                .collect(),
            meadows: state
                .landscape
                .all_meadows()
                .map(|(name, meadow)| MeadowHeader::of(name, &meadow))
                .collect(),
            simulation: simulation.map(SimulationHeader::of),
            steps: state.steps.clone(),
            notes: state.notes.clone(),
        }
    }

    fn size(&self) -> Result<Size, String> {
        Size::new(self.columns, self.rows).map_err(|error| error.to_string())
    }

    pub(super) fn head(&self) -> Result<Head, String> {
        let domain = Domain::new(self.size()?, self.cell);
        let layers = self.layers.iter().map(|(name, _)| name.clone()).collect();
        Ok(Head { done: self.done, domain, layers })
    }

    /// Bytes after the header, by what it says.
    fn body_bytes(&self) -> Result<u128, String> {
        let cells = self.size()?.cells() as u128;
        let layers = self.layers.len() as u128 * 4 * cells + if self.masked { cells } else { 0 };
        let plants: u128 = self.plants.iter().map(PlantsHeader::bytes).sum();
        let meadows: u128 = self.meadows.iter().map(MeadowHeader::bytes).sum();
        Ok(layers
            + plants
            + meadows
            + self.simulation.as_ref().map_or(0, SimulationHeader::bytes)
            + u128::from(HASH_BYTES))
    }

    pub(super) fn read_state(self, file: &mut HashedReader<'_>) -> Result<State, String> {
        let size = self.size()?;
        let valid = if self.masked { Mask::new(size, file.flags(size.cells())?) } else { None };
        let finest = self.finest.map(|[columns, rows]| Size::new(columns, rows).map_err(|e| e.to_string()));
        let finest = finest.transpose()?;
        let domain = Domain {
            size,
            cell: self.cell,
            georeference: self.georeference,
            valid,
            finest,
            sea_level: self.sea_level,
        };
        let mut landscape = Landscape::new(domain);
        for (name, unit) in &self.layers {
            landscape.insert(name, unit, Field::from_values(size, file.singles(size.cells())?));
        }
        for header in self.plants {
            let (name, plants) = header.read(file)?;
            landscape.plant(&name, plants);
        }
        for header in self.meadows {
            let (name, meadow) = header.read(file)?;
            landscape.sow(&name, meadow);
        }
        let simulation = self.simulation.map(|header| header.read(file)).transpose()?;
        Ok(State { landscape, done: self.done, simulation, steps: self.steps, notes: self.notes })
    }
}

impl SimulationHeader {
    fn of(simulation: &SavedSimulation) -> Self {
        let SavedSimulation { iteration, planes, sums } = simulation;
        let planes = planes.iter().map(|(name, plane)| (name.clone(), plane.len() as u64)).collect();
        let sums = sums.iter().map(|(name, sums)| (name.clone(), sums.len() as u64)).collect();
        Self { iteration: *iteration, planes, sums }
    }

    fn bytes(&self) -> u128 {
        let total = |list: &[(String, u64)]| list.iter().map(|(_, length)| u128::from(*length)).sum::<u128>();
        4 * total(&self.planes) + 8 * total(&self.sums)
    }

    fn read(self, file: &mut HashedReader<'_>) -> Result<SavedSimulation, String> {
        let mut simulation = SavedSimulation { iteration: self.iteration, ..SavedSimulation::default() };
        for (name, length) in self.planes {
            simulation.planes.push((name, file.singles(length as usize)?));
        }
        for (name, length) in self.sums {
            simulation.sums.push((name, file.doubles(length as usize)?));
        }
        Ok(simulation)
    }
}

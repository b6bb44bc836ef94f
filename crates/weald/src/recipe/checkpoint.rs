//! The state of a run on disk, so that an interrupted run ends with the same bits as one that was not.
//!
//! Layout, all numbers little-endian: `WEALDCP1`; the length of the header as `u64`; the header as JSON; the
//! no-data mask, one byte a cell, where there is one; each layer as `f32`; each plant as its numbers; the maps of
//! all grass; each plane as `f32`; each sum as `f64`; the BLAKE3 hash of all of that.

mod belongs;
mod grown;
mod manifest;
mod parts;
mod planted;
mod stream;

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;

use serde::{Deserialize, Serialize};

pub use belongs::CHECKPOINT_FILE;
use belongs::{MAGIC, MAGIC_OF_PARTS, MAX_HEADER, fits};
use grown::MeadowHeader;
pub(super) use manifest::{Manifest, PARTS_FOLDER};
pub(super) use parts::{KeptParts, remove_stale_parts};
use planted::PlantsHeader;
use stream::{HASH_BYTES, HashedReader, HashedWriter};
use weald_core::domain::{Domain, Georeference};
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};
use weald_core::landscape::Landscape;
use weald_engine::SavedSimulation;
use weald_engine::report::StepReport;
use weald_io::write_whole_with;
use weald_plants::Vegetation;

/// How far a run has come.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct State {
    /// The landscape as it was before the step that runs now.
    pub(super) landscape: Landscape,
    /// Steps done.
    pub(super) done: usize,
    /// Where the step that runs now is, if it can go on from there.
    pub(super) simulation: Option<SavedSimulation>,
    /// What the steps done have to report.
    pub(super) steps: Vec<StepReport>,
    /// What there is to say of the input.
    pub(super) notes: Vec<String>,
}

/// All but the planes.
#[derive(Debug, Serialize, Deserialize)]
struct Header {
    version: String,
    recipe: String,
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

/// Writes the state, with `simulation` in place of the state's own.
pub(super) fn write(
    path: &Path,
    recipe: &str,
    state: &State,
    simulation: Option<&SavedSimulation>,
) -> Result<(), Error> {
    write_whole_with(path, |file| write_to(file, recipe, state, simulation))
}

fn write_to(
    out: impl Write,
    recipe: &str,
    state: &State,
    simulation: Option<&SavedSimulation>,
) -> std::io::Result<()> {
    let header = Header::of(recipe, state, simulation);
    let header = serde_json::to_vec(&header).expect("numbers, texts and lists are JSON");
    let mut out = HashedWriter::new(out);
    out.bytes(MAGIC)?;
    out.bytes(&(header.len() as u64).to_le_bytes())?;
    out.bytes(&header)?;
    if let Some(valid) = &state.landscape.domain.valid {
        out.flags(valid.flags())?;
    }
    for (_, layer) in state.landscape.layers() {
        out.singles(layer.field.values())?;
    }
    for (_, plants) in state.landscape.all_plants() {
        planted::write(plants, &mut out)?;
    }
    for (_, meadow) in state.landscape.all_meadows() {
        grown::write(&meadow, &mut out)?;
    }
    for (_, plane) in simulation.iter().flat_map(|simulation| &simulation.planes) {
        out.singles(plane)?;
    }
    for (_, sums) in simulation.iter().flat_map(|simulation| &simulation.sums) {
        out.doubles(sums)?;
    }
    out.finish()
}

/// A landscape as bytes: its grid, layers, plants and grass, to the bit. Its materials and fractals, which a recipe has, are
/// not in them.
pub fn pack_landscape(landscape: &Landscape) -> Vec<u8> {
    let (landscape, steps, notes) = (landscape.clone(), Vec::new(), Vec::new());
    let state = State { landscape, done: 0, simulation: None, steps, notes };
    let mut bytes = Vec::new();
    write_to(&mut bytes, NO_RECIPE, &state, None).expect("memory takes what is written");
    bytes
}

/// The landscape of bytes that [`pack_landscape`] has made, of the default materials.
///
/// # Errors
/// [`Error::Input`] for bytes that are damaged, or of another version of Weald.
pub fn unpack_landscape(bytes: &[u8]) -> Result<Landscape, Error> {
    let wrong = |what: String| Error::input(Path::new("a packed landscape"), what);
    read_from(HashedReader::of_bytes(bytes), NO_RECIPE, |_| Ok(()), &wrong).map(|state| state.landscape)
}

/// What stands for the recipe of a landscape that is kept alone.
const NO_RECIPE: &str = "";

/// What the head of a checkpoint says of the run.
#[derive(Debug)]
pub(super) struct Head {
    /// Steps done.
    pub(super) done: usize,
    /// The grid, without the cells that hold no data.
    pub(super) domain: Domain,
    /// Names of the layers.
    pub(super) layers: BTreeSet<String>,
}

/// Reads the state of a run of exactly this recipe.
pub(super) fn read(path: &Path, recipe: &str) -> Result<State, Error> {
    read_if(path, recipe, |_| Ok(()))
}

/// The same, where its head is accepted before anything else is read.
pub(super) fn read_if(
    path: &Path,
    recipe: &str,
    accept: impl FnOnce(&Head) -> Result<(), Error>,
) -> Result<State, Error> {
    let wrong = |what: String| Error::input(path, what);
    let file = HashedReader::open(path).map_err(|cause| {
        wrong(match cause.kind() {
            std::io::ErrorKind::NotFound => "there is no checkpoint; run without --resume".to_owned(),
            _ => format!("the checkpoint cannot be read: {cause}"),
        })
    })?;
    read_from(file, recipe, accept, &wrong)
}

fn read_from(
    mut file: HashedReader<'_>,
    recipe: &str,
    accept: impl FnOnce(&Head) -> Result<(), Error>,
    wrong: &impl Fn(String) -> Error,
) -> Result<State, Error> {
    let header = read_header(&mut file).map_err(wrong)?;
    fits(&header.version, &header.recipe, recipe).map_err(wrong)?;
    accept(&header.head().map_err(wrong)?)?;
    let state = header.read_state(&mut file).map_err(wrong)?;
    file.finish().map_err(wrong)?;
    Ok(state)
}

fn read_header(file: &mut HashedReader<'_>) -> Result<Header, String> {
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
    fn of(recipe: &str, state: &State, simulation: Option<&SavedSimulation>) -> Self {
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

    fn head(&self) -> Result<Head, String> {
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

    fn read_state(self, file: &mut HashedReader<'_>) -> Result<State, String> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::path::PathBuf;
    use weald_core::domain::GeoKeys;
    use weald_core::plants::{Plant, Plants};
    use weald_plants::grass::{Bend, Maps, Meadow, SPECIES, Species};

    fn state() -> State {
        let size = Size::new(3, 2).expect("small");
        let mut domain = Domain::new(size, 0.1 + 0.2);
        domain.valid = Mask::new(size, vec![true, false, true, true, true, true]);
        domain.georeference = Some(Georeference {
            epsg: Some(32616),
            origin: [1.0 / 3.0, -2.0e-300],
            pixel: [80.0, 80.0],
            keys: Some(GeoKeys { directory: vec![1, 1, 0, 0], doubles: vec![0.1], ascii: "a|".to_owned() }),
        });
        let mut landscape = Landscape::new(domain);
        landscape.insert("height", "m", Field::from_function(size, |x, y| (x + 10 * y) as f32 / 3.0));
        let plant = |at: f64| Plant {
            place: [at, 0.1, 1.0 / 3.0],
            up: [0.0, -0.6, 0.8],
            turn: 6.1,
            ..Plant::default()
        };
        let plants = vec![plant(0.5), plant(f64::MIN_POSITIVE)];
        landscape.plant("ferns", Plants { kind: "fern".to_owned(), spacing: 0.7, plants });
        landscape.plant("none", Plants { kind: "tree".to_owned(), spacing: 2.0, plants: Vec::new() });
        let map = || Field::from_function(size, |x, y| (x + 3 * y) as f32 / 7.0);
        landscape.sow(
            "lawn",
            Meadow {
                species: vec![SPECIES[1].clone(), Species { height: 0.1, ..SPECIES[3].clone() }],
                bend: Bend::Printed,
                seed: u64::MAX,
                densest: 0.1,
                level: 1.0 / 3.0,
                mown_height: 0.04,
                deepest: 0.0,
                maps: Maps {
                    cell: 0.3,
                    valid: landscape.domain.valid.clone(),
                    density: map(),
                    soil: map(),
                    light: map(),
                    shares: vec![map(), map()],
                    water: None,
                    mown: Some(map()),
                    trodden: None,
                },
            },
        );
        let simulation = SavedSimulation {
            iteration: 7,
            planes: vec![("water".to_owned(), vec![f32::MIN_POSITIVE, -0.0, 3.5])],
            sums: vec![("rained".to_owned(), vec![0.1, f64::MAX])],
        };
        let report = StepReport {
            cached: false,
            step: "slide".to_owned(),
            seconds: 0.1,
            peak_memory: Some(5 << 20),
            cells: 6,
            iterations: 1,
            cell_updates_per_second: 1.0 / 3.0,
            budget: None,
            measures: [("reach".to_owned(), 0.25)].into(),
            notes: Vec::new(),
        };
        State { landscape, done: 1, simulation: Some(simulation), steps: vec![report], notes: Vec::new() }
    }

    fn written() -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join(CHECKPOINT_FILE);
        let state = state();
        write(&path, "a = 1\nb = 2\n", &state, state.simulation.as_ref()).expect("writes");
        (folder, path)
    }

    #[test]
    fn a_state_comes_back_to_the_bit() {
        let (_folder, path) = written();
        assert_eq!(read(&path, "a = 1\nb = 2\n").expect("reads"), state());
    }

    #[test]
    fn a_landscape_is_packed_alone_to_the_bit() {
        let bytes = pack_landscape(&state().landscape);
        assert_eq!(unpack_landscape(&bytes).expect("reads"), state().landscape);
        assert!(unpack_landscape(&bytes[..bytes.len() - 1]).is_err(), "a byte is missing");
        let (_folder, of_run) = written();
        let of_run = std::fs::read(of_run).expect("reads");
        assert!(unpack_landscape(&of_run).is_err(), "that of a run belongs to its recipe");
    }

    #[test]
    fn another_recipe_is_refused_and_the_difference_shown() {
        let (_folder, path) = written();
        let error = read(&path, "a = 1\nb = 3\n").expect_err("another recipe");
        assert_eq!(error.exit_code(), 4);
        let message = error.to_string();
        assert!(message.contains("`b = 2`") && message.contains("`b = 3`"), "{message}");
    }

    #[test]
    fn a_missing_checkpoint_says_what_to_do() {
        let error = read(Path::new("/nowhere/checkpoint.weald"), "").expect_err("missing");
        assert!(error.to_string().contains("run without --resume"), "{error}");
    }

    proptest! {
        #[test]
        fn no_damaged_checkpoint_is_believed(at in 0_usize..4096, flip in 1_u8..=255, cut in 0_usize..4096) {
            let (_folder, path) = written();
            let whole = std::fs::read(&path).expect("just written");
            let mut flipped = whole.clone();
            flipped[at % whole.len()] ^= flip;
            for bytes in [&flipped[..], &whole[..cut % whole.len()]] {
                std::fs::write(&path, bytes).expect("writes");
                prop_assert!(read(&path, "a = 1\nb = 2\n").is_err());
            }
        }
    }
}

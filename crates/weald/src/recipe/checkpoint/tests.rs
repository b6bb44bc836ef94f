use super::*;
use proptest::prelude::*;
use std::path::PathBuf;
use weald_core::domain::{Domain, GeoKeys, Georeference};
use weald_core::grid::{Field, Mask, Size};
use weald_core::plants::{Plant, Plants};
use weald_engine::report::StepReport;
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
    let plant =
        |at: f64| Plant { place: [at, 0.1, 1.0 / 3.0], up: [0.0, -0.6, 0.8], turn: 6.1, ..Plant::default() };
    let plants = vec![plant(0.5), plant(f64::MIN_POSITIVE)];
    landscape.plant("ferns", Plants { kind: "fern".to_owned(), spacing: 0.7, plants });
    landscape.plant("none", Plants { kind: "tree".to_owned(), spacing: 2.0, plants: Vec::new() });
    let map = || Field::from_function(size, |x, y| (x + 3 * y) as f32 / 7.0);
    landscape.sow(
        "lawn",
        Meadow {
            species: vec![SPECIES[1].clone(), Species { height: 0.1, splay: 0.2, ..SPECIES[3].clone() }],
            bend: Bend::Printed,
            seed: u64::MAX,
            densest: 0.1,
            level: 1.0 / 3.0,
            mown_height: 0.04,
            deepest: 0.0,
            tussocks: 0.3,
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

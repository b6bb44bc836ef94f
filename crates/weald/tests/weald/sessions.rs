//! Sessions: a step held in hand, saved as a recipe, replayed by a run, opened again.

use std::path::Path;

use weald::edit::{Brush, Change, Effect, Setting};
use weald::engine::Engine;
use weald::random::{hash2, unit};
use weald::recipe::source::Value;
use weald::recipe::{Options, Overrides, Recipe, Run, Session, SessionOptions, Silent};
use weald::{Error, Landscape};

/// A recipe with a step of one kind between others.
fn recipe(folder: &Path, step: &str) -> Recipe {
    let text = format!(
        "[landscape]\nsize = [40, 32]\ncell = 4.0\nseed = 3\n\
         [[material]]\nname = \"rock\"\n[[material]]\nname = \"sand\"\nbottom = 30\n\
         [[material]]\nname = \"soil\"\nthickness = 1\n\
         [[step]]\ndo = \"diamond-square\"\nrelief = 60\n\
         [[step]]\n{step}\n\
         [[step]]\ndo = \"slope\"\n\
         [[output]]\nlayer = \"height\"\nfile = \"height.npy\"\n\
         [[output]]\nlayer = \"slope\"\nfile = \"slope.npy\"\n"
    );
    let file = folder.join("r.toml");
    std::fs::write(&file, &text).expect("written");
    Recipe::load(&file, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

const HELD: &[(&str, &[(&str, f64)])] = &[
    (
        "do = \"hydraulic\"\nmodel = \"han\"\nrain_period = 7\ndry_period = 5",
        &[("rain", 0.1), ("capacity", 20.0)],
    ),
    ("do = \"hydraulic\"\nmodel = \"mei\"\nboundary = \"open\"", &[("evaporation", 0.03)]),
    (
        "do = \"hydraulic\"\nmodel = \"stava\"\nrain_period = 7\ndry_period = 5\nslippage = {}",
        &[("slippage.strength", 0.02), ("erosion", 4.0)],
    ),
    (
        "do = \"fluvial\"\nflow_time = 0.02\nrain = 5000\nduration = 3\nerodibility = 0.1\ndeepest = 0.5\nlevels = 2",
        &[("erodibility", 0.4), ("evaporation", 500.0)],
    ),
    ("do = \"thermal\"\ntalus = 0.3", &[("strength", 0.1)]),
    ("do = \"slippage\"", &[("strength", 0.05)]),
    ("do = \"constant\"\nheight = 1.0\ninto = \"water\"\n[[step]]\ndo = \"dissolution\"", &[("depth", 0.5)]),
];

fn changes(seed: u64, settings: &[(&str, f64)]) -> Vec<(u64, Change)> {
    let random = |at: u64, which: i64| unit(hash2(seed, at as i64, which));
    let change = |at: u64| {
        let amount = 0.5 + 2.0 * random(at, 0);
        let effect = match (random(at, 1) * 8.0) as u64 {
            0 => Effect::Add { material: "sand".to_owned(), thickness: amount },
            1 => Effect::Remove { material: "rock".to_owned(), thickness: amount },
            2 => Effect::AddWater { depth: amount },
            3 => Effect::Smooth { times: 2 },
            4 => Effect::Flatten { height: 30.0 },
            5 => Effect::Freeze,
            6 => Effect::Source { rate: 0.1 },
            _ => {
                let (key, value) = settings[at as usize % settings.len()];
                let setting = Setting { key: key.to_owned(), value: Value::Number(value) };
                return ((random(at, 2) * 9.0) as u64, setting.into());
            }
        };
        let place = [160.0 * random(at, 3), 128.0 * random(at, 4)];
        ((random(at, 2) * 9.0) as u64, Brush::dab(effect, place, 12.0).into())
    };
    (0..8).map(change).collect()
}

/// Does what it can of some changes, with steps between them.
fn act(session: &mut Session, changes: &[(u64, Change)]) -> usize {
    let mut done = 0;
    for (steps, change) in changes {
        session.advance(*steps).expect("runs");
        let result = match change.clone() {
            Change::Stroke(brush) => session.paint(brush),
            Change::Set(setting) => session.set(setting),
        };
        match result {
            Ok(()) => done += 1,
            Err(error) => assert!(matches!(error, Error::Run(_)), "{error}"),
        }
    }
    done
}

fn open(recipe: Recipe) -> Session {
    Session::open(recipe, SessionOptions::default(), &Silent).unwrap_or_else(|error| panic!("{error}"))
}

fn layers(landscape: &Landscape) -> Vec<(String, Vec<u32>)> {
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect();
    landscape.layers().map(|(name, layer)| (name.to_owned(), bits(layer.field.values()))).collect()
}

#[test]
fn a_saved_session_is_a_recipe_that_a_run_replays_to_the_same_bits_and_that_opens_again() {
    for (number, (step, settings)) in (0_u64..).zip(HELD) {
        let mut all = 0;
        for seed in 0..4 {
            let folder = tempfile::tempdir().expect("a folder");
            let mut session = open(recipe(folder.path(), step));
            let done = act(&mut session, &changes(100 * number + seed, settings));
            all += done;
            // Elsewhere, so that files must be found from there.
            std::fs::create_dir(folder.path().join("kept")).expect("made");
            let file = folder.path().join("kept/mine.toml");
            session.save(&file).unwrap_or_else(|error| panic!("{step}: {error}"));
            let end = session.finish(&Silent).expect("the steps after it run");
            let saved = Recipe::load(&file, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
            let mut again = open(saved);
            assert_eq!(again.steps(), session.steps());
            let reopened = again.finish(&Silent).expect("runs");
            assert!(layers(&reopened) == layers(&end), "{step}, {seed}: opened again");
            let saved = Recipe::load(&file, &Overrides::default()).expect("is good");
            let options =
                Options { engine: Engine::Bands(3), ..Options::into_folder(folder.path().join("out")) };
            let run = Run { recipe: &saved, options };
            let landscape = run.landscape(&Silent).unwrap_or_else(|error| panic!("{step}: {error}"));
            assert!(layers(&landscape) == layers(&end), "{step}, {seed}: run");
        }
        assert!(all > 10, "{step}: {all} changes");
    }
}

#[test]
fn a_session_that_was_opened_again_can_be_undone_to_its_beginning() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut session = open(recipe(folder.path(), HELD[2].0));
    let start = layers(&session.landscape().expect("is there").0);
    act(&mut session, &changes(5, HELD[2].1));
    let file = folder.path().join("mine.toml");
    session.save(&file).expect("written");
    let mut again = open(Recipe::load(&file, &Overrides::default()).expect("is good"));
    assert!(layers(&again.landscape().expect("is there").0) != start);
    while again.history().undo().expect("takes back") {}
    assert!(layers(&again.landscape().expect("is there").0) == start);
}

#[test]
fn a_recipe_without_a_step_that_can_be_held_says_which_can() {
    let folder = tempfile::tempdir().expect("a folder");
    let of = |number| {
        let options = SessionOptions { step: Some(number), ..SessionOptions::default() };
        Session::open(recipe(folder.path(), HELD[4].0), options, &Silent).map(drop)
    };
    let error = of(1).expect_err("a generator").to_string();
    assert!(error.contains("no step 1 that can be held; such are: dissolution, "), "{error}");
    assert!(of(0).is_err() && of(9).is_err());
    of(2).expect("can be held");
    let little = SessionOptions { memory: 1000, ..SessionOptions::default() };
    let error = Session::open(recipe(folder.path(), HELD[4].0), little, &Silent).expect_err("too little");
    assert_eq!(error.exit_code(), 5, "{error}");
}

#[test]
fn a_session_behind_a_step_that_is_off_is_saved_into_its_own_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let step = "do = \"fbm\"\nrelief = 900\noff = true\n[[step]]\ndo = \"hydraulic\"\nmodel = \"mei\"";
    let options = SessionOptions::default();
    let mut session = Session::open(recipe(folder.path(), step), options.clone(), &Silent).expect("it opens");
    assert_eq!(session.replayed().0, 2);
    session.advance(5).expect("it runs");
    let file = folder.path().join("saved.toml");
    session.save(&file).expect("saved");
    let here = session.finish(&Silent).expect("it ends");
    let saved = Recipe::load(&file, &Overrides::default()).expect("a recipe");
    assert_eq!(saved.steps.len(), 3, "the step is off still");
    let there = Session::open(saved, options, &Silent).expect("it opens").finish(&Silent).expect("it ends");
    assert_eq!(here.field("slope").expect("there"), there.field("slope").expect("there"));
}

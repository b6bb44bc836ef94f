//! Random sessions on a device, of every step that can be held: a run of what was saved has the same bits.

use std::path::Path;
use std::sync::Arc;

use crate::programs::gpu;
use weald::edit::{Brush, Change, Effect, Setting};
use weald::engine::Engine;
use weald::random::{hash2, unit};
use weald::recipe::source::Value;
use weald::recipe::{Options, Overrides, Recipe, Run, Session, SessionOptions, Silent};
use weald::{Error, Landscape};

/// Sessions of each step.
const SESSIONS: u64 = 4;

/// Steps with those that they need, and keys of them that can change.
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
    (
        "do = \"constant\"\nheight = 1.0\ninto = \"water\"\n[[step]]\ndo = \"constant\"\nheight = 0.8\n\
         into = \"flux_x\"\n[[step]]\ndo = \"constant\"\nheight = 0.3\ninto = \"flux_y\"\n[[step]]\n\
         do = \"fbm\"\nrelief = 5.0\ninto = \"dye\"\n[[step]]\ndo = \"transport\"\nlayer = \"dye\"",
        &[],
    ),
];

fn recipe(folder: &Path, step: &str) -> Recipe {
    let text = format!(
        "[landscape]\nsize = [40, 32]\ncell = 4.0\nseed = 3\n\
         [[material]]\nname = \"rock\"\n[[material]]\nname = \"sand\"\nbottom = 30\n\
         [[step]]\ndo = \"diamond-square\"\nrelief = 60\n\
         [[step]]\n{step}\n\
         [[output]]\nlayer = \"height\"\nfile = \"height.npy\"\n"
    );
    let file = folder.join("r.toml");
    std::fs::write(&file, &text).expect("written");
    Recipe::load(&file, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Steps, strokes and settings.
fn changes(seed: u64, settings: &[(&str, f64)]) -> Vec<(u64, Change)> {
    let random = |at: u64, which: i64| unit(hash2(seed, at as i64, which));
    let change = |at: u64| {
        let steps = 1 + (random(at, 2) * 9.0) as u64;
        let amount = 0.5 + 2.0 * random(at, 0);
        let effect = match (random(at, 1) * 8.0) as u64 {
            0 => Effect::Add { material: "sand".to_owned(), thickness: amount },
            1 => Effect::Remove { material: "bedrock".to_owned(), thickness: amount },
            2 => Effect::AddWater { depth: amount },
            3 => Effect::Smooth { times: 2 },
            4 => Effect::Flatten { height: 30.0 },
            5 => Effect::Freeze,
            6 => Effect::Source { rate: 0.1 },
            _ if settings.is_empty() => Effect::AddWater { depth: 0.5 },
            _ => {
                let (key, value) = settings[at as usize % settings.len()];
                let setting = Setting { key: key.to_owned(), value: Value::Number(value) };
                return (steps, setting.into());
            }
        };
        let place = [160.0 * random(at, 3), 128.0 * random(at, 4)];
        (steps, Brush::dab(effect, place, 12.0).into())
    };
    (0..8).map(change).collect()
}

/// Does what the step can follow of some changes, with steps between them.
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

fn bits(landscape: &Landscape) -> Vec<(String, Vec<u32>)> {
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect();
    landscape.layers().map(|(name, layer)| (name.to_owned(), bits(layer.field.values()))).collect()
}

#[test]
fn what_was_saved_of_random_sessions_on_a_device_is_replayed_there_to_the_same_bits() {
    let Some(gpu) = gpu() else { return };
    let engine = || Engine::Device(Arc::new(gpu.clone()));
    for (number, (step, settings)) in (0_u64..).zip(HELD) {
        let mut all = 0;
        for seed in 0..SESSIONS {
            let folder = tempfile::tempdir().expect("a folder");
            let options = SessionOptions { engine: engine(), ..SessionOptions::default() };
            let mut session = Session::open(recipe(folder.path(), step), options, &Silent)
                .unwrap_or_else(|error| panic!("{step}: {error}"));
            let start = bits(&session.landscape().expect("is there").0);
            all += act(&mut session, &changes(100 * number + seed, settings));
            let file = folder.path().join("mine.toml");
            session.save(&file).unwrap_or_else(|error| panic!("{step}: {error}"));
            let end = session.finish(&Silent).expect("the steps after it run");
            let saved = Recipe::load(&file, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
            let options = Options { engine: engine(), ..Options::into_folder(folder.path().join("out")) };
            let run = Run { recipe: &saved, options }.landscape(&Silent);
            let run = run.unwrap_or_else(|error| panic!("{step}: {error}"));
            assert!(bits(&run) == bits(&end), "{step}, {seed}");
            assert!(bits(&end) != start, "{step}, {seed}: nothing changed");
        }
        println!("{all} changes of {step:?}");
        assert!(all > 8 || settings.is_empty(), "{step}: {all} changes");
    }
}

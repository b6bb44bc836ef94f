//! Runs of recipes with scripts of strokes.

use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use weald::Size;
use weald::edit::{Brush, Edit, Effect, Falloff, Script};
use weald::engine::Engine;
use weald::random::{hash2, unit};
use weald::recipe::{Options, Overrides, Progress, Recipe, Run, Silent};

fn dab(effect: Effect) -> Brush {
    Brush { path: vec![[60.0, 50.0]], radius: 30.0, falloff: Falloff::Smooth, strength: 1.0, effect }
}

/// A recipe with a simulation of layered ground that a script edits.
fn edited(script: &Script, folder: &Path) -> Recipe {
    edited_within(script, folder, "closed")
}

fn edited_within(script: &Script, folder: &Path, boundary: &str) -> Recipe {
    script.save(&folder.join("s.jsonl")).expect("written");
    let text = format!(
        "[landscape]\nsize = [40, 32]\ncell = 4.0\nseed = 3\n\
                [[material]]\nname = \"rock\"\n[[material]]\nname = \"sand\"\nbottom = 30\n\
                [[material]]\nname = \"soil\"\nthickness = 1\n\
                [[step]]\ndo = \"diamond-square\"\nrelief = 60\n\
                [[step]]\ndo = \"hydraulic\"\nmodel = \"stava\"\niterations = 500\nrain_period = 20\n\
                dry_period = 20\nedits = \"s.jsonl\"\nslippage = {{}}\nboundary = \"{boundary}\"\n\
                [[output]]\nlayer = \"height\"\nfile = \"height.npy\"\n\
                [[output]]\nlayer = \"sand\"\nfile = \"sand.npy\"\n\
                [[output]]\nlayer = \"water\"\nfile = \"water.npy\"\n"
    );
    let file = folder.join("r.toml").display().to_string();
    Recipe::parse(&file, &text, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Fifty strokes of all kinds that a run can follow, spread over 500 steps.
fn fifty() -> Script {
    let name = |seed: u64| ["rock", "sand", "soil"][(seed % 3) as usize].to_owned();
    let random = |seed: u64, stroke: u64| unit(hash2(seed, stroke as i64, 0));
    let edit = |stroke: u64| {
        let amount = 0.5 + 2.0 * random(1, stroke);
        let effect = match stroke % 11 {
            0 => Effect::Add { material: name(stroke / 11), thickness: amount },
            1 => Effect::Remove { material: name(stroke / 11), thickness: amount },
            2 => Effect::AddWater { depth: amount },
            3 => Effect::RemoveWater { depth: amount },
            4 => Effect::Smooth { times: 2 },
            5 => Effect::Flatten { height: 20.0 + 10.0 * amount },
            6 => Effect::Source { rate: 0.1 * amount },
            7 => Effect::Drain { rate: 0.1 * amount },
            8 => Effect::Rain { factor: amount },
            9 => Effect::Freeze,
            _ => Effect::Thaw,
        };
        let end = |seed: u64| [160.0 * random(seed, stroke), 128.0 * random(seed + 1, stroke)];
        let brush = Brush { path: vec![end(2), end(4)], radius: 12.0, strength: 0.7, ..dab(effect) };
        Edit::stroke(stroke * stroke / 5, brush)
    };
    Script::new((0..50).map(edit).collect())
}

/// Ends the run once so many steps of the simulation are done.
struct StopsAt(u64, AtomicU64);

impl Progress for StopsAt {
    fn progress(&self, done: u64, _: u64, _: usize) {
        self.1.store(done, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.1.load(Ordering::Relaxed) >= self.0
    }
}

#[test]
fn fifty_strokes_over_500_steps_replay_to_the_same_bits_on_every_cpu_engine_and_after_a_pause() {
    let folder = tempfile::tempdir().expect("a folder");
    let recipe = edited(&fifty(), folder.path());
    let run = |out: &str, engine: Engine, resume: bool, progress: &dyn Progress| {
        let options = Options { engine, resume, ..Options::into_folder(folder.path().join(out)) };
        Run { recipe: &recipe, options }.execute(progress)
    };
    let file = |out: &str, name: &str| std::fs::read(folder.path().join(out).join(name)).expect("written");
    let report = run("one", Engine::Cpu, false, &Silent).expect("runs");
    run("bands", Engine::Bands(3), false, &Silent).expect("runs");
    run("tiles", Engine::Tiles(Size::square(16).expect("small")), false, &Silent).expect("runs");
    let error = run("parts", Engine::Cpu, false, &StopsAt(180, AtomicU64::new(0))).expect_err("stopped");
    assert_eq!(error.exit_code(), 130, "{error}");
    run("parts", Engine::Cpu, true, &Silent).expect("goes on");
    for name in ["height.npy", "sand.npy", "water.npy"] {
        for other in ["bands", "tiles", "parts"] {
            assert!(file("one", name) == file(other, name), "{other}: {name}");
        }
    }
    let budget = report.steps[1].budget.as_ref().expect("a simulation has one");
    assert!(budget.solid.error.abs() < 1e-5 && budget.water.error.abs() < 1e-5, "{budget:?}");
    assert!(
        report.steps[1].notes[0].starts_with("strokes of the script that happened: 50;"),
        "{:?}",
        report.steps[1].notes
    );
    let untouched = edited(&Script::default(), folder.path()).landscape().expect("runs");
    let touched = edited(&fifty(), folder.path()).landscape().expect("runs");
    assert_ne!(touched.field("height").ok(), untouched.field("height").ok(), "the strokes did something");
}

#[test]
fn a_script_with_a_fault_or_a_frost_at_an_open_border_ends_the_run_with_its_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let frost = Script::new(vec![Edit::stroke(7, dab(Effect::Freeze))]);
    let message = edited_within(&frost, folder.path(), "open").landscape().expect_err("no frost").to_string();
    assert!(message.contains("freezes") && message.contains("closed"), "{message}");
    let recipe = edited(&Script::default(), folder.path());
    assert_eq!(recipe.inputs(), [folder.path().join("s.jsonl")]);
    std::fs::write(folder.path().join("s.jsonl"), "{\"do\": \"thaw\"}\n").expect("written");
    let message = recipe.landscape().expect_err("faulty").to_string();
    assert!(message.contains("s.jsonl:1: thaw: `path` is needed"), "{message}");
}

#[test]
fn poured_sand_lies_where_it_was_poured_and_not_elsewhere() {
    let folder = tempfile::tempdir().expect("a folder");
    let heap = Effect::Add { material: "sand".to_owned(), thickness: 5.0 };
    let script = Script::new(vec![Edit::stroke(501, dab(heap.clone()))]);
    let never = edited(&script, folder.path()).landscape().expect("runs");
    let script = Script::new(vec![Edit::stroke(499, dab(heap))]);
    let late = edited(&script, folder.path()).landscape().expect("runs");
    let gain = |x: usize, y: usize| {
        let [now, before] =
            [&late, &never].map(|landscape| landscape.field("sand").expect("a layer").at(x, y));
        now - before
    };
    assert!(gain(15, 12) > 4.0, "{}", gain(15, 12));
    assert_eq!(gain(35, 28), 0.0);
    assert_eq!(
        never.field("sand").ok(),
        edited(&Script::default(), folder.path()).landscape().expect("runs").field("sand").ok()
    );
}

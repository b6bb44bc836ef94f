//! Recipes over ranks: files and report of the first are those of one processor.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use weald::Error;
use weald::edit::{Brush, Edit, Effect, Falloff, Script};
use weald::engine::Engine;
use weald::engine::ranks::{Ranks, ranks_in_threads};
use weald::recipe::{Options, Overrides, Progress, Recipe, Report, Run, Silent, take_part};

const FILES: [&str; 6] = ["height.npy", "sand.npy", "water.npy", "dye.npy", "area.npy", "seen.png"];

/// Steps of all kinds: those that run over ranks, between some that do not.
fn recipe(folder: &Path) -> Recipe {
    let path = vec![[20.0, 60.0], [120.0, 64.0]];
    let add = Effect::Add { material: "sand".to_owned(), thickness: 2.0 };
    let brush = Brush { path, radius: 20.0, falloff: Falloff::Smooth, strength: 1.0, effect: add };
    Script::new(vec![Edit::stroke(70, brush)]).save(&folder.join("s.jsonl")).expect("written");
    let step = |text: &str| format!("[[step]]\n{text}\n");
    let steps = [
        "do = \"diamond-square\"\nrelief = 60",
        "do = \"hydraulic\"\nmodel = \"stava\"\niterations = 150\nedits = \"s.jsonl\"\nslippage = {}",
        "do = \"hydraulic\"\niterations = 120\nboundary = \"open\"\ninitial_water = \"water\"",
        "do = \"fbm\"\ninto = \"dye\"\nrelief = 1.0",
        "do = \"transport\"\nlayer = \"dye\"\niterations = 40",
        "do = \"slippage\"\niterations = 30",
        "do = \"dissolution\"\niterations = 30",
        "do = \"thermal\"\niterations = 40",
        "do = \"fluvial\"\nduration = 20.0\nflow_time = 0.02\nlevels = 2",
        "do = \"flow\"",
    ];
    let text = format!(
        "[landscape]\nsize = [40, 56]\ncell = 4.0\nseed = 3\n\
         [[material]]\nname = \"rock\"\n[[material]]\nname = \"sand\"\nbottom = 30\n{}",
        steps.map(step).concat()
    );
    let outputs: String = ["height", "sand", "water", "dye"].map(output).concat();
    let more = "[[output]]\nlayer = \"accumulation\"\nfile = \"area.npy\"\n\
                [[output]]\npicture = \"relief\"\nfile = \"seen.png\"\n";
    let file = folder.join("r.toml").display().to_string();
    let text = format!("{text}{outputs}{more}");
    Recipe::parse(&file, &text, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn output(layer: &str) -> String {
    format!("[[output]]\nlayer = \"{layer}\"\nfile = \"{layer}.npy\"\n")
}

fn run(
    recipe: &Recipe,
    (out, engine): (&Path, Engine),
    resume: bool,
    progress: &dyn Progress,
) -> Result<Report, Error> {
    let options = Options { engine, resume, ..Options::into_folder(out) };
    Run { recipe, options }.execute(progress)
}

/// The run of the first of so many ranks; all others must end well, however it ends.
fn over(
    count: usize,
    (recipe, out): (&Recipe, &Path),
    resume: bool,
    progress: &dyn Progress,
) -> Result<Report, Error> {
    let mut ranks = ranks_in_threads(count).into_iter();
    let first = ranks.next().expect("at least one");
    std::thread::scope(|scope| {
        let follow = |ranks: Arc<dyn Ranks>| take_part(recipe, &ranks);
        let others: Vec<_> = ranks.map(|ranks| scope.spawn(move || follow(ranks))).collect();
        let done = run(recipe, (out, Engine::Ranks(first)), resume, progress);
        for other in others {
            other.join().expect("no panic").unwrap_or_else(|error| panic!("{error}"));
        }
        done
    })
}

/// What a report says of its steps, beside their times.
fn steps_of(report: &Report) -> Vec<String> {
    let said = |step: &weald::recipe::StepReport| {
        format!("{} {} {:?} {:?} {:?}", step.step, step.iterations, step.budget, step.measures, step.notes)
    };
    report.steps.iter().map(said).collect()
}

fn assert_same_files(expected: &Path, got: &Path, what: &str) {
    for name in FILES {
        let [expected, got] =
            [expected, got].map(|folder| std::fs::read(folder.join(name)).expect("written"));
        assert!(expected == got, "{what}: {name}");
    }
}

#[test]
fn a_recipe_over_ranks_makes_the_files_and_the_report_of_one_processor() {
    let folder = tempfile::tempdir().expect("a folder");
    let recipe = recipe(folder.path());
    let place = |out: &str| folder.path().join(out);
    let report = run(&recipe, (&place("one"), Engine::Cpu), false, &Silent).expect("runs");
    for count in [1, 3, 4] {
        let out = place(&format!("{count}"));
        let over = over(count, (&recipe, &out), false, &Silent).expect("runs");
        assert_same_files(&place("one"), &out, &format!("{count} ranks"));
        assert_eq!(steps_of(&report), steps_of(&over), "{count} ranks");
        assert_eq!(over.engine, "ranks");
    }
}

/// Ends the run once so many steps of its second simulation are done.
struct Stops(u64, [AtomicU64; 2]);

impl Progress for Stops {
    fn step(&self, number: usize, _: usize, _: &str) {
        self.1[0].store(number as u64, Ordering::Relaxed);
    }

    fn progress(&self, done: u64, _: u64, _: usize) {
        self.1[1].store(done, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.1[0].load(Ordering::Relaxed) == 2 && self.1[1].load(Ordering::Relaxed) >= self.0
    }
}

#[test]
fn an_interrupted_run_lets_all_ranks_go_and_goes_on_over_another_number_of_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let recipe = recipe(folder.path());
    let [one, parts] = ["one", "parts"].map(|out| folder.path().join(out));
    run(&recipe, (&one, Engine::Cpu), false, &Silent).expect("runs");
    let stop = || Stops(70, Default::default());
    let error = over(4, (&recipe, &parts), false, &stop()).expect_err("stopped");
    assert_eq!(error.exit_code(), 130, "{error}");
    assert!(error.to_string().contains("after 70 iterations"), "before the stroke: {error}");
    over(3, (&recipe, &parts), true, &Silent).expect("goes on");
    assert_same_files(&one, &parts, "4 and 3 ranks");
}

#[test]
fn a_run_that_fails_on_the_first_rank_lets_the_others_go() {
    let folder = tempfile::tempdir().expect("a folder");
    let recipe = recipe(folder.path());
    std::fs::write(folder.path().join("s.jsonl"), "{\"do\": \"thaw\"}\n").expect("written");
    let error = over(3, (&recipe, &folder.path().join("out")), false, &Silent).expect_err("a faulty script");
    assert!(error.to_string().contains("`path` is needed"), "{error}");
}

#[test]
fn only_the_first_rank_runs_a_recipe() {
    let folder = tempfile::tempdir().expect("a folder");
    let recipe = recipe(folder.path());
    let second = ranks_in_threads(2).remove(1);
    let out = folder.path().join("out");
    let error = run(&recipe, (&out, Engine::Ranks(second)), false, &Silent).expect_err("refused");
    assert!(error.to_string().contains("rank 1 was to run a recipe"), "{error}");
    assert!(!out.exists());
}

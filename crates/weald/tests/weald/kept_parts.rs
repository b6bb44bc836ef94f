//! Checkpoints by parts: a run that no process holds ends early anywhere and goes on over another number of ranks, to the same
//! bits; what is damaged or of another run is named.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use weald::Error;
use weald::recipe::{CHECKPOINT_FILE, Options, Overrides, Progress, Recipe, Report, Run, Silent};

use crate::distributed::over_with;
use crate::ground_by_rows::{ground_with_holes, with_holes};
use crate::out_of_core::{BESIDE, assert_same_files, land, run, said};

/// Wants the end when one of the steps of a name has told so often where it is.
struct StopsIn<'a> {
    step: &'a str,
    after: u64,
    /// What is told while that step runs; the step runs from 1 on.
    told: AtomicU64,
}

impl<'a> StopsIn<'a> {
    fn new(step: &'a str, after: u64) -> Self {
        Self { step, after, told: AtomicU64::new(0) }
    }
}

impl Progress for StopsIn<'_> {
    fn step(&self, _: usize, _: usize, name: &str) {
        let is_over = self.told.load(Ordering::Relaxed) > self.after;
        if !is_over {
            self.told.store(u64::from(name == self.step), Ordering::Relaxed);
        }
    }

    fn progress(&self, _: u64, _: u64, _: usize) {
        if self.told.load(Ordering::Relaxed) > 0 {
            self.told.fetch_add(1, Ordering::Relaxed);
        }
    }

    fn output(&self, _: usize, _: usize, file: &Path) {
        if file == Path::new(self.step) {
            self.told.store(self.after + 1, Ordering::Relaxed);
        }
    }

    fn cancelled(&self) -> bool {
        self.told.load(Ordering::Relaxed) > self.after
    }
}

/// Where layers and rows lie.
#[derive(Clone, Copy, Debug)]
enum Lies {
    /// On the disk of one process.
    Alone,
    /// On the disks of so many ranks.
    Disk(usize),
    /// In the memory of so many ranks.
    Memory(usize),
}

fn options(out: &Path, lies: Lies, scratch: &Path, every: Duration) -> Options {
    let disk = |memory| Options { memory: Some(memory), ..Options::from_disk(out, scratch) };
    let options = match lies {
        // The whole is cut into bands.
        Lies::Alone => disk(BESIDE + (7 << 20)),
        Lies::Disk(_) => disk(BESIDE + (9 << 20)),
        Lies::Memory(_) => Options { memory: Some(1 << 30), ..Options::into_folder(out) },
    };
    Options { checkpoint_every: every, resume: out.join(CHECKPOINT_FILE).exists(), ..options }
}

/// A run that goes on where there is a checkpoint: what the first rank says.
fn go(
    recipe: &Recipe,
    (out, lies): (&Path, Lies),
    every: Duration,
    progress: &(dyn Progress + Sync),
) -> Result<Report, Error> {
    let scratch = tempfile::tempdir().expect("a folder");
    let options = options(out, lies, scratch.path(), every);
    let (Lies::Disk(count) | Lies::Memory(count)) = lies else {
        return Run { recipe, options: Options { threads: Some(2), ..options } }.execute(progress);
    };
    let mut ends = over_with(count, recipe, &|_| options.clone(), progress);
    let alike = ends.iter().all(|end| end.is_ok() == ends[0].is_ok());
    assert!(alike, "{ends:?}");
    ends.swap_remove(0)
}

fn parts(out: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(out.join("checkpoint.parts")).into_iter().flatten().flatten();
    let mut parts: Vec<_> = entries.map(|entry| entry.path()).collect();
    parts.sort();
    parts
}

/// That a run has left the files and the report of one in memory, and no checkpoint.
fn assert_same(expected: &Report, (whole, out): (&Path, &Path), got: &Report) {
    let without_going_on = |report: &Report| {
        let mut report = Report { engine: String::new(), ..report.clone() };
        for step in &mut report.steps {
            step.notes.retain(|note| !note.starts_with("went on from a checkpoint"));
        }
        said(&report)
    };
    assert_eq!(without_going_on(got), without_going_on(expected));
    assert_same_files(expected, [whole, out], "a run that went on");
    assert!(!out.join(CHECKPOINT_FILE).exists() && !out.join("checkpoint.parts").exists());
}

#[test]
fn a_run_that_is_ended_anywhere_goes_on_over_another_number_of_ranks_to_the_same_bits() {
    let open = "boundary = \"open\"\nthermal = { talus = 0.6, strength = 0.05 }";
    let mei = "model = \"mei\"\nboundary = \"open\"\ninitial_water = \"pond\"";
    let kinds = [
        (
            open,
            [Lies::Memory(3), Lies::Alone, Lies::Disk(2), Lies::Memory(6), Lies::Disk(4), Lies::Memory(1)],
        ),
        (mei, [Lies::Disk(6), Lies::Memory(4), Lies::Memory(2), Lies::Alone, Lies::Disk(3), Lies::Disk(2)]),
    ];
    for (hydraulic, turns) in kinds {
        let recipe = land("fbm", hydraulic);
        let [whole, out] = [0; 2].map(|_| tempfile::tempdir().expect("a folder"));
        let expected = run(&recipe, whole.path(), None, &Silent).unwrap_or_else(|error| panic!("{error}"));
        let places =
            [("fbm", 0), ("hydraulic", 1), ("hydraulic", 0), ("flow", 2), ("discharge.tif", 0), ("", 0)];
        let mut went_on = 0;
        for ((step, after), lies) in places.into_iter().zip(turns) {
            let progress = StopsIn::new(step, after);
            let ended = go(&recipe, (out.path(), lies), Duration::MAX, &progress);
            if step.is_empty() {
                let report = ended.unwrap_or_else(|error| panic!("{lies:?}: {error}"));
                assert_same(&expected, (whole.path(), out.path()), &report);
                let notes = report.steps.iter().flat_map(|step| &step.notes);
                went_on += notes.filter(|note| note.starts_with("went on from a checkpoint")).count();
                continue;
            }
            let error = ended.expect_err("it is to end");
            assert_eq!(error.exit_code(), 130, "{step} {lies:?}: {error}");
            assert!(error.to_string().contains("the same command with --resume goes on from"), "{error}");
            assert!(!out.path().join("height.tif").exists(), "no file has its name");
            let count = match lies {
                Lies::Alone => 1,
                Lies::Disk(count) | Lies::Memory(count) => count,
            };
            assert_eq!(parts(out.path()).len(), count, "those of this checkpoint alone");
        }
        assert_eq!(went_on, 1, "the simulation went on within");
    }
}

#[test]
fn checkpoints_kept_all_the_time_change_nothing_and_the_last_one_stands_when_a_rank_cannot_write_its_part() {
    let recipe = land("fbm", "");
    let [whole, out, scratch, elsewhere] = [0; 4].map(|_| tempfile::tempdir().expect("a folder"));
    let expected = run(&recipe, whole.path(), None, &Silent).unwrap_or_else(|error| panic!("{error}"));
    let report = go(&recipe, (out.path(), Lies::Memory(3)), Duration::ZERO, &Silent);
    assert_same(&expected, (whole.path(), out.path()), &report.expect("it ends well"));
    // Until the simulation has begun, and then with an output folder that one rank sees elsewhere.
    let stopped = go(&recipe, (out.path(), Lies::Memory(3)), Duration::MAX, &StopsIn::new("hydraulic", 0));
    assert_eq!(stopped.expect_err("it is to end").exit_code(), 130);
    let before = (std::fs::read(out.path().join(CHECKPOINT_FILE)).expect("kept"), parts(out.path()));
    let given = |rank: usize| {
        let options = options(out.path(), Lies::Memory(3), scratch.path(), Duration::ZERO);
        let out = if rank == 1 { elsewhere.path().to_owned() } else { options.out.clone() };
        Options { out, resume: false, ..options }
    };
    let ends = over_with(3, &recipe, &given, &StopsIn::new("flow", 0));
    for end in ends {
        let error = end.expect_err("it is to end").to_string();
        assert!(error.contains("checkpoint.parts") && !error.contains("--resume goes on"), "{error}");
    }
    let after = std::fs::read(out.path().join(CHECKPOINT_FILE)).expect("kept");
    assert!(before.0 == after, "the checkpoint of before stands");
    assert!(before.1.iter().all(|part| part.exists()), "with its parts");
    // Another folder that has parts of its own is not taken for this one either.
    std::fs::create_dir(elsewhere.path().join("checkpoint.parts")).expect("made");
    let error =
        over_with(3, &recipe, &given, &StopsIn::new("flow", 0)).swap_remove(0).expect_err("as before");
    assert!(error.to_string().contains("must be the same on the machines of all ranks"), "{error}");
    assert!(before.0 == std::fs::read(out.path().join(CHECKPOINT_FILE)).expect("kept"));
    // What was left of parts that never belonged to a checkpoint goes with the next run.
    std::fs::write(out.path().join("checkpoint.parts/900-0.part"), "half").expect("written");
    let report = go(&recipe, (out.path(), Lies::Disk(2)), Duration::MAX, &Silent).expect("it goes on");
    assert_same(&expected, (whole.path(), out.path()), &report);
}

/// What a run says that goes on.
fn refused(recipe: &Recipe, out: &Path, lies: Lies) -> (u8, String) {
    let error = go(recipe, (out, lies), Duration::MAX, &Silent).expect_err("it cannot go on");
    (error.exit_code(), error.to_string())
}

#[test]
fn what_is_damaged_missing_or_of_another_run_is_named_with_what_was_expected_and_what_to_do() {
    let recipe = land("fbm", "");
    let out = tempfile::tempdir().expect("a folder");
    let stopped = go(&recipe, (out.path(), Lies::Memory(3)), Duration::MAX, &StopsIn::new("hydraulic", 0));
    assert_eq!(stopped.expect_err("it is to end").exit_code(), 130);
    let manifest = out.path().join(CHECKPOINT_FILE);
    let [first, _, last] = parts(out.path()).try_into().expect("three parts");
    let asserted = |said: (u8, String), words: &[&str]| {
        for word in words {
            assert!(said.0 == 4 && said.1.contains(word), "{word}: {said:?}");
        }
        assert!(said.1.contains("without --resume"), "{said:?}");
    };
    let good = std::fs::read(&first).expect("a part");
    let name = first.file_name().expect("it has one").to_string_lossy().into_owned();
    let kinds = [Lies::Alone, Lies::Memory(2), Lies::Disk(4)];
    for lies in kinds {
        let mut flipped = good.clone();
        flipped[good.len() / 3] ^= 16;
        std::fs::write(&first, &flipped).expect("written");
        asserted(refused(&recipe, out.path(), lies), &[&name, "its BLAKE3 hash was to be"]);
        std::fs::write(&first, &good[1..]).expect("written");
        let bytes = format!("a part of {} bytes", good.len());
        asserted(refused(&recipe, out.path(), lies), &[&name, &bytes, "are there"]);
        std::fs::remove_file(&first).expect("removed");
        asserted(refused(&recipe, out.path(), lies), &[&name, &bytes, "cannot be read"]);
        std::fs::write(&first, &good).expect("written");
    }
    // A part of another rank, of the very length.
    let other = std::fs::read(&last).expect("a part");
    if other.len() == good.len() {
        std::fs::write(&first, &other).expect("written");
        asserted(refused(&recipe, out.path(), Lies::Alone), &[&name, "is damaged"]);
        std::fs::write(&first, &good).expect("written");
    }
    asserted(
        refused(&land("fbm", "rain = 0.02"), out.path(), Lies::Alone),
        &["checkpoint.weald", "belongs to another recipe", "rain = 0.02"],
    );
    let whole = std::fs::read(&manifest).expect("kept");
    for at in [3, 12, whole.len() / 2, whole.len() - 1] {
        let mut flipped = whole.clone();
        flipped[at] ^= 4;
        std::fs::write(&manifest, &flipped).expect("written");
        asserted(refused(&recipe, out.path(), Lies::Memory(2)), &["checkpoint.weald"]);
        assert!(first.exists(), "a manifest that cannot be read keeps its parts");
    }
    std::fs::write(&manifest, &whole).expect("written");
    let in_memory = Options { resume: true, ..Options::into_folder(out.path()) };
    let error = Run { recipe: &recipe, options: in_memory }.execute(&Silent).expect_err("of another kind");
    asserted((error.exit_code(), error.to_string()), &["checkpoint.weald", "--distributed or --out-of-core"]);
    assert!(go(&recipe, (out.path(), Lies::Alone), Duration::MAX, &Silent).is_ok(), "nothing was lost");
}

#[test]
fn a_checkpoint_of_a_run_in_memory_is_not_taken_for_parts() {
    let text = "[landscape]\nsize = 40\n[[step]]\ndo = \"fbm\"\n[[step]]\ndo = \"constant\"\ninto = \"snow\"\n\
                [[output]]\nlayer = \"height\"\nfile = \"h.tif\"\n";
    let recipe = Recipe::parse("land.toml", text, &Overrides::default()).expect("good");
    let out = tempfile::tempdir().expect("a folder");
    let stopped = run(&recipe, out.path(), None, &StopsIn::new("", 0).at_once()).expect_err("it is to end");
    assert_eq!(stopped.exit_code(), 130);
    let said = refused(&recipe, out.path(), Lies::Memory(2));
    assert!(said.0 == 4 && said.1.contains("is a checkpoint of a run in memory"), "{said:?}");
}

impl StopsIn<'_> {
    /// Wants the end already.
    fn at_once(self) -> Self {
        Self { told: AtomicU64::new(self.after + 1), ..self }
    }
}

#[test]
fn cells_without_data_are_kept_with_the_rest() {
    let [folder, whole, out] = [0; 3].map(|_| tempfile::tempdir().expect("a folder"));
    let file = ground_with_holes(folder.path());
    let recipe = with_holes(&file, "model = \"han\"\nboundary = \"open\"");
    let expected = run(&recipe, whole.path(), None, &Silent).unwrap_or_else(|error| panic!("{error}"));
    for ((step, after), lies) in
        [(("hydraulic", 1), Lies::Memory(3)), (("flow", 2), Lies::Alone), (("water.zarr", 0), Lies::Disk(4))]
    {
        let ended = go(&recipe, (out.path(), lies), Duration::MAX, &StopsIn::new(step, after));
        assert!(matches!(ended, Err(Error::Interrupted(_))), "{step}: {ended:?}");
        assert!(!parts(out.path()).is_empty(), "{step}");
    }
    let got = go(&recipe, (out.path(), Lies::Memory(2)), Duration::MAX, &Silent);
    let got = got.unwrap_or_else(|error| panic!("{error}"));
    assert_same(&expected, (whole.path(), out.path()), &got);
}

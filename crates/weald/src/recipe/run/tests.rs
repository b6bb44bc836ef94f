use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use super::writer::Writer;
use super::*;
use crate::recipe::testing::parse;
use std::time::Duration;
use weald_core::grid::Field;
use weald_export::Finished;

const RECIPE: &str = "\
[landscape]
size = [9, 7]
seed = 5
[[step]]
do = \"rough\"
[[step]]
do = \"wear\"
iterations = 20
[[output]]
layer = \"height\"
file = \"deep/height.bits\"
[[output]]
picture = \"dot\"
file = \"dot.png\"
";

/// Asks for the end once so many iterations are done.
struct StopsAfter {
    iterations: u64,
    calls: AtomicU64,
}

impl StopsAfter {
    fn new(iterations: u64) -> Self {
        Self { iterations, calls: AtomicU64::new(0) }
    }
}

impl Progress for StopsAfter {
    fn progress(&self, _: u64, _: u64, _: usize) {
        self.calls.fetch_add(1, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.calls.load(Ordering::Relaxed) >= self.iterations
    }
}

fn run(text: &str, out: &Path, resume: bool, progress: &dyn Progress) -> Result<Report, Error> {
    let recipe = parse(text).expect("the recipe is good");
    let options = Options { resume, ..Options::into_folder(out) };
    Run { recipe: &recipe, options }.execute(progress)
}

#[test]
fn a_landscape_in_memory_has_the_bits_of_the_file() {
    let folder = folder();
    run(RECIPE, folder.path(), false, &Silent).expect("runs");
    let landscape = parse(RECIPE).expect("good").landscape().expect("runs");
    let values = landscape.field("height").expect("written").values().iter();
    let bits: Vec<u8> = values.flat_map(|value| value.to_bits().to_le_bytes()).collect();
    assert_eq!(bits, height(folder.path()));
}

/// Sees whether there is a checkpoint when a step begins.
struct Looks<'a> {
    out: &'a Path,
    seen: AtomicU64,
}

impl Progress for Looks<'_> {
    fn step(&self, _: usize, _: usize, _: &str) {
        self.seen.fetch_add(self.out.join(CHECKPOINT_FILE).exists().into(), Ordering::Relaxed);
    }
}

#[test]
fn steps_that_keep_no_checkpoints_of_their_own_get_one_between_them() {
    let generate = "[[step]]\ndo = \"rough\"\n";
    let more = format!("{generate}into = \"one\"\n{generate}into = \"two\"\n{generate}");
    let text = RECIPE.replace(generate, &more).replace("iterations = 20", "iterations = 1");
    let recipe = parse(&text).expect("the recipe is good");
    let seen = |checkpoint_every| {
        let folder = folder();
        let looks = Looks { out: folder.path(), seen: AtomicU64::new(0) };
        let options = Options { checkpoint_every, ..Options::into_folder(folder.path()) };
        Run { recipe: &recipe, options }.execute(&looks).expect("runs");
        looks.seen.into_inner()
    };
    assert_eq!(seen(Duration::ZERO), 3, "before the second, third and fourth step");
    assert_eq!(seen(Duration::from_hours(1)), 0);
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

fn height(out: &Path) -> Vec<u8> {
    std::fs::read(out.join("deep/height.bits")).expect("the run wrote it")
}

fn files_in(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the folder exists");
    let name = |entry: std::io::Result<std::fs::DirEntry>| {
        entry.expect("readable").file_name().to_string_lossy().into_owned()
    };
    let mut names: Vec<_> = entries.map(name).collect();
    names.sort();
    names
}

#[test]
fn a_run_leaves_its_files_and_a_report_and_nothing_else() {
    let out = folder();
    let report = run(RECIPE, out.path(), false, &Silent).expect("runs");
    assert_eq!(files_in(out.path()), ["deep", "dot.png", "report.json"]);
    let text = std::fs::read_to_string(out.path().join(REPORT_FILE)).expect("written");
    let read: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    for key in ["engine", "adapter", "seed", "recipe_blake3", "version", "steps", "outputs"] {
        assert!(read.get(key).is_some(), "the report has `{key}`");
    }
    assert_eq!(read["steps"][1]["iterations"], 20);
    assert_eq!(read["outputs"][0]["layer"], "height");
    for list in ["steps", "outputs"] {
        for each in read[list].as_array().expect("a list") {
            assert!(each["seconds"].as_f64().is_some_and(|seconds| seconds > 0.0), "{each}");
            let peak = each["peak_memory"].as_u64();
            assert!(!cfg!(target_os = "linux") || peak.is_some_and(|bytes| bytes > 1 << 20), "{each}");
        }
    }
    assert_eq!(report.recipe_blake3, parse(RECIPE).expect("good").hash());
}

#[test]
fn a_run_that_is_stopped_and_resumed_ends_with_the_same_bits() {
    let (whole, parts) = (folder(), folder());
    run(RECIPE, whole.path(), false, &Silent).expect("runs");
    for stop in [1, 4, 9] {
        let resume = stop > 1;
        let error = run(RECIPE, parts.path(), resume, &StopsAfter::new(stop)).expect_err("stopped");
        assert_eq!(error.exit_code(), 130);
        assert!(error.to_string().contains("--resume"), "{error}");
        assert_eq!(files_in(parts.path()), ["checkpoint.weald", "deep"], "no output is there yet");
    }
    let report = run(RECIPE, parts.path(), true, &Silent).expect("goes on to the end");
    assert!(report.steps[1].notes[0].contains("after 14 iterations"), "{:?}", report.steps[1].notes);
    assert_eq!(height(whole.path()), height(parts.path()));
    assert_eq!(files_in(parts.path()), ["deep", "dot.png", "report.json"], "the checkpoint is gone");
}

#[test]
fn the_checkpoint_of_another_recipe_is_refused() {
    let out = folder();
    run(RECIPE, out.path(), false, &StopsAfter::new(3)).expect_err("stopped");
    let other = RECIPE.replace("seed = 5", "seed = 6");
    let error = run(&other, out.path(), true, &Silent).expect_err("another seed");
    assert!(error.to_string().contains("`seed = 5`") && error.to_string().contains("`seed = 6`"), "{error}");
    assert_eq!(error.exit_code(), 4);
    run(&other, out.path(), false, &Silent).expect("starts anew");
}

#[test]
fn a_nan_is_reported_with_step_layer_and_cell_and_the_last_good_state() {
    let out = folder();
    let broken = RECIPE.replace("iterations = 20", "iterations = 20\nbreaks_after = 12");
    let recipe = parse(&broken).expect("good");
    let options = Options { checkpoint_every: Duration::ZERO, ..Options::into_folder(out.path()) };
    let error = Run { recipe: &recipe, options }.execute(&Silent).expect_err("a NaN");
    let message = error.to_string();
    assert!(message.contains("step 2 (`wear`): layer `height` became NaN at column 0, row 0"), "{message}");
    assert!(message.contains("checkpoint.weald"), "{message}");
    assert_eq!(error.exit_code(), 1);
    let Error::NotFinite(fault) = error else { panic!("{message}") };
    assert_eq!((fault.step.as_deref(), fault.layer.as_str(), fault.cell), (Some("wear"), "height", [0, 0]));
    assert!(!out.path().join(REPORT_FILE).exists(), "a failed run has no report");
}

#[test]
fn a_file_in_place_of_the_folder_is_found_before_anything_runs() {
    let out = folder();
    let file = out.path().join("file");
    std::fs::write(&file, "x").expect("writes");
    let calls = StopsAfter::new(u64::MAX);
    let error = run(RECIPE, &file, false, &calls).expect_err("not a folder");
    assert_eq!(error.exit_code(), 1);
    assert_eq!(calls.calls.load(Ordering::Relaxed), 0, "nothing ran");
    std::fs::create_dir_all(out.path().join("dot.png")).expect("makes");
    let error = run(RECIPE, out.path(), false, &calls).expect_err("a folder in place of a file");
    assert!(error.to_string().contains("it is a folder"), "{error}");
}

#[test]
fn cells_without_data_are_written_as_such() {
    let recipe = parse(RECIPE).expect("good");
    let size = weald_core::Size::new(3, 1).expect("small");
    let valid = weald_core::grid::Mask::new(size, vec![true, false, true]);
    let mut landscape = Landscape::new(Domain { valid: valid.clone(), ..Domain::new(size, 2.0) });
    landscape.insert("height", "m", Field::from_values(size, vec![5.0, f32::NAN, 7.0]));
    let finished =
        Finished { landscape: &landscape, steps: &[], recipe: &recipe.file, hash: "", seed: recipe.seed };
    let writer = Writer { finished, recipe: &recipe, device: None, next_frame: &|_, _| Ok(()) };
    let raster = writer.raster("height").expect("the layer is there");
    assert_eq!(raster.field.values(), [5.0, 0.0, 7.0]);
    assert_eq!(raster.valid, valid);
    assert_eq!(raster.provenance.map(|provenance| provenance.range), Some((5.0, 7.0)));
}

#[test]
fn steps_of_the_same_kind_draw_different_numbers() {
    let two =
        RECIPE.replace("[[step]]\ndo = \"wear\"\niterations = 20", "[[step]]\ndo = \"rough\"\ninto = \"b\"");
    let two = format!("{two}[[output]]\nlayer = \"b\"\nfile = \"b.bits\"\n");
    let out = folder();
    run(&two, out.path(), false, &Silent).expect("runs");
    assert_ne!(height(out.path()), std::fs::read(out.path().join("b.bits")).expect("written"));
}

const OTHERS: &str = "\
[landscape]
size = [9, 7]
seed = 5
[[step]]
do = \"rough\"
[[output]]
layer = \"height\"
file = \"height.bits\"
preset = \"twice\"
[[output]]
layer = \"height\"
file = \"once.bits\"
[[output]]
export = \"tally\"
file = \"deep/tally.txt\"
";

#[test]
fn an_export_writes_all_its_files_and_the_report_names_them() {
    let folder = folder();
    let report = run(OTHERS, folder.path(), false, &Silent).expect("runs");
    let text = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("written");
    assert_eq!((text("deep/tally.txt").as_str(), text("deep/tally_steps.txt").as_str()), ("63", "1"));
    let output = &report.outputs[2];
    assert_eq!(output.export.as_deref(), Some("tally"));
    assert_eq!(
        (&output.companions, &output.notes),
        (&vec!["deep/tally_steps.txt".to_owned()], &vec!["counted".to_owned()])
    );
}

#[test]
fn a_preset_chooses_how_a_layer_is_written_and_losses_are_reported() {
    let folder = folder();
    let report = run(OTHERS, folder.path(), false, &Silent).expect("runs");
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).expect("written");
    assert_eq!(bytes("height.bits"), bytes("once.bits").repeat(2));
    assert!(report.outputs[0].notes.is_empty());
    assert_eq!(report.outputs[1].notes, ["the side of a cell is left out"]);
}

/// Frame `number` of a film, as the numbers in its one pixel.
fn frame(folder: &Path, film: &str, number: usize) -> Vec<u8> {
    let file = std::fs::File::open(folder.join(format!("{film}-{number:05}.png"))).expect("a frame");
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a PNG");
    let mut pixel = vec![0; 3];
    reader.next_frame(&mut pixel).expect("one pixel");
    pixel
}

const FILMS: &str = "\
[landscape]
size = [9, 7]
seed = 5
[[step]]
do = \"rough\"
relief = 100.0
[[step]]
do = \"wear\"
iterations = 10
[[step]]
do = \"wear\"
iterations = 7
[[output]]
picture = \"dot\"
every = 3
file = \"rise.png\"
[[output]]
picture = \"dot\"
frames = 4
file = \"turn.png\"
";

#[test]
fn a_time_lapse_shows_each_moment_once_and_a_turn_goes_once_around() {
    let folder = folder();
    let report = run(FILMS, folder.path(), false, &Silent).expect("runs");
    // 0, 3, 6 and 9 of the first simulation, 3 and 6 of the second.
    assert_eq!((report.outputs[0].frames, report.outputs[1].frames), (Some(6), Some(4)));
    let heights: Vec<_> = (0..6).map(|number| frame(folder.path(), "rise", number)[1]).collect();
    assert!(heights[0] > 10, "{heights:?}");
    assert!(heights.windows(2).all(|pair| pair[1] < pair[0]), "{heights:?}");
    assert!(!folder.path().join("rise-00006.png").exists());
    let shares: Vec<_> = (0..4).map(|number| frame(folder.path(), "turn", number)[2]).collect();
    assert_eq!(shares, [0, 2, 4, 6]);
}

#[test]
fn an_interrupted_time_lapse_goes_on_with_the_same_frames() {
    let (whole, halves) = (folder(), folder());
    run(FILMS, whole.path(), false, &Silent).expect("runs");
    run(FILMS, halves.path(), false, &StopsAfter::new(13)).expect_err("stopped");
    assert_eq!(files_in(halves.path()), [".weald", CHECKPOINT_FILE], "frames have no names yet");
    let made = new_files(halves.path(), &parse(FILMS).expect("good"));
    let drawn = |frame: &str| made.join(frame).exists();
    assert!(drawn("rise-00003.png") && !drawn("rise-00005.png"));
    run(FILMS, halves.path(), true, &Silent).expect("goes on");
    for number in 0..6 {
        assert_eq!(frame(halves.path(), "rise", number), frame(whole.path(), "rise", number), "{number}");
    }
}

#[test]
fn the_rate_of_a_step_is_its_cells_times_its_iterations_over_its_seconds() {
    let folder = folder();
    let report = run(RECIPE, folder.path(), false, &Silent).expect("runs");
    let step = &report.steps[1];
    assert_eq!((step.cells, step.iterations), (63, 20));
    let updates = step.cell_updates_per_second * step.seconds.max(1e-9);
    assert!((updates / (63.0 * 20.0) - 1.0).abs() < 1e-9, "{updates} updates of cells");
}

#[test]
fn a_second_run_into_a_folder_is_told_who_has_it_and_one_after_the_end_of_the_first_is_not() {
    let out = folder();
    let place = WorkFolder::take(out.path(), &parse(RECIPE).expect("good")).expect("free");
    let error = run(RECIPE, out.path(), false, &Silent).expect_err("taken").to_string();
    let holder = format!("another run (process {}) writes into", std::process::id());
    assert!(error.contains(&holder) && error.contains("choose another --out folder"), "{error}");
    drop(place);
    // What a killed run leaves is a lock file that nobody holds.
    std::fs::create_dir_all(out.path().join(".weald/new/old")).expect("made");
    std::fs::write(out.path().join(".weald/lock"), "process 1").expect("written");
    std::fs::write(out.path().join(".weald/journal.json.1.tmp-weald"), "{").expect("written");
    run(RECIPE, out.path(), false, &Silent).expect("runs");
    assert_eq!(files_in(out.path()), ["deep", "dot.png", "report.json"]);
}

/// Breaks the work folder of a run when its outputs begin.
struct Breaks<'a> {
    out: &'a Path,
    recipe: &'a str,
    entries: &'a [&'a str],
}

impl Progress for Breaks<'_> {
    fn output(&self, number: usize, _: usize, _: &Path) {
        if number == 2 {
            // A folder stands where each file is to be.
            let made = new_files(self.out, &parse(self.recipe).expect("good"));
            for entry in self.entries {
                std::fs::create_dir_all(made.join(entry)).expect("made");
            }
        }
    }
}

#[test]
fn a_run_that_fails_at_its_second_output_leaves_all_files_as_they_were_and_goes_on_later() {
    let out = folder();
    run(RECIPE, out.path(), false, &Silent).expect("runs");
    let all = |out: &Path| [height(out), bytes(out, "dot.png"), bytes(out, REPORT_FILE)];
    let before = all(out.path());
    let other = RECIPE.replace("seed = 5", "seed = 6");
    let breaks = Breaks { out: out.path(), recipe: &other, entries: &["dot.png"] };
    let error = run(&other, out.path(), false, &breaks).expect_err("cannot be written").to_string();
    let named = out.path().join("dot.png").display().to_string();
    assert!(error.contains(&named) && !error.contains(".weald/new"), "{error}");
    assert!(error.contains("no file has changed") && error.contains("--resume"), "{error}");
    assert!(before == all(out.path()), "no file of the run before has changed");
    assert_eq!(files_in(out.path()), [CHECKPOINT_FILE, "deep", "dot.png", "report.json"]);
    run(&other, out.path(), true, &Silent).expect("goes on");
    let whole = folder();
    run(&other, whole.path(), false, &Silent).expect("runs");
    assert_eq!(height(out.path()), height(whole.path()));
}

/// `/dev/full` refuses every byte as a full disk does; a link puts it in the place of the checkpoint that is written first.
#[cfg(target_os = "linux")]
#[test]
fn files_that_are_of_no_use_any_more_make_room_for_the_checkpoint_of_a_finished_landscape() {
    let out = folder();
    let temporary = format!("{CHECKPOINT_FILE}.{}.tmp-weald", std::process::id());
    std::os::unix::fs::symlink("/dev/full", out.path().join(temporary)).expect("linked");
    let breaks = Breaks { out: out.path(), recipe: RECIPE, entries: &["dot.png"] };
    let error = run(RECIPE, out.path(), false, &breaks).expect_err("cannot be written").to_string();
    assert!(error.contains("no file has changed") && error.contains("--resume"), "{error}");
    run(RECIPE, out.path(), true, &Silent).expect("goes on");
}

#[cfg(unix)]
#[test]
fn outputs_that_a_link_brings_into_one_folder_are_refused_before_anything_runs() {
    let out = folder();
    let text = format!("{RECIPE}[[output]]\nlayer = \"height\"\nfile = \"other/height.bits\"\n");
    std::fs::create_dir(out.path().join("deep")).expect("made");
    std::os::unix::fs::symlink("deep", out.path().join("other")).expect("linked");
    let error =
        run(&text, out.path(), false, &Silent).expect_err("one would overwrite the other").to_string();
    assert!(error.contains("is where another output is to be"), "{error}");
}

/// The recipe with a dozen outputs more.
fn with_many_outputs() -> String {
    let more = (0..12).map(|number| format!("[[output]]\nlayer = \"height\"\nfile = \"h{number}.bits\"\n"));
    format!("{RECIPE}{}", more.collect::<String>())
}

fn run_on(threads: usize, text: &str, out: &Path, progress: &dyn Progress) -> Result<Report, Error> {
    let recipe = parse(text).expect("the recipe is good");
    let options = Options { threads: Some(threads), ..Options::into_folder(out) };
    Run { recipe: &recipe, options }.execute(progress)
}

#[test]
fn outputs_made_side_by_side_are_those_made_one_after_the_other_and_in_their_order() {
    let text = with_many_outputs();
    let made = |threads| {
        let out = folder();
        let report = run_on(threads, &text, out.path(), &Silent).expect("runs");
        let files: Vec<_> = report.outputs.iter().map(|output| output.file.clone()).collect();
        let all: Vec<_> = files.iter().map(|file| bytes(out.path(), file)).collect();
        (files, all)
    };
    let one = made(1);
    assert!(one.0.len() == 14 && one.0[13] == "h11.bits", "{:?}", one.0);
    assert!((2..5).all(|threads| made(threads) == one));
    let recipe = parse(&text).expect("good");
    let groups = recipe.output_groups(&recipe.landscape().expect("runs"));
    assert!(groups.len() > 1 && groups.iter().all(|group| (1..=8).contains(&group.len())), "{groups:?}");
    assert_eq!(groups.into_iter().flatten().collect::<Vec<_>>(), (0..14).collect::<Vec<_>>());
}

#[test]
fn of_outputs_that_fail_side_by_side_the_first_is_told() {
    let text = with_many_outputs();
    for threads in 1..5 {
        let out = folder();
        let breaks = Breaks { out: out.path(), recipe: &text, entries: &["h7.bits", "h4.bits"] };
        let error = run_on(threads, &text, out.path(), &breaks).expect_err("cannot be written").to_string();
        assert!(error.contains("h4.bits") && error.contains("no file has changed"), "{error}");
        assert!(files_in(out.path()).iter().all(|file| !file.contains("bits")), "on {threads} threads");
    }
}

fn bytes(out: &Path, file: &str) -> Vec<u8> {
    std::fs::read(out.join(file)).expect("written")
}

#[test]
fn the_next_run_finishes_what_was_ended_while_files_got_their_names() {
    let (whole, cut) = (folder(), folder());
    run(RECIPE, whole.path(), false, &Silent).expect("runs");
    // As a kill after the first of three renames leaves it.
    let recipe = parse(RECIPE).expect("good");
    let new = new_files(cut.path(), &recipe);
    std::fs::create_dir_all(&new).expect("made");
    std::fs::create_dir_all(cut.path().join("deep")).expect("made");
    std::fs::write(cut.path().join("deep/height.bits"), height(whole.path())).expect("written");
    for file in ["dot.png", REPORT_FILE] {
        std::fs::write(new.join(file), bytes(whole.path(), file)).expect("written");
    }
    let files = ["deep/height.bits", "dot.png", REPORT_FILE];
    let made_in = new.file_name().expect("a name").to_string_lossy();
    let journal = serde_json::json!({ "made_in": made_in, "files": files }).to_string();
    std::fs::write(cut.path().join(".weald/journal.json"), journal).expect("written");
    std::fs::write(cut.path().join(CHECKPOINT_FILE), "of the run that was ended").expect("written");
    let report = run(RECIPE, cut.path(), true, &Silent).expect("it is done");
    assert_eq!(report.outputs.len(), 2, "the report is that of the run that was ended");
    for file in files {
        assert!(bytes(cut.path(), file) == bytes(whole.path(), file), "{file}");
    }
    assert_eq!(files_in(cut.path()), ["deep", "dot.png", "report.json"]);
}

#[test]
fn a_journal_that_somebody_sends_moves_nothing_out_of_or_into_other_folders() {
    let (out, theirs) = (folder(), folder());
    std::fs::write(theirs.path().join("letter"), "dear").expect("written");
    let made = out.path().join(".weald/made");
    std::fs::create_dir_all(&made).expect("made");
    std::fs::write(made.join("letter"), "new").expect("written");
    let theirs_file = theirs.path().join("letter");
    for (made_in, file) in [
        (theirs.path(), Path::new("letter")),
        (Path::new("made"), theirs_file.as_path()),
        (Path::new("made"), Path::new("../letter")),
        (Path::new("../.weald/made"), Path::new("letter")),
    ] {
        let journal = serde_json::json!({ "made_in": made_in, "files": [file] }).to_string();
        std::fs::write(out.path().join(".weald/journal.json"), journal).expect("written");
        let error = run(RECIPE, out.path(), false, &Silent).expect_err("refused");
        assert!(error.to_string().contains("is no name within this folder"), "{error}");
        assert_eq!(bytes(theirs.path(), "letter"), b"dear");
        assert_eq!(bytes(&made, "letter"), b"new");
    }
}

/// Puts a folder where checkpoints are to be, and hears notes.
struct NoRoom<'a> {
    out: &'a Path,
    notes: std::sync::Mutex<Vec<String>>,
}

impl Progress for NoRoom<'_> {
    fn step(&self, _: usize, _: usize, _: &str) {
        std::fs::create_dir_all(self.out.join(CHECKPOINT_FILE).join("full")).expect("made");
    }

    fn note(&self, text: &str) {
        self.notes.lock().expect("whole").push(text.to_owned());
    }
}

#[test]
fn a_checkpoint_that_cannot_be_written_is_told_and_the_run_goes_on() {
    let (out, whole) = (folder(), folder());
    run(RECIPE, whole.path(), false, &Silent).expect("runs");
    let recipe = parse(RECIPE).expect("good");
    let calls = NoRoom { out: out.path(), notes: std::sync::Mutex::default() };
    let options = Options { checkpoint_every: Duration::ZERO, ..Options::into_folder(out.path()) };
    let ended = Run { recipe: &recipe, options }.execute(&calls);
    // The folder in its place cannot be removed as a checkpoint is; all files are whole by then.
    assert!(ended.expect_err("a folder").to_string().contains("the run is done"));
    assert_eq!(height(out.path()), height(whole.path()));
    let notes = calls.notes.into_inner().expect("whole").join("\n");
    assert!(notes.contains("no checkpoint: cannot write") && notes.contains("the run goes on"), "{notes}");
}

#[test]
fn temporary_files_of_killed_runs_are_removed_and_told() {
    let out = folder();
    std::fs::create_dir(out.path().join("deep")).expect("made");
    let left = [format!("dot.png.{}.tmp-weald", u32::MAX), format!("deep/h.bits.{}.tmp-weald", u32::MAX)];
    for name in &left {
        std::fs::write(out.path().join(name), "half").expect("written");
    }
    let calls = Hears::default();
    run(RECIPE, out.path(), false, &calls).expect("runs");
    assert!(calls.0.lock().expect("whole").concat().contains("2 temporary files"));
    assert!(left.iter().all(|name| !out.path().join(name).exists()));
}

/// Hears notes.
#[derive(Default)]
struct Hears(std::sync::Mutex<Vec<String>>);

impl Progress for Hears {
    fn note(&self, text: &str) {
        self.0.lock().expect("whole").push(text.to_owned());
    }
}

#[test]
fn a_checkpoint_whose_frames_are_gone_is_refused_and_those_of_another_recipe_stay() {
    let out = folder();
    run(FILMS, out.path(), false, &StopsAfter::new(13)).expect_err("stopped");
    // A run of another recipe that ends before its first checkpoint leaves the frames of this one.
    let other = FILMS.replace("seed = 5", "seed = 6");
    drop(WorkFolder::take(out.path(), &parse(&other).expect("good")).expect("free"));
    let made = new_files(out.path(), &parse(FILMS).expect("good"));
    assert!(made.join("rise-00003.png").exists());
    std::fs::remove_file(made.join("rise-00001.png")).expect("there");
    let error = run(FILMS, out.path(), true, &Silent).expect_err("no frame").to_string();
    assert!(error.contains("rise-00001.png is gone; run without --resume"), "{error}");
    run(FILMS, out.path(), false, &Silent).expect("starts anew");
    assert!(!out.path().join(".weald").exists());
}

#[test]
fn a_run_that_would_take_more_memory_than_is_allowed_does_not_start() {
    let out = folder();
    let recipe = parse(RECIPE).expect("good");
    let options = Options { memory: Some(1 << 20), ..Options::into_folder(out.path()) };
    let error = Run { recipe: &recipe, options }.execute(&Silent).expect_err("a mebibyte is too little");
    assert_eq!(error.exit_code(), 5);
    let message = error.to_string();
    assert!(
        message.contains("of memory, at most 1.0 MiB are allowed") && message.contains("--memory"),
        "{message}"
    );
    assert_eq!(files_in(out.path()), ["deep"], "nothing was made");
    // No machine has the memory of the greatest grid with so many layers in a limited address space.
    let whole = parse(&RECIPE.replace("[9, 7]", "16384")).expect("good");
    let domain = Domain::new(weald_core::Size::square(16384).expect("the greatest"), 1.0);
    assert!(whole.memory(&domain).bytes > 3 << 30);
}

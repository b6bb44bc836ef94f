mod films;
mod folders;
mod side_by_side;

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

#[test]
fn the_rate_of_a_step_is_its_cells_times_its_iterations_over_its_seconds() {
    let folder = folder();
    let report = run(RECIPE, folder.path(), false, &Silent).expect("runs");
    let step = &report.steps[1];
    assert_eq!((step.cells, step.iterations), (63, 20));
    let updates = step.cell_updates_per_second * step.seconds.max(1e-9);
    assert!((updates / (63.0 * 20.0) - 1.0).abs() < 1e-9, "{updates} updates of cells");
}

fn bytes(out: &Path, file: &str) -> Vec<u8> {
    std::fs::read(out.join(file)).expect("written")
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

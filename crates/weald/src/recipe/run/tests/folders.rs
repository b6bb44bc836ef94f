//! What a run leaves in its folder when it fails, is killed or meets another.

use super::*;

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
pub(super) struct Breaks<'a> {
    pub(super) out: &'a Path,
    pub(super) recipe: &'a str,
    pub(super) entries: &'a [&'a str],
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

//! Ranks that hold their own rows alone: files and report of one machine, memory by the share, and ends.

use std::fmt::Write;
use std::path::Path;

use crate::ends::{children, end_of, ends_with_a_checkpoint_when_told, signal, under_way};
use crate::launched::{assert_same, on_one, report, run, said};

const COUNTS: [usize; 5] = [1, 2, 3, 4, 6];

/// Writes a recipe of generated ground, rain on it, and where the water goes, with files of three layers.
fn write_recipe(folder: &Path, size: [usize; 2], hydraulic: &str) {
    let mut text = format!(
        "[landscape]\nsize = {size:?}\ncell = 12.0\nseed = 5\n\
         [[step]]\ndo = \"fbm\"\nrelief = 400\nwavelength = 900\n\
         [[step]]\ndo = \"hydraulic\"\nmodel = \"han\"\n{hydraulic}\n\
         [[step]]\ndo = \"flow\"\n"
    );
    for (layer, more) in [("height", "preset = \"cog\""), ("accumulation", "preset = \"cog\""), ("water", "")]
    {
        let _ = write!(text, "[[output]]\nlayer = \"{layer}\"\nfile = \"{layer}.tif\"\n{more}\n");
    }
    text += "[[output]]\nlayer = \"flow_direction\"\nfile = \"directions.zarr\"\n";
    std::fs::write(folder.join("r.toml"), text).expect("written");
}

#[test]
fn ranks_of_their_own_rows_leave_the_files_and_the_report_of_one_machine() {
    let folder = tempfile::tempdir().expect("a folder");
    write_recipe(folder.path(), [300, 310], "iterations = 90\nboundary = \"open\"\nthermal = {}");
    let scratch = folder.path().join("scratch");
    std::fs::create_dir(&scratch).expect("made");
    let expected = on_one(folder.path());
    for count in COUNTS {
        let disk = ["--out-of-core", "scratch", "--memory", "72MiB"];
        for (kind, more) in [("disk", &disk[..]), ("memory", &["--distributed"])] {
            let out = format!("{kind}-{count}");
            let output = run(count, folder.path(), &out, more);
            assert!(output.status.success(), "{count} ranks, {kind}: {}", said(&output));
            assert_same(folder.path(), &expected, &out);
        }
    }
    assert_eq!(std::fs::read_dir(scratch).expect("there").count(), 0, "nothing is left");
}

/// The most memory that any rank had taken when the run ended, in bytes.
fn peak(count: usize, size: usize) -> u64 {
    let folder = tempfile::tempdir().expect("a folder");
    write_recipe(folder.path(), [size; 2], "iterations = 4");
    let output = run(count, folder.path(), "out", &["--distributed", "--memory", "4GiB"]);
    assert!(output.status.success(), "{count} ranks: {}", said(&output));
    let outputs = report(folder.path(), "out").outputs;
    outputs.last().and_then(|output| output.peak_memory).expect("the system tells it")
}

#[test]
fn no_rank_takes_more_memory_than_its_share() {
    let side = 1400;
    let program = peak(4, 64);
    let [one, four] = [1, 4].map(|count| peak(count, side).saturating_sub(program));
    println!("beside {program} bytes of the program: one rank {one}, each of four at most {four}");
    // The ground, five planes of the simulation, and its grid with eight.
    let whole = 4 * (side * side) as u64 * 14;
    assert!(one > whole / 2, "the whole shows: {one} of {whole}");
    assert!(four < one * 2 / 5, "a quarter, and the rows around it: {four} of {one}");
}

#[test]
fn what_needs_the_whole_is_refused_once_and_before_anything_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "[landscape]\nsize = 64\n[[step]]\ndo = \"diamond-square\"\n[[step]]\ndo = \"thermal\"\n\
                [[output]]\nlayer = \"height\"\nfile = \"h.npy\"\n";
    std::fs::write(folder.path().join("r.toml"), text).expect("written");
    let output = run(3, folder.path(), "out", &["--distributed"]);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    for words in ["`diamond-square`", "`thermal`", "h.npy"] {
        assert_eq!(said(&output).matches(words).count(), 1, "{words}: {}", said(&output));
    }
    assert!(!folder.path().join("out").exists(), "nothing was begun");
}

#[test]
fn a_distributed_run_that_is_killed_or_told_to_end_goes_on_over_another_number_of_ranks() {
    let folder = tempfile::tempdir().expect("a folder");
    write_recipe(folder.path(), [160, 200], "iterations = 1600\nboundary = \"open\"");
    let expected = on_one(folder.path());
    let running = under_way(3, folder.path(), &["--distributed"]);
    signal("KILL", children(running.id())[1]);
    assert!(!end_of(running).success());
    std::fs::create_dir(folder.path().join("scratch")).expect("made");
    let on_disk = ["--out-of-core", "scratch", "--memory", "72MiB", "--resume"];
    let running = under_way(2, folder.path(), &on_disk);
    ends_with_a_checkpoint_when_told(running, folder.path());
    assert!(!folder.path().join("parts/height.tif").exists(), "no half of a result");
    let output = run(4, folder.path(), "parts", &["--distributed", "--resume"]);
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("going on after 1 steps"), "{}", said(&output));
    assert_same(folder.path(), &expected, "parts");
    assert!(!folder.path().join("parts/checkpoint.parts").exists(), "nothing is left");
}

#[test]
fn a_disk_that_one_run_has_not_ends_all_ranks_with_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    write_recipe(folder.path(), [64, 100], "iterations = 4");
    let output = run(3, folder.path(), "out", &["--out-of-core", "missing", "--memory", "1GiB"]);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(said(&output).contains("step 1 (`fbm`): cannot write missing"), "{}", said(&output));
    let resumed = run(2, folder.path(), "out", &["--distributed", "--resume"]);
    assert!(said(&resumed).contains("there is no checkpoint; run without --resume"), "{}", said(&resumed));
}

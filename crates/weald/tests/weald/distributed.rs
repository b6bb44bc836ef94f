//! Ranks that hold their own rows alone: the files and the report of a run on one machine, and no cell too many.

use std::path::Path;
use std::sync::Arc;

use weald::Error;
use weald::engine::Engine;
use weald::engine::ranks::{Ranks, ranks_in_threads};
use weald::recipe::{Options, Progress, Recipe, Report, Run, Silent};

use crate::out_of_core::{BESIDE, assert_same_files, land, recipe, run, said};

/// A run over ranks, each of which calls it: what the first says, and the others.
fn over(
    count: usize,
    (recipe, out): (&Recipe, &Path),
    (disk, memory): (Option<&Path>, u64),
    progress: &(dyn Progress + Sync),
) -> Vec<Result<Report, Error>> {
    // The folder is the first rank's alone.
    let of_rank = |rank| if rank == 0 { out.to_owned() } else { out.join("never-made") };
    let options = |rank| Options {
        out_of_core: disk.map(Path::to_owned),
        memory: Some(memory),
        ..Options::into_folder(of_rank(rank))
    };
    over_with(count, recipe, &options, progress)
}

/// The same with the options of each rank.
pub(crate) fn over_with(
    count: usize,
    recipe: &Recipe,
    options: &(dyn Fn(usize) -> Options + Sync),
    progress: &(dyn Progress + Sync),
) -> Vec<Result<Report, Error>> {
    let work = |ranks: Arc<dyn Ranks>| {
        let options = options(ranks.rank());
        let engine = Engine::Ranks(ranks);
        let options = Options { engine, distributed: true, threads: Some(2), ..options };
        Run { recipe, options }.execute(progress)
    };
    std::thread::scope(|scope| {
        let running: Vec<_> =
            ranks_in_threads(count).into_iter().map(|ranks| scope.spawn(|| work(ranks))).collect();
        running.into_iter().map(|rank| rank.join().expect("no panic")).collect()
    })
}

/// That all ranks ended well, and that the first left the files and the report of a run in memory.
fn assert_same(
    expected: &Report,
    (whole, parts): (&Path, &Path),
    got: Vec<Result<Report, Error>>,
    what: &str,
) {
    let got: Vec<_> =
        got.into_iter().map(|got| got.unwrap_or_else(|error| panic!("{what}: {error}"))).collect();
    for report in &got {
        let mut steps = said(&Report { engine: "cpu".to_owned(), ..report.clone() });
        let mut first = said(expected);
        // The files beside a file are known to the rank that wrote it.
        if !std::ptr::eq(report, &raw const got[0]) {
            steps.truncate(report.steps.len());
            first.truncate(report.steps.len());
        }
        assert_eq!(steps, first, "{what}");
        assert_eq!(report.engine, "ranks");
    }
    assert_same_files(expected, [whole, parts], what);
    assert!(!parts.join("never-made").exists(), "only the first rank has a folder");
}

#[test]
fn ranks_of_their_own_rows_give_the_files_and_the_report_of_one_machine() {
    let thermal =
        "boundary = \"open\"\nthermal = { talus = 0.6, strength = 0.05 }\ntransport = \"maccormack\"";
    let mei = "model = \"mei\"\nboundary = \"open\"\ninitial_water = \"pond\"";
    let lands = [("fbm", ""), ("ridged", thermal), ("fbm", mei)];
    for (number, (generator, hydraulic)) in lands.into_iter().enumerate() {
        let recipe = land(generator, hydraulic);
        let [whole, scratch] = [0; 2].map(|_| tempfile::tempdir().expect("a folder"));
        let expected = run(&recipe, whole.path(), None, &Silent).unwrap_or_else(|error| panic!("{error}"));
        for count in [1, 2, 3, 4, 6] {
            let on_disk = (count + number).is_multiple_of(2);
            let given = if on_disk { (Some(scratch.path()), BESIDE + (9 << 20)) } else { (None, 1 << 30) };
            let parts = tempfile::tempdir().expect("a folder");
            let got = over(count, (&recipe, parts.path()), given, &Silent);
            let what = format!("{generator} {hydraulic} over {count} ranks, on disk: {on_disk}");
            assert_same(&expected, (whole.path(), parts.path()), got, &what);
            assert_eq!(std::fs::read_dir(scratch.path()).expect("it is there").count(), 0, "nothing is left");
        }
    }
}

#[test]
fn what_one_rank_cannot_do_ends_all_and_is_named() {
    let recipe = land("fbm", "");
    let [out, scratch] = [0; 2].map(|_| tempfile::tempdir().expect("a folder"));
    let missing = |ranks: Arc<dyn Ranks>| {
        let disk = scratch.path().join(if ranks.rank() == 1 { "missing" } else { "" });
        let options = Options {
            engine: Engine::Ranks(ranks),
            distributed: true,
            out_of_core: Some(disk),
            memory: Some(1 << 30),
            ..Options::into_folder(out.path().join("out"))
        };
        Run { recipe: &recipe, options }.execute(&Silent).expect_err("no folder").to_string()
    };
    let told: Vec<_> = std::thread::scope(|scope| {
        let running: Vec<_> =
            ranks_in_threads(3).into_iter().map(|ranks| scope.spawn(|| missing(ranks))).collect();
        running.into_iter().map(|rank| rank.join().expect("no panic")).collect()
    });
    assert!(
        told.iter().all(|told| told.starts_with("step 1 (`fbm`): ") && told.contains("missing")),
        "{told:?}"
    );
    assert!(told[0].contains("rank 1: ") && told[2].contains("rank 1: "), "{told:?}");
    assert!(!out.path().join("out/height.tif").exists(), "nothing is half written");
}

#[test]
fn a_limit_and_what_is_refused_end_all_ranks_alike() {
    let [out, scratch] = [0; 2].map(|_| tempfile::tempdir().expect("a folder"));
    let land = land("fbm", "");
    let said = |recipe: &Recipe, given: (Option<&Path>, u64), progress: &(dyn Progress + Sync)| {
        let ends = over(3, (recipe, &out.path().join("out")), given, progress).into_iter();
        let ends = ends.map(|end| end.expect_err("it ends early"));
        let said: Vec<_> = ends.map(|error| (error.exit_code(), error.to_string())).collect();
        assert!(said.iter().all(|end| end.0 == said[0].0), "{said:?}");
        said[0].clone()
    };
    let narrow = said(&land, (None, BESIDE + (1 << 19)), &Silent);
    assert!(narrow.0 == 5 && narrow.1.contains("the rows of one rank"), "{narrow:?}");
    let narrow = said(&land, (Some(scratch.path()), BESIDE + (1 << 20)), &Silent);
    assert!(narrow.0 == 5 && narrow.1.contains("330 columns"), "{narrow:?}");
    let whole = recipe(
        "[landscape]\nsize = 40\n[[step]]\ndo = \"diamond-square\"\n[[output]]\nlayer = \"height\"\nfile = \"h.tif\"\n",
    );
    let refused = said(&whole, (None, 1 << 30), &Silent);
    assert!(refused.0 == 3 && refused.1.contains("`diamond-square`"), "{refused:?}");
    let left =
        std::fs::read_dir(out.path().join("out")).expect("the folder").map(|entry| entry.expect("one"));
    let left: Vec<_> = left.map(|entry| entry.file_name()).collect();
    assert!(left.iter().all(|name| name == "water"), "no files: {left:?}");
}

#[test]
fn an_engine_that_has_no_ranks_is_refused() {
    let out = tempfile::tempdir().expect("a folder");
    let land = land("fbm", "");
    let refused =
        |options: Options| Run { recipe: &land, options }.execute(&Silent).expect_err("refused").to_string();
    let into = || Options {
        distributed: true,
        memory: Some(1 << 30),
        ..Options::into_folder(out.path().join("out"))
    };
    assert!(refused(into()).contains("made by ranks, and not on the engine `cpu`"));
    let alone = || ranks_in_threads(1).remove(0);
    let undistributed = Options { distributed: false, out_of_core: Some(out.path().to_owned()), ..into() };
    let undistributed = refused(Options { engine: Engine::Ranks(alone()), ..undistributed });
    assert!(undistributed.contains("is distributed"), "{undistributed}");
    assert!(!out.path().join("out").exists());
}

/// Runs by rows, over so many ranks each or from disk (0), beside one in memory: same report and same files.
pub(crate) fn assert_same_by_rows(recipe: &Recipe, counts: &[usize], what: &str) {
    let [whole, scratch] = [0; 2].map(|_| tempfile::tempdir().expect("a folder"));
    let expected = run(recipe, whole.path(), None, &Silent).unwrap_or_else(|error| panic!("{error}"));
    for &count in counts {
        let out = tempfile::tempdir().expect("a folder");
        let got = if count == 0 {
            run(recipe, out.path(), Some((scratch.path(), BESIDE + (8 << 20))), &Silent)
        } else {
            let options = |_| Options { memory: Some(1 << 30), ..Options::into_folder(out.path()) };
            over_with(count, recipe, &options, &Silent).swap_remove(0)
        };
        let got = got.unwrap_or_else(|error| panic!("{what} over {count}: {error}"));
        let what = format!("{what} over {count}");
        assert_eq!(said(&Report { engine: "cpu".to_owned(), ..got }), said(&expected), "{what}");
        assert_same_files(&expected, [whole.path(), out.path()], &what);
    }
}

//! `weald-mpi` started by `mpirun`, and the same recipe on one processor.

use std::path::Path;
use std::process::{Command, Output};

use weald::recipe::{Options, Overrides, Recipe, Report, Run, Silent};

/// What `mpirun` needs where there are fewer cores than ranks, and where a test runs as root in a container.
pub(crate) const LAUNCHER: [&str; 6] =
    ["--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle"];

/// `mpirun` of so many ranks, each of which begins `weald-mpi`.
pub(crate) fn mpirun(count: usize) -> Command {
    let mut command = Command::new("mpirun");
    command.args(LAUNCHER).args(["1", "-n", &count.to_string(), env!("CARGO_BIN_EXE_weald-mpi")]);
    command
}

/// What a run of so many ranks of the recipe in a folder says.
pub(crate) fn run(count: usize, folder: &Path, out: &str, more: &[&str]) -> Output {
    let mut command = mpirun(count);
    command.current_dir(folder).args(["run", "r.toml", "--threads", "1", "--out", out]).args(more);
    command.output().expect("mpirun is installed (openmpi-bin)")
}

/// The run of the recipe in a folder on one processor, into the folder `one`.
pub(crate) fn on_one(folder: &Path) -> Report {
    let path = folder.join("r.toml");
    let recipe = Recipe::load(&path, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    let options = Options::into_folder(folder.join("one"));
    Run { recipe: &recipe, options }.execute(&Silent).unwrap_or_else(|error| panic!("{error}"))
}

/// The report that a run has left.
pub(crate) fn report(folder: &Path, out: &str) -> Report {
    Report::read(&folder.join(out).join("report.json")).unwrap_or_else(|error| panic!("{error}"))
}

/// What `mpirun` printed on its standard error output.
pub(crate) fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// That two runs have left the same bytes, and reports that differ in engine and times alone.
pub(crate) fn assert_same(folder: &Path, expected: &Report, out: &str) {
    let got = report(folder, out);
    let names: Vec<_> = expected.outputs.iter().map(|output| output.file.clone()).collect();
    assert!(!names.is_empty(), "a run without files shows nothing");
    for name in names {
        let [ours, theirs] = ["one", out].map(|run| contents(&folder.join(run).join(&name)));
        assert!(ours == theirs, "{out}: {name} differs");
    }
    for (ours, theirs) in expected.steps.iter().zip(&got.steps) {
        let all = |step: &weald::recipe::StepReport| {
            // A run that went on says so, and nothing else is new.
            let notes = step.notes.iter().filter(|note| !note.starts_with("went on from a checkpoint"));
            let text = format!("{:?} {:?} {:?}", step.budget, step.measures, notes.collect::<Vec<_>>());
            (step.step.clone(), step.iterations, text)
        };
        assert_eq!(all(ours), all(theirs), "{out}");
    }
    assert_eq!((expected.steps.len(), got.engine.as_str()), (got.steps.len(), "ranks"));
}

/// A file, or all in a folder, by names within it.
fn contents(path: &Path) -> Vec<(String, Vec<u8>)> {
    if path.is_file() {
        return vec![(String::new(), std::fs::read(path).expect("written"))];
    }
    let mut all = Vec::new();
    for entry in std::fs::read_dir(path).expect("written") {
        let name = entry.expect("one").file_name().into_string().expect("plain names");
        let inside = contents(&path.join(&name)).into_iter();
        all.extend(inside.map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
    }
    all.sort();
    all
}

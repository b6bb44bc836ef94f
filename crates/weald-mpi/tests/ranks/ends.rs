//! Runs that end early: faults are said once, a lost rank ends all, and a run goes on to the same bits.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant, SystemTime};

use crate::launched::{assert_same, mpirun, on_one, run, said};

/// Longest that a test waits for something that should happen soon; machines of tests are busy.
const TIMEOUT: Duration = Duration::from_mins(4);

/// How often a rank is killed.
fn kills() -> usize {
    std::env::var("WEALD_KILLS").map_or(3, |kills| kills.parse().expect("WEALD_KILLS is a number"))
}

/// A recipe long enough to be interrupted so often, in a folder of its own.
pub(crate) fn long(interrupted: usize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    // A checkpoint comes every 256 iterations at most.
    let iterations = 700 * (interrupted + 2);
    let text = format!(
        "[landscape]\nsize = [160, 200]\ncell = 10.0\nseed = 3\n\
         [[step]]\ndo = \"diamond-square\"\nrelief = 300\n\
         [[step]]\ndo = \"hydraulic\"\niterations = {iterations}\n\
         [[output]]\nlayer = \"height\"\nfile = \"height.npy\"\n\
         [[output]]\nlayer = \"water\"\nfile = \"water.npy\"\n"
    );
    std::fs::write(folder.path().join("r.toml"), text).expect("written");
    folder
}

/// Waits until something is so.
fn wait_until(what: &str, mut is_so: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < TIMEOUT, "waited in vain: {what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// A run in the background that keeps a checkpoint as often as it can, after its first one.
pub(crate) fn under_way(count: usize, folder: &Path, more: &[&str]) -> Child {
    let stderr = std::fs::File::create(folder.join("stderr")).expect("a file");
    let before = checkpoint_of(folder);
    let child = mpirun(count)
        .current_dir(folder)
        .args(["run", "r.toml", "--threads", "1", "--out", "parts", "--checkpoint-every", "0"])
        .args(more)
        .stderr(stderr)
        .stdout(Stdio::null())
        .spawn()
        .expect("mpirun is installed (openmpi-bin)");
    wait_for_a_checkpoint(folder, before);
    child
}

/// When the checkpoint was written that is there.
fn checkpoint_of(folder: &Path) -> Option<SystemTime> {
    checkpoint(folder).metadata().and_then(|about| about.modified()).ok()
}

/// Waits until there is another checkpoint than before.
pub(crate) fn wait_for_a_checkpoint(folder: &Path, before: Option<SystemTime>) {
    wait_until("a checkpoint", || checkpoint_of(folder).is_some_and(|now| Some(now) != before));
}

fn checkpoint(folder: &Path) -> PathBuf {
    folder.join("parts/checkpoint.weald")
}

/// Processes that a process has started.
pub(crate) fn children(parent: u32) -> Vec<u32> {
    let folders = std::fs::read_dir("/proc").expect("a system that lists processes").flatten();
    let numbers = folders.filter_map(|entry| entry.file_name().to_str()?.parse::<u32>().ok());
    let mut found: Vec<_> = numbers
        .filter(|number| {
            let status = std::fs::read_to_string(format!("/proc/{number}/status")).unwrap_or_default();
            status.lines().any(|line| line.strip_prefix("PPid:").map(str::trim) == Some(&parent.to_string()))
        })
        .collect();
    found.sort_unstable();
    found
}

pub(crate) fn end_of(mut child: Child) -> ExitStatus {
    let mut status = None;
    wait_until("the end of a run", || {
        status = child.try_wait().expect("a child can be waited for");
        status.is_some()
    });
    status.expect("it has ended")
}

/// As `srun` and `scancel` do: all ranks get the signal, and the launcher none.
pub(crate) fn ends_with_a_checkpoint_when_told(running: Child, folder: &Path) {
    for rank in children(running.id()) {
        signal("TERM", rank);
    }
    let status = end_of(running);
    let said_by_run = std::fs::read_to_string(folder.join("stderr")).expect("read");
    assert_eq!(status.code(), Some(130), "{said_by_run}");
    assert!(said_by_run.contains("the same command with --resume goes on"), "{said_by_run}");
}

pub(crate) fn signal(name: &str, process: u32) {
    let sent = Command::new("kill").args([&format!("-{name}"), &process.to_string()]).status();
    assert!(sent.is_ok_and(|status| status.success()), "{name} to {process}");
}

#[test]
fn a_killed_rank_ends_the_run_on_all_and_it_goes_on_to_the_same_bits() {
    let folder = long(kills());
    let expected = on_one(folder.path());
    for kill in 0..kills() {
        let resumed: &[&str] = if kill == 0 { &[] } else { &["--resume"] };
        let count = 2 + kill % 3;
        let running = under_way(count, folder.path(), resumed);
        let ranks = children(running.id());
        assert_eq!(ranks.len(), count, "{ranks:?}");
        signal("KILL", ranks[kill % count]);
        let status = end_of(running);
        assert!(!status.success(), "{status}");
        wait_until("the end of all ranks", || {
            ranks.iter().all(|rank| !Path::new(&format!("/proc/{rank}")).exists())
        });
        let said = std::fs::read_to_string(folder.path().join("stderr")).expect("read");
        assert!(said.contains("exited on signal 9 (Killed)") && said.contains("rank"), "{said}");
        assert!(!folder.path().join("parts/height.npy").exists(), "no half of a result");
        assert!(checkpoint(folder.path()).exists(), "the last checkpoint stands");
    }
    let output = run(4, folder.path(), "parts", &["--resume"]);
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("going on after 1 steps"), "{}", said(&output));
    assert_same(folder.path(), &expected, "parts");
}

#[test]
fn a_signal_of_the_scheduler_makes_a_checkpoint_from_which_another_number_of_ranks_goes_on() {
    let folder = long(1);
    let expected = on_one(folder.path());
    let running = under_way(3, folder.path(), &[]);
    ends_with_a_checkpoint_when_told(running, folder.path());
    let output = run(2, folder.path(), "parts", &["--resume"]);
    assert!(output.status.success(), "{}", said(&output));
    assert_same(folder.path(), &expected, "parts");
}

#[test]
fn what_is_wrong_is_said_once_with_the_exit_code_of_weald() {
    let folder = tempfile::tempdir().expect("a folder");
    let wrong = |text: &str| {
        std::fs::write(folder.path().join("r.toml"), text).expect("written");
        let output = run(3, folder.path(), "out", &[]);
        (output.status.code(), said(&output))
    };
    let start = "[landscape]\nsize = 16\ncell = 1.0\n";
    let (code, said) = wrong(&format!("{start}[[step]]\ndo = \"thermall\"\n"));
    assert_eq!((code, said.matches("did you mean `thermal`").count()), (Some(3), 1), "{said}");
    let (code, said) = wrong(&format!("{start}[[step]]\ndo = \"thermal\"\n"));
    assert_eq!(
        (code, said.matches("error: ").count()),
        (Some(3), said.matches("error: r.toml").count()),
        "{said}"
    );
    let usage = mpirun(3).args(["run"]).output().expect("mpirun is installed (openmpi-bin)");
    let said = String::from_utf8_lossy(&usage.stderr).into_owned();
    assert_eq!((usage.status.code(), said.matches("Usage: weald-mpi run").count()), (Some(2), 1), "{said}");
    let missing = mpirun(2).args(["run", "there-is-none.toml"]).output().expect("as above");
    let said = String::from_utf8_lossy(&missing.stderr).into_owned();
    assert_eq!((missing.status.code(), said.matches("there-is-none.toml").count()), (Some(3), 1), "{said}");
}

#[test]
fn a_rank_that_lacks_a_file_ends_the_run_on_all_and_is_named() {
    let folder = long(1);
    let recipe = folder.path().join("r.toml");
    let text = std::fs::read_to_string(&recipe).expect("read");
    let text = text.replace("iterations = 2100", "iterations = 40\nedits = \"s.jsonl\"");
    std::fs::write(&recipe, text).expect("written");
    std::fs::write(folder.path().join("s.jsonl"), "").expect("written");
    // The second rank begins in a folder without the script.
    let elsewhere = tempfile::tempdir().expect("a folder");
    let mut command = mpirun(1);
    command.current_dir(folder.path()).args(["run", "r.toml", ":", "-n", "1", "--wdir"]);
    command.arg(elsewhere.path()).args([env!("CARGO_BIN_EXE_weald-mpi"), "run", "r.toml"]);
    let output = command.output().expect("mpirun is installed (openmpi-bin)");
    assert!(!output.status.success());
    let said = said(&output);
    assert!(said.contains("error: rank 1: ") && said.contains("s.jsonl"), "{said}");
}

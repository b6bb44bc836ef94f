//! What a power cut would leave: no file has its name before its bytes are on disk, and no name is left to the system's memory.
//!
//! Nobody can cut the power in a test; the calls that a run makes are looked at instead, by `strace`.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::kills::RECIPE;
use crate::place::Place;

/// A call that has succeeded, of one thread.
#[derive(Debug)]
struct Call {
    thread: String,
    name: String,
    /// Paths in its arguments, in their order.
    paths: Vec<PathBuf>,
    /// Whether it can make a file or a folder.
    makes: bool,
}

impl Call {
    fn is_rename(&self) -> bool {
        self.name.starts_with("rename")
    }

    fn brings_to_disk(&self, path: &Path) -> bool {
        matches!(self.name.as_str(), "fsync" | "fdatasync") && self.paths[0] == path
    }
}

/// A line of the trace; those that were interrupted by another thread are in two parts, which are joined before.
fn call(line: &str) -> Option<Call> {
    let (thread, rest) = line.split_once(' ')?;
    let (name, rest) = rest.trim_start().split_once('(')?;
    let (arguments, result) = rest.rsplit_once(" = ")?;
    if result.starts_with('-') {
        return None;
    }
    // `fsync(5</folder/file>)`, `rename("/folder/one", "/folder/two")`: a handle has its path in angle brackets.
    let paths: Vec<_> = match name {
        "fsync" | "fdatasync" => {
            let path = arguments.split_once('<')?.1.rsplit_once('>')?.0;
            vec![PathBuf::from(path)]
        }
        _ => arguments.split('"').skip(1).step_by(2).map(PathBuf::from).collect(),
    };
    let makes = name.starts_with("mkdir") || arguments.contains("O_CREAT");
    Some(Call { thread: thread.to_owned(), name: name.to_owned(), paths, makes })
}

/// All calls of a run, in the order in which they ended.
fn calls(trace: &str) -> Vec<Call> {
    let mut begun = HashMap::new();
    let mut all = Vec::new();
    for line in trace.lines() {
        let thread = line.split(' ').next().unwrap_or_default();
        let joined = if let Some((first, _)) = line.split_once(" <unfinished ...>") {
            begun.insert(thread, first);
            continue;
        } else if let Some((_, last)) = line.split_once(" resumed>") {
            format!("{}{last}", begun.remove(thread).expect("it was begun"))
        } else {
            line.to_owned()
        };
        all.extend(call(&joined));
    }
    all
}

/// Runs the recipe, with all calls that have to do with names, into `out`.
fn trace(place: &Place, out: &Path) -> Vec<Call> {
    let written = place.path("trace");
    let run =
        place.command(&["run", "r.toml", "--quiet", "--engine", "cpu", "--checkpoint-every", "0", "--out"]);
    let mut command = Command::new("strace");
    command.args([
        "-f",
        "-y",
        "-s",
        "4096",
        "-e",
        "trace=openat,mkdir,mkdirat,rename,renameat,renameat2,fsync,fdatasync",
    ]);
    command.arg("-o").arg(&written).arg(run.get_program()).args(run.get_args()).arg(out);
    command.current_dir(place.path("")).env("WEALD_CACHE", "off");
    let output = command.output().unwrap_or_else(|cause| {
        panic!("strace does not start ({cause}); install it: apt-get install strace")
    });
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    calls(&std::fs::read_to_string(written).expect("a trace"))
}

/// What was made under a name, or below it, is on disk before the name is given.
fn assert_whole(before: &[Call], from: &Path) {
    let made = before.iter().enumerate().filter(|(_, call)| call.makes && call.paths[0].starts_with(from));
    for (at, call) in made {
        let path = &call.paths[0];
        let later = &before[at..];
        if call.name == "openat" {
            assert!(later.iter().any(|call| call.brings_to_disk(path)), "{} is not on disk", path.display());
        }
        if path != from {
            let folder = path.parent().expect("it lies in a folder");
            assert!(
                later.iter().any(|call| call.brings_to_disk(folder)),
                "{} has no name on disk",
                path.display()
            );
        }
    }
}

#[test]
fn bytes_are_on_disk_before_a_file_has_its_name_and_names_before_the_next() {
    let place = Place::with(RECIPE);
    let out = place.path("").canonicalize().expect("a folder").join("deep/out");
    let calls = trace(&place, &out);
    let mut named = BTreeSet::new();
    for (at, call) in calls.iter().enumerate().filter(|(_, call)| call.is_rename()) {
        let [from, to] = &call.paths[..] else { panic!("{call:?}") };
        assert_whole(&calls[..at], from);
        let folder = to.parent().expect("it lies in a folder");
        let mut after = calls[at + 1..].iter().filter(|later| later.thread == call.thread);
        let synced = after.find(|later| later.brings_to_disk(folder) || later.is_rename());
        assert!(
            synced.is_some_and(|call| !call.is_rename()),
            "{} is not on disk before the next",
            to.display()
        );
        named.insert(to);
    }
    for (at, call) in calls.iter().enumerate().filter(|(_, call)| call.name.starts_with("mkdir")) {
        let folder = call.paths[0].parent().expect("it lies in a folder");
        let kept = calls[at..].iter().any(|later| later.brings_to_disk(folder));
        assert!(kept || !call.paths[0].starts_with(&out), "{} has no name on disk", call.paths[0].display());
    }
    let files = std::fs::read_dir(&out).expect("a folder").flatten().map(|entry| entry.path());
    let unnamed: Vec<_> = files.filter(|path| !path.ends_with("maps") && !named.contains(path)).collect();
    assert!(unnamed.is_empty(), "{unnamed:?} have their names otherwise");
    assert!(out.join("rise.mp4").exists() && out.join("height.zarr").exists());
}

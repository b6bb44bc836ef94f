//! Runs that are interrupted or killed, and go on.

use std::process::{Command, Output, Stdio};
use std::time::Duration;

use crate::place::{Place, assert_ends};

const LONG: &str = "\
[landscape]
size = 128
cell = 10.0
[[step]]
do = \"diamond-square\"
relief = 100.0
[[step]]
do = \"hydraulic\"
iterations = 4000
[[output]]
layer = \"height\"
file = \"height.npy\"
[[output]]
layer = \"water\"
file = \"water.npy\"
";

/// Starts a run and sends it a signal once its first checkpoint is there.
fn interrupt(place: &Place, arguments: &[&str], checkpoint: &str, signal: &str) -> Output {
    let mut command = place.command(arguments);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the command starts");
    for _ in 0..6000 {
        if place.path(checkpoint).exists() {
            break;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    // The shell's own kill: the program of that name is not on every machine.
    let kill = format!("kill -{signal} {}", child.id());
    let killed = Command::new("sh").args(["-c", &kill]).status().expect("a shell starts");
    assert!(killed.success(), "the run was still there to be interrupted");
    child.wait_with_output().expect("it ends")
}

fn assert_same_files(place: &Place) {
    for file in ["height.npy", "water.npy"] {
        let [whole, parts] =
            ["whole", "parts"].map(|out| std::fs::read(place.path(out).join(file)).expect(file));
        assert!(whole == parts, "{file} has the same bits");
    }
}

#[test]
fn a_killed_run_goes_on_from_its_checkpoint_to_the_same_bits() {
    let place = Place::with(LONG);
    assert_ends(&place, &["run", "r.toml", "--out", "whole"], 0, &[]);
    let arguments = ["run", "r.toml", "--out", "parts", "--checkpoint-every", "0", "--threads", "2"];
    let output = interrupt(&place, &arguments, "parts/checkpoint.weald", "KILL");
    assert_eq!(output.status.code(), None, "it had no time to end by itself");
    assert!(!place.path("parts/height.npy").exists(), "it had not come to its end");
    assert_ends(&place, &["run", "r.toml", "--out", "parts", "--resume", "--threads", "1"], 0, &[]);
    assert_same_files(&place);
}

#[test]
fn an_interrupted_run_ends_with_130_and_resumes_to_the_same_bits() {
    let place = Place::with(LONG);
    assert_ends(&place, &["run", "r.toml", "--out", "whole"], 0, &[]);
    let arguments = ["run", "r.toml", "--out", "parts", "--checkpoint-every", "0"];
    let output = interrupt(&place, &arguments, "parts/checkpoint.weald", "INT");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{message}");
    assert!(message.contains("--resume") && message.contains("parts/checkpoint.weald"), "{message}");
    assert_eq!(place.names("parts"), ["checkpoint.weald"], "no half file is left");
    let changed = ["run", "r.toml", "--out", "parts", "--resume", "--seed", "1"];
    assert_ends(&place, &changed, 4, &["another recipe", "seed = 1"]);
    assert_ends(&place, &["run", "r.toml", "--out", "parts", "--resume"], 0, &[]);
    assert_same_files(&place);
    assert_eq!(place.names("parts"), ["height.npy", "report.json", "water.npy"]);
}

#[test]
fn an_interrupted_gallery_ends_with_130_and_keeps_what_is_done() {
    let place = Place::with(LONG);
    let output = interrupt(&place, &["gallery", "--out", "figures"], "figures/index.md", "INT");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{message}");
    assert!(message.contains("figure 1/") && !message.contains("figure 20/"), "{message}");
    let page = std::fs::read_to_string(place.path("figures/index.md")).expect("a page");
    assert!(page.contains("(fault-stages.png)") && place.path("figures/fault-stages.png").exists(), "{page}");
}

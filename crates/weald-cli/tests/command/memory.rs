//! What the check says of memory, beside what a run takes.

use std::process::Stdio;

use crate::place::{Place, assert_ends, stdout};

/// A recipe of a million cells with these steps.
fn place(steps: &str) -> Place {
    Place::with(&format!(
        "[landscape]\nsize = 1024\ncell = 20.0\n[[step]]\ndo = \"fbm\"\nrelief = 300.0\n{steps}[[output]]\nlayer = \
         \"height\"\nfile = \"height.npy\"\n"
    ))
}

/// Bytes that the check tells.
fn estimated(place: &Place) -> f64 {
    let said = stdout(&place.weald(&["check", "r.toml"]));
    let words: Vec<_> = said.split("memory: about ").nth(1).expect("it is told").split(' ').collect();
    assert_eq!(words[1], "MiB", "{said}");
    words[0].parse::<f64>().expect("a number") * f64::from(1 << 20)
}

/// Most bytes that a run takes, as the system counts them while it runs.
fn taken(place: &Place) -> f64 {
    let mut command = place.command(&["run", "r.toml", "--engine", "cpu", "--quiet"]);
    let mut child = command.stdout(Stdio::null()).spawn().expect("it starts");
    let path = format!("/proc/{}/status", child.id());
    let mut most: f64 = 0.0;
    while child.try_wait().expect("it is ours").is_none() {
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kibibytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok());
        most = most.max(kibibytes.unwrap_or(0.0));
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    most * 1024.0
}

#[cfg(target_os = "linux")]
#[test]
fn the_memory_that_a_check_tells_is_within_a_third_of_what_a_run_takes() {
    for steps in [
        "[[step]]\ndo = \"hydraulic\"\niterations = 3\n",
        "[[step]]\ndo = \"hydraulic\"\nmodel = \"mei\"\niterations = 3\n",
        "[[step]]\ndo = \"thermal\"\niterations = 3\n",
        "[[step]]\ndo = \"flow\"\n[[step]]\ndo = \"rivers\"\n[[step]]\ndo = \"sunlight\"\n",
    ] {
        let place = place(steps);
        let ratio = estimated(&place) / taken(&place);
        println!("{ratio:.2} for {}", steps.replace('\n', " "));
        assert!((0.67..1.5).contains(&ratio), "{ratio} for {steps}");
    }
}

#[test]
fn a_run_over_the_memory_that_is_allowed_ends_with_5_before_anything_is_made() {
    let place = place("");
    assert_ends(&place, &["run", "r.toml", "--memory", "20MiB"], 5, &["r.toml: ", "of memory", "--memory"]);
    assert_ends(&place, &["run", "r.toml", "--memory", "1GiB"], 0, &[]);
}

/// A shell limits the address space, where all that is not checked ends by a signal.
#[cfg(target_os = "linux")]
#[test]
fn a_limited_address_space_is_told_with_5_and_no_signal() {
    let place = Place::with(
        "[landscape]\nsize = 16384\n[[step]]\ndo = \"fbm\"\n[[output]]\nlayer = \"height\"\nfile = \"height.npy\"\n",
    );
    let weald = env!("CARGO_BIN_EXE_weald");
    let script =
        format!("ulimit -v 2000000; exec {weald} run r.toml --engine cpu --threads 1 --memory 64GiB");
    let mut shell = std::process::Command::new("sh");
    let output = shell
        .env("WEALD_CACHE", "off")
        .args(["-c", &script])
        .current_dir(place.path(""))
        .output()
        .expect("a shell");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(5), "{said}");
    assert!(said.contains("of memory, at most"), "{said}");
}

//! What the check says of memory, beside what a run takes.

use std::process::Stdio;

use crate::place::{Place, assert_ends, stdout};

/// A recipe of a million cells with these steps.
fn place(steps: &str) -> Place {
    place_of((1024, 300.0), steps)
}

/// A recipe of a square of 20 km with so many cells a side, so many metres from its lowest to its highest point, and these
/// steps.
fn place_of((size, relief): (u32, f64), steps: &str) -> Place {
    let cell = 20_480.0 / f64::from(size);
    Place::with(&format!(
        "[landscape]\nsize = {size}\ncell = {cell:?}\n[[step]]\ndo = \"fbm\"\nrelief = {relief:?}\n{steps}[[output]]\n\
         layer = \"height\"\nfile = \"height.npy\"\n"
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

#[cfg(target_os = "linux")]
#[test]
fn the_memory_that_a_check_tells_counts_what_outputs_need() {
    for output in [
        "export = \"mesh\"\nerror = 0.05\nfile = \"land.glb\"\n",
        "export = \"report\"\nfile = \"report.html\"\n",
        "export = \"unreal\"\nfile = \"unreal/land.png\"\n",
        "picture = \"relief\"\nfile = \"relief.png\"\n",
        "picture = \"view\"\nwidth = 160\nheight = 90\nrock_deg = 8.0\nfile = \"view.png\"\n",
        "export = \"plants\"\non = { error = 0.05 }\nfile = \"plants.csv\"\n[[step]]\ndo = \"scatter\"\ncount = 2000\n",
    ] {
        let place = place(&format!("[[output]]\n{output}"));
        let ratio = estimated(&place) / taken(&place);
        println!("{ratio:.2} for {}", output.replace('\n', " "));
        assert!((0.67..1.5).contains(&ratio), "{ratio} for {output}");
    }
}

/// Steep ground is drawn on finer cells; whether any is no check can tell.
#[cfg(target_os = "linux")]
#[test]
fn the_memory_that_a_check_tells_of_a_view_holds_for_gentle_and_for_steep_ground() {
    let view = "[[output]]\npicture = \"view\"\nwidth = 160\nheight = 90\nsamples = 1\nfile = \"view.png\"\n";
    for (size, relief) in [(256, 50.0), (256, 8000.0), (512, 50.0), (512, 8000.0)] {
        let place = place_of((size, relief), view);
        let ratio = estimated(&place) / taken(&place);
        println!("{ratio:.2} for {size} cells, {relief} m");
        assert!((0.67..1.5).contains(&ratio), "{ratio} for {size} cells, {relief} m");
    }
}

#[test]
fn a_run_over_the_memory_that_is_allowed_ends_with_5_before_anything_is_made() {
    let place = place("");
    assert_ends(&place, &["run", "r.toml", "--memory", "20MiB"], 5, &["r.toml: ", "of memory", "--memory"]);
    assert_ends(&place, &["run", "r.toml", "--memory", "1GiB"], 0, &[]);
}

#[test]
fn a_run_that_goes_on_from_a_checkpoint_is_held_to_the_same_memory() {
    let place = place("[[step]]\ndo = \"hydraulic\"\niterations = 10_000_000\n");
    let mut command = place.command(&["run", "r.toml", "--checkpoint-every", "0", "--quiet"]);
    let mut child = command.spawn().expect("it starts");
    while !place.path("out/r/checkpoint.weald").exists() {
        assert!(child.try_wait().expect("it is ours").is_none(), "it ended before its first checkpoint");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    child.kill().and_then(|()| child.wait()).expect("it is ours");
    let resume = ["run", "r.toml", "--resume", "--memory", "20MiB"];
    assert_ends(&place, &resume, 5, &["r.toml: ", "of memory", "--memory"]);
}

#[test]
fn a_long_file_is_refused_before_it_is_read() {
    let place = Place::with(
        "[landscape]\nfrom = \"long.npy\"\n[[output]]\nlayer = \"height\"\nfile = \"height.tif\"\n",
    );
    let long = |bytes| std::fs::File::create(place.path("long.npy")).and_then(|file| file.set_len(bytes));
    long(60_000_000_000).expect("sparse");
    assert_ends(&place, &["run", "r.toml", "--memory", "100GiB"], 5, &["long.npy: ", "at most"]);
    assert_ends(&place, &["check", "r.toml"], 5, &["long.npy: ", "at most"]);
    long(100_000_000).expect("sparse");
    assert_ends(&place, &["run", "r.toml", "--memory", "50MiB"], 5, &["long.npy: ", "of memory", "--memory"]);
}

/// How a run ends in so many kibibytes of addresses, and what it says.
#[cfg(target_os = "linux")]
fn limited(place: &Place, kibibytes: u64) -> (Option<i32>, String) {
    limited_command(place, kibibytes, "run r.toml --engine cpu --threads 2 --memory 64GiB --quiet")
}

/// The same for any command. A shell limits the addresses.
#[cfg(target_os = "linux")]
fn limited_command(place: &Place, kibibytes: u64, command: &str) -> (Option<i32>, String) {
    let weald = env!("CARGO_BIN_EXE_weald");
    let script = format!("ulimit -v {kibibytes}; exec {weald} {command}");
    let mut shell = std::process::Command::new("sh");
    let shell = shell.env("WEALD_CACHE", "off").args(["-c", &script]).current_dir(place.path(""));
    let output = shell.output().expect("a shell");
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[cfg(target_os = "linux")]
#[test]
fn a_limited_address_space_is_told_with_5_and_no_signal() {
    for size in [16384, 4096] {
        let place = Place::with(&format!(
            "[landscape]\nsize = {size}\n[[step]]\ndo = \"fbm\"\n[[output]]\nlayer = \"height\"\nfile = \
             \"height.npy\"\n"
        ));
        let (code, said) = limited(&place, 700_000);
        assert_eq!(code, Some(5), "{said}");
        assert!(said.contains("of memory, at most"), "{said}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn whatever_addresses_there_are_a_run_ends_with_0_or_5() {
    let outputs = "[[output]]\npicture = \"relief\"\nfile = \"relief.png\"\n[[output]]\nexport = \"mesh\"\nfile = \
                   \"mesh.glb\"\n[[output]]\nlayer = \"height\"\nfile = \"height.tif\"\n";
    for size in [256, 1024] {
        let place = Place::with(&format!(
            "[landscape]\nsize = {size}\ncell = 20.0\n[[step]]\ndo = \"fbm\"\nrelief = 300.0\n[[step]]\ndo = \
             \"hydraulic\"\niterations = 3\n[[step]]\ndo = \"flow\"\n{outputs}"
        ));
        let ends: Vec<_> =
            [2, 3, 4, 5, 10].into_iter().map(|share| limited(&place, share * 150_000)).collect();
        println!("{size}: {:?}", ends.iter().map(|(code, _)| code).collect::<Vec<_>>());
        let wrong = ends.iter().find(|(code, _)| ![Some(0), Some(5)].contains(code));
        assert!(wrong.is_none(), "{wrong:?}");
        assert_eq!(ends.last().map(|(code, _)| *code), Some(Some(0)), "there is room in the end");
    }
}

/// Of 2^24 cells, which are many more than fit, a few more, and as many.
#[cfg(target_os = "linux")]
#[test]
fn whatever_addresses_there_are_a_file_is_read_or_refused_with_5() {
    let place = Place::with(
        "[landscape]\nfrom = \"land.npy\"\ncell = 5.0\n[[step]]\ndo = \"thermal\"\niterations = 1\n[[output]]\nlayer = \
         \"height\"\nfile = \"height.npy\"\n",
    );
    let mut header =
        b"\x93NUMPY\x01\0\x76\0{'descr': '|u1', 'fortran_order': False, 'shape': (4096, 4096), }".to_vec();
    header.resize(127, b' ');
    header.push(b'\n');
    std::fs::write(place.path("land.npy"), &header).expect("written");
    let file = std::fs::File::options().write(true).open(place.path("land.npy")).expect("it is there");
    file.set_len(128 + (1 << 24)).expect("sparse");
    for command in
        ["info land.npy", "convert land.npy other.npy", "check r.toml", "run r.toml --memory 64GiB --quiet"]
    {
        let ends: Vec<_> =
            [90, 130, 200, 300, 450].map(|limit| limited_command(&place, limit << 10, command)).into();
        println!("{command}: {:?}", ends.iter().map(|(code, _)| code).collect::<Vec<_>>());
        let wrong = ends.iter().find(|(code, _)| ![Some(0), Some(5)].contains(code));
        assert!(wrong.is_none(), "{command}: {wrong:?}");
    }
}

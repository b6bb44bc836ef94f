//! What the check says of disk and time, beside what a run takes.

use std::path::Path;
use std::process::Output;

use crate::place::{Place, stdout};

/// Layers in five formats, a picture and a mesh.
const RECIPE: &str = "\
[landscape]
size = 128
cell = 20.0
[[step]]
do = \"diamond-square\"
relief = 600.0
[[step]]
do = \"hydraulic\"
iterations = 200
[[output]]
layer = \"height\"
file = \"height.tif\"
[[output]]
layer = \"height\"
file = \"height.png\"
[[output]]
layer = \"height\"
file = \"height.npy\"
[[output]]
layer = \"height\"
file = \"height.asc\"
[[output]]
layer = \"height\"
file = \"height.zarr\"
[[output]]
picture = \"relief\"
file = \"relief.png\"
";

const MESH: &str = "[[output]]\nexport = \"mesh\"\nerror = 2.0\nfile = \"land.glb\"\n";

/// The command with a folder for what it keeps.
fn keeping(place: &Place, arguments: &[&str]) -> Output {
    place.command(arguments).env("WEALD_CACHE", place.path("kept")).output().expect("it starts")
}

/// The line of the check that begins with a word.
fn line(place: &Place, word: &str, size: &str) -> String {
    let said = stdout(&keeping(place, &["check", "r.toml", "--size", size]));
    let found = said.lines().find_map(|line| line.trim().strip_prefix(word)).map(str::to_owned);
    found.unwrap_or_else(|| panic!("no {word} in {said}"))
}

/// Bytes that the check tells.
fn told(place: &Place, size: &str) -> f64 {
    let line = line(place, "disk: about ", size);
    let mut words = line.split([' ', ',']);
    let number: f64 = words.next().and_then(|word| word.parse().ok()).expect("a number");
    number * if words.next() == Some("MiB") { f64::from(1 << 20) } else { 1024.0 }
}

/// Bytes of all files below a folder but the report.
fn bytes(folder: &Path) -> f64 {
    let entries = std::fs::read_dir(folder).expect("it is there").flatten();
    let all = entries.map(|entry| match entry.metadata().expect("it is there") {
        about if about.is_dir() => bytes(&entry.path()),
        about if entry.file_name() != "report.json" => about.len() as f64,
        _ => 0.0,
    });
    all.sum()
}

fn run(place: &Place, size: &str) -> f64 {
    let arguments = ["run", "r.toml", "--engine", "cpu", "--quiet", "--size", size, "--out", size];
    let output = keeping(place, &arguments);
    assert!(output.status.success(), "{output:?}");
    bytes(&place.path(size))
}

#[test]
fn the_disk_that_a_check_tells_is_within_a_third_of_what_a_run_takes() {
    let place = Place::with(RECIPE);
    for size in ["128", "256", "512"] {
        let (told, took) = (told(&place, size), run(&place, size));
        println!("{size}: told {told}, took {took}");
        assert!((0.67..1.5).contains(&(told / took)), "{size}: told {told}, took {took}");
    }
}

#[test]
fn what_only_a_run_shows_is_named_before_and_told_after_it() {
    let place = Place::with(&format!("{RECIPE}{MESH}"));
    assert!(line(&place, "disk: ", "128").contains("beside land.glb, which no run has shown yet"));
    assert!(line(&place, "time: ", "128").contains("weald bench --calibrate"));
    run(&place, "64");
    run(&place, "128");
    for word in ["disk: ", "time: "] {
        let line = line(&place, word, "256");
        assert!(line.starts_with("about ") && !line.contains("beside"), "{line}");
    }
    let (told, took) = (told(&place, "256"), run(&place, "256"));
    assert!((0.67..1.5).contains(&(told / took)), "told {told}, took {took}");
}

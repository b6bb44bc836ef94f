//! `weald fractal` and recipes of fractals as a user meets them.

use std::process::{Command, Stdio};
use std::time::Duration;

use crate::place::{Place, assert_ends, stdout};

const SMALL: [&str; 5] = ["--size", "60x90", "--samples", "4", "--quiet"];

fn drawn(place: &Place, arguments: &[&str]) {
    assert_ends(place, &[&["fractal"], arguments, &SMALL].concat(), 0, &[]);
}

/// What ffprobe finds in a film: frames, width and height.
fn frames(place: &Place, file: &str) -> String {
    let entries = "stream=width,height,nb_read_frames";
    let arguments = ["-v", "error", "-count_frames", "-show_entries", entries, "-of", "csv=p=0"];
    let output = Command::new("ffprobe").args(arguments).arg(place.path(file)).output();
    let found = output.expect("ffprobe starts (Debian: ffmpeg)");
    String::from_utf8_lossy(&found.stdout).trim().to_owned()
}

#[test]
fn the_list_names_every_built_in_fractal() {
    let place = Place::with("");
    let list = stdout(&place.weald(&["fractal", "list"]));
    assert!(list.lines().count() >= 14, "{list}");
    assert!(list.contains("fern ") && list.contains("gasket ") && list.contains("3D"), "{list}");
}

#[test]
fn a_deformed_fern_is_a_picture_that_differs_from_the_fern() {
    let place = Place::with("");
    drawn(&place, &["fern"]);
    drawn(
        &place,
        &["fern", "--deform", "permutation", "--from", "5", "--to", "7", "-o", "pictures/bent.png"],
    );
    let [fern, bent] =
        ["fern.png", "pictures/bent.png"].map(|file| std::fs::read(place.path(file)).expect(file));
    assert!(fern.starts_with(b"\x89PNG") && bent.starts_with(b"\x89PNG") && fern != bent);
    assert_eq!(place.names("pictures"), ["bent.png"]);
}

#[test]
fn a_fern_in_the_wind_is_a_film_that_loops() {
    let place = Place::with("");
    drawn(&place, &["fern", "--wind", "8", "--frames", "6", "-o", "fern.apng"]);
    assert_eq!(frames(&place, "fern.apng"), "60,90,6");
    assert_eq!(place.names("."), ["fern.apng", "r.toml"]);
    let bytes = std::fs::read(place.path("fern.apng")).expect("written");
    let control = bytes.windows(4).position(|chunk| chunk == b"acTL").expect("animated") + 4;
    assert_eq!(bytes[control..control + 8], [0, 0, 0, 6, 0, 0, 0, 0], "six frames, for ever");
    drawn(&place, &["fern", "--wind", "8", "--frames", "3", "-o", "fern.mp4"]);
    assert_eq!(frames(&place, "fern.mp4"), "60,90,3");
    assert!(place.path("fern-00002.png").exists());
    let frame = |number| std::fs::read(place.path(&format!("fern-0000{number}.png"))).expect("a frame");
    assert!(frame(0) != frame(1) && frame(1) != frame(2), "it moves");
    let film = [
        "fractal",
        "fern",
        "--wind",
        "8",
        "--frames",
        "2",
        "--size",
        "60x90",
        "--samples",
        "4",
        "-o",
        "a.png",
    ];
    assert_eq!(stdout(&place.weald(&film)), "a-00000.png\na-00001.png\n", "the files that are there");
    assert!(place.path("a-00001.png").exists() && !place.path("a.png").exists());
}

#[test]
fn vectors_and_points_are_written() {
    let place = Place::with("");
    let parts = ["fractal", "gasket", "--draw", "parts", "--depth", "3", "-o", "gasket.svg"];
    assert_ends(&place, &parts, 0, &[]);
    let without_effect = "`samples` has no effect with draw = \"parts\"";
    assert_ends(&place, &[&parts[..], &["--samples", "4"]].concat(), 2, &[without_effect]);
    let svg = std::fs::read_to_string(place.path("gasket.svg")).expect("written");
    assert_eq!(svg.matches('M').count(), 27);
    assert_ends(&place, &["fractal", "fern", "-o", "fern.svg"], 0, &[]);
    let length = std::fs::metadata(place.path("fern.svg")).expect("written").len();
    assert!((1 << 20..64 << 20).contains(&length), "the finest parts that fit: {length}");
    drawn(&place, &["gasket", "--points", "points.csv", "--depth", "3"]);
    let points = std::fs::read_to_string(place.path("points.csv")).expect("written");
    assert_eq!(points.lines().count(), 28);
    assert!(!place.path("gasket.png").exists(), "points alone");
    drawn(&place, &["gasket", "--points", "points.npy", "--count", "100"]);
    assert!(place.path("points.npy").exists() && place.path("points_codes.npy").exists());
}

#[test]
fn faults_of_the_command_line_end_with_2_and_limits_with_5() {
    let place = Place::with("");
    let ends = |arguments: &[&str], code, part: &str| {
        assert_ends(&place, &[&["fractal"], arguments].concat(), code, &[part]);
    };
    ends(&["fren"], 2, "did you mean `fern`?");
    ends(&["fern", "--deform", "swap", "--from", "7", "--to", "5"], 2, "`from` is 7 and `to` is 5");
    ends(&["fern", "--deform", "swap", "--from", "1", "--to", "65"], 2, "64 digits");
    ends(&["fern", "--deform", "spin"], 2, "\"permutation\"");
    ends(&["fern", "--gamma", "0"], 2, "outside its range");
    ends(&["fern", "-o", "fern.gif"], 2, ".png or .svg");
    ends(&["fern", "--size", "200000x200000"], 5, "smaller `size`");
    ends(
        &["fern", "--depth", "13"],
        5,
        "fern: all parts to a depth of 13: 67108864 parts, at most 4194304 are allowed; choose a `depth` of 11",
    );
    ends(&["fern", "-o", "fern.mp4"], 2, "`file` is fern.mp4, a film: add `frames`");
    ends(&["fern", "--finest", "2", "-o", "fern.svg"], 5, "choose a larger `finest`, such as 4");
    ends(&["none.toml"], 3, "error: none.toml: the recipe cannot be read");
    assert_eq!(place.names("."), ["r.toml"], "nothing was written");
}

const RECIPE: &str = "\
[[fractal]]
name = \"mine\"
maps = [
    [0.0, 0.0, 0.0, 0.16, 0.0, 0.0],
    [0.85, 0.04, -0.04, 0.85, 0.0, 1.6],
    [0.2, -0.26, 0.23, 0.22, 0.0, 1.6],
    [-0.15, 0.28, 0.26, 0.24, 0.0, 0.44],
]
probabilities = [0.01, 0.85, 0.07, 0.07]
roles = [\"stem\", \"trunk\", \"branch\", \"branch\"]
deform = [{ by = \"reversal\", from = 2, to = 4 }]
[[output]]
picture = \"fractal\"
fractal = \"mine\"
size = [60, 90]
samples = 4
wind = { speed = 6 }
file = \"mine.png\"
";

#[test]
fn a_recipe_of_fractals_needs_no_ground_and_the_command_draws_its_first() {
    let place = Place::with(RECIPE);
    assert_ends(&place, &["run", "r.toml", "--quiet"], 0, &[]);
    assert_eq!(place.names("out/r"), ["mine.png", "report.json"]);
    drawn(&place, &["r.toml", "--wind", "6", "-o", "again.png"]);
    let pixels = |file: &str| {
        let arguments = ["-v", "error", "-i", file, "-f", "rawvideo", "-"];
        Command::new("ffmpeg")
            .current_dir(place.path("."))
            .args(arguments)
            .output()
            .expect("ffmpeg starts")
            .stdout
    };
    assert_eq!(pixels("out/r/mine.png").len(), 60 * 90 * 3);
    assert_eq!(pixels("out/r/mine.png"), pixels("again.png"));
}

#[test]
fn faults_of_a_fractal_in_a_recipe_end_with_3_and_their_lines() {
    let refused = |from: &str, to: &str, expected: &str| {
        assert!(RECIPE.contains(from), "{from}");
        assert_ends(&Place::with(&RECIPE.replace(from, to)), &["run", "r.toml"], 3, &[expected]);
    };
    refused(
        "[0.85, 0.04, -0.04, 0.85,",
        "[1.85, 0.04, -0.04, 0.85,",
        "r.toml:5: fractal: map 1 does not contract",
    );
    refused("0.07, 0.07]\nroles", "0.07, 0.17]\nroles", "r.toml:9: fractal: the probabilities sum to 1.1");
    refused(
        "from = 2, to = 4",
        "from = 4, to = 2",
        "r.toml:11: fractal: reversal: `from` is 4 and `to` is 2",
    );
    refused(
        "deform = [",
        "code_digits = 200\ndeform = [",
        "r.toml:11: fractal: codes of 200 digits do not fit",
    );
    refused(
        "fractal = \"mine\"",
        "fractal = \"minne\"",
        "r.toml:12: output: there is no fractal \"minne\"; did you",
    );
}

#[test]
fn an_interrupted_film_ends_with_130_and_leaves_no_half_file() {
    let place = Place::with("");
    let arguments =
        ["fractal", "fern", "--wind", "8", "--frames", "2000", "--size", "200x300", "-o", "fern.apng"];
    let mut command = place.command(&arguments);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the command starts");
    let begun = || place.names(".").iter().any(|name| name.contains("fern"));
    for _ in 0..6000 {
        if begun() {
            break;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    let kill = format!("kill -INT {}", child.id());
    let killed = Command::new("sh").args(["-c", &kill]).status().expect("a shell starts");
    assert!(killed.success(), "it was still there to be interrupted");
    let output = child.wait_with_output().expect("it ends");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{message}");
    assert!(message.contains("interrupted; every file that is there is whole"), "{message}");
    assert_eq!(place.names("."), ["r.toml"]);
}

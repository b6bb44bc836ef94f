//! `weald render` as a user meets it.

use crate::place::{Place, assert_ends, left_out};

const RECIPE: &str = "\
[landscape]
size = [96, 64]
cell = 10.0
seed = 3
[[step]]
do = \"diamond-square\"
relief = 100.0
[[output]]
layer = \"height\"
file = \"height.npy\"
";

fn sides(place: &Place, file: &str) -> (u32, u32) {
    let bytes = std::fs::read(place.path(file)).expect("the picture is there");
    let side = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four bytes"));
    assert_eq!(&bytes[1..4], b"PNG");
    (side(16), side(20))
}

#[test]
fn stills_turntables_and_flights_are_drawn() {
    if left_out() {
        return;
    }
    let place = Place::with(RECIPE);
    let small = ["--size", "64x48", "--samples", "1"];
    let draw = |arguments: &[&str]| {
        assert_ends(&place, &[&["render", "r.toml"], &small[..], arguments].concat(), 0, &[]);
    };
    draw(&["-o", "still.png"]);
    assert_eq!(sides(&place, "still.png"), (64, 48));
    draw(&[
        "--eye",
        "480,320",
        "--eye-height",
        "1.7",
        "--target",
        "100,100,80",
        "--field-of-view-deg",
        "60",
        "-o",
        "walk.png",
    ]);
    assert_ne!(std::fs::read(place.path("walk.png")).ok(), std::fs::read(place.path("still.png")).ok());
    draw(&["--turntable", "3", "-o", "turn.apng"]);
    assert_eq!(sides(&place, "turn.apng"), (64, 48));
    draw(&[
        "--eye",
        "480,600,300",
        "--through",
        "480,300,250",
        "300,100,300",
        "--frames",
        "3",
        "-o",
        "f.png",
    ]);
    if std::process::Command::new("ffmpeg").arg("-version").output().is_ok() {
        draw(&["--turntable", "2", "-o", "turn.mp4"]);
        let video = std::fs::read(place.path("turn.mp4")).expect("a video");
        assert_eq!(&video[4..8], b"ftyp");
    }
    let frames: Vec<_> = ["f-00000.png", "f-00001.png", "f-00002.png"]
        .iter()
        .map(|frame| std::fs::read(place.path(frame)).expect("a frame"))
        .collect();
    assert!(frames[0] != frames[1] && frames[1] != frames[2], "the camera moves");
}

#[test]
fn recipes_draw_stills_turns_flights_and_the_course_of_a_simulation() {
    if left_out() {
        return;
    }
    let output = |file: &str, keys: &str| {
        format!(
            "[[output]]\npicture = \"render\"\nwidth = 64\nheight = 48\nsamples = 1\nfile = \"{file}\"\n{keys}"
        )
    };
    let steep = RECIPE.replace("relief = 100.0", "relief = 900.0");
    let simulated = steep.replace("[[output]]", "[[step]]\ndo = \"thermal\"\niterations = 20\n[[output]]");
    let recipe = simulated
        + &output("still.png", "eye = [480, 320]\neye_height = 1.7\n")
        + &output("turn.apng", "frames = 3\n")
        + &output("flight.png", "eye = [480, 600]\nthrough = [300, 100]\nframes = 2\n")
        + &output("course.png", "every = 10\n");
    let place = Place::with(&recipe);
    assert_ends(&place, &["run", "r.toml"], 0, &[]);
    let bytes = |file: &str| std::fs::read(place.path(&format!("out/r/{file}"))).expect(file);
    for file in ["still.png", "turn.apng", "flight-00000.png", "flight-00001.png"] {
        assert_eq!(sides(&place, &format!("out/r/{file}")), (64, 48), "{file}");
    }
    assert!(bytes("flight-00000.png") != bytes("flight-00001.png"), "the camera moves");
    assert!(bytes("course-00000.png") != bytes("course-00002.png"), "the ground slides");
    let report = String::from_utf8(bytes("report.json")).expect("text");
    assert!(report.contains("\"adapter\""), "{report}");
}

#[test]
fn drawn_pictures_of_a_recipe_that_make_no_sense_are_told_with_what_would() {
    let refused = |keys: &str, parts: &[&str]| {
        let place =
            Place::with(&format!("{RECIPE}[[output]]\npicture = \"render\"\nfile = \"a.png\"\n{keys}"));
        assert_ends(&place, &["check", "r.toml"], 3, parts);
    };
    refused("samples = 3\n", &["`samples` is 3", "must be 1 or 4"]);
    refused("through = [1, 2]\nframes = 4\n", &["`through` has no effect without `eye`"]);
    refused("eye = [1, 1]\nthrough = [1, 2]\n", &["`through` needs `frames`"]);
    refused("sun_altitude_deg = 95\n", &["95", "90"]);
}

#[test]
fn what_cannot_be_drawn_is_reported_with_what_can() {
    if left_out() {
        return;
    }
    let place = Place::with(RECIPE);
    let refused = |arguments: &[&str], code: i32, parts: &[&str]| {
        assert_ends(&place, &[&["render", "r.toml"], arguments].concat(), code, parts);
    };
    refused(&["--size", "100000x4"], 5, &["100000 × 4", "--size"]);
    refused(&["--samples", "3"], 5, &["--samples 4"]);
    refused(&["--size", "64"], 2, &["1920x1080"]);
    refused(&["-o", "a.jpg"], 2, &["a.jpg", ".png"]);
    refused(&["-o", "a.apng"], 2, &["a still"]);
    refused(&["--eye", "480,320,-500"], 2, &["above the ground", "--eye-height 1.7"]);
    // Both ends lie over the ground, and the smooth line between them dips below it.
    let dive = ["--eye", "10,320,9000", "--through", "400,320,120", "800,320,120", "950,320,9000"];
    refused(
        &[&dive[..], &["--frames", "9"]].concat(),
        2,
        &["frame 3 of the flight", "--through a higher point"],
    );
    refused(&["--sun-altitude-deg", "95"], 3, &["95", "90"]);
    assert!(
        place.names(".").iter().all(|name| ["r.toml", "out"].contains(&name.as_str())),
        "nothing was drawn"
    );
}

#[test]
fn a_camera_that_makes_no_sense_is_refused_before_anything_is_simulated() {
    let place = Place::with(RECIPE);
    let refused = |arguments: &[&str], part: &str| {
        assert_ends(&place, &[&["render", "r.toml"], arguments].concat(), 2, &[part]);
        assert_eq!(place.names("."), ["r.toml"], "{arguments:?}: nothing was run or drawn");
    };
    refused(&["--eye", "480,320"], "--eye-height METRES");
    refused(&["--eye-height", "2"], "goes with --eye X,Y");
    refused(&["--eye", "1,1,5", "--eye-height", "2"], "leave out one");
    refused(&["--eye", "1,2,900", "--target", "1,2,900"], "the same point");
    for (option, value) in [("--azimuth-deg", "20"), ("--altitude-deg", "20"), ("--distance", "5")] {
        let beside = format!("{option} has no effect beside --eye; remove either");
        refused(&["--eye", "1,2,900", option, value], &beside);
    }
    refused(&["--frames", "4"], "use --turntable FRAMES");
    refused(
        &["--turntable", "4", "-o", "r.gif"],
        "an animation is written as .png or .apng or .mp4 or .webm",
    );
    refused(&["--camera", "480,320,900"], "it is now called --eye 480,320,900");
    refused(&["--fov", "60"], "it is now called --field-of-view-deg 60");
    refused(&["--eye", "1.7"], "the height above the ground is --eye-height 1.7");
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_device_the_error_says_what_is_missing_and_the_fallback_draws_only_if_asked() {
    let place = Place::with(RECIPE);
    let without_drivers = |arguments: &[&str]| {
        let mut command = place.command(arguments);
        command.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent");
        command.output().expect("it starts")
    };
    let arguments = ["render", "r.toml", "--size", "64x48", "-o", "a.png"];
    let refused = without_drivers(&arguments);
    let message = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(1), "{message}");
    for part in ["Vulkan", "mesa-vulkan-drivers", "--fallback view"] {
        assert!(message.contains(part), "{part}: {message}");
    }
    assert!(!place.path("a.png").exists());
    let drawn_by_recipe =
        format!("{RECIPE}[[output]]\npicture = \"render\"\nwidth = 64\nheight = 48\nfile = \"b.png\"\n");
    std::fs::write(place.path("d.toml"), drawn_by_recipe).expect("written");
    let refused = without_drivers(&["run", "d.toml"]);
    assert!(
        String::from_utf8_lossy(&refused.stderr).contains("--fallback view"),
        "reported before anything is run"
    );
    assert!(!place.path("out/d/height.npy").exists(), "nothing was run");
    let drawn = without_drivers(&["run", "d.toml", "--fallback", "view"]);
    assert_eq!(drawn.status.code(), Some(0), "{}", String::from_utf8_lossy(&drawn.stderr));
    assert_eq!(sides(&place, "out/d/b.png"), (64, 48));
    let drawn = without_drivers(&[&arguments[..], &["--fallback", "view"]].concat());
    assert_eq!(drawn.status.code(), Some(0), "{}", String::from_utf8_lossy(&drawn.stderr));
    assert_eq!(sides(&place, "a.png"), (64, 48));
}

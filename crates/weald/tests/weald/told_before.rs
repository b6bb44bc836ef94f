//! What recipe and grid already say is told by the check and not by the run: names that would be written twice, and sizes that
//! cannot be.

use weald::recipe::{Overrides, Recipe};

/// What the check says of a small landscape with such steps and outputs; nothing where it is good.
fn told(more: &str) -> String {
    let text = format!(
        "[landscape]\nsize = [33, 20]\ncell = 10.0\n[[step]]\ndo = \"fbm\"\n[[step]]\ndo = \"flow\"\n{more}\n"
    );
    Recipe::parse("r.toml", &text, &Overrides::default())
        .err()
        .map(|error| error.to_string())
        .unwrap_or_default()
}

fn step(keys: &str) -> String {
    format!("[[step]]\n{keys}\n")
}

fn output(keys: &str) -> String {
    format!("[[output]]\n{keys}\n")
}

#[test]
fn outputs_that_would_write_one_file_are_told_whatever_their_kinds() {
    let layer = |file: &str| output(&format!("layer = \"height\"\nfile = \"{file}\""));
    let export = |name: &str, file: &str| output(&format!("export = \"{name}\"\nfile = \"{file}\""));
    let lakes = step("do = \"lakes\"");
    let plants = step("do = \"scatter\"\nspacing = 20.0");
    let turn = "picture = \"relief\"\nframes = 3\nwidth = 32";
    let cases = [
        (lakes.clone() + &layer("x.raw") + &export("lakes", "x.raw.json"), "x.raw.json"),
        (lakes + &layer("x.tif") + &export("lakes", "x.geojson"), "x.qml"),
        (plants + &export("plants", "p.glb") + &export("mesh", "p.nodes.glb"), "p.nodes.glb"),
        (
            output(&format!("{turn}\nfile = \"a.mp4\"")) + &output(&format!("{turn}\nfile = \"a.png\"")),
            "a-00000.png",
        ),
        (layer("x.tif") + &layer("x.tiff"), "x.qml"),
    ];
    for (more, name) in cases {
        let message = told(&more);
        assert!(message.contains(&format!("would write {name}, where")), "{more}: {message}");
    }
    assert_eq!(told(&(layer("x.tif") + &layer("x.raw") + &layer("y.tif"))), "");
}

#[test]
fn the_height_of_flat_ground_is_asked_for_by_the_word_of_a_plane() {
    let message = told(&step("do = \"constant\"\nvalue = 3.0"));
    assert!(message.contains("constant: `value` is now called `height`"), "{message}");
}

#[test]
fn sizes_that_grid_and_limits_forbid_are_told() {
    let saved = output("layer = \"height\"\nfile = \"h.npy\"");
    let of_step = |keys: &str| step(keys) + &saved;
    let cases = [
        (of_step("do = \"resample\"\nsize = [64, 7]"), "would not be square; for 64 columns give 39 rows"),
        (of_step("do = \"slope\"\nscale = 5000.0"), "choose at most 320 m"),
        (of_step("do = \"curvature\"\nscale = 5000.0"), "choose at most 320 m"),
        (of_step("do = \"scatter\"\nspacing = 0.01"), "choose 0.07 m or more, or a `count`"),
        (output("picture = \"relief\"\nwidth = 100000\nfile = \"a.png\""), "its range: 16 to 16384 px"),
        (
            output("export = \"unity\"\nsize = 34\nfile = \"a.raw\""),
            "33 is the next smaller, 65 is the next larger",
        ),
        (output("export = \"unreal\"\nsize = 9000\nfile = \"a.png\""), "its range: 127 to 8129"),
        (output(&format!("layer = \"height\"\nfile = \"{}.npy\"", "n".repeat(210))), "which is too long"),
    ];
    for (more, words) in cases {
        let message = told(&more);
        assert!(message.contains(words), "{more}: {message}");
    }
}

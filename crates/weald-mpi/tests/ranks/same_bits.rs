//! Every process over 1, 2, 3, 4 and 6 ranks for 500 steps.

use std::fmt::Write;
use std::path::Path;

use crate::launched::{assert_same, on_one, run, said};

const COUNTS: [usize; 5] = [1, 2, 3, 4, 6];

/// Writes a hilly ground of 26 × 48 cells of 4 m, with cells without data.
fn write_ground(folder: &Path) {
    let mut text =
        "ncols 26\nnrows 48\nxllcorner 0\nyllcorner 0\ncellsize 4\nNODATA_value -9999\n".to_owned();
    for y in 0..48_u32 {
        for x in 0..26_u32 {
            let without = x.abs_diff(8).max(y.abs_diff(30)) < 4 || (x * 31 + y * 17) % 53 == 0;
            let height = 40.0 + 0.7 * f64::from(y) + 9.0 * (f64::from(x * y % 23) / 23.0);
            let _ = write!(text, "{} ", if without { -9999.0 } else { height });
        }
        text.push('\n');
    }
    std::fs::write(folder.join("ground.asc"), text).expect("written");
}

const STROKES: &str = r#"{"step": 0, "do": "add-water", "depth": 0.5, "path": [[10, 20], [90, 150]], "radius": 12}
{"step": 150, "do": "freeze", "path": [[50, 95]], "radius": 20}
{"step": 210, "do": "set", "key": "transport", "value": "maccormack"}
{"step": 300, "do": "add", "material": "sand", "thickness": 2, "path": [[20, 60], [80, 64]], "radius": 16}
{"step": 320, "do": "set", "key": "transport", "value": "upwind"}
{"step": 400, "do": "thaw", "path": [[50, 95]], "radius": 20}
"#;

/// The ground that [`write_ground`] writes.
const WITH_HOLES: &str = "from = \"ground.asc\"";

/// Runs a recipe of these steps on a ground, with these layers as its files.
fn assert_same_over_ranks(ground: &str, steps: &[&str], layers: &[&str]) {
    assert_same_with(&[], (ground, steps, layers));
}

/// The same with more options of the command.
fn assert_same_with(options: &[&str], (ground, steps, layers): (&str, &[&str], &[&str])) {
    let folder = tempfile::tempdir().expect("a folder");
    write_ground(folder.path());
    std::fs::write(folder.path().join("s.jsonl"), STROKES).expect("written");
    let mut text = format!(
        "[landscape]\n{ground}\nseed = 5\n[[material]]\nname = \"rock\"\n[[material]]\nname = \"sand\"\nthickness = 1.5\n"
    );
    text.extend(steps.iter().map(|step| format!("[[step]]\n{step}\n")));
    text.extend(
        layers.iter().map(|layer| format!("[[output]]\nlayer = \"{layer}\"\nfile = \"{layer}.npy\"\n")),
    );
    std::fs::write(folder.path().join("r.toml"), text).expect("written");
    let expected = on_one(folder.path());
    for count in COUNTS {
        let out = format!("over-{count}");
        let output = run(count, folder.path(), &out, options);
        assert!(output.status.success(), "{count} ranks: {}", said(&output));
        assert_same(folder.path(), &expected, &out);
    }
}

#[test]
fn water_by_han_and_mei_over_open_and_closed_borders() {
    let steps = [
        "do = \"hydraulic\"\niterations = 500\nboundary = \"open\"\nrain_period = 60\nthermal = {}",
        "do = \"hydraulic\"\nmodel = \"mei\"\niterations = 500\ninitial_water = \"water\"\ntransport = \"maccormack\"",
    ];
    assert_same_over_ranks(
        WITH_HOLES,
        &steps,
        &["height", "water", "sediment", "flux_x", "flux_y", "erosion"],
    );
}

#[test]
fn water_over_materials_that_a_script_edits() {
    let steps = [
        "do = \"hydraulic\"\nmodel = \"stava\"\niterations = 500\nedits = \"s.jsonl\"\nslippage = {}\ndissolution = {}",
    ];
    assert_same_over_ranks(WITH_HOLES, &steps, &["height", "sand", "water", "sediment", "flux_x"]);
}

#[test]
fn floods_on_several_grids() {
    let steps = [
        "do = \"diamond-square\"\nrelief = 60",
        "do = \"fluvial\"\nduration = 50.0\nflow_time = 1.2\ndeepest = 1.0\nrain = 1000.0\nlevels = 2\ncoarsest = 8.0",
    ];
    let layers = ["height", "water", "flux_x", "flux_y"];
    assert_same_over_ranks("size = [28, 48]\ncell = 4.0", &steps, &layers);
}

#[test]
fn rows_that_are_computed_while_messages_are_on_their_way() {
    let steps = [
        "do = \"fbm\"\nrelief = 80\nwavelength = 300",
        "do = \"hydraulic\"\niterations = 200\nboundary = \"open\"\nrain_period = 30",
        "do = \"hydraulic\"\nmodel = \"stava\"\niterations = 100\nslippage = {}\ndissolution = {}",
    ];
    let layers = ["height", "sand", "water", "sediment", "flux_x"];
    assert_same_with(&["--inside-first", "always"], ("size = [40, 290]\ncell = 4.0", &steps, &layers));
}

#[test]
fn gravity_and_what_water_carries_and_dissolves() {
    let steps = [
        "do = \"hydraulic\"\niterations = 100",
        "do = \"fbm\"\ninto = \"dye\"\nrelief = 1.0",
        "do = \"transport\"\nlayer = \"dye\"\niterations = 500",
        "do = \"slippage\"\niterations = 500",
        "do = \"dissolution\"\niterations = 500",
        "do = \"thermal\"\niterations = 500\ntalus = 0.3",
        "do = \"flow\"",
    ];
    assert_same_over_ranks(WITH_HOLES, &steps, &["height", "sand", "dye", "regolith", "accumulation"]);
}

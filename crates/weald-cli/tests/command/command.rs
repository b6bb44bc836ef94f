//! The command as a user meets it: exit codes, messages, files.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::place::{Place, assert_ends, stdout};

const RECIPE: &str = "\
[landscape]
size = [32, 16]
cell = 10.0
seed = 3
[[step]]
do = \"diamond-square\"
relief = 100.0
[[output]]
layer = \"height\"
file = \"height.npy\"
";

#[test]
fn a_run_writes_its_files_below_the_name_of_the_recipe() {
    let place = Place::with(RECIPE);
    let output = place.weald(&["run", "r.toml"]);
    assert!(output.status.success(), "{output:?}");
    assert_eq!(place.names("out/r"), ["height.npy", "report.json"]);
    assert!(stdout(&output).starts_with("out/r/height.npy  height, "), "{}", stdout(&output));
    assert!(String::from_utf8_lossy(&output.stderr).contains("step 1/1 diamond-square"));
}

#[test]
fn a_report_writes_one_page_and_nothing_else() {
    let place = Place::with(RECIPE);
    let output = place.weald(&["report", "r.toml", "--size", "24"]);
    assert!(output.status.success(), "{output:?}");
    assert_eq!(stdout(&output), "out/r/report.html\n");
    assert_eq!(place.names("out/r"), ["report.html"]);
    let output = place.weald(&["report", "r.toml", "--out", "pages/mine.html", "--quiet"]);
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty(), "{output:?}");
    assert_eq!(place.names("pages"), ["mine.html"]);
    assert_ends(&place, &["report", "r.toml", "--out", "page.pdf"], 2, &["page.pdf", ".html"]);
}

#[test]
fn a_quiet_run_prints_nothing() {
    let output = Place::with(RECIPE).weald(&["run", "r.toml", "--quiet"]);
    assert!(output.status.success() && output.stdout.is_empty() && output.stderr.is_empty(), "{output:?}");
}

#[test]
fn a_usage_error_ends_with_2() {
    let place = Place::with(RECIPE);
    assert_ends(&place, &["run"], 2, &["RECIPE.toml"]);
    assert_ends(&place, &["run", "r.toml", "--sized", "3"], 2, &["--size"]);
    assert_ends(&place, &["run", "r.toml", "--set", "landscape.cell"], 2, &["KEY=VALUE"]);
    assert_ends(&place, &["run", "r.toml", "--engine", "cup"], 2, &["auto, cpu and gpu"]);
    assert_ends(&place, &["run", "r.toml", "--threads", "0"], 2, &["1..=1024"]);
    assert_ends(&place, &["run", "r.toml", "--size", "0"], 2, &["'0'", "--size"]);
    assert_ends(&place, &["run", "r.toml", "--seed", "-1"], 2, &["invalid value '-1'"]);
    let greatest = u64::MAX.to_string();
    assert_ends(&place, &["run", "r.toml", "--seed", &greatest], 2, &[&greatest, "9007199254740991"]);
    assert_ends(&place, &["steps", "diamond-sqare"], 2, &["did you mean `diamond-square`?"]);
    assert_ends(&place, &["new", "x", "--template", "highlnd"], 2, &["highland"]);
    assert_ends(&place, &["convert", "a.npy", "b.xyz"], 2, &[".npy"]);
}

#[test]
fn a_bad_recipe_ends_with_3_and_names_file_line_key_value_and_range() {
    let bad = RECIPE.replace("cell = 10.0", "cell = -10.0").replace("relief", "releif");
    let place = Place::with(&bad.replace("layer = \"height\"", "layer = \"hight\""));
    for command in ["run", "check"] {
        assert_ends(
            &place,
            &[command, "r.toml"],
            3,
            &[
                "error: r.toml:3: landscape: `cell` is -10, outside its range: 0.001 to 100000 m",
                "error: r.toml:7: diamond-square: unknown key `releif`; did you mean `relief`?",
            ],
        );
    }
    assert!(!place.path("out").exists(), "nothing ran");
    assert_ends(&place, &["run", "none.toml"], 3, &["error: none.toml: the recipe cannot be read"]);
    let place = Place::with("size = = 3");
    assert_ends(&place, &["check", "r.toml"], 3, &["r.toml:1: "]);
}

#[test]
fn a_recipe_that_cannot_be_read_ends_with_3_and_says_what_to_do() {
    let place = Place::with(RECIPE);
    assert_ends(&place, &["run", "none.toml"], 3, &["error: none.toml: ", "weald new"]);
    assert_ends(&place, &["run", "."], 3, &["error: .: the recipe cannot be read"]);
    let utf_16: Vec<u8> = RECIPE.encode_utf16().flat_map(u16::to_le_bytes).collect();
    std::fs::write(place.path("utf16.toml"), [&[0xff, 0xfe][..], &utf_16].concat()).expect("written");
    assert_ends(&place, &["run", "utf16.toml"], 3, &["UTF-8 text"]);
    std::fs::write(place.path("long.toml"), " ".repeat((1 << 20) + 1)).expect("written");
    assert_ends(&place, &["run", "long.toml"], 3, &["1048577 bytes; at most 1048576"]);
    std::fs::write(place.path("twice.toml"), RECIPE.replace("cell", "size")).expect("written");
    assert_ends(&place, &["run", "twice.toml"], 3, &["twice.toml:3: duplicate key: `size`"]);
    let windows = format!("\u{feff}{}", RECIPE.replace('\n', "\r\n"));
    std::fs::write(place.path("windows.toml"), windows).expect("written");
    assert_ends(&place, &["check", "windows.toml"], 0, &[]);
}

#[test]
fn a_change_on_the_command_line_is_checked_like_the_recipe() {
    let place = Place::with(RECIPE);
    assert_ends(&place, &["check", "r.toml", "--set", "step.1.roughness=0.7"], 0, &[]);
    assert_ends(
        &place,
        &["check", "r.toml", "--set", "diamond-square.releif=3"],
        3,
        &["did you mean `relief`?"],
    );
    assert_ends(&place, &["check", "r.toml", "--set", "diamond-sqare.relief=3"], 3, &["`diamond-square`"]);
    assert_ends(
        &place,
        &["check", "r.toml", "--set", "landscape.cell=wide"],
        3,
        &["\"wide\"", "command line"],
    );
}

#[test]
fn a_bad_input_file_ends_with_4() {
    let from = "[landscape]\nfrom = \"in.tif\"\n[[output]]\nlayer = \"height\"\nfile = \"h.npy\"\n";
    let place = Place::with(from);
    assert_ends(&place, &["run", "r.toml"], 4, &["in.tif: cannot be read: ", "; r.toml:2 names it"]);
    std::fs::write(place.path("in.tif"), b"II*\0\x08").expect("written");
    assert_ends(&place, &["run", "r.toml"], 4, &["in.tif"]);
    assert_ends(&place, &["info", "in.tif"], 4, &["in.tif"]);
    assert_ends(&place, &["run", "r.toml", "--resume"], 4, &["no checkpoint", "without --resume"]);
    assert_eq!(place.names("out/r"), [""; 0], "nothing is left behind");
    assert_ends(&place, &["run", "r.toml", "--size", "9"], 3, &["resample"]);
}

#[test]
fn a_grid_over_the_limit_ends_with_5() {
    let place = Place::with(RECIPE);
    assert_ends(&place, &["run", "r.toml", "--size", "100000"], 5, &["100000 × 50000", "smaller"]);
    // So large that the cell would be too small as well: the size is what the user can mend.
    assert_ends(&place, &["run", "r.toml", "--size", "99999999"], 5, &["99999999 × 49999999", "smaller"]);
    assert_ends(&place, &["run", "r.toml", "--set", "landscape.size=100000000"], 5, &["100000000"]);
}

#[test]
fn a_folder_that_cannot_be_written_ends_with_1_before_anything_runs() {
    let place = Place::with(RECIPE);
    for out in ["r.toml", "/proc/weald"] {
        let (code, message) = place.ends(&["run", "r.toml", "--out", out]);
        assert_eq!(code, 1, "{message}");
        assert!(message.contains(out) && !message.contains("step 1"), "{message}");
        assert!(out != "r.toml" || message.contains("choose another folder"), "{message}");
    }
}

#[test]
fn a_disk_that_fills_up_ends_with_1_and_leaves_no_half_file() {
    let place = Place::with(&RECIPE.replace("[32, 16]", "[64, 64]"));
    let weald = env!("CARGO_BIN_EXE_weald");
    let script = format!("trap '' XFSZ; ulimit -f 1; exec '{weald}' run r.toml --out o");
    let mut shell = Command::new("sh");
    let output = shell
        .current_dir(place.path(""))
        .env("WEALD_CACHE", "off")
        .args(["-c", &script])
        .output()
        .expect("sh starts");
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("error: cannot write o/height.npy"), "{message}");
    assert!(message.contains("make room, or choose another folder"), "{message}");
    assert_eq!(place.names("o"), [""; 0]);
}

#[test]
fn a_new_size_keeps_shape_and_extent() {
    let place = Place::with(RECIPE);
    let output = place.weald(&["check", "r.toml", "--size", "8", "--seed", "11"]);
    let text = stdout(&output);
    let told = "r.toml: good; 8 × 4 cells of 40 m, steps: 1, outputs: 1, seed: 11\n";
    assert!(text.starts_with(told) && text.ends_with("height.npy\n"), "{text}");
}

#[test]
fn the_result_depends_on_the_seed_and_not_on_threads_or_bands() {
    let place = Place::with(RECIPE);
    let height = |arguments: &[&str]| {
        let output = place.weald(&[&["run", "r.toml"], arguments].concat());
        assert!(output.status.success(), "{output:?}");
        std::fs::read(place.path("out/r/height.npy")).expect("written")
    };
    let one = height(&["--threads", "1"]);
    assert_eq!(one, height(&["--threads", "3", "--engine", "bands:3"]));
    assert_ne!(one, height(&["--seed", "4"]));
}

#[test]
fn a_recipe_is_not_written_over_another() {
    let place = Place::with(RECIPE);
    assert_ends(&place, &["new", "mine"], 0, &[]);
    assert_ends(&place, &["check", "mine.toml"], 0, &[]);
    assert_ends(&place, &["new", "mine.toml"], 1, &["mine.toml exists already"]);
}

#[test]
fn a_recipe_with_an_old_name_is_refused_and_rewritten_in_place_or_beside() {
    let step = "[[step]] # seas\ndo = \"flow\"\n[[step]]\ndo = \"wetness\"\nleast_slope = 0.01\n[[output]]";
    let old = RECIPE.replace("[[output]]", step);
    let place = Place::with(&old);
    let text = |file: &str| std::fs::read_to_string(place.path(file)).expect("a recipe");
    let expected = "r.toml:12: wetness: `least_slope` is now called `min_slope`; `weald migrate` rewrites";
    assert_ends(&place, &["check", "r.toml"], 3, &[expected]);
    let beside = stdout(&place.weald(&["migrate", "r.toml", "-o", "new.toml"]));
    let lines: Vec<_> = beside.lines().collect();
    let name = "r.toml:12: `least_slope` is now called `min_slope`";
    let format = "r.toml:1: the recipe says its format, `weald = 1`";
    assert_eq!(lines, [format, name, "new.toml: rewritten, changes: 2"]);
    assert_eq!(text("r.toml"), old, "the old one stays");
    assert_eq!(text("new.toml"), format!("weald = 1\n\n{}", old.replace("least_slope", "min_slope")));
    assert_ends(&place, &["check", "new.toml"], 0, &[]);
    assert_ends(&place, &["migrate", "r.toml"], 0, &[]);
    assert_eq!(text("r.toml"), text("new.toml"));
    assert_eq!(stdout(&place.weald(&["migrate", "r.toml"])), "r.toml: nothing to rename\n");
    assert_eq!(place.names("."), ["new.toml", "r.toml"]);
    assert_ends(&place, &["migrate", "none.toml"], 3, &["error: none.toml: the recipe cannot be read"]);
}

#[test]
fn the_catalogue_and_the_schema_name_every_step() {
    let place = Place::with(RECIPE);
    let schema: serde_json::Value =
        serde_json::from_str(&stdout(&place.weald(&["schema"]))).expect("the schema is JSON");
    let schema = schema.to_string();
    let overview = stdout(&place.weald(&["steps"]));
    for entry in weald::recipe::catalog::CATALOG {
        assert!(overview.contains(entry.name), "steps lists {}", entry.name);
        assert!(
            schema.contains(&format!("{{\"const\":\"{}\"}}", entry.name)),
            "the schema has {}",
            entry.name
        );
        let shown = stdout(&place.weald(&["steps", entry.name]));
        assert!(shown.contains("Source: "), "steps {} names its source", entry.name);
    }
}

#[test]
fn completions_exist_for_every_shell() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(stdout(&Place::with(RECIPE).weald(&["completions", shell])).contains("weald"), "{shell}");
    }
}

#[test]
fn a_reader_that_leaves_early_is_no_failure() {
    let mut command = Place::with(RECIPE).command(&["schema"]);
    let mut child = command.stdout(Stdio::piped()).current_dir("/").spawn().expect("the command starts");
    drop(child.stdout.take());
    assert!(child.wait().expect("it ends").success());
}

#[test]
fn a_second_run_replaces_the_folder_of_the_first() {
    let place = Place::with(&RECIPE.replace("height.npy", "height.zarr"));
    for _ in 0..2 {
        assert_ends(&place, &["run", "r.toml"], 0, &[]);
        assert_eq!(place.names("out/r"), ["height.zarr", "report.json"]);
    }
}

#[test]
fn a_film_becomes_a_video_of_all_its_frames() {
    let still =
        RECIPE.replace("layer = \"height\"\nfile = \"height.npy\"", "picture = \"view\"\nfile = \"v.png\"");
    let small = "width = 65\nheight = 33\nsamples = 1\nframes = 5\n";
    for video in ["turn.mp4", "turn.webm"] {
        let place = Place::with(&format!("{}{small}", still.replace("v.png", video)));
        assert_ends(&place, &["run", "r.toml"], 0, &["file 1/1 turn"]);
        let mut names: Vec<_> = (0..5).map(|number| format!("turn-0000{number}.png")).collect();
        names.extend([video.to_owned()]);
        names.insert(0, "report.json".to_owned());
        assert_eq!(place.names("out/r"), names);
        let entries = ["-v", "error", "-count_frames", "-show_entries", "stream=width,height,nb_read_frames"];
        let mut probe = Command::new("ffprobe");
        let probe =
            probe.args(entries).args(["-of", "csv=p=0"]).arg(place.path("out/r").join(video)).output();
        let probe = probe.expect("ffprobe is there; install it: apt-get install ffmpeg");
        assert_eq!(stdout(&probe).trim(), "64,32,5", "{video}");
    }
}

#[test]
fn a_conversion_keeps_the_place_on_earth_and_the_cells_without_data() {
    let place = Place::with(RECIPE);
    let data = &data("jacksboro_fault_utm16_80m.tif");
    let info = |file: &str| -> serde_json::Value {
        serde_json::from_str(&stdout(&place.weald(&["info", file, "--json"]))).expect("info gives JSON")
    };
    assert_ends(&place, &["convert", data, "copy.tif"], 0, &[]);
    let (old, new) = (info(data), info("copy.tif"));
    assert_eq!(new["epsg"], 32616);
    for key in ["epsg", "origin", "pixel", "columns", "rows", "no_data_share", "range"] {
        assert_eq!(old[key], new[key], "{key}");
    }
    assert!(stdout(&place.weald(&["info", "copy.tif"])).contains("32616"));
    assert_ends(
        &place,
        &["convert", data, "copy.npy"],
        0,
        &["note: copy.npy: the georeferencing (CRS and origin) is left out; .tif holds it"],
    );
    assert_ends(&place, &["convert", data, "none/copy.tif"], 1, &["none/copy.tif", "make the folder"]);
}

fn data(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data").join(name).display().to_string()
}

/// A recipe that starts from an elevation model and writes it again.
fn from_file(name: &str, more: &str) -> Place {
    Place::with(&format!(
        "[landscape]\nfrom = {:?}\n{more}\n[[output]]\nlayer = \"height\"\nfile = \"height.tif\"\n",
        data(name)
    ))
}

#[test]
fn ground_from_a_file_keeps_its_place_and_its_cells_without_data() {
    let place = from_file("jacksboro_fault_utm16_80m.tif", "[[step]]\ndo = \"smooth\"\n");
    assert_ends(&place, &["run", "r.toml"], 0, &[]);
    let info = |file: &str| -> serde_json::Value {
        serde_json::from_str(&stdout(&place.weald(&["info", file, "--json"]))).expect("info gives JSON")
    };
    let (old, new) = (info(&data("jacksboro_fault_utm16_80m.tif")), info("out/r/height.tif"));
    assert!(old["no_data_share"].as_f64() > Some(0.05), "the file has cells without data");
    for key in ["epsg", "origin", "pixel", "columns", "rows", "no_data_share"] {
        assert_eq!(old[key], new[key], "{key}");
    }
    assert_ne!(old["range"], new["range"], "the step has smoothed something");
}

#[test]
fn degrees_become_metres_and_the_run_says_so() {
    let place = from_file("jacksboro_fault_srtm_wgs84.tif", "");
    assert_ends(&place, &["run", "r.toml"], 0, &["note: ", "degrees became metres at latitude 36"]);
    let report = std::fs::read_to_string(place.path("out/r/report.json")).expect("written");
    assert!(report.contains("degrees became metres"), "{report}");
}

#[test]
fn a_cell_size_that_contradicts_the_file_ends_with_4() {
    let place = from_file("jacksboro_fault_utm16_80m.tif", "cell = 30");
    assert_ends(&place, &["run", "r.toml"], 4, &["80 m wide", "`cell = 30`", "remove `cell`"]);
}

#[test]
fn a_check_tells_a_missing_input_and_what_does_not_go_with_the_ground_of_a_file() {
    let missing = Place::with(
        "[landscape]\nfrom = \"none.tif\"\n[[output]]\nlayer = \"height\"\nfile = \"height.tif\"\n",
    );
    assert_ends(&missing, &["check", "r.toml"], 4, &["none.tif", "cannot be read", "r.toml:2 names it"]);
    let square = from_file("jacksboro_fault_utm16_80m.tif", "[[step]]\ndo = \"resample\"\nsize = [64, 7]\n");
    assert_ends(&square, &["check", "r.toml"], 3, &["r.toml:3: resample: ", "would not be square", "rows"]);
    let good = from_file("jacksboro_fault_utm16_80m.tif", "");
    let said = stdout(&good.weald(&["check", "r.toml"]));
    assert!(said.contains(": good; ") && said.ends_with("  height.tif\n  height.qml\n"), "{said}");
}

#[test]
fn a_film_without_ffmpeg_is_told_by_the_check_and_never_listed_as_written() {
    let film =
        RECIPE.replace("layer = \"height\"\nfile = \"height.npy\"", "picture = \"view\"\nfile = \"v.mp4\"");
    let place = Place::with(&format!("{film}width = 32\nheight = 32\nframes = 2\n"));
    let without = |arguments: &[&str]| {
        let output = place.command(arguments).env("PATH", "/nowhere").output().expect("it starts");
        assert!(output.status.success(), "{output:?}");
        (stdout(&output), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let told = "note: ffmpeg with libx264 and libvpx-vp9 is not there";
    let (_, checked) = without(&["check", "r.toml"]);
    let (listed, ran) = without(&["run", "r.toml"]);
    assert!(checked.contains(told) && ran.contains(told), "{checked}{ran}");
    assert!(!listed.contains("v.mp4") && listed.contains("v-00001.png"), "{listed}");
    assert_eq!(place.names("out/r"), ["report.json", "v-00000.png", "v-00001.png"]);
    let report = std::fs::read_to_string(place.path("out/r/report.json")).expect("written");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    assert_eq!(report["outputs"][0]["name_only"], true, "{report}");
}

#[test]
fn a_second_run_takes_what_the_first_has_left_unless_it_is_told_not_to() {
    // Long enough to be worth keeping.
    let place = Place::with(&format!("{RECIPE}[[step]]\ndo = \"thermal\"\niterations = 2000\n"));
    let cached = |out: &str, arguments: &[&str]| {
        let run = ["run", "r.toml", "--engine", "cpu", "--out", out];
        let mut command = place.command(&[&run[..], arguments].concat());
        let output = command.env("WEALD_CACHE", place.path("kept")).output().expect("the command starts");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let report = std::fs::read_to_string(place.path(out).join("report.json")).expect("there is a report");
        report.contains("\"cached\": true")
    };
    assert!(!cached("one", &[]), "there is nothing yet");
    assert!(cached("two", &[]), "the first run has left something");
    assert!(!cached("three", &["--no-cache"]));
    assert!(!cached("four", &["--cache", "elsewhere"]) && cached("five", &["--cache", "elsewhere"]));
    assert!(!cached("six", &["--set", "landscape.cell=7"]));
    let file = |out: &str| std::fs::read(place.path(out).join("height.npy")).expect("written");
    assert!(["two", "three", "four", "five"].iter().all(|out| file(out) == file("one")));
    assert_ends(&place, &["run", "r.toml", "--cache", "k", "--no-cache"], 2, &["cannot be used with"]);
}

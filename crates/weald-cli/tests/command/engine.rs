//! `--engine` and `--gpu-memory` as a user meets them.

use crate::place::{Place, assert_ends, left_out};

const RECIPE: &str = "\
[landscape]
size = [96, 64]
cell = 10.0
seed = 3
[[step]]
do = \"diamond-square\"
relief = 100.0
[[step]]
do = \"hydraulic\"
iterations = 20
[[output]]
layer = \"height\"
file = \"height.npy\"
";

#[test]
fn a_run_on_the_gpu_says_so_in_its_report_and_names_the_adapter() {
    if left_out() {
        return;
    }
    let place = Place::with(RECIPE);
    assert_ends(&place, &["run", "r.toml", "--engine", "gpu", "--gpu-memory", "64MiB"], 0, &[]);
    let report = std::fs::read_to_string(place.path("out/r/report.json")).expect("the report");
    assert!(report.contains("\"engine\": \"gpu\""), "{report}");
    assert!(report.contains("\"adapter\": \"") && !report.contains("\"adapter\": \"\""), "{report}");
}

/// By which the loader of Vulkan finds Mesa's driver that computes on the CPU, and no other.
#[cfg(target_os = "linux")]
fn software_driver() -> Option<std::path::PathBuf> {
    let drivers = std::fs::read_dir("/usr/share/vulkan/icd.d").ok()?;
    let mut paths = drivers.filter_map(|driver| Some(driver.ok()?.path()));
    paths.find(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("lvp_icd")))
}

#[cfg(target_os = "linux")]
#[test]
fn auto_never_takes_software_for_a_graphics_card_and_gpu_does() {
    let Some(driver) = software_driver().filter(|_| !left_out()) else {
        println!("there is no software driver of Vulkan: this test is left out");
        return;
    };
    let place = Place::with(RECIPE);
    let run = |engine: &str| {
        let mut command = place.command(&["run", "r.toml", "--engine", engine]);
        let command = command.env("VK_DRIVER_FILES", &driver).env("VK_ICD_FILENAMES", &driver);
        // A layer of Mesa's otherwise says that there is no display.
        let command = command.env("NODEVICE_SELECT", "1");
        let output = command.output().expect("the command starts");
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{engine}: {stderr}");
        let report = std::fs::read_to_string(place.path("out/r/report.json")).expect("the report");
        (stderr, report)
    };
    let (stderr, report) = run("auto");
    assert!(report.contains("\"engine\": \"cpu\"") && report.contains("\"adapter\": null"), "{report}");
    let usual =
        |line: &str| ["step ", "file ", "note: height.npy: "].iter().any(|start| line.starts_with(start));
    assert!(stderr.lines().all(usual), "something is odd: {stderr}");
    let (_, report) = run("gpu");
    assert!(report.contains("\"engine\": \"gpu\"") && report.contains("llvmpipe"), "{report}");
}

/// Mesa's layer that asks the desktop for its graphics card says so where there is none.
#[cfg(target_os = "linux")]
#[test]
fn no_line_of_a_driver_looks_like_an_error() {
    if left_out() {
        return;
    }
    let place = Place::with(RECIPE);
    let mut command = place.command(&["run", "r.toml", "--engine", "gpu", "--quiet"]);
    let command = command.env_remove("XDG_RUNTIME_DIR").env_remove("NODEVICE_SELECT");
    let output = command.output().expect("the command starts");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    assert!(!stderr.contains("error"), "{stderr}");
}

#[cfg(target_os = "linux")]
#[test]
fn without_an_adapter_the_gpu_ends_with_1_and_auto_runs_on_the_cpu() {
    let place = Place::with(RECIPE);
    let run = |engine: &str| {
        let mut command = place.command(&["run", "r.toml", "--engine", engine, "--quiet"]);
        // The loader of Vulkan finds no driver there.
        let command = command.env("VK_DRIVER_FILES", "/none").env("VK_ICD_FILENAMES", "/none");
        let output = command.output().expect("the command starts");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, message) = run("gpu");
    assert_eq!(code, Some(1), "{message}");
    for part in ["Vulkan", "none at all", "mesa-vulkan-drivers", "--engine cpu"] {
        assert!(message.contains(part), "{part}: {message}");
    }
    assert_eq!(run("auto").0, Some(0));
    let report = std::fs::read_to_string(place.path("out/r/report.json")).expect("the report");
    assert!(report.contains("\"engine\": \"cpu\"") && report.contains("\"adapter\": null"), "{report}");
}

#[test]
fn gpu_memory_that_makes_no_sense_is_a_usage_error() {
    let place = Place::with(RECIPE);
    for (memory, part) in [("64MB", "`MB` is no unit"), ("lots", "no unit"), ("10KiB", "at least 1MiB")] {
        assert_ends(&place, &["run", "r.toml", "--engine", "gpu", "--gpu-memory", memory], 2, &[part]);
    }
    let with_cpu = ["run", "r.toml", "--engine", "cpu", "--gpu-memory", "64MiB"];
    assert_ends(&place, &with_cpu, 2, &["--engine gpu or auto"]);
}

//! Runs from disk: the files and the report of a run in memory, within little memory, and nothing left behind.

use std::path::{Path, PathBuf};

use weald::Error;
use weald::recipe::{Options, OutputReport, Overrides, Progress, Recipe, Report, Run, Silent};

/// What a run takes beside its steps, as the run from disk counts it.
pub(crate) const BESIDE: u64 = 64 << 20;

pub(crate) fn recipe(text: &str) -> Recipe {
    Recipe::parse("land.toml", text, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Ground, rain on it, and where the water goes; `hydraulic` has more keys, of the model of Han without one of its own. A
/// `pond` that it mentions is there.
pub(crate) fn land(generator: &str, hydraulic: &str) -> Recipe {
    let output = |layer: &str, file: &str, more: &str| {
        format!("[[output]]\nlayer = \"{layer}\"\nfile = \"{file}\"\n{more}\n")
    };
    let cog = "preset = \"cog\"";
    let model = if hydraulic.contains("model = ") { "" } else { "model = \"han\"" };
    let pond = if hydraulic.contains("pond") {
        "[[step]]\ndo = \"fbm\"\ninto = \"pond\"\nrelief = 3\nseed = 9\n"
    } else {
        ""
    };
    let outputs = [
        output("height", "height.tif", cog),
        output("flow_direction", "directions.tif", cog),
        output("accumulation", "areas.tif", ""),
        output("discharge", "discharge.tif", ""),
        output("flux_x", "flux.tif", cog),
        output("water", "water/depth.tif", cog),
        output("erosion", "erosion.tif", ""),
    ];
    recipe(&format!(
        "[landscape]\nsize = [330, 290]\ncell = 12.0\nseed = 5\n\
         [[step]]\ndo = \"{generator}\"\nrelief = 400\nwavelength = 900\n{pond}\
         [[step]]\ndo = \"hydraulic\"\niterations = 75\nrain_period = 20\n{model}\ndry_period = 15\n{hydraulic}\n\
         [[step]]\ndo = \"constant\"\nheight = 0.3\ninto = \"runoff\"\n\
         [[step]]\ndo = \"flow\"\nweight = \"runoff\"\n{}",
        outputs.concat()
    ))
}

pub(crate) fn run(
    recipe: &Recipe,
    out: &Path,
    disk: Option<(&Path, u64)>,
    progress: &dyn Progress,
) -> Result<Report, Error> {
    let options = Options {
        out_of_core: disk.map(|(scratch, _)| scratch.to_owned()),
        memory: disk.map(|(_, memory)| memory),
        threads: Some(if disk.is_some() { 3 } else { 2 }),
        ..Options::into_folder(out)
    };
    Run { recipe, options }.execute(progress)
}

/// What a report says beside times and memory.
pub(crate) fn said(report: &Report) -> Vec<String> {
    let steps = report.steps.iter().map(|step| {
        format!(
            "{} {} {} {:?} {:?} {:?}",
            step.step, step.cells, step.iterations, step.budget, step.measures, step.notes
        )
    });
    let outputs = report.outputs.iter().map(|output| {
        format!(
            "{} {:?} {:?} {:?} {:?} {:?}",
            output.file, output.layer, output.unit, output.range, output.companions, output.notes
        )
    });
    steps.chain(outputs).chain([report.engine.clone(), report.recipe_blake3.clone()]).collect()
}

/// That all files of a run are in another folder too, to the byte, and those of folders with no others beside them.
pub(crate) fn assert_same_files(expected: &Report, [whole, parts]: [&Path; 2], what: &str) {
    for file in expected.outputs.iter().flat_map(OutputReport::files) {
        let [expected, got] = [whole, parts].map(|folder| contents(&folder.join(&file)));
        let names = [&expected, &got].map(|files| files.iter().map(|(name, _)| name).collect::<Vec<_>>());
        assert_eq!(names[0], names[1], "{} of {what}", file.display());
        let other = expected.iter().zip(&got).find(|(expected, got)| expected != got);
        assert!(other.is_none(), "{} of {} of {what}", other.expect("one").0.0.display(), file.display());
    }
}

/// A file, or all in a folder, by paths within it.
fn contents(path: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    if path.is_file() {
        return vec![(PathBuf::new(), std::fs::read(path).expect("it was written"))];
    }
    let mut all = Vec::new();
    for entry in std::fs::read_dir(path).unwrap_or_else(|cause| panic!("{}: {cause}", path.display())) {
        let name = PathBuf::from(entry.expect("one").file_name());
        let inside = contents(&path.join(&name)).into_iter();
        all.extend(inside.map(|(inner, bytes)| (name.join(inner), bytes)));
    }
    all.sort();
    all
}

#[test]
fn a_run_from_disk_gives_the_files_and_the_report_of_one_in_memory() {
    let thermal =
        "boundary = \"open\"\nthermal = { talus = 0.6, strength = 0.05 }\ntransport = \"maccormack\"";
    for (generator, hydraulic, memory) in [
        ("fbm", "", BESIDE + (6 << 20)),
        ("ridged", "transport = \"semi-lagrangian\"\nmean_over = 13", BESIDE + (5 << 20)),
        ("fbm", thermal, BESIDE + (9 << 20)),
        ("fbm", "boundary = \"open\"", 1 << 30),
        ("fbm", "model = \"mei\"\nslope = \"central\"", BESIDE + (8 << 20)),
        ("fbm", "model = \"mei\"\nboundary = \"open\"\ninitial_water = \"pond\"", BESIDE + (9 << 20)),
        ("ridged", "initial_water = \"pond\"", BESIDE + (6 << 20)),
    ] {
        let recipe = land(generator, hydraulic);
        let [whole, parts, scratch] = [0; 3].map(|_| tempfile::tempdir().expect("a folder"));
        let expected = run(&recipe, whole.path(), None, &Silent).unwrap_or_else(|error| panic!("{error}"));
        let got = run(&recipe, parts.path(), Some((scratch.path(), memory)), &Silent);
        let got = got.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(said(&got), said(&expected), "{generator} {hydraulic}");
        let what = format!("{generator} {hydraulic}");
        assert_same_files(&expected, [whole.path(), parts.path()], &what);
        assert_eq!(std::fs::read_dir(scratch.path()).expect("it is there").count(), 0, "nothing is left");
    }
}

#[test]
fn what_needs_memory_is_named_before_anything_runs() {
    let text = "[landscape]\nsize = 40\nsea_level = 3.0\n\
                [[step]]\ndo = \"diamond-square\"\n\
                [[step]]\ndo = \"hydraulic\"\nmodel = \"stava\"\n\
                [[step]]\ndo = \"flow\"\ndepressions = \"breach\"\n\
                [[step]]\ndo = \"lakes\"\n\
                [[output]]\npicture = \"relief\"\nfile = \"r.png\"\n\
                [[output]]\nlayer = \"height\"\nfile = \"h.npy\"\n";
    let error = recipe(text).scratch().expect_err("refused").to_string();
    for words in [
        "land.toml:1: ",
        "`sea_level`",
        "land.toml:4: ",
        "`diamond-square`: it generates the whole landscape at once",
        "`hydraulic`: the model `stava`",
        "`flow`: `depressions = \"breach\"`",
        "`lakes`",
        "r.png",
        "h.npy",
    ] {
        assert!(error.contains(words), "{words}: {error}");
    }
    let out = tempfile::tempdir().expect("a folder");
    let refused = run(&recipe(text), &out.path().join("out"), Some((out.path(), 1 << 30)), &Silent);
    assert!(matches!(refused, Err(Error::Recipe(_))));
    assert!(!out.path().join("out").exists(), "nothing was begun");
}

#[test]
fn the_disk_that_a_run_takes_is_told_before() {
    // The ground, seven planes of the simulation, and what there is no room for in that of its fluxes when layers are written:
    // three planes of the state, two of the means, four layers.
    let scratch = land("fbm", "").scratch().expect("it can be made");
    assert_eq!(scratch, 330 * 290 * 4 * (1 + 3 + 2 + 4));
}

#[test]
fn too_little_memory_is_told_with_what_is_needed() {
    let out = tempfile::tempdir().expect("a folder");
    let error = run(&land("fbm", ""), out.path(), Some((out.path(), BESIDE + (1 << 20))), &Silent);
    let Err(Error::Limit(limit)) = error else { panic!("{error:?}") };
    assert!(limit.asked > Some(1 << 20) && limit.to_string().contains("330 columns"), "{limit}");
}

#[test]
fn a_folder_for_layers_that_is_not_there_is_named() {
    let missing = Path::new("/no/such/folder");
    let out = tempfile::tempdir().expect("a folder");
    let error = run(&land("fbm", ""), out.path(), Some((missing, 1 << 30)), &Silent).expect_err("no folder");
    assert!(error.to_string().contains("/no/such/folder"), "{error}");
}

#[test]
fn more_cells_than_memory_holds_are_for_runs_from_disk_alone() {
    let text = "[landscape]\nsize = [40000, 30000]\n[[step]]\ndo = \"fbm\"\n\
                [[step]]\ndo = \"hydraulic\"\nmodel = \"han\"\n[[step]]\ndo = \"flow\"\n\
                [[output]]\nlayer = \"accumulation\"\nfile = \"a.tif\"\n";
    let cells = 40_000 * 30_000;
    let refused = Recipe::parse("land.toml", text, &Overrides::default()).expect_err("refused");
    assert!(matches!(&refused, Error::Limit(limit) if limit.asked == Some(cells)), "{refused}");
    let overrides = Overrides { larger_than_memory: true, ..Overrides::default() };
    let large = Recipe::parse("land.toml", text, &overrides).expect("good");
    // The ground and five planes of the state; its means are not wanted. `flow` has four planes beside it.
    assert_eq!(large.scratch().expect("it can be made"), cells * 4 * (1 + 5));
    assert_eq!(large.look_ahead_on_disk().expect("it can be made").grid.size.cells() as u64, cells);
    let out = tempfile::tempdir().expect("a folder");
    let in_memory = run(&large, out.path(), None, &Silent).expect_err("refused");
    assert!(matches!(&in_memory, Error::Limit(limit) if limit.asked == Some(cells)), "{in_memory}");
}

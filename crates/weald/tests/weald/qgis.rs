//! Every file of a landscape that is for maps, opened in QGIS as a new user does: at its place, and in the colours of the style
//! that lies beside it.
//!
//! QGIS is 900 MB on a disk, so that `./check` tries this only where it is installed. `WEALD_QGIS_PICTURES` is a folder for what
//! it draws.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::json;
use weald::io::{self, Raster};
use weald::layer_words;
use weald::recipe::{Options, Overrides, Recipe, Run, Silent};

/// Layers of steps that the landscape of the test has not.
const ELSEWHERE: [&str; 3] = ["regolith", "sea_depth", "exposure"];

/// What makes every other layer that a step has a name for, and plants.
const STEPS: &str = "
    [[material]]
    name = \"rock\"
    [[material]]
    name = \"soil\"
    thickness = 2.0
    [[step]]
    do = \"hydraulic\"
    model = \"stava\"
    iterations = 40
    [[step]]
    do = \"flow\"
    [[step]]
    do = \"lakes\"
    area = 20_000.0
    [[step]]
    do = \"rivers\"
    area = 2.0e6
    lakes = \"lake\"
    [[step]]
    do = \"watersheds\"
    [[step]]
    do = \"slope\"
    [[step]]
    do = \"aspect\"
    [[step]]
    do = \"curvature\"
    [[step]]
    do = \"wetness\"
    [[step]]
    do = \"moisture\"
    rivers = \"river\"
    lakes = \"lake\"
    [[step]]
    do = \"soil\"
    [[step]]
    do = \"sunlight\"
    directions = 8
    positions = 8
    [[step]]
    do = \"occlusion\"
    directions = 8
    [[step]]
    do = \"top-material\"
    [[step]]
    do = \"select\"
    where = [{ layer = \"slope\", below = 12.0, soft = 8.0 }]
    [[step]]
    do = \"grass\"
    [[step]]
    do = \"scatter\"
    count = 2000
    spacing = 20.0
";

/// The files of vectors and plants.
const VECTORS: [(&str, &str); 3] =
    [("rivers", "rivers.geojson"), ("lakes", "lakes.geojson"), ("plants", "ferns.geojson")];

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data").join(name)
}

fn layer(name: &str, more: &str) -> String {
    format!("[[output]]\nlayer = \"{name}\"\nfile = \"{name}.tif\"\n{more}\n")
}

fn vectors(more: &str) -> String {
    let all = VECTORS
        .map(|(export, file)| format!("[[output]]\nexport = \"{export}\"\nfile = \"{file}\"\n{more}\n"));
    all.concat()
}

fn run(landscape: &str, outputs: &str, folder: &Path) {
    let text = format!("[landscape]\n{landscape}\n{STEPS}{outputs}");
    let recipe =
        Recipe::parse("r.toml", &text, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"));
    Run { recipe: &recipe, options: Options::into_folder(folder) }.execute(&Silent).expect("it runs");
}

/// What QGIS has to find: the CRS, the extent, and a place around which no cell of the model has data.
fn wanted(model: &Path) -> serde_json::Value {
    let Raster { field, valid, georeference, .. } = io::read(model).expect("it is there");
    let place = georeference.expect("it has a place");
    let size = field.size();
    let [west, north] = place.at([0.0, 0.0]);
    let [east, south] = place.at([size.columns as f64, size.rows as f64]);
    let hole = valid.map(|valid| {
        let is_empty = |cell: usize| !valid.is_valid_at(cell);
        let cell = (0..size.cells()).find(|&cell| is_empty(cell) && size.neighbours(cell).all(is_empty));
        let cell = cell.expect("no data over several cells");
        place.at([cell % size.columns, cell / size.columns].map(|at| at as f64 + 0.5))
    });
    json!({ "epsg": place.epsg, "extent": [west, south, east, north], "hole": hole })
}

/// Opens all files of a folder in QGIS, and panics with its complaints.
fn open(folder: &Path, wanted: &serde_json::Value, files: usize) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../clients/qgis_layers.py");
    let mut command = Command::new("/usr/bin/python3");
    command.env("QT_QPA_PLATFORM", "offscreen").arg(script).arg(folder).arg(wanted.to_string());
    if let Some(pictures) = std::env::var_os("WEALD_QGIS_PICTURES") {
        let pictures = Path::new(&pictures).join(wanted["epsg"].to_string());
        std::fs::create_dir_all(&pictures).expect("a folder for pictures");
        command.arg(pictures);
    }
    let output = command.output().expect("Python starts");
    let [said, faults] =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    println!("{said}");
    assert!(output.status.success(), "QGIS (python3-qgis, qgis-providers): {}\n{faults}", output.status);
    assert_eq!(said.lines().count(), files, "files that QGIS opened: {said}");
}

#[test]
#[ignore = "QGIS is needed: apt-get install python3-qgis qgis-providers; then --ignored qgis::"]
fn every_layer_and_all_vectors_open_in_their_place_and_colours() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = data("jacksboro_fault_utm16_80m.tif");
    let names: Vec<_> =
        layer_words::LAYERS.iter().map(|(name, _)| *name).filter(|name| !ELSEWHERE.contains(name)).collect();
    let layers: String = names.iter().map(|name| layer(name, "")).collect();
    let others = "
        [[output]]
        layer = \"flow_direction\"
        file = \"d8-esri.tif\"
        codes = \"esri\"
        preset = \"cog\"
        [[output]]
        layer = \"height\"
        file = \"height-cog.tif\"
        preset = \"cog\"
        [[output]]
        export = \"plants\"
        file = \"ferns.csv\"
    ";
    run(&format!("from = {model:?}"), &[&layers, others, &vectors("")].concat(), folder.path());
    open(folder.path(), &wanted(&model), names.len() + 3 + VECTORS.len());
}

#[test]
#[ignore = "QGIS is needed: apt-get install python3-qgis qgis-providers; then --ignored qgis::"]
fn files_of_a_landscape_without_a_place_lie_over_each_other_in_metres() {
    let folder = tempfile::tempdir().expect("a folder");
    let names = ["height", "river", "lake"];
    let landscape = "size = [128, 96]\ncell = 30.0\n[[step]]\ndo = \"diamond-square\"\nrelief = 600.0";
    let layers = names.map(|name| layer(name, "")).concat();
    run(landscape, &[layers, vectors("")].concat(), folder.path());
    let wanted = json!({ "epsg": null, "extent": [0.0, 0.0, 128.0 * 30.0, 96.0 * 30.0], "hole": null });
    open(folder.path(), &wanted, names.len() + VECTORS.len());
}

#[test]
#[ignore = "QGIS is needed: apt-get install python3-qgis qgis-providers; then --ignored qgis::"]
fn files_in_degrees_and_of_rfc_7946_open_in_their_place_and_colours() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = data("jacksboro_fault_srtm_wgs84.tif");
    let names = ["height", "slope", "accumulation", "river", "lake", "strahler", "watershed"];
    let layers = names.map(|name| layer(name, "grid = \"source\"")).concat();
    run(&format!("from = {model:?}"), &[layers, vectors("rfc7946 = true")].concat(), folder.path());
    open(folder.path(), &wanted(&model), names.len() + VECTORS.len());
}

//! A model in degrees comes in, is analysed in metres, and goes out on its own grid; beside it what GDAL and pysheds find on
//! that grid.

use std::path::{Path, PathBuf};
use std::process::Command;

use weald::io::{self, Raster};
use weald::recipe::{Options, Overrides, Recipe, Run, Silent};
use weald::{Field, Size};

const SIZE: Size = Size { columns: 403, rows: 344 };

/// Metres of a cell at the middle latitude, as GDAL has to be told them.
const CELL: [f64; 2] = [74.572_729, 92.474_959];

fn model() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/jacksboro_fault_srtm_wgs84.tif")
}

fn gdal(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).output().unwrap_or_else(|cause| {
        panic!("{program} does not start ({cause}); install it: apt-get install gdal-bin")
    });
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{program} {arguments:?}: {message}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The model analysed, each layer on the grid that came in.
fn analysed(folder: &Path) {
    let layers = ["height", "slope", "accumulation", "river"];
    let outputs = layers
        .map(|layer| format!("[[output]]\nlayer = \"{layer}\"\nfile = \"{layer}.tif\"\ngrid = \"source\"\n"));
    let text = format!(
        "[landscape]\nfrom = \"{}\"\n[[step]]\ndo = \"slope\"\n[[step]]\ndo = \"flow\"\n\
         directions = \"d8\"\n[[step]]\ndo = \"rivers\"\narea = 1.0e6\n{}\
         [[output]]\nlayer = \"flow_direction\"\nfile = \"d8.tif\"\ncodes = \"esri\"\npreset = \"cog\"\n",
        model().display(),
        outputs.concat()
    );
    let recipe = Recipe::parse("r.toml", &text, &Overrides::default()).expect("good");
    let report =
        Run { recipe: &recipe, options: Options::into_folder(folder) }.execute(&Silent).expect("runs");
    let note = "from 403 × 427 cells of 74.6 m back to the 403 × 344 cells of jacksboro_fault_srtm_wgs84.tif: linear";
    assert!(report.outputs[0].notes.iter().any(|known| known == note), "{:?}", report.outputs[0].notes);
    assert!(report.outputs[3].notes.iter().any(|note| note.ends_with(": greatest")), "rivers do not break");
}

fn read(path: &Path) -> Field {
    let Raster { field, valid, .. } = io::read(path).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((field.size(), valid), (SIZE, None), "{}", path.display());
    field
}

/// Mean and root mean square of the differences, leaving out so many cells at the border.
fn differences(ours: &Field, theirs: &Field, border: usize) -> [f64; 2] {
    let (mut sum, mut squares, mut count) = (0.0, 0.0, 0.0);
    for y in border..SIZE.rows - border {
        for x in border..SIZE.columns - border {
            let apart = f64::from(ours.at(x, y)) - f64::from(theirs.at(x, y));
            sum += apart;
            squares += apart * apart;
            count += 1.0;
        }
    }
    [sum / count, (squares / count).sqrt()]
}

/// Share of the cells of one mask that lie in the other or beside a cell of it.
fn near(cells: &[bool], others: &[bool]) -> f64 {
    let held = |cell: usize| others[cell] || SIZE.neighbours(cell).any(|beside| others[beside]);
    let (all, found) = (0..cells.len())
        .filter(|&cell| cells[cell])
        .fold((0, 0), |(all, found), cell| (all + 1, found + usize::from(held(cell))));
    found as f64 / all as f64
}

/// Slope by Horn's method in GDAL, on cells as wide and as high as they are.
fn slope_of_gdal(folder: &Path) -> Field {
    let [metres, slope] = ["metres.tif", "gdal.tif"].map(|name| folder.join(name).display().to_string());
    let [east, south] = [CELL[0] * 403.0, -CELL[1] * 344.0].map(|metres| metres.to_string());
    let place = ["-q", "-a_srs", "EPSG:32616", "-a_ullr", "0", "0", &east, &south];
    gdal("gdal_translate", &[&place[..], &[&model().display().to_string(), &metres]].concat());
    gdal("gdaldem", &["slope", "-q", "-compute_edges", &metres, &slope]);
    read(Path::new(&slope))
}

#[test]
fn a_model_in_degrees_goes_out_on_its_own_grid_and_agrees_with_gdal_and_pysheds() {
    let folder = tempfile::tempdir().expect("a folder");
    analysed(folder.path());
    let ours = |layer: &str| read(&folder.path().join(format!("{layer}.tif")));
    let model_raster = io::read(&model()).expect("there");
    for layer in ["height", "slope", "accumulation", "river"] {
        let back = io::read(&folder.path().join(format!("{layer}.tif"))).expect("written");
        assert_eq!(back.georeference, model_raster.georeference, "{layer}: origin, cells and CRS to the bit");
    }

    let [mean, root] = differences(&ours("height"), &model_raster.field, 1);
    println!("heights: mean {mean:.3} m, root mean square {root:.2} m");
    assert!(mean.abs() < 0.05 && root < 3.0, "{mean} {root}");

    let theirs = slope_of_gdal(folder.path());
    let [mean, root] = differences(&ours("slope"), &theirs, 1);
    println!("slope: mean {mean:.3}°, root mean square {root:.2}°");
    assert!(mean.abs() < 0.2 && root < 1.0, "{mean} {root}");

    // pysheds counts cells of 74.6 × 92.5 m; the tests' data say how.
    let area = CELL[0] * CELL[1];
    let cells =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../weald-land/tests/data/jacksboro_areas_pysheds.tif");
    let theirs: Vec<f64> = read(&cells).values().iter().map(|&cells| f64::from(cells) * area).collect();
    let accumulation = ours("accumulation");
    let is_alike = |cell: usize| {
        let alike = |&here: &usize| (f64::from(accumulation.values()[here]) / theirs[cell] - 1.0).abs() < 0.1;
        std::iter::once(cell).chain(SIZE.neighbours(cell)).any(|here| alike(&here))
    };
    let large: Vec<usize> = (0..theirs.len()).filter(|&cell| theirs[cell] >= 1e6).collect();
    let alike = large.iter().filter(|&&cell| is_alike(cell)).count() as f64 / large.len() as f64;
    let river: Vec<bool> = ours("river").values().iter().map(|&value| value == 1.0).collect();
    let their_river: Vec<bool> = theirs.iter().map(|&area| area >= 1e6).collect();
    let found = [near(&their_river, &river), near(&river, &their_river)];
    println!("areas over 1 km² within a tenth: {:.1} % of {} cells", 100.0 * alike, large.len());
    println!("rivers within a cell: {:.1} % of theirs, {:.1} % of ours", 100.0 * found[0], 100.0 * found[1]);
    assert!(alike > 0.8 && found.iter().all(|share| *share > 0.97), "{alike} {found:?}");
}

#[test]
fn gdal_finds_the_grid_the_classes_and_the_smaller_images() {
    let folder = tempfile::tempdir().expect("a folder");
    analysed(folder.path());
    let info = |name: &str| gdal("gdalinfo", &["-json", &folder.path().join(name).display().to_string()]);
    let [river, source] = [info("river.tif"), gdal("gdalinfo", &["-json", &model().display().to_string()])]
        .map(|text| serde_json::from_str::<serde_json::Value>(&text).expect("JSON"));
    for key in ["geoTransform", "size", "coordinateSystem"] {
        assert_eq!(river[key], source[key], "{key}");
    }
    let band = &river["bands"][0];
    assert_eq!((band["type"].as_str(), band["noDataValue"].as_f64()), (Some("Byte"), Some(255.0)));
    let text = gdal("gdalinfo", &[&folder.path().join("river.tif").display().to_string()]);
    assert!(text.contains("Categories:") && text.contains("1: river"), "{text}");
    assert!(text.contains("WEALD_RESAMPLED=from 403 × 427 cells"), "{text}");

    let text = gdal("gdalinfo", &[&folder.path().join("d8.tif").display().to_string()]);
    assert!(text.contains("Type=Byte") && text.contains("Overviews: 202x214"), "{text}");
    assert!(text.contains("128: north-east") && text.contains("64: north"), "{text}");
    let path = folder.path().join("d8.tif").display().to_string();
    let script = "import sys\nfrom osgeo_utils.samples import validate_cloud_optimized_geotiff as cog\n\
                  warnings, errors, _ = cog.validate(sys.argv[1], full_check=True)\nassert not warnings and not errors, \
                  (warnings, errors)\n";
    gdal("/usr/bin/python3", &["-c", script, &path]);
    let directions = io::read(&folder.path().join("d8.tif")).expect("written").field;
    let legal = [0, 1, 2, 4, 8, 16, 32, 64, 128].map(|code: u8| f32::from(code));
    assert!(directions.values().iter().all(|value| legal.contains(value)), "only numbers of ESRI's");
    let style = std::fs::read_to_string(folder.path().join("river.qml")).expect("a style beside it");
    assert!(style.contains("type=\"paletted\"") && style.contains("label=\"river\""), "{style}");
    // Areas on the grid that came in, whose greatest the style has last.
    let areas = io::read(&folder.path().join("accumulation.tif")).expect("written").field;
    let most = f64::from(areas.range(None).expect("it has cells").1);
    let style = std::fs::read_to_string(folder.path().join("accumulation.qml")).expect("a style beside it");
    assert!(style.contains("type=\"singlebandpseudocolor\""), "{style}");
    assert!(style.contains(&format!("classificationMax=\"{most}\"")), "{most}: {style}");
}

#[test]
fn what_lies_beside_classes_is_told_and_kept_apart() {
    let names = |outputs: &str| {
        let text = format!(
            "[landscape]\nsize = 16\ncell = 10\n[[step]]\ndo = \"fbm\"\n[[step]]\ndo = \"flow\"\n{outputs}"
        );
        Recipe::parse("r.toml", &text, &Overrides::default()).map(|recipe| recipe.names())
    };
    let output = |layer: &str, file: &str| format!("[[output]]\nlayer = \"{layer}\"\nfile = \"{file}\"\n");
    let classes = names(&output("flow_direction", "d.tif")).expect("good");
    assert!(classes.iter().any(|name| name == "d.qml"), "{classes:?}");
    assert_eq!(names(&output("height", "h.tif")).expect("good"), ["h.tif", "h.qml"]);
    assert_eq!(names(&output("accumulation", "a.tif")).expect("good"), ["a.tif", "a.qml"]);
    let both = output("flow_direction", "d.tif")
        + &output("flow_direction", "d.nc.tif").replace("d.nc.tif", "d.tiff");
    let message = names(&both).expect_err("both have d.qml").to_string();
    assert!(message.contains("would write d.qml"), "{message}");
}

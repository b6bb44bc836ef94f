//! Ground from a file of which each process reads its own rows: the files and the report of a run that has the whole in memory.

use std::path::Path;
use std::process::Command;

use weald::io::{Raster, write};
use weald::recipe::{Options, Overrides, Recipe, Silent};
use weald::{Field, Size};

use crate::distributed::{assert_same_by_rows, over_with};
use crate::out_of_core::{BESIDE, assert_same_files, run, said};

/// A recipe on the ground of a file, with more keys of the landscape.
fn on(from: &Path, keys: &str) -> Recipe {
    let text = format!(
        "[landscape]\nfrom = {:?}\nseed = 5\n{keys}\n\
         [[step]]\ndo = \"hydraulic\"\nmodel = \"han\"\niterations = 40\nboundary = \"open\"\n\
         [[step]]\ndo = \"flow\"\n\
         [[output]]\nlayer = \"height\"\nfile = \"height.tif\"\npreset = \"cog\"\n\
         [[output]]\nlayer = \"accumulation\"\nfile = \"areas.tif\"\n",
        from.display().to_string()
    );
    Recipe::parse("land.toml", &text, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn gdal(program: &str, arguments: &str, files: [&Path; 2]) {
    let mut command = Command::new(program);
    let done = command.args(["-q"]).args(arguments.split_whitespace()).args(files).output();
    let done = done.unwrap_or_else(|cause| panic!("{program} (gdal-bin): {cause}"));
    assert!(done.status.success(), "{program} {arguments}: {}", String::from_utf8_lossy(&done.stderr));
}

/// Ground of 230 × 270 cells, as a file of Weald and as others write it, each with what the recipe says of it.
fn files(folder: &Path) -> Vec<(std::path::PathBuf, &'static str)> {
    let own = folder.join("own.tif");
    let height = |x: usize, y: usize| {
        let (x, y) = (x as f64, y as f64);
        (300.0 + 60.0 * libm::sin(x / 23.0) * libm::cos(y / 31.0) + (x * 7.0 + y * 13.0) % 11.0) as f32
    };
    let field = Field::from_function(Size { columns: 230, rows: 270 }, height);
    write(&own, &Raster { cell: Some(20.0), ..Raster::from(field) }).expect("written");
    let place = "-a_srs EPSG:32616 -a_ullr 700000 4000000 704600 3994600";
    let kinds = [
        ("strips.tif", "-ot Int16 -co BLOCKYSIZE=7 -co COMPRESS=LZW -co PREDICTOR=2", ""),
        (
            "scaled.tif",
            "-ot Float64 -a_scale 0.1 -a_offset -7 -co TILED=YES -co BLOCKXSIZE=64 -co BLOCKYSIZE=48",
            "",
        ),
        ("feet.tif", "-ot UInt16 -co BIGTIFF=YES -co ENDIANNESS=BIG -co COMPRESS=DEFLATE", "unit = \"ft\""),
        ("cog.tif", "-of COG -co BLOCKSIZE=128", ""),
        ("marked.tif", "-a_nodata -9999 -co COMPRESS=ZSTD", "nodata = -1.0"),
    ];
    let made = kinds.map(|(name, options, keys)| {
        gdal("gdal_translate", &format!("{place} {options}"), [&own, &folder.join(name)]);
        (folder.join(name), keys)
    });
    let southern = folder.join("southern.tif");
    gdal(
        "gdal_translate",
        "-a_srs EPSG:32616 -a_ullr 700000 3994600 704600 4000000 -co COMPRESS=DEFLATE -co BLOCKYSIZE=10",
        [&own, &southern],
    );
    [(own, ""), (southern, "")].into_iter().chain(made).collect()
}

#[test]
fn ground_that_each_rank_reads_its_rows_of_gives_the_files_of_the_whole_in_memory() {
    let folder = tempfile::tempdir().expect("a folder");
    for (number, (file, keys)) in files(folder.path()).into_iter().enumerate() {
        let recipe = on(&file, keys);
        let [whole, scratch] = [0; 2].map(|_| tempfile::tempdir().expect("a folder"));
        let expected = run(&recipe, whole.path(), None, &Silent).unwrap_or_else(|error| panic!("{error}"));
        let counts = [1, 2, 3, 4, 6];
        for count in [0, counts[number % 5], counts[(number + 2) % 5]] {
            let out = tempfile::tempdir().expect("a folder");
            let got = if count == 0 {
                run(&recipe, out.path(), Some((scratch.path(), BESIDE + (7 << 20))), &Silent)
            } else {
                let options = |_| Options { memory: Some(1 << 30), ..Options::into_folder(out.path()) };
                over_with(count, &recipe, &options, &Silent).swap_remove(0)
            };
            let got = got.unwrap_or_else(|error| panic!("{}: {error}", file.display()));
            let engine = "cpu".to_owned();
            let got = weald::recipe::Report { engine, ..got };
            assert_eq!(said(&got), said(&expected), "{}", file.display());
            assert_eq!(got.notes, expected.notes);
            let what = format!("{} over {count}", file.display());
            assert_same_files(&expected, [whole.path(), out.path()], &what);
        }
    }
}

#[test]
fn what_a_file_cannot_give_by_rows_is_named_with_what_to_do_before_anything_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let own = files(folder.path()).swap_remove(0).0;
    let refused = |file: &Path, keys: &str, count: usize| {
        let out = folder.path().join("out");
        let options = |_| Options { memory: Some(1 << 30), ..Options::into_folder(&out) };
        let ends = over_with(count, &on(file, keys), &options, &Silent);
        let ends: Vec<_> = ends.into_iter().map(|end| end.expect_err("refused").to_string()).collect();
        ends[0].clone()
    };
    let degrees = folder.path().join("degrees.tif");
    gdal("gdal_translate", "-a_srs EPSG:4326 -a_ullr 10 40 10.1 39.9", [&own, &degrees]);
    let said = refused(&degrees, "", 2);
    assert!(said.contains("degrees.tif") && said.contains("gdalwarp it to square cells of metres"), "{said}");
    let empty = folder.path().join("empty.tif");
    let nothing =
        Raster { cell: Some(20.0), ..Raster::from(Field::filled(Size { columns: 90, rows: 170 }, -1.0)) };
    write(&empty, &nothing).expect("written");
    let said = refused(&empty, "nodata = -1.0", 3);
    assert!(said.contains("empty.tif") && said.contains("no cell with data"), "{said}");
    let one_strip = folder.path().join("strip.tif");
    gdal(
        "gdal_translate",
        "-co BLOCKYSIZE=270 -a_srs EPSG:32616 -a_ullr 700000 4000000 704600 3994600",
        [&own, &one_strip],
    );
    let out = folder.path().join("narrow");
    let said = run(&on(&one_strip, ""), &out, Some((folder.path(), BESIDE + (1 << 18))), &Silent);
    let said = said.expect_err("refused").to_string();
    assert!(said.contains("270 rows, which are packed together") && said.contains("TILED=YES"), "{said}");
    let missing = refused(&folder.path().join("none.tif"), "", 2);
    assert!(missing.contains("none.tif"), "{missing}");
}

/// Ground with cells that have no data: single ones, a corner, a strait that parts it, a pond in it, none in its southern half.
pub(crate) fn ground_with_holes(folder: &Path) -> std::path::PathBuf {
    let size = Size { columns: 230, rows: 400 };
    let height = |x: usize, y: usize| {
        let (east, south) = (x as f64, y as f64);
        let is_hole = (x * 7 + y * 3).is_multiple_of(97) || x + y < 60 || (100..104).contains(&x);
        let is_pond = (150..190).contains(&x) && (60..150).contains(&y);
        let hills = 300.0 + 60.0 * libm::sin(east / 23.0) * libm::cos(south / 31.0);
        if y < 210 && (is_hole || is_pond) {
            -1.0
        } else {
            (hills + (east * 7.0 + south * 13.0) % 11.0) as f32
        }
    };
    let path = folder.join("holes.tif");
    let raster = Raster { cell: Some(20.0), ..Raster::from(Field::from_function(size, height)) };
    write(&path, &raster).expect("written");
    path
}

/// Rain on the ground with holes, with files of all formats that are written some rows at a time.
pub(crate) fn with_holes(file: &Path, hydraulic: &str) -> Recipe {
    let output = |layer: &str, file: &str, more: &str| {
        format!("[[output]]\nlayer = \"{layer}\"\nfile = \"{file}\"\n{more}\n")
    };
    let text = format!(
        "[landscape]\nfrom = {:?}\nnodata = -1.0\nseed = 5\n\
         [[step]]\ndo = \"fbm\"\nrelief = 3\ninto = \"pond\"\n\
         [[step]]\ndo = \"hydraulic\"\niterations = 40\nrain_period = 15\ndry_period = 10\n{hydraulic}\n\
         [[step]]\ndo = \"flow\"\nmethod = \"mfd\"\nweight = \"pond\"\nfilled = \"filled\"\n{}",
        file.display().to_string(),
        [
            output("height", "height.tif", "preset = \"cog\""),
            output("water", "water.zarr", ""),
            output("flux_x", "flux.tif", ""),
            output("erosion", "erosion.zarr", "preset = \"sharded\""),
            output("flow_direction", "directions.tif", "preset = \"cog\""),
            output("flow_direction", "directions.zarr", ""),
            output("discharge", "discharge.tif", ""),
            output("filled", "filled.tif", ""),
        ]
        .concat()
    );
    Recipe::parse("land.toml", &text, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn cells_without_data_are_those_of_a_run_in_memory_to_the_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = ground_with_holes(folder.path());
    let kinds = [
        ("model = \"han\"\nboundary = \"open\"\nthermal = { talus = 0.6 }", [0, 1, 4]),
        ("model = \"han\"\ntransport = \"maccormack\"\ninitial_water = \"pond\"", [0, 2, 6]),
        ("model = \"mei\"\nboundary = \"open\"\ninitial_water = \"pond\"", [0, 3, 4]),
    ];
    for (hydraulic, counts) in kinds {
        let recipe = with_holes(&file, hydraulic);
        assert_same_by_rows(&recipe, &counts, hydraulic);
    }
}

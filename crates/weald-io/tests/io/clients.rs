//! Real clients open what Weald writes: GDAL the GeoTIFF, PNG and ASCII files, the OpenEXR tools the EXR files,
//! `NumPy` the arrays.
//!
//! The clients come from the Debian packages `gdal-bin`, `openexr` and `python3-numpy`. A test fails where one is
//! missing, because a skipped proof proves nothing.

use std::path::Path;
use std::process::Command;

use crate::rasters::{HILLS, hills, written};
use serde_json::Value;
use weald_core::domain::Georeference;
use weald_core::grid::Field;
use weald_io::Raster;

/// Standard output of a program that must be there and succeed.
fn output(program: &str, package: &str, arguments: &[&str]) -> Vec<u8> {
    let run = Command::new(program).args(arguments).env("GDAL_PAM_ENABLED", "NO").output();
    let output = run.unwrap_or_else(|cause| {
        panic!("{program} does not start ({cause}); install it: apt-get install {package}")
    });
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !message.contains("ERROR"), "{program} {arguments:?}: {message}");
    output.stdout
}

fn gdalinfo(path: &Path) -> Value {
    let text = output("gdalinfo", "gdal-bin", &["-json", shown(path)]);
    serde_json::from_slice(&text).expect("gdalinfo writes JSON")
}

/// All values as GDAL reads them, row-major.
fn gdal_values(path: &Path) -> Vec<f32> {
    let raw = path.with_extension("raw");
    output("gdal_translate", "gdal-bin", &["-q", "-of", "ENVI", "-ot", "Float32", shown(path), shown(&raw)]);
    let bytes = std::fs::read(raw).expect("gdal_translate wrote it");
    bytes.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]])).collect()
}

fn shown(path: &Path) -> &str {
    path.to_str().expect("a temporary folder has a plain name")
}

/// What a client must find: the value, or its number for no-data.
fn expected(raster: &Raster, no_data: f32) -> Vec<f32> {
    let land = raster.valid.as_ref();
    let values = raster.field.values().iter().enumerate();
    values
        .map(
            |(index, value)| if land.is_none_or(|valid| valid.is_valid_at(index)) { *value } else { no_data },
        )
        .collect()
}

#[test]
fn gdal_reads_every_cell_and_the_place_of_a_geotiff() {
    let raster = hills();
    let (_folder, path) = written(&raster, "height.tif");
    let info = gdalinfo(&path);
    assert_eq!(info["geoTransform"], serde_json::json!([730_900.75, 80.0, 0.0, 4_069_271.25, 0.0, -80.0]));
    assert_eq!(info["size"], serde_json::json!([300, 270]));
    let wkt = info["coordinateSystem"]["wkt"].as_str().expect("a CRS");
    assert!(wkt.contains("UTM zone 16N") && wkt.contains("ID[\"EPSG\",32616]]"), "{wkt}");
    let band = &info["bands"][0];
    assert_eq!(
        (&band["type"], &band["unit"], &band["description"]),
        (&"Float32".into(), &"m".into(), &"height".into())
    );
    assert_eq!((&band["noDataValue"], &band["block"]), (&(-9999.0).into(), &serde_json::json!([256, 256])));
    assert_eq!(info["metadata"][""]["WEALD_SEED"], "7");
    assert_eq!(info["metadata"][""]["TIFFTAG_SOFTWARE"], "Weald 0.1.0");
    assert!(gdal_values(&path) == expected(&raster, -9999.0), "GDAL reads other values");
}

#[test]
fn gdal_finds_the_cell_size_of_a_ground_without_a_place() {
    let raster = Raster { georeference: None, valid: None, cell: Some(20.0), ..hills() };
    let (_folder, path) = written(&raster, "height.tif");
    let info = gdalinfo(&path);
    assert_eq!(info["geoTransform"], serde_json::json!([0.0, 20.0, 0.0, 5400.0, 0.0, -20.0]));
    assert_eq!(info["coordinateSystem"], Value::Null);
    let again = weald_io::read(&path).expect("reads");
    assert_eq!(again.cell, Some(20.0));
}

#[test]
fn gdal_finds_the_crs_of_a_model_that_was_read_and_made_square() {
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/jacksboro_fault_srtm_wgs84.tif");
    let (raster, _) = weald_io::square(weald_io::read(&model).expect("reads")).expect("square");
    let (_folder, path) = written(&raster, "height.tif");
    let (was, is) = (gdalinfo(&model), gdalinfo(&path));
    assert_eq!(is["coordinateSystem"]["wkt"], was["coordinateSystem"]["wkt"]);
    for corner in ["upperLeft", "lowerRight"] {
        for axis in 0..2 {
            let difference = is["cornerCoordinates"][corner][axis].as_f64().expect("a number")
                - was["cornerCoordinates"][corner][axis].as_f64().expect("a number");
            assert!(difference.abs() < 1e-6, "{corner} is off by {difference}°");
        }
    }
    assert_eq!(is["size"], serde_json::json!([403, 427]));
}

#[test]
fn gdal_reads_a_png_as_greys_of_its_range() {
    let raster = hills();
    let (_folder, path) = written(&raster, "height.png");
    let info = gdalinfo(&path);
    assert_eq!(
        (&info["bands"][0]["type"], &info["bands"][0]["noDataValue"]),
        (&"UInt16".into(), &0.0.into())
    );
    let text =
        |key: &str| info["metadata"][""][key].as_str().expect("a text").parse::<f64>().expect("a number");
    let (low, high) = (text("WEALD_MINIMUM"), text("WEALD_MAXIMUM"));
    assert_eq!(text("WEALD_CELL_METRES"), 80.0);
    let step = (high - low) / 65534.0;
    for (grey, value) in gdal_values(&path).into_iter().zip(expected(&raster, f32::NAN)) {
        if value.is_nan() {
            assert_eq!(grey, 0.0);
        } else {
            let read = low + (f64::from(grey) - 1.0) * step;
            assert!((read - f64::from(value)).abs() <= 0.5001 * step, "{read} for {value}");
        }
    }
}

#[test]
fn gdal_reads_every_cell_and_the_place_of_an_ascii_grid() {
    let raster = hills();
    for (epsg, name) in [(32616, "UTM zone 16N"), (26916, "NAD83 / UTM zone 16N"), (32733, "UTM zone 33S")] {
        let mut raster = raster.clone();
        raster.georeference.as_mut().expect("placed").epsg = Some(epsg);
        let (_folder, path) = written(&raster, "height.asc");
        let info = gdalinfo(&path);
        assert_eq!(
            info["geoTransform"],
            serde_json::json!([730_900.75, 80.0, 0.0, 4_069_271.25, 0.0, -80.0])
        );
        assert_eq!(info["size"], serde_json::json!([300, 270]));
        let wkt = info["coordinateSystem"]["wkt"].as_str().expect("a CRS");
        assert!(wkt.contains(name) && wkt.ends_with(&format!("ID[\"EPSG\",{epsg}]]")), "{wkt}");
        let band = &info["bands"][0];
        assert_eq!((&band["type"], &band["noDataValue"]), (&"Float32".into(), &(-9999.0).into()));
        assert!(gdal_values(&path) == expected(&raster, -9999.0), "GDAL reads other values");
    }
    let place = Georeference { epsg: Some(4326), origin: [-84.5, 36.75], pixel: [0.001, 0.002], keys: None };
    let degrees = Raster { georeference: Some(place), cell: None, ..raster };
    let (_folder, path) = written(&degrees, "degrees.asc");
    let info = gdalinfo(&path);
    assert_eq!(info["geoTransform"], serde_json::json!([-84.5, 0.001, 0.0, 36.75, 0.0, -0.002]));
    let wkt = info["coordinateSystem"]["wkt"].as_str().expect("a CRS");
    assert!(wkt.contains("GEOGCRS[\"WGS 84\"") && wkt.ends_with("ID[\"EPSG\",4326]]"), "{wkt}");
}

#[test]
fn weald_reads_the_ascii_grids_that_gdal_writes() {
    let raster = hills();
    let (folder, path) = written(&raster, "height.tif");
    let grid = folder.path().join("gdal.asc");
    let digits = ["-co", "SIGNIFICANT_DIGITS=9"];
    let files = [shown(&path), shown(&grid)];
    let arguments = [["-q", "-of", "AAIGrid"].as_slice(), &digits, &files].concat();
    output("gdal_translate", "gdal-bin", &arguments);
    let again = weald_io::read(&grid).expect("reads");
    assert!(again.field == raster.field && again.valid == raster.valid, "other values");
    assert_eq!(again.cell, raster.cell);
    let place = |raster: &Raster| raster.georeference.as_ref().map(|it| (it.epsg, it.origin, it.pixel));
    assert_eq!(place(&again), place(&raster));
}

/// The library of the OpenEXR tools unpacks every sample and packs them again, in tiles.
#[test]
fn the_openexr_tools_read_every_cell_of_an_exr_and_weald_reads_theirs() {
    let raster = hills();
    let (folder, path) = written(&raster, "height.exr");
    let header = output("exrheader", "openexr", &[shown(&path)]);
    let header = String::from_utf8_lossy(&header);
    for line in [
        "    Y, 32-bit floating-point, sampling 1 1",
        "dataWindow (type box2i): (0 0) - (299 269)",
        "WEALD_CELL_METRES (type double): 80",
        "WEALD_EPSG (type int): 32616",
        "WEALD_UNIT (type string): \"m\"",
    ] {
        assert!(header.contains(line), "{line} is not in:\n{header}");
    }
    for compression in ["none", "rle", "zip", "piz"] {
        let tiled = folder.path().join(format!("{compression}.exr"));
        let arguments = ["-z", compression, "-t", "64", "48", shown(&path), shown(&tiled)];
        output("exrmaketiled", "openexr", &arguments);
        let again = weald_io::read(&tiled).expect("reads");
        assert!(again.field == raster.field && again.valid == raster.valid, "{compression}: other values");
        assert_eq!(again.provenance, raster.provenance, "{compression}");
    }
}

/// Blocks that would not shrink are stored as they are, so that small tiles of hills say nothing of wavelets.
#[test]
fn weald_reads_the_wavelets_of_the_openexr_tools_in_one_channel_and_in_three() {
    let hills = hills();
    // Few heights, whose numbers have less than 15 bits, and so many that they need all 16.
    let stepped = hills.field.values().iter().map(|height| (height / 16.0).round() * 16.0).collect();
    let stepped = Raster { field: Field::from_values(hills.field.size(), stepped), ..hills.clone() };
    let folder = tempfile::tempdir().expect("a folder");
    for (raster, preset) in
        [(&hills, None), (&stepped, None), (&hills, Some("blender")), (&stepped, Some("blender"))]
    {
        let [path, plain, packed] =
            ["height", "none", "piz"].map(|name| folder.path().join(format!("{name}.exr")));
        let (encode, _) = weald_io::format_of(&path).expect("known").writing(preset).expect("a preset");
        weald_io::write_parts(&path, &encode.parts(raster).expect("fits")).expect("written");
        for (compression, tiled) in [("none", &plain), ("piz", &packed)] {
            let arguments = ["-z", compression, "-t", "300", "270", shown(&path), shown(tiled)];
            output("exrmaketiled", "openexr", &arguments);
        }
        let bytes = |path: &Path| std::fs::metadata(path).expect("a file").len();
        assert!(bytes(&packed) < bytes(&plain) * 95 / 100, "{preset:?} has not shrunk");
        let again = weald_io::read(&packed).expect("reads");
        let expected = weald_io::read(&path).expect("reads");
        assert!(again.field == expected.field && again.valid == expected.valid, "{preset:?}: other values");
    }
}

#[test]
fn the_openexr_tools_find_the_channels_that_each_reader_wants() {
    let raster = hills();
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("height.exr");
    for (preset, expected) in [
        (
            "blender",
            ["B, 32-bit floating-point", "G, 32-bit floating-point", "R, 32-bit floating-point"].as_slice(),
        ),
        ("terrain3d", &["R, 32-bit floating-point"]),
        ("hterrain", &["R, 16-bit floating-point"]),
    ] {
        let (encode, _) = weald_io::format_of(&path).expect("known").writing(Some(preset)).expect("a preset");
        weald_io::write_parts(&path, &encode.parts(&raster).expect("fits")).expect("written");
        let header = output("exrheader", "openexr", &[shown(&path)]);
        let header = String::from_utf8_lossy(&header).into_owned();
        let channels: Vec<_> =
            header.lines().filter_map(|line| line.trim().strip_suffix(", sampling 1 1")).collect();
        assert_eq!(channels, expected, "{preset}");
        let tiled = folder.path().join("tiled.exr");
        output("exrmaketiled", "openexr", &["-z", "none", shown(&path), shown(&tiled)]);
        let (low, _) = raster.field.range(raster.valid.as_ref()).expect("land");
        let again = weald_io::read(&tiled).expect("reads");
        assert_eq!(again.valid, None, "{preset} has no NaN");
        for (value, wanted) in again.field.values().iter().zip(self::expected(&raster, low)) {
            let within = if preset == "hterrain" { wanted.abs() / 2048.0 } else { 0.0 };
            assert!((value - wanted).abs() <= within, "{preset}: {value} for {wanted}");
        }
    }
}

/// The interpreter that has `NumPy`: the system's own before another that comes first in the path.
fn python() -> &'static str {
    let has_numpy = |program: &&str| {
        Command::new(program).args(["-c", "import numpy"]).output().is_ok_and(|run| run.status.success())
    };
    let found = ["/usr/bin/python3", "python3"].into_iter().find(has_numpy);
    found.expect("no python3 has NumPy; install it: apt-get install python3-numpy")
}

#[test]
fn numpy_reads_every_cell_of_an_array() {
    let raster = hills();
    let (_folder, path) = written(&raster, "height.npy");
    let script = "import numpy, sys; a = numpy.load(sys.argv[1]); print(a.dtype.str, a.shape, a.flags.c_contiguous);\
                  a.tofile(sys.argv[1] + '.raw')";
    let printed = output(python(), "python3-numpy", &["-c", script, shown(&path)]);
    assert_eq!(String::from_utf8_lossy(&printed).trim(), "<f4 (270, 300) True");
    let raw = std::fs::read(path.with_extension("npy.raw")).expect("NumPy wrote it");
    let values = raw.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]));
    assert_eq!(values.len(), HILLS.cells());
    for (value, expected) in values.zip(expected(&raster, f32::NAN)) {
        assert!(value == expected || value.is_nan() && expected.is_nan(), "{value} for {expected}");
    }
}

#[test]
fn weald_reads_what_numpy_writes() {
    let folder = tempfile::tempdir().expect("a folder");
    for (kind, order) in [("<f8", "C"), (">i2", "C"), ("<u2", "F"), (">f4", "F"), ("|i1", "C")] {
        let path = folder.path().join("array.npy");
        let script = "import numpy, sys; a = numpy.arange(6).reshape(2, 3).astype(sys.argv[2], order=sys.argv[3]);\
                      numpy.save(sys.argv[1], a)";
        output(python(), "python3-numpy", &["-c", script, shown(&path), kind, order]);
        let raster = weald_io::read(&path).expect("reads");
        assert_eq!(raster.field.values(), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0], "{kind}, order {order}");
    }
}

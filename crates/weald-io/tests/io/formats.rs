//! Raster files are read as GDAL reads them.

use std::path::{Path, PathBuf};

use crate::rasters::fixture;
use tempfile::tempdir;
use weald_core::Error;
use weald_core::domain::{GeoKeys, Georeference};
use weald_core::grid::{Field, Size};
use weald_io::{Limits, Raster, geotiff, netcdf, npy, png16};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data").join(name)
}

/// A fixture as a file in a folder of its own.
fn read_fixture(name: &str) -> Result<Raster, Error> {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, fixture(name)).expect("written");
    weald_io::read(&path)
}

pub(super) fn read(name: &str) -> Raster {
    read_fixture(name).expect("a file that GDAL wrote")
}

/// What is wrong with a fixture, in the words for the user.
fn diagnostic(name: &str) -> String {
    read_fixture(name).expect_err("a file that is not read").to_string()
}

/// The values of a fixture as GDAL printed them.
fn printed(name: &str) -> Vec<f32> {
    let text = String::from_utf8(fixture(name)).expect("digits");
    text.split_whitespace().map(|number| number.parse().expect("a number")).collect()
}

fn is_valid(raster: &Raster, index: usize) -> bool {
    raster.valid.as_ref().is_none_or(|valid| valid.is_valid_at(index))
}

fn mean(raster: &Raster) -> f64 {
    let cells = raster.field.size().cells();
    let valid: Vec<usize> = (0..cells).filter(|&index| is_valid(raster, index)).collect();
    valid.iter().map(|&index| f64::from(raster.field.values()[index])).sum::<f64>() / valid.len() as f64
}

/// `gdalinfo -stats` and `gdallocationinfo -valonly data/jacksboro_fault_utm16_80m.tif X Y`, GDAL 3.6.2.
#[test]
fn the_projected_model_is_read_as_gdal_reads_it() {
    let raster = weald_io::read(&data("jacksboro_fault_utm16_80m.tif")).expect("a file that GDAL wrote");
    assert_eq!(raster.field.size(), Size { columns: 388, rows: 408 });
    assert_eq!(raster.cell, Some(80.0));
    let place = raster.georeference.as_ref().expect("georeferenced");
    assert_eq!(place.epsg, Some(32616));
    assert_eq!(place.origin, [730_900.757_145_892_6, 4_069_271.263_471_795]);
    assert_eq!(place.pixel, [80.0, 80.0]);
    let valid = raster.valid.as_ref().expect("corners without data");
    assert_eq!(valid.valid_cells(), 388 * 408 - 8809);
    assert_eq!(raster.field.range(Some(valid)), Some((237.067_14, 1_073.456_3)));
    assert!((mean(&raster) - 531.009_736_557_51).abs() < 1e-9, "mean {}", mean(&raster));
    for (x, y, height) in
        [(194, 204, 578.667_36), (37, 12, 521.479_9), (10, 10, 403.360_87), (5, 200, 601.385_86)]
    {
        assert_eq!(raster.field.at(x, y), height, "column {x}, row {y}");
        assert!(valid.is_valid(x, y));
    }
    for (x, y) in [(0, 0), (0, 407), (387, 0), (387, 407)] {
        assert!(!valid.is_valid(x, y), "column {x}, row {y} holds -9999 in the file");
    }
}

/// `gdalinfo -stats` and `gdallocationinfo -valonly data/jacksboro_fault_srtm_wgs84.tif X Y`, GDAL 3.6.2.
#[test]
fn the_geographic_model_is_read_as_gdal_reads_it() {
    let raster = weald_io::read(&data("jacksboro_fault_srtm_wgs84.tif")).expect("a file that GDAL wrote");
    assert_eq!(raster.field.size(), Size { columns: 403, rows: 344 });
    assert_eq!((raster.stored, raster.cell, &raster.valid), ("int16", None, &None));
    let place = raster.georeference.as_ref().expect("georeferenced");
    assert_eq!(place.epsg, Some(4326));
    assert!(place.is_geographic());
    assert!((place.origin[0] + 84.414_166_666_666_66).abs() < 1e-12, "{:?}", place.origin);
    assert!((place.origin[1] - 36.733_333_333_333_334).abs() < 1e-12, "{:?}", place.origin);
    assert_eq!(raster.field.range(None), Some((236.0, 1076.0)));
    assert!((mean(&raster) - 531.031_168_849_9).abs() < 1e-9, "mean {}", mean(&raster));
    for (x, y, height) in [(0, 0, 483.0), (402, 343, 272.0), (200, 100, 522.0), (402, 0, 444.0)] {
        assert_eq!(raster.field.at(x, y), height, "column {x}, row {y}");
    }
}

#[test]
fn every_way_to_store_floats_gives_the_same_raster() {
    let expected = printed("float.txt");
    for (name, stored) in [
        ("float32_tiles_deflate_predictor3.tif", "float32"),
        ("float32_strips_lzw_predictor2.tif", "float32"),
        ("float32_big_endian_lzw_predictor2.tif", "float32"),
        ("float64_big_endian_deflate.tif", "float64"),
        ("float64_tiles_predictor3.tif", "float64"),
        ("float64_strips_predictor2.tif", "float64"),
        ("bigtiff_strips.tif", "float32"),
        ("nan_undeclared.tif", "float32"),
        #[cfg(feature = "zstd")]
        ("zstd.tif", "float32"),
        ("bigtiff_big_endian_tiles.tif", "float32"),
        ("no_data_nan.tif", "float32"),
    ] {
        let raster = read(name);
        assert_eq!(raster.stored, stored, "{name}");
        for (index, &number) in expected.iter().enumerate() {
            assert_eq!(is_valid(&raster, index), number != -9999.0, "{name}, cell {index}");
            let value = if number == -9999.0 { 0.0 } else { number };
            assert_eq!(raster.field.values()[index], value, "{name}, cell {index}");
        }
        let place = raster.georeference.expect("georeferenced");
        assert_eq!(place.epsg, Some(32616), "{name}");
        // 351 cells of 80 m east of the whole model.
        assert_eq!(place.origin, [758_980.757_145_892_6, 4_069_271.263_471_795], "{name}");
    }
}

#[test]
fn every_way_to_store_integers_gives_the_same_raster() {
    let expected = printed("integer.txt");
    for (name, stored) in [
        ("int16_strips_deflate_predictor2.tif", "int16"),
        ("uint16_tiles_lzw_predictor2.tif", "uint16"),
        ("int32_big_endian_lzw_predictor2.tif", "int32"),
        ("uint32_tiles_deflate.tif", "uint32"),
        ("uint16.png", "uint16"),
    ] {
        let raster = read(name);
        assert_eq!((raster.field.values(), raster.stored), (expected.as_slice(), stored), "{name}");
        assert_eq!(raster.valid, None, "{name}");
    }
    for (name, stored, share) in
        [("uint8.tif", "uint8", 255.0 / 1020.0), ("int8.tif", "int8", 127.0 / 1020.0)]
    {
        let raster = read(name);
        assert_eq!(raster.stored, stored);
        for (value, whole) in raster.field.values().iter().zip(&expected) {
            assert!((value - whole * share).abs() <= 0.5001, "{name}: {value} for {whole}");
        }
    }
}

#[test]
fn a_tie_point_in_the_middle_of_its_cell_gives_the_same_corner() {
    let point = read("int16_pixel_is_point.tif").georeference.expect("georeferenced");
    let area = read("int16_strips_deflate_predictor2.tif").georeference.expect("georeferenced");
    for axis in 0..2 {
        assert!((point.origin[axis] - area.origin[axis]).abs() < 1e-12, "{point:?} and {area:?}");
        assert_eq!(point.pixel[axis], area.pixel[axis]);
    }
}

/// `convert` writes what it has read: heights in metres beside the keys and the code of a CRS with heights in feet.
#[test]
fn heights_in_feet_become_metres_once() {
    let size = Size::new(2, 2).expect("small");
    let keys = GeoKeys { directory: vec![1, 1, 0, 2, 1024, 0, 1, 1, 4099, 0, 1, 9003], ..GeoKeys::default() };
    let place = |epsg, keys| Some(Georeference { epsg, origin: [8.0, 48.0], pixel: [0.5; 2], keys });
    let raster = Raster { unit: Some("m".to_owned()), ..Raster::from(Field::filled(size, 100.0)) };
    let tif = Raster { georeference: place(None, Some(keys)), ..raster.clone() };
    let tif = geotiff::decode(&geotiff::encode(&tif).expect("written"), Limits::default()).expect("reads");
    assert_eq!(tif.field.values(), [100.0; 4]);
    let geographic = Raster { georeference: place(Some(8724), None), ..raster };
    let nc =
        netcdf::decode(&netcdf::encode(&geographic).expect("written"), Limits::default()).expect("reads");
    assert_eq!(nc.field.values(), [100.0; 4]);
}

#[test]
fn survey_feet_become_metres() {
    let raster = read("survey_feet.tif");
    let cell = raster.cell.expect("square cells");
    assert!((cell - 100.0 * 1200.0 / 3937.0).abs() < 1e-12, "{cell}");
    assert_eq!(raster.georeference.expect("georeferenced").pixel, [100.0, 100.0]);
}

#[test]
fn tiles_that_a_sparse_file_leaves_out_are_no_data() {
    let raster = read("sparse.tif");
    assert_eq!(raster.valid.map(|valid| valid.valid_cells()), Some(0));
}

#[test]
fn nan_is_no_data_whether_the_file_says_so_or_not() {
    let (declared, undeclared) = (read("no_data_nan.tif"), read("nan_undeclared.tif"));
    assert!(declared.valid.is_some() && declared.field == undeclared.field);
    assert_eq!(declared.valid, undeclared.valid);
}

#[test]
fn files_of_an_unread_kind_say_what_would_be_read() {
    assert!(diagnostic("two_bands.tif").contains("2 bands; choose one with `gdal_translate -b 1"));
    assert!(diagnostic("mask.tif").contains("mask of their own"));
    assert!(diagnostic("rotated.tif").contains("rotated or sheared"));
    assert!(diagnostic("float.txt").contains(".tif .tiff .png .exr"));
}

#[test]
fn a_size_over_the_limit_is_refused_before_anything_is_read() {
    let bytes = std::fs::read(data("jacksboro_fault_utm16_80m.tif")).expect("there");
    let fault = geotiff::decode(&bytes, Limits { cells: 388 * 408 - 1 }).expect_err("too large");
    assert!(matches!(fault, weald_io::Fault::Limit(_)), "{fault}");
    let folder = tempdir().expect("a folder");
    let path = folder.path().join("huge.npy");
    std::fs::write(&path, npy_header("<f4", "(16385, 16384)")).expect("written");
    assert_eq!(weald_io::read(&path).expect_err("too large").exit_code(), 5);
}

fn npy_header(kind: &str, shape: &str) -> Vec<u8> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n");
    [b"\x93NUMPY\x01\x00", (header.len() as u16).to_le_bytes().as_slice(), header.as_bytes()].concat()
}

#[test]
fn npy_arrays_of_other_types_and_orders_are_read() {
    let big = [npy_header(">i2", "(1, 2)"), vec![0xff, 0xfe, 0x01, 0x00]].concat();
    assert_eq!(npy::decode(&big, Limits::default()).expect("reads").field.values(), [-2.0, 256.0]);
    let columns_first = String::from_utf8_lossy(&npy_header("|u1", "(2, 3)")[10..]).replace("False", "True ");
    let mut bytes = [b"\x93NUMPY\x01\x00", (columns_first.len() as u16).to_le_bytes().as_slice()].concat();
    bytes.extend(columns_first.bytes().chain([1, 4, 2, 5, 3, 6]));
    let raster = npy::decode(&bytes, Limits::default()).expect("reads");
    assert_eq!(
        (raster.field.row(0), raster.field.row(1)),
        ([1.0, 2.0, 3.0].as_slice(), [4.0, 5.0, 6.0].as_slice())
    );
    let deep = npy::decode(&npy_header("<f4", "(1, 2, 3)"), Limits::default()).expect_err("three dimensions");
    assert!(deep.to_string().contains("two dimensions"), "{deep}");
}

#[test]
fn infinity_in_a_file_names_its_cell() {
    let bytes = [npy_header("<f4", "(1, 2)"), [1.0, f32::INFINITY].map(f32::to_le_bytes).concat()].concat();
    let fault = npy::decode(&bytes, Limits::default()).expect_err("infinite");
    assert!(fault.to_string().contains("column 1, row 0 holds inf"), "{fault}");
}

#[test]
fn eight_bit_png_is_read_with_a_warning_and_colour_is_refused() {
    let mut grey = Vec::new();
    let mut encoder = png::Encoder::new(&mut grey, 2, 1);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&[3, 200])).expect("encodes");
    let raster = png16::decode(&grey, Limits::default()).expect("reads");
    assert_eq!(raster.field.values(), [3.0, 200.0]);
    assert!(raster.notes[0].contains("terraces"));
    let mut colour = Vec::new();
    let mut encoder = png::Encoder::new(&mut colour, 1, 1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(&[1, 2, 3])).expect("encodes");
    let fault = png16::decode(&colour, Limits::default()).expect_err("coloured");
    assert!(fault.to_string().contains("Rgb with 8 bits"), "{fault}");
}

#[test]
fn a_description_asks_where_cells_without_a_crs_look_like_degrees() {
    let folder = tempdir().expect("a folder");
    let path = folder.path().join("land.tif");
    let place = |epsg| Georeference { epsg, origin: [8.0, 47.0], pixel: [0.001; 2], keys: None };
    let asks = |epsg| {
        let field = Field::filled(Size { columns: 2, rows: 2 }, 5.0);
        let raster = Raster { georeference: Some(place(epsg)), ..Raster::from(field) };
        weald_io::write(&path, &raster).expect("written");
        let notes = weald_io::describe(&path).expect("reads").notes;
        notes.iter().any(|note| note.contains("look like degrees; say `crs = \"EPSG:4326\"`"))
    };
    assert!(asks(None) && !asks(Some(4326)));
}

#[test]
fn a_description_holds_what_the_file_says() {
    let info = weald_io::describe(&data("jacksboro_fault_utm16_80m.tif")).expect("reads");
    let json = info.to_json();
    assert_eq!(json["epsg"], 32616);
    assert_eq!(json["type"], "float32");
    assert_eq!(json["cell_metres"], 80.0);
    assert!((info.no_data_share - 0.056).abs() < 5e-4, "{}", info.no_data_share);
    let text = info.to_string();
    for part in ["GeoTIFF", "388 × 408 cells of float32", "5.6 % of the cells", "80 m", "EPSG:32616"] {
        assert!(text.contains(part), "{part} is not in:\n{text}");
    }
}

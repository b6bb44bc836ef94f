//! OpenEXR, bare numbers and ASCII grids: what other programs wrote is read, what Weald writes comes back, and
//! what a format cannot hold is said.

use std::path::Path;

use crate::rasters::{any_raster, exr_file};
use proptest::prelude::*;
use weald_core::domain::{GeoKeys, Georeference};
use weald_core::grid::{Field, Size};
use weald_core::random::hash2;
use weald_io::{
    Capabilities, Decode, Encode, FORMATS, Fault, InMemory, Limits, Metadata, Part, Provenance, Raster,
    Values, asc, exr, raw,
};

const EXR_SIZE: Size = Size { columns: 21, rows: 37 };

/// The samples of a fixture as floats.
fn samples(name: &str) -> Vec<f32> {
    let bytes = exr_file(&format!("{name}.bin"));
    let fours = bytes.chunks_exact(4).map(|four| four.try_into().expect("four bytes"));
    match name {
        "uint" => fours.map(|four| u32::from_le_bytes(four) as f32).collect(),
        _ => fours.map(f32::from_le_bytes).collect(),
    }
}

fn ensure_holds(file: &str, raster: &Raster, expected: &[f32]) {
    assert_eq!(raster.field.size(), EXR_SIZE, "{file}");
    for (index, expected) in expected.iter().enumerate() {
        let is_valid = raster.valid.as_ref().is_none_or(|valid| valid.is_valid_at(index));
        assert_eq!(is_valid, !expected.is_nan(), "{file}, cell {index}");
        let expected = if is_valid { expected.to_bits() } else { 0 };
        assert_eq!(raster.field.values()[index].to_bits(), expected, "{file}, cell {index}");
    }
}

#[test]
fn every_compression_and_type_of_openexr_gives_its_samples() {
    for (kind, stored) in [("float", "float32"), ("half", "float16"), ("uint", "uint32")] {
        let expected = samples(kind);
        assert_eq!(expected.iter().any(|value| value.is_nan()), kind != "uint");
        for compression in ["none", "rle", "zips", "zip", "piz"] {
            let file = format!("{compression}_{kind}.exr");
            let raster = exr::decode(&exr_file(&file), Limits::default()).expect("reads");
            assert_eq!((raster.stored, &raster.notes), (stored, &Vec::new()), "{file}");
            ensure_holds(&file, &raster, &expected);
        }
    }
}

#[test]
fn tiles_and_heights_among_other_channels_are_read() {
    for (file, kind) in [
        ("piz_float_tiles.exr", "float"),
        ("zip_half_tiles.exr", "half"),
        ("piz_y_among_others.exr", "float"),
        ("zip_grey_rgb.exr", "float"),
    ] {
        let raster = exr::decode(&exr_file(file), Limits::default()).expect("reads");
        ensure_holds(file, &raster, &samples(kind));
        assert_eq!(raster.notes.is_empty(), file != "piz_y_among_others.exr", "{:?}", raster.notes);
    }
}

#[test]
fn openexr_files_of_an_unread_kind_say_what_would_be_read() {
    let diagnostic = |file: &str| {
        exr::decode(&exr_file(file), Limits::default()).expect_err("a file that is not read").to_string()
    };
    assert!(
        diagnostic("zip_colour.exr").contains("channels B, G, R; heights are read from a single channel")
    );
    assert!(diagnostic("zip_two.exr").contains("channels depth, normal;"));
    assert!(diagnostic("pxr24_float.exr").contains("PXR24, which rounds floats to 24 bits"));
    let mut deep = exr_file("zip_float.exr");
    deep[5] |= 0x10;
    let fault = exr::decode(&deep, Limits::default()).expect_err("several parts");
    assert!(fault.to_string().contains("exrmultipart -separate"), "{fault}");
}

/// The bytes of an attribute's value in a file.
fn patched(mut file: Vec<u8>, attribute: &str, at: usize, value: &[u8]) -> Vec<u8> {
    let name = [attribute.as_bytes(), &[0]].concat();
    let start = file.windows(name.len()).position(|window| window == name).expect("the attribute is there");
    let kind = start + name.len();
    let value_at = kind + file[kind..].iter().position(|&byte| byte == 0).expect("a type") + 5 + at;
    file[value_at..value_at + value.len()].copy_from_slice(value);
    file
}

#[test]
fn an_openexr_header_that_lies_is_refused_before_memory_is_taken() {
    let limits = Limits { cells: 1 << 16 };
    let right = |file: &str, edge: i32| patched(exr_file(file), "dataWindow", 8, &edge.to_le_bytes());
    let fault = exr::decode(&right("zip_float.exr", i32::MAX), limits).expect_err("too wide");
    assert!(matches!(fault, Fault::Limit(_)), "{fault}");
    let fault = exr::decode(&right("zip_float.exr", -1), limits).expect_err("no column");
    assert!(fault.to_string().contains("there is nothing in it"), "{fault}");
    // Within the limits, but not within what two kilobytes can hold.
    let fault = exr::decode(&right("zip_float.exr", 1_000_000), Limits::default()).expect_err("too wide");
    assert!(fault.to_string().contains("bytes cannot hold the"), "{fault}");
    let tile = patched(exr_file("zip_half_tiles.exr"), "tiles", 0, &[0; 4]);
    let fault = exr::decode(&tile, limits).expect_err("no tile");
    assert!(fault.to_string().contains("tiles have no cells"), "{fault}");
    let tile = patched(exr_file("zip_half_tiles.exr"), "tiles", 0, &[1, 0, 0, 0, 1, 0, 0, 0]);
    let fault = exr::decode(&tile, limits).expect_err("more tiles than bytes");
    assert!(fault.to_string().contains("6216 bytes are missing at the end"), "{fault}");
}

#[test]
fn half_floats_that_would_overflow_are_refused_with_their_cell() {
    let (encode, _) =
        weald_io::format_of(Path::new("a.exr")).expect("known").writing(Some("hterrain")).expect("known");
    let field = |greatest| Field::from_values(Size { columns: 2, rows: 1 }, vec![1.0, greatest]);
    let error = encode.parts(&Raster::from(field(65_520.0))).expect_err("beyond halves").to_string();
    assert!(error.contains("column 1, row 0 holds 65520, but half floats end at 65504"), "{error}");
    let parts = encode.parts(&Raster::from(field(1000.4))).expect("fits");
    let again = exr::decode(&parts[0].bytes, Limits::default()).expect("reads");
    assert_eq!((again.field.values(), again.stored), ([1.0, 1000.5].as_slice(), "float16"));
}

/// Heights, as a raster of a landscape has them.
fn heights(columns: usize, rows: usize, seed: u64) -> Raster {
    let mut raster = any_raster(columns, rows, seed);
    for (index, value) in raster.field.values_mut().iter_mut().enumerate() {
        let height = -200.0 + (hash2(seed, index as i64, 1) >> 40) as f32 * 1e-4;
        *value = if hash2(seed, index as i64, 0) >> 61 == 0 { 0.0 } else { height };
    }
    raster
}

fn known(raster: Raster) -> Raster {
    let range = raster.field.range(raster.valid.as_ref()).unwrap_or_default();
    let provenance = Provenance {
        version: "0.1.0".to_owned(),
        recipe_blake3: "af13".repeat(16),
        seed: u64::MAX,
        layer: "height".to_owned(),
        unit: "m".to_owned(),
        range: (f64::from(range.0), f64::from(range.1)),
        resampled: None,
    };
    let origin = [500_000.25, 4_234_567.875];
    let georeference = Georeference { epsg: Some(32633), origin, pixel: [12.5; 2], keys: None };
    Raster { cell: Some(12.5), georeference: Some(georeference), provenance: Some(provenance), ..raster }
}

fn through(encode: Encode, decode: Decode, file: &str, raster: &Raster) -> Raster {
    let parts = encode.parts(raster).expect("finite");
    let again = match decode {
        Decode::File(decode) | Decode::Rows { whole: decode, .. } => {
            decode(&parts[0].bytes, Limits::default())
        }
        Decode::Parts(decode) => decode(&InMemory::of(file, parts), Limits::default()),
    };
    again.expect("our own file")
}

fn bits(raster: &Raster) -> Vec<u32> {
    raster.field.values().iter().map(|value| value.to_bits()).collect()
}

/// Everything that `holds` does not give up is there again, and everything that it does is said.
fn ensure_kept(name: &str, raster: &Raster, again: &Raster, holds: Capabilities) {
    let losses = holds.losses(raster);
    let omitted = |knowledge: Metadata| holds.omits.contains(&knowledge);
    assert_eq!(again.cell.is_none(), omitted(Metadata::Cell), "{name}: cell");
    assert_eq!(again.georeference.is_none(), omitted(Metadata::Place), "{name}: place");
    assert_eq!(again.provenance.is_none(), omitted(Metadata::Provenance), "{name}: provenance");
    assert_eq!(again.valid.is_none(), omitted(Metadata::NoData), "{name}: no-data");
    let place = |raster: &Raster| raster.georeference.as_ref().map(|it| (it.epsg, it.origin, it.pixel));
    assert!(again.cell.is_none_or(|cell| Some(cell) == raster.cell), "{name}");
    assert!(again.georeference.is_none() || place(again) == place(raster), "{name}");
    assert!(again.provenance.is_none() || again.provenance == raster.provenance, "{name}");
    assert!(again.valid.is_none() || again.valid == raster.valid, "{name}");
    let said = [Metadata::Cell, Metadata::Place, Metadata::Provenance, Metadata::NoData];
    let omits = said.into_iter().filter(|&knowledge| omitted(knowledge)).count();
    let rounds = holds.values != Values::Float32;
    assert_eq!(losses.len(), omits + usize::from(rounds), "{name}: {losses:?}");
    if !rounds && !omitted(Metadata::NoData) {
        assert_eq!(bits(again), bits(raster), "{name}");
    }
}

#[test]
fn every_format_and_preset_gives_back_what_it_does_not_say_it_loses() {
    let raster = known(heights(33, 21, 5));
    let mut tried = 0;
    for format in FORMATS {
        let file = format!("land.{}", format.extensions[0]);
        let Some(decode) = format.decode else { continue };
        let plain = format.encode.map(|encode| ("", encode, format.holds));
        let presets = format.presets.iter().map(|preset| (preset.name, preset.encode, preset.holds));
        for (preset, encode, holds) in plain.into_iter().chain(presets) {
            let again = through(encode, decode, &file, &raster);
            ensure_kept(&format!("{} {preset}", format.name), &raster, &again, holds);
            tried += 1;
        }
    }
    assert!(tried >= 10, "{tried} ways to write");
}

#[test]
fn a_crs_that_a_prj_cannot_spell_is_said_to_be_lost() {
    let mut raster = known(heights(5, 4, 1));
    let format = weald_io::format_of(Path::new("land.asc")).expect("known");
    let place = raster.georeference.as_mut().expect("placed");
    place.epsg = Some(31_468);
    let losses = format.holds.losses(&raster);
    assert!(losses.iter().any(|loss| loss.contains("the CRS is left out")), "{losses:?}");
    let again = through(Encode::Parts(asc::encode), Decode::Parts(asc::decode), "land.asc", &raster);
    assert_eq!(
        again.georeference.map(|place| (place.epsg, place.origin)),
        Some((None, [500_000.25, 4_234_567.875]))
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn floats_of_any_bits_come_back(columns in 1_usize..90, rows in 1_usize..90, seed: u64) {
        let raster = known(any_raster(columns, rows, seed));
        for file in ["land.exr", "land.r32", "land.asc"] {
            let format = weald_io::format_of(Path::new(file)).expect("known");
            let (Some(encode), Some(decode)) = (format.encode, format.decode) else { unreachable!("both ways") };
            let again = through(encode, decode, file, &raster);
            prop_assert_eq!(bits(&again), bits(&raster), "{}", file);
            prop_assert_eq!(&again.valid, &raster.valid);
            prop_assert_eq!((again.cell, &again.georeference), (raster.cell, &raster.georeference));
        }
    }

    #[test]
    fn raw_numbers_come_back_within_half_a_step(columns in 1_usize..90, rows in 1_usize..90, seed: u64) {
        let raster = known(heights(columns, rows, seed));
        let again = through(Encode::Parts(raw::encode_16), Decode::Parts(raw::decode_16), "land.r16", &raster);
        prop_assert_eq!((&again.valid, again.cell), (&raster.valid, raster.cell));
        let (low, high) = raster.field.range(raster.valid.as_ref()).unwrap_or_default();
        let half_a_step = 0.5 * f64::from(high - low) / 65534.0;
        for (value, was) in again.field.values().iter().zip(raster.field.values()) {
            prop_assert!(f64::from((value - was).abs()) <= half_a_step + 1e-4, "{value} was {was}");
        }
    }

    #[test]
    fn corners_anywhere_come_back(x in -2e7..2e7_f64, y in 0.0..2e7_f64, pixel in 1e-6..1e4_f64, rows in 1_usize..40) {
        let georeference = Some(Georeference { epsg: Some(32733), origin: [x, y], pixel: [pixel, pixel], keys: None });
        let raster = Raster { georeference, cell: Some(pixel), ..any_raster(3, rows, 9) };
        for file in ["land.exr", "land.r32", "land.r16", "land.asc"] {
            let format = weald_io::format_of(Path::new(file)).expect("known");
            let (Some(encode), Some(decode)) = (format.encode, format.decode) else { unreachable!("both ways") };
            let again = through(encode, decode, file, &raster).georeference.expect("placed");
            let was = raster.georeference.as_ref().expect("placed");
            prop_assert_eq!((again.pixel, again.origin[0]), (was.pixel, was.origin[0]));
            let within = if file == "land.asc" { 4e-9 } else { 0.0 };
            prop_assert!((again.origin[1] - was.origin[1]).abs() <= within, "{}: {} was {}", file, again.origin[1], y);
        }
    }
}

#[test]
fn a_crs_of_keys_alone_survives_in_openexr_and_beside_raw_numbers() {
    let keys =
        GeoKeys { directory: vec![1, 1, 0, 1, 1024, 0, 1, 2], doubles: vec![0.1], ascii: "x|".to_owned() };
    let georeference = Georeference { epsg: None, origin: [1.0, 2.0], pixel: [0.5, 0.25], keys: Some(keys) };
    let raster = Raster { georeference: Some(georeference), ..heights(3, 2, 1) };
    for file in ["land.exr", "land.r32", "land.raw"] {
        let format = weald_io::format_of(Path::new(file)).expect("known");
        let again = through(format.encode.expect("written"), format.decode.expect("read"), file, &raster);
        assert_eq!(again.georeference, raster.georeference, "{file}");
    }
}

fn raw_file(bytes: &[u8], sidecar: Option<&str>) -> InMemory {
    let sidecar = sidecar.map(|json| Part::beside(".json", json.as_bytes().to_vec()));
    InMemory::of("land.r16", [Part::own(bytes.to_vec())].into_iter().chain(sidecar).collect())
}

#[test]
fn a_square_of_raw_numbers_is_read_without_a_description_and_says_so() {
    let numbers: Vec<u8> = [7_u16, 0, 65535, 256].iter().flat_map(|number| number.to_le_bytes()).collect();
    let raster = raw::decode_16(&raw_file(&numbers, None), Limits::default()).expect("a square");
    assert_eq!((raster.field.values(), raster.stored), ([7.0, 0.0, 65535.0, 256.0].as_slice(), "uint16"));
    assert!(raster.notes[0].contains("read as 2 × 2 little-endian uint16"), "{:?}", raster.notes);
    let fault = raw::decode_16(&raw_file(&numbers[..6], None), Limits::default()).expect_err("no square");
    assert!(fault.to_string().contains("6 bytes are no square of uint16"), "{fault}");
    assert!(fault.to_string().contains("\"type\": \"uint16\""), "{fault}");
    let one = raw::decode_32(&raw_file(&1.5_f32.to_le_bytes(), None), Limits::default()).expect("one cell");
    assert_eq!(one.field.values(), [1.5]);
}

#[test]
fn the_description_of_raw_numbers_is_followed_and_checked() {
    let read = |bytes: &[u8], json: &str| raw::decode_16(&raw_file(bytes, Some(json)), Limits::default());
    let json = r#"{"columns": 2, "rows": 1, "type": "uint16", "byte_order": "big", "value_of_0": -10, "value_of_65535": 55.535}"#;
    let raster = read(&[0, 10, 0xff, 0xff], json).expect("described");
    assert_eq!(raster.field.values(), [-9.99, 55.535]);
    let diagnostic = |bytes: &[u8], json: &str| read(bytes, json).expect_err("refused").to_string();
    let long = diagnostic(&[0; 6], r#"{"columns": 2, "rows": 1, "type": "uint16"}"#);
    assert!(long.contains("2 × 1 numbers of uint16 need 4 bytes, but the file has 6"), "{long}");
    let kind = diagnostic(&[0; 4], r#"{"columns": 2, "rows": 1, "type": "int8"}"#);
    assert!(kind.contains("unknown variant `int8`, expected `uint16` or `float32`"), "{kind}");
    let half = diagnostic(&[0; 4], r#"{"columns": 2, "rows": 1, "type": "uint16", "value_of_0": 1}"#);
    assert!(half.contains("stand together"), "{half}");
    let huge =
        read(&[0; 4], r#"{"columns": 1000000, "rows": 1000000, "type": "uint16"}"#).expect_err("too large");
    assert!(matches!(huge, Fault::Limit(_)), "{huge}");
}

#[test]
fn files_beside_are_found_in_capitals_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("DEM.ASC"), "ncols 2\nnrows 1\nxllcorner 5000\nyllcorner 7000\ncellsize 30\n1 2\n")
        .expect("written");
    assert_eq!(weald_io::read(&path("DEM.ASC")).expect("reads").cell, Some(30.0), "without");
    std::fs::write(path("DEM.PRJ"), "PROJCS[\"x\",UNIT[\"foot\",0.3048]]").expect("written");
    assert_eq!(weald_io::read(&path("DEM.ASC")).expect("reads").cell, Some(9.144));
    let plain = Raster::from(Field::filled(Size::new(2, 1).expect("small"), 7.0));
    weald_io::write(&path("LAND.PNG"), &plain).expect("written");
    std::fs::write(path("LAND.PGW"), "30\n0\n0\n-30\n500015\n3999985\n").expect("written");
    let place = weald_io::read(&path("LAND.PNG")).expect("reads").georeference.expect("placed");
    assert_eq!(place.origin, [5e5, 4e6]);
}

fn grid(text: &str, crs: Option<&str>) -> Result<Raster, Fault> {
    let crs = crs.map(|crs| Part::sibling(".prj", crs.as_bytes().to_vec()));
    let parts = [Part::own(text.as_bytes().to_vec())].into_iter().chain(crs).collect();
    asc::decode(&InMemory::of("land.asc", parts), Limits::default())
}

#[test]
fn ascii_grids_of_other_programs_are_read() {
    let raster = grid(
        "NCOLS 3\r\nNROWS 2\r\nXLLCENTER 100.5\r\nYLLCENTER 20\r\nCELLSIZE 1\r\nNODATA_VALUE -32768\r\n1 2 -32768\r\n4 5e-1 6\r\n",
        None,
    )
    .expect("reads");
    assert_eq!(raster.field.values(), [1.0, 2.0, 0.0, 4.0, 0.5, 6.0]);
    assert_eq!(raster.valid.as_ref().map(|valid| valid.is_valid(2, 0)), Some(false));
    assert_eq!(raster.cell, Some(1.0));
    let place = raster.georeference.expect("placed");
    assert_eq!((place.origin, place.epsg), ([100.0, 21.5], None));
    let oblong = grid("ncols 1 nrows 2 xllcorner 0 yllcorner 0 dx 2 dy 3 NODATA_value nan 1 nan", None)
        .expect("reads");
    assert_eq!((oblong.cell, oblong.georeference), (None, None), "oblong, and no place at 0, 0");
    assert_eq!(oblong.valid.map(|valid| valid.valid_cells()), Some(1));
    let wkt = "GEOGCS[\"GCS_Mine\",DATUM[\"D\",SPHEROID[\"S\",6378137.0,298.0]],UNIT[\"Degree\",0.0174532925199433]]";
    let degrees = grid("ncols 1 nrows 1 xllcorner 8 yllcorner 50 cellsize 0.1 7", Some(wkt)).expect("reads");
    assert!(degrees.georeference.is_some_and(|place| place.is_geographic()) && degrees.cell.is_none());
}

#[test]
fn a_height_that_usually_stands_for_no_data_comes_back_from_an_ascii_grid() {
    let text = "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 1\nNODATA_value -1\n-9999 5\n";
    let raster = grid(text, None).expect("read");
    assert_eq!((raster.field.values(), &raster.valid), (&[-9999.0, 5.0][..], &None));
    let again =
        asc::decode(&InMemory::of("a.asc", asc::encode(&raster).expect("written")), Limits::default());
    let again = again.expect("read again");
    assert_eq!((again.field, again.valid), (raster.field, None));
}

#[test]
fn faults_of_ascii_grids_say_where() {
    let header = "ncols 2\nnrows 2\nxllcorner 1\nyllcorner 1\ncellsize 1\n";
    let diagnostic = |rest: &str| grid(&format!("{header}{rest}"), None).expect_err("refused").to_string();
    assert!(diagnostic("1 2 3 x4").contains("column 1, row 1 holds \"x4\", no number"));
    assert!(diagnostic("1 2 3").contains("the file ends before column 1, row 1 of 2 × 2 cells"));
    assert!(diagnostic("1 2 3 4 5").contains("\"5\" follows the last of 2 × 2 numbers"));
    assert!(diagnostic("1 2 inf 4").contains("column 0, row 1 holds inf"));
    assert!(diagnostic("colour 7 1 2 3 4").contains("\"colour\" is no word of an ESRI ASCII grid"));
    let fault = grid("nrows 2 xllcorner 1 yllcorner 1 cellsize 1 1 2", None).expect_err("no columns");
    assert!(fault.to_string().contains("the header has no ncols"), "{fault}");
    let fault =
        grid("ncols 16000 nrows 16000 xllcorner 1 yllcorner 1 cellsize 1 1 2", None).expect_err("a lie");
    assert!(fault.to_string().contains("bytes cannot hold 16000 × 16000 numbers"), "{fault}");
    let fault = grid("ncols 1 nrows 1 xllcorner 1 yllcorner 1 cellsize -1 1", None).expect_err("no side");
    assert!(fault.to_string().contains("sides must be above 0"), "{fault}");
}

#[test]
fn a_description_of_each_format_names_format_type_and_note() {
    let folder = tempfile::tempdir().expect("a folder");
    let raster = known(heights(9, 9, 4));
    for (file, format, kind) in [
        ("a.exr", "OpenEXR", "float32"),
        ("a.r32", "32-bit raw", "float32"),
        ("a.r16", "16-bit raw", "uint16"),
        ("a.asc", "ESRI ASCII grid", "text"),
    ] {
        let path = folder.path().join(file);
        weald_io::write(&path, &raster).expect("written");
        let info = weald_io::describe(&path).expect("read");
        assert_eq!((info.format, info.value_type), (format, kind));
        assert_eq!(info.to_json()["epsg"], 32633, "{file}");
        assert_eq!(info.cell, Some(12.5), "{file}");
    }
    std::fs::remove_file(folder.path().join("a.r16.json")).expect("there");
    let text = weald_io::describe(&folder.path().join("a.r16")).expect("a square").to_string();
    assert!(text.contains("there is no .json beside it: read as 9 × 9"), "{text}");
}

//! Files of arrays: what Weald writes it reads back to the bit, and what is damaged or lies is refused.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::rasters::any_raster;
use proptest::prelude::*;
use serde_json::{Value, json};
use weald_core::domain::{GeoKeys, Georeference};
use weald_core::grid::{Field, Mask, Size};
use weald_core::random::hash2;
use weald_io::{
    Encode, Fault, Format, InMemory, Limits, Provenance, Raster, StripPlace, format_of, netcdf, zarr,
};

const LIMITS: Limits = Limits { cells: 1 << 16 };

/// What a raster can know of its place: none, a cell, metres, degrees with a cell, survey feet of no EPSG code.
fn placed(raster: Raster, kind: u8) -> Raster {
    let place = |epsg, origin, pixel, keys| Some(Georeference { epsg, origin, pixel, keys });
    let feet = GeoKeys {
        directory: vec![1, 1, 0, 4, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 32767, 3076, 0, 1, 9003],
        doubles: vec![0.1, -87.5],
        ascii: "our own|".to_owned(),
    };
    let (cell, georeference) = match kind % 5 {
        0 => (None, None),
        1 => (Some(0.1), None),
        2 => (Some(12.3), place(Some(32733), [500_000.1, -1_234_567.7], [12.3; 2], None)),
        3 => (Some(85.4), place(Some(4326), [-84.414_166_666_666_66, 36.7], [1.0 / 1200.0, 7e-4], None)),
        _ => (Some(1000.0 / 3937.0 * 1.2), place(None, [1e6, 7e5], [1.0; 2], Some(feet))),
    };
    Raster { cell, georeference, ..raster }
}

fn provenance() -> Provenance {
    Provenance {
        version: "0.1.0".to_owned(),
        recipe_blake3: "af13".repeat(16),
        seed: u64::MAX,
        layer: "water<\"&\">".to_owned(),
        unit: "m³/step".to_owned(),
        range: (-0.1, 1e-30),
        resampled: None,
    }
}

fn bits(raster: &Raster) -> Vec<u32> {
    raster.field.values().iter().map(|value| value.to_bits()).collect()
}

fn through_netcdf(raster: &Raster) -> Raster {
    netcdf::decode(&netcdf::encode(raster).expect("finite"), Limits::default()).expect("our own file")
}

fn folder(raster: &Raster) -> InMemory {
    InMemory::of("a.zarr", zarr::encode(raster).expect("finite"))
}

fn through_zarr(raster: &Raster) -> Raster {
    zarr::decode(&folder(raster), Limits::default()).expect("our own folder")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn all_that_a_raster_knows_comes_back_to_the_bit(
        columns in 1_usize..600, rows in 1_usize..300, seed: u64, kind: u8, knows_its_source: bool
    ) {
        let raster = placed(any_raster(columns, rows, seed), kind);
        let raster = Raster { provenance: knows_its_source.then(provenance), ..raster };
        for mut again in [through_netcdf(&raster), through_zarr(&raster)] {
            if kind % 5 == 0 {
                let note = again.notes.pop();
                prop_assert!(note.is_some_and(|note| note.contains("no coordinates")));
            }
            prop_assert_eq!(bits(&again), bits(&raster));
            prop_assert_eq!(&again, &raster);
        }
    }
}

fn format(name: &str) -> &'static Format {
    format_of(Path::new(name)).expect("there is such a format")
}

#[test]
fn what_is_lost_is_said() {
    for name in ["a.nc", "a.zarr"] {
        let losses = |kind| format(name).holds.losses(&placed(any_raster(4, 4, 1), kind));
        assert_eq!([0, 1, 2, 3].map(losses), [const { Vec::<String>::new() }; 4]);
        let feet = losses(4);
        assert!(feet.len() == 1 && feet[0].contains("no EPSG code"), "{feet:?}");
    }
}

#[test]
fn bytes_of_a_group_do_not_depend_on_threads() {
    let raster = any_raster(700, 530, 3);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| zarr::encode(&raster)).expect("finite")
    };
    let one = with(1);
    assert!(one.len() > 6 && one == with(2) && one == with(3));
}

#[test]
fn chunks_without_data_are_left_out_and_come_back_without_data() {
    let size = Size { columns: 600, rows: 300 };
    let valid = Mask::new(size, (0..size.cells()).map(|cell| cell % 600 < 256).collect());
    let field = Field::from_function(size, |x, y| if x < 256 { (x + y) as f32 } else { 0.0 });
    let raster = Raster { valid, cell: Some(2.0), ..Raster::from(field) };
    let folder = folder(&raster);
    let chunks: Vec<_> = folder.files.keys().filter(|path| path.starts_with("a.zarr/layer/c")).collect();
    assert_eq!(chunks, [Path::new("a.zarr/layer/c/0/0"), Path::new("a.zarr/layer/c/1/0")]);
    assert_eq!(zarr::decode(&folder, Limits::default()), Ok(raster));
}

/// A raster of a layer of that name, as landlab's preset writes it in both formats.
fn for_landlab(layer: &str) -> (Raster, Vec<u8>, InMemory) {
    let provenance = Provenance { layer: layer.to_owned(), ..provenance() };
    let raster = Raster { provenance: Some(provenance), ..placed(any_raster(7, 5, 2), 2) };
    let encode = |name: &str| {
        let (encode, _) = format(name).writing(Some("landlab")).expect("a preset");
        encode.parts(&raster).expect("finite")
    };
    let nc = encode("a.nc").remove(0).bytes;
    let zarr = InMemory::of("a.zarr", encode("a.zarr"));
    (raster, nc, zarr)
}

#[test]
fn layers_have_the_names_of_landlab_and_are_known_by_them() {
    for (layer, name) in
        [("height", "topographic__elevation"), ("bedrock", "bedrock__elevation"), ("soil", "soil__depth")]
    {
        let (raster, nc, zarr) = for_landlab(layer);
        assert!(nc.windows(name.len()).any(|bytes| bytes == name.as_bytes()), "{name}");
        assert!(zarr.files.contains_key(&Path::new("a.zarr").join(name).join("zarr.json")), "{name}");
        assert_eq!(netcdf::decode(&nc, LIMITS).as_ref(), Ok(&raster));
        assert_eq!(zarr::decode(&zarr, LIMITS), Ok(raster));
    }
}

/// landlab numbers its nodes from the south-western corner and takes rows as they come.
#[test]
fn rows_for_landlab_begin_in_the_south() {
    let (raster, nc, _) = for_landlab("height");
    let usual = netcdf::encode(&raster).expect("finite");
    let rows =
        |file: &[u8]| file[file.len() - 7 * 5 * 4..].chunks(28).map(<[u8]>::to_vec).collect::<Vec<_>>();
    let (mut south_up, north_up) = (rows(&nc), rows(&usual));
    assert_ne!(south_up, north_up);
    south_up.reverse();
    assert_eq!(south_up, north_up);
}

#[test]
fn a_folder_may_hold_a_single_array() {
    let raster = any_raster(7, 5, 2);
    let whole = folder(&raster);
    let inside = |(path, bytes): (&PathBuf, &Vec<u8>)| {
        let rest = path.strip_prefix("a.zarr/layer").ok()?;
        Some((Path::new("b.zarr").join(rest), bytes.clone()))
    };
    let files: BTreeMap<_, _> = whole.files.iter().filter_map(inside).collect();
    let alone = zarr::decode(&InMemory { file: "b.zarr".into(), files }, LIMITS).expect("reads");
    assert_eq!((alone.field, alone.valid), (raster.field, raster.valid));
}

/// The group with its description changed.
fn changed(folder: &InMemory, array: &str, change: impl Fn(&mut Value)) -> InMemory {
    let mut folder = folder.clone();
    let path = Path::new("a.zarr/zarr.json");
    let mut json: Value = serde_json::from_slice(&folder.files[path]).expect("JSON");
    change(&mut json["consolidated_metadata"]["metadata"][array]);
    folder.files.insert(path.to_owned(), json.to_string().into_bytes());
    folder
}

#[test]
fn a_group_whose_description_lists_no_arrays_is_read_folder_by_folder() {
    let raster = Raster { provenance: Some(provenance()), ..placed(any_raster(7, 5, 2), 2) };
    let mut folder = folder(&raster);
    let path = Path::new("a.zarr/zarr.json");
    let mut json: Value = serde_json::from_slice(&folder.files[path]).expect("JSON");
    assert!(json["consolidated_metadata"].is_object());
    json["consolidated_metadata"] = Value::Null;
    folder.files.insert(path.to_owned(), json.to_string().into_bytes());
    assert_eq!(zarr::decode(&folder, LIMITS), Ok(raster));
}

#[test]
fn descriptions_that_lie_are_refused_before_memory_is_taken() {
    let whole = folder(&any_raster(7, 5, 2));
    let fault = |change: &dyn Fn(&mut Value)| {
        zarr::decode(&changed(&whole, "layer", change), Limits::default()).expect_err("a lie")
    };
    let sides = json!([2_147_483_648_u64, 2_147_483_648_u64]);
    assert!(matches!(fault(&|array| array["shape"] = sides.clone()), Fault::Limit(_)));
    let chunk = json!([1_099_511_627_776_u64, 1]);
    let large = |array: &mut Value| array["chunk_grid"]["configuration"]["chunk_shape"] = chunk.clone();
    assert!(matches!(fault(&large), Fault::Limit(_)));
    let sides = json!([u64::MAX, u64::MAX]);
    let larger = |array: &mut Value| array["chunk_grid"]["configuration"]["chunk_shape"] = sides.clone();
    assert!(matches!(fault(&larger), Fault::Limit(_)));
    for (key, value) in [
        ("shape", json!([0, 5])),
        ("shape", json!([5])),
        ("shape", json!([-5, 7])),
        ("data_type", json!("complex64")),
        ("data_type", json!("float16")),
        ("chunk_grid", json!({ "name": "rectangular" })),
        ("fill_value", json!("nothing")),
        ("codecs", json!([{ "name": "bytes" }, { "name": "blosc" }])),
        ("chunk_key_encoding", json!({ "name": "own" })),
    ] {
        let fault = fault(&|array| array[key] = value.clone());
        assert!(matches!(fault, Fault::Damaged(_)), "{key} {value}: {fault}");
    }
}

#[test]
fn a_chunk_of_another_length_than_its_description_says_is_refused() {
    let whole = folder(&any_raster(7, 5, 2));
    for side in [6, 8] {
        let chunk = json!([5, side]);
        let lie = changed(&whole, "layer", |array| {
            array["chunk_grid"]["configuration"]["chunk_shape"] = chunk.clone();
        });
        let fault = zarr::decode(&lie, LIMITS).expect_err("140 bytes are in the chunk").to_string();
        assert!(fault.contains("layer/c/0/0") && fault.contains(&format!("{}", 20 * side)), "{fault}");
    }
}

#[test]
fn an_array_may_not_lie_outside_its_group() {
    let whole = folder(&any_raster(7, 5, 2));
    for name in ["..", "", "a:b", "a\\b"] {
        let lie = changed(&whole, name, |array| *array = json!({ "node_type": "array", "shape": [5, 7] }));
        let fault = zarr::decode(&lie, LIMITS).expect_err("outside").to_string();
        assert!(fault.contains(&format!("an array is called {name:?}")), "{fault}");
    }
}

#[test]
fn a_folder_without_a_description_or_without_arrays_is_told() {
    let of = |name: &str| {
        let files = BTreeMap::from([(Path::new("a.zarr").join(name), b"{}".to_vec())]);
        zarr::decode(&InMemory { file: "a.zarr".into(), files }, LIMITS).expect_err("unread").to_string()
    };
    assert!(of(".zgroup").contains("no variable has rows and columns"));
    assert!(of(".zarray").contains("`shape` is null"));
    assert!(of("README").contains("neither zarr.json nor .zgroup"));
}

/// A classic file with its first dimension's length changed; it stands behind the name `y`.
fn with_rows(rows: u32) -> Vec<u8> {
    let mut bytes = netcdf::encode(&any_raster(7, 5, 2)).expect("finite");
    let at = bytes.windows(8).position(|eight| eight == b"\0\0\0\x01y\0\0\0").expect("the name is there") + 8;
    assert_eq!(bytes[at..at + 4], 5_u32.to_be_bytes());
    bytes[at..at + 4].copy_from_slice(&rows.to_be_bytes());
    bytes
}

#[test]
fn headers_that_lie_are_refused_before_memory_is_taken() {
    assert!(netcdf::decode(&with_rows(5), LIMITS).is_ok());
    for rows in [6, 1 << 16, i32::MAX as u32] {
        let fault = netcdf::decode(&with_rows(rows), Limits::default()).expect_err("a lie").to_string();
        assert!(fault.contains("does not end within"), "{fault}");
    }
    let negative = netcdf::decode(&with_rows(1 << 31), LIMITS).expect_err("below 0").to_string();
    assert!(negative.contains("a count of -2147483648"), "{negative}");
    // A length of 0 is that of records, of which there are none.
    let none = netcdf::decode(&with_rows(0), LIMITS).expect_err("no rows").to_string();
    assert!(none.contains("7 × 0 cells"), "{none}");
    let many = netcdf::decode(&netcdf::encode(&any_raster(400, 300, 2)).expect("finite"), LIMITS);
    assert!(matches!(many, Err(Fault::Limit(_))));
}

#[test]
fn two_variables_of_one_name_are_refused() {
    // The coordinates of seven rows are called as those of five columns.
    let mut bytes = netcdf::encode(&placed(any_raster(5, 7, 2), 2)).expect("finite");
    let name = b"\0\0\0\x01y\0\0\0";
    let places: Vec<_> = (0..bytes.len()).filter(|at| bytes[*at..].starts_with(name)).collect();
    // The first is the dimension's.
    bytes[places[1] + 4] = b'x';
    let fault = netcdf::decode(&bytes, LIMITS).expect_err("which is meant?").to_string();
    assert!(fault.contains("two variables are called `x`"), "{fault}");
}

#[test]
fn other_kinds_of_files_are_named() {
    let of = |bytes: &[u8]| netcdf::decode(bytes, LIMITS).expect_err("unread").to_string();
    assert!(of(b"\x89HDF\r\n\x1a\n").contains("nccopy -k classic"));
    assert!(of(b"GIF89a").contains("does not begin with CDF"));
    assert!(of(b"CDF\x01\xff\xff\xff\xff").contains("number of records"));
}

#[test]
fn a_file_cut_off_anywhere_is_an_error() {
    let bytes = netcdf::encode(&placed(any_raster(19, 11, 4), 2)).expect("finite");
    assert!(netcdf::decode(&bytes, LIMITS).is_ok());
    for length in 0..bytes.len() {
        assert!(netcdf::decode(&bytes[..length], LIMITS).is_err(), "{length} of {} bytes", bytes.len());
    }
}

/// One to four bytes changed.
fn mutant(bytes: &[u8], seed: u64) -> Vec<u8> {
    let mut mutant = bytes.to_vec();
    for change in 0..=hash2(seed, 0, 0) % 4 {
        let random = hash2(seed, 1, change as i64);
        let at = (random >> 16) as usize % mutant.len();
        mutant[at] = if random & 1 == 0 { mutant[at] ^ 1 << (random >> 8 & 7) } else { (random >> 8) as u8 };
    }
    mutant
}

#[test]
fn mutated_files_never_panic_and_stay_within_limits() {
    let raster = placed(any_raster(19, 11, 4), 2);
    let (nc, whole) = (netcdf::encode(&raster).expect("finite"), folder(&raster));
    let mut refused = [0, 0];
    for seed in 0..3000 {
        let mut folder = whole.clone();
        let path = whole.files.keys().nth(seed as usize % whole.files.len()).expect("files");
        folder.files.insert(path.clone(), mutant(&whole.files[path], seed));
        let read = [netcdf::decode(&mutant(&nc, seed), LIMITS), zarr::decode(&folder, LIMITS)];
        for (refused, read) in refused.iter_mut().zip(read) {
            match read {
                Err(_) => *refused += 1,
                Ok(raster) => assert!(raster.field.size().cells() <= LIMITS.cells),
            }
        }
    }
    assert!(
        refused.iter().all(|refused| (300..3000).contains(refused)),
        "{refused:?} of 3000 mutants refused"
    );
}

#[test]
fn a_group_is_written_to_disk_and_read_from_there() {
    let place = tempfile::tempdir().expect("a folder");
    let path = place.path().join("land.zarr");
    let raster = placed(any_raster(300, 270, 5), 3);
    weald_io::write(&path, &raster).expect("written");
    assert!(path.join("zarr.json").is_file() && path.join("layer/c/1/1").is_file());
    assert_eq!(weald_io::read(&path).expect("reads"), raster);
    assert!(matches!(format("a.zarr").encode, Some(Encode::Strips { .. })));
}

/// Rows of a raster from one of them on.
fn rows_of(raster: &Raster, rows: std::ops::Range<usize>) -> Raster {
    let columns = raster.field.size().columns;
    let (cells, size) = (rows.start * columns..rows.end * columns, Size { columns, rows: rows.len() });
    let valid =
        raster.valid.as_ref().and_then(|valid| Mask::new(size, valid.flags()[cells.clone()].to_vec()));
    let field = Field::from_values(size, raster.field.values()[cells].to_vec());
    Raster { field, valid, ..raster.clone() }
}

#[test]
fn strips_and_descriptions_are_the_files_of_the_whole_each_once() {
    let wide = Size { columns: 17_000, rows: 3 };
    let wide = Raster { cell: Some(2.0), ..Raster::from(Field::from_function(wide, |x, y| (x ^ y) as f32)) };
    for raster in [any_raster(700, 530, 3), any_raster(300, 90, 4), any_raster(3, 1, 5), wide] {
        let raster = Raster { provenance: Some(provenance()), ..raster };
        for preset in [None, Some("sharded")] {
            let (encode, _) = format("a.zarr").writing(preset).expect("a preset");
            let Encode::Strips { by_strips, .. } = encode else { panic!("by strips") };
            let whole = raster.field.size();
            let head = Raster {
                field: Field::filled(Size { columns: 1, rows: 1 }, 0.0),
                valid: None,
                ..raster.clone()
            };
            let mut parts = (by_strips.descriptions)(&head, whole).expect("finite");
            for first in (0..whole.rows).step_by(by_strips.rows) {
                let strip = rows_of(&raster, first..(first + by_strips.rows).min(whole.rows));
                parts.extend((by_strips.strip)(&strip, StripPlace { whole, first }).expect("finite"));
            }
            let count = parts.len();
            let strips = InMemory::of("a.zarr", parts);
            assert_eq!(strips.files.len(), count, "no file is written twice");
            assert!(strips.files == InMemory::of("a.zarr", encode.parts(&raster).expect("finite")).files);
            let again = zarr::decode(&strips, Limits::default()).expect("our own folder");
            assert_eq!(bits(&again), bits(&raster), "{preset:?}");
            assert_eq!(again.valid, raster.valid);
        }
    }
}

#[test]
fn shards_make_few_files_of_many_chunks_and_leave_out_those_without_data() {
    let size = Size { columns: 1300, rows: 600 };
    let valid =
        Mask::new(size, (0..size.cells()).map(|cell| cell / 1300 < 256 && cell % 1300 > 256).collect());
    let raster = Raster { valid, ..Raster::from(Field::filled(size, 3.0)) };
    let (encode, _) = format("a.zarr").writing(Some("sharded")).expect("a preset");
    let parts = encode.parts(&Raster { valid: None, ..raster.clone() }).expect("finite");
    let shards = |parts: &[weald_io::Part]| {
        let paths = parts.iter().map(|part| part.name.path(Path::new("")));
        paths.filter(|path| path.starts_with("layer/c")).collect::<Vec<_>>()
    };
    assert_eq!(shards(&parts), ["layer/c/0/0", "layer/c/1/0", "layer/c/2/0"].map(PathBuf::from));
    let parts = encode.parts(&raster).expect("finite");
    assert_eq!(shards(&parts), [PathBuf::from("layer/c/0/0")]);
    let zeros = Raster {
        field: Field::from_function(size, |x, y| if y < 256 && x > 256 { 3.0 } else { 0.0 }),
        ..raster
    };
    let again = zarr::decode(&InMemory::of("a.zarr", parts), Limits::default()).expect("our own folder");
    assert_eq!((again.field, again.valid), (zeros.field, zeros.valid));
}

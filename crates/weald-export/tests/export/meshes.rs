//! Real programs open the meshes: the validator of the Khronos Group, and Blender; and Blender the images for it.
//!
//! `clients/install` installs them into `target/clients`. A test fails where one is missing, because a skipped proof
//! proves nothing.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::programs::{client, root, said, validated};
use serde_json::Value;
use weald_core::domain::Georeference;
use weald_core::grid::{Mask, Size};
use weald_core::material::Material;
use weald_core::{Domain, Field, Landscape};
use weald_export::{Colours, Export, Finished, Mesh};

const COLUMNS: usize = 90;
const ROWS: usize = 60;
const CELL: f64 = 25.0;

/// Mountains with a lake, a place and, where asked for, a hole.
fn mountains(hole: bool) -> Landscape {
    let size = Size::new(COLUMNS, ROWS).expect("small");
    let height = crate::common::rough(COLUMNS, ROWS, 400.0, 5);
    let is_valid =
        |cell: usize| (cell % COLUMNS).abs_diff(30).pow(2) + (cell / COLUMNS).abs_diff(20).pow(2) > 90;
    let land = if hole { Mask::new(size, (0..size.cells()).map(is_valid).collect()) } else { None };
    let place =
        Georeference { epsg: Some(32616), origin: [730_900.0, 4_069_271.25], pixel: [CELL; 2], keys: None };
    let mut landscape =
        Landscape::new(Domain { valid: land, georeference: Some(place), ..Domain::new(size, CELL) });
    landscape.materials = ["rock", "sand"].iter().filter_map(|name| Material::built_in(name)).collect();
    let water = Field::from_function(size, |x, y| (150.0 - height.at(x, y)).max(0.0));
    landscape.insert(
        "sand",
        "m",
        Field::from_function(size, |x, y| if height.at(x, y) < 180.0 { 2.0 } else { 0.0 }),
    );
    landscape.insert("water", "m", water);
    landscape.insert("height", "m", height);
    landscape
}

fn written(mesh: &Mesh, landscape: &Landscape) -> Vec<u8> {
    let finished = Finished { landscape, steps: &[], recipe: "mountains.toml", hash: "af13", seed: 7 };
    let parts = mesh.parts(&finished, Path::new("land.glb")).expect("a mesh");
    parts.into_iter().next().expect("one file").bytes
}

/// The JSON of a file and its bytes.
fn opened(glb: &[u8]) -> (Value, &[u8]) {
    let number = |at: usize| u32::from_le_bytes(glb[at..at + 4].try_into().expect("four bytes")) as usize;
    assert_eq!((&glb[..4], number(4), number(8)), (b"glTF".as_slice(), 2, glb.len()));
    let json = number(12);
    (serde_json::from_slice(&glb[20..20 + json]).expect("JSON"), &glb[28 + json..])
}

/// Vectors of an attribute of the first mesh.
fn attribute<const N: usize>(glb: &[u8], name: &str) -> Vec<[f32; N]> {
    let (json, bytes) = opened(glb);
    let index = |value: &Value| value.as_u64().expect("a number") as usize;
    let accessor = &json["accessors"][index(&json["meshes"][0]["primitives"][0]["attributes"][name])];
    let view = &json["bufferViews"][index(&accessor["bufferView"])];
    let bytes = &bytes[index(&view["byteOffset"])..][..index(&view["byteLength"])];
    let float = |four: &[u8]| f32::from_le_bytes(four.try_into().expect("four bytes"));
    let vector = |bytes: &[u8]| std::array::from_fn(|at| float(&bytes[4 * at..4 * at + 4]));
    bytes.chunks_exact(4 * N).map(vector).collect()
}

fn saved(glb: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("land.glb");
    std::fs::write(&path, glb).expect("written");
    (folder, path)
}

#[test]
fn the_khronos_validator_has_no_error_and_no_warning_for_any_kind_of_mesh() {
    let plain = Mesh { colours: Some(Colours::Plain), normal_map: false, water: false, ..Mesh::default() };
    let full = Mesh { colours: Some(Colours::Natural), skirt: 50.0, texture: Some(64), ..Mesh::default() };
    let tints = Mesh { colours: Some(Colours::Tints), texture: Some(300), error: 20.0, ..Mesh::default() };
    let mut fine = crate::common::landscape(crate::common::rough(300, 300, 300.0, 3));
    fine.domain.cell = 0.25;
    let every_cell = Mesh { error: 0.001, normal_map: false, texture: Some(16), ..Mesh::default() };
    for (mesh, landscape, meshes) in [
        (plain, mountains(false), 1),
        (full, mountains(true), 3),
        (tints, mountains(false), 2),
        (every_cell, fine, 1),
    ] {
        let glb = written(&mesh, &landscape);
        let (_folder, path) = saved(&glb);
        let report = validated(&path);
        let (issues, info) = (&report["issues"], &report["info"]);
        for kind in ["numErrors", "numWarnings"] {
            assert_eq!(issues[kind], 0, "{mesh:?}: {issues}");
        }
        assert_eq!((&info["version"], &info["drawCallCount"]), (&"2.0".into(), &meshes.into()));
        let triangles = info["totalTriangleCount"].as_u64().expect("a number");
        assert!(triangles > 100, "{triangles} triangles");
        assert_eq!(mesh.error < 0.01, triangles > 65_536, "one file has indices of 32 bits: {triangles}");
    }
}

#[test]
fn blender_finds_a_mesh_in_metres_with_north_at_y_and_with_the_same_normals_and_tangents() {
    let landscape = mountains(true);
    let glb = written(&Mesh { error: 3.0, ..Mesh::default() }, &landscape);
    let (_folder, path) = saved(&glb);
    let python = client("blender/bin/python");
    let found = said(Command::new(python).arg(root().join("clients/blender_mesh.py")).arg(&path));
    let (terrain, water) = (&found["terrain"], &found["water"]);
    let (low, high) =
        landscape.field("height").expect("there").range(landscape.domain.valid.as_ref()).expect("land");
    let half = [COLUMNS, ROWS].map(|count| 0.5 * (count as f64 - 1.0) * CELL);
    let number = |value: &Value| value.as_f64().expect("a number");
    for (bound, sign, height) in [("low", -1.0, low), ("high", 1.0, high)] {
        for axis in 0..2 {
            assert!((number(&terrain[bound][axis]) - sign * half[axis]).abs() < 1e-3, "{bound}: {terrain}");
        }
        assert!((number(&terrain[bound][2]) - f64::from(height)).abs() <= 3.0, "{bound}: {height} m");
    }
    assert!((number(&water["high"][2]) - 150.0).abs() < 0.01 && number(&water["low"][2]) > 140.0);
    assert_eq!((&terrain["material"], &water["material"]), (&"terrain".into(), &"water".into()));
    let images = serde_json::json!({ "colours": [1024, 683, "sRGB"], "normals": [90, 60, "Non-Color"] });
    assert_eq!(terrain["images"], images);
    check_vertices(&glb, terrain);
}

/// Blender's vertices are those of the file, with z up and y north.
fn check_vertices(glb: &[u8], terrain: &Value) {
    let (places, normals) = (attribute::<3>(glb, "POSITION"), attribute::<3>(glb, "NORMAL"));
    let tangents = attribute::<4>(glb, "TANGENT");
    assert_eq!(terrain["vertices"], places.len());
    let mut same_tangents = 0;
    for (index, [x, y, z]) in places.iter().copied().enumerate() {
        let of = |name: &str| -> Vec<f32> {
            let numbers = terrain[name][index].as_array().expect("a vector").iter();
            numbers.map(|number| number.as_f64().expect("a number") as f32).collect()
        };
        let apart = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(apart(&of("places"), &[x, -z, y]) < 1e-3, "{:?} for {x} {y} {z}", of("places"));
        let [x, y, z] = normals[index];
        assert!(apart(&of("normals"), &[x, -z, y]) < 2e-3, "{:?} for {x} {y} {z}", of("normals"));
        let [x, y, z, sign] = tangents[index];
        same_tangents += usize::from(apart(&of("tangents"), &[x, -z, y, sign]) < 5e-3);
    }
    assert!(places.len() > 500, "{} vertices", places.len());
    assert!(same_tangents * 100 >= places.len() * 99, "{same_tangents} tangents of {} agree", places.len());
}

#[test]
fn blender_reads_every_height_of_an_image_that_is_written_for_it() {
    let size = Size::new(37, 23).expect("small");
    let field = Field::from_function(size, |x, y| 1000.0 + 3.25 * x as f32 - 0.5 * y as f32);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("height.exr");
    let (encode, _) = weald_io::format_of(&path).expect("known").writing(Some("blender")).expect("a preset");
    weald_io::write_parts(&path, &encode.parts(&field.clone().into()).expect("fits")).expect("written");
    let python = client("blender/bin/python");
    let found = said(Command::new(python).arg(root().join("clients/blender_image.py")).arg(&path));
    assert_eq!(
        (&found["width"], &found["height"], &found["is_float"]),
        (&37.into(), &23.into(), &true.into())
    );
    let values = found["values"].as_array().expect("a list");
    assert_eq!(values.len(), size.cells());
    for (value, height) in values.iter().zip(field.values()) {
        assert_eq!(value.as_f64(), Some(f64::from(*height)));
    }
}

#[test]
fn a_file_says_how_true_it_is_and_where_it_lies() {
    let (glb, error) = (written(&Mesh { error: 3.0, ..Mesh::default() }, &mountains(false)), 3.0);
    let (json, _) = opened(&glb);
    let extras = &json["asset"]["extras"];
    assert_eq!(json["asset"]["generator"], concat!("Weald ", env!("CARGO_PKG_VERSION")));
    assert_eq!((&extras["recipe"], &extras["seed"]), (&"mountains.toml".into(), &7.into()));
    let deviation = extras["greatest_deviation"].as_f64().expect("a number");
    assert!(deviation > 0.5 * error && deviation <= error, "{deviation} m");
    let origin = &extras["origin"];
    assert_eq!((&origin["crs"], &origin["x"]), (&"EPSG:32616".into(), &(730_900.0 + 45.0 * CELL).into()));
    assert_eq!(origin["y"], 4_069_271.25 - 30.0 * CELL);
}

#[test]
fn ground_that_has_no_triangle_is_refused_with_a_reason() {
    let refused = |size: Size, land: Option<Mask>| {
        let mut landscape = Landscape::new(Domain { valid: land, ..Domain::new(size, CELL) });
        landscape.insert("height", "m", Field::filled(size, 1.0));
        let finished =
            Finished { landscape: &landscape, steps: &[], recipe: "r.toml", hash: "af13", seed: 7 };
        Mesh::default().parts(&finished, Path::new("land.glb")).expect_err("no ground").to_string()
    };
    let row = Size::new(9, 1).expect("small");
    assert!(refused(row, None).contains("2 × 2 cells or more; the landscape has 9 × 1"));
    let square = Size::square(6).expect("small");
    let stripes = Mask::new(square, (0..36).map(|cell| cell % 2 == 0).collect());
    assert!(refused(square, stripes).contains("no three cells with data are neighbours"));
}

#[test]
fn the_same_ground_makes_the_same_file() {
    let mesh = Mesh { skirt: 10.0, ..Mesh::default() };
    assert!(written(&mesh, &mountains(true)) == written(&mesh, &mountains(true)));
}

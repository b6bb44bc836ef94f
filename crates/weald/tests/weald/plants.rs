//! Plants as other programs get them: the validator of the Khronos Group, Blender, tables and clouds of points.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use crate::programs::{client, root, said, validated};
use serde_json::Value;
use weald::domain::Georeference;
use weald::engine::Job;
use weald::export::{Export, Finished, Mesh, PlantSet};
use weald::grow::scatter::Scatter;
use weald::io::{InMemory, write_parts};
use weald::plants::Plants;
use weald::recipe::parameter::Nested;
use weald::recipe::{Options, Overrides, Recipe, Run, Silent};
use weald::step::Step;
use weald::{Domain, Landscape, Size};

const COLUMNS: usize = 60;
const ROWS: usize = 40;
const CELL: f64 = 5.0;

/// Rough ground with 500 plants of a kind.
fn planted(kind: &str) -> (Landscape, Arc<Plants>) {
    let place =
        Georeference { epsg: Some(32616), origin: [730_900.0, 4_069_271.25], pixel: [CELL; 2], keys: None };
    let domain = Domain::new(Size::new(COLUMNS, ROWS).expect("small"), CELL);
    let mut landscape = Landscape::new(Domain { georeference: Some(place), ..domain });
    landscape.insert("height", "m", crate::common::rough(COLUMNS, ROWS, 80.0, 5));
    let scatter = Scatter {
        plant: kind.to_owned(),
        count: Some(500),
        spacing: 1.0,
        upright: 0.3,
        ..Scatter::default()
    };
    scatter.run(&mut landscape, &Job::unwatched(3)).expect("runs");
    let plants = landscape.plants("plants").expect("set").clone();
    assert_eq!(plants.plants.len(), 500);
    (landscape, plants)
}

/// The files of an export, on disk.
fn written(landscape: &Landscape, file: &str) -> (tempfile::TempDir, PathBuf) {
    let finished = Finished { landscape, steps: &[], recipe: "hills.toml", hash: "af13", seed: 7 };
    let parts =
        PlantSet { texture: 64, ..PlantSet::default() }.parts(&finished, Path::new(file)).expect("files");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(file);
    write_parts(&path, &parts).expect("written");
    (folder, path)
}

#[test]
fn the_khronos_validator_has_no_error_and_no_warning_for_plants_with_and_without_instancing() {
    for kind in ["fern", "fern-3d", "tree", "conifer"] {
        let (landscape, _) = planted(kind);
        let (folder, path) = written(&landscape, "plants.glb");
        for (path, required) in [
            (path, serde_json::json!(["EXT_mesh_gpu_instancing"])),
            (folder.path().join("plants.nodes.glb"), Value::Null),
        ] {
            let report = validated(&path);
            for severity in ["numErrors", "numWarnings"] {
                assert_eq!(report["issues"][severity], 0, "{kind}: {}", report["issues"]);
            }
            let info = &report["info"];
            assert!(info["totalVertexCount"].as_u64().is_some_and(|count| count > 100), "{kind}: {info}");
            assert_eq!(info["extensionsUsed"], required, "{kind}");
        }
    }
}

#[test]
fn blender_finds_every_plant_where_it_stands_leaning_as_it_leans() {
    let (landscape, plants) = planted("fern");
    let (folder, path) = written(&landscape, "plants.glb");
    for path in [path, folder.path().join("plants.nodes.glb")] {
        let script = root().join("clients/blender_plants.py");
        let found = said(Command::new(client("blender/bin/python")).arg(script).arg(&path));
        assert_eq!((&found["plants"], &found["meshes"]), (&500.into(), &1.into()), "{}", path.display());
        assert_eq!(found["textures"].as_array().map(Vec::len), Some(4), "four texture coordinates");
        check_plants(&found, &plants);
    }
}

/// Each plant is among those that Blender has, whatever their order.
fn check_plants(found: &Value, plants: &Plants) {
    let vector = |name: &str, at: usize| -> Vec<f64> {
        found[name][at]
            .as_array()
            .expect("a vector")
            .iter()
            .map(|number| number.as_f64().expect("a number"))
            .collect()
    };
    let all: Vec<_> = (0..plants.plants.len())
        .map(|at| (vector("places", at), vector("ups", at), found["sizes"][at].as_f64().expect("a size")))
        .collect();
    let middle = [0.5 * COLUMNS as f64 * CELL, 0.5 * ROWS as f64 * CELL];
    for plant in &plants.plants {
        let [x, y, z] = plant.place;
        let place = [x - middle[0], middle[1] - y, z];
        let apart = |other: &[f64]| place.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let (_, up, size) =
            all.iter().find(|(other, ..)| apart(other) < 1e-3).unwrap_or_else(|| panic!("none at {place:?}"));
        let [east, south, upward] = plant.up.map(f64::from);
        let off = [up[0] - east, up[1] + south, up[2] - upward].map(f64::abs);
        assert!(off.iter().all(|off| *off < 1e-3), "{up:?} for {:?}", plant.up);
        assert!((size - f64::from(plant.size)).abs() < 1e-3, "{size} m for {}", plant.size);
    }
}

#[test]
fn plants_can_stand_on_a_coarse_mesh_which_is_off_the_ground_by_no_more_than_its_error() {
    let (landscape, plants) = planted("fern");
    let finished =
        Finished { landscape: &landscape, steps: &[], recipe: "hills.toml", hash: "af13", seed: 7 };
    let heights = |error: Option<f64>| -> Vec<f64> {
        let on = error.map(|error| Nested(Mesh { error, water: false, ..Mesh::default() }));
        let parts = PlantSet { on, ..PlantSet::default() }
            .parts(&finished, Path::new("plants.csv"))
            .expect("a table");
        let text = String::from_utf8(parts[0].bytes.clone()).expect("text");
        text.lines().skip(1).map(|row| row.split(',').nth(3).expect("z").parse().expect("a number")).collect()
    };
    let off = |heights: &[f64]| -> f64 {
        let apart = heights.iter().zip(&plants.plants).map(|(height, plant)| (height - plant.place[2]).abs());
        apart.fold(0.0, f64::max)
    };
    assert!(off(&heights(None)) < 1e-3);
    let coarse = off(&heights(Some(4.0)));
    // Between centres the triangle and the bilinear ground may be a little further apart.
    assert!((2.0..6.0).contains(&coarse), "{coarse} m");
}

#[test]
fn a_table_has_a_row_for_each_plant_in_coordinates_of_the_crs() {
    let (landscape, plants) = planted("tree");
    let (_folder, path) = written(&landscape, "plants.csv");
    let text = std::fs::read_to_string(path).expect("written");
    let mut rows = text.lines();
    assert_eq!(rows.next(), Some("id,x,y,z,size,turn_deg,up_east,up_north,up,phase,suitability"));
    for (id, plant) in plants.plants.iter().enumerate() {
        let row = rows.next().expect("a row a plant");
        let numbers: Vec<f64> = row.split(',').map(|number| number.parse().expect("a number")).collect();
        let expected = [
            id as f64,
            730_900.0 + plant.place[0],
            4_069_271.25 - plant.place[1],
            plant.place[2],
            f64::from(plant.size),
            f64::from(plant.turn).to_degrees(),
            f64::from(plant.up[0]),
            -f64::from(plant.up[1]),
            f64::from(plant.up[2]),
            f64::from(plant.phase),
            1.0,
        ];
        assert_eq!(numbers.len(), expected.len());
        assert!(numbers.iter().zip(expected).all(|(number, wanted)| (number - wanted).abs() < 6e-3), "{row}");
    }
    assert_eq!(rows.next(), None);
}

#[test]
fn a_cloud_says_what_its_numbers_are_and_has_them_all() {
    let (landscape, plants) = planted("tree");
    let finished =
        Finished { landscape: &landscape, steps: &[], recipe: "hills.toml", hash: "af13", seed: 7 };
    let parts = PlantSet::default().parts(&finished, Path::new("plants.ply")).expect("files");
    let bytes = InMemory::of("plants.ply", parts).files.remove(Path::new("plants.ply")).expect("one file");
    let end = b"end_header\n";
    let at = bytes.windows(end.len()).position(|window| window == end).expect("a header") + end.len();
    let header = String::from_utf8_lossy(&bytes[..at]);
    assert!(header.starts_with("ply\nformat binary_little_endian 1.0\ncomment Weald"), "{header}");
    assert!(header.contains("\nelement vertex 500\n") && header.contains("EPSG:32616"), "{header}");
    let properties = header.lines().filter(|line| line.starts_with("property ")).count();
    assert_eq!(bytes.len() - at, 500 * 4 * properties);
    let number =
        |index: usize| f32::from_le_bytes(bytes[at + 4 * index..][..4].try_into().expect("four bytes"));
    let last = &plants.plants[499];
    let first_of_last = 499 * properties;
    assert!((f64::from(number(first_of_last)) - (last.place[0] - 150.0)).abs() < 1e-4);
    assert!((f64::from(number(first_of_last + 1)) - (100.0 - last.place[1])).abs() < 1e-4);
    assert!((number(first_of_last + 5) - last.up[2]).abs() < 1e-6);
}

#[test]
fn plants_that_no_step_sets_and_fractals_that_there_are_not_are_reported_before_anything_runs() {
    let refused = |plant: &str, of: &str| {
        let text = format!(
            "[landscape]\nsize = 16\n[[step]]\ndo = \"fbm\"\n[[step]]\ndo = \"scatter\"\nplant = \"{plant}\"\n\
             into = \"ferns\"\n[[output]]\nexport = \"plants\"\nof = \"{of}\"\nfile = \"a.csv\"\n"
        );
        Recipe::parse("r.toml", &text, &Overrides::default()).map(drop).map_err(|error| error.to_string())
    };
    assert_eq!(refused("fern", "ferns"), Ok(()));
    let message = refused("fern", "frens").expect_err("no such plants");
    assert!(
        message.contains(
            "r.toml:9: output: a.csv needs plants `frens`, which no step sets; did you mean `ferns`?"
        ),
        "{message}"
    );
    let message = refused("fernn", "ferns").expect_err("no such fractal");
    assert!(message.contains("there is no fractal \"fernn\"; did you mean `fern`?"), "{message}");
}

/// A recipe that plants a fractal of its own.
fn own_plant(keys: &str) -> String {
    format!(
        "[landscape]\nsize = 16\n[[fractal]]\nname = \"fork\"\nmaps = [\n[0.5, -0.3, 0.3, 0.5, 0.0, 0.4],\n\
         [0.5, 0.3, -0.3, 0.5, 0.0, 0.4],\n[0.02, 0.0, 0.0, 0.4, 0.0, 0.0],\n]\n{keys}[[step]]\ndo = \"fbm\"\n\
         [[step]]\ndo = \"scatter\"\nplant = \"fork\"\ncount = 9\n[[output]]\nexport = \"plants\"\n\
         of = \"plants\"\nfile = \"forks.glb\"\n"
    )
}

#[test]
fn a_fractal_of_the_recipe_is_planted_but_not_a_bent_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let recipe = Recipe::parse("r.toml", &own_plant(""), &Overrides::default()).expect("good");
    let run = Run { recipe: &recipe, options: Options::into_folder(folder.path()) };
    run.execute(&Silent).expect("runs");
    let report = validated(&folder.path().join("forks.nodes.glb"));
    assert_eq!(report["issues"]["numErrors"], 0, "{report}");
    assert_eq!(report["info"]["drawCallCount"], 1, "{report}");
    let bytes = std::fs::read(folder.path().join("forks.nodes.glb")).expect("written");
    let text = String::from_utf8_lossy(&bytes);
    assert_eq!(text.matches("\"rotation\"").count(), 9, "a node for each plant");
    let bent = own_plant("deform = [{ by = \"swap\", from = 1, to = 2 }]\n");
    let error = Recipe::parse("r.toml", &bent, &Overrides::default()).expect_err("bent");
    assert!(error.to_string().contains("r.toml:13: scatter: the fractal \"fork\" has `deform`"), "{error}");
}

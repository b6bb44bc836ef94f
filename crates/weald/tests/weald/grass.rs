//! Grass as other programs get it: the validator of the Khronos Group, and Blender.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::programs::{client, root, said, validated};
use serde_json::Value;
use weald::condition::Condition;
use weald::engine::Job;
use weald::error::{Limit, Quantity};
use weald::export::{Export, Finished, GrassSets};
use weald::grow::Vegetation;
use weald::grow::grass::{Instance, Meadow};
use weald::grow::grass_step::{Grass, Kind};
use weald::io::write_parts;
use weald::recipe::parameter::{LayerName, Nested};
use weald::recipe::{Overrides, Recipe};
use weald::step::Step;
use weald::{Domain, Error, Field, Landscape, Size};

const SIDE: usize = 24;
const CELL: f64 = 1.5;

/// Rough ground with fescue, and reeds in its wet south.
fn grown() -> Landscape {
    let size = Size::square(SIDE).expect("small");
    let mut landscape = Landscape::new(Domain::new(size, CELL));
    landscape.insert("height", "m", crate::common::rough(SIDE, SIDE, 6.0, 5));
    landscape.insert("fertility", "1", Field::from_function(size, |x, _| x as f32 / 23.0));
    landscape.insert("light", "1", Field::filled(size, 0.7));
    landscape.insert("moisture", "1", Field::from_function(size, |_, y| y as f32 / 23.0));
    let wet = Condition { layer: LayerName::of("moisture"), above: Some(0.8), ..Condition::default() };
    let reed = Kind { name: "reed".to_owned(), share: 5.0, r#where: vec![Nested(wet)], ..Kind::default() };
    let fescue = Kind { name: "fescue".to_owned(), ..Kind::default() };
    let grass = Grass { sets: 0.8, species: vec![Nested(fescue), Nested(reed)], ..Grass::default() };
    grass.run(&mut landscape, &Job::unwatched(3)).expect("runs");
    landscape
}

fn finished(landscape: &Landscape) -> Finished<'_> {
    Finished { landscape, steps: &[], recipe: "meadow.toml", hash: "af13", seed: 7 }
}

/// The files of the export, on disk.
fn written(landscape: &Landscape) -> (tempfile::TempDir, [PathBuf; 2]) {
    let parts = GrassSets::default().parts(&finished(landscape), Path::new("grass.glb")).expect("files");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("grass.glb");
    write_parts(&path, &parts).expect("written");
    let nodes = folder.path().join("grass.nodes.glb");
    (folder, [path, nodes])
}

#[test]
fn the_khronos_validator_has_no_error_and_no_warning_for_grass_with_and_without_instancing() {
    let (_folder, [instances, nodes]) = written(&grown());
    for (path, required) in
        [(instances, serde_json::json!(["EXT_mesh_gpu_instancing"])), (nodes, Value::Null)]
    {
        let report = validated(&path);
        for severity in ["numErrors", "numWarnings"] {
            assert_eq!(report["issues"][severity], 0, "{}", report["issues"]);
        }
        let info = &report["info"];
        assert!(info["totalVertexCount"].as_u64().is_some_and(|count| count >= 480), "{info}");
        assert_eq!(info["extensionsUsed"], required);
    }
}

#[test]
fn blender_finds_every_set_on_the_ground() {
    let landscape = grown();
    let meadow = landscape.meadow("grass").expect("grown");
    let sets: Vec<_> = meadow.sets(&meadow.area()).into_iter().map(Instance::unpack).collect();
    assert!(sets.len() > 200 && sets.iter().any(|set| set.species == 1), "{} sets", sets.len());
    let (_folder, paths) = written(&landscape);
    for path in paths {
        let script = root().join("clients/blender_plants.py");
        let found = said(Command::new(client("blender/bin/python")).arg(script).arg(&path));
        assert_eq!(
            (&found["plants"], &found["meshes"]),
            (&sets.len().into(), &2.into()),
            "{}",
            path.display()
        );
        assert_eq!(found["textures"].as_array().map(Vec::len), Some(2), "two texture coordinates");
        let places: Vec<Vec<f64>> = serde_json::from_value(found["places"].clone()).expect("places");
        let sizes: Vec<f64> = serde_json::from_value(found["sizes"].clone()).expect("sizes");
        assert!(sizes.iter().all(|size| (1e-3..5.0).contains(size)));
        let middle = 0.5 * SIDE as f64 * CELL;
        let ground = landscape.field("height").expect("there is one");
        for set in &sets {
            let [x, y] = set.place.map(f64::from);
            let height = Meadow::height(ground, CELL, set.place).expect("on the ground");
            let place = [x - middle, middle - y, f64::from(height)];
            let apart = |other: &Vec<f64>| (0..3).map(|i| (place[i] - other[i]).abs()).fold(0.0, f64::max);
            assert!(places.iter().any(|other| apart(other) < 1e-3), "none at {place:?}");
        }
    }
}

#[test]
fn a_rectangle_holds_its_sets_alone_and_too_many_are_over_a_stated_limit() {
    let landscape = grown();
    let count = |export: GrassSets| -> Result<u64, Error> {
        let parts = export.parts(&finished(&landscape), Path::new("grass.glb"))?;
        let json = &parts[0].bytes[20..];
        let end = u32::from_le_bytes(parts[0].bytes[12..16].try_into().expect("four bytes")) as usize;
        let document: Value = serde_json::from_slice(&json[..end]).expect("JSON");
        Ok(document["asset"]["extras"]["sets"].as_u64().expect("a number"))
    };
    let whole = count(GrassSets::default()).expect("few");
    let part = count(GrassSets { area: vec![0.0, 18.0, 18.0, 36.0], ..GrassSets::default() }).expect("few");
    assert!(part > 50 && part < whole / 2, "{part} of {whole}");
    let error = count(GrassSets { max_sets: 100, ..GrassSets::default() }).expect_err("too many");
    assert!(
        error.to_string().contains("at most 100 are allowed") && error.to_string().contains("`max_sets`")
    );
    let Error::Limit(Limit { what: Quantity::GrassSets, asked: Some(101..), allowed, .. }) = error else {
        panic!("{error:?}")
    };
    assert_eq!(allowed, 0..=100);
}

#[test]
fn grass_that_no_step_grows_and_areas_that_are_none_are_reported_before_anything_runs() {
    let refused = |of: &str, area: &str| {
        let text = format!(
            "[landscape]\nsize = 16\n[[step]]\ndo = \"fbm\"\n[[step]]\ndo = \"constant\"\ninto = \"even\"\n[[step]]\n\
             do = \"grass\"\ninto = \"lawn\"\nsoil = \"even\"\nlight = \"even\"\ndensity = \"even\"\n[[output]]\n\
             export = \"grass\"\nof = \"{of}\"\narea = {area}\nfile = \"a.glb\"\n"
        );
        Recipe::parse("r.toml", &text, &Overrides::default()).map(drop).map_err(|error| error.to_string())
    };
    assert_eq!(refused("lawn", "[0, 0, 8, 8]"), Ok(()));
    let message = refused("lwan", "[0, 0, 8, 8]").expect_err("no such grass");
    assert!(
        message.contains("a.glb needs grass `lwan`, which no step grows; did you mean `lawn`?"),
        "{message}"
    );
    let message = refused("lawn", "[8, 0, 0, 8]").expect_err("no area");
    assert!(message.contains("east must be beyond west"), "{message}");
}

//! Sets for game engines, decoded as the engines' documentation says: heights in metres within half a step of those
//! at the vertices, sizes that an engine takes, tiles that meet to the bit.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde_json::Value;
use weald::domain::Georeference;
use weald::export::{EXPORTS, Export, Finished, Terrain3d, Unity, Unreal, Weight};
use weald::grid::{Field, Mask, Size};
use weald::io::{Limits, exr};
use weald::recipe::parameter::{LayerName, Nested};
use weald::{Domain, Landscape};

const SIZE: Size = Size { columns: 90, rows: 70 };
const CELL: f64 = 20.0;

/// Hills, between -120 and 900 m.
fn hill(x: f64, y: f64) -> f64 {
    390.0 + 310.0 * (x / 370.0).sin() + 200.0 * (y / 290.0 + x / 900.0).cos()
}

fn landscape(size: Size, land: Option<Mask>) -> Landscape {
    let georeference = Some(Georeference {
        epsg: Some(32633),
        origin: [500_000.0, 5_000_000.0],
        pixel: [CELL; 2],
        keys: None,
    });
    let mut landscape = Landscape::new(Domain { georeference, valid: land, ..Domain::new(size, CELL) });
    let height = |x: usize, y: usize| hill(x as f64 * CELL, y as f64 * CELL) as f32;
    landscape.insert("height", "m", Field::from_function(size, height));
    let east = (size.columns - 1) as f32;
    landscape.insert("soil", "m", Field::from_function(size, |x, _| 2.0 * x as f32 / east));
    landscape
}

/// Files of a set by their names.
fn files(export: &dyn Export, landscape: &Landscape, file: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let finished = Finished { landscape, steps: &[], recipe: "land.toml", hash: "af13", seed: 7 };
    assert_eq!(export.faults(), []);
    let parts = export.parts(&finished, Path::new(file)).expect("makes files");
    parts.into_iter().map(|part| (part.name.path(Path::new(file)), part.bytes)).collect()
}

fn json(files: &BTreeMap<PathBuf, Vec<u8>>, name: &str) -> Value {
    serde_json::from_slice(&files[Path::new(name)]).expect("JSON")
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn words(bytes: &[u8]) -> Vec<f64> {
    bytes.chunks_exact(2).map(|two| f64::from(u16::from_le_bytes([two[0], two[1]]))).collect()
}

/// Numbers of a grey PNG and its side.
fn png(bytes: &[u8], depth: png::BitDepth) -> (usize, Vec<f64>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
    let info = reader.info();
    assert_eq!(
        (info.color_type, info.bit_depth, info.width),
        (png::ColorType::Grayscale, depth, info.height)
    );
    let side = info.width as usize;
    let mut pixels = vec![0; side * side * if depth == png::BitDepth::Sixteen { 2 } else { 1 }];
    reader.next_frame(&mut pixels).expect("pixels");
    let numbers = match depth {
        png::BitDepth::Sixteen => {
            pixels.chunks_exact(2).map(|two| f64::from(u16::from_be_bytes([two[0], two[1]]))).collect()
        }
        _ => pixels.into_iter().map(f64::from).collect(),
    };
    (side, numbers)
}

/// Decoded heights against those at the vertices; `place` gives the column and row of a vertex.
fn ensure_within_half_a_step(
    heights: &[f64],
    field: &Field,
    step: f64,
    place: impl Fn(usize) -> (usize, usize),
) {
    for (index, height) in heights.iter().enumerate() {
        let (x, y) = place(index);
        let expected = f64::from(field.at(x, y));
        let half_a_step = 0.5 * step * (1.0 + 1e-9);
        assert!(
            (height - expected).abs() <= half_a_step,
            "{height} for {expected} m at {x}, {y}: {half_a_step}"
        );
    }
}

/// A square landscape with as many cells as a set has vertices, so that its heights are those at the vertices.
fn square(side: usize) -> (Landscape, Field) {
    let landscape = landscape(Size::square(side).expect("small"), None);
    let field = landscape.field("height").expect("there").clone();
    (landscape, field)
}

#[test]
fn unreal_heights_decode_by_the_guide_within_half_a_step() {
    let (landscape, field) = square(127);
    for file in ["land.r16", "land.png"] {
        let files = files(&Unreal::default(), &landscape, file);
        let info = json(&files, &format!("{file}.json"));
        let bytes = &files[Path::new(file)];
        let numbers = if file == "land.r16" { words(bytes) } else { png(bytes, png::BitDepth::Sixteen).1 };
        let z_scale = number(&info["Scale"]["z"]);
        // Landscape Technical Guide: (number - 32768) / 128 * Z scale, in centimetres.
        let heights: Vec<f64> =
            numbers.iter().map(|number| (number - 32768.0) / 128.0 * z_scale / 100.0).collect();
        assert_eq!(heights.len(), 127 * 127);
        ensure_within_half_a_step(&heights, &field, z_scale / 12800.0, |index| (index % 127, index / 127));
        let most = numbers.iter().copied().fold(0.0, f64::max);
        assert_eq!(most, 65535.0, "the whole range is used");
        assert_eq!(number(&info["Scale"]["x"]), 100.0 * CELL);
    }
}

/// What interpolation between cells of 20 m may differ from the hills themselves, in metres: it stays within the
/// range of the cells, and of a summit between two of them 20² / 8 · 0.0047 m are above both.
const INTERPOLATION: f64 = 0.24;

#[test]
fn unreal_landscapes_of_another_size_cover_the_same_ground() {
    let landscape = landscape(SIZE, None);
    let files = files(&Unreal::default(), &landscape, "land.png");
    let info = json(&files, "land.png.json");
    let (side, numbers) = png(&files[Path::new("land.png")], png::BitDepth::Sixteen);
    assert_eq!((side, &info["Overall Resolution"]), (127, &serde_json::json!([127, 127])));
    let [x, y, z] = ["x", "y", "z"].map(|axis| number(&info["Scale"][axis]));
    // 126 quads of the X scale in centimetres are the 89 cells from first to last.
    assert!((126.0 * x / 100.0 - 89.0 * CELL).abs() < 1e-9 && (126.0 * y / 100.0 - 69.0 * CELL).abs() < 1e-9);
    for (index, number) in numbers.iter().enumerate() {
        let height = (number - 32768.0) / 128.0 * z / 100.0;
        let expected = hill((index % side) as f64 * x / 100.0, (index / side) as f64 * y / 100.0);
        assert!(
            (height - expected).abs() <= z / 25600.0 + INTERPOLATION,
            "{height} for {expected}: vertex {index}"
        );
    }
    assert_eq!((&info["height_m"]["of_32768"], &info["source"]["epsg"]), (&0.0.into(), &32633.into()));
    assert_eq!(info["source"]["north_western_vertex"], serde_json::json!([500_010.0, 4_999_990.0]));
}

#[test]
fn unreal_scales_hold_depths_and_a_scale_that_is_too_small_is_refused() {
    let mut deep = landscape(SIZE, None);
    let sunk = deep.field("height").expect("there").values().iter().map(|height| height - 3000.0).collect();
    deep.insert("height", "m", Field::from_values(SIZE, sunk));
    let files_of = |export: &Unreal| files(export, &deep, "land.r16");
    let files = files_of(&Unreal::default());
    let z = number(&json(&files, "land.r16.json")["Scale"]["z"]);
    let heights: Vec<f64> = words(&files[Path::new("land.r16")])
        .iter()
        .map(|number| 3000.0 + (number - 32768.0) / 12800.0 * z)
        .collect();
    let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(low < 0.0 && low > -121.0, "{low}");
    let raised = Unreal { zero: -2600.0, z_scale: Some(400.0), ..Unreal::default() };
    let files = files_of(&raised);
    let first = words(&files[Path::new("land.r16")])[0];
    let height = -2600.0 + (first - 32768.0) / 128.0 * 4.0;
    assert!((height - (hill(0.0, 0.0) - 3000.0)).abs() <= 2.0 / 128.0 + 1e-4, "{height}");
    let finished = Finished { landscape: &deep, steps: &[], recipe: "", hash: "", seed: 0 };
    let narrow = Unreal { z_scale: Some(100.0), ..Unreal::default() };
    let notes = narrow.notes(&finished).join("\n");
    assert!(notes.contains("do not go into a `z_scale` of 100 %"), "{notes}");
    assert_eq!(files_of(&narrow), files_of(&Unreal::default()), "it takes the least that heights go into");
}

#[test]
fn unreal_tiles_meet_to_the_bit_and_their_masks_too() {
    let (landscape, field) = square(379);
    let mask = Weight { layer: LayerName::of("soil"), low: 0.0, high: 2.0 };
    let export = Unreal { tiles: 3, size: Some(127), masks: vec![Nested(mask)], ..Unreal::default() };
    let files = files(&export, &landscape, "land.png");
    assert_eq!(files.len(), 9 + 9 + 1);
    let tile = |x: usize, y: usize| {
        png(&files[&PathBuf::from(format!("land_x{x}_y{y}.png"))], png::BitDepth::Sixteen).1
    };
    let z = number(&json(&files, "land.png.json")["Scale"]["z"]);
    for y in 0..3 {
        for x in 0..3 {
            let numbers = tile(x, y);
            let heights: Vec<f64> = numbers.iter().map(|number| (number - 32768.0) / 12800.0 * z).collect();
            ensure_within_half_a_step(&heights, &field, z / 12800.0, |index| {
                (x * 126 + index % 127, y * 126 + index / 127)
            });
            if x < 2 {
                let east = tile(x + 1, y);
                assert!((0..127).all(|row| numbers[row * 127 + 126] == east[row * 127]), "east of {x}, {y}");
            }
            if y < 2 {
                assert!(numbers[126 * 127..] == tile(x, y + 1)[..127], "south of {x}, {y}");
            }
        }
    }
    let (side, soil) = png(&files[Path::new("land_soil_x2_y0.png")], png::BitDepth::Eight);
    assert_eq!((side, soil[126]), (127, 255.0), "2 m of soil in the east");
    let (_, soil) = png(&files[Path::new("land_soil_x0_y1.png")], png::BitDepth::Eight);
    assert_eq!(soil[0], 0.0);
    assert!((soil[126] - 255.0 / 3.0).abs() <= 0.5, "a third of the way: {}", soil[126]);
}

#[test]
fn sizes_that_an_engine_does_not_take_are_faults() {
    let unreal = Unreal { size: Some(1024), ..Unreal::default() };
    assert!(
        unreal.faults()[0]
            .message
            .contains("127, 253, 505, 1009, 2017, 4033 or 8129 vertices a side; 1009 is the next smaller, 2017 is the next larger")
    );
    let unity = Unity { size: Some(1024), ..Unity::default() };
    assert!(
        unity.faults()[0]
            .message
            .contains("33, 65, 129, 257, 513, 1025, 2049 or 4097 vertices a side; 513 is the")
    );
    let godot = Terrain3d { region_size: Some(100), ..Terrain3d::default() };
    assert!(godot.faults()[0].message.contains("64, 128, 256, 512, 1024 or 2048 vertices"));
    let mask = Weight { layer: LayerName::of("soil"), low: 1.0, high: 1.0 };
    let level = Unreal { masks: vec![Nested(mask)], ..Unreal::default() };
    assert!(level.faults()[0].message.contains("must differ"));
    assert_eq!(level.reads(), ["height", "soil"]);
}

#[test]
fn cells_that_are_resampled_and_numbers_that_are_wasted_are_noted() {
    let of = |landscape: &Landscape, export: &dyn Export| {
        let finished = Finished { landscape, steps: &[], recipe: "", hash: "", seed: 0 };
        export.notes(&finished).join("\n")
    };
    let (fits, _) = square(127);
    assert_eq!(of(&fits, &Unreal::default()), "");
    let other = landscape(SIZE, None);
    let note = "90 × 70 cells were resampled to 127 × 127 vertices, 14.13 m × 10.95 m apart";
    assert!(of(&other, &Unreal::default()).starts_with(note), "{}", of(&other, &Unreal::default()));
    assert!(of(&other, &Unity::default()).contains("resampled to 129 × 129 vertices"));
    let far = of(&fits, &Unreal { zero: 90_000.0, ..Unreal::default() });
    assert!(far.contains("of 65536 numbers, one every 2.750 m; a `zero` near them"), "{far}");
}

#[test]
fn unity_tiles_decode_to_metres_from_the_south_west() {
    let (landscape, field) = square(129);
    let export = Unity { tiles: 2, size: Some(65), ..Unity::default() };
    let files = files(&export, &landscape, "land.raw");
    assert_eq!(files.len(), 4 + 1);
    let info = json(&files, "land.raw.json");
    let [width, height, length] = ["x", "y", "z"].map(|axis| number(&info["Terrain Size"][axis]));
    let floor = number(&info["Position"]["y"]);
    assert!((2.0 * width - 128.0 * CELL).abs() < 1e-9 && (2.0 * length - 128.0 * CELL).abs() < 1e-9);
    assert_eq!((&info["Byte Order"], &info["Flip Vertically"]), (&"Windows".into(), &false.into()));
    let tile = |x: usize, z: usize| words(&files[&PathBuf::from(format!("land_{x}_{z}.raw"))]);
    for z in 0..2 {
        for x in 0..2 {
            let numbers = tile(x, z);
            // Unity's importer: the share number / 65536 of the terrain's height; rows go up in z.
            let heights: Vec<f64> = numbers.iter().map(|number| floor + number / 65536.0 * height).collect();
            ensure_within_half_a_step(&heights, &field, height / 65536.0, |index| {
                (x * 64 + index % 65, 128 - (z * 64 + index / 65))
            });
            if x == 0 {
                let east = tile(1, z);
                assert!((0..65).all(|row| numbers[row * 65 + 64] == east[row * 65]), "east of {z}");
            }
            if z == 0 {
                assert!(numbers[64 * 65..] == tile(x, 1)[..65], "north of {x}");
            }
        }
    }
    let all: Vec<f64> = (0..4).flat_map(|index| tile(index % 2, index / 2)).collect();
    assert!(all.contains(&0.0) && all.contains(&65535.0), "the whole range is used");
}

#[test]
fn terrain3d_gets_metres_as_they_are_or_the_range_of_its_numbers() {
    let landscape = landscape(SIZE, None);
    let field = landscape.field("height").expect("there");
    let plain = files(&Terrain3d::default(), &landscape, "land.exr");
    let raster = exr::decode(&plain[Path::new("land.exr")], Limits::default()).expect("reads");
    assert_eq!(&raster.field, field, "cells as they are");
    let info = json(&plain, "land.exr.json");
    assert_eq!((number(&info["vertex_spacing"]), number(&info["region_size"])), (CELL, 256.0));
    assert!(info.get("r16_range").is_none(), "metres have no range to be entered");
    let whole = files(&Terrain3d::default(), &landscape, "land.r16");
    let info = json(&whole, "land.r16.json");
    assert_eq!(info["r16_size"], serde_json::json!([90, 70]));
    let [low, high] = [0, 1].map(|end| number(&info["r16_range"][end]));
    let metres = |number: f64| low + number / 65535.0 * (high - low);
    let heights: Vec<f64> = words(&whole[Path::new("land.r16")]).into_iter().map(metres).collect();
    ensure_within_half_a_step(&heights, field, (high - low) / 65535.0, |index| (index % 90, index / 90));
    let spaced = Terrain3d { spacing: Some(10.0), region_size: Some(64), ..Terrain3d::default() };
    let fine = files(&spaced, &landscape, "land.exr");
    let info = json(&fine, "land.exr.json");
    assert_eq!((number(&info["vertex_spacing"]), &info["regions"]), (10.0, &serde_json::json!([3, 3])));
    let raster = exr::decode(&fine[Path::new("land.exr")], Limits::default()).expect("reads");
    assert_eq!(raster.field.size(), Size { columns: 179, rows: 139 });
    for (index, height) in raster.field.values().iter().enumerate() {
        let expected = hill((index % 179) as f64 * 10.0, (index / 179) as f64 * 10.0);
        assert!((f64::from(*height) - expected).abs() <= INTERPOLATION, "{height} for {expected}");
    }
    let many = Terrain3d { region_size: Some(64), spacing: Some(0.5), ..Terrain3d::default() };
    let finished = Finished { landscape: &landscape, steps: &[], recipe: "", hash: "", seed: 0 };
    let error = many.parts(&finished, Path::new("land.exr")).expect_err("too many regions").to_string();
    assert!(error.contains("regions a side, at most 32 are allowed"), "{error}");
}

#[test]
fn cells_without_data_are_the_lowest_height_and_a_mask_of_holes() {
    let flags = (0..SIZE.cells()).map(|index| index % SIZE.columns < 60).collect();
    let mut landscape = landscape(SIZE, Mask::new(SIZE, flags));
    let broken = Field::from_function(SIZE, |x, y| {
        if x < 60 { hill(x as f64 * CELL, y as f64 * CELL) as f32 } else { -1e30 }
    });
    landscape.insert("height", "m", broken);
    let files = files(&Unreal::default(), &landscape, "land.png");
    let (_, numbers) = png(&files[Path::new("land.png")], png::BitDepth::Sixteen);
    let (side, holes) = png(&files[Path::new("land_holes.png")], png::BitDepth::Eight);
    let z = number(&json(&files, "land.png.json")["Scale"]["z"]);
    let low =
        landscape.field("height").expect("there").range(landscape.domain.valid.as_ref()).expect("land").0;
    assert!(z < 400.0, "-1e30 took no part: {z}");
    let mut counts = [0; 2];
    for (number, hole) in numbers.iter().zip(&holes) {
        counts[usize::from(*hole > 0.0)] += 1;
        if *hole > 0.0 {
            let height = (number - 32768.0) / 12800.0 * z;
            assert!((height - f64::from(low)).abs() <= 1.0, "{height} for {low}");
        }
    }
    assert_eq!(counts[0] + counts[1], side * side);
    assert!(counts[1] > side * side / 4 && counts[1] < side * side / 2, "{counts:?}");
    let finished = Finished { landscape: &landscape, steps: &[], recipe: "", hash: "", seed: 0 };
    assert!(Unreal::default().notes(&finished)[0].contains("lowest height; the file of holes"));
    assert!(Unity::default().notes(&finished)[0].contains("lowest height"));
}

#[test]
fn a_recipe_writes_each_set() {
    let mut recipe = String::from("[landscape]\nsize = [40, 30]\ncell = 10\n[[step]]\ndo = \"fbm\"\n");
    for (name, file) in [("unreal", "u.png"), ("unity", "v.raw"), ("terrain3d", "g.exr")] {
        assert!(EXPORTS.iter().any(|entry| entry.name == name));
        let output = format!("[[output]]\nexport = \"{name}\"\nfile = \"{file}\"\n");
        recipe.push_str(&output);
    }
    let folder = tempfile::tempdir().expect("a folder");
    let recipe = weald::recipe::Recipe::parse("set.toml", &recipe, &weald::recipe::Overrides::default())
        .expect("good");
    let options = weald::recipe::Options::into_folder(folder.path());
    let report =
        weald::recipe::Run { recipe: &recipe, options }.execute(&weald::recipe::Silent).expect("runs");
    let names = ["u.png", "u.png.json", "v.raw", "v.raw.json", "g.exr", "g.exr.json"];
    assert!(names.iter().all(|name| folder.path().join(name).exists()));
    let companions: Vec<_> = report.outputs.iter().flat_map(|output| output.companions.clone()).collect();
    assert_eq!(companions, ["u.png.json", "v.raw.json", "g.exr.json"]);
}

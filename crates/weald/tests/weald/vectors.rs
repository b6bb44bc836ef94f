//! Rivers and lakes as `GeoJSON`, and what GDAL finds in them.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::{Value, json};
use weald::Landscape;
use weald::domain::Georeference;
use weald::export::{Export, Finished, LakeAreas, RiverLines};
use weald::recipe::{Overrides, Recipe};

const ROWS: usize = 96;
const CELL: f64 = 30.0;

/// Mountains with lakes and rivers, in a CRS or in none.
fn country(georeference: Option<Georeference>) -> Landscape {
    let text = "
        [landscape]
        size = [128, 96]
        cell = 30.0
        seed = 3
        [[step]]
        do = \"diamond-square\"
        relief = 600.0
        roughness = 0.6
        [[step]]
        do = \"lakes\"
        [[step]]
        do = \"flow\"
        [[step]]
        do = \"rivers\"
        lakes = \"lake\"
        [[output]]
        export = \"rivers\"
        file = \"rivers.geojson\"
    ";
    let recipe = Recipe::parse("country.toml", text, &Overrides::default()).expect("a recipe");
    let mut landscape = recipe.landscape().expect("it runs");
    landscape.domain.georeference = georeference;
    landscape
}

fn utm() -> Georeference {
    Georeference { epsg: Some(32616), origin: [730_900.75, 4_069_271.25], pixel: [CELL; 2], keys: None }
}

fn written(export: &dyn Export, landscape: &Landscape) -> (Vec<u8>, Vec<String>) {
    let finished = Finished { landscape, steps: &[], recipe: "country.toml", hash: "af13", seed: 3 };
    let mut parts = export.parts(&finished, Path::new("lines.geojson")).expect("a file");
    (parts.remove(0).bytes, export.notes(&finished))
}

fn read(export: &dyn Export, landscape: &Landscape) -> Value {
    serde_json::from_slice(&written(export, landscape).0).expect("JSON")
}

/// What `ogrinfo` says of a file.
fn ogrinfo(bytes: &[u8]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let path: PathBuf = folder.path().join("lines.geojson");
    std::fs::write(&path, bytes).expect("written");
    let run = Command::new("ogrinfo").args(["-ro", "-so", "-al"]).arg(&path).output();
    let output = run.unwrap_or_else(|cause| {
        panic!("ogrinfo does not start ({cause}); install it: apt-get install gdal-bin")
    });
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && message.is_empty(), "ogrinfo: {message}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn features(file: &Value) -> &[Value] {
    file["features"].as_array().expect("a list")
}

/// Least and greatest first and second coordinate of all points.
fn extent(file: &Value) -> [f64; 4] {
    fn visit(value: &Value, extent: &mut [f64; 4]) {
        let list = value.as_array().expect("a list");
        if let [Some(x), Some(y), Some(_)] = [0, 1, 2].map(|at| list.get(at).and_then(Value::as_f64)) {
            *extent = [extent[0].min(x), extent[1].min(y), extent[2].max(x), extent[3].max(y)];
        } else {
            for inner in list {
                visit(inner, extent);
            }
        }
    }
    let mut extent = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    for feature in features(file) {
        visit(&feature["geometry"]["coordinates"], &mut extent);
    }
    extent
}

fn shown(extent: [f64; 4]) -> String {
    format!("Extent: ({:.6}, {:.6}) - ({:.6}, {:.6})", extent[0], extent[1], extent[2], extent[3])
}

#[test]
fn gdal_finds_all_rivers_and_lakes_at_their_place_in_the_crs_of_the_file() {
    let landscape = country(Some(utm()));
    let (rivers, lakes): (&dyn Export, &dyn Export) = (&RiverLines::default(), &LakeAreas::default());
    for (export, name, geometry) in
        [(rivers, "rivers", "3D Line String"), (lakes, "lakes", "3D Multi Polygon")]
    {
        let (bytes, notes) = written(export, &landscape);
        let file: Value = serde_json::from_slice(&bytes).expect("JSON");
        let said = ogrinfo(&bytes);
        let extent = extent(&file);
        assert!(features(&file).len() > 3, "{} {name}", features(&file).len());
        for expected in [
            format!("Layer name: {name}"),
            format!("Geometry: {geometry}"),
            format!("Feature Count: {}", features(&file).len()),
            shown(extent),
            "ID[\"EPSG\",32616]".to_owned(),
        ] {
            assert!(said.contains(&expected), "{expected:?} is not in {said}");
        }
        let [west, south, east, north] = extent;
        assert!(west >= 730_900.75 && east <= 730_900.75 + 128.0 * CELL && east - west > 1000.0);
        assert!(north <= 4_069_271.25 && south >= 4_069_271.25 - 96.0 * CELL && north - south > 1000.0);
        assert_eq!(notes, [""; 0]);
    }
}

#[test]
fn coordinates_are_degrees_to_the_millimetre_where_the_crs_has_degrees() {
    let pixel = [0.0003, 0.00025];
    let place = |epsg| Georeference { epsg: Some(epsg), origin: [-84.2, 36.6], pixel, keys: None };
    for (code, member) in [(4326, "urn:ogc:def:crs:OGC:1.3:CRS84"), (4269, "urn:ogc:def:crs:EPSG::4269")] {
        let landscape = country(Some(place(code)));
        let file = read(&RiverLines::default(), &landscape);
        assert_eq!(file["crs"]["properties"]["name"], json!(member));
        let said = ogrinfo(&written(&RiverLines::default(), &landscape).0);
        // Without the member GDAL takes points with heights for EPSG:4979, whose heights are above the ellipsoid.
        assert!(said.contains(&format!("ID[\"EPSG\",{code}]")), "{said}");
        let metres = extent(&read(&RiverLines::default(), &country(None)));
        let expected =
            [-84.2 + metres[0] / CELL * pixel[0], 36.6 - (ROWS as f64 - metres[1] / CELL) * pixel[1]];
        let found = extent(&file);
        assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 1e-7), "{found:?}, {expected:?}");
    }
}

#[test]
fn rfc_7946_has_longitude_and_latitude_alone_and_is_refused_elsewhere() {
    let place =
        Georeference { epsg: Some(4326), origin: [-84.2, 36.6], pixel: [0.0003, 0.00025], keys: None };
    let landscape = country(Some(place));
    let rivers = RiverLines { rfc7946: true, ..RiverLines::default() };
    let lakes = LakeAreas { rfc7946: true, ..LakeAreas::default() };
    for export in [&rivers as &dyn Export, &lakes] {
        let bytes = written(export, &landscape).0;
        let file: Value = serde_json::from_slice(&bytes).expect("JSON");
        assert!(file.get("crs").is_none() && !features(&file).is_empty());
        let said = ogrinfo(&bytes);
        assert!(
            said.contains("ID[\"EPSG\",4326]")
                && said.contains("Geometry: ")
                && !said.contains("Geometry: 3D"),
            "{said}"
        );
        let elsewhere = country(Some(utm()));
        let finished =
            Finished { landscape: &elsewhere, steps: &[], recipe: "country.toml", hash: "af13", seed: 3 };
        let error = export.parts(&finished, Path::new("a.geojson")).expect_err("metres").to_string();
        assert!(error.contains("EPSG:32616") && error.contains("ogr2ogr -t_srs EPSG:4326"), "{error}");
    }
}

#[test]
fn without_a_place_coordinates_are_metres_from_the_south_west_and_a_note_says_so() {
    let (bytes, notes) = written(&RiverLines::default(), &country(None));
    let file: Value = serde_json::from_slice(&bytes).expect("JSON");
    let [west, south, east, north] = extent(&file);
    assert!(west >= 0.0 && south >= 0.0 && east <= 128.0 * CELL && north <= 96.0 * CELL);
    assert!(notes.len() == 1 && notes[0].contains("metres from its south-western corner"), "{notes:?}");
    let said = ogrinfo(&bytes);
    assert!(said.contains(&shown(extent(&file))));
    let is_in_metres = said.contains("ENGCRS[\"metres from the south-western corner\"");
    assert!(is_in_metres && !said.contains("degree"), "{said}");
}

#[test]
fn every_river_says_where_its_water_goes_and_gets_no_smaller_on_the_way() {
    let file = read(&RiverLines::default(), &country(Some(utm())));
    let lakes = read(&LakeAreas::default(), &country(Some(utm())));
    let known: Vec<_> = features(&lakes).iter().map(|lake| &lake["properties"]["id"]).collect();
    let (mut joined, mut into_lakes) = (0, 0);
    for feature in features(&file) {
        let river = &feature["properties"];
        assert_eq!(feature["id"], river["id"]);
        let number = |key: &str| river[key].as_f64().unwrap_or_else(|| panic!("{key} of {river}"));
        assert!(number("length") > 0.0 && number("width") > 0.0 && number("depth") > 0.0, "{feature}");
        let points = feature["geometry"]["coordinates"].as_array().expect("a line");
        let heights: Vec<_> = points.iter().map(|point| point[2].as_f64().expect("a height")).collect();
        assert!(heights.windows(2).all(|pair| pair[1] <= pair[0]), "{heights:?} runs uphill");
        match river["end"].as_str().expect("a word") {
            "confluence" => {
                let next =
                    features(&file).iter().find(|other| other["id"] == river["downstream"]).expect("there");
                let next = &next["properties"];
                assert!(next["order"].as_u64() >= river["order"].as_u64());
                assert!(next["discharge"].as_f64() > river["discharge"].as_f64(), "{river} into {next}");
                joined += 1;
            }
            "lake" => {
                assert!(known.contains(&&river["to_lake"]), "{river}");
                into_lakes += 1;
            }
            end => assert!(end == "outlet" && river["downstream"].is_null(), "{river}"),
        }
    }
    assert!(joined > 2 && into_lakes > 0, "{joined} confluences, {into_lakes} mouths in lakes");
}

#[test]
fn the_area_within_the_shores_of_a_lake_is_its_area() {
    let file = read(&LakeAreas::default(), &country(Some(utm())));
    for feature in features(&file) {
        let (lake, geometry) = (&feature["properties"], &feature["geometry"]["coordinates"]);
        let mut area = 0.0;
        for polygon in geometry.as_array().expect("areas") {
            for (index, ring) in polygon.as_array().expect("rings").iter().enumerate() {
                let ring = ring_area(ring);
                assert_eq!(ring > 0.0, index == 0, "shores run anticlockwise, islands clockwise");
                area += ring;
            }
        }
        let said = lake["area"].as_f64().expect("a number");
        assert!((area - said).abs() < 0.5, "{area} m² within the shores of {lake}");
        let level = lake["level"].as_f64();
        assert_eq!(geometry[0][0][0][2].as_f64(), level);
    }
    let largest = features(&file)[0]["properties"]["area"].as_f64().expect("a number");
    let few = read(&LakeAreas { smallest: largest, ..LakeAreas::default() }, &country(Some(utm())));
    assert!(features(&few).len() < features(&file).len() && !features(&few).is_empty());
}

fn ring_area(ring: &Value) -> f64 {
    let ring: Vec<Vec<f64>> = serde_json::from_value(ring.clone()).expect("points");
    assert_eq!(ring.first(), ring.last(), "a ring is closed");
    let [x, y] = [ring[0][0], ring[0][1]];
    let cross = |a: &[f64], b: &[f64]| (a[0] - x) * (b[1] - y) - (b[0] - x) * (a[1] - y);
    0.5 * ring.windows(2).map(|pair| cross(&pair[0], &pair[1])).sum::<f64>()
}

#[test]
fn small_rivers_are_left_out_by_their_order() {
    let landscape = country(None);
    let count =
        |order: u32| features(&read(&RiverLines { order, ..RiverLines::default() }, &landscape)).len();
    assert!(count(1) > count(2) && count(2) > 0, "{} and {}", count(1), count(2));
}

//! What Weald writes it reads back to the bit.

use std::collections::BTreeMap;

use crate::formats::read;
use crate::rasters::any_raster;
use proptest::prelude::*;
use tempfile::tempdir;
use weald_core::Error;
use weald_core::domain::Georeference;
use weald_core::grid::{Field, Mask, Size};
use weald_core::random::hash2;
use weald_io::{
    Class, Classes, InMemory, Limits, Part, PartName, Provenance, Raster, Shades, Spread, format_of, geotiff,
    netcdf, npy, png16, zarr,
};

#[test]
fn a_failed_write_leaves_nothing_and_keeps_what_was_there() {
    let folder = tempdir().expect("a folder");
    let raster = Raster::from(Field::filled(Size { columns: 2, rows: 2 }, 1.0));
    let missing = folder.path().join("missing/height.tif");
    let error = weald_io::write(&missing, &raster).expect_err("no such folder");
    assert!(matches!(&error, Error::Run(what) if what.contains("missing/height.tif")), "{error}");
    assert!(!missing.exists());
    // A folder in the file's place lets the temporary file be written and the renaming fail.
    let taken = folder.path().join("taken.tif");
    std::fs::create_dir(&taken).expect("made");
    weald_io::write(&taken, &raster).expect_err("a folder is in the way");
    let names: Vec<_> =
        std::fs::read_dir(folder.path()).expect("lists").map(|e| e.expect("entry").file_name()).collect();
    assert_eq!(names, ["taken.tif"]);
    let kept = folder.path().join("kept.tif");
    weald_io::write(&kept, &raster).expect("written");
    let before = std::fs::read(&kept).expect("there");
    let broken = Raster::from(Field::filled(Size { columns: 1, rows: 1 }, f32::NAN));
    let error = weald_io::write(&kept, &broken).expect_err("NaN");
    assert!(error.to_string().contains("column 0, row 0 holds NaN"), "{error}");
    assert_eq!(std::fs::read(&kept).expect("there"), before);
}

fn provenance() -> Provenance {
    Provenance {
        version: "0.1.0".to_owned(),
        recipe_blake3: "af13".repeat(16),
        seed: u64::MAX,
        layer: "height".to_owned(),
        unit: "m".to_owned(),
        range: (-0.1, 1e30),
        resampled: None,
    }
}

fn bits(raster: &Raster) -> Vec<u32> {
    raster.field.values().iter().map(|value| value.to_bits()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn geotiff_comes_back_to_the_bit(columns in 1_usize..600, rows in 1_usize..300, seed: u64) {
        let mut raster = any_raster(columns, rows, seed);
        raster.provenance = Some(provenance());
        raster.cell = Some(12.5);
        let origin = [500_000.25, -1_234_567.875];
        raster.georeference = Some(Georeference { epsg: Some(32733), origin, pixel: [12.5; 2], keys: None });
        let bytes = geotiff::encode(&raster).expect("finite");
        let again = geotiff::decode(&bytes, Limits::default()).expect("our own file");
        prop_assert_eq!(bits(&again), bits(&raster));
        prop_assert_eq!(&again.valid, &raster.valid);
        prop_assert_eq!(&again.provenance, &raster.provenance);
        prop_assert_eq!(again.cell, raster.cell);
        let place = again.georeference.as_ref().expect("written");
        prop_assert_eq!((place.epsg, place.origin, place.pixel), (Some(32733), origin, [12.5; 2]));
        prop_assert_eq!(geotiff::encode(&again).expect("finite"), bytes);
    }

    #[test]
    fn npy_comes_back_to_the_bit(columns in 1_usize..100, rows in 1_usize..100, seed: u64) {
        let raster = any_raster(columns, rows, seed);
        let bytes = npy::encode(&raster).expect("finite");
        prop_assert_eq!(bytes.len() % 64, raster.field.size().cells() * 4 % 64);
        let again = npy::decode(&bytes, Limits::default()).expect("our own file");
        prop_assert_eq!((bits(&again), again.valid), (bits(&raster), raster.valid));
    }

    #[test]
    fn png_comes_back_within_half_a_step(
        columns in 1_usize..100, rows in 1_usize..100, seed: u64, low in -9000.0..9000.0_f32, relief in 0.0..9000.0_f32
    ) {
        let mut raster = any_raster(columns, rows, seed);
        for (index, value) in raster.field.values_mut().iter_mut().enumerate() {
            *value = if *value == 0.0 { 0.0 } else { low + relief * ((hash2(seed, index as i64, 1) >> 40) as f32 / (1 << 24) as f32) };
        }
        raster.cell = Some(0.1);
        raster.provenance = Some(provenance());
        let range = raster.field.range(raster.valid.as_ref()).unwrap_or_default();
        raster.provenance.as_mut().expect("set").range = (f64::from(range.0), f64::from(range.1));
        let again = png16::decode(&png16::encode(&raster).expect("finite"), Limits::default()).expect("our own file");
        prop_assert_eq!((&again.valid, again.cell, &again.provenance), (&raster.valid, raster.cell, &raster.provenance));
        let half_a_step = 0.5 * f64::from(range.1 - range.0) / 65534.0;
        // What an f32 near the value cannot tell apart comes on top.
        let rounding = f64::from(range.0.abs().max(range.1.abs())) * 1.2e-7;
        for (value, was) in again.field.values().iter().zip(raster.field.values()) {
            let error = f64::from((value - was).abs());
            prop_assert!(error <= half_a_step + rounding, "{value} was {was}, half a step is {half_a_step}");
        }
    }
}

#[test]
fn the_keys_of_a_file_survive_unchanged() {
    for name in ["float32_tiles_deflate_predictor3.tif", "survey_feet.tif", "int16_pixel_is_point.tif"] {
        let first = read(name);
        let bytes = geotiff::encode(&first).expect("finite");
        let again = geotiff::decode(&bytes, Limits::default()).expect("our own file");
        assert_eq!(again.georeference, first.georeference, "{name}");
        assert_eq!(again.field, first.field, "{name}");
    }
}

#[test]
fn geotiff_bytes_do_not_depend_on_threads() {
    let raster = any_raster(700, 530, 3);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| geotiff::encode(&raster)).expect("finite")
    };
    let one = with(1);
    assert!(one == with(2) && one == with(3));
}

#[test]
fn a_no_data_number_is_never_a_value_of_the_data() {
    let size = Size { columns: 2, rows: 1 };
    for heights in [[-9999.0, 0.0], [-10000.0, 0.0], [-100_000.0, -50.0], [f32::MIN, f32::MAX]] {
        let mut values = heights.to_vec();
        values.push(0.0);
        let size = Size { columns: 3, ..size };
        let valid = Mask::new(size, vec![true, true, false]);
        let raster = Raster { valid, ..Raster::from(Field::from_values(size, values)) };
        let bytes = geotiff::encode(&raster).expect("finite");
        let again = geotiff::decode(&bytes, Limits::default()).expect("our own file");
        assert_eq!((again.valid, again.field), (raster.valid, raster.field));
    }
}

#[test]
fn classes_are_whole_numbers_and_come_back_with_their_no_data() {
    let size = Size { columns: 300, rows: 270 };
    for (greatest, stored, bytes) in
        [(9, "uint8", 1), (254, "uint8", 1), (255, "uint16", 2), (65_534, "uint16", 2), (65_535, "int32", 4)]
    {
        let number = |x: usize, y: usize| (hash2(3, x as i64, y as i64) % (greatest + 1)) as f32;
        let valid = Mask::new(size, (0..size.cells()).map(|cell| cell % 7 != 3).collect());
        let mut field =
            Field::from_function(size, |x, y| if (x + y * 300) % 7 == 3 { 0.0 } else { number(x, y) });
        field.values_mut()[0] = greatest as f32;
        let named = vec![Class { number: 0, name: "no lake & none".to_owned(), colour: [1, 2, 255] }];
        let classes = Some(Classes { named, greatest: greatest as u32 });
        let raster =
            Raster { valid, classes, provenance: Some(provenance()), cell: Some(5.0), ..Raster::from(field) };
        for preset in [None, Some("cog")] {
            let (encode, _) =
                format_of("a.tif".as_ref()).and_then(|format| format.writing(preset)).expect("there");
            let parts = encode.parts(&raster).expect("written");
            let again = geotiff::decode(&parts[0].bytes, Limits::default()).expect("our own file");
            assert_eq!((&again.field, &again.valid), (&raster.field, &raster.valid), "{greatest} {preset:?}");
            assert_eq!((again.stored, again.notes.len()), (stored, 0));
            let style = style_beside(&parts).expect("beside it");
            let first = elements_of(&style, "paletted", &["colorPalette"]).remove(0);
            assert_eq!(
                ["value", "color", "label"].map(|key| first[key].as_str()),
                ["0", "#0102ff", "no lake & none"]
            );
        }
        let packed = geotiff::encode(&raster).expect("written").len();
        assert!(packed < size.cells() * bytes + 40_000, "{packed}");
        let again =
            netcdf::decode(&netcdf::encode(&raster).expect("written"), Limits::default()).expect("ours");
        assert_eq!((&again.field, &again.valid, again.stored), (&raster.field, &raster.valid, "int32"));
        let parts = InMemory::of("a.zarr", zarr::encode(&raster).expect("written"));
        let again = zarr::decode(&parts, Limits::default()).expect("ours");
        assert_eq!((&again.field, &again.valid, again.stored), (&raster.field, &raster.valid, "int32"));
    }
}

/// The style of QGIS among the files of a raster.
fn style_beside(parts: &[Part]) -> Option<String> {
    let style = parts.iter().find(|part| part.name == PartName::Sibling(".qml".to_owned()))?;
    Some(String::from_utf8(style.bytes.clone()).expect("text"))
}

/// The attributes of the elements in which QGIS looks for values and colours: those within `path` below the one renderer.
fn elements_of(style: &str, kind: &str, path: &[&str]) -> Vec<BTreeMap<String, String>> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let document = roxmltree::Document::parse_with_options(style, options).expect("XML");
    let mut node = document.root_element();
    assert_eq!(node.tag_name().name(), "qgis");
    for name in ["pipe", "rasterrenderer"].iter().chain(path) {
        let mut children = node.children().filter(|child| child.has_tag_name(*name));
        let next = children.next().unwrap_or_else(|| panic!("no <{name}> in {style}"));
        if *name == "rasterrenderer" {
            assert_eq!((next.attribute("type"), next.attribute("band")), (Some(kind), Some("1")), "{style}");
        }
        assert!(children.next().is_none(), "one <{name}>: {style}");
        node = next;
    }
    let attributes = |node: roxmltree::Node<'_, '_>| {
        node.attributes().map(|it| (it.name().to_owned(), it.value().to_owned())).collect()
    };
    node.children().filter(roxmltree::Node::is_element).map(attributes).collect()
}

/// That colours of a style rise from at most the least to at least the greatest value, as QGIS expects them.
fn assert_covers(style: &str, (low, high): (f32, f32)) {
    let kind = "singlebandpseudocolor";
    let shader = elements_of(style, kind, &["rastershader"]).remove(0);
    assert_eq!(shader["colorRampType"], "INTERPOLATED");
    let mut items = elements_of(style, kind, &["rastershader", "colorrampshader"]);
    let legend = items.pop().expect("the last one says how the legend is");
    assert_eq!(legend["useContinuousLegend"], "0", "a line a colour");
    let number = |text: &String| text.parse::<f64>().expect("a number");
    let values: Vec<f64> = items.iter().map(|item| number(&item["value"])).collect();
    assert!(values.windows(2).all(|pair| pair[0] < pair[1]), "{style}");
    let ends = [values[0], values[values.len() - 1]];
    assert!(ends[0] <= f64::from(low) && ends[1] >= f64::from(high), "{low} to {high}: {style}");
    assert_eq!(["minimumValue", "maximumValue"].map(|key| number(&shader[key])), ends);
    let is_colour = |text: &str| text.len() == 7 && u32::from_str_radix(&text[1..], 16).is_ok();
    assert!(items.iter().all(|item| is_colour(&item["color"]) && !item["label"].is_empty()), "{style}");
    assert_eq!(items[items.len() - 1]["color"], "#01021e");
}

#[test]
fn measures_have_a_style_whose_colours_cover_what_the_file_holds() {
    let size = Size { columns: 40, rows: 30 };
    for spread in [Spread::Even, Spread::Logarithmic, Spread::Centred, Spread::CentredFar, Spread::Compass] {
        let value = |share: f32| match spread {
            Spread::Even => 3.0 + 40.0 * share,
            Spread::Logarithmic => 25.0 * 1e6_f32.powf(share),
            Spread::Centred | Spread::CentredFar => 0.3 * share - 0.1,
            Spread::Compass => {
                if share < 0.1 {
                    -1.0
                } else {
                    359.0 * share
                }
            }
        };
        let field = Field::from_function(size, |x, y| value((x * size.rows + y) as f32 / 1199.0));
        let range = field.range(None).expect("it has cells");
        let shades = Shades { spread, colours: vec![[250, 240, 230], [120, 130, 140], [1, 2, 30]] };
        let raster = Raster { shades: Some(shades), ..Raster::from(field) };
        for preset in [None, Some("cog")] {
            let (encode, _) =
                format_of("a.tif".as_ref()).and_then(|format| format.writing(preset)).expect("there");
            let parts = encode.parts(&raster).expect("written");
            assert_eq!(parts.len(), 2);
            assert_covers(&style_beside(&parts).expect("beside it"), range);
        }
    }
}

#[test]
fn a_slope_in_degrees_is_rise_over_run_for_landlab() {
    let slope =
        Provenance { layer: "slope".to_owned(), unit: "deg".to_owned(), range: (45.0, 45.0), ..provenance() };
    let field = Field::filled(Size { columns: 3, rows: 2 }, 45.0);
    let raster = Raster { provenance: Some(slope), cell: Some(5.0), ..Raster::from(field) };
    let (encode, _) =
        format_of("a.nc".as_ref()).and_then(|format| format.writing(Some("landlab"))).expect("there");
    let bytes = encode.parts(&raster).expect("written").remove(0).bytes;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    assert!(text.contains("topographic__slope") && !text.contains("steepest"), "its name in landlab");
    let again = netcdf::decode(&bytes, Limits::default()).expect("ours");
    assert!((again.field.at(1, 1) - 1.0).abs() < 1e-6, "{}", again.field.at(1, 1));
    assert_eq!(again.provenance.map(|said| said.unit).as_deref(), Some("1"));
}

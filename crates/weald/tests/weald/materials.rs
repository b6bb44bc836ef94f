//! Materials of a recipe, from their tables and files to layers, maps and files.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use tempfile::TempDir;
use weald::grid::Mask;
use weald::io::{self, Raster};
use weald::recipe::{Options, Overrides, Progress, Recipe, Run, Silent};
use weald::{Error, Field, Landscape, Size};

const SIDE: usize = 12;

/// Ground that slopes from 5.5 m in the west to 60.5 m in the east, of these materials.
fn recipe(materials: &str, steps: &str, outputs: &str) -> String {
    format!(
        "[landscape]\nsize = {SIDE}\ncell = 1.0\n{materials}[[step]]\ndo = \"plane\"\nslope = 5.0\nheight = \
         33.0\nazimuth_deg = 270.0\n{steps}{outputs}"
    )
}

fn output(layer: &str, file: &str) -> String {
    format!("[[output]]\nlayer = \"{layer}\"\nfile = \"{file}\"\n")
}

/// A folder with a recipe in it.
struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn raster(&self, name: &str, raster: impl Into<Raster>) {
        io::write(&self.path(name), &raster.into()).expect("a raster is written");
    }

    fn recipe(&self, text: &str) -> Recipe {
        let file = self.path("r.toml").display().to_string();
        Recipe::parse(&file, text, &Overrides::default()).unwrap_or_else(|error| panic!("{error}\n{text}"))
    }

    fn landscape(&self, text: &str) -> Result<Landscape, Error> {
        self.recipe(text).landscape()
    }

    fn run(&self, text: &str) -> PathBuf {
        let out = self.path("out");
        let options = Options::into_folder(&out);
        Run { recipe: &self.recipe(text), options }.execute(&Silent).expect("runs");
        out
    }
}

fn refusal(text: &str) -> String {
    let faults = Recipe::parse("r.toml", text, &Overrides::default());
    faults.expect_err("the recipe is bad").to_string()
}

fn field(side: usize, value: impl FnMut(usize, usize) -> f32) -> Field {
    Field::from_function(Size::square(side).expect("small"), value)
}

fn thickness() -> Field {
    field(SIDE, |x, y| (x * y) as f32 / 7.0)
}

const LAYERS: &str = "[[step]]\ndo = \"layers\"\n";

const STRATA: &str = "[[material]]\nname = \"rock\"\n[[material]]\nname = \"clay\"\nbottom = 20\n\
                      [[material]]\nname = \"sand\"\nbottom = 40\n[[material]]\nname = \"soil\"\nthickness = 0.5\n";

#[test]
fn strata_lie_level_in_the_slope_and_leave_the_rest_to_the_bedrock() {
    let text = recipe(STRATA, LAYERS, &output("clay", "clay.tif"));
    let landscape = Place::new().landscape(&text).expect("runs");
    let layer = |name: &str| landscape.field(name).expect("the step writes it");
    let (height, bedrock) = (layer("height"), layer("bedrock"));
    assert!(height.at(0, 0) < 20.0 && height.at(SIDE - 1, 0) > 41.0, "the slope cuts all strata");
    for x in 0..SIDE {
        let roof = height.at(x, 3) - 0.5;
        let expected = [roof.min(20.0), (roof.min(40.0) - 20.0).max(0.0), (roof - 40.0).max(0.0), 0.5];
        let found = ["bedrock", "clay", "sand", "soil"].map(|name| layer(name).at(x, 3));
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-5, "column {x}: {found} instead of {expected}");
        }
    }
    assert_ne!(bedrock, height);
}

#[test]
fn the_map_of_materials_counts_from_the_bedrock_and_passes_over_films() {
    let map = "[[step]]\ndo = \"top-material\"\n";
    let top = |steps: &str| {
        let text = recipe(STRATA, steps, &output("material", "material.npy"));
        let landscape = Place::new().landscape(&text).expect("runs");
        let map = landscape.field("material").expect("written");
        [0, 5, SIDE - 1].map(|x| map.at(x, 0))
    };
    assert_eq!(top(map), [3.0; 3], "half a metre of soil lies everywhere");
    assert_eq!(top(&format!("{map}thinnest = 0.6\n")), [0.0, 1.0, 2.0]);
}

#[test]
fn a_layer_goes_out_as_a_geotiff_and_comes_back_to_the_bit() {
    let place = Place::new();
    place.raster("sand.tif", thickness());
    let material = "[[material]]\nname = \"granite\"\n[[material]]\nname = \"sand\"\nfrom = \"sand.tif\"\n";
    let out =
        place.run(&recipe(material, LAYERS, &(output("sand", "sand.tif") + &output("bedrock", "b.tif"))));
    assert_eq!(io::read(&out.join("sand.tif")).expect("written").field, thickness());
    let back = material.replace("sand.tif", "out/sand.tif");
    let again = place.landscape(&recipe(&back, "", &output("sand", "sand.tif"))).expect("runs");
    assert_eq!(again.field("sand").expect("loaded"), &thickness());
    assert_eq!(again.materials[0].name, "granite");
}

#[test]
fn a_file_of_thicknesses_is_scaled_and_must_fit_the_landscape() {
    let place = Place::new();
    let from = |file: &str, scale: &str| {
        let material = format!(
            "[[material]]\nname = \"rock\"\n[[material]]\nname = \"sand\"\nfrom = \"{file}\"\n{scale}"
        );
        place.landscape(&recipe(&material, "", &output("sand", "sand.tif")))
    };
    place.raster("sand.npy", thickness());
    let doubled = from("sand.npy", "scale = 2.0\n").expect("fits");
    assert_eq!(doubled.field("sand").expect("loaded").at(5, 7), 2.0 * thickness().at(5, 7));
    place.raster("wide.npy", field(SIDE + 1, |_, _| 1.0));
    let error = from("wide.npy", "").expect_err("another size");
    let message = error.to_string();
    assert!(
        message.contains("wide.npy") && message.contains("13 × 13") && message.contains("12 × 12"),
        "{message}"
    );
    assert_eq!(error.exit_code(), 4);
    assert_eq!(from("none.npy", "").expect_err("missing").exit_code(), 4);
}

#[test]
fn a_thickness_below_nothing_is_refused_where_it_is_used() {
    let place = Place::new();
    place.raster("sand.npy", field(SIDE, |x, _| 2.0 - x as f32));
    let material = "[[material]]\nname = \"rock\"\n[[material]]\nname = \"sand\"\nfrom = \"sand.npy\"\n";
    let message = place.landscape(&recipe(material, LAYERS, &output("sand", "a.tif"))).expect_err("negative");
    assert!(message.to_string().contains("`sand` holds -1 at column 3, row 0"), "{message}");
}

fn load(keys: &str) -> String {
    format!("[[step]]\ndo = \"load\"\n{keys}")
}

#[test]
fn load_scales_shifts_and_resamples() {
    let place = Place::new();
    place.raster("slope.npy", field(2 * SIDE, |x, _| x as f32));
    let keys = "file = \"slope.npy\"\ninto = \"sand\"\nscale = 2.0\noffset = -1.0\n";
    let text = |more: &str| recipe("", &load(&format!("{keys}{more}")), &output("sand", "sand.tif"));
    let message = place.landscape(&text("")).expect_err("another size").to_string();
    assert!(message.contains("24 × 24") && message.contains("resample = true"), "{message}");
    let loaded = place.landscape(&text("resample = true\n")).expect("resampled");
    let row: Vec<_> = loaded.field("sand").expect("loaded").row(0).to_vec();
    assert_eq!(row, (0..SIDE).map(|x| 2.0 * (2.0 * x as f32 + 0.5) - 1.0).collect::<Vec<_>>());
}

#[test]
fn cells_without_data_need_a_value_where_the_landscape_has_ground() {
    let place = Place::new();
    let holes = Mask::new(thickness().size(), (0..SIDE * SIDE).map(|cell| cell != 17).collect());
    place.raster("holes.tif", Raster { valid: holes, ..thickness().into() });
    let keys = "file = \"holes.tif\"\ninto = \"sand\"\n";
    let text = |more: &str| recipe("", &load(&format!("{keys}{more}")), &output("sand", "sand.tif"));
    let message = place.landscape(&text("")).expect_err("a hole").to_string();
    assert!(message.contains("column 5, row 1 has no data") && message.contains("no_data"), "{message}");
    let filled = place.landscape(&text("no_data = 9.0\n")).expect("filled");
    assert_eq!(filled.field("sand").expect("loaded").at(5, 1), 9.0);
}

#[test]
fn layers_of_materials_are_there_only_once_something_writes_them() {
    let sand = output("sand", "sand.tif");
    let message = refusal(&recipe(STRATA, "", &sand));
    assert!(message.contains("needs layer `sand`") && message.contains("a `layers` step"), "{message}");
    let message = refusal(&recipe(STRATA, LAYERS, &output("rock", "rock.tif")));
    assert!(message.contains("the layer of the first material is `bedrock`"), "{message}");
    let unread = load("file = \"sand.tif\"\ninto = \"sand\"\n");
    let refused = refusal(&recipe(STRATA, &format!("{unread}{unread}{LAYERS}"), &sand));
    assert!(refused.contains("overwrites all that step 2 (`load`"), "{refused}");
    let read = recipe(STRATA, &format!("{unread}{LAYERS}"), &sand);
    Recipe::parse("r.toml", &read, &Overrides::default()).expect("`layers` reads what `load` wrote");
}

#[test]
fn no_output_overwrites_a_file_that_the_recipe_reads() {
    let place = Place::new();
    std::fs::create_dir(place.path("out")).expect("a folder");
    place.raster("out/sand.tif", thickness());
    let steps = load("file = \"out/sand.tif\"\ninto = \"sand\"\n");
    let recipe = place.recipe(&recipe("", &steps, &output("sand", "sand.tif")));
    assert_eq!(recipe.inputs(), [Path::new(&place.path("out/sand.tif"))]);
    let options = Options::into_folder(place.path("out"));
    let message = Run { recipe: &recipe, options }.execute(&Silent).expect_err("its own input").to_string();
    assert!(message.contains("is an input of the recipe and would be overwritten"), "{message}");
}

#[test]
fn materials_survive_a_change_of_resolution() {
    let resample = format!("[[step]]\ndo = \"resample\"\nsize = 6\n{LAYERS}");
    let landscape =
        Place::new().landscape(&recipe(STRATA, &resample, &output("clay", "clay.tif"))).expect("runs");
    assert_eq!(landscape.materials.len(), 4);
    assert_eq!(landscape.field("clay").expect("written").size().columns, 6);
}

#[test]
fn steps_that_do_not_go_with_the_materials_are_reported_before_anything_runs() {
    let assert_refused = |step: &str, part: &str| {
        let message = refusal(&recipe(STRATA, step, &output("clay", "clay.tif")));
        assert!(message.starts_with("r.toml:") && message.contains(part), "{message}");
    };
    let hydraulic = "[[step]]\ndo = \"hydraulic\"\nmodel = \"stava\"\n";
    assert_refused(&format!("{hydraulic}deposit = \"caly\"\n"), "`deposit` is \"caly\"");
    assert_refused(&format!("{hydraulic}deposit = \"caly\"\n"), "did you mean `clay`?");
    assert_refused(&format!("{hydraulic}slippage = {{ strength = 0.07 }}\n"), "at most 0.25 / 4 = 0.0625");
    assert_refused("[[step]]\ndo = \"slippage\"\nstrength = 0.07\n", "slippage: `strength` is 0.07");
    let water = "[[step]]\ndo = \"constant\"\ninto = \"water\"\n";
    assert_refused(
        &format!("{water}[[step]]\ndo = \"dissolution\"\ndeposit = \"mud\"\n"),
        "`deposit` is \"mud\"",
    );
    let stable =
        recipe(STRATA, &format!("{hydraulic}slippage = {{ strength = 0.0625 }}\n"), &output("clay", "c.tif"));
    Recipe::parse("r.toml", &stable, &Overrides::default()).expect("that much is stable");
}

#[test]
fn a_file_that_is_not_there_is_reported_before_the_first_step() {
    let place = Place::new();
    let recipe =
        place.recipe(&recipe("", &load("file = \"none.tif\"\ninto = \"sand\"\n"), &output("sand", "s.tif")));
    let steps = StepCounter(AtomicUsize::new(0));
    let options = Options::into_folder(place.path("out"));
    let error = Run { recipe: &recipe, options }.execute(&steps).expect_err("no such file");
    assert_eq!((error.exit_code(), steps.0.into_inner()), (4, 0), "{error}");
    assert!(error.to_string().contains("none.tif: cannot be read"), "{error}");
}

/// Counts the steps that begin.
struct StepCounter(AtomicUsize);

impl Progress for StepCounter {
    fn step(&self, _: usize, _: usize, _: &str) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

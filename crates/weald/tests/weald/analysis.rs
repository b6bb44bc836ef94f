//! Layers of slope, light, soil and selection against closed forms.

use weald::grid::Mask;
use weald::recipe::run_steps;
use weald::recipe::{Options, Overrides, Recipe, Run, Silent};
use weald::{Domain, Error, Field, Landscape, Size};

const CELL: f64 = 10.0;

/// Ground of 10 m cells from metres to the east and to the north of its middle.
fn land(side: usize, height: impl Fn(f64, f64) -> f64) -> Landscape {
    let size = Size::square(side).expect("small");
    let mut land = Landscape::new(Domain::new(size, CELL));
    let middle = (side - 1) as f64 / 2.0;
    let field = Field::from_function(size, |x, y| {
        height((x as f64 - middle) * CELL, (middle - y as f64) * CELL) as f32
    });
    land.insert("height", "m", field);
    land
}

fn after(mut land: Landscape, step: &str, keys: &str) -> Landscape {
    run_steps(&mut land, 1, &[(step, keys)]).unwrap_or_else(|error| panic!("{step}: {error}"));
    land
}

fn values<'a>(land: &'a Landscape, layer: &str) -> &'a [f32] {
    land.field(layer).expect("written").values()
}

fn middle(land: &Landscape, layer: &str) -> f64 {
    let size = land.domain.size;
    f64::from(land.field(layer).expect("written").at(size.columns / 2, size.rows / 2))
}

/// Largest distance of a layer from a value.
fn furthest(land: &Landscape, layer: &str, from: f64) -> f64 {
    values(land, layer).iter().map(|&value| (f64::from(value) - from).abs()).fold(0.0, f64::max)
}

/// A plane that faces a compass direction and rises away from it by an angle.
fn facing(aspect_deg: f64, slope_deg: f64) -> Landscape {
    let (sin, cos) = aspect_deg.to_radians().sin_cos();
    land(21, |east, north| -slope_deg.to_radians().tan() * (east * sin + north * cos))
}

#[test]
fn a_plane_has_its_slope_and_aspect_in_every_cell_also_at_the_edge() {
    for (aspect, slope) in [(0.0, 30.0), (45.0, 10.0), (90.0, 60.0), (200.0, 1.0), (315.0, 45.0)] {
        let plane = after(facing(aspect, slope), "slope", "");
        assert!(furthest(&plane, "slope", slope) < 2e-3, "slope {slope}");
        let plane = after(plane, "slope", "unit = \"tangent\"\ninto = \"rise\"");
        assert!(furthest(&plane, "rise", slope.to_radians().tan()) < 1e-4, "tangent of {slope}");
        let plane = after(plane, "aspect", "");
        let round = |value: &f32| (f64::from(*value) - aspect + 180.0).rem_euclid(360.0) - 180.0;
        assert!(values(&plane, "aspect").iter().all(|value| round(value).abs() < 0.02), "aspect {aspect}");
        let north = aspect.to_radians().cos() * slope.to_radians().sin();
        assert!(furthest(&plane, "northness", north) < 1e-4, "northness of {aspect}");
    }
}

#[test]
fn flat_ground_faces_nowhere() {
    let level = after(land(5, |_, _| 70.0), "aspect", "");
    assert_eq!(furthest(&level, "aspect", -1.0), 0.0);
    assert_eq!(furthest(&level, "northness", 0.0) + furthest(&level, "eastness", 0.0), 0.0);
}

#[test]
fn a_window_of_a_wider_scale_sees_through_what_is_smaller() {
    let ripple = |east: f64| if (east / CELL).rem_euclid(4.0) < 2.0 { 4.0 } else { 0.0 };
    let rippled = || land(41, |east, _| 0.2 * east + ripple(east));
    let worst = |keys: &str| {
        let slopes = after(rippled(), "slope", keys);
        let row = slopes.field("slope").expect("written").row(20)[12..29].to_vec();
        let off = |slope: &f32| (f64::from(*slope) - 0.2_f64.atan().to_degrees()).abs();
        row.iter().map(off).fold(0.0, f64::max)
    };
    assert!(worst("") > 8.0, "{}", worst(""));
    assert!(worst("scale = 80.0") < 1.5, "{}", worst("scale = 80.0"));
}

/// Curvatures at a place on ground: profile, plan, tangential, mean.
fn curvatures(ground: Landscape, x: usize, y: usize) -> [f64; 4] {
    let bent = after(ground, "curvature", "");
    ["profile", "plan", "tangential", "mean"]
        .map(|kind| f64::from(bent.field(&format!("curvature_{kind}")).expect("written").at(x, y)))
}

#[test]
fn a_dome_has_the_curvatures_of_its_sphere_and_a_bowl_their_negatives() {
    let radius = 2000.0;
    for sign in [1.0, -1.0] {
        let sphere = |east: f64, north: f64| sign * (radius * radius - east * east - north * north).sqrt();
        let [profile, plan, tangential, mean] = curvatures(land(101, sphere), 80, 40);
        for (name, found) in [("profile", profile), ("tangential", tangential), ("mean", mean)] {
            assert!((found * radius * sign - 1.0).abs() < 0.01, "{name} is {found}");
        }
        let contour = (300.0_f64.hypot(100.0)).recip();
        assert!((plan * sign / contour - 1.0).abs() < 0.01, "plan is {plan} instead of {contour}");
    }
}

#[test]
fn a_valley_of_parallel_contours_bends_along_its_slope_alone_and_a_cone_across_it() {
    let [profile, plan, tangential, _] = curvatures(land(61, |east, _| 0.001 * east * east), 45, 30);
    assert!(profile < -1e-3 && plan.abs() < 1e-7 && tangential.abs() < 1e-7, "{profile} {plan}");
    let [profile, plan, ..] = curvatures(land(61, |east, north| -0.5 * east.hypot(north)), 50, 30);
    assert!((plan * 200.0 - 1.0).abs() < 0.01 && profile.abs() < plan / 50.0, "{profile} {plan}");
}

#[test]
fn cells_without_data_change_no_slope() {
    let mut holed = facing(120.0, 25.0);
    let size = holed.domain.size;
    let flags: Vec<bool> = (0..size.cells()).map(|cell| cell % 5 != 0 && cell % 3 != 0).collect();
    let mut field = holed.field("height").expect("there").clone();
    for (cell, value) in field.values_mut().iter_mut().enumerate().filter(|(cell, _)| !flags[*cell]) {
        *value = if cell % 2 == 0 { f32::NAN } else { 1.0e9 };
    }
    holed.insert("height", "m", field);
    holed.domain.valid = Mask::new(size, flags.clone());
    let holed = after(holed, "slope", "");
    let slopes = values(&holed, "slope").iter().zip(&flags).filter(|(_, land)| **land);
    let worst = slopes.map(|(slope, _)| (f64::from(*slope) - 25.0).abs()).fold(0.0, f64::max);
    assert!(worst < 2e-3, "{worst}");
}

#[test]
fn every_plane_is_free_of_occlusion_and_sees_the_sky_that_its_tilt_allows() {
    for slope in [0.0_f64, 20.0, 50.0] {
        let plane = after(facing(70.0, slope), "occlusion", "");
        assert!(furthest(&plane, "occlusion", 1.0) < 1e-4, "occlusion at {slope}°");
        // At the lower edge nothing is seen but sky; the closed form is that of an endless plane.
        let expected = (1.0 + slope.to_radians().cos()) / 2.0;
        assert!(furthest(&plane, "sky_view", expected) < 2e-3, "sky view at {slope}°");
    }
}

#[test]
fn the_bottom_of_a_straight_valley_sees_the_cosine_of_its_walls() {
    for slope in [15.0_f64, 35.0, 55.0] {
        let rise = slope.to_radians().tan();
        let valley = after(land(201, |east, _| rise * east.abs()), "occlusion", "directions = 64");
        for layer in ["occlusion", "sky_view"] {
            let found = middle(&valley, layer);
            assert!((found - slope.to_radians().cos()).abs() < 0.01, "{layer} at {slope}°: {found}");
        }
    }
}

const EQUINOX: &str = "day = 80\ntransmissivity = 1.0\nalbedo = 0.0";

/// What a square metre of flat ground gets in a day without air, in kWh/m², by the closed form of Duffie and
/// Beckman 2013, "Solar Engineering of Thermal Processes", equations 1.4.1, 1.6.1a and 1.10.3.
fn insolation_without_air(day: f64, latitude_deg: f64) -> f64 {
    let turn = std::f64::consts::TAU / 365.0;
    let declination = (23.45_f64).to_radians() * (turn * (284.0 + day)).sin();
    let latitude = latitude_deg.to_radians();
    let sunset = (-latitude.tan() * declination.tan()).acos();
    let mean_height =
        latitude.cos() * declination.cos() * sunset.sin() + sunset * latitude.sin() * declination.sin();
    24.0 / std::f64::consts::PI * 1.361 * (1.0 + 0.033 * (turn * day).cos()) * mean_height
}

#[test]
fn level_open_ground_has_all_light_and_as_much_of_it_as_its_latitude_and_day_give() {
    for (day, latitude) in [(172, 60.0), (10, -20.0), (80, 0.0), (355, 50.0)] {
        let place = format!("day = {day}\nlatitude_deg = {latitude}");
        let outside = insolation_without_air(f64::from(day), latitude);
        let airless = after(land(9, |_, _| 5.0), "sunlight", &format!("{place}\ntransmissivity = 1.0"));
        assert!(furthest(&airless, "light", 1.0) < 1e-4, "{place}");
        let ratio = middle(&airless, "sunlight") / outside;
        assert!((ratio - 1.0).abs() < 0.02, "{place}: {ratio} of the closed form");
        let hazy = after(land(9, |_, _| 5.0), "sunlight", &place);
        assert!(furthest(&hazy, "light", 1.0) < 1e-4, "{place}");
        // A clear day lets half to four fifths through: less where the sun stays low.
        let through = middle(&hazy, "sunlight") / outside;
        assert!((0.4..0.8).contains(&through), "{place}: {through} comes through the air");
    }
}

#[test]
fn ground_that_leans_to_the_equator_by_its_latitude_gets_what_flat_ground_gets_there() {
    let level = after(land(9, |_, _| 5.0), "sunlight", &format!("{EQUINOX}\nlatitude_deg = 0"));
    for latitude in [20.0, 45.0, 60.0] {
        let leaning =
            after(facing(180.0, latitude), "sunlight", &format!("{EQUINOX}\nlatitude_deg = {latitude}"));
        let ratio = middle(&leaning, "sunlight") / middle(&level, "sunlight");
        assert!((ratio - 1.0).abs() < 0.01, "{latitude}°: {ratio}");
    }
}

#[test]
fn a_wall_in_the_east_hides_the_sun_until_it_stands_over_it() {
    let wall = land(81, |east, _| if east > 100.0 { 150.0 } else { 0.0 });
    let shaded = after(wall, "sunlight", &format!("{EQUINOX}\nlatitude_deg = 0\npositions = 200"));
    for x in [10, 25, 40, 48] {
        let distance = (51 - x) as f64 * CELL;
        let expected = 0.5 * (1.0 + (150.0 / distance).atan().cos());
        let found = f64::from(shaded.field("light").expect("written").at(x, 40));
        assert!((found - expected).abs() < 0.01, "{distance} m from the wall: {found} instead of {expected}");
    }
}

#[test]
fn land_that_is_the_same_to_the_east_and_the_west_is_lit_alike() {
    let ridge = |east: f64, north: f64| 200.0 * (-(east * east) / 2.0e4).exp() + 0.1 * north;
    let lit = after(land(41, ridge), "sunlight", "day = 120\nlatitude_deg = 50");
    let field = lit.field("sunlight").expect("written");
    let (low, high) = field.range(None).expect("cells");
    assert!(high - low > 0.5, "the ridge has sides in light and shade");
    for cell in 0..41 * 41 {
        let (x, y) = (cell % 41, cell / 41);
        let difference = (field.at(x, y) - field.at(40 - x, y)).abs();
        assert!(difference < 2e-3, "{difference} kWh/m² at {x}, {y}");
    }
}

#[test]
fn in_a_polar_night_there_is_no_light_at_all() {
    let rough = |east: f64, north: f64| 50.0 * (east * 0.03).sin() * (north * 0.02).cos();
    let dark = after(land(15, rough), "sunlight", "day = 355\nlatitude_deg = 80");
    assert_eq!(furthest(&dark, "sunlight", 0.0) + furthest(&dark, "light", 0.0), 0.0);
}

#[test]
fn northern_slopes_are_darker_in_the_north_and_lighter_in_the_south() {
    let light = |aspect, latitude: f64| {
        let plane = after(facing(aspect, 30.0), "sunlight", &format!("latitude_deg = {latitude}"));
        middle(&plane, "sunlight")
    };
    assert!(light(0.0, 45.0) < 0.8 * light(180.0, 45.0));
    assert!(light(0.0, -45.0) > 1.25 * light(180.0, -45.0));
}

#[test]
fn soil_is_deep_where_water_laid_it_down_and_gone_where_water_wore_the_ground() {
    let mut ground = land(31, |east, north| 5.0 * (east * 0.01).sin() + 0.05 * north);
    let size = ground.domain.size;
    ground.insert("erosion", "m", Field::from_function(size, |x, _| if x < 10 { 300.0 } else { 0.0 }));
    ground.insert("deposition", "m", Field::from_function(size, |x, _| if x > 20 { 4.0 } else { 0.0 }));
    let plain = after(ground.clone(), "soil", "");
    let worn = after(ground, "soil", "erosion = \"erosion\"\ndeposition = \"deposition\"");
    let depth = |land: &Landscape, x| land.field("soil_depth").expect("written").at(x, 15);
    assert_eq!((depth(&worn, 5), depth(&worn, 15)), (0.0, depth(&plain, 15)));
    assert!(depth(&plain, 15) > 0.2 && depth(&worn, 25) > 4.0, "{}", depth(&worn, 25));
    let fertility = worn.field("fertility").expect("written");
    assert!(fertility.at(25, 15) > fertility.at(15, 15) && fertility.at(5, 15) == 0.0);
}

#[test]
fn a_selection_meets_conditions_on_several_layers_and_a_mask_can_go_into_another() {
    let mut ground = land(21, |east, _| east);
    let size = ground.domain.size;
    ground.insert("damp", "1", Field::from_function(size, |_, y| y as f32 / 20.0));
    let both =
        "where = [{ layer = \"height\", above = 0 }, { layer = \"damp\", below = 0.5 }]\ninto = \"both\"";
    let chosen = after(ground, "select", both);
    let mask = chosen.field("both").expect("written");
    assert_eq!([mask.at(20, 0), mask.at(0, 0), mask.at(20, 20), mask.at(10, 10)], [1.0, 0.0, 0.0, 1.0]);
    let rest = "where = [{ layer = \"both\", above = 0.5 }]\nnot = true\ninto = \"rest\"";
    let chosen = after(chosen, "select", rest);
    let sums: Vec<f32> =
        values(&chosen, "both").iter().zip(values(&chosen, "rest")).map(|(a, b)| a + b).collect();
    assert!(sums.iter().all(|&sum| sum == 1.0));
}

#[test]
fn erosion_and_deposition_are_what_the_ground_lost_and_gained_in_metres() {
    let thermal = "thermal = { talus = 0.4, strength = 0.1 }";
    for keys in ["model = \"han\"", "model = \"mei\"", "model = \"stava\"\nslippage = {}", thermal] {
        let rough = land(33, |east, north| 40.0 * (east * 0.04).sin() + 30.0 * (north * 0.05).cos());
        let before = rough.field("height").expect("there").clone();
        let worn = after(rough, "hydraulic", &format!("iterations = 240\n{keys}"));
        let layers = ["height", "erosion", "deposition"].map(|layer| values(&worn, layer));
        let mut moved = 0.0_f64;
        for cell in 0..33 * 33 {
            let [height, lost, gained] = layers.map(|layer| f64::from(layer[cell]));
            assert!(lost >= 0.0 && gained >= 0.0 && lost * gained == 0.0, "{keys}: cell {cell}");
            let change = height - f64::from(before.values()[cell]);
            assert!((change - (gained - lost)).abs() < 2e-5, "{keys}: {change} m in cell {cell}");
            moved += lost;
        }
        assert!(moved > 0.1, "{keys}: {moved} m were moved in all");
    }
}

fn parsed(step: &str) -> Result<Recipe, Error> {
    let text = format!(
        "[landscape]\nsize = 48\ncell = 20.0\n[[step]]\ndo = \"diamond-square\"\nrelief = 300.0\n[[step]]\n\
         do = \"hydraulic\"\niterations = 240\n{step}\n[[output]]\nlayer = \"height\"\nfile = \"height.npy\"\n"
    );
    Recipe::parse("r.toml", &text, &Overrides::default())
}

#[test]
fn a_recipe_is_told_of_an_empty_selection_and_of_layers_that_are_not_there() {
    let refusal = |step| parsed(step).expect_err("refused").to_string();
    let empty = refusal("[[step]]\ndo = \"select\"");
    assert!(empty.contains("r.toml:10: select: `where` is empty"), "{empty}");
    let missing = refusal("[[step]]\ndo = \"soil\"\nmoisture = \"moisture\"");
    assert!(missing.contains("soil: reads layer `moisture`, which no earlier step writes"), "{missing}");
}

#[test]
fn the_measures_of_a_network_are_in_the_report() {
    let recipe = parsed("[[step]]\ndo = \"network\"").expect("good");
    let folder = tempfile::tempdir().expect("a folder");
    let run = Run { recipe: &recipe, options: Options::into_folder(folder.path()) };
    run.execute(&Silent).expect("runs");
    let text = std::fs::read_to_string(folder.path().join("report.json")).expect("written");
    let report: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let measures = &report["steps"][2]["measures"];
    for name in ["chan", "reach", "valley_largest", "drains", "pits"] {
        assert!(measures[name].is_f64(), "{name} in {measures}");
    }
    assert!(measures["drains"].as_f64().expect("a number") > 0.0);
    assert!(report["steps"][0].get("measures").is_none(), "other steps measure nothing");
}

//! What a perspective view shows, judged from its pixels.

use weald_core::grid::Mask;
use weald_core::parameter::{Nested, Places};
use weald_core::{Domain, Field, Landscape, Size};
use weald_picture::{Drape, GroundColour, Image, Picture, Scale, View};

use crate::pictures::stratum;

/// A mountain beside a lake, 64 cells of 20 m.
fn country() -> Landscape {
    let size = Size::square(64).expect("legal");
    let mut landscape = Landscape::new(Domain::new(size, 20.0));
    let ground = Field::from_function(size, |x, y| {
        let away = ((x as f32 - 22.0).powi(2) + (y as f32 - 26.0).powi(2)).sqrt();
        (400.0 - 16.0 * away).max(20.0) + ((x * 7 + y * 13) % 11) as f32
    });
    let lake = |x: usize, y: usize| if (40..60).contains(&x) && (30..60).contains(&y) { 25.0 } else { 0.0 };
    landscape.insert("water", "m", Field::from_function(size, lake));
    landscape.insert("height", "m", ground);
    landscape
}

fn small() -> View {
    View { width: 160, height: 90, samples: 2, ..View::default() }
}

fn above() -> View {
    View {
        altitude_deg: 90.0,
        azimuth_deg: 180.0,
        width: 120,
        height: 120,
        sun_altitude_deg: 60.0,
        ..small()
    }
}

fn draw(view: &View, landscape: &Landscape) -> Image {
    view.render(landscape).expect("draws")
}

fn light(image: &Image, x: usize, y: usize) -> f64 {
    image.pixel(x, y).map(f64::from).iter().sum::<f64>() / 3.0
}

#[test]
fn cameras_and_targets_far_from_the_landscape_are_noted() {
    let at = |x: f64, y: f64| Some(Places(vec![[x, y]]));
    let notes = |view: View| Picture::notes(&view, &country());
    assert!(notes(View { eye: at(-900.0, 600.0), target: at(600.0, 600.0), ..small() }).is_empty());
    let notes = notes(View { eye: at(99_999.0, 1.0), target: at(1.0, 99_999.0), ..small() });
    let far = |key| format!("`{key} is far from the landscape of 1280 m × 1280 m");
    assert_eq!(notes, [far("eye` [99999, 1]"), far("target` [1, 99999]")]);
}

#[test]
fn views_have_the_same_bits_on_any_number_of_threads() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        pool.install(|| draw(&small(), &country()))
    };
    let once = on(1);
    assert!(once.rgb.iter().any(|&byte| byte.abs_diff(once.rgb[0]) > 60), "there is something to see");
    assert_eq!(once, on(2));
    assert_eq!(once, on(3));
}

#[test]
fn what_has_no_data_is_not_drawn_whatever_its_numbers() {
    let with = |filler: f32| {
        let mut landscape = country();
        let size = landscape.domain.size;
        let is_valid = |x: usize| x < 40;
        landscape.domain.valid = Mask::new(size, (0..size.cells()).map(|cell| is_valid(cell % 64)).collect());
        let whole = landscape.field("height").expect("there").clone();
        let cut = Field::from_function(size, |x, y| if is_valid(x) { whole.at(x, y) } else { filler });
        landscape.insert("height", "m", cut);
        draw(&above(), &landscape)
    };
    let image = with(f32::NAN);
    assert_eq!(image, with(7777.0));
    assert_ne!(image, draw(&above(), &country()));
}

#[test]
fn a_landscape_without_land_is_a_bare_plain() {
    let mut landscape = country();
    landscape.domain.valid = Mask::new(landscape.domain.size, vec![false; 64 * 64]);
    let image = draw(&above(), &landscape);
    let [low, high] =
        [image.rgb.iter().min(), image.rgb.iter().max()].map(|byte| *byte.expect("there are pixels"));
    assert!(high - low < 60, "{low} to {high}");
}

#[test]
fn water_is_darker_and_bluer_than_the_land_beside_it() {
    let image = draw(&above(), &country());
    // The lake fills columns 40 to 60 and rows 30 to 60; the picture shows the whole landscape from above.
    let dry = draw(&View { water: false, ..above() }, &country());
    // The sky's light changes by a byte here and there on land beside the lake.
    let differs = |at: &usize| {
        let [wet, dry] = [&image, &dry].map(|image| image.pixel(at % 120, at / 120));
        wet.into_iter().zip(dry).any(|(wet, dry)| wet.abs_diff(dry) > 2)
    };
    let changed: Vec<_> = (0..120 * 120).filter(differs).collect();
    let blue = changed.iter().filter(|&&at| {
        let ([r, _, b], [dry_r, _, dry_b]) = (image.pixel(at % 120, at / 120), dry.pixel(at % 120, at / 120));
        i32::from(b) - i32::from(r) > i32::from(dry_b) - i32::from(dry_r)
    });
    let (blue, changed) = (blue.count(), changed.len());
    assert!(changed > 500 && blue * 10 > changed * 9, "{blue} of {changed} pixels are bluer");
}

#[test]
fn slopes_towards_the_sun_are_brighter_and_its_shadow_falls_on_the_other_side() {
    let sun = |sun_azimuth_deg| {
        draw(&View { sun_azimuth_deg, sun_altitude_deg: 25.0, water: false, ..above() }, &country())
    };
    let (west, east) = (sun(270.0), sun(90.0));
    let brighter = |from: std::ops::Range<usize>| {
        from.flat_map(|x| (35..60).map(move |y| (x, y)))
            .map(|(x, y)| light(&west, x, y) - light(&east, x, y))
            .sum::<f64>()
    };
    assert!(brighter(25..45) > 2000.0, "{}", brighter(25..45));
    assert!(brighter(55..75) < -2000.0, "{}", brighter(55..75));
}

#[test]
fn haze_pales_the_land_and_endless_visibility_leaves_it_alone() {
    let seen = |visibility| draw(&View { visibility: Some(visibility), ..small() }, &country());
    let (clear, clearer, hazy) = (seen(1e11), seen(1e12), seen(4000.0));
    let worst = clear.rgb.iter().zip(&clearer.rgb).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(worst <= Some(1), "{worst:?}");
    let contrast = |image: &Image| {
        let middle: Vec<f64> =
            (30..130).flat_map(|x| (30..70).map(move |y| (x, y))).map(|(x, y)| light(image, x, y)).collect();
        let mean = middle.iter().sum::<f64>() / middle.len() as f64;
        middle.iter().map(|light| (light - mean).abs()).sum::<f64>() / middle.len() as f64
    };
    assert!(contrast(&hazy) < 0.8 * contrast(&clear), "{} and {}", contrast(&hazy), contrast(&clear));
}

#[test]
fn materials_colour_the_ground_where_that_is_wished() {
    let mut landscape = country();
    landscape.materials.truncate(1);
    landscape.materials[0].colour = [0.9, 0.1, 0.1];
    let red = |image: &Image| {
        (0..120 * 120)
            .filter(|&at| matches!(image.pixel(at % 120, at / 120), [r, g, _] if r > g.saturating_add(50)))
            .count()
    };
    let named = draw(&above(), &landscape);
    let natural = draw(&View { ground: Some(GroundColour::Natural), ..above() }, &landscape);
    assert!(red(&named) > 5000 && red(&natural) < 500, "{} and {} red pixels", red(&named), red(&natural));
}

#[test]
fn materials_reach_into_each_other_along_their_borders_and_not_farther() {
    // A gentle slope, over which red begins at column 20 and blue at column 40.
    let size = Size::square(64).expect("legal");
    let mut landscape = Landscape::new(Domain::new(size, 20.0));
    landscape.insert("height", "m", Field::from_function(size, |x, _| 2.0 * x as f32));
    landscape.materials.truncate(1);
    landscape.materials.push(stratum("red", 40.0, [0.8, 0.05, 0.05]));
    landscape.materials.push(stratum("blue", 80.0, [0.05, 0.05, 0.8]));
    let image = draw(&View { width: 240, height: 240, water: false, ..above() }, &landscape);
    let is_blue = |x: &usize, y: usize| matches!(image.pixel(*x, y), [r, _, b] if b > r);
    let borders: Vec<usize> =
        (60..180).map(|y| (100..200).find(|x| is_blue(x, y)).expect("blue in the east")).collect();
    let [first, last] = [borders.iter().min(), borders.iter().max()].map(|border| *border.expect("many"));
    // Some three pixels are a cell.
    assert!((5..20).contains(&(last - first)), "borders from column {first} to {last}");
    let pure = |x: usize, blue: bool| (60..180).all(|y| is_blue(&x, y) == blue);
    assert!(pure(first - 8, false) && pure(last + 12, true), "{first} to {last}");
}

#[test]
fn beds_end_at_their_level_on_a_wall_and_do_not_fade_over_cells() {
    // A wall that falls southward by 50 m a cell, of which red is below 220 m and blue above.
    let size = Size::square(64).expect("legal");
    let mut landscape = Landscape::new(Domain::new(size, 20.0));
    let wall = |_, y: usize| (425.0 - 50.0 * (y as f32 - 24.0)).clamp(25.0, 425.0);
    landscape.insert("height", "m", Field::from_function(size, wall));
    landscape.materials.truncate(1);
    landscape.materials.push(stratum("red", 0.0, [0.8, 0.05, 0.05]));
    landscape.materials.push(stratum("blue", 220.0, [0.05, 0.05, 0.8]));
    let image = draw(&View { width: 480, height: 480, water: false, ..above() }, &landscape);
    // How blue rows are, from -1 to 1, in the mean of the columns: 1 above the edge, and less where bushes grow below it.
    let blue = |y: usize| {
        let of = |x: usize| {
            let [red, _, blue] = image.pixel(x, y).map(f64::from);
            (blue - red) / (blue + red)
        };
        (100..380).map(of).sum::<f64>() / 280.0
    };
    let rows: Vec<f64> = (205..280).map(blue).collect();
    let first = rows.iter().position(|&blue| blue < 0.7).expect("red follows");
    let last = rows.iter().rposition(|&blue| blue > 0.0).expect("blue comes first");
    // Seven and a half pixels are a cell, and 50 m.
    assert!(last.abs_diff(first) <= 2, "it fades from {first} to {last}");
}

#[test]
fn a_draped_layer_colours_the_ground_as_its_scale_says_and_nothing_else_does() {
    let mut landscape = country();
    let size = landscape.domain.size;
    landscape.insert("age", "yr", Field::from_function(size, |x, _| if x < 32 { 3.0 } else { 1003.0 }));
    let drape = Drape { ramp: Scale::Ember, ..Drape::of("age") };
    let scale = drape.scale(&landscape).expect("there");
    assert_eq!((scale.range, scale.share(503.0)), ([3.0, 1003.0], 0.5));
    assert_eq!(scale.ticks().last().map(|(_, text)| text.as_str()), Some("1000"));
    let view = View { drape: Some(Nested(drape)), water: false, ..above() };
    assert_eq!(view.reads(), ["height", "age"]);
    let image = draw(&view, &landscape);
    // Flat ground in the south, on both sides of the border.
    let row = |x: usize| light(&image, x, 108);
    let mean = |from: usize| (from..from + 25).map(row).sum::<f64>() / 25.0;
    assert!(mean(22) < 0.4 * mean(72), "nearly black and pale: {} and {}", mean(22), mean(72));
    // On flat ground only the grain of the ground itself could tell pixels apart.
    landscape.insert("height", "m", Field::filled(size, 20.0));
    let spread = |image: &Image| {
        let lights = || (72..97).map(|x| light(image, x, 60));
        lights().fold(0.0, f64::max) - lights().fold(255.0, f64::min)
    };
    let natural = spread(&draw(&View { drape: None, ..view.clone() }, &landscape));
    let draped = spread(&draw(&view, &landscape));
    assert!(draped < 3.0 && natural > 6.0, "no grain hides values: {draped}, but {natural} without");
    landscape.remove("age");
    assert!(view_error(&landscape).contains("age"));
}

fn view_error(landscape: &Landscape) -> String {
    let view = View { drape: Some(Nested(Drape::of("age"))), ..above() };
    view.render(landscape).expect_err("there is no such layer").to_string()
}

#[test]
fn a_river_from_a_spring_is_no_wider_than_one_that_drains_all_the_land() {
    let mut landscape = country();
    let size = landscape.domain.size;
    landscape.remove("water");
    // All but nothing seeps over the land; the river in the middle carries what a spring gives.
    let river = |_: usize, y: usize| if y == 31 { 9.0 } else { 1e-7 };
    landscape.insert("height", "m", Field::from_function(size, |x, _| 200.0 - x as f32));
    landscape.insert("flux_x", "m³/s", Field::from_function(size, river));
    landscape.insert("flux_y", "m³/s", Field::filled(size, 0.0));
    let with = draw(&above(), &landscape);
    let without = draw(&View { water: false, ..above() }, &landscape);
    let pixels = |rows: std::ops::Range<usize>| {
        let at = rows.flat_map(|y| (30..90).map(move |x| (x, y)));
        at.filter(|&(x, y)| light(&with, x, y) != light(&without, x, y)).count()
    };
    assert!(pixels(50..70) > 40, "there is a river: {}", pixels(50..70));
    assert_eq!(pixels(20..45) + pixels(75..100), 0, "and dry land beside it");
}

#[test]
fn snow_lies_above_its_line() {
    let view = View { snow_line: Some(150.0), water: false, ..above() };
    let (bare, snowy) =
        (draw(&View { snow_line: None, ..view.clone() }, &country()), draw(&view, &country()));
    let change = |x: usize, y: usize| light(&snowy, x, y) - light(&bare, x, y);
    let most = (0..120 * 120).map(|at| change(at % 120, at / 120)).fold(0.0, f64::max);
    assert!(most > 40.0, "{most}");
    // The plain in the south lies at 20 to 31 m.
    assert!((20..100).all(|x| change(x, 105).abs() < 1e-9));
}

#[test]
fn woods_spread_from_nowhere_over_moist_ground_to_all_that_is_gentle() {
    let view = |woods: f64| View { woods, water: false, ..above() };
    let none = draw(&View { tree_line: Some(-1000.0), ..view(0.5) }, &country());
    let wooded = [0.0, 0.3, 0.5, 0.7, 1.0].map(|woods| {
        let drawn = draw(&view(woods), &country());
        drawn.rgb.chunks(3).zip(none.rgb.chunks(3)).filter(|(a, b)| a != b).count()
    });
    assert_eq!(wooded[0], 0, "no tree stands");
    assert!(wooded.is_sorted() && wooded[4] > 2 * wooded[1].max(1000), "{wooded:?}");
}

#[test]
fn frames_of_a_turntable_differ_and_the_last_is_the_first_again() {
    let frame = |share: f64| draw(&View { samples: 1, ..small() }.turned(share), &country());
    let (first, half, last) = (frame(0.0), frame(0.5), frame(1.0));
    assert_ne!(first, half);
    let apart = first.rgb.iter().zip(&last.rgb).filter(|(a, b)| a.abs_diff(**b) > 12).count();
    assert!(apart * 50 < first.rgb.len(), "{apart} of {} bytes differ", first.rgb.len());
}

#[test]
fn the_tiniest_grids_can_be_drawn() {
    for (columns, rows) in [(1, 1), (1, 9), (2, 2), (9, 1)] {
        let size = Size::new(columns, rows).expect("legal");
        let mut landscape = Landscape::new(Domain::new(size, 3.0));
        landscape.insert("height", "m", Field::from_function(size, |x, y| (x + 2 * y) as f32));
        assert_eq!(draw(&small(), &landscape).width, 160, "{columns} × {rows}");
    }
}

#[test]
fn a_view_beyond_the_limits_is_refused_before_it_is_drawn() {
    let huge = View { width: 16384, height: 16384, ..View::default() };
    let error = huge.render(&country()).expect_err("too many pixels");
    assert_eq!(error.exit_code(), 5);
    assert!(error.to_string().contains("16384 × 16384"), "{error}");
}

//! What the pictures show, judged from their pixels.

use weald_core::grid::Mask;
use weald_core::material::Material;
use weald_core::parameter::LayerName;
use weald_core::{Domain, Field, Landscape, Size};
use weald_picture::{
    Along, Image, Map, Materials, Oklab, PAPER, PICTURES, Picture, Relief, Scale, Section, Tint, encode,
    linear_of_hex,
};

fn ground(columns: usize, rows: usize, height: impl FnMut(usize, usize) -> f32) -> Landscape {
    let size = Size::new(columns, rows).expect("legal");
    let mut landscape = Landscape::new(Domain::new(size, 10.0));
    landscape.insert("height", "m", Field::from_function(size, height));
    landscape
}

/// Hills of several sizes.
fn hills(side: usize) -> Landscape {
    ground(side, side, |x, y| {
        let wave = |length: f32, turn: f32| {
            let phase = x as f32 / length + turn * y as f32 / length;
            (phase - phase.floor() - 0.5).abs() * length
        };
        100.0 + wave(31.0, 0.6) * 3.0 + wave(17.0, -1.3) * 2.0 + wave(7.0, 2.2)
    })
}

fn plain() -> Relief {
    Relief { width: Some(64), contours: Some(0.0), water: false, ramp: Tint::Grey, ..Relief::default() }
}

fn draw(picture: &impl Picture, landscape: &Landscape) -> Image {
    picture.render(landscape).expect("draws")
}

fn oklab(image: &Image, x: usize, y: usize) -> Oklab {
    let [r, g, b] = image.pixel(x, y).map(u32::from);
    Oklab::of(linear_of_hex(r << 16 | g << 8 | b))
}

fn lightness(image: &Image, x: usize, y: usize) -> f64 {
    oklab(image, x, y).lightness
}

#[test]
fn light_from_the_north_west_falls_on_slopes_that_face_it() {
    let ridge = ground(64, 64, |x, y| -10.0 * (x as f32 + y as f32 - 63.0).abs());
    let image = draw(&plain(), &ridge);
    let (facing, averted) = (lightness(&image, 20, 20), lightness(&image, 43, 43));
    assert!(facing > averted + 0.15, "facing the light {facing}, averted {averted}");
}

#[test]
fn light_from_the_south_east_swaps_the_sides() {
    let ridge = ground(64, 64, |x, y| -10.0 * (x as f32 + y as f32 - 63.0).abs());
    let image = draw(&Relief { sun_azimuth_deg: 135.0, ..plain() }, &ridge);
    assert!(lightness(&image, 43, 43) > lightness(&image, 20, 20) + 0.15);
}

#[test]
fn a_plane_is_shaded_evenly_along_its_contours_right_up_to_the_border() {
    for (columns, rows) in [(64, 64), (9, 7), (300, 200)] {
        let plane = ground(columns, rows, |_, y| 500.0 + 4.0 * y as f32);
        let image = draw(&plain(), &plane);
        for y in 0..image.height {
            let row: Vec<f64> = (0..image.width).map(|x| lightness(&image, x, y)).collect();
            let spread = row.iter().copied().fold(0.0, f64::max) - row.iter().copied().fold(1.0, f64::min);
            assert!(spread < 0.006, "{columns} × {rows}, row {y}: lightness differs by {spread}");
        }
        let column: Vec<f64> = (0..image.height).map(|y| lightness(&image, 0, y)).collect();
        let bend = |three: &[f64]| (three[0] - 2.0 * three[1] + three[2]).abs();
        let worst = column.windows(3).map(bend).fold(0.0, f64::max);
        assert!(worst < 0.012, "{columns} × {rows}: lightness bends by {worst} down the slope");
    }
}

#[test]
fn contours_lie_where_the_height_is_a_multiple_of_the_interval() {
    let plane = ground(128, 128, |x, _| 10.0 * x as f32);
    let bare = draw(&Relief { width: Some(512), ..plain() }, &plane);
    let lined = draw(&Relief { width: Some(512), contours: Some(200.0), ..plain() }, &plane);
    let darker = |x: usize| lightness(&bare, x, 256) - lightness(&lined, x, 256);
    for x in 0..512 {
        let height = 10.0 * ((x as f64 + 0.5) / 4.0 - 0.5);
        let away = (height / 200.0 - (height / 200.0).round()).abs() * 200.0 / 2.5;
        if away < 0.5 && height > 100.0 {
            assert!(darker(x) > 0.02, "no line at pixel {x}, height {height}");
        }
        if away > 2.0 {
            assert!(darker(x).abs() < 1e-9, "ink at pixel {x}, height {height}");
        }
    }
}

#[test]
fn lakes_and_rivers_are_blue_and_the_film_of_rain_is_not_drawn() {
    let mut landscape = ground(64, 64, |x, y| (x as f32 - 32.0).abs() * 4.0 + 0.5 * (64.0 - y as f32));
    let size = landscape.domain.size;
    let lake = |x: usize, y: usize| if (24..40).contains(&x) && y > 50 { 20.0 } else { 0.01 };
    landscape.insert("water", "m", Field::from_function(size, lake));
    landscape.insert("flux_x", "m³/step", Field::filled(size, 0.0));
    let river = |x: usize, y: usize| if x == 32 { 1.0 + y as f32 } else { 0.01 };
    landscape.insert("flux_y", "m³/step", Field::from_function(size, river));
    let picture = Relief { width: Some(512), water: true, ..plain() };
    let (wet, dry) =
        (draw(&picture, &landscape), draw(&Relief { water: false, ..picture.clone() }, &landscape));
    let blueness = |x: usize, y: usize| oklab(&dry, x, y).b - oklab(&wet, x, y).b;
    assert!(blueness(256, 480) > 0.04, "lake {}", blueness(256, 480));
    assert!(blueness(260, 300) > 0.04, "river {}", blueness(260, 300));
    assert_eq!(wet.pixel(100, 300), dry.pixel(100, 300), "dry land");
}

#[test]
fn the_tint_of_flat_ground_is_lighter_the_higher_it_lies_in_the_alpine_ramp() {
    let steps = ground(64, 64, |x, _| (x / 16) as f32 * 100.0);
    let image = draw(&Relief { ramp: Tint::Alpine, exaggeration: Some(0.01), ..plain() }, &steps);
    let terraces: Vec<f64> = [8, 24, 40, 56].map(|x| lightness(&image, x, 32)).to_vec();
    assert!(terraces.windows(2).all(|pair| pair[1] > pair[0] + 0.02), "{terraces:?}");
}

#[test]
fn no_data_stays_paper_and_land_beside_it_is_drawn() {
    let mut landscape = hills(64);
    let size = landscape.domain.size;
    let hole = |cell: usize| cell % 64 > 40 || cell / 64 < 5;
    landscape.domain.valid = Mask::new(size, (0..size.cells()).map(|cell| !hole(cell)).collect());
    let field = landscape.field("height").expect("is there").clone();
    let holed = Field::from_function(size, |x, y| if hole(64 * y + x) { f32::NAN } else { field.at(x, y) });
    landscape.insert("height", "m", holed);
    let map = Map { of: LayerName::of("height"), width: Some(128), legend: false, ..Map::default() };
    for image in [draw(&Relief { width: Some(128), ..Relief::default() }, &landscape), draw(&map, &landscape)]
    {
        assert_eq!(image.pixel(100, 64), encode(PAPER));
        assert_eq!(image.pixel(20, 3), encode(PAPER));
        assert_ne!(image.pixel(78, 64), encode(PAPER));
    }
}

#[test]
fn flat_ground_with_one_pit_keeps_the_colour_of_its_tint() {
    let pitted = ground(64, 64, |x, y| if (x, y) == (20, 20) { -300.0 } else { 7.0 });
    let image = draw(&plain(), &pitted);
    assert!(lightness(&image, 50, 50) > 0.75, "{:?}", image.pixel(50, 50));
}

#[test]
fn a_landscape_without_land_is_a_sheet_of_paper() {
    let mut landscape = ground(8, 8, |_, _| 0.0);
    landscape.domain.valid = Mask::new(landscape.domain.size, vec![false; 64]);
    let image = draw(&plain(), &landscape);
    assert_eq!(image, Image::paper(image.width, image.height));
}

#[test]
fn pictures_have_the_same_bits_on_any_number_of_threads() {
    let mut landscape = hills(200);
    let size = landscape.domain.size;
    for layer in ["water", "flux_x", "flux_y"] {
        let wave = |x: usize, y: usize| ((x * 7 + y * 3) % 31) as f32 * 0.3;
        landscape.insert(layer, "m", Field::from_function(size, wave));
    }
    let draw_on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        pool.install(|| draw(&Relief { width: Some(333), ..Relief::default() }, &landscape))
    };
    let once = draw_on(1);
    assert!(once.rgb.iter().any(|&byte| byte != once.rgb[0]));
    assert_eq!(once, draw_on(2));
    assert_eq!(once, draw_on(3));
}

#[test]
fn grids_of_one_cell_and_of_one_row_can_be_drawn() {
    for (columns, rows, height) in [(1, 1, 64), (3, 1, 21), (1, 3, 192), (2, 2, 64), (5, 2, 26)] {
        let image = draw(&plain(), &ground(columns, rows, |x, y| (x * 3 + y) as f32));
        assert_eq!((image.width, image.height), (64, height), "{columns} × {rows}");
    }
}

#[test]
fn a_picture_is_as_large_as_the_grid_but_neither_tiny_nor_huge() {
    let side = |columns, rows| {
        let image = draw(&Relief::default(), &ground(columns, rows, |x, _| x as f32));
        (image.width, image.height)
    };
    assert_eq!(side(64, 32), (1024, 512));
    assert_eq!(side(1500, 10), (1500, 10));
    assert_eq!(side(2, 5000), (2, 5000), "two columns need two pixels");
}

#[test]
fn a_picture_beyond_the_limit_is_refused_before_it_is_drawn() {
    let tower = ground(1, 1000, |_, y| y as f32);
    let error = Relief { width: Some(16384), ..Relief::default() }.render(&tower).expect_err("too large");
    assert_eq!(error.exit_code(), 5);
    assert!(error.to_string().contains("16384 × 16384000"), "{error}");
}

#[test]
fn a_grid_larger_than_the_picture_keeps_its_mean_colour() {
    let checker = ground(512, 512, |x, y| ((x + y) % 2) as f32);
    let map = Map {
        of: LayerName::of("height"),
        width: Some(64),
        ramp: Scale::Grey,
        legend: false,
        ..Map::default()
    };
    let image = draw(&map, &checker);
    let even = ground(64, 64, |x, _| if x == 0 { 0.0 } else { 0.5 });
    let middle = draw(&Map { high: Some(1.0), ..map }, &even);
    assert_eq!(image.pixel(32, 32), middle.pixel(32, 32));
}

#[test]
fn a_logarithmic_map_gives_every_decade_the_same_span_of_colour() {
    let decades = ground(64, 64, |x, _| [1.0, 10.0, 100.0, 1000.0][x / 16]);
    let (low, high) = (Some(1.0), Some(1000.0));
    let map = Map {
        of: LayerName::of("height"),
        width: Some(64),
        ramp: Scale::Grey,
        logarithmic: true,
        low,
        high,
        legend: false,
    };
    let image = draw(&map, &decades);
    let light: Vec<f64> = [8, 24, 40, 56].map(|x| lightness(&image, x, 32)).to_vec();
    let steps: Vec<f64> = light.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(steps.iter().all(|step| (step - 1.0 / 3.0).abs() < 0.01), "{steps:?}");
}

#[test]
fn every_kind_of_picture_documents_all_its_parameters() {
    for entry in PICTURES {
        assert!(!entry.summary.is_empty() && !entry.source.is_empty());
        for parameter in (entry.parameters)() {
            assert!(parameter.doc.len() > 10, "{}: {}", entry.name, parameter.name);
        }
    }
}

/// A stratum that begins at such a height in metres.
pub(crate) fn stratum(name: &str, bottom: f64, colour: [f32; 3]) -> Material {
    Material {
        name: name.to_owned(),
        bottom: Some(bottom),
        colour,
        ..Material::built_in("clay").expect("built in")
    }
}

/// A slope from 0 m in the west to 630 m in the east, with two strata, pure red from 200 m and pure blue from 400 m.
fn strata() -> Landscape {
    let mut landscape = ground(64, 64, |x, _| 10.0 * x as f32);
    landscape.materials.truncate(1);
    landscape.materials.push(stratum("red", 200.0, [1.0, 0.0, 0.0]));
    landscape.materials.push(stratum("blue", 400.0, [0.0, 0.0, 1.0]));
    landscape
}

fn hue(image: &Image, x: usize, y: usize) -> &'static str {
    let [r, g, b] = image.pixel(x, y);
    match (r > g.saturating_add(60), b > g.saturating_add(60)) {
        (true, false) => "red",
        (false, true) => "blue",
        _ => "grey",
    }
}

#[test]
fn strata_crop_out_in_bands_on_a_picture_of_materials() {
    let materials = Materials { width: Some(64), water: false, ..Materials::default() };
    let image = draw(&materials, &strata());
    let bands = [10, 30, 55].map(|x| hue(&image, x, 32));
    assert_eq!(bands, ["grey", "red", "blue"]);
}

#[test]
fn a_section_shows_strata_from_the_bedrock_up_water_on_them_and_nothing_above() {
    let mut landscape = strata();
    let water = Field::from_function(landscape.domain.size, |x, _| (150.0 - 10.0 * x as f32).max(0.0));
    landscape.insert("water", "m", water);
    let image = draw(&Section { width: 640, ..Section::default() }, &landscape);
    let column = |x: usize| (0..image.height).map(|y| hue(&image, x, y)).collect::<Vec<_>>();
    let east = column(620);
    // Lines between the strata are thinner than three pixels.
    let bands = east.chunk_by(|a, b| a == b).filter(|run| run.len() > 3);
    let seen: Vec<_> = bands.map(|run| run[0]).collect();
    assert_eq!(seen, ["grey", "blue", "red", "grey"], "sky, the upper stratum, the lower one, bedrock");
    let [blue, red] = ["blue", "red"].map(|hue| east.iter().filter(|seen| **seen == hue).count() as f64);
    assert!((blue / red - 1.1).abs() < 0.08, "blue is 220 m thick there, red 200 m: {blue} and {red} pixels");
    let wet = |image: &Image| {
        (0..image.height).any(|y| matches!(image.pixel(60, y), [r, _, b] if b > r.saturating_add(50)))
    };
    assert!(wet(&image), "the lake in the west is seen");
    let dry = draw(&Section { width: 640, water: false, ..Section::default() }, &landscape);
    assert!(!wet(&dry));
}

#[test]
fn a_section_stands_in_its_exaggeration_and_along_a_column_the_ground_is_level() {
    let image = |along, exaggeration| {
        draw(&Section { width: 640, along, exaggeration, ..Section::default() }, &strata())
    };
    let [once, thrice] = [1.0, 3.0].map(|factor| image(Along::Row, Some(factor)).height as f64);
    assert!((thrice / once - 3.0).abs() < 0.02, "{once} and {thrice} pixels high");
    let column = image(Along::Column, None);
    let surface = |x: usize| (0..column.height).position(|y| hue(&column, x, y) == "red");
    assert!(surface(100).is_some() && surface(100) == surface(600));
    let endless = Section { width: 16384, exaggeration: Some(1000.0), ..Section::default() };
    let notes = endless.notes(&strata()).join("\n");
    assert!(notes.contains("not 1000: the picture would be too high"), "{notes}");
    assert_eq!(Section { width: 64, ..endless }.render(&strata()).expect("it is lowered").height, 16384);
}

//! Generators: the same bits on any number of threads, the same ground at any resolution, no preferred
//! direction.

use std::sync::Arc;

use proptest::prelude::*;
use weald::engine::{Engine, Job};
use weald::generate::Generator;
use weald::generate::diamond_square::DiamondSquare;
use weald::generate::fault::Fault;
use weald::generate::fbm::Fbm;
use weald::generate::ridged::Ridged;
use weald::generate::warp::Warp;
use weald::recipe::catalog::CATALOG;
use weald::recipe::parameter::{Diagnostics, LayerName};
use weald::recipe::source;
use weald::recipe::{Cache, Overrides, Recipe, Silent};
use weald::step::{Stage, Step};
use weald::{Domain, Field, Landscape, Size};

fn domain(columns: usize, rows: usize, cell: f64) -> Domain {
    Domain::new(Size::new(columns, rows).expect("small"), cell)
}

fn filled(generator: &dyn Generator, domain: &Domain, seed: u64) -> Field {
    generator.fill(domain, seed).expect("any grid will do")
}

fn generators() -> Vec<Box<dyn Generator>> {
    vec![
        Box::new(Fault { iterations: 40, ..Fault::default() }),
        Box::new(DiamondSquare::default()),
        Box::new(Fbm::default()),
        Box::new(Ridged::default()),
        Box::new(Warp::default()),
    ]
}

#[test]
fn one_two_and_three_threads_give_the_same_bits() {
    let domain = domain(157, 131, 40.0);
    for generator in generators() {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
            pool.install(|| filled(generator.as_ref(), &domain, 5))
        };
        let [one, two, three] = [1, 2, 3].map(on);
        let (low, high) = one.range(None).expect("cells");
        assert!(high - low > 10.0, "{generator:?} made no relief, so agreement would mean nothing");
        assert!(one == two && one == three, "{generator:?}");
    }
}

#[test]
fn another_seed_gives_another_ground_and_the_step_s_own_replaces_it() {
    let domain = domain(64, 64, 40.0);
    for generator in generators() {
        assert_ne!(
            filled(generator.as_ref(), &domain, 5),
            filled(generator.as_ref(), &domain, 6),
            "{generator:?}"
        );
    }
    let step = Fbm { seed: Some(6), ..Fbm::default() };
    let mut landscape = Landscape::new(domain.clone());
    step.run(&mut landscape, &Job::unwatched(5)).expect("runs");
    assert_eq!(*landscape.field("height").expect("written"), filled(&step, &domain, 6));
}

#[test]
fn a_generator_writes_the_layer_it_is_told_to_in_metres() {
    let step = Ridged { into: LayerName::of("crests"), ..Ridged::default() };
    let mut landscape = Landscape::new(domain(8, 8, 40.0));
    step.run(&mut landscape, &Job::unwatched(1)).expect("runs");
    assert_eq!(step.writes(), [("crests".to_owned(), "m")]);
    assert_eq!(landscape.layer("crests").expect("written").unit, "m");
    assert_eq!(landscape.layers().count(), 1);
}

#[test]
fn noise_three_times_as_fine_passes_through_the_same_points() {
    let (coarse, fine) = (domain(60, 50, 30.0), domain(180, 150, 10.0));
    let noises: [Box<dyn Generator>; 3] =
        [Box::new(Fbm::default()), Box::new(Ridged::default()), Box::new(Warp::default())];
    for noise in noises {
        let [coarse, fine] = [&coarse, &fine].map(|domain| filled(noise.as_ref(), domain, 3));
        for y in 0..50 {
            for x in 0..60 {
                // The middle of three fine cells has the centre of the coarse one.
                let difference = (coarse.at(x, y) - fine.at(3 * x + 1, 3 * y + 1)).abs();
                assert!(difference < 0.05, "{noise:?}: {difference} m of 1000 at {x}, {y}");
            }
        }
    }
}

#[test]
fn relief_is_about_what_a_landscape_of_some_wavelengths_spans() {
    for seed in 0..6 {
        for noise in [&Fbm::default() as &dyn Generator, &Warp::default()] {
            let (low, high) = filled(noise, &domain(256, 256, 60.0), seed).range(None).expect("cells");
            assert!((600.0..1250.0).contains(&(high - low)), "{noise:?}, seed {seed}: {low} to {high}");
        }
        let (low, high) =
            filled(&Ridged::default(), &domain(256, 256, 60.0), seed).range(None).expect("cells");
        assert!(low >= 0.0 && high <= 1000.0 && high - low > 700.0, "seed {seed}: {low} to {high}");
    }
}

/// Mean square slope per direction of an eighth of a turn, relative to the mean over all directions.
fn slopes_by_direction(field: &Field) -> [f64; 8] {
    let size = field.size();
    let mut sums = [0.0; 8];
    let apart = 4_i64;
    let diagonal = 3_i64;
    let shifts = [
        (apart, 0),
        (apart, 2),
        (diagonal, diagonal),
        (2, apart),
        (0, apart),
        (-2, apart),
        (-diagonal, diagonal),
        (-apart, 2),
    ];
    for (sum, (dx, dy)) in sums.iter_mut().zip(shifts) {
        for y in 8..size.rows - 8 {
            for x in 8..size.columns - 8 {
                let there = field.at((x as i64 + dx) as usize, (y as i64 + dy) as usize);
                *sum += f64::from(there - field.at(x, y)).powi(2) / (dx * dx + dy * dy) as f64;
            }
        }
    }
    let mean = sums.iter().sum::<f64>() / 8.0;
    sums.map(|sum| sum / mean)
}

#[test]
fn fbm_is_as_steep_in_every_direction() {
    let ground = Fbm { wavelength: 900.0, octaves: 3, ..Fbm::default() };
    let directions = slopes_by_direction(&filled(&ground, &domain(700, 700, 10.0), 4));
    assert!(directions.iter().all(|share| (share - 1.0).abs() < 0.12), "{directions:?}");
}

#[test]
fn fbm_faces_all_directions_alike() {
    let ground = Fbm { wavelength: 400.0, octaves: 5, ..Fbm::default() };
    let field = filled(&ground, &domain(900, 900, 10.0), 8);
    let mut facing = [0.0_f64; 16];
    for y in 1..899 {
        for x in 1..899 {
            let east = f64::from(field.at(x + 1, y) - field.at(x - 1, y));
            let south = f64::from(field.at(x, y + 1) - field.at(x, y - 1));
            let turn = south.atan2(east) / std::f64::consts::TAU + 0.5 + 1.0 / 32.0;
            facing[(turn * 16.0) as usize % 16] += 16.0 / (898.0 * 898.0);
        }
    }
    assert!(facing.iter().all(|share| (share - 1.0).abs() < 0.1), "{facing:?}");
}

#[test]
fn gain_sets_how_height_differences_grow_with_distance() {
    // Halving wavelengths with gain 2^-H gives differences that grow like distance^H, between the shortest
    // and the longest wavelength.
    for (gain, exponent) in [(0.5_f64.powf(0.5), 0.5), (0.5_f64.powf(0.8), 0.8)] {
        let ground = Fbm { gain, octaves: 12, wavelength: 4096.0, ..Fbm::default() };
        let field = filled(&ground, &domain(1024, 400, 4.0), 2);
        let structure = |apart: usize| {
            let row = |y: usize| (0..1024 - apart).map(move |x| (x, y));
            let squares =
                (0..400).flat_map(row).map(|(x, y)| f64::from(field.at(x + apart, y) - field.at(x, y)));
            squares.map(|d| d * d).sum::<f64>() / (400 * (1024 - apart)) as f64
        };
        let measured = 0.5 * (structure(64) / structure(4)).log2() / 4.0;
        assert!((measured - exponent).abs() < 0.1, "gain {gain}: {measured}, not {exponent}");
    }
}

#[test]
fn every_generator_of_the_catalogue_fills_a_single_cell_and_a_single_row() {
    for entry in CATALOG.iter().filter(|entry| entry.stage == Stage::Generate) {
        for (columns, rows) in [(1, 1), (1, 9), (9, 1)] {
            let table = source::parse("recipe", "").expect("empty");
            let step = (entry.read)(&table, &mut Diagnostics::default());
            let mut landscape = Landscape::new(domain(columns, rows, 10.0));
            step.run(&mut landscape, &Job::unwatched(1)).expect("runs");
            assert_eq!(
                landscape.field("height").expect("written").first_not_finite(None),
                None,
                "{}",
                entry.name
            );
        }
    }
}

#[test]
fn every_generator_of_the_catalogue_makes_a_coarse_ground_of_the_means_of_the_finest() {
    let finest = Size::new(96, 64).expect("small");
    for entry in CATALOG.iter().filter(|entry| entry.stage == Stage::Generate) {
        let table = source::parse("recipe", "").expect("empty");
        let step = (entry.read)(&table, &mut Diagnostics::default());
        let made = |every: usize| {
            let cell = 40.0 * every as f64;
            let domain = Domain { finest: Some(finest), ..domain(96 / every, 64 / every, cell) };
            let mut landscape = Landscape::new(domain);
            step.run(&mut landscape, &Job::unwatched(3)).expect("runs");
            landscape.field("height").expect("written").clone()
        };
        let [fine, coarse] = [1, 4].map(made);
        let (low, high) = fine.range(None).expect("cells");
        let mean = |x: usize, y: usize| {
            let cells = (0..16).map(|at| f64::from(fine.at(4 * x + at % 4, 4 * y + at / 4)));
            cells.sum::<f64>() / 16.0
        };
        for (x, y) in (0..24).flat_map(|x| (0..16).map(move |y| (x, y))) {
            let off = (mean(x, y) - f64::from(coarse.at(x, y))).abs();
            assert!(off <= 1e-5 * f64::from(high - low), "{}: {off} m at {x}, {y}", entry.name);
        }
    }
}

/// Hills, squared and laid on a slope by a mask: what no mean of coarse layers gives.
fn shaped(after: &str) -> String {
    format!(
        r#"
[landscape]
size = [24, 16]
cell = 40.0
finest = 96
sea_level = 100.0
[[step]]
do = "fbm"
wavelength = 300.0
[[step]]
do = "remap"
to = [0.0, 500.0]
gamma = 2.5
[[step]]
do = "fbm"
into = "mask"
wavelength = 500.0
[[step]]
do = "remap"
layer = "mask"
[[step]]
do = "plane"
into = "slope_of_rock"
slope = 0.4
[[step]]
do = "blend"
with = "slope_of_rock"
mask = "mask"
{after}
[[output]]
layer = "height"
file = "height.tif"
"#
    )
}

fn recipe_of(text: &str) -> Recipe {
    Recipe::parse("shaped.toml", text, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn all_steps_that_shape_ground_run_on_the_finest_grid_and_the_landscape_has_their_means() {
    let land = |text: &str| recipe_of(text).landscape().unwrap_or_else(|error| panic!("{error}"));
    let slope = "[[step]]\ndo = \"slope\"";
    let fine = land(&shaped(slope).replace("size = [24, 16]\ncell = 40.0", "size = [96, 64]\ncell = 10.0"));
    let of = |land: &Landscape, name: &str| land.field(name).expect("written").clone();
    // With a step after them, and where the last of them is the last of all.
    for after in [slope, ""] {
        let coarse = land(&shaped(after));
        assert_eq!((coarse.domain.size, coarse.domain.cell), (Size::new(24, 16).expect("small"), 40.0));
        for (name, range) in [("height", 500.0), ("mask", 1.0)] {
            let (fine, coarse) = (of(&fine, name), of(&coarse, name));
            for (x, y) in (0..24).flat_map(|x| (0..16).map(move |y| (x, y))) {
                let cells = (0..16).map(|at| f64::from(fine.at(4 * x + at % 4, 4 * y + at / 4)));
                let off = (cells.sum::<f64>() / 16.0 - f64::from(coarse.at(x, y))).abs();
                assert!(off <= 1e-6 * range, "`{name}` is {off} off at {x}, {y}");
            }
        }
        // The sea stands over the ground of the coarse cells, and is no mean of a finer sea.
        for (&height, &depth) in of(&coarse, "height").values().iter().zip(of(&coarse, "sea_depth").values())
        {
            assert!(depth == 0.0 || depth == 100.0 - height, "{depth} m over {height} m");
        }
    }
    // Without a finest grid the coarse ground is another.
    let own = land(&shaped(slope).replace("finest = 96\n", ""));
    let coarse = land(&shaped(slope));
    let off = |(&a, &b): (&f32, &f32)| (a - b).abs();
    let (own, coarse) = (of(&own, "height"), of(&coarse, "height"));
    assert!(own.values().iter().zip(coarse.values()).map(off).fold(0.0, f32::max) > 20.0);
}

#[test]
fn a_landscape_that_is_resampled_to_as_many_cells_as_the_finest_grid_has_keeps_them() {
    let recipe = recipe_of(&shaped("[[step]]\ndo = \"resample\"\nsize = [96, 64]"));
    let land = recipe.landscape_after(7, &Engine::Cpu, None, &Silent);
    assert_eq!(land.map(|land| land.domain.size.columns).ok(), Some(96));
}

#[test]
fn a_landscape_in_the_middle_of_such_steps_is_seen_on_its_own_grid_and_kept_results_are_not_mixed_up() {
    let cache = Arc::new(Cache::in_memory(1 << 26).keeping_all());
    let after = |text: &str, steps: usize| {
        let land = recipe_of(text).landscape_after(steps, &Engine::Cpu, Some(&cache), &Silent);
        let land = land.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(land.domain.size.columns, 24, "after {steps} steps");
        land.field("height").expect("written").clone()
    };
    let whole = shaped("");
    let [first, last] = [1, 6].map(|steps| after(&whole, steps));
    // With fewer steps another one is the last on the finest grid: what comes after it must not find what it left there.
    let (start, rest) = whole.split_at(whole.find("[[step]]\ndo = \"remap\"").expect("is there"));
    let outputs = &rest[rest.find("[[output]]").expect("is there")..];
    let shorter = format!("{start}[[step]]\ndo = \"slope\"\n{outputs}");
    assert_eq!(after(&shorter, 1), first);
    let steep = |land: &Landscape| land.field("slope").expect("written").clone();
    let kept = recipe_of(&shorter).landscape_after(2, &Engine::Cpu, Some(&cache), &Silent);
    let own = recipe_of(&shorter).landscape().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(steep(&kept.unwrap_or_else(|error| panic!("{error}"))), steep(&own));
    assert_eq!(after(&whole, 6), last);
    assert_eq!(own.field("height").expect("written"), &first);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn noise_is_finite_and_within_its_bounds_for_all_parameters(
        (columns, rows) in (1_usize..40, 1_usize..40),
        cell in prop_oneof![1.0e-3..1.0, 1.0..1.0e4],
        wavelength in prop_oneof![1.0e-3..1.0, 1.0..1.0e9],
        (octaves, gain, lacunarity) in (1_u32..=16, 0.0..=1.0, 1.0..=8.0),
        (sharpness, strength) in (0.0..=8.0, 0.0..=4.0),
        seed: u64,
    ) {
        let domain = domain(columns, rows, cell);
        let fbm = Fbm { wavelength, octaves, gain, lacunarity, ..Fbm::default() };
        let warp = Warp { wavelength, octaves, gain, lacunarity, strength, ..Warp::default() };
        // A sum of n octaves is at most sqrt(n) / sqrt(variance of one) standard deviations from its mean.
        let bound = 500.0 + 1000.0 / 6.0 * f64::from(octaves).sqrt() / 0.297;
        for noise in [&fbm as &dyn Generator, &warp] {
            let (low, high) = filled(noise, &domain, seed).range(None).expect("cells");
            prop_assert!(f64::from(low) >= 999.0 - bound && f64::from(high) <= bound + 1.0, "{low} to {high}");
        }
        let ridged = Ridged { wavelength, octaves, gain, lacunarity, sharpness, ..Ridged::default() };
        let (low, high) = filled(&ridged, &domain, seed).range(None).expect("cells");
        prop_assert!(low >= 0.0 && high <= 1000.1, "{low} to {high}");
    }

    #[test]
    fn diamond_square_and_fault_span_their_relief_for_all_parameters(
        (columns, rows) in (2_usize..90, 2_usize..90), roughness in 0.0..=2.0, relief in 0.0..=9000.0, seed: u64,
    ) {
        let domain = domain(columns, rows, 10.0);
        let mountains = DiamondSquare { relief, roughness, ..DiamondSquare::default() };
        let faults = Fault { relief: Some(relief), ..Fault::default() };
        for generator in [&mountains as &dyn Generator, &faults] {
            let range = filled(generator, &domain, seed).range(None);
            prop_assert_eq!(range, Some((0.0, relief as f32)));
        }
    }
}

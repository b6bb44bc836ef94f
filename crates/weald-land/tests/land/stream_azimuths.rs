//! Whether streams know where north is: their directions on ground that has none, measured on turned grids.

use weald_core::random::signed2;
use weald_core::{Domain, Field, Landscape, Size};
use weald_engine::{Job, step::Step};
use weald_land::analyse::stream_azimuths::StreamAzimuths;
use weald_land::erode::fluvial_step::Fluvial;
use weald_land::erode::stream_power_step::StreamPower;
use weald_land::generate::fbm::Fbm;

const SIDE: usize = 192;
const SEEDS: [u64; 3] = [11, 12, 13];

/// Share of all directions that lie within 10° of multiples of 45°.
const NO_DIRECTION: f64 = 4.0 / 9.0;

/// Share of the streams within 10° of multiples of 45°, mean over some grounds.
fn along_the_grid(ground: impl Fn(u64) -> Landscape) -> f64 {
    let shares = SEEDS.map(|seed| {
        let land = ground(seed);
        let height = land.field("height").expect("there is ground");
        let azimuths = StreamAzimuths::of(&land.domain, height).expect("square");
        assert!(azimuths.degrees.len() > 2000, "{} streams", azimuths.degrees.len());
        azimuths.along_the_grid()
    });
    shares.iter().sum::<f64>() / SEEDS.len() as f64
}

fn square(cell: f64) -> Landscape {
    Landscape::new(Domain::new(Size::square(SIDE).expect("small"), cell))
}

/// Waves of random directions, lengths and phases.
fn waves(seed: u64) -> Landscape {
    let random = |wave: i64, what: i64| 0.5 + 0.5 * signed2(seed, wave, what);
    let waves: Vec<[f64; 4]> = (0..80)
        .map(|wave| {
            let length = 6.0 * libm::pow(10.0, random(wave, 0));
            let (direction, phase) = (random(wave, 1), random(wave, 2));
            let [east, south] =
                [libm::cos, libm::sin].map(|of| of(direction * std::f64::consts::TAU) / length);
            [east, south, phase, length]
        })
        .collect();
    let mut land = square(20.0);
    let height = |x: usize, y: usize| {
        let of = |&[east, south, phase, length]: &[f64; 4]| {
            length * libm::sin((east * x as f64 + south * y as f64 + phase) * std::f64::consts::TAU)
        };
        waves.iter().map(of).sum::<f64>() as f32
    };
    land.insert("height", "m", Field::from_function(land.domain.size, height));
    land
}

#[test]
fn streams_on_waves_of_all_directions_have_none() {
    let share = along_the_grid(waves);
    assert!((share - NO_DIRECTION).abs() < 0.02, "{share}");
}

#[test]
fn rivers_between_points_off_the_middles_of_cells_know_no_axis_and_on_a_regular_grid_they_do() {
    let range = |irregularity: f64| {
        along_the_grid(|seed| {
            let mut land = square(40.0);
            let noise = |x: usize, y: usize| signed2(seed, x as i64, y as i64) as f32;
            land.insert("height", "m", Field::from_function(land.domain.size, noise));
            let step = StreamPower { irregularity, ..StreamPower::default() };
            step.run(&mut land, &Job::unwatched(seed)).expect("nothing stands against it");
            land
        })
    };
    let [regular, off] = [0.0, 1.0].map(range);
    // On a regular grid ridges lie along the axes, and slopes fall between them.
    assert!(
        (off - NO_DIRECTION).abs() < 0.025 && (regular - NO_DIRECTION).abs() > 0.08,
        "{off} and {regular}"
    );
}

#[test]
fn streams_of_floods_know_no_axis() {
    let share = along_the_grid(|seed| {
        let mut land = square(40.0);
        let ground = Fbm { relief: 1200.0, wavelength: 3000.0, ..Fbm::default() };
        let flood = Fluvial { duration: 20_000.0, ..Fluvial::default() };
        for step in [&ground as &dyn Step, &flood] {
            step.run(&mut land, &Job::unwatched(seed)).expect("nothing stands against it");
        }
        land
    });
    assert!((share - NO_DIRECTION).abs() < 0.025, "{share}");
}

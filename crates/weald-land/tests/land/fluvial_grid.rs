//! What the grid shows of what `fluvial` makes: on fewer cells, on coarser grids first, and in its directions.

use std::sync::Mutex;

use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::{Domain, Landscape};
use weald_engine::{Budget, Job, Watcher, step::Step};
use weald_land::erode::fluvial_step::Fluvial;
use weald_land::generate::fbm::Fbm;

use crate::common::field;
use crate::fluvial::{land, run, square};

/// Hills that a grid of any fineness can hold, as means over its cells.
pub(crate) fn hills(side: usize) -> Landscape {
    const FINEST: usize = 128;
    let (extent, every) = (5120.0, FINEST / side);
    let height = |x: f64, y: f64| {
        let wave =
            |east: f64, south: f64, shift: f64| libm::sin((east * x + south * y) / extent * 6.3 + shift);
        200.0 * (wave(1.0, 0.6, 0.3) + wave(-0.7, 1.2, 1.0))
            + 70.0 * (wave(2.9, -2.1, 2.0) + wave(2.3, 3.4, 0.7))
            + 25.0 * (wave(7.1, 3.9, 0.1) + wave(-4.3, 6.7, 5.0) + wave(9.3, -6.1, 3.1))
    };
    let step = extent / FINEST as f64;
    land(square(side), extent / side as f64, |x, y| {
        let fine = (0..every * every).map(|at| {
            let (x, y) = (x * every + at % every, y * every + at / every);
            height((x as f64 + 0.5) * step, (y as f64 + 0.5) * step)
        });
        fine.sum::<f64>() / (every * every) as f64
    })
}

/// A flood with coarse sediment, over ground that creeps: changes are small beside the relief. Channels lie as far apart
/// as the longest cells are long.
fn gentle() -> Fluvial {
    Fluvial { settling: 0.002, creep: 0.03, gathering: 160.0, ..Fluvial::default() }
}

#[test]
fn a_coarse_landscape_is_the_mean_of_a_fine_one() {
    let carved = |side: usize| {
        let mut land = hills(side);
        let start = field(&land, "height").clone();
        run(&Fluvial { flow_time: 1.5, ..gentle() }, &mut land);
        (start, land)
    };
    let (start, fine) = carved(128);
    let mean = |land: &Landscape, layer: &str| -> f64 {
        let values = field(land, layer).values();
        values.iter().map(|&value| f64::from(value)).sum::<f64>() / values.len() as f64
    };
    let (low, high) = start.range(None).expect("cells");
    let [eroded, laid] = ["erosion", "deposition"].map(|layer| mean(&fine, layer));
    assert!(eroded > 3.0, "hardly anything moved: {eroded} m");
    for (side, share) in [(64, 0.1), (32, 0.2)] {
        let (_, coarse) = carved(side);
        let every = 128 / side;
        let off = (0..side * side).map(|at| {
            let (x, y) = (at % side, at / side);
            let means = (0..every * every).map(|at| {
                f64::from(field(&fine, "height").at(x * every + at % every, y * every + at / every))
            });
            let mean = means.sum::<f64>() / (every * every) as f64;
            (mean - f64::from(field(&coarse, "height").at(x, y))).powi(2)
        });
        let off = (off.sum::<f64>() / (side * side) as f64).sqrt() / f64::from(high - low);
        let [erosion, deposition] = ["erosion", "deposition"].map(|layer| mean(&coarse, layer));
        println!(
            "{side}: erosion {erosion:.2} of {eroded:.2} m, deposition {deposition:.2} of {laid:.2} m, heights \
             {:.2} % of the relief apart",
            100.0 * off
        );
        assert!((erosion / eroded - 1.0).abs() < share, "{side}: {erosion} m were eroded, {eroded} on 128");
        assert!(off < 0.02, "{side}: heights are {off} of the relief apart");
    }
}

#[test]
fn coarse_levels_first_make_nearly_the_same_landscape_and_lose_nothing() {
    let carved = |levels: u32| {
        let mut land = hills(128);
        let budget = run(&Fluvial { levels, coarsest: 1000.0, ..gentle() }, &mut land);
        (land, budget)
    };
    let (one, _) = carved(1);
    let mean = |land: &Landscape, layer: &str| -> f64 {
        let values = field(land, layer).values();
        values.iter().map(|&value| f64::from(value)).sum::<f64>() / values.len() as f64
    };
    let (low, high) = field(&one, "height").range(None).expect("cells");
    let expected = mean(&one, "erosion");
    for (levels, share, apart) in [(2, 0.05, 0.02), (3, 0.1, 0.025)] {
        let (several, budget) = carved(levels);
        let off = field(&one, "height").values().iter().zip(field(&several, "height").values());
        let off = off.map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>() / (128.0 * 128.0);
        let off = off.sqrt() / f64::from(high - low);
        let erosion = mean(&several, "erosion");
        println!(
            "{levels} levels: erosion {erosion:.2} of {expected:.2} m, heights {:.2} % of the relief apart",
            100.0 * off
        );
        assert!((erosion / expected - 1.0).abs() < share, "{erosion} m were eroded, {expected} on one level");
        assert!(off < apart, "heights are {off} of the relief apart");
        // Sums of each level are rounded once.
        assert!(budget.water.error().abs() < 1e-5, "{:?}", budget.water);
        assert!(budget.solid.error().abs() < 1e-7, "{:?}", budget.solid);
    }
}

#[test]
fn landscapes_that_begin_on_the_same_grid_are_alike_at_every_size() {
    let carved = |side: usize| -> (Landscape, Budget) {
        let mut land = hills(side);
        let step = Fluvial { levels: 8, coarsest: 80.0, flow_time: 1.5, ..gentle() };
        let budget = run(&step, &mut land);
        (land, budget)
    };
    let [(coarse, _), (fine, _)] = [64, 128].map(carved);
    let mean =
        |land: &Landscape, layer: &str| field(land, layer).sum() / field(land, layer).size().cells() as f64;
    let [coarse_erosion, erosion] = [&coarse, &fine].map(|land| mean(land, "erosion"));
    assert!(erosion > 3.0, "hardly anything moved: {erosion} m");
    println!("erosion {coarse_erosion:.3} of {erosion:.3} m");
    assert!(
        (coarse_erosion / erosion - 1.0).abs() < 0.05,
        "{coarse_erosion} m were eroded, {erosion} on 128"
    );
}

/// Power of the relief at wavelengths of 2.5 to 5 cells: along the axes, and along the diagonals.
fn power(height: &Field) -> [f64; 2] {
    let side = height.size().columns;
    let wave = |at: usize| std::f64::consts::TAU * at as f64 / side as f64;
    let (low, high) = height.range(None).expect("cells");
    let windowed = Field::from_function(height.size(), |x, y| {
        let part = |at: usize| 0.5 - 0.5 * libm::cos(wave(at));
        ((f64::from(height.at(x, y)) - f64::from(low + high) / 2.0) * part(x) * part(y)) as f32
    });
    let turns: Vec<[f64; 2]> = (0..side).map(|at| [libm::cos(wave(at)), libm::sin(wave(at))]).collect();
    let mut power = [0.0; 2];
    // One of two waves that run opposite ways.
    for (east, south) in (0..side / 2).flat_map(|east| (0..side).map(move |south| (east, south))) {
        let south = if south > side / 2 { south as i64 - side as i64 } else { south as i64 };
        let cycles = libm::hypot(east as f64, south as f64) / side as f64;
        if !(0.2..0.4).contains(&cycles) {
            continue;
        }
        let (mut real, mut imaginary) = (0.0, 0.0);
        for y in 0..side {
            let start = (south * y as i64).rem_euclid(side as i64) as usize;
            for (x, &value) in windowed.row(y).iter().enumerate() {
                let [cosine, sine] = turns[(start + east * x) % side];
                real += f64::from(value) * cosine;
                imaginary += f64::from(value) * sine;
            }
        }
        let degrees = libm::atan2(south as f64, east as f64).to_degrees().rem_euclid(90.0);
        power[usize::from((22.5..67.5).contains(&degrees))] += real * real + imaginary * imaginary;
    }
    power
}

#[test]
fn relief_has_as_much_power_along_the_axes_as_along_the_diagonals() {
    let (mut before, mut after) = ([0.0; 2], [0.0; 2]);
    let add = |sum: &mut [f64; 2], height: &Field| {
        let power = power(height);
        // Each ground counts alike, however rough it is.
        for (sum, own) in sum.iter_mut().zip(power) {
            *sum += own / (power[0] + power[1]);
        }
    };
    for seed in 1..=4 {
        let mut land = Landscape::new(Domain::new(square(128), 20.0));
        let ground = Fbm { relief: 700.0, wavelength: 2500.0, ..Fbm::default() };
        ground.run(&mut land, &Job::unwatched(seed)).expect("it runs");
        add(&mut before, field(&land, "height"));
        run(&Fluvial { duration: 10_000.0, flow_time: 1.0, ..Fluvial::default() }, &mut land);
        assert!(field(&land, "erosion").sum() > 128.0 * 128.0, "hardly anything was carved");
        add(&mut after, field(&land, "height"));
    }
    let [before, after] = [before, after].map(|[axes, diagonals]| axes / diagonals);
    println!("power along the axes over that along the diagonals: {before:.2} before, {after:.2} after");
    assert!((0.8..1.25).contains(&before), "the ground itself has directions: {before}");
    assert!((0.77..1.3).contains(&after), "the relief has {after} times the power along the axes");
}

/// Looks every so many years, and keeps the year, the mean erosion and the heights.
struct EveryYears(u64, Mutex<Vec<(u64, f64, Field)>>);

impl Watcher for EveryYears {
    fn next_look(&self, done: u64) -> Option<u64> {
        Some(done.next_multiple_of(self.0))
    }

    fn look(&self, done: u64, land: &Landscape) -> Result<(), Error> {
        let eroded = land.field("erosion")?.sum();
        self.1.lock().expect("no look fails").push((done, eroded, land.field("height")?.clone()));
        Ok(())
    }
}

#[test]
fn a_flood_is_seen_year_by_year_on_all_its_grids() {
    let mut land = hills(64);
    let start = field(&land, "height").clone();
    let step = Fluvial { levels: 3, coarsest: 320.0, flow_time: 0.5, ..gentle() };
    let watcher = EveryYears(500, Mutex::new(Vec::new()));
    let job = Job { watcher: &watcher, ..Job::unwatched(1) };
    step.run(&mut land, &job).expect("it runs");
    let seen = watcher.1.into_inner().expect("no look fails");
    let years: Vec<_> = seen.iter().map(|(year, ..)| *year).collect();
    assert_eq!(years, (0..=20).map(|frame| 500 * frame).collect::<Vec<_>>());
    assert_eq!(seen[0].2.values(), start.values(), "the first is the ground of the start");
    assert_eq!(seen[20].2.values(), field(&land, "height").values(), "the last is what is left");
    let eroded: Vec<_> = seen.iter().map(|(_, eroded, _)| eroded / (64.0 * 64.0)).collect();
    println!("eroded: {eroded:.2?} m");
    assert!(eroded.windows(2).all(|pair| pair[1] != pair[0]), "nothing moves from a frame to the next");
    assert!((5..=20).all(|at| eroded[at] > eroded[at - 5]), "the country does not wear");
    assert!(eroded[20] > 3.0, "hardly anything was carved");
    assert_eq!(step.watched(), 10_000);
}

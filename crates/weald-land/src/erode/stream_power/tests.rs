//! What the equation promises: balance with uplift, the time that rivers take to answer, and nothing lost.

use super::{Conditions, Evolution, Mesh, Slopes, Volumes};
use weald_core::domain::Domain;
use weald_core::grid::{Field, Mask, Size};
use weald_core::random::signed2;

const UPLIFT: f64 = 1e-3;
const ERODIBILITY: f64 = 1e-5;

/// A year count of a step, and the rest as the tests have it: bare rivers, m = 1/2 and n = 1.
fn conditions(size: Size, years: f64) -> Conditions {
    Conditions {
        uplift: Field::filled(size, (UPLIFT * years) as f32),
        erodibility: Field::filled(size, (ERODIBILITY * years) as f32),
        area_exponent: 0.5,
        hillslope_area: 0.0,
        slope_exponent: 1.0,
        deposition: 0.0,
        creep: 0.0,
        critical: 1e9,
        taluses: None,
        sea_level: None,
        lakes_fill: false,
        settling: 0.0,
    }
}

fn rough(domain: &Domain) -> Vec<f64> {
    let size = domain.size;
    (0..size.cells())
        .map(|cell| signed2(3, (cell % size.columns) as i64, (cell / size.columns) as i64))
        .collect()
}

fn evolved(domain: &Domain, conditions: &Conditions, steps: u32) -> Evolution {
    let mut evolution = Evolution::new(domain, &rough(domain), Mesh::new(domain, 0.7, 1), |_, _| true);
    for _ in 0..steps {
        evolution.step(conditions);
    }
    evolution
}

/// Each cell that drains somewhere: its slope, upslope area, and itself.
fn slopes(evolution: &Evolution) -> Vec<(f64, f64, usize)> {
    let receivers = &evolution.receivers;
    let drained = evolution.mesh.inner().filter(|&cell| receivers.of[cell] as usize != cell);
    drained
        .map(|cell| {
            let drop = evolution.heights[cell] - evolution.heights[receivers.of[cell] as usize];
            (drop * f64::from(receivers.inverse[cell]), evolution.area[cell], cell)
        })
        .collect()
}

#[test]
fn in_balance_slopes_are_those_of_the_closed_form() {
    let domain = Domain::new(Size { columns: 70, rows: 50 }, 300.0);
    for (m, n) in [(0.5, 1.0), (0.9, 2.0), (0.4, 0.8)] {
        // Such that the rivers of all three are about as steep.
        let erodibility = UPLIFT * 1e6_f64.powf(-m) / 0.1_f64.powf(n);
        let years = 50_000.0;
        let conditions = Conditions {
            erodibility: Field::filled(domain.size, (erodibility * years) as f32),
            area_exponent: m,
            slope_exponent: n,
            ..conditions(domain.size, years)
        };
        let evolution = evolved(&domain, &conditions, 1500);
        for (slope, area, cell) in slopes(&evolution) {
            let expected = (UPLIFT / erodibility).powf(1.0 / n) * area.powf(-m / n);
            let off = slope / expected - 1.0;
            assert!(off.abs() < 0.01, "m {m}, n {n}: {slope} for {expected} in cell {cell}");
        }
    }
}

#[test]
fn deposits_make_rivers_in_balance_steeper_by_their_share_and_all_that_rises_leaves() {
    let domain = Domain::new(Size { columns: 40, rows: 30 }, 300.0);
    // From G = 2 on the rivers of a grid so small wander for ever, and are in balance on average only.
    for deposition in [0.2, 0.5, 1.0] {
        let conditions = Conditions { deposition, ..conditions(domain.size, 5_000.0) };
        let mut evolution = evolved(&domain, &conditions, 4000);
        let own = domain.cell_area();
        let is_off = |&&(slope, area, _): &&(f64, f64, usize)| {
            // All that rises upstream comes by, but no more settles than that.
            let share = (deposition * own / area).min(1.0) * (area / own - 1.0);
            let expected = (1.0 + share) * UPLIFT / ERODIBILITY / area.sqrt();
            (slope / expected - 1.0).abs() > 0.01
        };
        // Where two neighbours are as steep, the river goes to and fro between them.
        let slopes = slopes(&evolution);
        let off = slopes.iter().filter(is_off).count();
        assert!(20 * off < slopes.len(), "G {deposition}: {off} of {} cells are off", slopes.len());
        let Volumes { uplifted: risen, outgoing: gone } = evolution.step(&conditions);
        assert!((gone / risen - 1.0).abs() < 1e-3, "G {deposition}: {gone} of {risen} m left");
    }
}

#[test]
fn what_is_missing_from_the_ground_is_what_rivers_carry_to_the_border() {
    let domain = Domain::new(Size { columns: 64, rows: 48 }, 200.0);
    let conditions = Conditions { deposition: 1.0, creep: 0.0, ..conditions(domain.size, 20_000.0) };
    let mut evolution = evolved(&domain, &conditions, 40);
    let mut before = evolution.heights.clone();
    let counted = evolution.step(&conditions).outgoing;
    // The flux along the rivers, gathered anew, at the cells where they end.
    for (cell, before) in before.iter_mut().enumerate() {
        *before = if before.is_finite() { evolution.raised[cell] - evolution.heights[cell] } else { 0.0 };
    }
    for &cell in &evolution.order.downstream {
        let (cell, receiver) = (cell as usize, evolution.receivers.of[cell as usize] as usize);
        before[receiver] += if receiver == cell { 0.0 } else { before[cell] };
    }
    let ends = evolution.mesh.inner().filter(|&cell| evolution.base[cell]);
    let out: f64 = ends.map(|cell| before[cell]).sum();
    assert!((out / counted - 1.0).abs() < 1e-6, "{out} m at the border for {counted} m");
}

#[test]
fn rivers_answer_to_faster_uplift_after_their_response_time() {
    let domain = Domain::new(Size { columns: 60, rows: 60 }, 300.0);
    let mut evolution = evolved(&domain, &conditions(domain.size, 50_000.0), 600);
    let start = evolution.heights.clone();
    let (years, steps) = (1_000.0, 300);
    let faster = Conditions {
        uplift: Field::filled(domain.size, (2.0 * UPLIFT * years) as f32),
        ..conditions(domain.size, years)
    };
    for _ in 0..steps {
        evolution.step(&faster);
    }
    // n = 1: news of the base level comes upstream at K A^m, and until then a cell rises by all of the added uplift.
    let mut response = vec![0.0; start.len()];
    for &cell in evolution.order.downstream.iter().rev() {
        let (cell, receiver) = (cell as usize, evolution.receivers.of[cell as usize] as usize);
        if receiver != cell {
            let length = 1.0 / f64::from(evolution.receivers.inverse[cell]);
            response[cell] = response[receiver] + length / (ERODIBILITY * evolution.area[cell].sqrt());
        }
    }
    let passed = years * f64::from(steps);
    let (mut off, mut all) = (0.0, 0.0);
    for cell in evolution.mesh.inner() {
        let expected = UPLIFT * response[cell].min(passed);
        off += (evolution.heights[cell] - start[cell] - expected).abs();
        all += expected;
    }
    // The scheme is of first order: where news has just come the bend in a river is a bow some cells long.
    assert!(all > 1e4 && off < 0.08 * all, "{off} m off of {all} m");
    let late = response.iter().filter(|&&time| time > passed).count();
    assert!(late > 300, "{late} cells have not heard of it");
}

#[test]
fn rivers_run_through_lakes_and_cut_their_outlets() {
    let domain = Domain::new(Size { columns: 40, rows: 30 }, 100.0);
    // A bowl, 30 m deep, in a plain that falls to the east.
    let bowl =
        |x: f64, y: f64| 100.0 - x - (30.0 - 2.0 * ((x - 20.0).powi(2) + (y - 15.0).powi(2)).sqrt()).max(0.0);
    let heights: Vec<f64> = (0..1200).map(|cell| bowl((cell % 40) as f64, (cell / 40) as f64)).collect();
    let mut evolution = Evolution::new(&domain, &heights, Mesh::new(&domain, 0.5, 1), |_, _| true);
    let deepest = |evolution: &mut Evolution| evolution.lake_depths(None).into_iter().fold(0.0, f64::max);
    let before = deepest(&mut evolution);
    assert!((14.0..16.0).contains(&before), "{before} m");
    let still = Conditions { uplift: Field::filled(domain.size, 0.0), ..conditions(domain.size, 1000.0) };
    evolution.step(&still);
    let floor = domain.size.index(20, 15);
    assert_eq!(evolution.heights()[floor], heights[floor], "the floor of the lake is under water");
    let mut all = evolution.area.clone();
    all.retain(|area| *area > 0.0);
    let ends = evolution.mesh.inner().filter(|&cell| evolution.base[cell]);
    let drained: f64 = ends.map(|cell| evolution.area[cell]).sum();
    assert!((drained - 1200.0 * 1e4).abs() < 1e-3, "all land drains to the border: {drained} m²");
    for _ in 0..400 {
        evolution.step(&still);
    }
    let after = deepest(&mut evolution);
    assert!(after < 0.8 * before, "the outlet is cut: {after} m left of {before} m");
}

#[test]
fn rivers_fill_lakes_and_the_sea_up_to_their_level_where_they_enter() {
    let domain = Domain::new(Size { columns: 60, rows: 40 }, 100.0);
    let slope: Vec<f64> = (0..2400).map(|cell| 60.0 - 3.0 * (cell % 60) as f64).collect();
    let mut evolution = Evolution::new(&domain, &slope, Mesh::new(&domain, 0.7, 1), |_, _| true);
    let uplift = Field::from_function(domain.size, |x, _| if x < 15 { 5.0 } else { 0.0 });
    let conditions =
        Conditions { uplift, sea_level: Some(0.0), settling: 300.0, ..conditions(domain.size, 5_000.0) };
    for _ in 0..100 {
        evolution.step(&conditions);
    }
    let heights = evolution.heights();
    let sea = (0..2400).filter(|&cell| slope[cell] < 0.0 && cell % 60 < 59);
    let grown: Vec<_> = sea.filter(|&cell| heights[cell] > slope[cell] + 0.5).collect();
    assert!(grown.len() > 50, "{} cells of delta", grown.len());
    let mean = |from: usize, to: usize| {
        let cells = (0..2400).filter(|cell| (from..to).contains(&(cell % 60)));
        cells.clone().map(|cell| heights[cell] - slope[cell]).sum::<f64>() / cells.count() as f64
    };
    assert!(
        mean(22, 30) > 4.0 * mean(50, 58).max(0.0),
        "near the coast {}, far {}",
        mean(22, 30),
        mean(50, 58)
    );
}

#[test]
fn one_sweep_downstream_finds_in_lakes_and_sea_what_sweeps_over_the_rivers_find() {
    let domain = Domain::new(Size { columns: 60, rows: 40 }, 100.0);
    let conditions = Conditions {
        sea_level: Some(0.3),
        lakes_fill: true,
        settling: 500.0,
        ..conditions(domain.size, 20_000.0)
    };
    // So little that rivers lay down nothing to speak of, and yet all sweeps are made.
    let swept = Conditions { deposition: 1e-30, ..conditions.clone() };
    let [once, swept] = [conditions, swept].map(|conditions| evolved(&domain, &conditions, 30).heights());
    let off = once.iter().zip(&swept).map(|(once, swept)| (once - swept).abs()).fold(0.0, f64::max);
    let highest = once.iter().copied().fold(0.0, f64::max);
    assert!(highest > 100.0 && off < 1e-5, "{off} m off on ground of {highest} m");
}

#[test]
fn what_has_no_data_is_a_border_and_stays_out_of_everything() {
    let size = Size { columns: 50, rows: 40 };
    let round =
        (0..size.cells()).map(|cell| (cell % 50).abs_diff(25).pow(2) + (cell / 50).abs_diff(20).pow(2) < 300);
    let round: Vec<bool> = round.collect();
    let domain = Domain { valid: Mask::new(size, round.clone()), ..Domain::new(size, 200.0) };
    let evolution = evolved(&domain, &conditions(size, 50_000.0), 100);
    let heights = evolution.heights();
    assert!((0..size.cells()).all(|cell| heights[cell].is_finite() == round[cell]));
    let ends =
        evolution.mesh.inner().filter(|&cell| evolution.base[cell] && evolution.heights[cell].is_finite());
    let drained: f64 = ends.map(|cell| evolution.area[cell]).sum();
    let land = round.iter().filter(|&&land| land).count() as f64 * domain.cell_area();
    assert!((drained / land - 1.0).abs() < 1e-12, "{drained} of {land} m²");
}

#[test]
fn rivers_leave_over_the_border_that_is_open_and_the_others_rise() {
    let domain = Domain::new(Size { columns: 50, rows: 40 }, 200.0);
    let mesh = Mesh::new(&domain, 0.7, 1);
    let mut evolution = Evolution::new(&domain, &rough(&domain), mesh, |x, _| x == 0);
    for _ in 0..200 {
        evolution.step(&conditions(domain.size, 20_000.0));
    }
    let west: f64 = (0..40).map(|y| evolution.area[(y + 1) * 52 + 1]).sum();
    assert!((west - 2000.0 * domain.cell_area()).abs() < 1e-3, "all land drains to the west: {west} m²");
    let heights = evolution.heights();
    let column = |x: usize| (0..40).map(|y| heights[domain.size.index(x, y)]).sum::<f64>() / 40.0;
    assert!(
        column(0).abs() < 1.0 && column(49) > 2.0 * column(10),
        "{} {} {}",
        column(0),
        column(10),
        column(49)
    );
}

#[test]
fn nothing_stands_steeper_than_the_critical_slope_and_creep_rounds_ridges() {
    let domain = Domain::new(Size { columns: 60, rows: 60 }, 30.0);
    let slow = Conditions { critical: 0.6, hillslope_area: 20_000.0, ..conditions(domain.size, 20_000.0) };
    let steep = evolved(&domain, &slow, 300);
    let steepest = slopes(&steep).into_iter().map(|(slope, ..)| slope).fold(0.0, f64::max);
    assert!((0.5999..0.6001).contains(&steepest), "{steepest}");
    let curved = |evolution: &Evolution| {
        let heights = &evolution.heights;
        let inner = evolution.mesh.inner().filter(|&cell| !evolution.base[cell]);
        inner
            .map(|cell| (heights[cell - 1] + heights[cell + 1] - 2.0 * heights[cell]).min(0.0).abs())
            .sum::<f64>()
    };
    let rounded = evolved(&domain, &Conditions { creep: 0.05 * 20_000.0, ..slow }, 300);
    assert!(curved(&rounded) < 0.8 * curved(&steep), "{} of {}", curved(&rounded), curved(&steep));
}

#[test]
fn each_cell_stands_at_its_own_talus_and_nowhere_above_the_critical_slope() {
    let domain = Domain::new(Size { columns: 60, rows: 60 }, 30.0);
    let talus = |x: usize| [0.2, 0.4, 2.0][x / 20];
    let slow = Conditions {
        critical: 0.6,
        taluses: Some(Field::from_function(domain.size, |x, _| talus(x))),
        hillslope_area: 20_000.0,
        ..conditions(domain.size, 20_000.0)
    };
    let evolution = evolved(&domain, &slow, 300);
    let mut steepest = [0.0_f64; 3];
    for (slope, _, cell) in slopes(&evolution) {
        let third = &mut steepest[(cell % evolution.mesh.stride - 1) / 20];
        *third = third.max(slope);
    }
    for (found, expected) in steepest.into_iter().zip([0.2, 0.4, 0.6]) {
        assert!((found - expected).abs() < 1e-4, "{steepest:?}");
    }
}

#[test]
fn ranges_with_creep_are_as_high_on_cells_half_as_long() {
    let mean_height = |side: usize| {
        let cell = 12_800.0 / side as f64;
        let domain = Domain::new(Size { columns: side, rows: side }, cell);
        let conditions = Conditions {
            hillslope_area: 50_000.0,
            creep: 0.03 * 50_000.0,
            critical: 1.0,
            ..conditions(domain.size, 50_000.0)
        };
        let heights = evolved(&domain, &conditions, 200).heights();
        heights.iter().sum::<f64>() / heights.len() as f64
    };
    // With soil that stays in rivers they are 278 and 300 m high.
    let [coarse, fine] = [128, 256].map(mean_height);
    assert!((coarse / fine - 1.0).abs() < 0.05, "{coarse} and {fine} m");
}

#[test]
fn what_creeps_into_rivers_leaves_with_them() {
    let domain = Domain::new(Size { columns: 64, rows: 48 }, 100.0);
    let conditions =
        Conditions { hillslope_area: 50_000.0, creep: 400.0, ..conditions(domain.size, 20_000.0) };
    let mut evolution = evolved(&domain, &conditions, 100);
    let before: f64 = evolution.heights().iter().sum();
    let Volumes { uplifted, outgoing } = evolution.step(&conditions);
    let after: f64 = evolution.heights().iter().sum();
    assert!((before + uplifted - outgoing - after).abs() < 1e-7 * before, "nothing is lost");
    let rivers = evolution.mesh.inner().filter(|&cell| evolution.area[cell] > 50_000.0);
    let slopes = evolution.mesh.inner().filter(|&cell| evolution.area[cell] <= 50_000.0);
    let carried: f64 = rivers.map(|cell| evolution.crept[cell]).sum();
    assert!(carried > 0.01 * uplifted, "{carried} of {uplifted} m");
    assert!(slopes.into_iter().all(|cell| evolution.crept[cell] == 0.0));
}

/// Soil that would take 1.3e7 passes on these cells lies flat after hundreds or thousands, whether all, some or no cells are rivers.
#[test]
fn ground_that_has_crept_flat_is_left_to_lie() {
    let domain = Domain::new(Size { columns: 9, rows: 7 }, 0.05);
    let ground: Vec<f64> = rough(&domain).iter().map(|height| 900.0 + height).collect();
    for river_from in [0.0, 0.02, f64::INFINITY] {
        let Evolution { mesh, mut heights, mut spare, base, mut area, mut crept, .. } =
            Evolution::new(&domain, &ground, Mesh::new(&domain, 0.7, 1), |_, _| false);
        let before: f64 = mesh.inner().map(|cell| heights[cell]).sum();
        area.iter_mut().enumerate().for_each(|(cell, area)| *area = 0.01 * (cell % 5) as f64);
        let slopes = Slopes { mesh: &mesh, base: &base, area: &area, river_from };
        let passes = slopes.creep(1e4, (&mut heights, &mut spare), &mut crept);
        let (lowest, highest) = mesh.inner().fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), cell| {
            (low.min(heights[cell]), high.max(heights[cell]))
        });
        assert!(highest - lowest < 1e-9, "rivers from {river_from} m2: {lowest} to {highest} m");
        let after: f64 = mesh.inner().map(|cell| heights[cell] + crept[cell]).sum();
        assert!((after - before).abs() < 1e-9, "rivers from {river_from} m2: {} m", after - before);
        assert!(passes < 5_000, "rivers from {river_from} m2: {passes}");
    }
}

/// Slope over area in logarithms, by least squares.
fn steepness_exponent(evolution: &Evolution) -> f64 {
    let [mut n, mut x, mut y, mut xx, mut xy] = [0.0; 5];
    for (slope, area, _) in slopes(evolution).into_iter().filter(|&(slope, ..)| slope > 0.0) {
        let (a, s) = (area.ln(), slope.ln());
        (n, x, y, xx, xy) = (n + 1.0, x + a, y + s, xx + a * a, xy + a * s);
    }
    (n * xy - x * y) / (n * xx - x * x)
}

/// By hand, for `CORRECTNESS.md`: `cargo test --release -p weald-land --lib steepness -- --ignored --nocapture`.
#[test]
#[ignore = "two minutes"]
fn the_steepness_exponent_of_two_thousand_cells_a_side_is_that_of_the_law() {
    let domain = Domain::new(Size { columns: 2048, rows: 2048 }, 100.0);
    let evolution = evolved(&domain, &conditions(domain.size, 100_000.0), 300);
    let theta = -steepness_exponent(&evolution);
    println!("steepness exponent {theta}");
    assert!((theta - 0.5).abs() < 0.02, "{theta}");
}

//! Rivers wider than a cell: the `fluvial` step makes them as wide as their discharge asks for, on fine and coarse cells.

use weald_core::Landscape;
use weald_core::parameter::Nested;
use weald_land::erode::fluvial_step::Fluvial;
use weald_land::erode::springs::Source;

use crate::common::field;
use crate::fluvial::{land, run, square};

/// Cells along the sides of the ground.
const SIDE: usize = 128;

/// Where along a valley the width is measured, as cells from the middle: far from the edge, whose base level pends water up.
const REACH: std::ops::Range<f64> = -4.0..24.0;

/// Over a bed with the section of a parabola discharge goes with the power 3/2 of depth. All of it flows as it does in the mean,
/// `(∫q)² / ∫q²`, through `(3π/16)² / (16/35)` of the width.
const MEAN_WIDTH: f64 = 0.759;

/// East and north, for an azimuth clockwise from north.
fn direction(azimuth_deg: f64) -> [f64; 2] {
    [libm::sin(azimuth_deg.to_radians()), libm::cos(azimuth_deg.to_radians())]
}

/// A valley that falls by a hundredth towards an azimuth.
fn valley(cell: f64, azimuth_deg: f64) -> Landscape {
    let [east, north] = direction(azimuth_deg);
    let place = |at: usize| (at as f64 + 0.5 - 0.5 * SIDE as f64) * cell;
    land(square(SIDE), cell, |x, y| {
        let [x, y] = [place(x), -place(y)];
        100.0 - 0.01 * (x * east + y * north) + 0.2 * (x * north - y * east).abs()
    })
}

/// Three centuries of floods of a river that springs at its upper end.
fn flood((cell, azimuth_deg, discharge): (f64, f64, f64), lateral_wear: f64) -> Fluvial {
    let [east, north] = direction(azimuth_deg);
    let [x, y] = [0.5 - 0.35 * east, 0.5 + 0.35 * north].map(|share| share * cell * SIDE as f64);
    Fluvial {
        sources: vec![Nested(Source { x, y, radius: 15.0, discharge })],
        rain: 0.0,
        duration: 300.0,
        flow_time: 2.0,
        lateral_wear,
        ..Fluvial::default()
    }
}

fn carved(cell: f64, azimuth_deg: f64, discharge: f64, lateral_wear: f64) -> Landscape {
    let mut land = valley(cell, azimuth_deg);
    run(&flood((cell, azimuth_deg, discharge), lateral_wear), &mut land);
    land
}

/// How wide the river is in the mean of a reach, in metres, where its bed is a parabola.
fn width(land: &Landscape, azimuth_deg: f64) -> f64 {
    let cell = land.domain.cell;
    let [east, north] = direction(azimuth_deg);
    let place = |at: usize| at as f64 + 0.5 - 0.5 * SIDE as f64;
    let (mut sum, mut squares) = (0.0, 0.0);
    for (x, y) in (0..SIDE * SIDE).map(|at| (at % SIDE, at / SIDE)) {
        if REACH.contains(&(place(x) * east - place(y) * north)) {
            let [a, b] = ["flux_x", "flux_y"].map(|name| f64::from(field(land, name).at(x, y)) / cell);
            let discharge = a.hypot(b);
            sum += discharge * cell * cell;
            squares += discharge * discharge * cell * cell;
        }
    }
    sum * sum / squares / ((REACH.end - REACH.start) * cell) / MEAN_WIDTH
}

#[test]
fn a_river_is_as_wide_as_its_discharge_asks_for_on_fine_and_coarse_cells_at_every_angle() {
    let wear = Fluvial::default().lateral_wear;
    // In two cells of 5 m, as it would be without, none is within a fifth.
    let rivers = [(5.0, 90.0, 64.0), (5.0, 135.0, 64.0), (5.0, 112.5, 36.0), (10.0, 112.5, 64.0)];
    for (cell, azimuth_deg, discharge) in rivers {
        let found = width(&carved(cell, azimuth_deg, discharge, wear), azimuth_deg);
        let asked = Fluvial::default().channel_width * discharge.sqrt();
        println!("{discharge} m³/s at {azimuth_deg}° in cells of {cell} m: {found:.1} m wide, not {asked}");
        assert!(
            (found / asked - 1.0).abs() < 0.2,
            "{discharge} m³/s in cells of {cell} m: {found} m, not {asked}"
        );
    }
}

#[test]
fn a_river_that_only_cuts_down_is_as_narrow_as_its_cells() {
    // Between two cells, it runs in both.
    for cell in [20.0, 10.0] {
        let found = MEAN_WIDTH * width(&carved(cell, 90.0, 64.0, 0.0), 90.0);
        assert!((found / (2.0 * cell) - 1.0).abs() < 0.1, "{found} m wide in cells of {cell} m");
    }
}

#[test]
fn a_wide_river_leaves_over_an_edge_that_neither_sinks_nor_fills_for_its_banks() {
    // The lowest ground is a hole elsewhere: what leaves falls far.
    let change_of_border = |lateral_wear: f64| {
        let mut land = valley(10.0, 90.0);
        let hole = field(&land, "height").at(0, 0) - 60.0;
        let mut before = field(&land, "height").clone();
        before.set(0, 0, hole);
        land.insert("height", "m", before.clone());
        run(&flood((10.0, 90.0, 64.0), lateral_wear), &mut land);
        let change = |y: usize| f64::from(field(&land, "height").at(SIDE - 1, y) - before.at(SIDE - 1, y));
        (0..SIDE).map(change).collect::<Vec<_>>()
    };
    let [without, with] = [0.0, Fluvial::default().lateral_wear].map(change_of_border);
    let apart = without.iter().zip(&with).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("the border changes by {apart} m more or less");
    assert!(apart < 0.2, "the border changes by {apart} m more or less for the wear of banks");
}

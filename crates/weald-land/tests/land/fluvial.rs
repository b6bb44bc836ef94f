//! The `fluvial` step against closed forms, symmetries and budgets, and against itself on other grids.

use weald_core::grid::Field;
use weald_core::parameter::LayerName;
use weald_core::{Domain, Landscape, Size};
use weald_engine::{Budget, Job, step::Step};
use weald_land::erode::fluvial_step::Fluvial;
use weald_land::erode::hydraulic::Boundary;

use crate::common::{field, rough};

const GRAVITY: f64 = 9.81;

/// A landscape of cells of that many metres.
pub(crate) fn land(size: Size, cell: f64, height: impl Fn(usize, usize) -> f64) -> Landscape {
    let mut land = Landscape::new(Domain::new(size, cell));
    land.insert("height", "m", Field::from_function(size, |x, y| height(x, y) as f32));
    land
}

pub(crate) fn square(side: usize) -> Size {
    Size::new(side, side).expect("small")
}

pub(crate) fn run(step: &Fluvial, land: &mut Landscape) -> Budget {
    let outcome = step.run(land, &Job::unwatched(1)).expect("it runs");
    assert_eq!(outcome.notes, Vec::<String>::new());
    outcome.budget.expect("a simulation has a budget")
}

/// A flood over ground that stays as it is.
pub(crate) fn water_alone() -> Fluvial {
    Fluvial { duration: 0.0, ..Fluvial::default() }
}

/// Sine and cosine of an angle in degrees.
fn direction(degrees: f64) -> [f64; 2] {
    [libm::cos(degrees.to_radians()), libm::sin(degrees.to_radians())]
}

/// Distance from a place to the edge of a square, against a direction.
fn upslope([x, y]: [f64; 2], [east, south]: [f64; 2], side: f64) -> f64 {
    let along = |at: f64, step: f64| {
        if step > 1e-9 {
            at / step
        } else if step < -1e-9 {
            (at - side) / step
        } else {
            f64::INFINITY
        }
    };
    along(x, east).min(along(y, south))
}

#[test]
fn a_sheet_on_a_plane_has_the_discharge_depth_and_direction_of_the_closed_form_at_every_angle() {
    const SIDE: usize = 60;
    let (cell, slope) = (10.0, 0.05);
    // Channels so wide that the sheet takes all of the width.
    let step = Fluvial {
        rain: 200.0,
        flow_time: 0.7,
        deepest: 0.5,
        channel_width: 1000.0,
        boundary: Boundary::Closed,
        ..water_alone()
    };
    for degrees in [0.0, 10.0, 22.5, 35.0, 45.0, 67.5] {
        let [east, south] = direction(degrees);
        // Walls above, and below a trench that takes all water in.
        let mut land = land(square(SIDE), cell, |x, y| {
            let trench = if x.max(y) + 3 > SIDE { 900.0 } else { 0.0 };
            1000.0 - slope * cell * (x as f64 * east + y as f64 * south) - trench
        });
        run(&step, &mut land);
        let mut through = [0.0; 2];
        let (mut discharges, mut depths) = (Vec::new(), Vec::new());
        let half = SIDE as f64 / 2.0;
        for at in 0..SIDE * SIDE {
            let (x, y) = (at % SIDE, at / SIDE);
            let place = [x as f64 + 0.5, y as f64 + 0.5];
            if (place[0] - half).hypot(place[1] - half) > 0.6 * half {
                continue;
            }
            let flux = ["flux_x", "flux_y"].map(|name| f64::from(field(&land, name).at(x, y)) / cell);
            let discharge = flux[0].hypot(flux[1]);
            let depth = (step.friction.max(slope) * discharge * discharge / (GRAVITY * slope)).cbrt();
            through = [through[0] + flux[0], through[1] + flux[1]];
            let rain = step.rain / 3.6e6 * cell * upslope(place, [east, south], SIDE as f64);
            discharges.push(discharge / rain);
            depths.push(f64::from(field(&land, "water").at(x, y)) / depth);
        }
        let off = libm::atan2(through[1], through[0]).to_degrees() - degrees;
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let (discharge, depth) = (mean(&discharges), mean(&depths));
        println!("{degrees}°: off by {off:.2}°, discharge {discharge:.4}, depth {depth:.4}");
        assert!(off.abs() < 0.2, "at {degrees}° water runs {off}° off the fall line");
        assert!((discharge - 1.0).abs() < 0.03, "discharge is {discharge} of rain times area");
        assert!((depth - 1.0).abs() < 0.02, "depth is {depth} of the closed form");
    }
}

#[test]
fn a_channel_of_one_cell_runs_as_easily_at_every_angle() {
    const SIDE: usize = 81;
    let (cell, slope) = (20.0, 0.02);
    let step = Fluvial {
        rain: 2000.0,
        flow_time: 0.8,
        deepest: 4.0,
        boundary: Boundary::Closed,
        region: Some(LayerName::of("channel")),
        ..water_alone()
    };
    let mut ratios = Vec::new();
    for degrees in [0.0, 5.0, 10.0, 15.0, 22.5, 26.565, 30.0, 35.0, 40.0, 45.0] {
        let [east, south] = direction(degrees);
        // At its end a shaft takes all water in.
        let mut land = land(square(SIDE), cell, |x, y| {
            let shaft = if x + 5 > SIDE { 900.0 } else { 0.0 };
            1000.0 - slope * cell * (x as f64 * east + y as f64 * south) - shaft
        });
        // One cell a column: neighbours by their sides or their corners.
        let line = |x: usize, y: usize| y == (x as f64 * south / east).round() as usize;
        let channel = Field::from_function(square(SIDE), |x, y| f32::from(u8::from(line(x, y))));
        land.insert("channel", "1", channel);
        run(&step, &mut land);
        let rain = step.rain / 3.6e6;
        let (mut volume, mut expected) = (0.0, 0.0);
        // All but the ends, where water is pent up or falls.
        for x in 5..SIDE - 20 {
            let y = (x as f64 * south / east).round() as usize;
            volume += f64::from(field(&land, "water").at(x, y)) * cell * cell;
            let discharge = rain * cell * cell * (x + 1) as f64;
            let width = step.channel_width * discharge.sqrt();
            let speed = (GRAVITY * slope * discharge / width.min(cell) / step.friction.max(slope)).cbrt();
            expected += discharge / speed * cell / east;
        }
        println!("{degrees}°: holds {:.3} of the closed form", volume / expected);
        ratios.push(volume / expected);
    }
    let (least, most) = ratios.iter().fold((f64::MAX, 0.0_f64), |(a, b), &r| (a.min(r), b.max(r)));
    assert!(least > 0.93 && most < 1.07, "water stands {least} to {most} times as deep as it should");
}

/// A flood that changes rough ground of ten metres in a short time.
fn wild() -> Fluvial {
    Fluvial { duration: 2000.0, flow_time: 0.5, rain: 100.0, deepest: 1.0, ..Fluvial::default() }
}

#[test]
fn nothing_is_lost_and_nothing_negative_in_thousands_of_steps() {
    for boundary in [Boundary::Closed, Boundary::Open] {
        let ground = rough(48, 40, 60.0, 3);
        let mut land = land(ground.size(), 5.0, |x, y| f64::from(ground.at(x, y)));
        let budget = run(&Fluvial { boundary, ..wild() }, &mut land);
        let eroded: f64 = field(&land, "erosion").values().iter().map(|&e| f64::from(e) * 25.0).sum();
        assert!(eroded > 1000.0, "nothing moved, so a closed budget would mean nothing: {eroded} m³");
        let lost = budget.solid.lost() / eroded;
        println!("{boundary:?}: water {:.1e}, solid {lost:.1e} of {eroded:.0} m³", budget.water.error());
        assert!(budget.water.error().abs() < 1e-5, "{:?}", budget.water);
        assert!(lost.abs() < 1e-5, "{lost:e} of what moved is missing: {:?}", budget.solid);
        assert_eq!(budget.water.outgoing > 0.0, boundary == Boundary::Open);
        for layer in ["water", "sediment"] {
            let least = field(&land, layer).range(None).expect("cells").0;
            assert!(least >= 0.0, "{layer} is {least} m somewhere");
        }
    }
}

#[test]
fn discharge_on_steep_ground_comes_to_rest() {
    // Friction ends a flow within a small part of a step there.
    let fluxes = |steps: u32| -> Vec<f64> {
        let bumps = rough(48, 48, 60.0, 2);
        let mut land = land(square(48), 40.0, |x, y| 12.0 * x as f64 + f64::from(bumps.at(x, y)));
        run(&Fluvial { steps: Some(steps), mean_over: Some(1), ..water_alone() }, &mut land);
        let along = ["flux_x", "flux_y"].map(|layer| field(&land, layer).clone());
        along.iter().flat_map(|flux| flux.values().iter().map(|&value| f64::from(value))).collect()
    };
    let [before, after] = [600, 601].map(fluxes);
    let squares = |values: &mut dyn Iterator<Item = f64>| values.map(|value| value * value).sum::<f64>();
    let changed = squares(&mut before.iter().zip(&after).map(|(a, b)| b - a));
    let change = (changed / squares(&mut after.iter().copied())).sqrt();
    println!("discharge changes by {change} of itself in a step");
    assert!(change < 0.02, "discharge changes by {change} of itself in a step");
}

#[test]
fn a_lake_at_rest_stays_at_rest() {
    // Multiples of 1/64 m, so that ground and depth add up to the level without rounding.
    let bowl = |x: usize, y: usize| ((x as i64 - 16).pow(2) + (y as i64 - 16).pow(2)) as f64 / 16.0;
    let mut land = land(square(33), 1.0, bowl);
    let depth = Field::from_function(square(33), |x, y| (10.0 - bowl(x, y)).max(0.0) as f32);
    land.insert("depth", "m", depth.clone());
    let before = field(&land, "height").clone();
    let still = Fluvial { rain: 0.0, creep: 0.0, talus: 100.0, boundary: Boundary::Closed, ..wild() };
    run(&Fluvial { initial_water: Some(LayerName::of("depth")), ..still }, &mut land);
    assert_eq!(field(&land, "height").values(), before.values());
    assert_eq!(field(&land, "water").values(), depth.values());
}

#[test]
fn evaporation_lowers_a_lake_by_its_rate_and_stands_in_the_budget() {
    let bowl = |x: usize, y: usize| ((x as i64 - 16).pow(2) + (y as i64 - 16).pow(2)) as f64 / 16.0;
    let mut land = land(square(33), 1.0, bowl);
    let depth = Field::from_function(square(33), |x, y| (10.0 - bowl(x, y)).max(0.0) as f32);
    land.insert("depth", "m", depth.clone());
    // Half a metre in all.
    let dry = Fluvial { rain: 0.0, evaporation: 10_000.0, flow_time: 0.05, ..water_alone() };
    let step = Fluvial { initial_water: Some(LayerName::of("depth")), boundary: Boundary::Closed, ..dry };
    let budget = run(&step, &mut land);
    let left = field(&land, "water");
    let sunk = f64::from(depth.at(16, 16) - left.at(16, 16));
    println!("the lake sinks by {sunk} m; {:?}", budget.water);
    assert!((sunk / 0.5 - 1.0).abs() < 0.01, "the lake sinks by {sunk} m");
    assert!(left.range(None).expect("cells").0 >= 0.0, "no depth is negative");
    assert!((budget.water.outgoing / (depth.sum() - left.sum()) - 1.0).abs() < 1e-4, "{:?}", budget.water);
    assert!(budget.water.error().abs() < 1e-6, "{:?}", budget.water);
}

#[test]
fn ground_that_is_turned_or_mirrored_becomes_what_it_became_turned_or_mirrored() {
    const SIDE: usize = 40;
    let ground = rough(SIDE, SIDE, 60.0, 5);
    let after = |place: &dyn Fn(usize, usize) -> [usize; 2]| {
        let mut land = land(square(SIDE), 5.0, |x, y| {
            let [x, y] = place(x, y);
            f64::from(ground.at(x, y))
        });
        // Few steps: water that divides on a ridge decides by the last digit, and ground follows it.
        run(&Fluvial { flow_time: 0.03, duration: 60.0, ..wild() }, &mut land);
        land
    };
    let plain = after(&|x, y| [x, y]);
    let last = SIDE - 1;
    let turns: [&dyn Fn(usize, usize) -> [usize; 2]; 3] =
        [&|x, y| [y, last - x], &|x, y| [last - x, y], &|x, y| [y, x]];
    for turn in turns {
        let turned = after(turn);
        let (mut worst, mut moved) = (0.0_f32, 0.0_f32);
        for at in 0..SIDE * SIDE {
            let [x, y] = turn(at % SIDE, at / SIDE);
            let change = field(&plain, "height").at(x, y) - ground.at(x, y);
            let change_turned = field(&turned, "height").at(at % SIDE, at / SIDE) - ground.at(x, y);
            worst = worst.max((change - change_turned).abs());
            moved = moved.max(change.abs());
        }
        assert!(moved > 0.1 && worst < 1e-3 * moved, "{worst} m apart where up to {moved} m moved");
    }
}

#[test]
fn no_river_digs_below_the_lowest_ground() {
    let ground = rough(64, 64, 600.0, 9);
    let mut land = land(ground.size(), 40.0, |x, y| f64::from(ground.at(x, y)));
    run(&Fluvial { duration: 30_000.0, flow_time: 3.0, ..Fluvial::default() }, &mut land);
    let deepest = field(&land, "erosion").range(None).expect("cells").1;
    let lowest = field(&land, "height").range(None).expect("cells").0;
    assert!(deepest > 5.0, "hardly anything was carved: {deepest} m");
    assert!(lowest >= -0.01, "the ground ends {} m below its lowest start", -lowest);
}

#[test]
fn a_river_digs_its_bed_and_not_that_of_the_deep_lake_it_runs_through() {
    let size = Size::new(90, 16).expect("small");
    // A narrow valley, in which a sill at the 70th column dams a lake up to 80 m deep.
    let along = |x: usize| {
        let steep = 40.0 - 2.0 * (x.min(20)) as f64;
        let bed = if (20..70).contains(&x) { -80.0 * libm::sin((x - 20) as f64 * 0.0628).abs() } else { 0.0 };
        steep + bed - 0.5 * x.saturating_sub(70) as f64
    };
    let valley = |x: usize, y: usize| 100.0 + along(x) + 8.0 * (y as f64 - 7.5).abs();
    let mut land = land(size, 20.0, valley);
    let depth = Field::from_function(size, |x, y| (100.0 - valley(x, y)).max(0.0) as f32);
    land.insert("lake", "m", depth);
    let step = Fluvial {
        // In a century the river cuts the sill down, and the lake runs dry.
        duration: 30.0,
        rain: 4000.0,
        settling: 0.0,
        creep: 0.0,
        slide: 0.0,
        initial_water: Some(LayerName::of("lake")),
        ..Fluvial::default()
    };
    run(&step, &mut land);
    let dug = |columns: std::ops::Range<usize>| {
        let cells = columns.flat_map(|x| (6..10).map(move |y| (x, y)));
        cells.map(|(x, y)| field(&land, "erosion").at(x, y)).fold(0.0, f32::max)
    };
    let (river, lake) = (dug(4..18), dug(35..55));
    println!("the river digs {river} m, under the lake {lake} m");
    assert!(river > 1.0, "the river does not dig: {river} m");
    assert!(lake < 0.01 * river, "the bed of the lake is dug by {lake} m, that of the river by {river} m");
}

#[test]
fn levels_that_do_not_divide_are_refused() {
    let mut land = land(Size::new(36, 30).expect("small"), 5.0, |x, _| x as f64);
    let step = Fluvial { levels: 3, coarsest: 20.0, ..wild() };
    let error = step.run(&mut land, &Job::unwatched(1)).expect_err("30 is no multiple of 4").to_string();
    assert!(error.contains("multiples of 4") && error.contains("36 × 30"), "{error}");
    // Cells twice as long would be too long.
    assert!(Fluvial { coarsest: 9.9, ..step.clone() }.run(&mut land, &Job::unwatched(1)).is_ok());
    let region = Fluvial { region: Some(LayerName::of("land")), ..step };
    assert_eq!(region.faults().len(), 1, "a recipe says so already");
}

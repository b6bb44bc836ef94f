//! Combination: identities, conservation of constants, no-data cells, exact planes.

use proptest::prelude::*;
use weald_core::domain::Georeference;
use weald_core::grid::Mask;
use weald_core::parameter::LayerName;
use weald_core::parameter::Sides;
use weald_core::random::signed2;
use weald_core::{Domain, Field, Landscape, Size};
use weald_engine::Job;
use weald_engine::step::Step;
use weald_land::combine::add::Add;
use weald_land::combine::blend::Blend;
use weald_land::combine::extremes::{Max, Min};
use weald_land::combine::remap::Remap;
use weald_land::combine::resample::Resample;
use weald_land::combine::smooth::Smooth;
use weald_land::combine::terrace::Terrace;

const COLUMNS: usize = 33;
const ROWS: usize = 21;

fn size() -> Size {
    Size::new(COLUMNS, ROWS).expect("small")
}

fn random_field(seed: u64) -> Field {
    Field::from_function(size(), |x, y| 500.0 * signed2(seed, x as i64, y as i64) as f32)
}

/// `height` and `other` at random, `mask` from 0 to 1.
fn landscape() -> Landscape {
    let mut landscape = Landscape::new(Domain::new(size(), 10.0));
    landscape.insert("height", "m", random_field(1));
    landscape.insert("other", "m", random_field(2));
    landscape.insert("mask", "1", Field::from_function(size(), |x, _| x as f32 / (COLUMNS - 1) as f32));
    landscape
}

/// The same with a hole of no-data that holds absurd heights, and a strip of it along the east.
fn landscape_with_holes() -> Landscape {
    let mut landscape = landscape();
    let land = |x: usize, y: usize| !((8..14).contains(&x) && (5..12).contains(&y)) && x < 30;
    let flags = (0..ROWS).flat_map(|y| (0..COLUMNS).map(move |x| land(x, y))).collect();
    let mask = Mask::new(size(), flags).expect("has no-data");
    let mut height = random_field(1);
    for (value, &land) in height.values_mut().iter_mut().zip(mask.flags()) {
        *value = if land { *value } else { -9.0e8 };
    }
    landscape.insert("height", "m", height);
    landscape.domain.valid = Some(mask);
    landscape
}

fn run(step: &dyn Step, mut landscape: Landscape) -> Landscape {
    step.run(&mut landscape, &Job::unwatched(0)).expect("runs");
    landscape
}

fn height(landscape: &Landscape) -> &Field {
    landscape.field("height").expect("there")
}

fn other() -> LayerName {
    LayerName::of("other")
}

#[test]
fn adding_and_taking_away_is_nothing_and_order_does_not_matter() {
    let start = landscape();
    let doubled = run(&Add { with: LayerName::of("height"), ..Add::default() }, start.clone());
    assert!(height(&doubled).values().iter().zip(height(&start).values()).all(|(a, b)| *a == 2.0 * b));
    let nothing = run(&Add { with: LayerName::of("height"), factor: -1.0, ..Add::default() }, start.clone());
    assert!(height(&nothing).values().iter().all(|&value| value == 0.0));
    let there = run(&Add { with: other(), ..Add::default() }, start.clone());
    let back = Add {
        layer: other(),
        with: LayerName::of("height"),
        into: Some(LayerName::of("height")),
        ..Add::default()
    };
    assert_eq!(height(&there), height(&run(&back, start)));
}

#[test]
fn the_higher_and_the_lower_of_two_layers_add_up_to_both() {
    let start = landscape();
    let high = run(&Max { with: other(), ..Max::default() }, start.clone());
    let low = run(&Min { with: other(), ..Min::default() }, start.clone());
    let (a, b) = (height(&start), start.field("other").expect("there"));
    assert_ne!(height(&high), a);
    for index in 0..size().cells() {
        let (high, low) = (height(&high).values()[index], height(&low).values()[index]);
        assert!(high >= low);
        assert_eq!(
            f64::from(high) + f64::from(low),
            f64::from(a.values()[index]) + f64::from(b.values()[index])
        );
    }
}

#[test]
fn a_blend_shows_one_layer_at_mask_0_the_other_at_1_and_stays_between() {
    let start = landscape();
    let step = Blend { with: other(), mask: LayerName::of("mask"), ..Blend::default() };
    let blended = run(&step, start.clone());
    let (a, b) = (height(&start), start.field("other").expect("there"));
    for y in 0..ROWS {
        assert_eq!(height(&blended).at(0, y), a.at(0, y));
        assert_eq!(height(&blended).at(COLUMNS - 1, y), b.at(COLUMNS - 1, y));
        for x in 0..COLUMNS {
            let (low, high) = (a.at(x, y).min(b.at(x, y)), a.at(x, y).max(b.at(x, y)));
            assert!((low - 1e-3..=high + 1e-3).contains(&height(&blended).at(x, y)));
        }
    }
    let same = Blend { with: LayerName::of("height"), mask: LayerName::of("other"), ..Blend::default() };
    let same = run(&same, start.clone());
    assert!(height(&same).values().iter().zip(a.values()).all(|(new, old)| (new - old).abs() < 1e-3));
}

#[test]
fn a_result_goes_where_into_says_with_the_unit_of_its_layer() {
    let step = Min { layer: LayerName::of("mask"), with: other(), into: Some(LayerName::of("low")) };
    let end = run(&step, landscape());
    assert_eq!(end.layer("low").expect("written").unit, "1");
    assert_eq!(height(&end), height(&landscape()), "nothing else changes");
    assert_eq!(step.reads(), ["mask", "other"]);
    assert_eq!(step.writes()[0].0, "low");
}

#[test]
fn remap_takes_its_range_from_cells_with_data_and_reaches_both_ends() {
    let end = run(&Remap { to: vec![-5.0, 20.0], ..Remap::default() }, landscape_with_holes());
    assert_eq!(height(&end).range(end.domain.valid.as_ref()), Some((-5.0, 20.0)));
}

#[test]
fn remap_clamps_bends_and_goes_on_as_it_is_told() {
    let at = |step: Remap, value: f32| {
        let mut landscape = Landscape::new(Domain::new(Size::square(1).expect("small"), 1.0));
        landscape.insert("height", "m", Field::filled(Size::square(1).expect("small"), value));
        assert!(step.faults().is_empty(), "{:?}", step.faults());
        height(&run(&step, landscape)).at(0, 0)
    };
    let line = Remap { from: vec![0.0, 10.0], to: vec![100.0, 200.0], ..Remap::default() };
    assert_eq!(at(line.clone(), 12.0), 200.0);
    assert_eq!(at(Remap { clamp: false, ..line.clone() }, 12.0), 220.0);
    assert_eq!(at(Remap { gamma: 2.0, ..line.clone() }, 5.0), 125.0);
    assert_eq!(at(Remap { curve: vec![0.0, 0.0, 1.0], ..line.clone() }, 5.0), 100.0);
    assert_eq!(at(Remap { curve: vec![0.0, 0.0, 1.0], ..line.clone() }, 7.5), 150.0);
    assert_eq!(at(Remap { to: vec![1.0, 0.0], ..line }, 2.5), 0.75);
    assert_eq!(at(Remap::default(), 7.0), 0.0, "a flat layer has no range of its own");
}

#[test]
fn remap_gives_the_unit_that_it_is_told() {
    let unit = |step: Remap| run(&step, landscape()).layer("height").expect("written").unit.clone();
    assert_eq!(unit(Remap::default()), "m");
    assert_eq!(unit(Remap { unit: Some("1".to_owned()), ..Remap::default() }), "1");
}

#[test]
fn remap_says_what_is_wrong_with_its_lists() {
    let faults = |step: Remap| step.faults().iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
    assert!(faults(Remap { from: vec![2.0, 1.0], ..Remap::default() }).contains("low below high"));
    assert!(faults(Remap { from: vec![2.0], ..Remap::default() }).contains("[2.0]"));
    assert!(faults(Remap { to: vec![], ..Remap::default() }).contains("two numbers"));
    assert!(faults(Remap { curve: vec![1.0], ..Remap::default() }).contains("two or more"));
    assert!(faults(Remap { unit: Some("a\nb".to_owned()), ..Remap::default() }).contains("printable"));
    assert!(faults(Remap { gamma: 2.0, clamp: false, ..Remap::default() }).contains("clamp = true"));
}

#[test]
fn smoothing_keeps_flat_ground_level_to_the_bit() {
    for start in [landscape(), landscape_with_holes()] {
        let mut start = start;
        let level = Field::filled(size(), 1234.567);
        start.insert("height", "m", level.clone());
        let end = run(&Smooth { radius: 47.0, ..Smooth::default() }, start);
        assert_eq!(*height(&end), level);
    }
}

#[test]
fn smoothing_leaves_no_data_alone_and_takes_nothing_from_it() {
    let start = landscape_with_holes();
    let end = run(&Smooth { radius: 25.0, ..Smooth::default() }, start.clone());
    let land = start.domain.valid.clone().expect("has no-data");
    assert_eq!(end.domain, start.domain);
    for index in 0..size().cells() {
        let (before, after) = (height(&start).values()[index], height(&end).values()[index]);
        if land.is_valid_at(index) {
            assert!(after.abs() < 500.0, "no-data leaked: {after}");
        } else {
            assert_eq!(after, before);
        }
    }
    assert_ne!(height(&end), height(&start));
}

#[test]
fn smoothing_turns_a_spike_into_the_gaussian() {
    let size = Size::square(41).expect("small");
    let mut landscape = Landscape::new(Domain::new(size, 10.0));
    let mut spike = Field::filled(size, 0.0);
    spike.set(20, 20, 1000.0);
    landscape.insert("height", "m", spike);
    let end = run(&Smooth { radius: 20.0, ..Smooth::default() }, landscape);
    let peak = height(&end).at(20, 20);
    for (x, y) in [(21, 20), (20, 24), (25, 17), (15, 25)] {
        let squared = ((x as f64 - 20.0).powi(2) + (y as f64 - 20.0).powi(2)) * 100.0;
        let expected = f64::from(peak) * (-squared / (2.0 * 20.0 * 20.0)).exp();
        assert!((f64::from(height(&end).at(x, y)) - expected).abs() < 1e-4 * expected, "at {x}, {y}");
    }
    assert!((height(&end).sum() - 1000.0).abs() < 1e-2, "away from edges nothing is lost");
}

#[test]
fn a_radius_of_nothing_changes_nothing() {
    let end = run(&Smooth { radius: 0.0, ..Smooth::default() }, landscape());
    let differences = height(&end).values().iter().zip(height(&landscape()).values().to_vec());
    assert!(differences.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max) < 1e-4);
}

fn plane(columns: usize, rows: usize, cell: f64) -> Landscape {
    let size = Size::new(columns, rows).expect("small");
    let mut landscape = Landscape::new(Domain::new(size, cell));
    let (dx, dy) = (0.25 * cell as f32, 0.5 * cell as f32);
    let value = |x: usize, y: usize| 64.0 + dx * (x as f32 + 0.5) - dy * (y as f32 + 0.5);
    landscape.insert("height", "m", Field::from_function(size, value));
    landscape.insert("water", "m", Field::filled(size, 2.5));
    landscape
}

fn resample(columns: u32, rows: u32) -> Resample {
    Resample { size: Sides { columns: columns.into(), rows: rows.into() } }
}

#[test]
fn a_plane_stays_the_same_plane_at_any_finer_and_any_whole_times_coarser_resolution() {
    for (columns, rows) in [(64, 32), (32, 16), (128, 64), (16, 8), (8, 4), (48, 24), (96, 48)] {
        let cell = 4.0 * 32.0 / f64::from(columns);
        let end = run(&resample(columns, rows), plane(32, 16, 4.0));
        let expected = plane(columns as usize, rows as usize, cell);
        assert_eq!(end.domain, expected.domain);
        // Two old cells at the edge have no sixteen around them; they are kept within their range instead.
        let edge = if columns > 32 { columns.div_ceil(32) as usize * 2 } else { 0 };
        for y in edge..rows as usize - edge {
            for x in edge..columns as usize - edge {
                let difference = (height(&end).at(x, y) - height(&expected).at(x, y)).abs();
                assert!(difference < 1e-4, "{columns} × {rows} at {x}, {y}: {difference}");
            }
        }
        assert_eq!(end.field("water").expect("all layers come").range(None), Some((2.5, 2.5)));
    }
}

#[test]
fn resampling_carries_the_place_on_earth() {
    let mut start = plane(32, 16, 4.0);
    let georeference =
        Georeference { epsg: Some(32616), origin: [7.0e5, 4.0e6], pixel: [4.0, 4.0], keys: None };
    start.domain.georeference = Some(georeference.clone());
    let end = run(&resample(8, 4), start);
    let expected = Georeference { pixel: [16.0, 16.0], ..georeference };
    assert_eq!(end.domain.georeference, Some(expected), "the corner stays, the cell grows");
}

#[test]
fn resampling_keeps_no_data_out_and_in_its_place() {
    for (columns, rows) in [(66, 42), (11, 7), (33, 21)] {
        let start = landscape_with_holes();
        let end = run(&resample(columns, rows), start);
        let land = end.domain.valid.as_ref().expect("still has no-data");
        let share = land.valid_cells() as f64 / f64::from(columns * rows);
        assert!((share - 0.848).abs() < 0.02, "{columns} × {rows}: {share}");
        let (low, high) = height(&end).range(Some(land)).expect("cells");
        assert!(low > -500.0 && high < 500.0, "no-data leaked: {low} to {high}");
    }
}

#[test]
fn resampling_to_the_same_size_changes_nothing() {
    assert_eq!(run(&resample(COLUMNS as u32, ROWS as u32), landscape()), landscape());
}

#[test]
fn resampling_refuses_to_stretch_the_ground_and_names_the_right_rows() {
    let mut start = plane(32, 16, 4.0);
    let error = resample(64, 64).run(&mut start, &Job::unwatched(0)).expect_err("would stretch");
    assert!(error.to_string().contains("for 64 columns give 32 rows"), "{error}");
    assert_eq!(start, plane(32, 16, 4.0), "nothing has changed");
}

proptest! {
    #[test]
    fn terraces_move_no_point_by_more_than_half_a_step_and_keep_order(
        spacing in 0.01..500.0, softness in 0.0..=1.0,
    ) {
        let size = Size::new(400, 1).expect("small");
        let mut landscape = Landscape::new(Domain::new(size, 1.0));
        landscape.insert("height", "m", Field::from_function(size, |x, _| 3.3 * x as f32 - 600.0));
        let end = run(&Terrace { spacing, softness, ..Terrace::default() }, landscape.clone());
        let (before, after) = (height(&landscape).values(), height(&end).values());
        prop_assert!(after.is_sorted());
        for (a, b) in before.iter().zip(after) {
            prop_assert!(f64::from((a - b).abs()) <= 0.5 * spacing + 1e-3);
        }
    }

    #[test]
    fn resampling_stays_within_the_range_of_what_was_there(
        columns in 1_u32..90, seed: u64,
    ) {
        let rows = (f64::from(columns) * ROWS as f64 / COLUMNS as f64).round().max(1.0) as u32;
        let mut start = landscape();
        start.insert("height", "m", random_field(seed));
        let (low, high) = height(&start).range(None).expect("cells");
        let end = run(&resample(columns, rows), start);
        let (new_low, new_high) = height(&end).range(None).expect("cells");
        prop_assert!(new_low >= low && new_high <= high, "{new_low} to {new_high} of {low} to {high}");
    }
}

//! Cliffs where waves come, beaches where they do not, and what stands against it.

use super::*;
use weald_core::grid::Size;

/// A round island, 80 m high, in a sea 30 m deep, with cells of 20 m.
fn island() -> Landscape {
    let size = Size { columns: 120, rows: 120 };
    let domain = Domain { sea_level: Some(0.0), ..Domain::new(size, 20.0) };
    let mut landscape = Landscape::new(domain);
    let cone = |x, y| {
        let off = ((x as f32 - 59.5).powi(2) + (y as f32 - 59.5).powi(2)).sqrt();
        (80.0 - 2.0 * off).max(-30.0)
    };
    landscape.insert("height", "m", Field::from_function(size, cone));
    landscape
}

/// Cells of land in the quarter of the island that faces west, north, east and south.
fn quarters(landscape: &Landscape, of: impl Fn(f32) -> f64) -> [f64; 4] {
    let field = landscape.field("height").expect("is there");
    let mut sums = [0.0; 4];
    for (y, x) in (0..120).flat_map(|y| (0..120).map(move |x| (y, x))) {
        let (east, south) = (x as f64 - 59.5, y as f64 - 59.5);
        let quarter = if east.abs() > south.abs() {
            usize::from(east > 0.0) * 2
        } else {
            1 + 2 * usize::from(south > 0.0)
        };
        sums[quarter] += of(field.at(x, y));
    }
    sums
}

#[test]
fn a_round_island_under_wind_from_the_west_has_its_cliffs_there_and_beaches_in_the_east() {
    let mut landscape = island();
    let land = |height: f32| f64::from(u8::from(height > 0.0));
    let before = quarters(&landscape, land);
    let outcome = Coast::default().run(&mut landscape, &Job::unwatched(0)).expect("there is a sea");
    let after = quarters(&landscape, land);
    let lost: Vec<f64> = before.iter().zip(after).map(|(before, after)| before - after).collect();
    assert!(
        lost[0] > 200.0 && lost[0] > 2.0 * lost[1].max(lost[3]),
        "west, north, east, south lost {lost:?} cells"
    );
    assert!(lost[2] < 0.0, "the east has gained a beach: {lost:?}");
    assert!((lost[1] - lost[3]).abs() < 0.1 * lost[1], "north and south are alike: {lost:?}");
    let [erosion, deposition] =
        ["erosion", "deposition"].map(|name| landscape.field(name).expect("is written").sum());
    let solid = outcome.budget.expect("is kept").solid;
    assert!((solid.outgoing / 400.0 / (erosion - deposition) - 1.0).abs() < 1e-4, "{} m³", solid.outgoing);
    assert!(solid.error().abs() < 1e-6 && deposition <= 0.3 * erosion * 1.0001, "{solid:?}");
    let height = landscape.field("height").expect("is there");
    let falls: Vec<f32> = (1..40).map(|x| height.at(x, 60) - height.at(x - 1, 60)).collect();
    assert!(falls.iter().all(|fall| *fall >= 0.0), "no bar lies where the coast has been: {falls:?}");
    let exposure = landscape.field("exposure").expect("is written");
    assert!(exposure.at(19, 60) > 0.9 && exposure.at(100, 60) < 0.1, "{}", exposure.at(19, 60));
}

#[test]
fn soft_ground_retreats_further_and_none_at_all_where_nothing_can_be_cut() {
    let mut landscape = island();
    let soft = |_, y| if y < 60 { 4.0 } else { 0.0 };
    landscape.insert("soft", "1", Field::from_function(landscape.domain.size, soft));
    let coast = Coast {
        wind_spread_deg: 10_000.0,
        sand: 0.0,
        erodibility_map: Some(LayerName::of("soft")),
        ..Coast::default()
    };
    let before = quarters(&landscape, |height| f64::from(u8::from(height > 0.0)));
    coast.run(&mut landscape, &Job::unwatched(0)).expect("there is a sea");
    let after = quarters(&landscape, |height| f64::from(u8::from(height > 0.0)));
    assert!(before[1] - after[1] > 200.0, "{before:?} {after:?}");
    assert_eq!(before[3], after[3], "hard ground stands");
}

#[test]
fn without_a_sea_or_a_coast_it_says_so() {
    let mut landscape = island();
    landscape.domain.sea_level = None;
    let refused = Coast::default().run(&mut landscape, &Job::unwatched(0)).expect_err("there is no sea");
    assert!(refused.to_string().contains("sea_level"), "{refused}");
    landscape.domain.sea_level = Some(-500.0);
    let outcome = Coast::default().run(&mut landscape, &Job::unwatched(0)).expect("nothing to do");
    assert!(outcome.notes[0].contains("no coast"), "{:?}", outcome.notes);
}

use super::*;
use weald_core::grid::{Field, Size};
use weald_core::random::{hash2, unit as uniform};

fn ground(height: impl FnMut(usize, usize) -> f32) -> Surface {
    Surface::new(&Field::from_function(Size::new(60, 40).expect("small"), height))
}

fn hills(x: usize, y: usize) -> f32 {
    20.0 * (0.2 * x as f32).sin() * (0.17 * y as f32).cos()
        + 3.0 * uniform(hash2(5, x as i64, y as i64)) as f32
}

#[test]
fn the_ground_goes_on_over_the_border_in_height_and_slope() {
    let bed = ground(hills);
    let around = Surroundings::new(&bed, None);
    for step in 0..200 {
        let along = 0.5 + 40.0 * step as f32 / 200.0;
        for border in [[0.5, along], [60.5, along], [0.5 + 1.5 * (along - 0.5), 40.5]] {
            let (inside, outside) = (bed.with_slope(border), around.at(&bed, border).surface);
            for (a, b) in inside.into_iter().zip(outside) {
                assert!((a - b).abs() < 2e-2, "{border:?}: {inside:?} and {outside:?}");
            }
        }
    }
}

#[test]
fn a_lone_mountain_does_not_stand_again_around_itself_and_even_hills_do() {
    let highest = |bed: &Surface| {
        let around = Surroundings::new(bed, None);
        let places =
            (0..4000).map(|at| [0, 1].map(|seed| 600.0 * uniform(hash2(seed, at, 4)) as f32 - 300.0));
        let far = places.filter(|place| around.leaving(*place).share == 1.0);
        far.map(|place| around.at(bed, place).surface[0]).fold(f32::MIN, f32::max)
    };
    let lone = |x: usize, y: usize| (400.0 - 40.0 * (x as f32 - 30.0).hypot(y as f32 - 20.0)).max(0.0);
    let [lone, hilly] = [highest(&ground(lone)), highest(&ground(hills))];
    assert!(lone < 220.0, "{lone} m of 400");
    assert!(hilly > 10.0, "{hilly} m of 23");
}

#[test]
fn the_rise_beyond_the_border_is_that_of_its_heights() {
    let bed = ground(hills);
    let around = Surroundings::new(&bed, None);
    let height = |place: [f32; 2]| around.at(&bed, place).surface[0];
    let mut compared = 0;
    for step in 0..400 {
        let place = [0, 1].map(|seed| 240.0 * uniform(hash2(seed, step, 3)) as f32 - 90.0);
        if !around.is_beyond(place) {
            continue;
        }
        let Beyond { surface: rise, share, .. } = around.at(&bed, place);
        let [alone, left_behind] = around.height(&bed, place);
        assert!((alone - rise[0]).abs() < 1e-3 && left_behind == share, "{place:?}: {alone} m and {rise:?}");
        let near = 0.02;
        for axis in [0, 1] {
            let moved = |by: f32| std::array::from_fn(|at| place[at] + if at == axis { by } else { 0.0 });
            let expected = (height(moved(near)) - height(moved(-near))) / (2.0 * near);
            assert!((rise[1 + axis] - expected).abs() < 0.1, "{place:?}: {rise:?} instead of {expected}");
        }
        compared += 1;
    }
    assert!(compared > 200);
}

#[test]
fn beds_beyond_the_border_lie_by_the_ground_of_the_place_that_is_seen_there() {
    let bed = ground(hills);
    let around = Surroundings::new(&bed, None);
    let mut off = 0.0_f32;
    for step in 0..400 {
        let place = [0, 1].map(|seed| 240.0 * uniform(hash2(seed, step, 3)) as f32 - 90.0);
        let beyond = around.at(&bed, place);
        assert_eq!(beyond.own, bed.with_slope(beyond.place), "{place:?}");
        off = off.max((beyond.own[0] - beyond.surface[0]).abs());
    }
    assert!(off > 5.0, "it is not the height there, {off} m from it at most");
}

#[test]
fn a_sea_goes_on_where_it_meets_the_border_and_land_where_land_does() {
    // Land in the east, a sea floor in the west.
    let bed = ground(|x, _| if x < 30 { -50.0 } else { 2.0 * (x - 30) as f32 });
    let around = Surroundings::new(&bed, Some(0.0));
    let far = |x: f32| around.at(&bed, [x, 20.0]);
    for away in [15.0, 40.0, 200.0] {
        assert!(far(-away).surface[0] < 0.0, "{:?}", far(-away));
    }
    assert!(far(75.0).surface[0] > 0.0 && around.far_at([400.0, 20.0]).0[0] > 0.0);
    assert!((0..DIRECTIONS).all(|at| around.far[at][0] <= around.bounds[1]));
}

#[test]
fn no_height_is_beyond_its_bounds() {
    let bed = ground(hills);
    for sea in [None, Some(-5.0)] {
        let around = Surroundings::new(&bed, sea);
        let [low, high] = around.bounds;
        let mut far = 0;
        for step in 0..2000 {
            let place = [0, 1].map(|seed| 600.0 * uniform(hash2(seed, step, 9)) as f32 - 270.0);
            let height = around.at(&bed, place).surface[0];
            assert!(height >= low - 1e-3 && height <= high + 1e-3, "{height} outside {low} to {high}");
            let away = [0, 1].map(|axis| place[axis] - place[axis].clamp(0.5, around.cells[axis] + 0.5));
            let HeightsBeyond { highest_far, far_from, .. } = around.heights();
            let is_far = away[0].hypot(away[1]) >= far_from;
            assert!(!is_far || height <= highest_far + 1e-3, "{height} above {highest_far} at {place:?}");
            far += usize::from(is_far);
        }
        assert!(far > 1000 && around.highest_far < high);
    }
}

#[test]
fn a_range_that_rises_from_a_border_of_one_height_stands_in_no_trench_and_no_lake() {
    let inward = |x: usize, y: usize| x.min(y).min(59 - x).min(39 - y) as f32;
    let bed = ground(|x, y| 8.0 + 40.0 * inward(x, y));
    // Dry ground has a level that lies a cell below it.
    let dry = ground(|x, y| 8.0 + 40.0 * inward(x, y) - 20.0);
    let around = Surroundings::new(&bed, None);
    for step in 0..4000 {
        let place = [0, 1].map(|seed| 140.0 * uniform(hash2(seed, step, 11)) as f32 - 40.0);
        if around.is_beyond(place) {
            let of = around.height(&bed, place);
            // Hills far away stand about the border's height, as high and as low as the range about its mean.
            let lowest = 8.0 - (1.0 - of[1]) * NEAR[1] * around.highest - of[1] * around.mean;
            assert!(of[0] > lowest, "{} m at {place:?}", of[0]);
            let level = around.level(&dry, of, place, 20.0);
            assert!(level < of[0], "water {} m deep at {place:?}", level - of[0]);
        }
    }
}

#[test]
fn a_lake_goes_on_over_the_border_and_one_within_does_not_stand_there_again() {
    // Over the western border a lake at 5 m, and one at 50 m ten cells within the eastern one.
    let bed = ground(|x, _| if x < 8 { 0.0 } else { 60.0 });
    let levels = ground(|x, _| match x {
        0..8 => 5.0,
        40..50 => 75.0,
        _ => 40.0,
    });
    let around = Surroundings::new(&bed, None);
    let depth = |place: [f32; 2]| {
        let of = around.height(&bed, place);
        around.level(&levels, of, place, 20.0) - of[0]
    };
    for away in [0.25, 0.5, 1.0] {
        assert!((depth([0.5 - away, 20.0]) - 5.0).abs() < 1.0, "{} m of 5", depth([0.5 - away, 20.0]));
    }
    for away in [1.0, 10.0, 15.0, 20.0] {
        assert!(depth([60.5 + away, 20.0]) < 0.0, "{} m, {away} cells away", depth([60.5 + away, 20.0]));
    }
}

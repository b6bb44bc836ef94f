//! Routing of water over the ground: against plain versions of the same methods, analytic forms, symmetries.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::common::{rough, symmetries};
use proptest::prelude::*;
use weald_core::grid::Mask;
use weald_core::random::{hash2, unit};
use weald_core::{Field, Size};
use weald_land::analyse::directions::{Directions, SEA};
use weald_land::flow::{Depressions, MultipleFlow, Routed, Routing, accumulate, accumulate_multiple, route};

fn filled(height: &Field, valid: Option<&Mask>) -> Routed {
    route(height, valid, &Routing::default())
}

fn breached(height: &Field, valid: Option<&Mask>, deepest_breach: f64) -> Routed {
    route(height, valid, &Routing { depressions: Depressions::Breach, deepest_breach, ..Routing::default() })
}

/// Random cells without data.
pub(crate) fn holes(size: Size, seed: u64, one_in: u64) -> Option<Mask> {
    Mask::new(
        size,
        (0..size.cells()).map(|cell| !hash2(seed, cell as i64, 5).is_multiple_of(one_in)).collect(),
    )
}

fn is_valid(valid: Option<&Mask>, cell: usize) -> bool {
    valid.is_none_or(|valid| valid.is_valid_at(cell))
}

/// Whether water can leave from a cell: it is at the border, or beside a cell without data.
fn at_the_rim(size: Size, valid: Option<&Mask>, cell: usize) -> bool {
    let neighbours = size.neighbours(cell);
    size.neighbours(cell).count() < 8 || neighbours.into_iter().any(|other| !is_valid(valid, other))
}

/// Priority-flood with one queue of cells, straight from the publication.
fn flooded(height: &Field, valid: Option<&Mask>) -> Vec<f32> {
    let size = height.size();
    let whole = |level: f32| if level < 0.0 { !level.to_bits() as i32 } else { level.to_bits() as i32 | i32::MIN } as u32;
    let mut level = height.values().to_vec();
    let mut queue = BinaryHeap::new();
    let mut reached = vec![false; size.cells()];
    for cell in (0..size.cells()).filter(|&cell| is_valid(valid, cell) && at_the_rim(size, valid, cell)) {
        queue.push(Reverse((whole(level[cell]), cell)));
        reached[cell] = true;
    }
    while let Some(Reverse((_, cell))) = queue.pop() {
        for other in size.neighbours(cell) {
            if is_valid(valid, other) && !std::mem::replace(&mut reached[other], true) {
                level[other] = level[other].max(level[cell]);
                queue.push(Reverse((whole(level[other]), other)));
            }
        }
    }
    level
}

/// Every cell's water comes to an end, and no way rises.
pub(crate) fn check_paths(routed: &Routed, valid: Option<&Mask>) {
    let (directions, level) = (&routed.directions, routed.surface.values());
    let size = directions.size();
    Directions::of(&directions.layer(), valid).expect("no cycles");
    for cell in (0..size.cells()).filter(|&cell| is_valid(valid, cell)) {
        match directions.downstream(cell) {
            // A channel from a hollow below the sea may be deeper than the sea where it ends.
            Some(next) => {
                assert!(is_valid(valid, next) && (level[next] <= level[cell] || directions.is_sea(next)));
            }
            None => assert!(directions.is_sea(cell) || at_the_rim(size, valid, cell)),
        }
    }
}

fn at_the_ends(directions: &Directions, sums: &[f64]) -> f64 {
    (0..sums.len()).filter(|&cell| directions.downstream(cell).is_none()).map(|cell| sums[cell]).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn filling_gives_the_bits_of_a_plain_priority_flood(
        seed in 0_u64..1 << 40, columns in 1_usize..90, rows in 1_usize..90, steps in 0_u32..3, one_in in 5_u64..400,
    ) {
        // Rounding makes flats and ties, as heights in whole metres have.
        let step = [0.0, 0.5, 4.0][steps as usize];
        let mut height = rough(columns.max(2), rows.max(2), 40.0, seed);
        for value in height.values_mut() {
            *value = if step > 0.0 { (*value / step).round() * step } else { *value } - 11.0;
        }
        let valid = holes(height.size(), seed, one_in);
        let routed = filled(&height, valid.as_ref());
        let expected = flooded(&height, valid.as_ref());
        for cell in (0..expected.len()).filter(|&cell| is_valid(valid.as_ref(), cell)) {
            prop_assert_eq!(routed.surface.values()[cell], expected[cell], "cell {}", cell);
        }
        check_paths(&routed, valid.as_ref());
    }

    #[test]
    fn breaching_lowers_only_and_leaves_no_depression(
        seed in 0_u64..1 << 40, columns in 2_usize..70, rows in 2_usize..70, one_in in 5_u64..400, deepest in 0.0_f64..8.0,
    ) {
        let mut height = rough(columns, rows, 40.0, seed);
        if seed % 2 == 0 {
            // Whole metres make plateaus, also at the bottom of pits.
            height.values_mut().iter_mut().for_each(|value| *value = value.round());
        }
        let valid = holes(height.size(), seed, one_in);
        let whole = breached(&height, valid.as_ref(), f64::INFINITY);
        check_paths(&whole, valid.as_ref());
        prop_assert!(whole.surface.values().iter().zip(height.values()).all(|(after, before)| after <= before));
        let by_the_sea = Routing {
            depressions: Depressions::Breach, sea_level: Some(12.0), ..Routing::default()
        };
        check_paths(&route(&height, valid.as_ref(), &by_the_sea), valid.as_ref());
        let partly = breached(&height, valid.as_ref(), deepest);
        check_paths(&partly, valid.as_ref());
        let fill = filled(&height, valid.as_ref());
        for cell in (0..height.values().len()).filter(|&cell| is_valid(valid.as_ref(), cell)) {
            let (after, before) = (partly.surface.values()[cell], height.values()[cell]);
            prop_assert!(before - after <= deepest as f32 + 1e-5, "cut by {}", before - after);
            prop_assert!(after <= fill.surface.values()[cell], "a breach never dams");
        }
    }

    #[test]
    fn what_falls_on_the_land_arrives_at_its_ends(
        seed in 0_u64..1 << 40, columns in 2_usize..80, rows in 2_usize..80, one_in in 5_u64..400, exponent in 0.0_f64..8.0,
    ) {
        let height = rough(columns, rows, 40.0, seed);
        let valid = holes(height.size(), seed, one_in);
        let valid = valid.as_ref();
        let rain = Field::from_function(height.size(), |x, y| unit(hash2(seed, x as i64, y as i64)) as f32);
        let fallen: f64 =
            (0..height.values().len()).filter(|&cell| is_valid(valid, cell)).map(|cell| f64::from(rain.values()[cell])).sum();
        let cells = valid.map_or(columns * rows, Mask::valid_cells) as f64;
        let routed = filled(&height, valid);
        let flow = MultipleFlow { routed: &routed, valid, exponent };
        prop_assert_eq!(at_the_ends(&routed.directions, &accumulate(&routed.directions, valid, None)), cells);
        for (sums, whole) in [
            (accumulate(&routed.directions, valid, Some(&rain)), fallen),
            (accumulate_multiple(&flow, None), cells),
            (accumulate_multiple(&flow, Some(&rain)), fallen),
        ] {
            let arrived = at_the_ends(&routed.directions, &sums);
            prop_assert!((arrived - whole).abs() <= 1e-11 * whole.max(1.0), "{} of {}", arrived, whole);
        }
    }
}

#[test]
fn sums_are_those_of_a_plain_walk_from_every_cell() {
    let height = rough(60, 50, 40.0, 3);
    let routed = filled(&height, None);
    let mut expected = vec![0.0; 3000];
    for cell in 0..3000 {
        let path = std::iter::successors(Some(cell), |&cell| routed.directions.downstream(cell));
        path.for_each(|cell| expected[cell] += 1.0);
    }
    assert_eq!(accumulate(&routed.directions, None, None), expected);
    assert!(expected.iter().any(|&cells| cells > 200.0), "a river has formed");
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let height = rough(300, 200, 60.0, 9);
    let valid = holes(height.size(), 4, 900);
    let valid = valid.as_ref();
    let rain = rough(300, 200, 1.0, 12);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        pool.install(|| {
            let (fill, breach) = (filled(&height, valid), breached(&height, valid, 3.0));
            let flow = MultipleFlow { routed: &fill, valid, exponent: 1.1 };
            let sums =
                [accumulate(&fill.directions, valid, Some(&rain)), accumulate_multiple(&flow, Some(&rain))];
            let bits = sums.map(|sums| sums.into_iter().map(f64::to_bits).collect::<Vec<_>>());
            (fill, breach, bits)
        })
    };
    let one = with(1);
    for threads in [2, 3, 8] {
        assert!(with(threads) == one, "{threads} threads");
    }
}

#[test]
fn mirrored_and_turned_ground_has_mirrored_and_turned_flow() {
    let side = 48;
    let size = Size::square(side).expect("legal");
    // Rough enough that no two drops are the same, with depressions but no flats that ties could decide:
    // channels through rims are cut where the pits are.
    let height = rough(side, side, 40.0, 77);
    let bowl = |x: usize, y: usize| {
        let (x, y) = (x as f32 - 23.5, y as f32 - 23.5);
        height.at((x + 23.5) as usize, (y + 23.5) as usize) * 0.2 - 0.05 * (x * x + y * y)
    };
    let ground = Field::from_function(size, bowl);
    let flow_of = |ground: &Field| {
        let routed = filled(ground, None);
        let flow = MultipleFlow { routed: &routed, valid: None, exponent: 1.1 };
        (accumulate(&routed.directions, None, None), accumulate_multiple(&flow, None))
    };
    let (steepest, spread) = flow_of(&ground);
    assert!(steepest.iter().any(|&cells| cells > 40.0), "water gathers");
    for turn in symmetries(side) {
        let turned = Field::from_function(size, |x, y| {
            let (x, y) = turn(x, y);
            ground.at(x, y)
        });
        let (steepest_turned, spread_turned) = flow_of(&turned);
        for y in 0..side {
            for x in 0..side {
                let (from_x, from_y) = turn(x, y);
                let (here, there) = (size.index(x, y), size.index(from_x, from_y));
                assert_eq!(steepest_turned[here], steepest[there]);
                assert!((spread_turned[here] / spread[there] - 1.0).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn a_plane_gathers_row_by_row_and_a_valley_in_its_line() {
    let size = Size::new(31, 40).expect("legal");
    let plane = filled(&Field::from_function(size, |_, y| 100.0 - y as f32), None);
    let sums = accumulate(&plane.directions, None, None);
    assert!((0..40).all(|y| (0..31).all(|x| sums[size.index(x, y)] == (y + 1) as f64)));
    let valley = Field::from_function(size, |x, y| 100.0 - y as f32 + 3.0 * (x as f32 - 15.0).abs());
    let sums = accumulate(&filled(&valley, None).directions, None, None);
    // 3 down to the side beats (3 + 1) / √2 along the diagonal.
    assert!((0..40).all(|y| sums[size.index(15, y)] == (31 * (y + 1)) as f64), "{:?}", &sums[..40]);
}

#[test]
fn flow_that_divides_covers_a_cone_evenly() {
    let size = Size::square(201).expect("legal");
    let from_middle = |x: usize, y: usize| libm::hypot(x as f64 - 100.0, y as f64 - 100.0);
    let cone = Field::from_function(size, |x, y| (500.0 - from_middle(x, y)) as f32);
    let routed = filled(&cone, None);
    let flow = MultipleFlow { routed: &routed, valid: None, exponent: 1.1 };
    let spread = accumulate_multiple(&flow, None);
    let steepest = accumulate(&routed.directions, None, None);
    let worst = |sums: &[f64]| {
        let ring = (0..size.cells()).map(|cell| (cell, from_middle(cell % 201, cell / 201)));
        let inner = ring.filter(|&(_, radius)| (20.0..90.0).contains(&radius));
        // The area upslope of a unit of contour is half the radius.
        inner.map(|(cell, radius)| (sums[cell] / (radius / 2.0) - 1.0).abs()).fold(0.0, f64::max)
    };
    assert!(worst(&steepest) > 0.9, "D8 leads water in parallel lines: {}", worst(&steepest));
    assert!(worst(&spread) < 0.3, "{}", worst(&spread));
}

#[test]
fn sea_is_what_the_border_reaches_and_water_ends_in_it() {
    let size = Size::new(40, 20).expect("legal");
    // A shelf below the sea in the west, land that rises eastward, and a hollow below the sea in the land.
    let hollow = |x: usize, y: usize| (25..28).contains(&x) && (8..11).contains(&y);
    let height =
        Field::from_function(size, |x, y| if hollow(x, y) { -3.0 } else { x as f32 - 7.5 + 0.01 * y as f32 });
    let routed = route(&height, None, &Routing { sea_level: Some(0.0), ..Routing::default() });
    for cell in 0..size.cells() {
        let sea = routed.directions.codes()[cell] == SEA;
        assert_eq!(sea, cell % 40 < 8, "the hollow is no sea, the shelf is");
    }
    let sums = accumulate(&routed.directions, None, None);
    let coast: f64 = (0..20).map(|y| sums[size.index(7, y)]).sum();
    assert_eq!(coast, (33 * 20) as f64, "all land drains into the westernmost cells of the sea");
    assert_eq!(routed.surface.at(3, 3), height.at(3, 3), "the floor of the sea stays");
    assert!(routed.surface.at(26, 9) > 15.0, "the hollow is filled");
}

#[test]
fn flat_ground_drains_away_from_what_is_higher_through_its_middle() {
    // The publication's example in spirit: a level valley floor between walls, open at one end.
    let size = Size::new(21, 9).expect("legal");
    let floor = Field::from_function(size, |x, y| match (x, y) {
        (20, 4) => 0.0,
        (0 | 20, _) | (_, 0 | 8) => 9.0,
        _ => 1.0,
    });
    let routed = filled(&floor, None);
    let sums = accumulate(&routed.directions, None, None);
    let middle = (4..19).map(|x| sums[size.index(x, 4)]);
    let wall = (4..19).map(|x| sums[size.index(x, 1)].max(sums[size.index(x, 7)]));
    assert!(middle.zip(wall).all(|(middle, wall)| middle > 3.0 * wall), "water gathers in the middle");
}

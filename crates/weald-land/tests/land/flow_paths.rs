//! Directions of least deviation (D8-LTD): their paths follow the fall line where those of D8 keep to multiples of 45°.

use crate::common::{rough, symmetries};
use crate::flow::{check_paths, holes};
use proptest::prelude::*;
use weald_core::grid::Mask;
use weald_core::{Field, Size};
use weald_land::flow::{Depressions, DirectionRule, Routed, Routing, accumulate, route};

fn routed_by(directions: DirectionRule, height: &Field, valid: Option<&Mask>) -> Routed {
    route(height, valid, &Routing { directions, ..Routing::default() })
}

fn routed(height: &Field, valid: Option<&Mask>) -> Routed {
    routed_by(DirectionRule::LeastDeviation, height, valid)
}

/// Column and row of each cell of a path.
fn path(routed: &Routed, start: [usize; 2]) -> Vec<[f64; 2]> {
    let size = routed.directions.size();
    let cells = std::iter::successors(Some(size.index(start[0], start[1])), |&cell| {
        routed.directions.downstream(cell)
    });
    cells.map(|cell| [(cell % size.columns) as f64, (cell / size.columns) as f64]).collect()
}

/// Degrees clockwise from east from the first cell of a path to its last.
fn heading(path: &[[f64; 2]]) -> f64 {
    let (first, last) = (path[0], path[path.len() - 1]);
    libm::atan2(last[1] - first[1], last[0] - first[0]).to_degrees()
}

#[test]
fn paths_on_a_plane_run_down_the_fall_line_at_ten_angles() {
    let size = Size::new(200, 200).expect("legal");
    let mut worst_of_steepest = 0.0_f64;
    for degrees in [0.0, 7.0, 13.0, 18.0, 22.5, 26.0, 31.0, 38.0, 45.0, 67.5_f64] {
        let (east, south) = (libm::cos(degrees.to_radians()), libm::sin(degrees.to_radians()));
        let plane = Field::from_function(size, |x, y| (400.0 - east * x as f64 - south * y as f64) as f32);
        let off = |directions| {
            let routed = routed_by(directions, &plane, None);
            let starts = (2..40).flat_map(|at| [[at, 2], [2, at]]);
            // The last cells before the border may have to go along it.
            let path_of = |start| path(&routed, start).into_iter().take(120).collect::<Vec<_>>();
            let off = starts.map(|start| (heading(&path_of(start)) - degrees).abs());
            off.fold(0.0, f64::max)
        };
        let worst = off(DirectionRule::LeastDeviation);
        assert!(worst < 1.0, "{degrees}°: {worst}° off");
        worst_of_steepest = worst_of_steepest.max(off(DirectionRule::Steepest));
    }
    assert!(worst_of_steepest > 15.0, "D8 is {worst_of_steepest}° off");
}

#[test]
fn paths_over_a_cone_are_its_radii_outward_and_inward() {
    let (side, middle) = (201, 100.0);
    let size = Size::square(side).expect("legal");
    let away = |x: f64, y: f64| libm::hypot(x - middle, y - middle);
    for outward in [true, false] {
        let sign = if outward { -1.0 } else { 1.0 };
        let cone = Field::from_function(size, |x, y| (500.0 + sign * away(x as f64, y as f64)) as f32);
        let hole = (0..size.cells()).map(|cell| outward || cell != size.index(100, 100)).collect();
        let hole = Mask::new(size, hole);
        let aside = |directions| {
            let routed = routed_by(directions, &cone, hole.as_ref());
            let mut worst = 0.0_f64;
            for turn in 0..72 {
                let angle = f64::from(turn) * std::f64::consts::TAU / 72.0;
                let radius = if outward { 40.0 } else { 90.0 };
                let start =
                    [libm::cos(angle), libm::sin(angle)].map(|along| (middle + radius * along).round());
                let radial =
                    [start[0] - middle, start[1] - middle].map(|along| along / away(start[0], start[1]));
                let cells = path(&routed, start.map(|place| place as usize));
                let far = cells.iter().filter(|[x, y]| away(*x, *y) < 95.0);
                let aside = far.map(|[x, y]| ((x - middle) * radial[1] - (y - middle) * radial[0]).abs());
                worst = worst.max(aside.fold(0.0, f64::max));
            }
            worst
        };
        let (least, steepest) = (aside(DirectionRule::LeastDeviation), aside(DirectionRule::Steepest));
        assert!(least < 4.0, "{least} cells aside");
        assert!(steepest > 3.0 * least, "D8 is {steepest} cells aside");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn every_path_ends_and_none_rises_on_any_ground(
        seed in 0_u64..1 << 40, columns in 1_usize..90, rows in 1_usize..90, steps in 0_u32..3, one_in in 3_u64..400,
    ) {
        // Rounding makes flats and ties, as heights in whole metres have.
        let step = [0.0, 0.5, 4.0][steps as usize];
        let size = Size { columns, rows };
        let ground = rough(columns.max(2), rows.max(2), 40.0, seed);
        let height = Field::from_function(size, |x, y| {
            let height = ground.at(x, y);
            if step > 0.0 { (height / step).round() * step - 11.0 } else { height - 11.0 }
        });
        let valid = holes(size, seed, one_in);
        for depressions in [Depressions::Fill, Depressions::Breach] {
            for sea_level in [None, Some(3.0)] {
                let steepest = Routing { depressions, sea_level, ..Routing::default() };
                let least = Routing { directions: DirectionRule::LeastDeviation, ..steepest };
                let (steepest, least) = [steepest, least].map(|routing| route(&height, valid.as_ref(), &routing)).into();
                check_paths(&least, valid.as_ref());
                let counted: Vec<f64> = least.upslope_cells.iter().flatten().copied().map(f64::from).collect();
                prop_assert_eq!(counted, accumulate(&least.directions, valid.as_ref(), None));
                prop_assert_eq!(&least.surface, &steepest.surface);
                let ends = |routed: &Routed| routed.directions.codes().iter().map(|&code| (code == 0, code == 9)).collect::<Vec<_>>();
                prop_assert_eq!(ends(&least), ends(&steepest), "water leaves where it does in D8");
            }
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_directions() {
    let height = rough(300, 200, 60.0, 9);
    let valid = holes(height.size(), 4, 900);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads start");
        pool.install(|| routed(&height, valid.as_ref()))
    };
    let one = with(1);
    assert!(
        one.directions != routed_by(DirectionRule::Steepest, &height, valid.as_ref()).directions,
        "they are others than those of D8"
    );
    for threads in [2, 3, 8] {
        assert!(with(threads) == one, "{threads} threads");
    }
}

#[test]
fn mirrored_and_turned_ground_has_mirrored_and_turned_paths() {
    let side = 48;
    let size = Size::square(side).expect("legal");
    let height = rough(side, side, 40.0, 77);
    let ground = Field::from_function(size, |x, y| {
        let (east, south) = (x as f32 - 23.5, y as f32 - 23.5);
        height.at(x, y) * 0.2 - 0.05 * (east * east + south * south)
    });
    let areas = |ground: &Field| accumulate(&routed(ground, None).directions, None, None);
    let straight = areas(&ground);
    assert!(straight.iter().any(|&cells| cells > 40.0), "water gathers");
    for turn in symmetries(side) {
        let turned = areas(&Field::from_function(size, |x, y| {
            let (x, y) = turn(x, y);
            ground.at(x, y)
        }));
        for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
            let (from_x, from_y) = turn(x, y);
            assert_eq!(turned[size.index(x, y)], straight[size.index(from_x, from_y)]);
        }
    }
}

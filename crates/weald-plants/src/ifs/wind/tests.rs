//! What holds for plants in the wind.

use proptest::prelude::*;

use super::*;
use crate::ifs::Ifs;
use crate::ifs::code::Code;
use crate::ifs::game::Game;
use crate::ifs::lanes::LANES;
use crate::ifs::shapes::{self, SHAPES};

const PLANTS: [&str; 8] =
    ["fern", "cyclosorus", "culcita", "fishbone", "tree", "shrub", "fern-3d", "conifer"];

fn plant(name: &str) -> (Ifs, Sway) {
    let ifs = shapes::find(name).expect("built in").ifs();
    let sway = Sway::of(&ifs);
    (ifs, sway)
}

fn coded(ifs: &Ifs, count: u64) -> Vec<([f32; 3], Code)> {
    let mut points = Vec::new();
    Game::new(ifs, 5).points(count, |block| {
        points.extend((0..block.len()).map(|i| (block.point(i), block.code(i, ifs))));
    });
    points
}

fn apart(a: [f32; 3], b: [f32; 3]) -> f32 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f32>().sqrt()
}

fn squall() -> Wind {
    Wind { speed: 25.0, gusts: 1.0, seconds: Some(4.0), ..Wind::default() }
}

#[test]
fn a_calm_plant_keeps_its_bits() {
    for name in PLANTS {
        let (ifs, sway) = plant(name);
        let calm = Pose::calm();
        for (point, code) in coded(&ifs, 3_000) {
            assert_eq!(sway.at(&calm, point, |place| code.digit(place)), point, "{name} {code}");
        }
    }
}

#[test]
fn sixty_four_points_at_once_have_the_bits_of_each() {
    let mut moved = 0;
    for shape in SHAPES {
        let (ifs, sway) = plant(shape.name);
        let pose = squall().pose(1.7);
        let posed = Posed::new(&sway, &pose);
        Game::new(&ifs, 3).points(4096, |block| {
            for (row, rests) in block.rows().iter().enumerate() {
                let swayed = posed.row(|place| block.digits(row, place), rests);
                for lane in 0..LANES {
                    let number = row * LANES + lane;
                    let rest = block.point(number);
                    let alone = sway.at(&pose, rest, |place| block.digit(number, place));
                    let together = swayed.map(|axis| axis[lane]);
                    assert_eq!(together.map(f32::to_bits), alone.map(f32::to_bits), "{}", shape.name);
                    moved += usize::from(apart(rest, alone) > 0.01);
                }
            }
        });
    }
    assert!(moved > 20_000, "{moved} points moved");
}

#[test]
fn joints_never_part_in_any_frame_of_a_squall() {
    for name in PLANTS {
        let (ifs, sway) = plant(name);
        let points = coded(&ifs, 300);
        let size = ifs.diameter() as f32;
        for pose in squall().poses(96) {
            for (_, code) in &points {
                let gap = sway.joint_gap(&pose, |place| code.digit(place));
                assert!(gap <= 4e-6 * size, "{name} {code}: {gap}");
            }
        }
    }
}

#[test]
fn a_leaf_stays_as_far_from_the_stem_that_holds_it_as_it_was() {
    // Seen from outside: the point at the foot of each leaf and the nearest one of the stem, which no part-wise formula
    // knows of, keep their distance.
    let (ifs, sway) = plant("fern");
    let code = |text: &str| Code::parse(ifs.digits(), text).expect("digits");
    for pose in squall().poses(24) {
        for trunk in 0..12 {
            let on_stem = code(&format!("{}0{}", "1".repeat(trunk), "1".repeat(40)));
            let leaf = code(&format!("{}2", "1".repeat(trunk)));
            let place =
                |code: &Code| sway.at(&pose, ifs.point(code).map(|x| x as f32), |place| code.digit(place));
            let at_rest = |code: &Code| ifs.point(code).map(|x| x as f32);
            let before = apart(at_rest(&on_stem), at_rest(&leaf));
            assert!((apart(place(&on_stem), place(&leaf)) - before).abs() < 2e-5, "joint {trunk}");
        }
    }
}

#[test]
fn the_motion_begins_again_and_has_no_jumps() {
    let (ifs, sway) = plant("fern");
    let wind = squall();
    let poses: Vec<Pose> = wind.poses(96).collect();
    assert_eq!(wind.pose(4.0), poses[0]);
    let points = coded(&ifs, 500);
    let step = |a: &Pose, b: &Pose| {
        points
            .iter()
            .map(|(point, code)| {
                let at = |pose| sway.at(pose, *point, |place| code.digit(place));
                apart(at(a), at(b))
            })
            .fold(0.0, f32::max)
    };
    let steps: Vec<f32> = (0..96).map(|i| step(&poses[i], &poses[(i + 1) % 96])).collect();
    let longest = steps.iter().copied().fold(0.0, f32::max);
    assert!(longest > 0.02 && longest < 0.1 * ifs.diameter() as f32, "{longest}");
    // Half a frame further on is about half way: the motion is smooth, and not frozen between frames.
    let between = step(&wind.pose(0.0), &wind.pose(4.0 / 192.0));
    assert!(between > 0.3 * steps[0] && between < 0.7 * steps[0], "{between} of {}", steps[0]);
}

#[test]
fn trunks_go_further_and_leaflets_are_quicker() {
    let (ifs, sway) = plant("fern");
    let wind = squall();
    let code = |text: &str| Code::parse(ifs.digits(), text).expect("digits");
    let reversals = |text: &str| {
        let code = code(text);
        let poses: Vec<Pose> = wind.poses(192).collect();
        let xs: Vec<f32> = poses
            .iter()
            .map(|pose| sway.at(pose, ifs.point(&code).map(|x| x as f32), |place| code.digit(place))[1])
            .collect();
        let turns = (0..192)
            .filter(|&i| {
                let (a, b, c) = (xs[i], xs[(i + 1) % 192], xs[(i + 2) % 192]);
                (b - a) * (c - b) < 0.0
            })
            .count();
        (turns, xs.iter().copied().fold(f32::MIN, f32::max) - xs.iter().copied().fold(f32::MAX, f32::min))
    };
    let (trunk, _) = reversals(&"1".repeat(60));
    let (leaflet, _) = reversals(&format!("2{}2{}", "1".repeat(4), "1".repeat(40)));
    assert!(leaflet > trunk, "{leaflet} against {trunk}");
}

#[test]
fn the_wind_bends_a_plant_the_way_it_blows() {
    for (direction, axis, sign) in [(0.0, 0, 1.0), (180.0, 0, -1.0), (90.0, 2, 1.0), (-90.0, 2, -1.0)] {
        let (ifs, sway) = plant("fern-3d");
        let tip = Code::of(ifs.digits(), &[1; 64]).expect("fits");
        let rest = ifs.point(&tip).map(|x| x as f32);
        let wind = Wind { speed: 20.0, direction_deg: direction, gusts: 0.0, ..Wind::default() };
        let mean = (0..100)
            .map(|i| sway.at(&wind.pose(0.37 * f64::from(i)), rest, |place| tip.digit(place))[axis])
            .sum::<f32>()
            / 100.0;
        assert!(sign * (mean - rest[axis]) > 0.5, "towards {direction}: {mean} from {}", rest[axis]);
    }
}

proptest! {
    #[test]
    fn no_plant_is_torn_from_its_root_or_stretched(
        speed in 0.0..60.0_f64, gusts in 0.0..1.0_f64, seconds in 0.0..100.0_f64, direction_deg in -180.0..180.0_f64,
    ) {
        let (ifs, sway) = plant("fern-3d");
        let wind = Wind { speed, direction_deg, gusts, ..Wind::default() };
        let pose = wind.pose(seconds);
        let numbers = pose.numbers();
        prop_assert!(numbers.len() == 12 + ORDERS * PHASES && numbers.iter().all(|x| x.is_finite()));
        for (point, code) in coded(&ifs, 64) {
            let at = sway.at(&pose, point, |place| code.digit(place));
            // A chain of parts is never longer than the way along its joints at rest.
            prop_assert!(apart(at, [0.0; 3]) < 2.5 * ifs.diameter() as f32);
        }
    }
}

#[test]
fn what_is_half_a_gust_behind_swings_to_the_other_side() {
    let pose = squall().pose(1.7);
    for swing in pose.swing {
        assert!(swing.iter().any(|swing| swing.abs() > 1e-3), "{swing:?}");
        for phase in 0..PHASES / 2 {
            assert!((swing[phase] + swing[phase + PHASES / 2]).abs() < 1e-5, "{swing:?}");
        }
    }
}

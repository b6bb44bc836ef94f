//! What holds for plants of limbs.

use super::*;
use crate::ifs::foliage::Habit;
use crate::ifs::shapes;
use crate::wind::push;

fn plant(name: &str) -> Limbs {
    let ifs = shapes::find(name).expect("built in").ifs();
    Limbs::of(&ifs, Habit::of(&ifs, None))
}

fn apart(a: [f32; 3], b: [f32; 3]) -> f32 {
    leaf::length(std::array::from_fn(|i| a[i] - b[i]))
}

#[test]
fn every_shape_becomes_a_plant_of_one_metre_with_leaves_on_every_level() {
    for shape in shapes::SHAPES {
        let plant = plant(shape.name);
        let finest = plant.corners.iter().filter(|corner| corner.levels[0] == 0);
        let highest = finest.map(|corner| corner.rest[1]).fold(0.0, f32::max);
        assert!((highest - 1.0).abs() < 1e-5, "{}: {highest} m", shape.name);
        let counts: Vec<_> =
            (0..LEVELS as u32).map(|level| plant.triangles_of([level; 2]).len() / 3).collect();
        println!(
            "{}: {} limbs, {} corners, triangles {counts:?}, {} m, areas {:?}",
            shape.name,
            plant.limbs.len(),
            plant.corners.len(),
            plant.radius(),
            (0..LEVELS as u32).map(|level| plant.area(level)).collect::<Vec<_>>()
        );
        assert!(plant.corners.len() < 200_000 && plant.limbs.len() < 1 << 20);
        assert!(counts[LEVELS - 1] > 0 && counts[LEVELS - 1] <= 24, "{}: {counts:?}", shape.name);
        for (number, limb) in plant.limbs.iter().enumerate() {
            assert!(limb.parent.is_none_or(|parent| (parent as usize) < number), "{}", shape.name);
            assert!((0.0..=1.0).contains(&limb.along) && limb.order < 4 && (0.0..1.0).contains(&limb.phase));
        }
    }
}

/// Breezes at many places and moments, from none to a gale.
fn local_winds() -> impl Iterator<Item = LocalWind> {
    (0..60_u16).map(|number| {
        let seconds = 0.37 * f32::from(number);
        let [east, north] = push([3.0 * seconds, 40.0], seconds, 0.0);
        let stronger = f32::from(number % 4);
        wind_on([stronger * east, -stronger * north], seconds, 0.3)
    })
}

#[test]
fn joints_never_part_in_any_breeze() {
    let mut moved = 0.0_f32;
    for name in ["fern", "culcita", "fern-3d", "shrub", "tree", "conifer", "crown"] {
        let plant = plant(name);
        for breeze in local_winds() {
            for (number, limb) in (0..).zip(&plant.limbs) {
                let Some(parent) = limb.parent else { continue };
                let held = plant.bent(&breeze, parent, limb.along, limb.joint);
                for along in [0.0, 0.4, 1.0] {
                    let hangs = plant.bent(&breeze, number, along, limb.joint);
                    assert!(apart(held, hangs) < 4e-6, "{name} {number}: {held:?} {hangs:?}");
                }
                moved = moved.max(apart(held, limb.joint));
            }
        }
    }
    assert!(moved > 0.3, "{moved}: nothing swayed");
}

#[test]
fn limbs_hang_on_their_parents_and_roots_stand_still() {
    for name in ["fern", "fern-3d", "shrub", "conifer"] {
        let plant = plant(name);
        for breeze in local_winds() {
            for limb in plant.limbs.iter().filter(|limb| limb.parent.is_none()) {
                assert!(leaf::length(limb.joint) < 1e-3, "{name}: {:?}", limb.joint);
            }
            let of_stem =
                |corner: &&Corner| plant.limbs[corner.limb as usize].parent.is_none() && corner.is_stem;
            let feet = plant.corners.iter().filter(of_stem);
            for corner in feet.filter(|corner| leaf::length(corner.rest) < 0.02) {
                let bent = plant.bent(&breeze, corner.limb, corner.along, corner.rest);
                assert!(apart(bent, corner.rest) < 0.01, "{name}");
            }
        }
        // A leaf's foot is at the joint of the limb that it is.
        let feet = plant.corners.iter().filter(|corner| corner.along == 0.0 && !corner.is_stem);
        let off = feet.map(|corner| apart(corner.axis, plant.limbs[corner.limb as usize].joint));
        assert!(off.fold(0.0, f32::max) < 0.02, "{name}");
    }
}

#[test]
fn a_calm_plant_does_not_move() {
    let plant = plant("fern");
    let calm = wind_on([0.0; 2], 7.0, 0.2);
    for corner in &plant.corners {
        assert_eq!(plant.bent(&calm, corner.limb, corner.along, corner.rest), corner.rest);
    }
}

#[test]
fn all_levels_of_a_fern_have_its_area_of_leaves_and_lie_within_its_reach() {
    for name in ["fern", "culcita", "fern-3d", "shrub", "conifer", "spruce", "crown"] {
        let plant = plant(name);
        let whole = plant.area(0);
        let leafy = if ["conifer", "spruce", "crown"].contains(&name) { 3 } else { LEVELS as u32 };
        for level in 1..leafy {
            let share = plant.area(level) / whole;
            assert!((0.7..1.4).contains(&share), "{name}: level {level} has {share} of the area");
        }
        let lowest = plant.corners.iter().map(|corner| corner.rest[1]).fold(f32::INFINITY, f32::min);
        assert!(lowest > -0.15, "{name} reaches {lowest} m into the ground");
    }
}

#[test]
fn the_hull_of_a_crown_is_closed_and_looks_outward_and_reaches_as_far_as_its_leaves() {
    for name in ["spruce", "crown"] {
        let plant = plant(name);
        for level in [LEVELS as u32 - 2, LEVELS as u32 - 1] {
            let hull: Vec<_> = plant.corners.iter().filter(|corner| corner.levels == [level; 2]).collect();
            let looks_out = |corner: &&&Corner| {
                let [out, up] =
                    [corner.rest[0] * corner.normal[0] + corner.rest[2] * corner.normal[2], corner.normal[1]];
                out > -1e-6 && (out > 0.0 || up != 0.0)
            };
            assert!(hull.len() > 10 && hull.iter().filter(looks_out).count() == hull.len(), "{name} {level}");
            // Each edge of a closed body is that of two triangles.
            let mut edges = std::collections::HashMap::new();
            let own = |triangle: &&[u32; 3]| plant.corners[triangle[0] as usize].levels == [level; 2];
            for triangle in plant.triangles.iter().filter(own) {
                for at in 0..3 {
                    let [a, b] = [triangle[at], triangle[(at + 1) % 3]];
                    *edges.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
                }
            }
            assert!(edges.values().all(|&count| count == 2), "{name} {level}");
            let reach = |level: u32| {
                let of =
                    plant.corners.iter().filter(move |corner| corner.levels[0] == level && !corner.is_stem);
                of.map(|corner| corner.rest[0].hypot(corner.rest[2])).fold(0.0, f32::max)
            };
            let share = reach(level) / reach(0);
            // The tips of boughs, a twenty-fifth of all points on each side, stand out of the hull.
            assert!((0.4..1.3).contains(&share), "{name}: level {level} reaches {share} times as far");
        }
    }
}

#[test]
fn a_leaf_of_no_breadth_has_no_area() {
    for name in ["fern", "conifer", "crown"] {
        let plant = plant(name);
        let thin = |corner: u32| plant.corners[corner as usize].axis;
        let areas = plant.triangles.iter().map(|triangle| leaf::area(triangle.map(thin)));
        assert_eq!(areas.fold(0.0, f32::max), 0.0, "{name}");
        assert!(plant.area(0) > 0.1, "{name}");
    }
}

#[test]
fn the_last_word_of_a_limb_holds_its_parent_its_order_and_its_phase() {
    let limb = Limb {
        joint: [1.0; 3],
        direction: [0.0, 1.0, 0.0],
        parent: Some(5),
        along: 0.5,
        order: 3,
        phase: 0.25,
    };
    let tie = limb.packed()[7];
    assert_eq!([tie & 0xf_ffff, tie >> 20 & 3, tie >> 22], [5, 3, 256]);
    assert_eq!(Limb { parent: None, ..limb }.packed()[7] & 0xf_ffff, 0xf_ffff);
}

#[test]
fn the_main_stem_is_drawn_on_every_level_whose_leaves_are_smaller_than_the_whole() {
    for name in ["fern", "shrub", "conifer"] {
        let plant = plant(name);
        let whole = [0, LEVELS as u32 - 3];
        assert!(plant.corners.iter().any(|corner| corner.is_stem && corner.levels == whole), "{name}");
    }
}

#[test]
fn corners_of_a_leaf_say_how_far_up_and_on_which_edge_they_are_and_so_does_the_last_word() {
    let plant = plant("spruce");
    let is_of_leaf = |corner: &&Corner| !corner.is_stem && corner.levels[0] == 0;
    let leaves: Vec<_> = plant.corners.iter().filter(is_of_leaf).collect();
    for corner in &leaves {
        let is_on_axis = corner.rest == corner.axis;
        assert_eq!(corner.side == 0, is_on_axis, "{corner:?}");
        assert!(!is_on_axis || corner.up == 0.0 || corner.up == 1.0, "a foot or a tip: {corner:?}");
        let look = corner.packed()[11];
        assert!(((look >> 23 & 31) as f32 / 31.0 - corner.up).abs() < 0.017, "{corner:?}");
        assert_eq!((look >> 28) as i8 - 1, corner.side);
    }
    let [left, right] = [-1, 1].map(|side| leaves.iter().filter(|corner| corner.side == side).count());
    let [feet, tips] = [0.0, 1.0].map(|up| leaves.iter().filter(|corner| corner.up == up).count());
    assert!(left == right && feet == tips && left >= feet && feet > 1000, "{left} {right} {feet} {tips}");
}

#[test]
fn the_trunk_of_a_crown_is_round_from_close_by_and_stands_in_the_ground() {
    for name in ["spruce", "crown"] {
        let plant = plant(name);
        // Of its lower part: slender stems are ribbons on these levels too.
        let is_round = |corner: &&Corner| {
            let is_of_trunk = plant.limbs[corner.limb as usize].parent.is_none() && corner.rest[1] < 0.2;
            corner.is_stem && corner.levels == [0, 1] && is_of_trunk
        };
        let round: Vec<_> = plant.corners.iter().filter(is_round).collect();
        for corner in &round {
            let out: f32 = (0..3).map(|at| (corner.rest[at] - corner.axis[at]) * corner.normal[at]).sum();
            assert!(out > 0.9 * apart(corner.rest, corner.axis) && out > 0.0, "{name}: {corner:?}");
        }
        let on_foot = round.iter().filter(|corner| corner.rest[1] < 0.0);
        let azimuths: Vec<_> = on_foot.map(|corner| corner.normal[2].atan2(corner.normal[0])).collect();
        for turn in [-3.0_f32, -1.5, 0.0, 1.5, 3.0] {
            assert!(azimuths.iter().any(|azimuth| (azimuth - turn).cos() > 0.9), "{name}: none to {turn}");
        }
        let flat = plant.corners.iter().filter(|corner| corner.is_stem && corner.levels[0] == 1);
        assert!(flat.count() > 0, "{name} has ribbons farther off");
    }
}

#[test]
fn a_rosette_stands_on_the_ground_with_its_stipes() {
    let fern = plant("fern");
    let stems = fern.corners.iter().filter(|corner| corner.is_stem);
    let lowest = stems.map(|corner| corner.rest[1]).fold(f32::INFINITY, f32::min);
    assert!(lowest.abs() < 0.02, "{lowest} m");
}

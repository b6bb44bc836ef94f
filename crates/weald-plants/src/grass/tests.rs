//! The model over its whole space of inputs, and the numbers that are known of it.

use proptest::prelude::*;

use super::blade::rows;
use super::curves::{Curves, JOINT, LightCurve, SoilCurve};
use super::growth::{Bend, Growth, LEVELS, MAX_BEND, points};
use super::spline::{Spline, clamped};
use super::{BLADES, Blade, Instance, SPECIES, Set, Species};

fn share() -> impl Strategy<Value = f32> {
    prop_oneof![8 => 0.0..=1.0_f32, 1 => Just(0.0_f32), 1 => Just(1.0_f32)]
}

fn curves() -> impl Strategy<Value = Curves> {
    let five = || prop::array::uniform5(share());
    (prop::array::uniform3(share()), five(), five()).prop_map(|(soil, width, height)| Curves {
        soil: SoilCurve::new(soil).expect("within 0 to 1"),
        width: LightCurve::new(width).expect("within 0 to 1"),
        height: LightCurve::new(height).expect("within 0 to 1"),
    })
}

fn set() -> impl Strategy<Value = Set> {
    let whole = prop_oneof![3 => Just(1.0_f32), 1 => share()];
    (share(), share(), 0.0..=4.0_f32, whole, share(), 0..65536_u32)
        .prop_map(|(soil, light, level, cut, trodden, seed)| Set { soil, light, level, cut, trodden, seed })
}

fn species() -> impl Strategy<Value = &'static Species> {
    (0..SPECIES.len()).prop_map(|number| &SPECIES[number])
}

fn apart(a: [f32; 2], b: [f32; 2]) -> f32 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn in_degrees(height: f32, degrees: f32, bend: Bend) -> [[f32; 2]; LEVELS + 1] {
    points(height, degrees.to_radians() * bend.of_a_level())
}

#[test]
fn the_papers_example_grows_to_nothing_then_0_7_then_1_19() {
    let heights = in_degrees(0.7, 0.0, Bend::Total).map(|[up, _]| up);
    for (height, expected) in heights.into_iter().zip([0.0, 0.7, 1.19]) {
        assert!((height - expected).abs() < 1e-6, "{heights:?}");
    }
}

#[test]
fn printed_a_blade_of_the_greatest_height_falls_below_its_root_beyond_36_degrees() {
    for (degrees, expected) in [(0.0, 4.0), (20.0, 2.38), (30.0, 0.87), (36.0, 0.0), (60.0, -1.5)] {
        let tip = in_degrees(1.0, degrees, Bend::Printed)[4][0];
        assert!((tip - expected).abs() < 5e-3, "{degrees}°: {tip}");
    }
    let total = in_degrees(1.0, 60.0, Bend::Total)[4][0];
    assert!((total - 3.04).abs() < 5e-3, "{total}");
}

#[test]
fn points_are_the_closed_form_of_the_recurrence() {
    for (height, degrees) in [(0.7_f32, 12.0_f32), (1.0, 45.0), (0.3, 60.0)] {
        for (level, point) in in_degrees(height, degrees, Bend::Printed).into_iter().enumerate() {
            let mut sum = [0.0; 2];
            for k in 1..=level {
                let angle = f64::from(degrees).to_radians() * (level + 1 - k) as f64;
                let power = f64::from(height).powi(k as i32);
                sum = [sum[0] + power * angle.cos(), sum[1] + power * angle.sin()];
            }
            assert!(apart(point, sum.map(|x| x as f32)) < 1e-5, "level {level}: {point:?} {sum:?}");
        }
    }
}

#[test]
fn the_bend_before_its_clamp_leaves_the_range_that_the_source_claims() {
    let bend = |soil: f32, wide: f32, tall: f32| {
        let gamma = (soil + tall) / 2.0 - (soil + wide) / 8.0 + tall;
        (gamma * super::growth::BEND_OF_GAMMA).to_degrees()
    };
    assert!((bend(0.0, 1.0, 0.0) + 4.29).abs() < 0.01 && (bend(1.0, 0.0, 1.0) - 64.29).abs() < 0.01);
    assert!((bend(1.0, 1.0, 1.0) - 60.0).abs() < 0.01);
    assert_eq!((Growth::of(0.0, 1.0, 0.0).bend, Growth::of(1.0, 0.0, 1.0).bend), (0.0, MAX_BEND));
}

#[test]
fn printed_arcs_jump_where_the_mended_ones_meet() {
    let curve = Curves::OF_THE_SOURCE.width;
    let beyond = JOINT + 1e-6;
    assert!((curve.printed(JOINT) - 0.19).abs() < 0.02 && (curve.printed(beyond) - 0.65).abs() < 0.02);
    assert!((curve.at(JOINT) - curve.at(beyond)).abs() < 1e-5);
    assert_eq!(LightCurve::new([0.0, 0.3, 0.6, 0.9, 1.0]).expect("legal").kink().signum(), -1.0);
    let straight = LightCurve::new([0.0, 0.15, 0.3, 0.65, 1.0]).expect("legal");
    assert!(straight.kink().abs() < 1e-6, "a line has none: {}", straight.kink());
}

#[test]
fn a_control_value_outside_of_0_to_1_is_refused_by_its_number() {
    for wrong in [-0.01, 1.01, f32::NAN, f32::INFINITY] {
        let fault = SoilCurve::new([0.0, wrong, 1.0]).expect_err("refused");
        assert!(fault.contains("control value 2") && fault.contains("0 to 1"), "{fault}");
        assert!(LightCurve::new([0.0, 0.0, 0.0, 0.0, wrong]).expect_err("refused").contains("value 5"));
    }
}

#[test]
fn built_in_species_are_legal_and_look_different() {
    for (number, one) in SPECIES.iter().enumerate() {
        let Curves { soil, width, height } = one.curves;
        assert!(SoilCurve::new(soil.values()).is_ok(), "{}", one.name);
        assert!([width, height].iter().all(|curve| LightCurve::new(curve.values()).is_ok()), "{}", one.name);
        assert!(one.heads <= BLADES && one.taper <= 1.0 && one.variation < 1.0 && one.bending <= 1.0);
        for other in &SPECIES[number + 1..] {
            let (one, other) = (profile(one), profile(other));
            let differ = one.iter().zip(other).filter(|(one, other)| (*one / other).ln().abs() > 0.2);
            assert!(differ.count() >= 2, "{one:?} {other:?}");
        }
    }
    assert_eq!(Species::named("reed").map(|species| species.name), Some("reed"));
}

/// Height, slenderness and how far it hangs over, on middling ground.
fn profile(species: &Species) -> [f32; 3] {
    let set = Set { soil: 0.6, light: 0.6, level: 4.0, cut: 1.0, trodden: 0.0, seed: 1 };
    let blade = Blade::of(species, &set, BLADES - 1, Bend::Total);
    let [up, out] = blade.stem.0[4];
    [up, up / blade.width, out / up]
}

#[test]
fn a_blade_of_level_4_has_40_vertices_and_a_set_240() {
    let set = Set { soil: 0.5, light: 0.5, level: 4.0, cut: 1.0, trodden: 0.0, seed: 3 };
    let count = |blade| Blade::of(&SPECIES[0], &set, blade, Bend::Total).vertices(rows(set.level)).count();
    assert_eq!((count(0), (0..BLADES).map(count).sum::<usize>()), (40, 240));
    assert_eq!([1.0, 2.0, 2.5, 3.0, 4.0].map(rows), [5, 10, 15, 15, 20]);
}

/// Radians from upright at which the blades of a thousand sets leave the ground, all but stalks.
fn leaving_angles(species: &Species) -> Vec<f32> {
    let of = |seed: u32| {
        let set = Set { soil: 0.6, light: 0.6, level: 4.0, cut: 1.0, trodden: 0.0, seed };
        let blade = Blade::of(species, &set, species.heads, Bend::Total);
        let (_, [rise, run]) = blade.stem.at(0.0);
        run.atan2(rise)
    };
    (0..1000).map(of).collect()
}

#[test]
fn blades_leave_the_ground_at_all_angles_up_to_the_splay_of_their_species() {
    for species in &SPECIES {
        let upright = leaving_angles(&Species { splay: 0.0, ..species.clone() });
        let splayed = leaving_angles(species);
        let turned: Vec<_> =
            upright.iter().zip(&splayed).map(|(upright, splayed)| splayed - upright).collect();
        let (least, most) =
            (turned.iter().copied().fold(9.0, f32::min), turned.iter().copied().fold(-9.0, f32::max));
        assert!(least > -1e-5 && most < species.splay + 1e-5, "{}: {least} to {most}", species.name);
        let mean = turned.iter().sum::<f32>() / 1000.0;
        assert!((mean / species.splay - 0.5).abs() < 0.03, "{}: {mean} in the mean", species.name);
    }
}

#[test]
fn a_splayed_blade_is_as_long_as_an_upright_one_and_a_stalk_leans_less() {
    let oats = Species { variation: 0.0, ..SPECIES[4].clone() };
    let upright = Species { splay: 0.0, ..oats.clone() };
    let set = Set { soil: 0.6, light: 0.6, level: 4.0, cut: 1.0, trodden: 0.0, seed: 5 };
    for number in 0..BLADES {
        let length = |species: &Species| {
            let Spline(points) = Blade::of(species, &set, number, Bend::Total).stem;
            points.windows(2).map(|pair| apart(pair[0], pair[1])).sum::<f32>()
        };
        assert!((length(&oats) / length(&upright) - 1.0).abs() < 1e-5);
    }
    let stalks = |species: &Species| {
        let turned = |seed: u32| {
            let (_, [rise, run]) = Blade::of(species, &Set { seed, ..set }, 0, Bend::Total).stem.at(0.0);
            run.atan2(rise)
        };
        (0..1000).map(turned).sum::<f32>() / 1000.0
    };
    let lean = stalks(&oats) - stalks(&upright);
    assert!((lean / oats.splay - 0.2).abs() < 0.02, "{lean} in the mean");
}

proptest! {
    #[test]
    fn growth_lies_within_its_ranges_for_all_answers(soil in share(), wide in share(), tall in share()) {
        let growth = Growth::of(soil, wide, tall);
        prop_assert!((0.0..=0.25).contains(&growth.width), "{growth:?}");
        prop_assert!((0.0..=1.0).contains(&growth.height), "{growth:?}");
        prop_assert!((0.0..=MAX_BEND).contains(&growth.bend), "{growth:?}");
        prop_assert!((0.0..=1.0).contains(&growth.blend), "{growth:?}");
    }

    #[test]
    fn curves_stay_within_0_and_1_and_are_continuous(curves in curves(), at in share(), step in 0.0..1e-3_f32) {
        let (here, there) = (at, (at + step).min(1.0));
        for (one, other) in [
            (curves.soil.at(here), curves.soil.at(there)),
            (curves.width.at(here), curves.width.at(there)),
            (curves.height.at(here), curves.height.at(there)),
        ] {
            prop_assert!((0.0..=1.0).contains(&one));
            // The steepest arc goes from 0 to 1 within 0.15.
            prop_assert!((one - other).abs() <= 2.0 / JOINT * step + 1e-6, "{one} {other}");
        }
    }

    #[test]
    fn curves_pass_through_their_ends_and_their_joint(curves in curves()) {
        let [low, _, joint, _, high] = curves.width.values();
        let found = [0.0, JOINT, 1.0].map(|light| curves.width.at(light));
        for (found, expected) in found.into_iter().zip([low, joint, high]) {
            prop_assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
        let [low, _, high] = curves.soil.values();
        prop_assert_eq!([curves.soil.at(0.0), curves.soil.at(1.0)], [low, high]);
    }

    #[test]
    fn the_growth_of_all_curves_and_places_never_puts_a_total_tip_below_its_root(
        curves in curves(), soil in share(), light in share(), level in 0.0..=4.0_f32, t in share(),
    ) {
        let growth = Growth::at(&curves, soil, light);
        let points = growth.points(Bend::Total);
        prop_assert!(points.iter().all(|point| point[0] >= 0.0), "{points:?}");
        prop_assert!(growth.height == 0.0 || points[4][0] > 0.0, "{points:?}");
        prop_assert!(Spline::of(&points, level).at(t).0[0] >= 0.0);
    }

    #[test]
    fn a_spline_is_the_defined_one_at_whole_levels(
        height in share(), turn in 0.0..=MAX_BEND, level in 1..=LEVELS, t in share(),
    ) {
        let points = points(height, turn);
        let (one, other) = (Spline::of(&points, level as f32).at(t).0, clamped(&points[..=level], t));
        prop_assert!(apart(one, other) < 4e-6, "level {level} at {t}: {one:?} {other:?}");
    }

    #[test]
    fn a_stem_begins_and_ends_in_its_end_points(height in share(), turn in 0.0..=MAX_BEND, level in 1..=LEVELS) {
        let points = points(height, turn);
        let spline = Spline::of(&points, level as f32);
        prop_assert_eq!([spline.at(0.0).0, spline.at(1.0).0], [points[0], points[level]]);
    }

    #[test]
    fn a_stem_lies_within_the_convex_hull_of_its_points(
        height in share(), turn in 0.0..=MAX_BEND, level in 1..=LEVELS, t in share(), turns in 0.0..1.0_f32,
    ) {
        let points = points(height, turn);
        let [x, y] = super::random::direction(turns);
        let extent = |point: &[f32; 2]| x * point[0] + y * point[1];
        let farthest = points[..=level].iter().map(extent).fold(f32::NEG_INFINITY, f32::max);
        let found = extent(&Spline::of(&points, level as f32).at(t).0);
        prop_assert!(found <= farthest + 2e-6, "{found} is beyond {farthest}");
    }

    #[test]
    fn a_stem_grows_without_a_jump(
        height in share(), turn in 0.0..=MAX_BEND, level in 0.0..=4.0_f32, step in 0.0..1e-3_f32, t in share(),
    ) {
        let points = points(height, turn);
        let [one, other] = [level, (level + step).min(4.0)].map(|level| Spline::of(&points, level).at(t).0);
        // Between two levels no point goes farther than from one hull to the next.
        prop_assert!(apart(one, other) <= 4.0 * step + 4e-6, "{one:?} {other:?}");
    }

    #[test]
    fn a_slope_is_that_of_the_stem(height in 0.2..=1.0_f32, turn in 0.0..=MAX_BEND, level in 1.0..=4.0_f32, t in 0.01..0.99_f32) {
        let spline = Spline::of(&points(height, turn), level);
        let (near, slope) = (1e-3, spline.at(t).1);
        let (before, behind) = (spline.at(t - near).0, spline.at(t + near).0);
        let measured = [0, 1].map(|axis| (behind[axis] - before[axis]) / (2.0 * near));
        prop_assert!(apart(slope, measured) < 0.02, "{slope:?} {measured:?}");
    }

    #[test]
    fn every_vertex_is_finite_above_its_root_and_has_a_unit_normal(
        species in species(), set in set(), blade in 0..BLADES, along in share(), side in prop_oneof![Just(-1.0_f32), Just(1.0_f32)],
    ) {
        let blade = Blade::of(species, &set, blade, Bend::Total);
        let vertex = blade.vertex(along, side);
        let swayed = blade.swayed(&vertex, [0.8, -1.3]);
        for vertex in [vertex, swayed] {
            prop_assert!(vertex.place.iter().all(|part| part.is_finite()), "{vertex:?}");
            prop_assert!(vertex.place[1] >= 0.0, "{vertex:?}");
            let length = vertex.normal.iter().map(|part| part * part).sum::<f32>().sqrt();
            prop_assert!((length - 1.0).abs() < 1e-5, "{vertex:?}");
            prop_assert!((0.0..=1.0).contains(&vertex.head) && (0.0..=1.0).contains(&vertex.blend));
        }
        prop_assert!(vertex.place[1] <= set.cut * species.top() * (1.0 + 1e-5) + 1e-7, "{vertex:?}");
        let calm = blade.swayed(&vertex, [0.0; 2]).place;
        let moved = (0..3).map(|i| (calm[i] - vertex.place[i]).abs()).fold(0.0, f32::max);
        prop_assert!(moved <= 1e-6 * species.top(), "without wind it moves by {moved}");
    }

    #[test]
    fn a_normal_stands_at_right_angles_to_a_flat_blade(set in set(), along in 0.05..0.95_f32) {
        let flat = Species { fold: 0.0, ..SPECIES[0].clone() };
        let grown = Set { level: set.level.max(0.5), soil: set.soil.max(0.2), cut: 1.0, ..set };
        let blade = Blade::of(&flat, &grown, 2, Bend::Total);
        let at = |along| blade.vertex(along, 1.0);
        let [low, high, left] = [at(along - 0.01), at(along + 0.01), blade.vertex(along, -1.0)];
        let normal = at(along).normal;
        for (from, to) in [(low, high), (left, at(along))] {
            let edge: [f32; 3] = std::array::from_fn(|i| to.place[i] - from.place[i]);
            let length = edge.iter().map(|part| part * part).sum::<f32>().sqrt();
            let across: f32 = (0..3).map(|i| edge[i] * normal[i]).sum::<f32>() / length;
            prop_assert!(across.abs() < 0.12, "{across} of {edge:?} is along {normal:?}");
        }
    }

    #[test]
    fn a_blade_grows_without_a_jump(species in species(), set in set(), blade in 0..BLADES, step in 0.0..1e-3_f32, along in share()) {
        let later = Set { level: (set.level + step).min(4.0), ..set };
        let [one, other] = [set, later].map(|set| Blade::of(species, &set, blade, Bend::Total).vertex(along, 1.0));
        let apart = (0..3).map(|i| (one.place[i] - other.place[i]).abs()).fold(0.0, f32::max);
        prop_assert!(apart <= 4.0 * species.top() * step + 1e-5 * species.top(), "{apart}");
    }

    #[test]
    fn treading_lays_a_blade_down_and_makes_it_no_longer(species in species(), set in set(), blade in 0..BLADES) {
        let tip = |trodden| {
            let set = Set { trodden, cut: 1.0, level: 4.0, soil: set.soil.max(0.1), ..set };
            Blade::of(species, &set, blade, Bend::Total).stem.0[4]
        };
        let (free, down) = (tip(0.0), tip(1.0));
        prop_assert!(down[0] <= 0.09 * free[0] && down[0] > 0.0, "{free:?} {down:?}");
        prop_assert!(down[1] > free[1] && down[1] <= free[0] + free[1] + 1e-6, "{free:?} {down:?}");
    }
}

fn instance() -> impl Strategy<Value = Instance> {
    let place = prop::array::uniform2(0.0..40_000.0_f32);
    (place, 0..16_u32, set()).prop_map(|(place, species, tuft)| Instance { place, species, tuft })
}

proptest! {
    #[test]
    fn an_instance_comes_back_from_its_16_bytes_to_half_a_step(instance in instance()) {
        let found = Instance::unpack(instance.pack());
        prop_assert_eq!((found.place, found.species, found.tuft.seed), (instance.place, instance.species, instance.tuft.seed));
        let (one, other) = (found.tuft, instance.tuft);
        for (found, expected, step) in [
            (one.soil, other.soil, 1.0 / 1023.0),
            (one.light, other.light, 1.0 / 1023.0),
            (one.level, other.level, 4.0 / 4095.0),
            (one.cut, other.cut, 1.0 / 63.0),
            (one.trodden, other.trodden, 1.0 / 63.0),
        ] {
            prop_assert!((found - expected).abs() <= 0.5 * step + 1e-6, "{found} {expected}");
        }
        prop_assert_eq!(found.pack(), instance.pack());
    }
}

#[test]
fn the_ends_of_all_shares_keep_their_values_in_16_bytes() {
    for share in [0.0, 1.0] {
        let set =
            Set { soil: share, light: share, level: 4.0 * share, cut: share, trodden: share, seed: 65535 };
        let found = Instance::unpack(Instance { place: [0.0, -1.5], species: 15, tuft: set }.pack());
        assert!((found.tuft.soil - share).abs() < 1e-6 && (found.tuft.cut - share).abs() < 1e-6, "{found:?}");
        assert!((found.tuft.level - 4.0 * share).abs() < 1e-6 && found.tuft.seed == 65535, "{found:?}");
    }
}

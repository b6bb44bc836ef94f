//! What the source says of its deformations.

use proptest::prelude::*;

use super::*;
use crate::ifs::game::Game;
use crate::ifs::map::distance;
use crate::ifs::shapes;

fn ifs(name: &str) -> Ifs {
    shapes::find(name).expect("built in").ifs()
}

fn interval(from: usize, to: usize) -> Interval {
    Interval { from, to }
}

fn any_code(ifs: &Ifs, seed: u64) -> Code {
    let digit = |place: i64| (weald_core::random::hash2(seed, place, 1) % ifs.maps().len() as u64) as u8;
    let digits: Vec<u8> = (0..ifs.code_digits() as i64).map(digit).collect();
    Code::of(ifs.digits(), &digits).expect("fits")
}

fn any_interval() -> impl Strategy<Value = Interval> {
    (1_usize..20, 0_usize..5).prop_map(|(from, more)| interval(from, from + more))
}

fn name() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec!["gasket", "fern", "tree", "carpet", "dragon"])
}

proptest! {
    #[test]
    fn as_many_permutations_as_maps_give_the_code_back(name in name(), seed: u64, within in any_interval()) {
        let ifs = ifs(name);
        let code = any_code(&ifs, seed);
        let mut changed = code;
        for time in 1..=ifs.maps().len() {
            changed = Permutation(within).change(&changed, ifs.digits());
            prop_assert_eq!(changed == code, time == ifs.maps().len());
        }
    }

    #[test]
    fn swapping_or_reversing_twice_is_nothing(name in name(), seed: u64, within in any_interval()) {
        let ifs = ifs(name);
        let code = any_code(&ifs, seed);
        let swap = Swap { interval: within, between: [0, 1] };
        let twice = |change: &dyn CodeChange| change.change(&change.change(&code, ifs.digits()), ifs.digits());
        prop_assert_eq!(twice(&swap), code);
        prop_assert_eq!(twice(&Reversal(within)), code);
        let touched = within.places().any(|place| code.digit(place) < 2);
        prop_assert_eq!(swap.change(&code, ifs.digits()) != code, touched);
    }

    #[test]
    fn codes_that_differ_still_differ_after_an_insertion(name in name(), seeds: [u64; 2], within in any_interval(), same in 0_usize..24) {
        let ifs = ifs(name);
        let [one, other] = seeds.map(|seed| any_code(&ifs, seed));
        // Two codes that agree at first, so that the difference lies before, in and after the interval.
        let other = (0..same.min(one.len())).fold(other, |code, place| code.replaced(place, one.digit(place)));
        prop_assume!(one != other);
        let insertion = Insertion { interval: within, digit: 0 };
        let [changed, others] = [one, other].map(|code| insertion.change(&code, ifs.digits()));
        prop_assert_ne!(changed, others);
        prop_assert_eq!(changed.len(), one.len() + within.count() - 1);
        // It can be undone, so nothing was lost.
        let back: Vec<u8> = changed.digits().enumerate()
            .filter(|(place, _)| !inserted(within, *place)).map(|(_, digit)| digit).collect();
        prop_assert_eq!(Code::of(ifs.digits(), &back).expect("fits"), one);
    }

    #[test]
    fn replacing_twice_is_replacing_once_and_forgets(name in name(), seed: u64, within in any_interval()) {
        let ifs = ifs(name);
        let replacement = Replacement { interval: within, digit: 1, with: 0 };
        let change = |code: &Code| replacement.change(code, ifs.digits());
        let code = any_code(&ifs, seed).replaced(within.from - 1, 1);
        prop_assert_eq!(change(&change(&code)), change(&code));
        let other = code.replaced(within.from - 1, 0);
        prop_assert!(code != other && change(&code) == change(&other));
    }

    #[test]
    fn a_code_change_moves_a_point_no_further_than_its_part_is_wide(name in name(), seed: u64, within in any_interval()) {
        let ifs = ifs(name);
        let bound = ifs.precision(within.from - 1) + 1e-9;
        let code = any_code(&ifs, seed);
        let changes: [Box<dyn CodeChange>; 3] = [
            Box::new(Permutation(within)),
            Box::new(Reversal(within)),
            Box::new(Insertion { interval: within, digit: 0 }),
        ];
        for change in changes {
            let deformation = Deformation::new(&ifs, vec![Deform::Codes(change)]).expect("legal");
            let point = ifs.point(&code);
            prop_assert!(distance(deformation.apply(point, &code), point) <= bound);
        }
    }

    #[test]
    fn displacement_vectors_shift_by_their_bound_at_most(seed: u64, within in any_interval(), delta in 0.1..0.95_f64) {
        let ifs = ifs("fern");
        let vectors = Displacement::OF_THE_SOURCE.to_vec();
        let displacement = Displacement { interval: within, delta, vectors, frame: Frame::FERN };
        let shift = |code: &Code| distance(displacement.of(code), [0.0; 3]);
        prop_assert!(shift(&any_code(&ifs, seed)) <= displacement.bound() * (1.0 + 1e-12));
        // The bound is tight: a code of the longest vector alone reaches it.
        let longest = Code::of(ifs.digits(), &[3; 64]).expect("fits");
        prop_assert!((shift(&longest) - displacement.bound()).abs() < 1e-9);
        let smaller = Displacement { delta: delta * 0.5, ..displacement.clone() };
        prop_assert!(smaller.bound() <= displacement.bound());
    }

    #[test]
    fn joints_stay_and_all_other_points_keep_their_bits(
        seed: u64, prefix in "[123]{1,4}", angle in -1.5..1.5_f64, factor in 0.2..2.0_f64,
    ) {
        let ifs = ifs("fern");
        let prefix = Code::parse(ifs.digits(), &prefix).expect("digits");
        let part = Part::turned(prefix, angle, factor);
        let deformation = Deformation::new(&ifs, vec![Deform::Part(part)]).expect("legal");
        let joint = ifs.point(&prefix);
        let full = Code::of(ifs.digits(), &[prefix.digits().collect(), vec![0; 60 - prefix.len()]].concat()).expect("fits");
        prop_assert_eq!(ifs.point(&full), joint);
        prop_assert_eq!(deformation.apply(joint, &full), joint);
        let code = any_code(&ifs, seed);
        let point = ifs.point(&code);
        let changed = deformation.apply(point, &code);
        if !code.starts_with(&prefix) {
            prop_assert_eq!(changed, point);
        }
        let within = prefix.digits().chain(code.digits()).take(64);
        let within = Code::packed(ifs.digits(), within);
        let (before, after) = (ifs.point(&within), deformation.apply(ifs.point(&within), &within));
        prop_assert!((distance(after, joint) - factor * distance(before, joint)).abs() < 1e-9);
    }

    #[test]
    fn parts_carry_the_parts_within_them(angle in 0.1..1.0_f64, inner in 0.1..1.0_f64, wrong_order: bool) {
        let ifs = ifs("fern");
        let code = |text: &str| Code::parse(ifs.digits(), text).expect("digits");
        let mut parts = [Part::turned(code("1"), angle, 1.0), Part::turned(code("13"), inner, 1.0)];
        if wrong_order {
            parts.reverse();
        }
        let deforms = parts.iter().copied().map(Deform::Part).collect();
        let both = Deformation::new(&ifs, deforms).expect("legal");
        let at = code("1321121");
        let outer_alone = Deformation::new(&ifs, vec![Deform::Part(Part::turned(code("1"), angle, 1.0))]).expect("legal");
        let joint = outer_alone.apply(ifs.point(&code("13")), &code("13"));
        let end = both.apply(ifs.point(&code("13")), &code("13"));
        prop_assert!(distance(joint, end) < 1e-12, "the leaf hangs where its frond carries it");
        let carried = outer_alone.apply(ifs.point(&at), &at);
        let turned = Part::turned(code("13"), inner, 1.0).about(joint, carried);
        prop_assert!(distance(both.apply(ifs.point(&at), &at), turned) < 1e-12);
    }
}

/// Whether an insertion put the digit at this place of the longer code.
fn inserted(within: Interval, place: usize) -> bool {
    let start = within.from - 1;
    let end = start + 2 * within.count() - 1;
    (start..end).contains(&place) && (place - start) % 2 == 1
}

#[test]
fn exchanging_places_3_and_5_is_the_worked_example_of_the_source() {
    let ifs = ifs("fern");
    let exchanged = |text: &str| {
        let code = Code::parse(ifs.digits(), text).expect("digits");
        Reversal(interval(3, 5)).change(&code, ifs.digits()).to_string()
    };
    assert_eq!((exchanged("1111201"), exchanged("1111001")), ("1121101".to_owned(), "1101101".to_owned()));
}

#[test]
fn the_joints_of_the_fern_are_those_of_the_source() {
    let ifs = ifs("fern");
    let joints = [("2", [0.0, 1.6]), ("3", [0.0, 0.44]), ("13", [0.0176, 1.974]), ("113", [0.0939, 3.2772])];
    for (prefix, [x, y]) in joints {
        let joint = ifs.point(&Code::parse(ifs.digits(), prefix).expect("digits"));
        assert!((joint[0] - x).abs() < 5e-5 && (joint[1] - y).abs() < 5e-5, "{prefix}: {joint:?}");
    }
}

#[test]
fn a_point_of_two_codes_is_torn_by_the_permutation() {
    let ifs = ifs("gasket");
    let within = Permutation(interval(2, 2));
    let deformation = Deformation::new(&ifs, vec![Deform::Codes(Box::new(within))]).expect("legal");
    let code = |digits: &[u8]| Code::of(ifs.digits(), digits).expect("fits");
    let (one, other) = (code(&[&[0][..], &[1; 23][..]].concat()), code(&[1]));
    assert!(distance(ifs.point(&one), ifs.point(&other)) < 1e-6, "both are (0.5, 0)");
    assert!(distance(deformation.apply(ifs.point(&one), &one), [0.25, 0.25, 0.0]) < 1e-6);
    let other = code(&[1, 0, 0, 0, 0, 0]);
    assert!(distance(deformation.apply(ifs.point(&other), &other), [0.75, 0.0, 0.0]) < 1e-6);
}

#[test]
fn a_field_is_looked_up_where_the_changed_code_points() {
    let ifs = ifs("gasket");
    let code = Code::parse(ifs.digits(), "012012012").expect("digits");
    let point = ifs.point(&code);
    let field = Field::of_the_source(0.4, Frame::UNIT);
    let deforms = vec![Deform::Field(field.clone()), Deform::Codes(Box::new(Permutation(interval(2, 4))))];
    let deformation = Deformation::new(&ifs, deforms).expect("legal");
    let shift = field.at(ifs.point(&deformation.code(&code)));
    assert_eq!(deformation.apply(point, &code), [point[0] + shift[0], point[1] + shift[1], 0.0]);
    assert!(distance(shift, field.at(point)) > 1e-3, "the changed code points elsewhere");
}

#[test]
fn replacement_leaves_the_stated_share_of_codes() {
    for (name, kept) in [("gasket", 0.296), ("fern", 0.422)] {
        let ifs = ifs(name);
        let replacement = Replacement { interval: interval(2, 4), digit: 2, with: 0 };
        let mut all = Vec::new();
        crate::ifs::expansion::parts(&ifs, 4, |part| {
            all.push(replacement.change(&part.code, ifs.digits()));
        })
        .expect("few");
        let before = all.len() as f64;
        all.sort_unstable();
        all.dedup();
        assert!((all.len() as f64 / before - kept).abs() < 5e-4, "{name}: {} of {before}", all.len());
    }
}

#[test]
fn permutation_moves_nearly_all_points_of_the_game_and_keeps_their_number() {
    let ifs = ifs("fern");
    let deforms = vec![Deform::Codes(Box::new(Permutation(interval(5, 7))))];
    let deformation = Deformation::new(&ifs, deforms).expect("legal");
    let mut moved = 0;
    Game::new(&ifs, 1).points(10_000, |block| {
        for i in 0..block.len() {
            let (point, code) = (block.point(i).map(f64::from), block.code(i, &ifs));
            moved += u32::from(distance(point, deformation.apply(point, &code)) > 1e-3);
        }
    });
    assert!(moved > 9_000, "{moved} of 10000");
}

#[test]
fn faulty_deformations_say_what_is_wrong() {
    let ifs = ifs("fern");
    let faults = |deform: Deform| Deformation::new(&ifs, vec![deform]).expect_err("faulty").join("; ");
    let permutation = |from, to| Deform::Codes(Box::new(Permutation(interval(from, to))));
    assert_eq!(
        faults(permutation(7, 5)),
        "`from` is 7 and `to` is 5; the first place must not lie after the last"
    );
    assert_eq!(faults(permutation(0, 5)), "`from` is 0, but places of a code are counted from 1");
    assert_eq!(faults(permutation(60, 65)), "`to` is 65, but codes of this fractal have 64 digits");
    let swap = Swap { interval: interval(1, 2), between: [1, 4] };
    assert_eq!(faults(Deform::Codes(Box::new(swap))), "digit 4 names no map; the digits here are 0 to 3");
    let long = Insertion { interval: interval(1, 64), digit: 0 };
    let twice = vec![Deform::Codes(Box::new(long)), Deform::Codes(Box::new(long))];
    let faults_of_two = Deformation::new(&ifs, twice).expect_err("too long").join("; ");
    assert_eq!(faults_of_two, "insertions make codes of 190 digits; they hold at most 128");
    let few =
        Displacement { interval: interval(1, 1), delta: 0.5, vectors: vec![[0.0; 3]; 3], frame: Frame::UNIT };
    assert!(faults(Deform::Displacement(few)).starts_with("3 displacement vectors are too few"));
}

//! What holds for fractals, their codes and their points.

use proptest::prelude::*;
use rayon::prelude::*;

use super::expansion::{parts, points};
use super::game::CHUNK;
use super::map::distance;
use super::shapes::{self, SHAPES};
use super::*;
use weald_core::random::hash2;

fn ifs(name: &str) -> Ifs {
    shapes::find(name).expect("built in").ifs()
}

fn draft(maps: &[([f64; 6], f64)]) -> Draft {
    let weighted = |&(numbers, probability): &([f64; 6], f64)| Weighted {
        map: Map::planar(numbers),
        probability,
        role: Role::Branch,
    };
    Draft { name: "mine".to_owned(), maps: maps.iter().map(weighted).collect(), code_digits: None }
}

const HALF: [f64; 6] = [0.5, 0.0, 0.0, 0.5, 0.0, 0.0];
const OTHER: [f64; 6] = [0.5, 0.0, 0.0, 0.5, 0.5, 0.0];

/// Points of the game as they come.
fn played(ifs: &Ifs, count: u64) -> Vec<(Point, Code)> {
    let mut points = Vec::new();
    Game::new(ifs, 7).points(count, |block| {
        points.extend((0..block.len()).map(|i| (block.point(i).map(f64::from), block.code(i, ifs))));
    });
    points
}

#[test]
fn a_hundred_thousand_points_come_back_from_their_codes() {
    for shape in SHAPES {
        let ifs = shape.ifs();
        let precision = ifs.precision(ifs.code_digits()) + 1e-5 * ifs.diameter();
        let points = played(&ifs, 100_000);
        assert_eq!(points.len(), 100_000);
        let worst = points.iter().map(|(at, code)| distance(*at, ifs.point(code))).fold(0.0, f64::max);
        assert!(worst > 0.0 && worst <= precision, "{}: {worst} of {precision}", shape.name);
    }
}

#[test]
fn a_point_without_its_code_is_found_by_its_place() {
    for name in ["gasket", "fern", "dragon", "fern-3d"] {
        let ifs = ifs(name);
        let precision = 2.0 * ifs.precision(ifs.code_digits()) + 1e-9;
        let points = played(&ifs, 500);
        let worst = points.par_iter().map(|(_, code)| {
            let at = ifs.point(code);
            let (found, off) = code_of(&ifs, at, precision).unwrap_or_else(|| panic!("{name}: {code}"));
            assert_eq!(off, distance(ifs.point(&found), at));
            off
        });
        let worst = worst.reduce(|| 0.0, f64::max);
        assert!(worst <= precision, "{name}: {worst} of {precision}");
    }
    assert_eq!(code_of(&ifs("gasket"), [0.9, 0.9, 0.0], 0.01), None, "a hole of the gasket");
}

#[test]
fn all_points_lie_in_the_box_and_reach_its_sides() {
    for shape in SHAPES {
        let ifs = shape.ifs();
        let [low, high] = ifs.bounds();
        let slack = 1e-5 * ifs.diameter();
        let (mut least, mut most) = ([f64::MAX; 3], [f64::MIN; 3]);
        for (at, _) in played(&ifs, 300_000) {
            for i in 0..3 {
                (least[i], most[i]) = (least[i].min(at[i]), most[i].max(at[i]));
            }
        }
        for i in 0..3 {
            assert!(least[i] >= low[i] - slack && most[i] <= high[i] + slack, "{} {i}", shape.name);
            let gap = (least[i] - low[i]).max(high[i] - most[i]);
            assert!(gap <= 0.06 * ifs.diameter(), "{} axis {i}: {gap} is left empty", shape.name);
        }
    }
}

#[test]
fn the_box_of_the_fern_is_the_published_one() {
    let [low, high] = ifs("fern").bounds();
    let published = [(low[0], -2.18), (high[0], 2.66), (low[1], 0.0), (high[1], 10.0)];
    assert!(published.iter().all(|(ours, theirs)| (ours - theirs).abs() < 0.01), "{low:?} {high:?}");
}

#[test]
fn threads_do_not_change_points() {
    let ifs = ifs("fern");
    let count = 3 * CHUNK + 1000;
    let whole = played(&ifs, count);
    for threads in [1, 2, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let game = Game::new(&ifs, 7);
        let chunks: Vec<Vec<(Point, Code)>> = pool.install(|| {
            (0..4_u64)
                .into_par_iter()
                .map(|chunk| {
                    let mut points = Vec::new();
                    game.chunk(chunk, count - chunk * CHUNK, |block| {
                        points.extend(
                            (0..block.len()).map(|i| (block.point(i).map(f64::from), block.code(i, &ifs))),
                        );
                    });
                    points
                })
                .collect()
        });
        assert_eq!(chunks.concat(), whole, "{threads} threads");
    }
}

#[test]
fn any_number_of_maps_plays_the_same_game_by_look_up_and_by_selection() {
    let ifs = ifs("fern");
    let table = Table::of(&ifs);
    let [chosen, looked_up] =
        lanes::both(&table, &lanes::Lanes::at_root(&ifs, &Game::new(&ifs, 9).keys(0)), 300);
    assert_eq!(chosen, looked_up);
}

#[test]
fn maps_get_their_shares_of_the_points_and_no_two_steps_depend_on_each_other() {
    let ifs = ifs("fern");
    let mut single = [0_u64; 4];
    let mut pairs = [[0_u64; 4]; 4];
    let count = 2_000_000;
    Game::new(&ifs, 3).points(count, |block| {
        for i in 0..block.len() {
            let (newest, before) = (block.digit(i, 0), block.digit(i, 1));
            single[usize::from(newest)] += 1;
            pairs[usize::from(before)][usize::from(newest)] += 1;
        }
    });
    let share = |m: usize| ifs.maps()[m].probability;
    for m in 0..4 {
        assert!(close(single[m], share(m), count), "{m}: {single:?}");
        for n in 0..4 {
            assert!(close(pairs[m][n], share(m) * share(n), count), "{m} then {n}: {pairs:?}");
        }
    }
}

/// Whether a count is within five standard deviations of what a share gives, and the rounding of shares.
fn close(found: u64, share: f64, of: u64) -> bool {
    let expected = share * of as f64;
    (found as f64 - expected).abs() < 5.0 * expected.sqrt() + of as f64 / 65536.0
}

#[test]
fn an_expansion_has_every_code_once_and_points_of_the_game_lie_near_it() {
    let ifs = ifs("gasket");
    let expanded = points(&ifs, 6).expect("few");
    assert_eq!(expanded.len(), 729);
    assert!(expanded.windows(2).all(|pair| pair[0].code < pair[1].code));
    let reach = ifs.precision(6);
    for (at, code) in played(&ifs, 2_000) {
        let near =
            expanded.binary_search_by(|coded| coded.code.cmp(&code.prefix(6))).expect("every code is there");
        assert!(distance(expanded[near].at, at) <= reach);
    }
}

#[test]
fn faulty_fractals_are_told_apart() {
    let fault = |maps: &[([f64; 6], f64)]| Ifs::new(draft(maps)).unwrap_err().to_string();
    assert_eq!(fault(&[]), "a fractal needs at least 2 maps and has 0");
    assert_eq!(fault(&[(HALF, 1.0)]), "a fractal needs at least 2 maps and has 1");
    assert!(fault(&vec![(HALF, 1.0 / 257.0); 257]).starts_with("a fractal of 257 maps is too large"));
    let grows = [1.2, 0.0, 0.0, 0.4, 0.0, 0.0];
    assert!(
        fault(&[(HALF, 0.5), (grows, 0.5)]).starts_with("map 1 does not contract: it lengthens by 1.200")
    );
    assert!(fault(&[(HALF, 0.5), (OTHER, 0.4)]).starts_with("the probabilities sum to 0.9, not to 1"));
    assert_eq!(
        fault(&[(HALF, 1.5), (OTHER, -0.5)]),
        "the probability of map 0 is 1.5; it must be above 0 and at most 1"
    );
    assert_eq!(fault(&[(HALF, 0.5), ([f64::NAN; 6], 0.5)]), "map 1 has a number that is not finite");
    let long = Draft { code_digits: Some(257), ..draft(&[(HALF, 0.5), (OTHER, 0.5)]) };
    let message = "codes of 257 digits do not fit: with 2 maps a code holds 1 to 256";
    assert_eq!(Ifs::new(long).unwrap_err().to_string(), message);
}

#[test]
fn maps_that_contract_only_in_a_row_make_a_fractal() {
    // Each lengthens one way, any two in a row shorten.
    let sheared = [0.2, 0.6, -0.2, 0.2, 1.0, 0.5];
    let map = Map::planar([0.0, 1.1, 0.0, 0.0, 0.0, 0.0]);
    assert!(map.ratio() > 1.0);
    let ifs =
        Ifs::new(draft(&[([0.0, 1.1, 0.0, 0.0, 0.0, 0.0], 0.5), (sheared, 0.5)])).expect("words contract");
    assert!(ifs.ratio_of(200) < 0.1 * ifs.ratio_of(20) && ifs.diameter() > 0.0);
}

#[test]
fn an_expansion_beyond_the_limit_is_refused_before_it_begins() {
    let error = parts(&ifs("fern"), 14, |_| panic!("nothing is expanded")).expect_err("4^14 parts");
    assert!(error.to_string().contains("choose a depth of 13 or less"), "{error}");
    assert_eq!(error.exit_code(), 5);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_contracting_maps_keep_their_points_in_their_box(
        maps in prop::collection::vec(prop::array::uniform6(-0.55..0.55_f64), 2..6),
        scale in 0.1..10.0_f64,
    ) {
        let even = 1.0 / maps.len() as f64;
        let weighted: Vec<_> = maps.iter().map(|numbers| (*numbers, even)).collect();
        let Ok(ifs) = Ifs::new(draft(&weighted)) else { return Ok(()); };
        let seen = ifs.in_units(scale, [1.0, -2.0, 0.0]);
        let [low, high] = seen.bounds();
        let slack = 1e-6 * (1.0 + seen.diameter());
        for number in 0..200_i64 {
            let digits: Vec<u8> = (0..40).map(|place| (hash2(5, number, place) % maps.len() as u64) as u8).collect();
            let code = Code::of(ifs.digits(), &digits).expect("fits");
            let at = seen.point(&code);
            prop_assert!((0..3).all(|i| at[i] >= low[i] - slack && at[i] <= high[i] + slack), "{at:?}");
            let unscaled = ifs.point(&code);
            prop_assert!((at[0] - (scale * unscaled[0] + 1.0)).abs() < 1e-9 * (1.0 + scale * ifs.diameter()));
        }
    }
}

#[test]
fn the_shares_of_a_game_are_those_of_the_maps_and_make_a_whole() {
    for shape in SHAPES {
        let ifs = shape.ifs();
        let shares = Game::new(&ifs, 7).shares();
        assert_eq!((shares.len(), shares.iter().sum::<u32>()), (ifs.maps().len(), 1 << 16), "{}", shape.name);
        for (share, weighted) in shares.iter().zip(ifs.maps()) {
            let off = f64::from(*share) / 65536.0 - weighted.probability;
            assert!(off.abs() < 0.01, "{}: {off}", shape.name);
        }
    }
}

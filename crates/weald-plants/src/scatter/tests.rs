use super::pattern::{CUTS, Pattern, Place, Suitability, overlap, squared};
use super::*;
use proptest::prelude::*;
use weald_core::grid::{Mask, Size};
use weald_engine::Unwatched;

/// Ground whose suitability is a function of the place.
struct Land<F> {
    extent: [f64; 2],
    suitability: F,
    /// By how much the suitability changes in a metre, at most.
    steepness: f64,
}

impl<F: Fn([f64; 2]) -> f64 + Sync> Suitability for Land<F> {
    fn extent(&self) -> [f64; 2] {
        self.extent
    }

    fn suitability(&self, place: [f64; 2]) -> f64 {
        let inside = (0..2).all(|axis| place[axis] >= 0.0 && place[axis] <= self.extent[axis]);
        if inside { (self.suitability)(place) } else { 0.0 }
    }

    fn bounds(&self, [low, high]: [[f64; 2]; 2]) -> [f64; 2] {
        let overlaps = |axis: usize| low[axis] <= self.extent[axis];
        if !(overlaps(0) && overlaps(1)) {
            return [0.0; 2];
        }
        let middle = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
        let (value, off) = ((self.suitability)(middle), 0.5 * self.steepness * squared(low, high).sqrt());
        let inside = (0..2).all(|axis| high[axis] <= self.extent[axis]);
        [if inside { (value - off).max(0.0) } else { 0.0 }, (value + off).min(1.0)]
    }
}

fn even(side: f64) -> Land<impl Fn([f64; 2]) -> f64 + Sync> {
    Land { extent: [side; 2], suitability: |_| 1.0, steepness: 0.0 }
}

/// From 1 in the west to nothing in the east, over `side` metres.
fn fading(side: f64) -> Land<impl Fn([f64; 2]) -> f64 + Sync> {
    Land { extent: [side; 2], suitability: move |[x, _]: [f64; 2]| 1.0 - x / side, steepness: 1.0 / side }
}

/// Patches of all densities and none.
fn patchy(side: f64) -> Land<impl Fn([f64; 2]) -> f64 + Sync> {
    let wave = |along: f64| 0.5 + 0.5 * libm::sin(along / 9.0);
    let suitability = move |[x, y]: [f64; 2]| (1.4 * wave(x) * wave(y) - 0.3).clamp(0.0, 1.0);
    Land { extent: [side, 0.7 * side], suitability, steepness: 0.16 }
}

fn places(ground: &dyn Suitability, spacing: f64, seed: u64) -> Vec<Place> {
    Pattern { ground, spacing, seed, cuts: CUTS }.places(&Unwatched).expect("nobody interrupts")
}

/// The nearest distance to another place, for each.
fn nearest(places: &[Place]) -> Vec<f64> {
    let others = |place: &Place| {
        let apart =
            places.iter().filter(|other| other.rank != place.rank).map(|other| squared(other.at, place.at));
        apart.fold(f64::INFINITY, f64::min).sqrt()
    };
    places.iter().map(others).collect()
}

#[test]
fn discs_never_overlap_and_their_number_is_that_of_a_full_pattern() {
    let full = places(&even(60.0), 1.0, 5);
    let expected = DENSITY * 60.0 * 60.0;
    // Discs stand out over the edge, where there is nothing.
    let shares = full.len() as f64 / expected;
    assert!((1.0..1.05).contains(&shares), "{} places for {expected}", full.len());
    assert!(nearest(&full).iter().all(|apart| *apart >= 1.0));
    let patches = places(&patchy(120.0), 1.0, 5);
    assert!(patches.len() > 1000, "{}", patches.len());
    for (number, place) in patches.iter().enumerate() {
        assert!(patches[..number].iter().all(|other| !overlap(other, place)), "{place:?}");
        assert!((place.diameter - 1.0 / place.suitability.max(1.0 / 64.0).sqrt()).abs() < 1e-12);
    }
}

#[test]
fn no_room_is_left_for_another() {
    let (spacing, side) = (1.0, 40.0);
    let full = places(&even(side), spacing, 11);
    let steps = 400;
    let mut farthest: f64 = 0.0;
    for cell in 0..steps * steps {
        let at = [cell % steps, cell / steps].map(|step| (f64::from(step) + 0.5) * side / f64::from(steps));
        let apart = full.iter().map(|place| squared(place.at, at)).fold(f64::INFINITY, f64::min);
        farthest = farthest.max(apart.sqrt());
    }
    assert!(farthest < 1.03 * spacing, "a place {farthest} m from all others is free");
}

#[test]
fn density_follows_suitability() {
    let side = 240.0;
    let fading = places(&fading(side), 1.0, 3);
    // Tenths from west to east: 95 %, 85 % … of the densest.
    for tenth in 0..10 {
        let within = |place: &&Place| (place.at[0] / side * 10.0) as usize == tenth;
        let found = fading.iter().filter(within).count() as f64;
        let expected = DENSITY * side * side / 10.0 * (0.95 - tenth as f64 / 10.0);
        assert!((found / expected - 1.0).abs() < 0.08, "tenth {tenth}: {found} places for {expected}");
    }
    let sparse = Land { extent: [400.0; 2], suitability: |_| 0.004, steepness: 0.0 };
    let (found, expected) = (places(&sparse, 1.0, 3).len() as f64, DENSITY * 400.0 * 400.0 * 0.004);
    assert!((found / expected - 1.0).abs() < 0.15, "{found} places for {expected}, kept at random");
}

/// Mean power of waves along the axes in the middle of the ground, away from its edges; white noise has 1.
fn power(places: &[Place], side: f64, waves: std::ops::Range<usize>) -> f64 {
    let edge = 0.1 * side;
    let is_inside = |place: &&Place| place.at.iter().all(|along| (edge..side - edge).contains(along));
    let places: Vec<_> = places.iter().filter(is_inside).collect();
    let side = side - 2.0 * edge;
    let mut sum = 0.0;
    for wave in waves.clone() {
        for axis in 0..2 {
            let step = std::f64::consts::TAU * wave as f64 / side;
            let add = |(c, s): (f64, f64), place: &&Place| {
                let angle = step * place.at[axis];
                (c + libm::cos(angle), s + libm::sin(angle))
            };
            let (c, s) = places.iter().fold((0.0, 0.0), add);
            sum += (c * c + s * s) / places.len() as f64;
        }
    }
    sum / (2 * waves.len()) as f64
}

#[test]
fn the_pattern_is_blue_and_not_white() {
    let side = 100.0;
    let full = places(&even(side), 1.0, 7);
    let (long, short) = (power(&full, side, 3..32), power(&full, side, 72..104));
    assert!(long < 0.25 && short > 1.0, "long waves {long}, short ones {short}");
    let sparse = Land { extent: [side; 2], suitability: |_| 0.05, steepness: 0.0 };
    let thin = places(&sparse, 0.25, 7);
    let (long, short) = (power(&thin, side, 3..29), power(&thin, side, 64..93));
    assert!(long < 0.25 && short > 1.0, "on sparse ground: long waves {long}, short ones {short}");
}

#[test]
fn tiles_of_any_size_on_any_number_of_threads_give_the_whole() {
    for (name, ground) in
        [("even", &even(30.0) as &dyn Suitability), ("patchy", &patchy(70.0)), ("fading", &fading(38.0))]
    {
        let pattern = Pattern { ground, spacing: 1.0, seed: 21, cuts: CUTS };
        let whole = pattern.in_tiles(1000, &Unwatched).expect("nobody interrupts");
        assert!(whole.len() > 400, "{name}: {}", whole.len());
        for (tile, threads) in [(6, 1), (7, 2), (16, 3)] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let tiled = pool.install(|| pattern.in_tiles(tile, &Unwatched)).expect("nobody interrupts");
            assert!(tiled == whole, "{name} in tiles of {tile}: {} places for {}", tiled.len(), whole.len());
        }
    }
}

#[test]
fn another_seed_gives_other_places() {
    assert_ne!(places(&even(20.0), 1.0, 1), places(&even(20.0), 1.0, 2));
    assert_eq!(places(&even(20.0), 1.0, 1), places(&even(20.0), 1.0, 1));
}

/// A slope that rises by 0.5 m a metre to the east, with a hole.
fn slope(cell: f64, valid: Option<Mask>) -> Landscape {
    let size = Size::new(40, 30).expect("small");
    let mut landscape = Landscape::new(Domain { valid, ..Domain::new(size, cell) });
    landscape.insert("height", "m", Field::from_function(size, |x, _| (0.5 * cell) as f32 * x as f32));
    landscape.insert("soil", "1", Field::from_function(size, |_, y| y as f32));
    landscape
}

fn scattered(step: &Scatter, landscape: &mut Landscape) -> (Outcome, Vec<Plant>) {
    let outcome = step.run(landscape, &Job::unwatched(4)).expect("runs");
    (outcome, landscape.plants(&step.into.0).expect("set").plants.clone())
}

#[test]
fn plants_stand_on_the_ground_within_their_sizes_and_lean_as_told() {
    for (upright, east) in [(1.0, 0.0), (0.0, -0.447_21), (0.5, -0.229_75)] {
        let mut landscape = slope(10.0, None);
        let step = Scatter { spacing: 6.0, upright, size: vec![2.0, 3.0], ..Scatter::default() };
        let (_, plants) = scattered(&step, &mut landscape);
        assert!(plants.len() > 2000);
        for Plant { place: [x, _, z], up, size, turn, phase, .. } in &plants {
            assert!((z - 0.5 * (x - 5.0)).abs() < 1e-4, "height {z} at {x}");
            assert!((up[0] - east).abs() < 1e-4 && up[1].abs() < 1e-6 && up[2] > 0.0, "{up:?}");
            assert!(
                (2.0..=3.0).contains(size)
                    && (0.0..std::f32::consts::TAU).contains(turn)
                    && (0.0..1.0).contains(phase)
            );
        }
        let mean = plants.iter().map(|plant| f64::from(plant.size)).sum::<f64>() / plants.len() as f64;
        assert!((mean - 2.5).abs() < 0.02, "sizes have a mean of {mean}");
    }
}

#[test]
fn vigour_lets_the_ground_set_the_size() {
    let mut landscape = slope(10.0, None);
    let soil =
        Condition { layer: LayerName::of("soil"), above: Some(15.0), soft: 30.0, ..Condition::default() };
    let step = Scatter { vigour: 1.0, r#where: vec![Nested(soil)], ..Scatter::default() };
    let (_, plants) = scattered(&step, &mut landscape);
    for Plant { size, suitability, .. } in &plants {
        assert!((size - (0.6 + 0.6 * suitability)).abs() < 1e-5);
    }
    let least = plants.iter().map(|plant| plant.suitability).fold(1.0, f32::min);
    assert!(least < 0.3, "some stand on poor ground: {least}");
}

#[test]
fn a_count_is_met_exactly_as_far_apart_as_can_be_and_never_closer_than_the_spacing() {
    let mut landscape = slope(10.0, None);
    let step = Scatter { count: Some(1234), spacing: 1.0, ..Scatter::default() };
    let (outcome, plants) = scattered(&step, &mut landscape);
    assert_eq!((plants.len(), outcome.notes.len()), (1234, 0));
    let spacing = landscape.plants("plants").expect("set").spacing;
    let widest = (DENSITY * 390.0 * 290.0 / 1234.0).sqrt();
    assert!((0.97 * widest..1.04 * widest).contains(&spacing), "{spacing} m, at most {widest} m or so");
    let crowded = Scatter { spacing: 20.0, ..step };
    let (outcome, plants) = scattered(&crowded, &mut landscape);
    assert!((150..300).contains(&plants.len()), "{}", plants.len());
    assert!(outcome.notes[0].starts_with(&format!("{} of 1234 plants", plants.len())), "{:?}", outcome.notes);
}

#[test]
fn conditions_water_and_no_data_keep_plants_out_to_the_metre() {
    let size = Size::new(40, 30).expect("small");
    let hole = |cell: usize| (cell % 40).abs_diff(20).pow(2) + (cell / 40).abs_diff(15).pow(2) > 40;
    let mut landscape = slope(10.0, Mask::new(size, (0..size.cells()).map(hole).collect()));
    landscape.insert("water", "m", Field::from_function(size, |x, _| if x < 10 { 2.0 } else { 0.0 }));
    let soil = Condition { layer: LayerName::of("soil"), above: Some(6.25), ..Condition::default() };
    let step = Scatter { spacing: 3.0, r#where: vec![Nested(soil)], ..Scatter::default() };
    let (_, plants) = scattered(&step, &mut landscape);
    assert!(plants.len() > 2000, "{}", plants.len());
    let least = |axis: usize| plants.iter().map(|plant| plant.place[axis]).fold(f64::INFINITY, f64::min);
    // The bound lies a quarter of the way between two rows of centres; water ends within a step of columns.
    assert!((67.5..68.5).contains(&least(1)), "southward from {} m", least(1));
    assert!((104.5..106.0).contains(&least(0)), "eastward from {} m", least(0));
    for plant in &plants {
        let [x, y] = [plant.place[0] / 10.0, plant.place[1] / 10.0];
        assert!(
            landscape.domain.valid.as_ref().expect("a hole").is_valid(x as usize, y as usize)
                || near_edge(x, y)
        );
    }
    let counted: f64 = landscape.field("plants").expect("written").sum() * 100.0;
    assert!((counted - plants.len() as f64).abs() < 0.1, "{counted} in the layer, {} plants", plants.len());
}

/// Half a square of three cells with data lies partly in the fourth.
fn near_edge(x: f64, y: f64) -> bool {
    let distance = ((x - 20.5).powi(2) + (y - 15.5).powi(2)).sqrt();
    distance > 5.0
}

#[test]
fn too_many_plants_are_a_limit_that_says_how_far_apart_is_possible() {
    let mut landscape = slope(100.0, None);
    let step = Scatter { spacing: 0.2, ..Scatter::default() };
    let error = step.run(&mut landscape, &Job::unwatched(4)).expect_err("too many");
    assert_eq!(error.exit_code(), 5);
    assert!(error.to_string().contains("choose 0.89 m or more"), "{error}");
    let Error::Limit(Limit { what: Quantity::Plants, asked: Some(asked), allowed, .. }) = error else {
        panic!("{error:?}")
    };
    assert_eq!(allowed, 0..=u64::from(MAX_PLANTS));
    // As many as a spacing of that square root times as much would have room for.
    let spacing = 0.2 * (asked as f64 / f64::from(MAX_PLANTS)).sqrt();
    assert!((0.88..=0.89).contains(&spacing), "{asked} plants");
}

#[test]
fn a_spacing_for_too_many_plants_is_widened_where_conditions_decide_and_told() {
    let step = Scatter { spacing: 0.2, ..Scatter::default() };
    let area = 1.0e7;
    let spacing = step.narrowest(area).expect("too narrow");
    let enough = Scatter { spacing, ..Scatter::default() };
    assert!(enough.narrowest(area).is_none() && enough.narrowest(1.05 * area).is_some(), "{spacing} m");
    let notes = step.outcome(spacing, 9_000_000).notes.join("\n");
    assert!(notes.contains(&format!("stand {spacing} m apart, not 0.2 m")), "{notes}");
    assert_eq!(step.outcome(0.2, 9).notes, Vec::<String>::new());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn any_ground_cut_into_any_tiles_gives_the_whole(
        seed in any::<u64>(), spacing in 0.6..2.5_f64, tile in 4_i64..12, suits in 0.002..1.0_f64,
    ) {
        let wavy = move |[x, y]: [f64; 2]| suits * (0.55 + 0.45 * libm::sin(x / 5.0 + y / 11.0));
        let ground = Land { extent: [40.0, 35.0], suitability: wavy, steepness: 0.1 };
        let pattern = Pattern { ground: &ground, spacing, seed, cuts: CUTS };
        let whole = pattern.in_tiles(1000, &Unwatched).expect("nobody interrupts");
        prop_assert_eq!(pattern.in_tiles(tile, &Unwatched).expect("nobody interrupts"), whole);
    }
}

/// Rough ground with holes, a shore, and two conditions.
fn rough_site(seed: u64) -> (Landscape, Vec<Condition>) {
    let size = Size::new(24, 18).expect("small");
    let value = move |stream: i64, x: usize, y: usize| {
        random::unit(random::hash2(seed ^ stream as u64, x as i64, y as i64)) as f32
    };
    let mut domain = Domain::new(size, 10.0);
    domain.valid =
        Mask::new(size, (0..size.cells()).map(|cell| value(9, cell % 24, cell / 24) < 0.95).collect());
    let mut landscape = Landscape::new(domain);
    for (stream, (name, scale)) in
        [("height", 50.0), ("soil", 1.0), ("light", 1.0), ("water", 0.2)].iter().enumerate()
    {
        let field = Field::from_function(size, |x, y| scale * value(stream as i64, x, y));
        landscape.insert(name, "1", field);
    }
    let above =
        Condition { layer: LayerName::of("soil"), above: Some(0.3), soft: 0.5, ..Condition::default() };
    let below =
        Condition { layer: LayerName::of("light"), below: Some(0.8), soft: 0.1, ..Condition::default() };
    (landscape, vec![above, below])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn no_place_of_a_rectangle_is_better_or_worse_than_its_bounds(
        seed in any::<u64>(), corner in [-5.0..240.0_f64, -5.0..180.0_f64], side in 0.01..30.0_f64,
    ) {
        let (landscape, conditions) = rough_site(seed);
        let site = Site::new(&landscape, "height", conditions.iter(), 0.1).expect("layers are there");
        let mut suits = 0;
        for step in 0..40 {
            let side = if step % 2 == 0 { side } else { 0.05 * side };
            let low = [0, 1].map(|axis| corner[axis] + 7.3 * f64::from(step % 5) * (axis as f64 - 0.4));
            let [least, most] = site.bounds([low, low.map(|at| at + side)]);
            for probe in 0..49 {
                let at = [low[0] + side * f64::from(probe % 7) / 6.0, low[1] + side * f64::from(probe / 7) / 6.0];
                let suitability = site.suitability(at);
                suits += usize::from(suitability > 0.0);
                prop_assert!(
                    suitability >= least - 1e-6 && suitability <= most + 1e-6,
                    "{suitability} at {at:?}, within {least} and {most}"
                );
            }
        }
        prop_assume!(suits > 0);
    }
}

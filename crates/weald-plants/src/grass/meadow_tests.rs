//! Sets are a function of the maps, the same for tiles as for the whole, evenly placed, and as many as the density says.

use proptest::prelude::*;

use super::curves::Curves;
use super::meadow::{Area, Maps, Meadow};
use super::{Bend, Instance, Packed, SPECIES};
use weald_core::grid::{Field, Mask, Size};

const SIDE: usize = 20;

fn field(value: impl FnMut(usize, usize) -> f32) -> Field {
    Field::from_function(Size::square(SIDE).expect("small"), value)
}

/// A square of 40 m, of two species, the second in the east.
fn meadow(density: impl FnMut(usize, usize) -> f32) -> Meadow {
    Meadow {
        species: vec![SPECIES[0].clone(), SPECIES[2].clone()],
        bend: Bend::Total,
        seed: 7,
        densest: 10.0,
        level: 4.0,
        mown_height: 0.05,
        deepest: 0.1,
        tussocks: 0.0,
        maps: Maps {
            cell: 2.0,
            valid: None,
            density: field(density),
            soil: field(|x, _| x as f32 / 19.0),
            light: field(|_, y| y as f32 / 19.0),
            shares: vec![field(|x, _| 1.0 - x as f32 / 19.0), field(|_, _| 1.0)],
            water: None,
            mown: None,
            trodden: None,
        },
    }
}

fn places(sets: &[Packed]) -> Vec<[f32; 2]> {
    sets.iter().map(|&packed| Instance::unpack(packed).place).collect()
}

/// The mean distance to the nearest other, beside that of as many places by pure chance.
fn evenness(sets: &[Packed], area: f64) -> f64 {
    let places = places(sets);
    let nearest = |place: &[f32; 2]| {
        let apart = |other: &[f32; 2]| (place[0] - other[0]).hypot(place[1] - other[1]);
        places.iter().map(apart).filter(|&apart| apart > 0.0).fold(f32::INFINITY, f32::min)
    };
    let mean = places.iter().map(|place| f64::from(nearest(place))).sum::<f64>() / places.len() as f64;
    mean / (0.5 * (area / places.len() as f64).sqrt())
}

#[test]
fn there_are_as_many_sets_as_the_density_says_and_they_stand_more_evenly_than_by_chance() {
    for density in [1.0_f32, 0.5, 0.2, 0.05] {
        let meadow = meadow(|_, _| density);
        let sets = meadow.sets(&meadow.area());
        // Half a cell along each side has no ground on both sides.
        let ground = 38.0_f64 * 38.0;
        let expected = f64::from(density) * 10.0 * ground;
        assert!((sets.len() as f64 / expected - 1.0).abs() < 0.04, "{} of {expected}", sets.len());
        let evenness = evenness(&sets, ground);
        assert!(evenness > 1.15, "density {density}: {evenness} times as far apart as by chance");
    }
}

#[test]
fn soil_light_and_species_are_those_of_the_place() {
    let meadow = meadow(|_, _| 1.0);
    let (mut east, mut reeds) = ([0.0; 2], [0.0; 2]);
    for packed in meadow.sets(&meadow.area()) {
        let Instance { place: [x, y], species, tuft } = Instance::unpack(packed);
        assert!(
            (tuft.soil - (x / 2.0 - 0.5) / 19.0).abs() < 1e-3
                && (tuft.light - (y / 2.0 - 0.5) / 19.0).abs() < 1e-3
        );
        let half = usize::from(x > 20.0);
        east[half] += 1.0;
        reeds[half] += f64::from(species);
    }
    let [west, east] = [reeds[0] / east[0], reeds[1] / east[1]];
    assert!((west - 0.25).abs() < 0.03 && (east - 0.75).abs() < 0.03, "{west} and {east} are reeds");
}

/// Of pairs of sets of reeds and ryegrass that are about so far apart, those of one species; and the mean difference of their soils.
fn alike(sets: &[Instance], apart: std::ops::Range<f32>) -> [f64; 2] {
    let mut sum = [0.0; 3];
    for (number, one) in sets.iter().enumerate() {
        for other in &sets[..number] {
            let away = (one.place[0] - other.place[0]).hypot(one.place[1] - other.place[1]);
            if apart.contains(&away) {
                let is_alike = f64::from(u8::from(one.species == other.species));
                let parts = [1.0, is_alike, f64::from((one.tuft.soil - other.tuft.soil).abs())];
                (0..3).for_each(|part| sum[part] += parts[part]);
            }
        }
    }
    [sum[1] / sum[0], sum[2] / sum[0]]
}

#[test]
fn sets_of_a_tussock_share_soil_and_species_and_all_together_have_those_of_the_maps() {
    let even = Meadow { densest: 30.0, tussocks: 0.6, ..meadow(|_, _| 1.0) };
    let maps =
        Maps { soil: field(|_, _| 0.5), shares: vec![field(|_, _| 0.6), field(|_, _| 1.0)], ..even.maps };
    let even = Meadow { maps, ..even };
    let sets = |meadow: &Meadow| -> Vec<_> {
        meadow.sets(&Area { low: [5.0; 2], high: [35.0; 2] }).into_iter().map(Instance::unpack).collect()
    };
    let all = sets(&even);
    let mean = |value: &dyn Fn(&Instance) -> f32| {
        all.iter().map(|set| f64::from(value(set))).sum::<f64>() / all.len() as f64
    };
    let (soil, reeds) = (mean(&|set| set.tuft.soil), mean(&|set| set.species as f32));
    assert!((soil - 0.5).abs() < 0.01 && (reeds - 0.4).abs() < 0.04, "soil {soil}, {reeds} are reeds");
    let some: Vec<_> = all.into_iter().step_by(4).collect();
    let [near, far] = [0.0..0.3, 4.0..6.0].map(|apart| alike(&some, apart));
    assert!(near[0] > far[0] + 0.04 && near[1] < 0.75 * far[1], "near each other {near:?}, apart {far:?}");
    let alone: Vec<_> = sets(&Meadow { tussocks: 0.0, ..even }).into_iter().step_by(4).collect();
    let [near, far] = [0.0..0.3, 4.0..6.0].map(|apart| alike(&alone, apart));
    assert!(
        (near[0] - far[0]).abs() < 0.04 && near[1] == 0.0,
        "as the source has it {near:?}, apart {far:?}"
    );
}

#[test]
fn nothing_grows_in_deep_water_beyond_the_ground_or_where_there_is_no_density() {
    let mut wet = meadow(|x, _| if x < 5 { 0.0 } else { 1.0 });
    wet.maps.water = Some(field(|_, y| if y < 10 { 0.0 } else { 1.0 }));
    wet.maps.valid =
        Mask::new(Size::square(SIDE).expect("small"), (0..400).map(|cell| cell % 20 != 15).collect());
    let sets = wet.sets(&wet.area());
    assert!(sets.len() > 500, "{}", sets.len());
    for [x, y] in places(&sets) {
        assert!(x > 9.0 && y < 19.3, "{x} {y}");
        assert!(!(29.0..=33.0).contains(&x), "{x} is beside what has no data");
    }
}

#[test]
fn mown_grass_is_cut_to_the_height_that_is_asked_for_and_trodden_grass_lies() {
    let mut mown = meadow(|_, _| 1.0);
    mown.maps.mown = Some(field(|x, _| if x < 10 { 1.0 } else { 0.0 }));
    mown.maps.trodden = Some(field(|_, y| if y < 10 { 1.0 } else { 0.0 }));
    for packed in mown.sets(&mown.area()) {
        let Instance { place: [x, y], species, tuft } = Instance::unpack(packed);
        let top = mown.species[species as usize].top();
        if x < 19.0 {
            assert!((tuft.cut * top - 0.05).abs() < top / 100.0, "{}", tuft.cut * top);
        }
        assert!(x < 21.0 || tuft.cut == 1.0);
        assert!(if y < 19.0 { tuft.trodden == 1.0 } else { y < 21.0 || tuft.trodden == 0.0 });
    }
}

#[test]
fn another_seed_is_another_meadow_of_as_many_sets() {
    let one = meadow(|_, _| 0.6);
    let other = Meadow { seed: 8, ..one.clone() };
    let [one, other] = [one, other].map(|meadow| meadow.sets(&meadow.area()));
    assert!(one != other && (one.len() as f64 / other.len() as f64 - 1.0).abs() < 0.02);
    assert_eq!(Curves::OF_THE_SOURCE, SPECIES[0].curves);
}

proptest! {
    #[test]
    fn tiles_together_are_the_whole(cuts in prop::array::uniform2(-5.0..45.0_f64), across in 0.5..30.0_f64) {
        let meadow = meadow(|x, y| ((x + y) % 7) as f32 / 6.0);
        let whole = Area { low: [cuts[0].min(30.0), 3.0], high: [cuts[0].min(30.0) + across, 31.0] };
        let mut tiles = Vec::new();
        for (west, east) in [(whole.low[0], whole.low[0] + 0.4 * across), (whole.low[0] + 0.4 * across, whole.high[0])] {
            for (north, south) in [(3.0, cuts[1].clamp(3.0, 31.0)), (cuts[1].clamp(3.0, 31.0), 31.0)] {
                tiles.extend(meadow.sets(&Area { low: [west, north], high: [east, south] }));
            }
        }
        let mut sets = meadow.sets(&whole);
        sets.sort_unstable();
        tiles.sort_unstable();
        prop_assert_eq!(sets, tiles);
    }
}

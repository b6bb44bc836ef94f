//! The order of the sets of grass on a device, and the bounds of each run of them: those that are close together, and of
//! these those that are left out together where fewer stand, lie side by side, so that one look leaves out a whole run.

use weald::grow::grass::choice::reach_of_blades;
use weald::grow::grass::{Instance, Packed, Species};

/// Sets of a run, from which one thread chooses, as `meadow.wgsl` has them.
pub(super) const RUN: u32 = 16;

/// Side in metres of the squares of which each has its sets side by side: a meadow has some hundreds of sets in one.
const SQUARE: f32 = 2.0;

/// Sets square by square, in each by their ranks.
pub(super) fn in_order(sets: Vec<Packed>) -> Vec<Packed> {
    let mut keyed: Vec<_> = sets.into_iter().map(|set| (key(&set), set)).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, set)| set).collect()
}

/// Row and column of a set's square, and its rank.
fn key(set: &Packed) -> ([i32; 2], u32) {
    let Instance { place: [east, south], tuft, .. } = Instance::unpack(*set);
    // A rank is not negative: its bits have its order.
    ([south, east].map(|at| (at / SQUARE).floor() as i32), tuft.rank().to_bits())
}

/// For each run the middle of its sets, how far their blades reach from it at most, and the least of their ranks.
pub(super) fn bounds(sets: &[Packed], kinds: &[Species]) -> Vec<[f32; 4]> {
    sets.chunks(RUN as usize).map(|run| bounds_of_run(run, kinds)).collect()
}

fn bounds_of_run(sets: &[Packed], kinds: &[Species]) -> [f32; 4] {
    let (mut low, mut high, mut rank) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2], f32::INFINITY);
    let mut reach = 0.0_f32;
    for set in sets {
        let Instance { place, tuft, species } = Instance::unpack(*set);
        reach = reach.max(reach_of_blades(&kinds[species as usize]));
        low = [0, 1].map(|axis| low[axis].min(place[axis]));
        high = [0, 1].map(|axis| high[axis].max(place[axis]));
        rank = rank.min(tuft.rank());
    }
    let [east, south] = [0, 1].map(|axis| 0.5 * (low[axis] + high[axis]));
    // A hundredth more, for what a device rounds otherwise.
    let radius = 0.505 * (high[0] - low[0]).hypot(high[1] - low[1]) + 0.01 + reach;
    [east, south, radius, rank]
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::grow::grass::{SPECIES, Set};

    fn sets() -> Vec<Packed> {
        let place = |number: u32| [37, 91].map(|factor| (number * factor % 1000) as f32 * 0.02 - 3.0);
        let set = |number: u32| {
            let tuft = Set { soil: 1.0, light: 1.0, level: 4.0, cut: 1.0, trodden: 0.0, seed: number * 77 };
            Instance { place: place(number), species: number % 3, tuft }.pack()
        };
        (0..4001).map(set).collect()
    }

    #[test]
    fn the_order_keeps_every_set() {
        let (mut before, mut after) = (sets(), in_order(sets()));
        assert_ne!(before, after);
        before.sort_unstable();
        after.sort_unstable();
        assert_eq!(before, after);
    }

    #[test]
    fn the_bounds_of_a_run_hold_its_sets_closely() {
        let sets = in_order(sets());
        let bounds = bounds(&sets, &SPECIES);
        assert_eq!(bounds.len(), sets.len().div_ceil(RUN as usize));
        let mut beyond_blades = 0.0;
        for (run, [east, south, radius, rank]) in sets.chunks(RUN as usize).zip(&bounds) {
            let mut longest = 0.0_f32;
            for set in run {
                let Instance { place, tuft, species } = Instance::unpack(*set);
                let reach = reach_of_blades(&SPECIES[species as usize]);
                let away = (place[0] - east).hypot(place[1] - south);
                assert!(away + reach <= *radius && tuft.rank() >= *rank);
                longest = longest.max(reach);
            }
            beyond_blades += radius - longest;
        }
        let mean = beyond_blades / bounds.len() as f32;
        assert!(mean < SQUARE, "{mean} m beyond the longest blades");
    }
}

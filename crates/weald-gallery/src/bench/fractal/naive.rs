//! Random iteration as one writes it first: one point after the other, a generator with a state, a chain of branches.

use weald_core::random::splitmix64;
use weald_plants::ifs::{Ifs, Window};

/// A walk over a 2D fractal.
struct Walk {
    /// A map's numbers, and the sum of probabilities up to it.
    maps: Vec<([f32; 6], f32)>,
    at: [f32; 2],
    state: u64,
}

impl Walk {
    fn of(ifs: &Ifs) -> Self {
        let mut sum = 0.0;
        let maps = ifs.maps().iter().map(|weighted| {
            sum += weighted.probability;
            let [[a, b, _], [c, d, _], _] = weighted.map.linear;
            let [e, f, _] = weighted.map.offset;
            ([a, b, c, d, e, f].map(|number| number as f32), sum as f32)
        });
        Self { maps: maps.collect(), at: [0.0; 2], state: splitmix64(7) }
    }

    /// xorshift64, Marsaglia 2003.
    fn draw(&mut self) -> f32 {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        (self.state >> 40) as f32 / (1 << 24) as f32
    }

    fn step(&mut self) -> [f32; 2] {
        let draw = self.draw();
        let taken = self.maps.iter().position(|(_, sum)| draw < *sum).unwrap_or(0);
        let [a, b, c, d, e, f] = self.maps[taken].0;
        let [x, y] = self.at;
        self.at = [a * x + b * y + e, c * x + d * y + f];
        self.at
    }
}

/// The sum of so many points, so that none is left out.
pub(super) fn points(ifs: &Ifs, count: u64) -> [f32; 2] {
    let mut walk = Walk::of(ifs);
    let mut sum = [0.0; 2];
    for _ in 0..count {
        let [x, y] = walk.step();
        sum = [sum[0] + x, sum[1] + y];
    }
    sum
}

/// Counts of so many points in the cells of a window.
pub(super) fn counts(ifs: &Ifs, window: Window, count: u64) -> Vec<u32> {
    let Window { low, scale, size: [columns, rows] } = window;
    let mut counts = vec![0_u32; (columns * rows) as usize];
    let mut walk = Walk::of(ifs);
    for _ in 0..count {
        let [x, y] = walk.step();
        let (column, row) = ((x - low[0]) * scale[0], (y - low[1]) * scale[1]);
        if column >= 0.0 && row >= 0.0 && column < columns as f32 && row < rows as f32 {
            counts[row as usize * columns as usize + column as usize] += 1;
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_plants::ifs::{Game, Histogram, shapes};

    #[test]
    fn the_naive_loop_draws_the_same_fern() {
        let ifs = shapes::find("fern").expect("built in").ifs();
        let window = Window { low: [-3.0, 0.0], scale: [1.0; 2], size: [6, 10] };
        let count = 1_000_000;
        let naive = counts(&ifs, window, count);
        let mut histogram = Histogram::new(window);
        Game::new(&ifs, 1).points(count, |block| histogram.count(block));
        let pairs = naive.iter().zip(histogram.counts());
        let worst =
            pairs.map(|(naive, ours)| f64::from(naive.abs_diff(ours)) / count as f64).fold(0.0, f64::max);
        assert!(naive.iter().filter(|count| **count > 1000).count() > 15, "{naive:?}");
        assert!(worst < 2e-3, "{worst}");
        let sum = points(&ifs, 1000);
        assert!(sum[1] > 1000.0, "{sum:?}");
    }
}

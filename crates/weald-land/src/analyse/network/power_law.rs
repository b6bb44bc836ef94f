//! The exponent of a power law `value ~ area^p`, from means over octaves of area.
//!
//! Most cells have small areas. Octaves, in which the mean of a power law is again one, give all sizes the same
//! weight.

/// Fewer cells than this say nothing of their octave.
const MIN_CELLS: usize = 10;

/// Fewer octaves than this make no line.
const MIN_OCTAVES: usize = 3;

/// Slope of the regression line of ln value on ln area through the octaves from `least` cells of area upwards;
/// `None` where there are too few.
pub(super) fn exponent(samples: impl Iterator<Item = [f64; 2]>, least: f64) -> Option<f64> {
    let mut octaves: Vec<Octave> = Vec::new();
    for [area, value] in samples.filter(|&[area, value]| area >= least && value > 0.0) {
        let octave = libm::floor(libm::log2(area / least)) as usize;
        octaves.resize(octaves.len().max(octave + 1), Octave::default());
        octaves[octave].add(area, value);
    }
    let points: Vec<[f64; 2]> = octaves.iter().filter_map(Octave::point).collect();
    (points.len() >= MIN_OCTAVES).then(|| line(&points).slope)
}

#[derive(Clone, Copy, Default)]
struct Octave {
    cells: usize,
    area: f64,
    value: f64,
}

impl Octave {
    fn add(&mut self, area: f64, value: f64) {
        self.cells += 1;
        self.area += area;
        self.value += value;
    }

    fn point(&self) -> Option<[f64; 2]> {
        let mean = |sum: f64| libm::log(sum / self.cells as f64);
        (self.cells >= MIN_CELLS).then(|| [mean(self.area), mean(self.value)])
    }
}

/// How two quantities go together.
pub(super) struct Line {
    /// Of the regression line of the second on the first; 0 where the first is all the same.
    pub(super) slope: f64,
    /// Correlation, -1 to 1; 0 where one of them is all the same.
    pub(super) correlation: f64,
}

/// Least squares through points.
pub(super) fn line(points: &[[f64; 2]]) -> Line {
    let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64;
    let means = [mean(0), mean(1)];
    let moment = |a: usize, b: usize| -> f64 {
        points.iter().map(|point| (point[a] - means[a]) * (point[b] - means[b])).sum()
    };
    let (first, second, both) = (moment(0, 0), moment(1, 1), moment(0, 1));
    let ratio = |over: f64| if over > 0.0 { both / over } else { 0.0 };
    Line { slope: ratio(first), correlation: ratio((first * second).sqrt()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponent_of_a_power_law_comes_back_and_small_areas_are_left_out() {
        let law = (1..5000).map(|area| {
            let area = f64::from(area);
            [area, if area < 8.0 { 99.0 } else { 3.0 * libm::pow(area, -0.4) }]
        });
        let found = exponent(law, 8.0).expect("nine octaves");
        assert!((found + 0.4).abs() < 0.005, "{found}");
    }

    #[test]
    fn two_octaves_make_no_law() {
        assert_eq!(exponent((8..32).map(|area| [f64::from(area), 1.0]), 8.0), None);
    }

    #[test]
    fn points_on_a_falling_line_correlate_fully() {
        let points: Vec<[f64; 2]> = (0..5).map(|x| [f64::from(x), 3.0 - 2.0 * f64::from(x)]).collect();
        let Line { slope, correlation } = line(&points);
        assert!((slope + 2.0).abs() < 1e-12 && (correlation + 1.0).abs() < 1e-12);
    }
}

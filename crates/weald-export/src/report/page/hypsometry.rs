//! How much land lies at which height: the histogram and the hypsometric curve.
//!
//! ```text
//! curve: share of the land above z         integral = (mean - lowest) / (highest - lowest)
//! ```
//!
//! Strahler 1952, "Hypsometric (area-altitude) analysis of erosional topography", doi
//! 10.1130/0016-7606(1952)63[1117:HAAOET]2.0.CO;2; the integral by the elevation-relief ratio of Pike and Wilson 1971,
//! doi 10.1130/0016-7606(1971)82[1079:ERHIAG]2.0.CO;2.

use super::axis::{Axis, round_step};
use super::figures::{count, number, plain};
use super::ground::Ground;
use super::html::figure;
use super::plot::Plot;

/// Bars of a histogram, about.
const BARS: f64 = 36.0;

/// Points of the curve.
const POINTS: usize = 200;

/// Both charts.
pub(super) fn charts(ground: &Ground) -> String {
    let heights = &ground.sorted;
    let (Some(&low), Some(&high)) = (heights.first(), heights.last()) else { return String::new() };
    let range = [f64::from(low), f64::from(high)];
    format!("<div class=\"pair\">\n{}{}</div>\n", histogram(heights, range), curve(heights, range))
}

/// Cells between two heights.
struct Bin {
    low: f64,
    high: f64,
    cells: usize,
}

/// Bins between round heights; a height that is a bound belongs to the bin above it.
fn bins(heights: &[f32], [low, high]: [f64; 2]) -> Vec<Bin> {
    let step = round_step((high - low).max(1e-6) / BARS);
    let first = libm::floor(low / step);
    let below = |bound: f64| heights.partition_point(|&height| f64::from(height) < bound);
    let count = (libm::floor(high / step) - first) as usize + 1;
    (0..count)
        .map(|at| {
            let (low, high) = ((first + at as f64) * step, (first + at as f64 + 1.0) * step);
            Bin { low, high, cells: below(high) - below(low) }
        })
        .collect()
}

fn histogram(heights: &[f32], range: [f64; 2]) -> String {
    let bins = bins(heights, range);
    let share = |cells: usize| 100.0 * cells as f64 / heights.len() as f64;
    let most = bins.iter().map(|bin| share(bin.cells)).fold(0.0, f64::max);
    let mut plot = Plot::new(
        Axis::linear("height, m", range[0], range[1]),
        Axis::linear("share of the land, %", 0.0, most),
    );
    for bin in &bins {
        let title =
            format!("{} to {} m: {} cells", plain(bin.low, 3), plain(bin.high, 3), count(bin.cells as u64));
        plot.bar([bin.low, bin.high], share(bin.cells), (bin.cells, &title));
    }
    let step = bins.first().map_or(0.0, |bin| bin.high - bin.low);
    let [tenth, median, ninth] = [0.1, 0.5, 0.9].map(|share| number(quantile(heights, share)));
    figure(
        "chart histogram",
        &plot.svg("Histogram of heights"),
        &format!(
            "<strong>Heights</strong>, in steps of {} m. Half of the land lies below {median} m, a tenth below {tenth} m, \
             a tenth above {ninth} m.",
            number(step)
        ),
    )
}

fn curve(heights: &[f32], [low, high]: [f64; 2]) -> String {
    // From the lowest height, above which all land lies, to the highest.
    let point = |at: usize| {
        let share = at as f64 / POINTS as f64;
        (100.0 * (1.0 - share), quantile(heights, share))
    };
    let mut points: Vec<_> = (0..=POINTS).map(point).collect();
    points.reverse();
    let mut plot = Plot::new(
        Axis::linear("share of the land that lies higher, %", 0.0, 100.0),
        Axis::linear("height, m", low, high),
    );
    plot.area("filled", &points);
    plot.line("curve hypsometric", &points);
    let integral = integral(heights, [low, high]);
    figure(
        "chart hypsometry",
        &plot.svg("Hypsometric curve"),
        &format!(
            "<strong>Hypsometric curve</strong> (Strahler 1952). Its integral is \
             <data value=\"{integral:.6}\">{integral:.2}</data>: above 0.6 land is young and little cut, below 0.35 it is \
             worn down."
        ),
    )
}

/// The height below which that share of the cells lies.
fn quantile(heights: &[f32], share: f64) -> f64 {
    let place = (share * (heights.len() - 1) as f64).round() as usize;
    f64::from(heights[place])
}

fn integral(heights: &[f32], [low, high]: [f64; 2]) -> f64 {
    let mean = heights.iter().map(|&height| f64::from(height)).sum::<f64>() / heights.len() as f64;
    if high > low { (mean - low) / (high - low) } else { 0.5 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_hold_every_cell_once() {
        let heights: Vec<f32> = (0..1000).map(|cell| (cell as f32 * 0.731).sqrt() * 10.0).collect();
        let range = [f64::from(heights[0]), f64::from(heights[999])];
        let bins = bins(&heights, range);
        assert_eq!(bins.iter().map(|bin| bin.cells).sum::<usize>(), 1000);
        assert!(bins.len() > 20 && bins.windows(2).all(|pair| pair[0].high <= pair[1].low + 1e-9));
        assert_eq!(self::bins(&[5.0; 7], [5.0, 5.0]).iter().map(|bin| bin.cells).sum::<usize>(), 7);
    }

    #[test]
    fn a_plane_has_the_integral_one_half() {
        let heights: Vec<f32> = (0..=100).map(|cell| cell as f32).collect();
        assert!((integral(&heights, [0.0, 100.0]) - 0.5).abs() < 1e-9);
        let cone: Vec<f32> = (0..=1000).map(|cell| 100.0 * (1.0 - (cell as f32 / 1000.0).sqrt())).collect();
        assert!((integral(&cone, [0.0, 100.0]) - 1.0 / 3.0).abs() < 2e-3, "the volume of a cone");
    }
}

//! How slope falls with upslope area: the signature of rivers.
//!
//! ```text
//! S = k A^-θ
//! ```
//!
//! Flint 1974, "Stream gradient as a function of order, magnitude, and discharge", doi 10.1029/WR010i005p00969. Slopes
//! are those from each cell to the one its water goes to; level and filled ones are left out. θ is the slope of a
//! straight line through the medians of bins with at least [`CHANNEL_CELLS`] cells of area, by least squares.

use super::axis::Axis;
use super::figures::{count, number};
use super::ground::Ground;
use super::html::figure;
use super::plot::Plot;
use weald_land::flow::directions::Directions;

/// Bins a decade of area.
const BINS_PER_DECADE: f64 = 5.0;

/// Fewest cells in a bin that is shown.
const MIN_BIN_CELLS: usize = 5;

/// Area in cells from which a bin counts as river.
const CHANNEL_CELLS: f64 = 100.0;

/// Slopes of the cells through which about the same area drains.
struct Bin {
    /// Middle of its areas in m².
    area: f64,
    /// Slopes below which a quarter, half and three quarters of the cells lie.
    quartiles: [f64; 3],
    cells: usize,
}

/// The plot; nothing where no bin has cells enough.
pub(super) fn chart(ground: &Ground) -> String {
    let bins = bins(slopes(ground));
    let (Some(first), Some(last)) = (bins.first(), bins.last()) else { return String::new() };
    let least = bins.iter().map(|bin| bin.quartiles[0]).fold(f64::INFINITY, f64::min);
    let most = bins.iter().map(|bin| bin.quartiles[2]).fold(0.0, f64::max);
    let mut plot = Plot::new(
        Axis::logarithmic("upslope area, m²", first.area, last.area),
        Axis::logarithmic("slope", least, most),
    );
    for bin in &bins {
        plot.whisker("spread series-0", bin.area, [bin.quartiles[0], bin.quartiles[2]]);
        let title = format!(
            "{} m²: median slope {:.4}, {} cells",
            bin.area.round(),
            bin.quartiles[1],
            count(bin.cells as u64)
        );
        plot.dot("dot series-0", (bin.area, bin.quartiles[1]), &title);
    }
    let channels = CHANNEL_CELLS * ground.land.domain.cell_area();
    let rivers: Vec<&Bin> = bins.iter().filter(|bin| bin.area >= channels).collect();
    let law = power_law(&rivers);
    if let Some([theta, log_k]) = law {
        let point = |bin: &Bin| (bin.area, libm::exp(log_k - theta * libm::log(bin.area)));
        plot.line("curve fit", &[point(rivers[0]), point(rivers[rivers.len() - 1])]);
    }
    figure("chart slope-area", &plot.svg("Slope against area"), &caption(law))
}

fn caption(law: Option<[f64; 2]>) -> String {
    let what = "<strong>Slope against area</strong>: the median of each bin of areas, and between which slopes half of \
                its cells lie.";
    match law {
        Some([theta, _]) => format!(
            "{what} The line is S = k A<sup>−θ</sup> where {} cells and more drain through, with θ = \
             <data value=\"{theta:.6}\">{theta:.2}</data>, the concavity index; graded \
             (steady-state) rivers mostly have 0.4 to 0.6.",
            number(CHANNEL_CELLS)
        ),
        None => format!("{what} The land is too small to fit a power law."),
    }
}

/// Area and slope of every cell that has a lower one to go to.
fn slopes(ground: &Ground) -> Vec<(f64, f64)> {
    let domain = &ground.land.domain;
    let field = |name: &str| ground.land.field(name).ok();
    let (Some(codes), Some(area), Some(height)) =
        (field("flow_direction"), field("accumulation"), field(&ground.height))
    else {
        return Vec::new();
    };
    let Ok(directions) = Directions::of(codes, domain.valid.as_ref()) else { return Vec::new() };
    let columns = domain.size.columns;
    let slope = |cell: usize| {
        let next = directions.downstream(cell)?;
        let straight = next % columns == cell % columns || next / columns == cell / columns;
        let distance = domain.cell * if straight { 1.0 } else { std::f64::consts::SQRT_2 };
        let fall = f64::from(height.values()[cell]) - f64::from(height.values()[next]);
        (fall > 0.0).then(|| (f64::from(area.values()[cell]), fall / distance))
    };
    (0..domain.size.cells()).filter_map(slope).collect()
}

fn bins(mut slopes: Vec<(f64, f64)>) -> Vec<Bin> {
    let number = |area: f64| libm::floor(libm::log10(area) * BINS_PER_DECADE);
    slopes.retain(|(area, _)| *area > 0.0);
    slopes.sort_unstable_by(|a, b| number(a.0).total_cmp(&number(b.0)).then(a.1.total_cmp(&b.1)));
    let groups = slopes.chunk_by(|a, b| number(a.0) == number(b.0));
    groups
        .filter(|group| group.len() >= MIN_BIN_CELLS)
        .map(|group| Bin {
            area: libm::exp10((number(group[0].0) + 0.5) / BINS_PER_DECADE),
            quartiles: [0.25, 0.5, 0.75].map(|share| group[((group.len() - 1) as f64 * share) as usize].1),
            cells: group.len(),
        })
        .collect()
}

/// θ and the logarithm of k, from three bins or more.
fn power_law(bins: &[&Bin]) -> Option<[f64; 2]> {
    if bins.len() < 3 {
        return None;
    }
    let points: Vec<_> = bins.iter().map(|bin| (libm::log(bin.area), libm::log(bin.quartiles[1]))).collect();
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let across: f64 = points.iter().map(|point| (point.0 - x) * (point.0 - x)).sum();
    let both: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    let theta = -both / across;
    Some([theta, y + theta * x])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_found_again() {
        let slopes: Vec<(f64, f64)> = (0..20_000)
            .map(|cell| {
                let area = 1.0e4 * 10_f64.powf(f64::from(cell) / 5000.0);
                (area, 3.0 * area.powf(-0.45))
            })
            .collect();
        let bins = bins(slopes);
        assert!(bins.len() >= 20 && bins.iter().map(|bin| bin.cells).sum::<usize>() == 20_000);
        let [theta, log_k] = power_law(&bins.iter().collect::<Vec<_>>()).expect("bins enough");
        assert!((theta - 0.45).abs() < 1e-3 && (log_k.exp() / 3.0 - 1.0).abs() < 0.02, "{theta} {log_k}");
    }

    /// A plane that falls by so many metres a column and a row, of cells of 10 m.
    fn plane([east, south]: [f64; 2]) -> Ground {
        let size = weald_core::grid::Size::square(40).expect("small");
        let height = |x: usize, y: usize| (east * x as f64 + south * y as f64) as f32;
        let mut land = weald_core::landscape::Landscape::new(weald_core::domain::Domain::new(size, 10.0));
        land.insert("height", "m", weald_core::grid::Field::from_function(size, height));
        Ground::of(&land, "height").expect("flow and rivers")
    }

    #[test]
    fn slopes_of_a_plane_are_its_own_straight_and_across_corners() {
        for (falls, expected) in [([2.0, 0.0], 0.2), ([2.0, 2.0], 0.4 / std::f64::consts::SQRT_2)] {
            let found = slopes(&plane(falls));
            let most = found.iter().filter(|(_, slope)| (slope - expected).abs() < 1e-6).count();
            assert!(most > 1400 && found.iter().all(|&(area, _)| area >= 100.0), "{most} of {}", found.len());
        }
    }

    #[test]
    fn the_chart_of_a_plane_tells_its_slope() {
        let chart = chart(&plane([2.0, 0.0]));
        assert!(
            chart.contains("aria-label=\"Slope against area\"") && chart.contains("median slope 0.2000"),
            "{chart}"
        );
    }
}

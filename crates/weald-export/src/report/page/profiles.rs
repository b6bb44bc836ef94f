//! Where the longest rivers run, and how they fall from their heads to their ends.
//!
//! A river that has had time is steep at its head and flat at its end; a step is a lake, a hard bed, or a wave of
//! erosion on its way up.

use std::fmt::Write;

use super::axis::Axis;
use super::figures::number;
use super::ground::Ground;
use super::html::{Cell, figure, table};
use super::plot::{Plot, SERIES};
use weald_land::analyse::rivers::RiverPoint;

/// Length of the longer side of the map, in its own units.
const MAP_SIDE: f64 = 640.0;

/// A river from its head to its end.
struct Stem<'a> {
    points: Vec<&'a RiverPoint>,
    /// Metres to the end, point by point.
    to_the_end: Vec<f64>,
    order: u32,
}

/// Map and profiles of the longest rivers with the chart `beside`, and a table of them.
pub(super) fn charts(ground: &Ground, most: usize, beside: &str) -> String {
    let stems = stems(ground, most.min(SERIES));
    if stems.is_empty() {
        return format!("<p>No river is large enough to be listed.</p>\n{beside}");
    }
    let (map, profiles) = (map(ground, &stems), profiles(&stems));
    format!(
        "<div class=\"pair\">\n{map}<div class=\"stack\">\n{profiles}{beside}</div>\n</div>\n{}",
        list(&stems)
    )
}

fn stems(ground: &Ground, most: usize) -> Vec<Stem<'_>> {
    let reaches = &ground.rivers.reaches;
    let stem = |path: Vec<usize>| {
        let order = path.iter().map(|&reach| reaches[reach].order).max().unwrap_or(1);
        let points: Vec<_> = path.iter().flat_map(|&reach| &reaches[reach].points).collect();
        let mut to_the_end = vec![0.0; points.len()];
        for at in (1..points.len()).rev() {
            let (upper, lower) = (points[at - 1], points[at]);
            to_the_end[at - 1] = to_the_end[at] + libm::hypot(upper.x - lower.x, upper.y - lower.y);
        }
        Stem { points, to_the_end, order }
    };
    ground.rivers.stems().into_iter().take(most).map(stem).collect()
}

fn profiles(stems: &[Stem<'_>]) -> String {
    let longest = stems.iter().map(Stem::length).fold(0.0, f64::max);
    let heights = || stems.iter().flat_map(|stem| stem.points.iter().map(|point| point.z));
    let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
    let mut plot = Plot::new(
        Axis::linear("distance upstream from the end of the river, km", 0.0, longest / 1000.0),
        Axis::linear("height of the water, m", low, high),
    );
    for (number, stem) in stems.iter().enumerate() {
        let profile: Vec<_> = stem
            .to_the_end
            .iter()
            .zip(&stem.points)
            .map(|(distance, point)| (distance / 1000.0, point.z))
            .collect();
        plot.line(&format!("curve profile series-{number}"), &profile);
        plot.label(&format!("name series-{number}"), profile[0], &(number + 1).to_string());
    }
    figure(
        "chart profiles",
        &plot.svg("Long profiles of the longest rivers"),
        "<strong>Long profiles</strong> of the longest rivers, from their ends on the left up to their heads.",
    )
}

impl Stem<'_> {
    fn length(&self) -> f64 {
        self.to_the_end.first().copied().unwrap_or(0.0)
    }
}

/// All rivers, the ones whose profiles are drawn in their colours.
fn map(ground: &Ground, stems: &[Stem<'_>]) -> String {
    let domain = &ground.land.domain;
    let [width, height] = [domain.size.columns, domain.size.rows].map(|cells| cells as f64 * domain.cell);
    let scale = MAP_SIDE / width.max(height);
    let path = |points: &[&RiverPoint]| {
        let places: Vec<_> =
            points.iter().map(|point| format!("{:.1},{:.1}", point.x * scale, point.y * scale)).collect();
        places.join(" ")
    };
    let mut lines = String::new();
    for reach in &ground.rivers.reaches {
        let points: Vec<_> = reach.points.iter().collect();
        let stroke = 0.7 + 0.5 * f64::from(reach.order);
        // Writing to a string cannot fail, here and below.
        let _ = writeln!(
            lines,
            "<polyline class=\"river\" stroke-width=\"{stroke:.1}\" points=\"{}\"/>",
            path(&points)
        );
    }
    for (number, stem) in stems.iter().enumerate() {
        let line = path(&stem.points);
        let _ = writeln!(lines, "<polyline class=\"curve series-{number}\" points=\"{line}\"/>");
        let head = stem.points[0];
        let (x, y) = (head.x * scale, head.y * scale);
        let _ = writeln!(
            lines,
            "<text class=\"name series-{number}\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
            (y - 7.0).max(16.0),
            number + 1
        );
    }
    let (width, height) = (width * scale, height * scale);
    let chart = format!(
        "<svg viewBox=\"0 0 {width:.1} {height:.1}\" role=\"img\" aria-label=\"Map of the rivers\">\n\
         <rect class=\"sheet\" width=\"{width:.1}\" height=\"{height:.1}\"/>\n{lines}</svg>"
    );
    let count = ground.rivers.reaches.len();
    let caption = format!(
        "<strong>Rivers</strong>, {count} reaches between heads, confluences and ends; wider strokes are of higher order. {}",
        ground.source()
    );
    figure("chart rivers", &chart, &caption)
}

fn list(stems: &[Stem<'_>]) -> String {
    let row = |(at, stem): (usize, &Stem<'_>)| {
        let (head, end) = (stem.points[0], stem.points[stem.points.len() - 1]);
        // The last point may lie in the river or lake that the stem joins.
        let last = stem.points[stem.points.len().saturating_sub(2)];
        vec![
            Cell::text(at + 1),
            Cell::number(number(stem.length() / 1000.0)),
            Cell::number(number(head.z - end.z)),
            Cell::number(number(last.area / 1.0e6)),
            Cell::number(number(last.discharge)),
            Cell::number(stem.order.to_string()),
        ]
    };
    let rows: Vec<_> = stems.iter().enumerate().map(row).collect();
    let header = ["river", "length, km", "fall, m", "drainage area, km²", "discharge, m³/s", "order"];
    table("The longest rivers; orders are Strahler's.", &header, &rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_river_of_four_kilometres_goes_all_the_way_along_an_axis_of_kilometres() {
        let point =
            |x: f64| RiverPoint { x, y: 0.0, z: 90.0, width: 1.0, depth: 1.0, discharge: 1.0, area: 1.0 };
        let points = [point(0.0), point(1000.0), point(4000.0)];
        let stem = Stem { points: points.iter().collect(), to_the_end: vec![4000.0, 3000.0, 0.0], order: 1 };
        let chart = profiles(&[stem]);
        assert!(chart.contains("text-anchor=\"middle\">4</text>") && !chart.contains(">5</text>"), "{chart}");
        let line = chart.split("points=\"").nth(1).expect("a line");
        assert!(
            line.starts_with("620.0,") && line.contains(" 72.0,"),
            "from the right end to the left: {line}"
        );
    }
}

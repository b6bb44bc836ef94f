//! Charts as SVG: a frame with two axes, and marks in it.

use std::fmt::Write;

use super::axis::Axis;
use super::html::escape;

/// Size of a chart in its own units, about pixels.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 380.0;

/// Room for labels: left, top, right, bottom.
const LEFT: f64 = 72.0;
const TOP: f64 = 14.0;
const RIGHT: f64 = 20.0;
const BOTTOM: f64 = 52.0;

/// Colours of series, which the style sheet names `series-0` and so on.
pub(super) const SERIES: usize = 8;

/// A chart that is being drawn.
pub(super) struct Plot {
    x: Axis,
    y: Axis,
    marks: String,
}

impl Plot {
    pub(super) fn new(x: Axis, y: Axis) -> Self {
        Self { x, y, marks: String::new() }
    }

    fn across(&self, x: f64) -> f64 {
        LEFT + (WIDTH - LEFT - RIGHT) * self.x.place(x).clamp(0.0, 1.0)
    }

    fn down(&self, y: f64) -> f64 {
        HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * self.y.place(y).clamp(0.0, 1.0)
    }

    /// A line through points; `class` chooses its look.
    pub(super) fn line(&mut self, class: &str, points: &[(f64, f64)]) {
        let points: Vec<String> =
            points.iter().map(|&(x, y)| format!("{:.1},{:.1}", self.across(x), self.down(y))).collect();
        // Writing to a string cannot fail, here and below.
        let _ = writeln!(self.marks, "<polyline class=\"{class}\" points=\"{}\"/>", points.join(" "));
    }

    /// The area between points and the foot of the chart.
    pub(super) fn area(&mut self, class: &str, points: &[(f64, f64)]) {
        let (Some(first), Some(last)) = (points.first(), points.last()) else { return };
        let foot = HEIGHT - BOTTOM;
        let mut shape = format!("{:.1},{foot:.1}", self.across(first.0));
        for &(x, y) in points {
            let _ = write!(shape, " {:.1},{:.1}", self.across(x), self.down(y));
        }
        let _ = write!(shape, " {:.1},{foot:.1}", self.across(last.0));
        let _ = writeln!(self.marks, "<polygon class=\"{class}\" points=\"{shape}\"/>");
    }

    /// A bar from the foot of the chart, over a stretch of the x axis. It tells `title` when it is pointed at, and
    /// holds the number of cells for programs.
    pub(super) fn bar(&mut self, stretch: [f64; 2], height: f64, (cells, title): (usize, &str)) {
        let [left, right] = stretch.map(|x| self.across(x));
        let (top, foot) = (self.down(height), HEIGHT - BOTTOM);
        let _ = writeln!(
            self.marks,
            "<rect class=\"bar\" x=\"{:.2}\" y=\"{top:.2}\" width=\"{:.2}\" height=\"{:.2}\" data-cells=\"{cells}\">\
             <title>{}</title></rect>",
            left + 0.5,
            (right - left - 1.0).max(0.5),
            foot - top,
            escape(title),
        );
    }

    /// A dot.
    pub(super) fn dot(&mut self, class: &str, (x, y): (f64, f64), title: &str) {
        let (x, y) = (self.across(x), self.down(y));
        let title = escape(title);
        let _ = writeln!(
            self.marks,
            "<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"><title>{title}</title></circle>"
        );
    }

    /// A stroke upright between two values.
    pub(super) fn whisker(&mut self, class: &str, x: f64, [low, high]: [f64; 2]) {
        let (x, low, high) = (self.across(x), self.down(low), self.down(high));
        let _ = writeln!(
            self.marks,
            "<line class=\"{class}\" x1=\"{x:.1}\" y1=\"{low:.1}\" x2=\"{x:.1}\" y2=\"{high:.1}\"/>"
        );
    }

    /// A word at a place; it ends there where there is no room to its right.
    pub(super) fn label(&mut self, class: &str, (x, y): (f64, f64), text: &str) {
        let (x, y) = (self.across(x), self.down(y));
        let at_the_end = x > WIDTH - 120.0;
        let (anchor, x) = if at_the_end { ("end", x - 6.0) } else { ("start", x + 6.0) };
        let text = escape(text);
        let _ = writeln!(
            self.marks,
            "<text class=\"{class}\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{text}</text>",
            (y - 6.0).max(TOP + 10.0)
        );
    }

    /// The chart; `description` tells those who cannot see it what it shows.
    pub(super) fn svg(&self, description: &str) -> String {
        format!(
            "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{}\">\n{}{}{}</svg>",
            escape(description),
            self.rows(),
            self.columns(),
            self.marks
        )
    }

    fn rows(&self) -> String {
        let (right, middle) = (WIDTH - RIGHT, TOP + 0.5 * (HEIGHT - TOP - BOTTOM));
        let mut text = String::new();
        for tick in &self.y.ticks {
            let y = HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * tick.place;
            let _ = writeln!(
                text,
                "<line class=\"grid\" x1=\"{LEFT}\" y1=\"{y:.1}\" x2=\"{right}\" y2=\"{y:.1}\"/>"
            );
            let _ = writeln!(
                text,
                "<text class=\"tick\" x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>",
                LEFT - 9.0,
                y + 4.0,
                tick.label
            );
        }
        let title = escape(&self.y.title);
        let _ = writeln!(
            text,
            "<text class=\"axis\" transform=\"translate(16 {middle:.1}) rotate(-90)\" text-anchor=\"middle\">{title}</text>"
        );
        text
    }

    fn columns(&self) -> String {
        let (foot, middle) = (HEIGHT - BOTTOM, LEFT + 0.5 * (WIDTH - LEFT - RIGHT));
        let mut text = String::new();
        for tick in &self.x.ticks {
            let x = LEFT + (WIDTH - LEFT - RIGHT) * tick.place;
            let _ = writeln!(
                text,
                "<line class=\"mark\" x1=\"{x:.1}\" y1=\"{foot}\" x2=\"{x:.1}\" y2=\"{}\"/>",
                foot + 5.0
            );
            let _ = writeln!(
                text,
                "<text class=\"tick\" x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                foot + 20.0,
                tick.label
            );
        }
        let title = escape(&self.x.title);
        let _ = writeln!(
            text,
            "<text class=\"axis\" x=\"{middle:.1}\" y=\"{}\" text-anchor=\"middle\">{title}</text>",
            HEIGHT - 10.0
        );
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ticks_of_the_lower_axis_begin_at_the_frame_and_their_numbers_stand_below() {
        let plot = Plot::new(Axis::linear("metres", 0.0, 10.0), Axis::linear("share", 0.0, 1.0));
        let svg = plot.svg("nothing");
        assert!(
            svg.contains("<line class=\"mark\" x1=\"72.0\" y1=\"328\" x2=\"72.0\" y2=\"333\"/>"),
            "{svg}"
        );
        assert!(
            svg.contains("<text class=\"tick\" x=\"620.0\" y=\"348\" text-anchor=\"middle\">10</text>"),
            "{svg}"
        );
    }
}

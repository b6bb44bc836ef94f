//! Curves over two axes, with their control points.

use weald_picture::{Image, Linear, Pen, StrokePoint, Strokes, blend};

/// Colours of lines and writing.
pub(super) const INK: Linear = [0.06, 0.05, 0.04];
pub(super) const GREEN: Linear = [0.05, 0.22, 0.03];
pub(super) const RED: Linear = [0.5, 0.06, 0.03];
pub(super) const GREY: Linear = [0.5, 0.48, 0.43];

/// Room around the axes in pixels: left, top, right, bottom.
const MARGIN: [f32; 4] = [46.0, 14.0, 18.0, 40.0];

/// A chart that is being drawn.
pub(super) struct Chart {
    image: Image,
    x: [f32; 2],
    y: [f32; 2],
    /// Whether both axes have one scale.
    scale: [f32; 2],
}

impl Chart {
    /// Axes from the first to the second number of each pair, in a picture of that size.
    pub(super) fn new([width, height]: [usize; 2], x: [f32; 2], y: [f32; 2]) -> Self {
        let [left, top, right, bottom] = MARGIN;
        let scale =
            [(width as f32 - left - right) / (x[1] - x[0]), (height as f32 - top - bottom) / (y[1] - y[0])];
        Self { image: Image::paper(width, height), x, y, scale }
    }

    /// The same scale on both axes; what is left over is empty.
    pub(super) fn even(mut self) -> Self {
        let scale = self.scale[0].min(self.scale[1]);
        self.scale = [scale; 2];
        self
    }

    /// Axes with numbers at each `step`, and what they stand for.
    pub(super) fn axes(mut self, step: f32, names: [&str; 2]) -> Self {
        let pen = Pen { unit: 1.1, ink: INK };
        let ticks = |[low, high]: [f32; 2]| {
            let count = ((high - low) / step + 1e-3) as usize;
            (0..=count).map(move |tick| low + tick as f32 * step)
        };
        for x in ticks(self.x) {
            self.line(&[[x, self.y[0]], [x, self.y[1]]], GREY, 0.5);
            let (text, [place, foot]) = (written(x), self.place([x, self.y[0]]));
            pen.write(&mut self.image, &text, [place - 0.5 * pen.width(&text), foot + 6.0]);
        }
        for y in ticks(self.y) {
            self.line(&[[self.x[0], y], [self.x[1], y]], GREY, 0.5);
            let (text, [left, place]) = (written(y), self.place([self.x[0], y]));
            pen.write(&mut self.image, &text, [left - pen.width(&text) - 6.0, place - 0.5 * pen.height()]);
        }
        let [right, foot] = self.place([self.x[1], self.y[0]]);
        pen.write(&mut self.image, names[0], [right - pen.width(names[0]), foot + 22.0]);
        let [left, top] = self.place([self.x[0], self.y[1]]);
        pen.write(&mut self.image, names[1], [left + 6.0, top + 5.0]);
        self
    }

    /// A line through points.
    pub(super) fn line(&mut self, points: &[[f32; 2]], ink: Linear, width: f32) {
        let mut strokes = Strokes::new(self.image.width, self.image.height);
        let at = |point: &[f32; 2]| {
            let [x, y] = self.place(*point);
            StrokePoint { x, y, width, opacity: 1.0 }
        };
        strokes.draw_straight(&points.iter().map(at).collect::<Vec<_>>());
        self.ink(&strokes, ink);
    }

    /// A curve over the axis.
    pub(super) fn curve(&mut self, of: impl Fn(f32) -> f32, [from, to]: [f32; 2], ink: Linear) {
        let points: Vec<_> = (0..=120)
            .map(|step| {
                let x = from + (to - from) * step as f32 / 120.0;
                [x, of(x)]
            })
            .collect();
        self.line(&points, ink, 2.2);
    }

    /// Points, with dashes from one to the next where they are control points of one curve.
    pub(super) fn controls(&mut self, points: &[[f32; 2]], ink: Linear) {
        for pair in points.windows(2) {
            let between =
                |share: f32| [0, 1].map(|axis| pair[0][axis] + share * (pair[1][axis] - pair[0][axis]));
            for dash in 0..8 {
                let (from, to) = (dash as f32 / 8.0, (dash as f32 + 0.5) / 8.0);
                self.line(&[between(from), between(to)], ink, 0.9);
            }
        }
        for &point in points {
            self.line(&[point, point], ink, 7.0);
        }
    }

    /// A word beside a point.
    pub(super) fn word(&mut self, text: &str, at: [f32; 2], ink: Linear) {
        let [x, y] = self.place(at);
        let pen = Pen { unit: 1.1, ink };
        let left = if x + 8.0 + pen.width(text) > self.image.width as f32 {
            x - 8.0 - pen.width(text)
        } else {
            x + 8.0
        };
        pen.write(&mut self.image, text, [left, y - 14.0]);
    }

    /// The chart.
    pub(super) fn image(self) -> Image {
        self.image
    }

    fn place(&self, [x, y]: [f32; 2]) -> [f32; 2] {
        let foot = self.image.height as f32 - MARGIN[3];
        [MARGIN[0] + (x - self.x[0]) * self.scale[0], foot - (y - self.y[0]) * self.scale[1]]
    }

    fn ink(&mut self, strokes: &Strokes, ink: Linear) {
        for y in 0..self.image.height {
            for (x, &cover) in strokes.row(y).iter().enumerate() {
                blend(&mut self.image, [x as f32, y as f32], ink, cover);
            }
        }
    }
}

fn written(number: f32) -> String {
    let text = format!("{number:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn empty() -> Chart {
        Chart::new([264, 254], [0.0, 10.0], [0.0, 10.0])
    }

    /// The westernmost and the easternmost column with ink.
    fn inked(image: &Image) -> [usize; 2] {
        let columns = 0..image.width;
        let has_ink =
            |&x: &usize| (0..image.height).any(|y| image.pixel(x, y) != Image::paper(1, 1).pixel(0, 0));
        [columns.clone().find(has_ink), columns.rev().find(has_ink)]
            .map(|column| column.expect("there is ink"))
    }

    #[test]
    fn dashes_go_all_the_way_from_one_control_point_to_the_next() {
        let mut chart = empty();
        chart.controls(&[[2.0, 5.0], [8.0, 5.0]], INK);
        let (image, row) = (chart.image, 254 - 40 - 100);
        let dark = |x: usize| image.pixel(x, row)[1] < 200;
        // Twenty pixels to the unit, from 46 on: eight dashes of 15 pixels, each half as long.
        let dashes: Vec<bool> = (0..8).map(|dash| dark(46 + 40 + 15 * dash + 4)).collect();
        assert_eq!(dashes, [true; 8]);
        assert!((1..7).all(|dash| !dark(46 + 40 + 15 * dash + 11)), "between them the paper shows");
    }

    #[test]
    fn a_word_stands_east_of_its_point_and_west_of_it_where_the_picture_ends() {
        let written = |x: f32| {
            let mut chart = empty();
            chart.word("tip", [x, 5.0], INK);
            inked(&chart.image)
        };
        for east in [2.0, 6.0] {
            assert!(written(east)[0] as f32 >= 46.0 + 20.0 * east, "{:?}", written(east));
        }
        let [from, to] = written(10.0);
        assert!(to <= 246 && from > 200, "{from} to {to}");
    }

    #[test]
    fn numbers_of_the_axis_stand_in_the_middle_below_their_lines() {
        let chart = Chart::new([264, 254], [0.0, 10.0], [0.0, 10.0]).axes(10.0, ["", ""]);
        let below = 254 - 40 + 6..254 - 40 + 18;
        let columns = 180..264_usize;
        let has_ink = |&x: &usize| below.clone().any(|y| chart.image.pixel(x, y)[1] < 200);
        let [from, to] = [columns.clone().find(has_ink), columns.rev().find(has_ink)].map(|x| x.expect("10"));
        let middle = (from + to) as f32 / 2.0;
        assert!((middle - 246.0).abs() < 3.0, "10 stands at {middle}");
    }
}

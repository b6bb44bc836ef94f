//! Smooth tapered lines on a sheet, as the share of each pixel that they cover.

/// A point of a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Pixels from the left edge of the sheet.
    pub x: f32,
    /// Pixels from its top.
    pub y: f32,
    /// Width of the line here, in pixels.
    pub width: f32,
    /// 0 invisible to 1 opaque.
    pub opacity: f32,
}

impl Point {
    fn between(self, other: Self, share: f32) -> Self {
        let mix = |a: f32, b: f32| a + (b - a) * share;
        Self {
            x: mix(self.x, other.x),
            y: mix(self.y, other.y),
            width: mix(self.width, other.width),
            opacity: mix(self.opacity, other.opacity),
        }
    }
}

/// Cover of a whole sheet, 0 to 1 a pixel. Where lines cross the stronger one counts, so their order does not.
#[derive(Debug)]
pub struct Strokes {
    width: usize,
    cover: Vec<f32>,
}

impl Strokes {
    /// A sheet without lines.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, cover: vec![0.0; width * height] }
    }

    /// Cover along row `y`.
    pub fn row(&self, y: usize) -> &[f32] {
        &self.cover[y * self.width..][..self.width]
    }

    /// Draws a line through `points`, smoothed.
    pub fn draw(&mut self, points: &[Point]) {
        let smooth = smoothed(&smoothed(points));
        smooth.windows(2).for_each(|pair| self.segment(pair[0], pair[1]));
    }

    /// Draws a line straight from point to point.
    pub fn draw_straight(&mut self, points: &[Point]) {
        points.windows(2).for_each(|pair| self.segment(pair[0], pair[1]));
    }

    fn segment(&mut self, from: Point, to: Point) {
        let reach = from.width.max(to.width) * 0.5 + 1.0;
        let height = self.cover.len() / self.width;
        let columns = span(from.x.min(to.x) - reach, from.x.max(to.x) + reach, self.width);
        for y in span(from.y.min(to.y) - reach, from.y.max(to.y) + reach, height) {
            for x in columns.clone() {
                let cover = cover_at(x as f32 + 0.5, y as f32 + 0.5, from, to);
                let here = &mut self.cover[y * self.width + x];
                *here = here.max(cover);
            }
        }
    }
}

fn span(low: f32, high: f32, count: usize) -> std::ops::Range<usize> {
    (low.floor().max(0.0) as usize).min(count)..(high.ceil().max(0.0) as usize).min(count)
}

/// Cover of the pixel around a place by a line between two points.
pub(super) fn cover_at(x: f32, y: f32, from: Point, to: Point) -> f32 {
    let (along_x, along_y) = (to.x - from.x, to.y - from.y);
    let length2 = (along_x * along_x + along_y * along_y).max(1e-12);
    let share = (((x - from.x) * along_x + (y - from.y) * along_y) / length2).clamp(0.0, 1.0);
    let nearest = from.between(to, share);
    let distance = ((x - nearest.x) * (x - nearest.x) + (y - nearest.y) * (y - nearest.y)).sqrt();
    let cover = (0.5 * nearest.width + 0.5 - distance).clamp(0.0, 1.0);
    cover.min(nearest.width) * nearest.opacity
}

/// Chaikin's corner cutting: twice the points, the same ends.
fn smoothed(points: &[Point]) -> Vec<Point> {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return Vec::new() };
    let cut =
        points.windows(2).flat_map(|pair| [pair[0].between(pair[1], 0.25), pair[0].between(pair[1], 0.75)]);
    std::iter::once(first).chain(cut).chain(std::iter::once(last)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_covers_its_width_times_its_length_in_any_direction() {
        for (x, y) in [(80.0, 50.0), (50.0, 80.0), (71.2, 71.2), (76.0, 35.0)] {
            let mut strokes = Strokes::new(100, 100);
            let point = |x, y| Point { x, y, width: 3.0, opacity: 1.0 };
            strokes.draw(&[point(50.0, 50.0), point(x, y)]);
            let area: f32 = strokes.cover.iter().sum();
            let length = ((x - 50.0) * (x - 50.0) + (y - 50.0) * (y - 50.0)).sqrt();
            let expected = 3.0 * length + 7.1;
            assert!((area / expected - 1.0).abs() < 0.04, "to ({x}, {y}): {area} px², expected {expected}");
        }
    }
}

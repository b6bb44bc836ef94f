//! Marks on pixels: each covers what lies under it, and edges are smooth because a pixel is sixteen smaller ones.

use rayon::prelude::*;

use super::frame::Frame;
use super::marks::{Mark, Shape};
use super::palette::Table;
use super::tone::{Covered, encoded};
use weald_core::error::{Error, Limit, Quantity};

/// Smaller pixels along the side of a pixel.
const FINE: usize = 4;

/// Most memory of the smaller pixels: 2 GiB.
const MAX_BYTES: u64 = 2 << 30;

/// Corners of a dot.
const DOT_CORNERS: usize = 12;

/// The pixels of all marks, painted in their order.
///
/// # Errors
/// [`Error::Limit`] where the smaller pixels would take more than 2 GiB.
pub(super) fn plot(
    marks: &[Mark],
    shape: Shape,
    frame: &Frame,
    table: &Table,
) -> Result<Vec<Covered>, Error> {
    let bytes = frame.pixels() * (FINE * FINE * size_of::<u16>()) as u64;
    if bytes > MAX_BYTES {
        let [width, height] = [frame.width, frame.height];
        let limit = Limit::new(Quantity::MemoryBytes, bytes, 0..=MAX_BYTES);
        let limit = limit.of(format!("marks on {width} × {height} pixels"));
        return Err(limit.remedy("choose a smaller `size`").into());
    }
    let mut canvas = Canvas::new(frame);
    for mark in marks {
        canvas.paint(mark, shape);
    }
    Ok(canvas.pixels(table))
}

/// Colours of the smaller pixels: 0 for none, else one more than the tinge.
struct Canvas {
    width: usize,
    height: usize,
    cells: Vec<u16>,
}

impl Canvas {
    fn new(frame: &Frame) -> Self {
        let [width, height] = [frame.width, frame.height].map(|side| side * FINE);
        Self { width, height, cells: vec![0; width * height] }
    }

    fn paint(&mut self, mark: &Mark, shape: Shape) {
        let corners: Vec<[f64; 2]> =
            outline(mark, shape).map(|corner| corner.map(|x| x * FINE as f64)).collect();
        if corners.iter().flatten().any(|x| !x.is_finite()) {
            return;
        }
        let low = corners.iter().map(|corner| corner[1]).fold(f64::INFINITY, f64::min);
        let high = corners.iter().map(|corner| corner[1]).fold(f64::NEG_INFINITY, f64::max);
        // A part smaller than a small pixel still leaves one behind.
        let first = low.floor().max(0.0) as usize;
        let last = high.floor().min(self.height as f64 - 1.0);
        if last < first as f64 || high < 0.0 {
            return;
        }
        for row in first..=last as usize {
            let middle = (row as f64 + 0.5).clamp(low, high);
            if let Some([left, right]) = span(&corners, middle) {
                self.fill(row, left, right, mark.palette_index + 1);
            }
        }
    }

    fn fill(&mut self, row: usize, left: f64, right: f64, value: u16) {
        if right < 0.0 || left >= self.width as f64 {
            return;
        }
        let first = left.floor().max(0.0) as usize;
        let last = (right.floor().min(self.width as f64 - 1.0)) as usize;
        self.cells[row * self.width + first..=row * self.width + last.max(first)].fill(value);
    }

    fn pixels(&self, table: &Table) -> Vec<Covered> {
        let across = self.width / FINE;
        let mut pixels = vec![[0.0; 4]; across * (self.height / FINE)];
        pixels.par_chunks_mut(across).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = self.pixel(x * FINE, y * FINE, table);
            }
        });
        pixels
    }

    fn pixel(&self, left: usize, top: usize, table: &Table) -> Covered {
        let mut sum = [0.0; 4];
        for row in top..top + FINE {
            for &cell in &self.cells[row * self.width + left..][..FINE] {
                if cell > 0 {
                    let [red, green, blue] = table.colour(cell - 1);
                    for (sum, light) in sum.iter_mut().zip([red, green, blue, 1.0]) {
                        *sum += light;
                    }
                }
            }
        }
        if sum[3] > 0.0 {
            let cover = sum[3] / (FINE * FINE) as f32;
            let [red, green, blue] = encoded(sum).map(|channel| channel * cover);
            sum = [red, green, blue, cover];
        }
        sum
    }
}

/// Corners of a mark, those of a disc for a dot.
fn outline(mark: &Mark, shape: Shape) -> impl Iterator<Item = [f64; 2]> + '_ {
    let diameter = if let Shape::Dot(diameter) = shape { diameter } else { 0.0 };
    let around = if diameter > 0.0 { DOT_CORNERS } else { 1 };
    mark.corners.iter().flat_map(move |&[x, y]| {
        (0..around).map(move |number| {
            let (sine, cosine) = libm::sincos(std::f64::consts::TAU * number as f64 / around as f64);
            [x + 0.5 * diameter * cosine, y + 0.5 * diameter * sine]
        })
    })
}

/// Where a level line enters and leaves a convex outline.
fn span(corners: &[[f64; 2]], level: f64) -> Option<[f64; 2]> {
    let mut span: Option<[f64; 2]> = None;
    let mut at = |x: f64| {
        let [left, right] = span.unwrap_or([x, x]);
        span = Some([left.min(x), right.max(x)]);
    };
    for (number, &[x, y]) in corners.iter().enumerate() {
        let [other_x, other_y] = corners[(number + 1) % corners.len()];
        if y == level {
            at(x);
        }
        if (y < level) != (other_y < level) {
            at(x + (level - y) / (other_y - y) * (other_x - x));
        }
    }
    span
}

//! The picture of a plant that its leaves are covered with.
//!
//! Texels are hit by points of random iteration; how often one is hit sets its tone, by the logarithm, and the share of
//! its quarters that are hit its opacity. The first rows are bark, for the stems. 3D shapes are seen from the
//! front and, beside it, from their right.

use crate::ifs::game::Game;
use crate::ifs::map::Point;
use crate::ifs::system::Ifs;

/// Rows of bark, as a share of the height.
const BARK: f64 = 1.0 / 32.0;

/// Points for each texel.
const POINTS: u64 = 48;

/// Widest picture, as a multiple of its height.
const WIDEST: f64 = 4.0;

/// Colours of a plant, as red, green, blue from 0 to 1, sRGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colours {
    /// Of its leaves.
    pub leaf: [f32; 3],
    /// Of its stems.
    pub stem: [f32; 3],
}

impl Colours {
    /// Those of a plant of which nothing else is said.
    pub const USUAL: Self = Self { leaf: [0.41, 0.54, 0.25], stem: [0.37, 0.33, 0.18] };
}

/// A picture with opacity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture {
    /// Texels from left to right.
    pub width: usize,
    /// Texels from top to bottom.
    pub height: usize,
    /// Red, green, blue and opacity, row-major from the top left.
    pub rgba: Vec<u8>,
}

/// How a shape lies in its picture.
pub(super) struct Sheet {
    bounds: [Point; 2],
    is_planar: bool,
}

impl Sheet {
    pub(super) fn of(ifs: &Ifs) -> Self {
        Self { bounds: ifs.bounds(), is_planar: ifs.is_planar() }
    }

    /// Pictures beside each other.
    pub(super) fn views(&self) -> usize {
        if self.is_planar { 1 } else { 2 }
    }

    /// The axis from left to right of a view: x from the front, z from the side.
    fn axis(view: usize) -> usize {
        if view == 0 { 0 } else { 2 }
    }

    /// The point of the shape's box at a share of its width and height, and its place in the texture.
    pub(super) fn corner(&self, view: usize, [side, along]: [f64; 2]) -> (Point, [f32; 2]) {
        let [low, high] = self.bounds;
        let mut point = [0.0; 3];
        let axis = Self::axis(view);
        point[axis] = low[axis] + side * (high[axis] - low[axis]);
        point[1] = low[1] + along * (high[1] - low[1]);
        let across = (view as f64 + side) / self.views() as f64;
        (point, [across as f32, (1.0 - along * (1.0 - BARK)) as f32])
    }

    /// A place of bark in the texture.
    pub(super) fn stem() -> [f32; 2] {
        [0.5, 0.4 * BARK as f32]
    }

    /// Width beside height of a view.
    fn aspect(&self) -> f64 {
        let [low, high] = self.bounds;
        let widest =
            (0..self.views()).map(|view| high[Self::axis(view)] - low[Self::axis(view)]).fold(0.0, f64::max);
        (widest / (high[1] - low[1]).max(1e-9)).clamp(1.0 / WIDEST, WIDEST)
    }
}

impl Texture {
    /// The picture of a fractal, so many texels high.
    pub fn of(ifs: &Ifs, height: usize, colours: Colours) -> Self {
        let sheet = Sheet::of(ifs);
        let bark = (BARK * height as f64) as usize;
        let view = ((height - bark) as f64 * sheet.aspect()) as usize + 1;
        let width = view * sheet.views();
        let counts = Counts::of(ifs, &sheet, [view, height - bark]);
        let mut rgba = Vec::with_capacity(4 * width * height);
        for _ in 0..bark * width {
            rgba.extend(bytes(colours.stem, 1.0));
        }
        for texel in 0..width * (height - bark) {
            let (tone, opacity) = counts.texel(texel % width, texel / width);
            // The light of a frond comes and goes with the depth of its leaflets.
            let shade = colours.leaf.map(|channel| channel * (0.55 + 0.45 * tone));
            rgba.extend(bytes(shade, opacity));
        }
        Self { width, height, rgba }
    }
}

fn bytes(colour: [f32; 3], opacity: f32) -> [u8; 4] {
    let [red, green, blue] = colour;
    [red, green, blue, opacity].map(|channel| libm::roundf(255.0 * channel.clamp(0.0, 1.0)) as u8)
}

/// How often quarters of texels were hit.
struct Counts {
    columns: usize,
    hits: Vec<u32>,
    most: f32,
}

impl Counts {
    fn of(ifs: &Ifs, sheet: &Sheet, [width, height]: [usize; 2]) -> Self {
        let [low, high] = sheet.bounds;
        let (columns, rows) = (2 * width * sheet.views(), 2 * height);
        let mut hits = vec![0_u32; columns * rows];
        let cell = |value: f64, axis: usize, count: usize| {
            let share = (value - low[axis]) / (high[axis] - low[axis]).max(1e-12);
            ((share * count as f64) as usize).min(count - 1)
        };
        Game::new(ifs, 1).points((width * height * sheet.views()) as u64 * POINTS, |block| {
            for number in 0..block.len() {
                let point = block.point(number).map(f64::from);
                let row = rows - 1 - cell(point[1], 1, rows);
                for view in 0..sheet.views() {
                    let axis = Sheet::axis(view);
                    hits[row * columns + 2 * width * view + cell(point[axis], axis, 2 * width)] += 1;
                }
            }
        });
        let most = hits.iter().copied().max().unwrap_or(1).max(1) as f32;
        Self { columns, hits, most }
    }

    /// Tone and opacity of a texel, both from 0 to 1.
    fn texel(&self, x: usize, y: usize) -> (f32, f32) {
        let quarters = [(0, 0), (1, 0), (0, 1), (1, 1)]
            .map(|(dx, dy)| self.hits[(2 * y + dy) * self.columns + 2 * x + dx]);
        let hit = quarters.iter().filter(|&&hits| hits > 0).count();
        if hit == 0 {
            return (0.5, 0.0);
        }
        let mean = quarters.iter().sum::<u32>() as f32 / hit as f32;
        (libm::log1pf(mean) / libm::log1pf(self.most), 0.25 * hit as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ifs::shapes;

    #[test]
    fn leaves_are_darker_than_their_colour_by_no_more_than_their_depth_says() {
        let ifs = shapes::find("fern").expect("built in").ifs();
        let texture = Texture::of(&ifs, 64, Colours { leaf: [0.8, 0.4, 0.2], stem: [0.0; 3] });
        let leaves = texture.rgba.chunks(4).filter(|texel| texel[3] > 0 && texel[0] > 0);
        let reds: Vec<u8> = leaves.map(|texel| texel[0]).collect();
        let (least, most) = (reds.iter().min().expect("leaves"), reds.iter().max().expect("leaves"));
        assert!(*least >= 112 && *most <= 204 && most - least > 30, "{least} to {most} of 204");
    }

    #[test]
    fn the_corners_of_the_sheet_are_those_of_the_box() {
        let sheet = Sheet { bounds: [[-1.0, -2.0, 0.0], [1.0, 3.0, 0.0]], is_planar: true };
        assert_eq!(sheet.corner(0, [0.0, 0.0]), ([-1.0, -2.0, 0.0], [0.0, 1.0]));
        assert_eq!(sheet.corner(0, [1.0, 1.0]), ([1.0, 3.0, 0.0], [1.0, BARK as f32]));
    }
}

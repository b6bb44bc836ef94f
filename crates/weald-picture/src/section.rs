//! A section: the ground cut open along a row or a column, with its layers in their colours, the water on it
//! and the ranges of hills behind it.
//!
//! Each pixel is covered by a material for the part of it that lies below the top of that material, so edges
//! are smooth. Behind stand the skylines of the ground beyond the cut, paler with distance.

use rayon::prelude::*;

use super::colour::{Linear, encode, linear_of_hex, linear_of_srgb, mix};
use super::contours::automatic_interval;
use super::cut::{Cut, Line, Slice};
use super::strokes::{Point, cover_at};
use super::{Image, PAPER, Picture, digits};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::random::{hash2, unit};

weald_core::choices! {
    /// Which way a cut runs.
    pub enum Along {
        /// From west to east.
        Row = "row",
        /// From north to south.
        Column = "column",
    }
}

weald_core::parameters! {
    /// A vertical cut through the ground.
    pub struct Section {
        /// Layer of heights in metres, under which the materials lie.
        of: LayerName = LayerName::of("height");
        /// Whether the cut runs along a row of cells, from west to east, or a column, from north to south.
        along: Along = Along::Row;
        /// Where it runs, as a share of the way from north to south for a row, from west to east for a column.
        at: f64 = 0.5, range 0.0..=1.0;
        /// Width of the picture.
        width: u32 = 1600, range 64..=16384, unit "px";
        /// How many times higher heights are drawn than lengths. By default the picture is about a third as
        /// high as it is wide.
        /// Where the picture would then be higher than 16,384 pixels, it is less.
        exaggeration: Option<f64> = None, range 0.01..=1000.0;
        /// Whether the layer `water` is drawn where it exists.
        water: bool = true;
        /// Layer with the heights of the ground as it was: a dashed line, and a shade where ground is gone.
        before: Option<LayerName> = None;
    }
}

/// Height of a picture as a share of its width, where the exaggeration is free.
const DEFAULT_HEIGHT: f64 = 0.36;

/// Room below the lowest bedrock and above the highest ground, as shares of the heights between them.
const ROOM: [f64; 2] = [0.16, 0.12];

/// Length in lines of a dash with the gap after it, and the share of the dash.
const DASH: f32 = 14.0;
const DASHED: f32 = 0.6;

/// Most pixels of a picture, and of its height.
const MAX_PIXELS: f64 = (1_u32 << 27) as f64;
const MAX_HEIGHT: f64 = 16384.0;

impl Section {
    fn cut(&self, landscape: &Landscape) -> Result<Cut, Error> {
        let ground = landscape.field(&self.of.0)?;
        let size = ground.size();
        let down = self.along == Along::Column;
        let lines = if down { size.columns } else { size.rows };
        let place = ((self.at * lines as f64) as usize).min(lines - 1);
        let line = Line { down, place };
        let cut = Cut::new(landscape, ground, line, self.water)?;
        match &self.before {
            Some(before) => Ok(cut.with_before(landscape.field(&before.0)?, line)),
            None => Ok(cut),
        }
    }
}

impl Picture for Section {
    fn reads(&self) -> Vec<String> {
        [Some(&self.of), self.before.as_ref()].into_iter().flatten().map(|name| name.0.clone()).collect()
    }

    fn optional(&self) -> Vec<String> {
        if self.water { vec!["water".to_owned()] } else { Vec::new() }
    }

    fn notes(&self, landscape: &Landscape) -> Vec<String> {
        let Ok(cut) = self.cut(landscape) else { return Vec::new() };
        let lowered = Frame::new(self, &cut, landscape.domain.cell).lowered;
        let asked = self.exaggeration.unwrap_or_default();
        let note = |drawn: f64| {
            format!(
                "heights are drawn {drawn:.3} times as high as lengths, not {asked}: the picture would be too high"
            )
        };
        lowered.map(note).into_iter().collect()
    }

    fn render(&self, landscape: &Landscape) -> Result<Image, Error> {
        let cut = self.cut(landscape)?;
        let frame = Frame::new(self, &cut, landscape.domain.cell);
        let slices = frame.slices(&cut);
        let colours = landscape.materials.iter().map(|material| linear_of_srgb(material.colour)).collect();
        let mut image = Drawing { frame: &frame, slices, inks: Inks::default(), colours }.paint();
        frame.label(&mut image);
        Ok(image)
    }
}

/// The picture's size and scale.
struct Frame {
    width: usize,
    /// Columns at the left that the heights are written on.
    margin: usize,
    height: usize,
    cells: usize,
    /// Height of the upper edge.
    high: f64,
    /// Height of a pixel in metres.
    rise: f64,
    /// Metres between the heights that are written at the edge.
    interval: f64,
    /// The exaggeration, where the picture would be too high with the one that was asked for.
    lowered: Option<f64>,
}

impl Frame {
    fn new(section: &Section, cut: &Cut, cell: f64) -> Self {
        let [low, high] = cut.range().unwrap_or([0.0, 1.0]).map(f64::from);
        let relief = if high > low { high - low } else { cell };
        let (low, high) = (low - ROOM[0] * relief, high + ROOM[1] * relief);
        let width = section.width as usize;
        let interval = automatic_interval(2.5 * relief).unwrap_or(relief);
        let longest = [low, high].map(|height| digits::width(&nearest(height, interval)));
        let margin = (side(width) * (longest[0].max(longest[1]) + 6)).min(width / 4);
        let run = cut.cells() as f64 * cell / (width - margin) as f64;
        let usual = DEFAULT_HEIGHT * width as f64 * run / (high - low);
        let asked = section.exaggeration.unwrap_or(usual);
        let most = MAX_HEIGHT.min((MAX_PIXELS / width as f64).floor());
        let rise = (run / asked).max((high - low) / most);
        let lowered = (rise > run / asked).then(|| run / rise);
        let height = ((high - low) / rise).ceil().clamp(1.0, most) as usize;
        Self { width, margin, height, cells: cut.cells(), high, rise, interval, lowered }
    }

    fn slices(&self, cut: &Cut) -> Vec<Slice> {
        let drawn = self.width - self.margin;
        let place = |x: usize| (x as f64 + 0.5) * self.cells as f64 / drawn as f64 - 0.5;
        (0..drawn).into_par_iter().map(|x| cut.at(place(x))).collect()
    }

    /// Rows from the top of the picture to a height.
    fn row(&self, height: f64) -> f32 {
        ((self.high - height) / self.rise) as f32
    }

    /// Pixels of a line that is one pixel wide on a picture of 1024.
    fn line(&self) -> f32 {
        (self.width as f32 / 1024.0).clamp(0.5, 6.0)
    }

    /// Heights in the margin, in metres, each with a tick at the ground.
    fn label(&self, image: &mut Image) {
        let side = side(self.width);
        let ink = encode(linear_of_hex(0x4a_4038));
        let lowest = self.high - self.rise * self.height as f64;
        let first = libm::ceil(lowest / self.interval) as i64;
        for level in first..=(libm::floor(self.high / self.interval) as i64) {
            let height = level as f64 * self.interval;
            let (row, text) = (self.row(height) as usize, nearest(height, self.interval));
            let (foot, length) = (digits::HEIGHT * side, (digits::width(&text) + 4) * side);
            if row < foot || row + foot > self.height || length > self.margin {
                continue;
            }
            digits::write(image, &text, [self.margin - length, row - foot / 2], side, ink);
            for y in row..(row + side.div_ceil(2)).min(self.height) {
                let tick = y * self.width + self.margin - 2 * side..y * self.width + self.margin;
                image.rgb[3 * tick.start..3 * tick.end].copy_from_slice(&ink.repeat(tick.len()));
            }
        }
    }
}

/// Side of the squares of a digit, in pixels.
fn side(width: usize) -> usize {
    (width / 640).max(1)
}

/// The multiple of `interval` nearest to a height, in its fewest digits.
fn nearest(height: f64, interval: f64) -> String {
    let places = if interval < 1.0 { libm::ceil(-libm::log10(interval)).min(9.0) as usize } else { 0 };
    format!("{:.places$}", (height / interval).round() * interval + 0.0)
}

/// Colours that no material has.
struct Inks {
    zenith: Linear,
    hills: [Linear; 3],
    shallow: Linear,
    deep: Linear,
    edge: Linear,
    before: Linear,
}

impl Default for Inks {
    fn default() -> Self {
        let hills = [0xa9_b3a8, 0xbf_c8c3, 0xd2_d8d6].map(linear_of_hex);
        let [zenith, shallow, deep, edge, before] =
            [0xd3_dfe4, 0x6f_b0cf, 0x25_5a8c, 0x2a_2420, 0xa8_321c].map(linear_of_hex);
        Self { zenith, hills, shallow, deep, edge, before }
    }
}

/// All that a pixel needs to know.
struct Drawing<'a> {
    frame: &'a Frame,
    slices: Vec<Slice>,
    inks: Inks,
    colours: Vec<Linear>,
}

impl Drawing<'_> {
    fn paint(&self) -> Image {
        let Frame { width, height, .. } = *self.frame;
        let mut rgb = vec![0; 3 * width * height];
        rgb.par_chunks_mut(3 * width).enumerate().for_each(|(y, row)| {
            for (x, pixel) in row.chunks_exact_mut(3).enumerate() {
                let place = x.checked_sub(self.frame.margin);
                pixel.copy_from_slice(&encode(place.map_or(PAPER, |x| self.pixel(x, y))));
            }
        });
        Image { width, height, rgb }
    }

    fn pixel(&self, x: usize, y: usize) -> Linear {
        let slice = &self.slices[x];
        let mut colour = mix(self.inks.zenith, PAPER, y as f32 / self.frame.height as f32);
        for (&skyline, &hill) in slice.skylines.iter().zip(&self.inks.hills).rev() {
            colour = mix(colour, hill, self.cover(skyline, y));
        }
        let Some(&surface) = slice.tops.last() else { return colour };
        if let Some(before) = slice.before {
            colour = mix(colour, self.inks.before, 0.22 * self.cover(before, y));
        }
        if let Some(level) = slice.level {
            let depth = (y as f32 - self.frame.row(f64::from(level))) / (40.0 * self.frame.line());
            let water = mix(self.inks.shallow, self.inks.deep, (depth / (depth.abs() + 0.6)).clamp(0.0, 1.0));
            colour = mix(colour, water, self.cover(level, y));
        }
        for (material, &top) in slice.tops.iter().enumerate().rev() {
            let below = material.checked_sub(1).map_or(f32::NEG_INFINITY, |below| slice.tops[below]);
            colour = mix(colour, self.rock(material, x, y), self.cover(top, y));
            if top - below > 0.5 * self.frame.rise as f32 {
                colour = mix(colour, self.shaded_edge(material), 0.6 * self.line(material, x, y, 1.1));
            }
        }
        let water_line = slice.level.is_some_and(|level| level > surface);
        let ink = if water_line { 0.5 } else { 0.9 };
        let colour = mix(colour, self.inks.edge, ink * self.line(slice.tops.len() - 1, x, y, 1.4));
        mix(colour, self.inks.before, self.dash(x, y))
    }

    /// Ink of the dashed line of the ground as it was.
    fn dash(&self, x: usize, y: usize) -> f32 {
        let place = x as f32 / (DASH * self.frame.line());
        if place - place.floor() > DASHED {
            return 0.0;
        }
        self.ink([x, y], 1.2, |slice| slice.before)
    }

    /// The part of a pixel of row `y` that lies below a height.
    fn cover(&self, height: f32, y: usize) -> f32 {
        (y as f32 + 1.0 - self.frame.row(f64::from(height))).clamp(0.0, 1.0)
    }

    fn shaded_edge(&self, material: usize) -> Linear {
        self.colours[material].map(|channel| 0.35 * channel)
    }

    /// A material with its grain: beds that are long and thin, blotches for the bedrock.
    fn rock(&self, material: usize, x: usize, y: usize) -> Linear {
        let line = self.frame.line();
        let grain = if material == 0 { [22.0, 14.0] } else { [70.0, 3.5] };
        let place = [x as f32 / (grain[0] * line), y as f32 / (grain[1] * line)];
        let speck = unit(hash2(material as u64, x as i64, y as i64)) as f32 - 0.5;
        let tone = 0.14 * (noise(material as u64, place) - 0.5) + 0.05 * speck;
        let deep = 1.0 - 0.22 * (y as f32 / self.frame.height as f32);
        self.colours[material].map(|channel| channel * (1.0 + tone) * deep)
    }

    /// Ink of a line of so many pixels along the top of a material, even where it is steep.
    fn line(&self, material: usize, x: usize, y: usize, width: f32) -> f32 {
        self.ink([x, y], width, |slice| slice.tops.get(material).copied())
    }

    /// Ink of a line of so many pixels through a height of each slice.
    fn ink(&self, [x, y]: [usize; 2], width: f32, height: impl Fn(&Slice) -> Option<f32>) -> f32 {
        let width = width * self.frame.line();
        let point = |x: usize| {
            let row = self.frame.row(f64::from(height(&self.slices[x])?));
            Some(Point { x: x as f32 + 0.5, y: row, width, opacity: 1.0 })
        };
        let Some(here) = point(x) else { return 0.0 };
        let cover = |from, to| cover_at(here.x, y as f32 + 0.5, from, to);
        let reach = (0.5 * width + 0.5).ceil() as usize;
        let segments = x.saturating_sub(reach)..(x + reach).min(self.slices.len() - 1);
        let covers = segments.filter_map(|left| Some(cover(point(left)?, point(left + 1)?)));
        covers.fold(cover(here, here), f32::max)
    }
}

/// Smooth random values from 0 to 1, one a square.
fn noise(seed: u64, [x, y]: [f32; 2]) -> f32 {
    let (column, row) = (x.floor(), y.floor());
    let ease = |t: f32| t * t * (3.0 - 2.0 * t);
    let (right, down) = (ease(x - column), ease(y - row));
    let corner = |dx: i64, dy: i64| unit(hash2(seed, column as i64 + dx, row as i64 + dy)) as f32;
    let upper = corner(0, 0) * (1.0 - right) + corner(1, 0) * right;
    let lower = corner(0, 1) * (1.0 - right) + corner(1, 1) * right;
    upper * (1.0 - down) + lower * down
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_in_the_margin_stand_at_their_ticks() {
        let frame = Frame {
            width: 640,
            margin: 60,
            height: 400,
            cells: 10,
            high: 350.0,
            rise: 1.0,
            interval: 100.0,
            lowered: None,
        };
        let mut image = Image::paper(640, 400);
        let paper = image.pixel(0, 0);
        frame.label(&mut image);
        let ticks: Vec<_> = (0..400).filter(|&y| image.pixel(59, y) != paper).collect();
        assert_eq!(ticks, [50, 150, 250, 350], "300, 200, 100 and 0 m");
        for y in (0..400).filter(|&y| (0..50).any(|x| image.pixel(x, y) != paper)) {
            assert!(ticks.iter().any(|tick| tick.abs_diff(y) <= digits::HEIGHT), "there is writing at {y}");
        }
    }

    #[test]
    fn the_far_hills_have_no_leaps() {
        for [before, after] in [[[0.9999, 0.5], [1.0, 0.5]], [[2.5, 3.9999], [2.5, 4.0]]] {
            assert!((noise(3, before) - noise(3, after)).abs() < 1e-3, "at {after:?}");
        }
    }

    #[test]
    fn the_line_of_a_cliff_does_not_stand_out_over_its_edge() {
        use weald_core::domain::Domain;
        use weald_core::grid::{Field, Size};
        // About a pixel a cell, so that the cliff falls by many pixels in one.
        let size = Size::new(1200, 1).expect("small");
        let mut landscape = Landscape::new(Domain::new(size, 1.0));
        let ground = |x: usize, _| [40.0, 30.0, 5.0][usize::from(x >= 100) + usize::from(x >= 600)];
        landscape.insert("height", "m", Field::from_function(size, ground));
        let image = Section::default().render(&landscape).expect("draws");
        let inked = |x: usize| {
            let is_dark = |y: &usize| image.pixel(x, *y).iter().all(|&channel| channel < 120);
            (0..image.height).find(is_dark).expect("the ground has an edge")
        };
        let flat = inked(400);
        let highest = (300..image.width).map(inked).min().expect("columns");
        assert!(flat.abs_diff(highest) <= 1, "the line is at {flat} and comes up to {highest}");
        assert!(inked(image.width - 10) > flat + 20, "the cliff is high");
    }

    #[test]
    fn the_ground_as_it_was_is_a_red_line_over_what_is_gone() {
        use weald_core::domain::Domain;
        use weald_core::grid::{Field, Size};
        let size = Size::new(30, 1).expect("small");
        let mut landscape = Landscape::new(Domain::new(size, 1.0));
        landscape.insert("height", "m", Field::from_function(size, |x, _| if x < 15 { 10.0 } else { 5.0 }));
        landscape.insert("was", "m", Field::filled(size, 10.0));
        let section = Section { width: 300, ..Section::default() };
        let now = section.render(&landscape).expect("draws");
        let with_before = Section { before: Some(LayerName::of("was")), ..section };
        let image = with_before.render(&landscape).expect("draws");
        assert_eq!((image.width, image.height), (now.width, now.height));
        let redder = |x: usize, y: usize| {
            let [now, image] = [&now, &image].map(|image| image.pixel(x, y).map(i32::from));
            (image[0] - image[2]) - (now[0] - now[2]) > 8
        };
        let red = |x: usize| (0..image.height).filter(|&y| redder(x, y)).count();
        assert!(red(240) > image.height / 4, "{} of {} rows where ground is gone", red(240), image.height);
        assert!(red(80) < 4, "{} rows where it stays", red(80));
    }
}

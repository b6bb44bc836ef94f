//! Writing around a picture: the strip beside a map, with what its colours stand for and a scale bar, and a title.

use super::Image;
use super::colour::{Linear, encode, linear_of_hex};
use super::font::{Pen, blend};
use super::ramp::Ramp;
use super::ticks::{Ticks, step};

/// Pixels of the map's longer side a unit; all lengths here are in units.
const PIXELS_PER_UNIT: f32 = 620.0;

/// Least and greatest side of a unit in pixels: a text of less than half a pixel a unit cannot be read.
const UNITS: [f32; 2] = [0.9, 12.0];

/// Colour of a title.
const TITLE_INK: Linear = [0.06, 0.05, 0.04];

const MARGIN: f32 = 10.0;
const BAR_WIDTH: f32 = 14.0;
const TICK: f32 = 4.0;
/// From the top of the title to that of the bar.
const BELOW_TITLE: f32 = 19.0;
/// Greatest length of the bar.
const BAR_HEIGHT: f32 = 300.0;
/// Height of the scale bar with its text and the room above it.
const SCALE_HEIGHT: f32 = 30.0;
/// Greatest length of the scale bar.
const SCALE_WIDTH: f32 = 70.0;
/// From one name to the next.
const NAME_STEP: f32 = 16.0;

const INK: u32 = 0x3a_342e;

/// What colours stand for.
#[derive(Debug)]
pub(super) enum Key {
    /// Values along a ramp.
    Bar { ramp: Ramp, ticks: Ticks },
    /// A name each, from top to bottom.
    Names(Vec<(String, Linear)>),
}

/// A legend.
#[derive(Debug)]
pub(super) struct Legend<'a> {
    pub(super) title: &'a str,
    /// Unit of the values; `1` is not written.
    pub(super) unit: &'a str,
    pub(super) key: Key,
    pub(super) metres_per_pixel: f64,
}

/// The strip and the pen that writes on it.
struct Strip {
    image: Image,
    pen: Pen,
}

impl Legend<'_> {
    /// The map with the legend to its right.
    pub(super) fn beside(&self, map: Image) -> Image {
        let unit = (map.width.max(map.height) as f32 / PIXELS_PER_UNIT).clamp(UNITS[0], UNITS[1]);
        let pen = Pen { unit, ink: linear_of_hex(INK) };
        let width = (unit * (self.width() + 2.0 * MARGIN)).ceil() as usize;
        let needed = (unit * self.least_height()).ceil() as usize;
        let mut strip = Strip { image: Image::paper(width, map.height.max(needed)), pen };
        strip.write(&self.title(), [MARGIN, MARGIN]);
        match &self.key {
            Key::Bar { ramp, ticks } => strip.bar(ramp, ticks),
            Key::Names(names) => strip.names(names),
        }
        strip.scale(self.metres_per_pixel);
        Image::beside(&[map, strip.image], 0)
    }

    fn title(&self) -> String {
        if self.unit == "1" { self.title.to_owned() } else { format!("{} in {}", self.title, self.unit) }
    }

    /// Width of what is written, in units.
    fn width(&self) -> f32 {
        let lines: Vec<&str> = match &self.key {
            Key::Bar { ticks, .. } => ticks.0.iter().map(|(_, text)| text.as_str()).collect(),
            Key::Names(names) => names.iter().map(|(name, _)| name.as_str()).collect(),
        };
        let key = lines.into_iter().map(super::font::width).fold(0.0, f32::max);
        (key + BAR_WIDTH + 2.0 * TICK).max(super::font::width(&self.title())).max(SCALE_WIDTH)
    }

    fn least_height(&self) -> f32 {
        let key = match &self.key {
            Key::Bar { .. } => 4.0 * NAME_STEP,
            Key::Names(names) => names.len() as f32 * NAME_STEP,
        };
        2.0 * MARGIN + BELOW_TITLE + key + SCALE_HEIGHT
    }
}

impl Strip {
    /// Height of the strip in units.
    fn height(&self) -> f32 {
        self.image.height as f32 / self.pen.unit
    }

    fn write(&mut self, text: &str, [left, top]: [f32; 2]) {
        let unit = self.pen.unit;
        self.pen.write(&mut self.image, text, [unit * left, unit * top]);
    }

    /// Fills a rectangle, given by its left, top, width and height in units, with smooth edges.
    fn fill(&mut self, [left, top, width, height]: [f32; 4], ink: Linear) {
        let unit = self.pen.unit;
        let [left, top, right, bottom] = [left, top, left + width, top + height].map(|at| at * unit);
        let cover = |at: f32, from: f32, to: f32| (to.min(at + 1.0) - from.max(at)).clamp(0.0, 1.0);
        for y in top.floor() as usize..bottom.ceil() as usize {
            for x in left.floor() as usize..right.ceil() as usize {
                let place = [x as f32, y as f32];
                blend(
                    &mut self.image,
                    place,
                    ink,
                    cover(place[0], left, right) * cover(place[1], top, bottom),
                );
            }
        }
    }

    fn bar(&mut self, ramp: &Ramp, ticks: &Ticks) {
        let top = MARGIN + BELOW_TITLE;
        let length = (self.height() - top - SCALE_HEIGHT - 1.5 * MARGIN).min(BAR_HEIGHT);
        let ink = self.pen.ink;
        self.fill([MARGIN - 0.6, top - 0.6, BAR_WIDTH + 1.2, length + 1.2], ink);
        let unit = self.pen.unit;
        let (left, right) = ((unit * MARGIN) as usize, (unit * (MARGIN + BAR_WIDTH)) as usize);
        for y in (unit * top) as usize..(unit * (top + length)) as usize {
            let share = 1.0 - (y as f32 + 0.5 - unit * top) / (unit * length);
            let row = encode(ramp.at(share)).repeat(right - left);
            let start = 3 * (y * self.image.width + left);
            self.image.rgb[start..start + row.len()].copy_from_slice(&row);
        }
        for (place, text) in &ticks.0 {
            let y = top + (1.0 - *place as f32) * length;
            self.fill([MARGIN + BAR_WIDTH, y - 0.5, TICK, 1.0], ink);
            self.write(text, [MARGIN + BAR_WIDTH + 2.0 * TICK, y - 0.5 * super::font::CAPITAL]);
        }
    }

    fn names(&mut self, names: &[(String, Linear)]) {
        let ink = self.pen.ink;
        for (at, (name, colour)) in names.iter().enumerate() {
            let top = MARGIN + BELOW_TITLE + NAME_STEP * at as f32;
            self.fill([MARGIN - 0.6, top - 0.6, BAR_WIDTH + 1.2, 0.7 * NAME_STEP + 1.2], ink);
            self.fill([MARGIN, top, BAR_WIDTH, 0.7 * NAME_STEP], *colour);
            self.write(name, [MARGIN + BAR_WIDTH + 2.0 * TICK, top + 0.35 * NAME_STEP - 4.0]);
        }
    }

    /// A bar of a round length.
    fn scale(&mut self, metres_per_pixel: f64) {
        let metres_per_crs_unit = metres_per_pixel * f64::from(self.pen.unit);
        let longest = f64::from(SCALE_WIDTH) * metres_per_crs_unit;
        // The greatest round length that is no longer.
        let rounded = [1.0, 0.5, 0.4, 0.2].map(|share| step(longest * share));
        let metres = rounded.into_iter().find(|metres| *metres <= longest).unwrap_or(longest);
        let length = (metres / metres_per_crs_unit) as f32;
        let foot = self.height() - MARGIN;
        let ink = self.pen.ink;
        self.fill([MARGIN, foot - 1.2, length, 1.2], ink);
        for end in [MARGIN, MARGIN + length - 1.2] {
            self.fill([end, foot - 5.0, 1.2, 5.0], ink);
        }
        self.write(&distance(metres), [MARGIN, foot - 17.0]);
    }
}

/// A length in metres or kilometres.
fn distance(metres: f64) -> String {
    if metres >= 1000.0 { format!("{} km", metres / 1000.0) } else { format!("{metres} m") }
}

impl Image {
    /// The picture below a line of writing.
    #[must_use]
    pub fn titled(&self, title: &str) -> Self {
        let pen = Pen { unit: 1.25, ink: TITLE_INK };
        let mut line = Self::paper(self.width, (2.6 * pen.height()) as usize);
        pen.write(&mut line, title, [2.0, 0.7 * pen.height()]);
        Self::below(&[line, self.clone()], 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PAPER, Scale};

    fn legend(ticks: Ticks, metres_per_pixel: f64) -> Image {
        let key = Key::Bar { ramp: Scale::Grey.ramp(), ticks };
        let legend = Legend { title: "height", unit: "m", key, metres_per_pixel };
        legend.beside(Image { width: 620, height: 500, rgb: [9, 99, 9].repeat(620 * 500) })
    }

    #[test]
    fn the_map_stays_as_it_is_and_the_bar_runs_from_the_lowest_colour_up_to_the_highest() {
        let image = legend(Ticks::linear([0.0, 100.0]), 10.0);
        assert!(image.width > 660 && image.height == 500);
        assert!((0..620).all(|x| image.pixel(x, 250) == [9, 99, 9]));
        let column: Vec<u8> = (0..500).map(|y| image.pixel(620 + (MARGIN + 6.0) as usize, y)[0]).collect();
        let (top, bottom) =
            ((MARGIN + BELOW_TITLE + 2.0) as usize, (MARGIN + BELOW_TITLE + BAR_HEIGHT - 2.0) as usize);
        assert!(column[top] > 245 && column[bottom] < 10, "{} {}", column[top], column[bottom]);
        assert!(column[top..bottom].windows(2).all(|pair| pair[1] <= pair[0]));
    }

    #[test]
    fn a_tick_stands_at_its_share_of_the_bar() {
        let bare = legend(Ticks(Vec::new()), 10.0);
        let marked = legend(Ticks(vec![(0.25, "x".to_owned())]), 10.0);
        assert_eq!(marked.width, bare.width);
        let x = 620 + (MARGIN + BAR_WIDTH + 2.0) as usize;
        let rows: Vec<usize> = (0..500).filter(|&y| marked.pixel(x, y) != bare.pixel(x, y)).collect();
        let expected = MARGIN + BELOW_TITLE + 0.75 * BAR_HEIGHT;
        assert!(
            !rows.is_empty() && rows.iter().all(|&y| (y as f32 - expected).abs() <= 1.5),
            "{rows:?} for {expected}"
        );
    }

    #[test]
    fn the_scale_bar_is_as_long_as_it_says() {
        for (metres_per_pixel, metres) in [(10.0, 500.0), (1.0, 50.0), (40.0, 2000.0), (0.3, 20.0)] {
            let image = legend(Ticks(Vec::new()), metres_per_pixel);
            let y = 500 - MARGIN as usize - 1;
            let paper = encode(PAPER);
            let length = (620..image.width).filter(|&x| image.pixel(x, y) != paper).count();
            assert!(
                (length as f64 - metres / metres_per_pixel).abs() <= 1.0,
                "{length} pixels at {metres_per_pixel} m"
            );
        }
    }

    #[test]
    fn each_name_has_its_colour_beside_it_one_below_the_other() {
        let colours = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let key = Key::Names(colours.iter().map(|&colour| ("rock".to_owned(), colour)).collect());
        let legend = Legend { title: "materials", unit: "1", key, metres_per_pixel: 1.0 };
        let image = legend.beside(Image { width: 620, height: 500, rgb: vec![0; 3 * 620 * 500] });
        for (at, colour) in colours.into_iter().enumerate() {
            let middle = MARGIN + BELOW_TITLE + NAME_STEP * (at as f32 + 0.35);
            let pixel = image.pixel(620 + (MARGIN + 0.5 * BAR_WIDTH) as usize, middle as usize);
            assert_eq!(pixel, encode(colour), "name {at}");
            let written = |x: &usize| image.pixel(*x, middle as usize) != encode(PAPER);
            let beside = 620 + (MARGIN + BAR_WIDTH + TICK) as usize;
            let first = (beside..image.width).find(written).expect("a name");
            assert!(first < beside + 8, "name {at} begins {} pixels from its colour", first - beside);
        }
    }

    #[test]
    fn a_title_stands_above_its_picture_and_leaves_it_as_it_was() {
        let image = Image { width: 40, height: 2, rgb: (0..240).collect() };
        let titled = image.titled("k 0.5");
        let above = titled.height - image.height;
        assert_eq!(titled.rgb[3 * 40 * above..], image.rgb);
        let dark = titled.rgb[..3 * 40 * above].chunks(3).filter(|pixel| pixel[0] < 100).count();
        assert!(dark > 15, "{dark} dark pixels");
    }
}

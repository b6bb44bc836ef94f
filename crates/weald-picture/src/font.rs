//! Writing on pictures: all of ASCII and the signs of units, as lines of even width at any size.
//!
//! A glyph is a list of lines over a grid on which capitals stand from row 0 to row 8, small letters from row 3, and
//! tails hang to row 10. Each point is two figures, column and row (`a` is 10); a line that begins with `~` is rounded.
//! The width of a glyph is its greatest column.

use super::Image;
use super::colour::{Linear, encode, linear_of_hex, mix};
use super::strokes::{Point, Strokes};

/// Units between the rows 0 and 8: the height of a capital.
pub(super) const CAPITAL: f32 = 8.0;

/// Units between two glyphs, and of a space.
const GAP: f32 = 2.2;
const SPACE: f32 = 2.6;

/// Width of a line in units.
const LINE: f32 = 1.05;

/// Size of raised figures.
const RAISED: f32 = 0.6;

/// Figures that are drawn small and raised, and what they are drawn as.
const SUPERSCRIPTS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻";
const AS: &str = "0123456789-";

const GLYPHS: &[(char, &str)] = &[
    ('A', "083068 1555"),
    ('B', "0800 ~002050542404 ~042464682808"),
    ('C', "~626000086866"),
    ('D', "0800 ~002060682808"),
    ('E', "50000858 0444"),
    ('F', "500008 0444"),
    ('G', "~626000086865 6545"),
    ('H', "0008 6068 0464"),
    ('I', "0008"),
    ('J', "~4044480806"),
    ('K', "0008 5005 2358"),
    ('L', "000848"),
    ('M', "0800356068"),
    ('N', "08006860"),
    ('O', "~040060680804"),
    ('P', "0800 ~002050542404"),
    ('Q', "~040060680804 4668"),
    ('R', "0800 ~002050542404 2458"),
    ('S', "~5150000454580807"),
    ('T', "0060 3038"),
    ('U', "~000408686460"),
    ('V', "003860"),
    ('W', "0028426880"),
    ('X', "0058 5008"),
    ('Y', "003460 3438"),
    ('Z', "00500858"),
    ('a', "5358 ~555303085856"),
    ('b', "0008 ~050353580806"),
    ('c', "~545303085857"),
    ('d', "5058 ~555303085856"),
    ('e', "0555 ~555303085857"),
    ('f', "~30101218 0333"),
    ('g', "~555303085856 ~53575a0a"),
    ('h', "0008 ~05035358"),
    ('i', "0308 0101"),
    ('j', "~23282a0a 2121"),
    ('k', "0008 4306 2548"),
    ('l', "0008"),
    ('m', "0308 ~05034348 ~45438388"),
    ('n', "0308 ~05035358"),
    ('o', "~05035358080605"),
    ('p', "030a ~050353580806"),
    ('q', "535a ~555303085856"),
    ('r', "0308 ~050333"),
    ('s', "~4443030546480807"),
    ('t', "~11161838 0333"),
    ('u', "5358 ~03085856"),
    ('v', "032843"),
    ('w', "0328446883"),
    ('x', "0348 4308"),
    ('y', "0328 431a"),
    ('z', "03430848"),
    ('0', "~040050580804"),
    ('1', "022028"),
    ('2', "~0200505308 0858"),
    ('3', "~0100505424 ~2454580807"),
    ('4', "48400656"),
    ('5', "500004 ~040353580807"),
    ('6', "~5000050858530306"),
    ('7', "005028"),
    ('8', "~240400505424 ~240408585424"),
    ('9', "~0858535000055552"),
    ('.', "0808"),
    (',', "180a"),
    (':', "0404 0808"),
    (';', "1414 180a"),
    ('!', "0005 0808"),
    ('?', "~02003050533435 3838"),
    ('-', "0535"),
    ('−', "0545"),
    ('+', "0545 2327"),
    ('=', "0444 0646"),
    ('_', "0858"),
    ('/', "0840"),
    ('\\', "0048"),
    ('|', "000a"),
    ('(', "~20030629"),
    (')', "~00232609"),
    ('[', "20000929"),
    (']', "00202909"),
    ('{', "~30101404 ~04141939"),
    ('}', "~00202434 ~34242909"),
    ('<', "420548"),
    ('>', "024508"),
    ('*', "2024 0143 4103"),
    ('#', "2018 4038 0353 0555"),
    ('$', "~5150000454580807 3039"),
    ('%', "6008 ~010010202122120201 ~474656666768584847"),
    ('&', "~68121030404205083865"),
    ('\'', "0002"),
    ('"', "0002 2022"),
    ('`', "0012"),
    ('^', "022042"),
    ('~', "~05143645"),
    ('@', "~7838080400407073765653 ~54432325264655"),
    ('°', "~010010202122120201"),
    ('·', "0505"),
    ('×', "0347 4307"),
    ('µ', "030a ~03085856 5358"),
];

/// What is drawn for a sign without a glyph: an empty box.
const UNKNOWN: &str = "0050580800";

/// A glyph, its size and how far its top lies below row 0.
fn glyph(sign: char) -> (&'static str, f32) {
    let raised = SUPERSCRIPTS.chars().zip(AS.chars()).find(|&(raised, _)| raised == sign);
    let (sign, size) = raised.map_or((sign, 1.0), |(_, plain)| (plain, RAISED));
    let known = GLYPHS.iter().find(|(known, _)| *known == sign);
    (known.map_or(UNKNOWN, |(_, lines)| lines), size)
}

/// Columns and rows of the points of a line.
fn points(line: &str) -> Vec<[f32; 2]> {
    let figures: Vec<f32> =
        line.chars().filter_map(|figure| figure.to_digit(16)).map(|figure| figure as f32).collect();
    figures.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect()
}

fn advance(sign: char) -> f32 {
    if sign == ' ' {
        return SPACE + GAP;
    }
    let (lines, size) = glyph(sign);
    let widest = points(&lines.replace([' ', '~'], "")).iter().map(|point| point[0]).fold(0.0, f32::max);
    size * widest + GAP
}

/// Width of a text in units of which a capital has eight.
pub(super) fn width(text: &str) -> f32 {
    (text.chars().map(advance).sum::<f32>() - GAP).max(0.0)
}

/// How a text is written.
#[derive(Clone, Copy, Debug)]
pub struct Pen {
    /// Pixels a unit: a capital is eight times as high.
    pub unit: f32,
    /// Colour of the letters.
    pub ink: Linear,
}

impl Pen {
    /// Width of a text in pixels.
    pub fn width(&self, text: &str) -> f32 {
        self.unit * width(text)
    }

    /// Height of a capital in pixels.
    pub fn height(&self) -> f32 {
        self.unit * CAPITAL
    }

    /// Writes a text whose top left corner is at (`left`, `top`). What does not fit on the picture is cut off.
    pub fn write(&self, image: &mut Image, text: &str, [left, top]: [f32; 2]) {
        let rim = 2.0 * self.unit + 2.0;
        let size =
            [self.width(text) + 2.0 * rim, self.unit * 10.0 + 2.0 * rim].map(|side| side.ceil() as usize);
        let corner = [left - rim, top - rim].map(f32::floor);
        let mut strokes = Strokes::new(size[0], size[1]);
        let mut place = left - corner[0];
        for sign in text.chars() {
            if sign != ' ' {
                self.draw(&mut strokes, sign, [place, top - corner[1]]);
            }
            place += self.unit * advance(sign);
        }
        for y in 0..size[1] {
            for (x, &cover) in strokes.row(y).iter().enumerate() {
                blend(image, [corner[0] + x as f32, corner[1] + y as f32], self.ink, cover);
            }
        }
    }

    fn draw(&self, strokes: &mut Strokes, sign: char, [left, top]: [f32; 2]) {
        let (lines, size) = glyph(sign);
        // Raised figures would otherwise be too thin.
        let line = LINE * size.sqrt() * self.unit;
        for shape in lines.split(' ') {
            let place = |[column, row]: [f32; 2]| Point {
                x: left + self.unit * size * column,
                y: top + self.unit * size * row,
                width: line,
                opacity: 1.0,
            };
            let points: Vec<_> = points(shape).into_iter().map(place).collect();
            if shape.starts_with('~') { strokes.draw(&points) } else { strokes.draw_straight(&points) }
        }
    }
}

/// Mixes ink into a pixel, if it is on the picture.
pub fn blend(image: &mut Image, [x, y]: [f32; 2], ink: Linear, cover: f32) {
    if cover <= 0.0 || x < 0.0 || y < 0.0 || x >= image.width as f32 || y >= image.height as f32 {
        return;
    }
    let (x, y) = (x as usize, y as usize);
    let [r, g, b] = image.pixel(x, y).map(u32::from);
    let below = linear_of_hex(r << 16 | g << 8 | b);
    let at = 3 * (y * image.width + x);
    image.rgb[at..at + 3].copy_from_slice(&encode(mix(below, ink, cover.min(1.0))));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn page(text: &str, unit: f32) -> Image {
        let mut image = Image::paper(400, 60);
        Pen { unit, ink: [0.0; 3] }.write(&mut image, text, [10.0, 10.0]);
        image
    }

    fn inked(image: &Image) -> Vec<[usize; 2]> {
        let paper = Image::paper(1, 1).pixel(0, 0);
        let all = (0..image.width * image.height).map(|at| [at % image.width, at / image.width]);
        all.filter(|&[x, y]| image.pixel(x, y) != paper).collect()
    }

    #[test]
    fn every_sign_of_ascii_and_of_units_has_a_look_of_its_own() {
        let signs: Vec<char> = ('!'..='~').chain("°·×²³⁻¹⁴µ−".chars()).collect();
        let unknown = page("\u{2603}", 2.0);
        let looks: Vec<Image> = signs.iter().map(|sign| page(&sign.to_string(), 2.0)).collect();
        for (at, look) in looks.iter().enumerate() {
            assert!(!inked(look).is_empty() && *look != unknown, "{} is a box", signs[at]);
            let same = looks[..at].iter().position(|other| other == look);
            // A bar is a bar: capital I and small l differ in nothing but their neighbours.
            assert!(
                same.is_none() || "Il|".contains(signs[at]),
                "{} looks like {}",
                signs[at],
                signs[same.unwrap_or(0)]
            );
        }
    }

    #[test]
    fn a_text_is_as_wide_as_it_says_and_capitals_are_eight_units_high() {
        let image = page("HEIGHT", 2.5);
        let inked = inked(&image);
        let span = |axis: usize| {
            let places = inked.iter().map(|place| place[axis]);
            places.clone().max().unwrap_or(0) - places.min().unwrap_or(0)
        };
        assert!((span(0) as f32 - 2.5 * (width("HEIGHT") + LINE)).abs() < 3.0);
        assert!((span(1) as f32 - 2.5 * (CAPITAL + LINE)).abs() < 3.0);
    }

    #[test]
    fn what_does_not_fit_is_cut_off() {
        let mut image = Image::paper(9, 9);
        Pen { unit: 3.0, ink: [0.0; 3] }.write(&mut image, "Wm²", [-7.0, -4.0]);
        assert!(!inked(&image).is_empty());
    }
}

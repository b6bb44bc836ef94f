//! Writing flames: maps as xforms, in a frame that shows all of the shape upright.

use std::fmt::Write;

use super::super::system::Ifs;
use super::xform::numbers;
use weald_core::error::Error;

/// How a flame is to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Columns and rows of the picture.
    pub size: [u32; 2],
    /// Points for each pixel of the picture.
    pub quality: f64,
    /// Greatest radius, in pixels, over which flam3 spreads points where they are few; 0 for none.
    pub spread: f64,
    /// Radius of flam3's filter, in pixels.
    pub filter: f64,
}

impl Default for Frame {
    fn default() -> Self {
        Self { size: [1024; 2], quality: 200.0, spread: 9.0, filter: 0.5 }
    }
}

/// Share of the frame that the shape fills, in the direction in which it fills more.
const FILLED: f64 = 0.9;

/// Colours from map 0 to the last: bark, leaf, young leaf.
const COLOURS: [[f64; 3]; 3] = [[122.0, 84.0, 50.0], [72.0, 160.0, 62.0], [222.0, 232.0, 128.0]];

impl Frame {
    /// Least x and y of what is drawn, and pixels for one unit of length.
    pub fn window(&self, ifs: &Ifs) -> ([f64; 2], f64) {
        let [low, high] = ifs.bounds();
        let sizes = self.size.map(f64::from);
        let share = |axis: usize| sizes[axis] / (high[axis] - low[axis]).max(1e-9 * (1.0 + high[axis].abs()));
        let scale = FILLED * share(0).min(share(1));
        let least = |axis: usize| 0.5 * (low[axis] + high[axis]) - 0.5 * sizes[axis] / scale;
        ([least(0), least(1)], scale)
    }
}

/// A file of one flame for each fractal, which flam3 draws as the same shape. Numbers of the maps come back to the bit,
/// probabilities within 1e-15.
///
/// # Errors
/// [`Error::Run`] for a 3D fractal: a flame is 2D.
pub fn write(fractals: &[Ifs], frame: &Frame) -> Result<String, Error> {
    let mut text = String::from("<flames>\n");
    for (time, ifs) in fractals.iter().enumerate() {
        if !ifs.is_planar() {
            return Err(Error::Run(format!(
                "`{}` is a 3D fractal, and a .flame file holds 2D maps; choose a 2D one",
                ifs.name()
            )));
        }
        text += &flame(ifs, frame, time);
    }
    Ok(text + "</flames>\n")
}

fn flame(ifs: &Ifs, frame: &Frame, time: usize) -> String {
    let (least, scale) = frame.window(ifs);
    let [columns, rows] = frame.size;
    let centre = [least[0] + 0.5 * f64::from(columns) / scale, -(least[1] + 0.5 * f64::from(rows) / scale)];
    let Frame { quality, spread, filter, .. } = frame;
    let last = (ifs.maps().len() - 1) as f64;
    let xforms = ifs.maps().iter().enumerate().map(|(number, weighted)| {
        let coefs = numbers(&weighted.map).map(|number| format!("{number:?}")).join(" ");
        let (weight, colour) = (weighted.probability, number as f64 / last);
        format!("   <xform weight=\"{weight:?}\" color=\"{colour:?}\" linear=\"1\" coefs=\"{coefs}\"/>\n")
    });
    format!(
        "<flame name=\"{name}\" version=\"Weald {version}\" time=\"{time}\" size=\"{columns} {rows}\" \
         center=\"{x:?} {y:?}\" scale=\"{scale:?}\" rotate=\"0\" zoom=\"0\" supersample=\"1\" filter=\"{filter:?}\" \
         quality=\"{quality:?}\" background=\"0 0 0\" brightness=\"4\" gamma=\"4\" gamma_threshold=\"0.01\" vibrancy=\"1\" \
         estimator_radius=\"{spread:?}\" estimator_minimum=\"0\" estimator_curve=\"0.4\">\n{xforms}{palette}</flame>\n",
        name = escaped(ifs.name()),
        version = env!("CARGO_PKG_VERSION"),
        x = centre[0] + 0.0,
        y = centre[1] + 0.0,
        xforms = xforms.collect::<String>(),
        palette = palette(),
    )
}

/// 256 colours, eight a line.
fn palette() -> String {
    let mut text = String::from("   <palette count=\"256\" format=\"RGB\">");
    for place in 0..256 {
        if place % 8 == 0 {
            text += "\n      ";
        }
        let along = f64::from(place) / 255.0 * (COLOURS.len() - 1) as f64;
        let from = (along as usize).min(COLOURS.len() - 2);
        let share = along - from as f64;
        for (low, high) in COLOURS[from].iter().zip(COLOURS[from + 1]) {
            let value = low * (1.0 - share) + high * share;
            let _ = write!(text, "{:02X}", value.round() as u8);
        }
    }
    text + "\n   </palette>\n"
}

/// A name as the value of an attribute.
fn escaped(name: &str) -> String {
    let mut text = String::new();
    for character in name.chars() {
        match character {
            '&' => text += "&amp;",
            '<' => text += "&lt;",
            '"' => text += "&quot;",
            // No XML file may hold them.
            character if character.is_control() || matches!(character, '\u{fffe}' | '\u{ffff}') => {
                text.push(' ');
            }
            character => text.push(character),
        }
    }
    text
}

//! How a fractal is drawn, declared once for recipes and for the command line.

use super::super::Watch;
use super::super::colour::{Linear, encode, linear_of_hex, linear_of_srgb};
use super::super::cutout::Cutout;
use super::camera::Camera;
use super::colouring::{ColourBy, Colouring};
use super::density::{Density, Sampling};
use super::frame::{Extent, Frame};
use super::marks::{Mark, Opened, Shape, marks};
use super::palette::{Palette, Table};
use super::plot::plot;
use super::subject::{Motion, Subject};
use super::svg;
use super::tone::{Covered, Tone};
use weald_core::error::{Error, Limit, Quantity};
use weald_core::parameter::{Colour, Sides};
use weald_plants::ifs::Ifs;

weald_core::choices! {
    /// What of a fractal is drawn.
    pub enum Draw {
        /// The density of millions of points, as light.
        Density = "density",
        /// A sharp dot for each part.
        Dots = "dots",
        /// The sharp outline of each part.
        Parts = "parts",
    }
}

weald_core::choices! {
    /// What a fractal is drawn on.
    pub enum Background {
        /// White.
        White = "white",
        /// Warm paper.
        Paper = "paper",
        /// Nearly black.
        Dark = "dark",
        /// Nothing: the picture has an alpha channel.
        Transparent = "transparent",
    }
}

impl Background {
    /// Its colour; `None` where there is none.
    pub fn colour(self) -> Option<Linear> {
        match self {
            Self::White => Some([1.0; 3]),
            Self::Paper => Some(linear_of_hex(0xf4_efe3)),
            Self::Dark => Some(linear_of_hex(0x07_0b0a)),
            Self::Transparent => None,
        }
    }
}

weald_core::parameters! {
    /// How a fractal is drawn.
    pub struct Look {
        /// What is drawn: the density of the points, or dots or outlines of the parts. In a .svg `density` is drawn as
        /// `parts`.
        draw: Draw = Draw::Density;
        /// Pixels a side, or [width, height]. By default 1024 on the longer side, in the proportions of the shape.
        size: Option<Sides> = None;
        /// Room around the shape, as a share of the shorter side.
        margin: f64 = 0.05, range 0.0..=0.45;
        /// Points for each pixel. By default 100, and 24 for each frame of a film.
        samples: Option<f64> = None, range 0.01..=100_000.0, when draw = "density",
            for "png" | "apng" | "mp4" | "webm";
        /// Supersampling: histogram bins along the side of a pixel, each with its own density.
        supersample: u32 = 2, range 1..=8, when draw = "density",
            for "png" | "apng" | "mp4" | "webm";
        /// Radius of the Gaussian reconstruction filter, which makes pixels of the bins.
        filter: f64 = 0.5, range 0.0..=8.0, unit "px", when draw = "density",
            for "png" | "apng" | "mp4" | "webm";
        /// What the colours tell: the code of a point, its largest part, or nothing.
        colour_by: ColourBy = ColourBy::Code, without ink;
        /// Colours from the stem, or the first map, to the last.
        palette: Palette = Palette::Fern, without ink;
        /// One colour for all, in place of a palette.
        ink: Option<Colour> = None;
        /// What lies behind.
        background: Background = Background::White;
        /// Brightness: each 1 more is as if there were twice as many points.
        exposure: f64 = 0.0, range -16.0..=16.0, unit "stops", when draw = "density",
            for "png" | "apng" | "mp4" | "webm";
        /// Exponent that lifts thin parts out of the background.
        gamma: f64 = 4.0, range 0.1..=10.0, when draw = "density",
            for "png" | "apng" | "mp4" | "webm";
        /// Alpha below which gamma is linear, so that single points do not shine.
        gamma_threshold: f64 = 0.01, range 0.0..=1.0, when draw = "density",
            for "png" | "apng" | "mp4" | "webm";
        /// Whether gamma keeps colours saturated (1) or acts on each channel (0).
        vibrancy: f64 = 1.0, range 0.0..=1.0, when draw = "density",
            for "png" | "apng" | "mp4" | "webm";
        /// Recursion depth of dots and parts: the digits of their codes. By default parts are split down to `finest`.
        depth: Option<u32> = None, range 0..=26;
        /// Size of the smallest dots and parts. By default 2 px; in a .svg twice that, four times and so on until the
        /// file fits into 64 MiB.
        finest: Option<f64> = None, range 0.1..=1000.0, unit "px", without depth;
        /// Diameter of a dot. By default `finest`, or 1.5 px with `depth`.
        dot: Option<f64> = None, range 0.05..=1000.0, unit "px", when draw = "dots";
        /// Turn of the camera about the vertical axis (yaw). By default 0 for a 2D fractal, 30 for a 3D one.
        turn_deg: Option<f64> = None, range -36000.0..=36000.0, unit "deg";
        /// Elevation angle of the camera above the horizon (pitch). By default 0 for a 2D fractal, 12 for a 3D one.
        tilt_deg: Option<f64> = None, range -90.0..=90.0, unit "deg";
        /// 0 is orthographic; else the size of the fractal divided by the distance of the camera.
        perspective: f64 = 0.0, range 0.0..=1.0;
    }
}

/// Points per pixel where nobody chooses: of a picture, and of a frame of a film.
const DEFAULT_SAMPLES: [f64; 2] = [100.0, 24.0];

/// Size of the smallest parts in pixels where nobody chooses, and how often a .svg may double it.
const DEFAULT_FINEST: f64 = 2.0;
const COARSER_SVG: u32 = 6;

/// Turn and tilt of the camera where nobody chooses, for a 3D fractal.
const DEFAULT_VIEW_DEG: [f64; 2] = [30.0, 12.0];

/// What all frames of a film share, so that it neither jumps nor flickers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// What they show.
    pub frame: Frame,
    /// Share of the points beside a usual one, from the first of them; `None` takes that of each picture.
    pub usual_share: Option<f64>,
    /// Points per pixel where the look does not say.
    pub usual_samples: f64,
}

impl Setting {
    /// Of one picture.
    ///
    /// # Errors
    /// [`Error::Limit`] for a picture too large.
    pub fn of_still(look: &Look, extent: &Extent) -> Result<Self, Error> {
        let frame = Frame::around(extent, look.size, look.margin)?;
        Ok(Self { frame, usual_share: None, usual_samples: DEFAULT_SAMPLES[0] })
    }

    /// Of a film that begins with `first` and fills `extent`.
    ///
    /// # Errors
    /// As [`Look::count`], and [`Error::Limit`] for a picture too large.
    pub fn of_film(look: &Look, first: &Subject<'_>, extent: &Extent) -> Result<Self, Error> {
        let still = Self { usual_samples: DEFAULT_SAMPLES[1], ..Self::of_still(look, extent)? };
        if look.draw != Draw::Density {
            return Ok(still);
        }
        let density = look.count(first, &still, &mut |_, _| Ok(()))?;
        Ok(Self { usual_share: Some(density.usual_share()), ..still })
    }
}

impl Look {
    /// A fractal as it is looked at, after `share` of a turn around it.
    pub fn subject<'a>(
        &self,
        ifs: &'a Ifs,
        motion: Option<&'a dyn Motion>,
        seed: u64,
        share: f64,
    ) -> Subject<'a> {
        let usual = if ifs.is_planar() { [0.0; 2] } else { DEFAULT_VIEW_DEG };
        let turn = self.turn_deg.unwrap_or(usual[0]) + 360.0 * share;
        let tilt = self.tilt_deg.unwrap_or(usual[1]);
        let [low, high] = ifs.bounds();
        let middle = std::array::from_fn(|axis| 0.5 * (low[axis] + high[axis]));
        let camera = Camera::new(middle, turn, tilt, [self.perspective, ifs.diameter()]);
        let frontal = ifs.is_planar() && turn == 0.0 && tilt == 0.0;
        Subject { ifs, motion, camera, frontal, seed }
    }

    /// The picture. `watch` is called with how many points are done, of how many, and may end it.
    ///
    /// # Errors
    /// [`Error::Limit`] where memory or marks are beyond their limits, and those of `watch`.
    pub fn draw(
        &self,
        subject: &Subject<'_>,
        setting: &Setting,
        watch: &mut Watch<'_>,
    ) -> Result<Cutout, Error> {
        let pixels = match self.shape() {
            None => {
                let density = self.count(subject, setting, watch)?;
                let usual_share = setting.usual_share.unwrap_or_else(|| density.usual_share());
                self.tone().develop(&density, self.supersample as usize, usual_share)
            }
            Some(shape) => {
                let marks = self.marks(subject, &setting.frame, shape)?;
                plot(&marks, shape, &setting.frame, &self.table())?
            }
        };
        Ok(self.laid(&pixels, &setting.frame))
    }

    /// The picture as vectors, of dots or parts; parts where the look is of a density. Where neither `finest` nor `depth`
    /// is given, parts are as fine as the limits allow, from 2 px in doublings.
    ///
    /// # Errors
    /// [`Error::Limit`] where marks or the file are beyond their limits.
    pub fn svg(&self, subject: &Subject<'_>, setting: &Setting) -> Result<String, Error> {
        let first = self.vectors(subject, setting);
        if self.finest.is_some() || self.depth.is_some() {
            return first;
        }
        let mut coarser = (1..=COARSER_SVG).map(|doublings| DEFAULT_FINEST * f64::from(1_u32 << doublings));
        let mut found = first;
        while let (Err(Error::Limit(_)), Some(finest)) = (&found, coarser.next()) {
            found = Self { finest: Some(finest), ..self.clone() }.vectors(subject, setting);
        }
        found
    }

    fn vectors(&self, subject: &Subject<'_>, setting: &Setting) -> Result<String, Error> {
        let shape = self.shape().unwrap_or(Shape::Outline);
        let marks = self.marks(subject, &setting.frame, shape)?;
        let file = svg::svg(&marks, shape, &setting.frame, &self.table(), self.background.colour());
        file.map_err(|excess| {
            // The number of parts falls at least as fast as their size grows.
            let remedy = match self.depth {
                Some(depth) => format!("choose a smaller `depth` than {depth}"),
                None => format!("choose a larger `finest`, such as {}", (self.finest() * excess).ceil()),
            };
            let limit = Limit::new(Quantity::FileBytes, None, 0..=svg::MAX_BYTES as u64);
            limit.of(format!("a .svg of {} parts", marks.len())).remedy(format!("{remedy}, or a .png")).into()
        })
    }

    /// The points of the picture, counted.
    ///
    /// # Errors
    /// As [`Look::draw`].
    pub fn count(
        &self,
        subject: &Subject<'_>,
        setting: &Setting,
        watch: &mut Watch<'_>,
    ) -> Result<Density, Error> {
        let sampling = Sampling {
            samples: self.samples.unwrap_or(setting.usual_samples),
            supersample: self.supersample as usize,
        };
        let colours = (self.colouring(subject.ifs), &*self.table().whole_numbers());
        Density::count(subject, colours, &setting.frame, sampling, watch)
    }

    fn finest(&self) -> f64 {
        self.finest.unwrap_or(DEFAULT_FINEST)
    }

    fn shape(&self) -> Option<Shape> {
        let usual = if self.depth.is_some() { 1.5 } else { self.finest() };
        match self.draw {
            Draw::Density => None,
            Draw::Dots => Some(Shape::Dot(self.dot.unwrap_or(usual))),
            Draw::Parts => Some(Shape::Outline),
        }
    }

    fn marks(&self, subject: &Subject<'_>, frame: &Frame, shape: Shape) -> Result<Vec<Mark>, Error> {
        let opened = match self.depth {
            Some(depth) => Opened::ToDepth(depth as usize),
            None => Opened::ToPixels(self.finest()),
        };
        marks(subject, &self.colouring(subject.ifs), frame, opened, shape)
    }

    fn colouring(&self, ifs: &Ifs) -> Colouring {
        Colouring::new(ifs, self.colour_by)
    }

    fn table(&self) -> Table {
        let ink = self.ink.map(|colour| linear_of_srgb(colour.0));
        Table::new(self.palette, ink, self.background.colour().unwrap_or(linear_of_hex(0x80_8a86)))
    }

    fn tone(&self) -> Tone {
        Tone {
            exposure: self.exposure,
            gamma: self.gamma,
            threshold: self.gamma_threshold,
            vibrancy: self.vibrancy,
            filter: self.filter,
        }
    }

    /// Light on its background.
    fn laid(&self, pixels: &[Covered], frame: &Frame) -> Cutout {
        match self.background.colour() {
            Some(colour) => Cutout::on(frame.width, pixels, encode(colour)),
            None => Cutout::see_through(frame.width, pixels),
        }
    }
}

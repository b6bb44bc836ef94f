//! Pictures of a landscape, one file a kind; [`PICTURES`] is the registry.

mod albedo;
mod apng;
mod automatic;
mod colour;
mod contours;
mod cut;
mod cutout;
mod digits;
mod drainage;
mod font;
pub mod fractal;
mod ground;
mod growth;
mod image;
mod lakes;
mod legend;
mod light;
mod map;
mod materials;
mod paint;
mod ramp;
mod relief;
mod render;
mod rivers;
mod scene;
mod section;
mod sheet;
mod spline;
mod strokes;
mod texture;
mod ticks;
mod view;

pub use albedo::tinted;
pub use apng::write_apng;
pub use colour::{Linear, Oklab, encode, linear_of_hex, linear_of_srgb};
pub use cutout::Cutout;
pub use font::{Pen, blend};
pub use growth::{Growth, GrowthKeys};
pub use image::Image;
pub use map::Map;
pub use materials::Materials;
pub use ramp::{Ramp, Scale, Tint};
pub use relief::Relief;
pub use render::{
    Flight, Frame, GrassRate, RayMarched, Reel, Render, RenderDevice, RenderKeys, RenderScene, Rendering,
};
pub use section::{Along, Section};
pub use strokes::{Point as StrokePoint, Strokes};
pub use view::albedo;
pub use view::{Camera, Follow, GroundColour, MapKind, Rim, Stage, StageMap, View};

use std::fmt::Debug;

use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Complaints, Parameter, Parameters};
use weald_core::source::Table;

/// Warm white: the sheet where there is no data.
pub const PAPER: Linear = [0.923, 0.896, 0.830];

/// A kind of picture with its parameters, checked and ready to draw.
pub trait Picture: Debug + Send + Sync {
    /// Names of the layers it needs.
    fn reads(&self) -> Vec<String>;

    /// Names of the layers it draws where they exist.
    fn optional(&self) -> Vec<String> {
        Vec::new()
    }

    /// Names of the fractals it draws.
    fn fractals(&self) -> Vec<String> {
        Vec::new()
    }

    /// The same picture at a share, 0 to 1, of a film of so many seconds: from a camera that has gone that share of a
    /// turn around the landscape, clockwise from above, or in the wind of that moment; `None` for a picture that does
    /// not move.
    fn turned(&self, share: f64, seconds: f64) -> Option<Box<dyn Picture>> {
        let _ = (share, seconds);
        None
    }

    /// The view that this picture is, for those that have a stage which a renderer on a device can draw.
    fn as_view(&self) -> Option<&View> {
        None
    }

    /// What of it a device draws; `None` for a picture that the processor draws.
    fn as_render(&self) -> Option<&Render> {
        None
    }

    /// Draws a landscape that has all the layers in [`Picture::reads`].
    ///
    /// # Errors
    /// [`Error::Limit`] where the picture would be too large, [`Error::Run`] where a layer is missing.
    fn render(&self, landscape: &Landscape) -> Result<Image, Error>;

    /// The same with a background that may show through. `watch` hears how far the drawing is and may end it.
    ///
    /// # Errors
    /// As [`Picture::render`], and those of `watch`.
    fn cutout(&self, landscape: &Landscape, watch: &mut Watch<'_>) -> Result<Cutout, Error> {
        let _ = watch;
        self.render(landscape).map(Cutout::from)
    }

    /// The picture as vectors, for those whose [`PictureEntry::extensions`] have `svg`.
    ///
    /// # Errors
    /// As [`Picture::render`].
    fn svg(&self, landscape: &Landscape) -> Result<String, Error> {
        let _ = landscape;
        Err(Error::Run("this picture has no vectors; choose a .png".to_owned()))
    }
}

/// Hears how much of a drawing is done, of how much, and says whether to go on.
pub type Watch<'a> = dyn FnMut(u64, u64) -> Result<(), Error> + 'a;

/// A picture's declaration in the registry.
#[derive(Clone, Copy, Debug)]
pub struct PictureEntry {
    /// Word after `picture =`.
    pub name: &'static str,
    /// What it shows, in one sentence.
    pub summary: &'static str,
    /// The publication, or "Weald" for what is common practice.
    pub source: &'static str,
    /// Extensions of a still in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Declares the parameters.
    pub parameters: fn() -> Vec<Parameter>,
    /// Reads them from an `[[output]]` table without its `picture` and `file`.
    pub read: fn(&Table, &mut Complaints) -> Box<dyn Picture>,
}

impl PictureEntry {
    /// The declaration of picture type `T`.
    pub const fn of<T: Picture + Parameters + 'static>(
        name: &'static str,
        summary: &'static str,
        source: &'static str,
    ) -> Self {
        let read = |table: &Table, complaints: &mut Complaints| -> Box<dyn Picture> {
            Box::new(T::read(table, complaints))
        };
        Self { name, summary, source, extensions: &["png"], parameters: T::parameters, read }
    }

    /// The same with other extensions.
    const fn into_files(self, extensions: &'static [&'static str]) -> Self {
        Self { extensions, ..self }
    }
}

/// All kinds of pictures. Adding one is one file and one line here.
pub const PICTURES: &[PictureEntry] = &[
    PictureEntry::of::<Relief>(
        "relief",
        "shaded relief with height tints, contours, lakes and rivers",
        "Mark 1992 (lights), Brown 2010 (texture shading), Imhof 1965 (colours and aerial perspective)",
    ),
    PictureEntry::of::<Materials>(
        "materials",
        "shaded relief in the colours of the materials at the surface, with lakes and rivers",
        "Weald; lights and shading as in a relief picture",
    ),
    PictureEntry::of::<Section>(
        "section",
        "the ground cut open along a row or a column, with its layers and the water on it",
        "Weald",
    ),
    PictureEntry::of::<View>(
        "view",
        "a perspective view with sun, sky, haze and water",
        "Tevs 2008 (rays), Hillaire 2020 (sky), Max 1988 (horizons), Koschmieder 1924 (haze)",
    ),
    PictureEntry::of::<Render>(
        "render",
        "the same view drawn on the graphics device, with grass blade by blade and plants",
        "Strugar 2009 (levels of detail), Kim and Cho 2010 (grass), Hillaire 2020 (sky)",
    ),
    PictureEntry::of::<Growth>(
        "fractal",
        "a plant or set of an iterated function system: the density of its points, or its parts",
        "Draves and Reckase 2003 (light), Barnsley 1988 (points), Han and Kim 2007 (deformations)",
    )
    .into_files(&["png", "svg"]),
    PictureEntry::of::<Map>("map", "one layer in an even colour ramp, linear or logarithmic", "Weald"),
];

/// The picture of that name.
pub fn find(name: &str) -> Option<&'static PictureEntry> {
    PICTURES.iter().find(|entry| entry.name == name)
}

//! All kinds of pictures, by their names.

use super::{Growth, Map, Materials, PictureEntry, Relief, Render, Section, View};

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
        "a perspective view with sun, sky, haze and water, ray-marched on the CPU",
        "Tevs 2008 (rays), Hillaire 2020 (sky), Max 1988 (horizons), Koschmieder 1924 (haze)",
    ),
    PictureEntry::of::<Render>(
        "render",
        "the perspective view rasterised on the GPU, with grass blade by blade and plants",
        "Strugar 2009 (levels of detail), Kim and Cho 2010 (grass), Hillaire 2020 (sky)",
    ),
    PictureEntry::of::<Growth>(
        "fractal",
        "a fractal plant or figure (an iterated function system): the density of its points, or its parts",
        "Draves and Reckase 2003 (light), Barnsley 1988 (points), Han and Kim 2007 (deformations)",
    )
    .into_files(&["png", "svg"]),
    PictureEntry::of::<Map>("map", "one layer in an even colour ramp, linear or logarithmic", "Weald"),
];

/// The picture of that name.
pub fn find(name: &str) -> Option<&'static PictureEntry> {
    PICTURES.iter().find(|entry| entry.name == name)
}

//! Pictures of fractals side by side, at one scale, and points to measure.

use crate::figures::GalleryJob;
use weald_core::error::Error;
use weald_core::parameter::Sides;
use weald_picture::Image;
use weald_picture::fractal::{Extent, Look, Motion, Setting};
use weald_plants::ifs::deform::Frame;
use weald_plants::ifs::map::distance;
use weald_plants::ifs::{Code, Deform, Deformation, Game, Ifs, Point, shapes};

/// Room between pictures, in pixels.
const GAP: usize = 8;

/// Seed of the points that are measured.
const SEED: u64 = 7;

/// The two shapes of the source, in the unit square in which it states its fields.
pub(super) fn shape(name: &str) -> Ifs {
    let ifs = shapes::find(name).expect("a built-in shape").ifs();
    if name == "fern" { ifs.in_units(Frame::FERN.scale, [0.5, 0.0, 0.0]) } else { ifs }
}

/// Deformations that are legal, as those of the figures are.
pub(super) fn deformation(ifs: &Ifs, deforms: Vec<Deform>) -> Result<Deformation<'_>, Error> {
    Deformation::new(ifs, deforms).map_err(|faults| Error::Run(faults.join("; ")))
}

/// A panel: its title, and what moves its points.
pub(super) struct Panel<'a> {
    pub(super) title: &'a str,
    pub(super) motion: Option<&'a dyn Motion>,
}

/// Panels of one shape in one frame that holds them all, side by side.
pub(super) fn row(ifs: &Ifs, look: &Look, panels: &[Panel<'_>], job: GalleryJob) -> Result<Image, Error> {
    let look = sized(look, job);
    let seen = |panel: &Panel<'_>| Extent::of(&look.subject(ifs, panel.motion, SEED, 0.0));
    let extent = panels.iter().map(seen).reduce(Extent::with).unwrap_or(Extent::NONE);
    let setting = Setting::of_still(&look, &extent)?;
    let images = panels.iter().map(|panel| {
        let subject = look.subject(ifs, panel.motion, SEED, 0.0);
        let drawn = look.draw(&subject, &setting, &mut |_, _| Ok(()))?;
        Ok(drawn.image.titled(panel.title))
    });
    Ok(Image::beside(&images.collect::<Result<Vec<_>, Error>>()?, GAP))
}

/// Rows above each other.
pub(super) fn rows(images: &[Image]) -> Image {
    Image::below(images, GAP)
}

fn sized(look: &Look, job: GalleryJob) -> Look {
    let [side, samples] = job.choose([480.0, 14.0], [48.0, 2.0]);
    Look {
        size: Some(Sides { columns: side as u64, rows: side as u64 }),
        samples: look.samples.or(Some(samples)),
        ..look.clone()
    }
}

/// Points of a shape with their codes.
pub(super) fn points(ifs: &Ifs, job: GalleryJob) -> Vec<(Point, Code)> {
    let mut points = Vec::new();
    Game::new(ifs, SEED).points(job.choose(100_000, 2_000), |block| {
        points.extend((0..block.len()).map(|number| {
            let code = block.code(number, ifs);
            // The point that the code stands for, not the single-precision one that the game met.
            (ifs.point(&code), code)
        }));
    });
    points
}

/// The longest way from where points are to where they go.
pub(super) fn longest(points: &[(Point, Code)], to: impl Fn(Point, &Code) -> Point) -> f64 {
    points.iter().map(|(point, code)| distance(*point, to(*point, code))).fold(0.0, f64::max)
}

/// The longest way between where two codes of one point of the gasket go, `[0,1,1,…]` and `[1,0,0,…]`: 0 where a
/// deformation does not tear.
pub(super) fn tear(gasket: &Ifs, deformation: &Deformation<'_>) -> f64 {
    let code = |first: u8, rest: u8| {
        let digits: Vec<u8> = std::iter::once(first).chain([rest; 23]).collect();
        Code::of(gasket.digits(), &digits).expect("24 digits fit")
    };
    let to = |code: Code| deformation.apply(gasket.point(&code), &code);
    distance(to(code(0, 1)), to(code(1, 0)))
}

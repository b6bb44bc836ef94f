//! The colours of the ground without light and shade, as a renderer wants them.

use rayon::prelude::*;

use super::Image;
use super::automatic;
use super::colour::encode;
use super::ground::{drawable, land_share};
use super::paint::Paint;
use super::ramp::Tint;
use super::sheet::Sheet;
use super::spline::{Spline, SplineRow};
use crate::error::Error;
use crate::landscape::Landscape;

/// Thickness in metres at which a material hides half of what it lies on, as in a picture of materials.
const THINNEST: f32 = 0.05;

/// What the ground is painted with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pigment {
    /// Colours by height.
    Tints(Tint),
    /// Colours of the materials at the surface.
    Materials,
}

/// Colours of the layer `of` on a sheet over all cells to their outer edges, `width` pixels wide or as suits the
/// grid. Cells without data have colours of the nearest land.
///
/// # Errors
/// [`Error::Limit`] where the sheet would be too large, [`Error::Run`] for a layer that is missing.
pub(crate) fn albedo(
    landscape: &Landscape,
    of: &str,
    pigment: Pigment,
    width: Option<u32>,
) -> Result<Image, Error> {
    let sheet = Sheet::new(&landscape.domain, width)?;
    let land = landscape.domain.land.as_ref();
    let ground = landscape.field(of)?;
    let height = drawable(ground, land, &sheet);
    let paint = match pigment {
        Pigment::Tints(tint) => Paint::Tints(tint.ramp()),
        Pigment::Materials => Paint::of_materials(landscape, ground, THINNEST, &sheet)?,
    };
    let [low, high] = automatic::tint_range(&height, land_share(land, &sheet).as_ref(), None);
    let spline = Spline::new(&sheet, height.size().columns, height.size().rows);
    let mut rgb = vec![0; 3 * sheet.width * sheet.height];
    let rows = <(SplineRow, [SplineRow; 3])>::default;
    rgb.par_chunks_mut(3 * sheet.width).enumerate().for_each_init(rows, |(heights, paints), (y, out)| {
        spline.row(&height, y, heights);
        paint.evaluate(&spline, y, paints);
        for (x, pixel) in out.chunks_exact_mut(3).enumerate() {
            let share = ((heights.value[x] - low) / (high - low)).clamp(0.0, 1.0);
            pixel.copy_from_slice(&encode(paint.at(x, share, paints)));
        }
    });
    Ok(Image { width: sheet.width, height: sheet.height, rgb })
}

//! Colours by height without light and shade, as a renderer wants them.

use rayon::prelude::*;

use super::Image;
use super::automatic;
use super::colour::encode;
use super::ground::{drawable, land_share};
use super::ramp::Tint;
use super::sheet::Sheet;
use super::spline::{Spline, SplineRow};
use weald_core::error::Error;
use weald_core::landscape::Landscape;

/// Tints of the layer `of` on a sheet over all cells to their outer edges, `width` pixels wide or as suits the grid.
/// Cells without data have tints of the nearest land.
///
/// # Errors
/// [`Error::Limit`] where the sheet would be too large, [`Error::Run`] for a layer that is missing.
pub fn tinted(landscape: &Landscape, of: &str, tint: Tint, width: Option<u32>) -> Result<Image, Error> {
    let sheet = Sheet::new(&landscape.domain, width)?;
    let land = landscape.domain.valid.as_ref();
    let height = drawable(landscape.field(of)?, land, &sheet);
    let [low, high] = automatic::tint_range(&height, land_share(land, &sheet).as_ref(), None);
    let spline = Spline::new(&sheet, height.size().columns, height.size().rows);
    let ramp = tint.ramp();
    let mut rgb = vec![0; 3 * sheet.width * sheet.height];
    rgb.par_chunks_mut(3 * sheet.width).enumerate().for_each_init(SplineRow::default, |row, (y, out)| {
        spline.row(&height, y, row);
        for (x, pixel) in out.chunks_exact_mut(3).enumerate() {
            let share = (row.value[x] - low) / (high - low);
            pixel.copy_from_slice(&encode(ramp.at(share)));
        }
    });
    Ok(Image { width: sheet.width, height: sheet.height, rgb })
}

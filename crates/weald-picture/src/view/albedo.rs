//! The colours of a view's ground without light and shade, seen from straight above, as a renderer wants them.

use rayon::prelude::*;

use super::cover::Cover;
use super::ground_kinds::{SurfacePoint, UPRIGHT, bed_of};
use super::keys::View;
use super::setting::{GroundOf, Setting};
use crate::Image;
use crate::colour::{Linear, encode, linear_of_hex, mix};
use crate::sheet::Sheet;
use weald_core::error::Error;
use weald_core::landscape::Landscape;

/// Rivers that are too narrow for a surface of their own.
const RIVER: u32 = 0x2c_4f57;

/// A sun that throws no shadows.
const OVERHEAD: [f32; 3] = [0.0, 0.0, 1.0];

/// The ground that a view shows, on a sheet over all cells to their outer edges, `width` pixels wide or as suits the
/// grid. The beds of lakes are gravel. Cells without data have colours of the nearest land.
///
/// # Errors
/// [`Error::Limit`] where the sheet would be too large, [`Error::Run`] for a layer that is missing.
pub fn albedo(view: &View, landscape: &Landscape, width: Option<u32>) -> Result<Image, Error> {
    let sheet = Sheet::new(&landscape.domain, width)?;
    let (setting, sites) = Setting::new(view, landscape, GroundOf::default())?;
    let river = linear_of_hex(RIVER);
    let above = TopView { cover: Cover::new(sites, &setting, OVERHEAD), setting, sheet, river };
    let mut rgb = vec![0; 3 * sheet.width * sheet.height];
    rgb.par_chunks_mut(3 * sheet.width).enumerate().for_each(|(y, row)| {
        for (x, pixel) in row.chunks_exact_mut(3).enumerate() {
            pixel.copy_from_slice(&encode(above.colour(x, y)));
        }
    });
    Ok(Image { width: sheet.width, height: sheet.height, rgb })
}

/// A landscape from above.
struct TopView {
    setting: Setting,
    cover: Cover,
    sheet: Sheet,
    /// Colour of rivers.
    river: Linear,
}

impl TopView {
    fn colour(&self, x: usize, y: usize) -> Linear {
        let share = [(x as f32 + 0.5) / self.sheet.width as f32, (y as f32 + 0.5) / self.sheet.height as f32];
        let size = self.setting.bed.size();
        let place = [0.5 + share[0] * size.columns as f32, 0.5 + share[1] * size.rows as f32];
        let [height, east, south] = self.setting.bed.with_slope(place);
        let above = self.setting.level.as_ref().map_or(f32::INFINITY, |level| height - level.at(place));
        if above < 0.0 {
            return self.cover.gravel();
        }
        let ground = self.cover.at(&self.spot(place, [height, above], [east, south])).albedo;
        let river = self.setting.rivers.as_ref().map_or(0.0, |rivers| rivers.at(share));
        mix(ground, self.river, river)
    }

    fn spot(&self, place: [f32; 2], [height, above]: [f32; 2], rise: [f32; 2]) -> SurfacePoint {
        let terrain = &self.setting.terrain;
        let normal = terrain.normal(rise);
        let run = (normal[0] * normal[0] + normal[1] * normal[1]).sqrt();
        SurfacePoint {
            place,
            point: terrain.point(place, height),
            slope: run / normal[2].max(1e-3),
            fall: [normal[0], normal[1]].map(|part| part / run.max(1e-6)),
            footprint: self.sheet.metres_per_pixel as f32,
            sight: UPRIGHT,
            above: above / self.setting.exaggeration,
            beach: 0.0,
            bed: bed_of([height, rise[0], rise[1]], 1.0),
        }
    }
}

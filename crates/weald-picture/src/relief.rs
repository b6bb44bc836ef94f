//! Shaded relief: height tints lit by several lights, texture shading, aerial perspective, contours, lakes and
//! rivers.
//!
//! The surface is a cubic B-spline on a sheet at least as fine as the grid; colours are mixed in linear light.
//! Aerial perspective after Eduard Imhof, "Kartographische Geländedarstellung" (1965): contrast grows with
//! height, and valleys lie in a light haze.

use rayon::prelude::*;

use super::automatic;
use super::colour::encode;
use super::ground::{drawable, land_share};
use super::paint::Paint;
use super::ramp::Tint;
use super::scene::{Scene, Shading};
use super::sheet::Sheet;
use super::spline::{Spline, SplineRow};
use super::{Image, Picture};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;

weald_core::parameters! {
    /// A shaded relief picture.
    pub struct Relief {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Width of the picture. By default the longer side has one pixel a cell, but 1024 at least and 4096 at most.
        width: Option<u32> = None, range 16..=16384, unit "px";
        /// Colours of heights.
        ramp: Tint = Tint::Hypsometric;
        /// Where the light comes from, clockwise from north. Maps are lit from the north-west: lit from below,
        /// hills look like hollows.
        sun_azimuth_deg: f64 = 315.0, range 0.0..=360.0, unit "deg";
        /// Height of the sun above the horizon.
        sun_altitude_deg: f64 = 45.0, range 5.0..=90.0, unit "deg";
        /// Factor on heights before they are lit. By default the one with which the slope that one cell in ten
        /// exceeds becomes 45° (the steepest, where nine cells in ten are level), within 0.02 to 50.
        exaggeration: Option<f64> = None, range 0.01..=1000.0;
        /// Height between contours; 0 draws none. By default a step of the series 1, 2, 5 that gives about
        /// fourteen intervals.
        contours: Option<f64> = None, range 0.0..=100_000.0, unit "m";
        /// Whether lakes (layer `water`) and rivers (layers `flux_x`, `flux_y`) are drawn where they exist.
        water: bool = true;
        /// Depth of water from which its surface is drawn. By default three tenths of a cell's side: what is
        /// shallower is overland flow.
        shallowest: Option<f64> = None, range 1.0e-6..=1.0e4, unit "m", when water = true;
        /// Least upslope area of a river that is drawn. By default that of 40 cells, and a nine-hundredth of the grid.
        least_area: Option<f64> = None, range 0.0..=1.0e15, unit "m²", when water = true;
    }
}

impl Picture for Relief {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn optional(&self) -> Vec<String> {
        if self.water { ["water", "flux_x", "flux_y"].map(str::to_owned).to_vec() } else { Vec::new() }
    }

    fn working_bytes(&self, cells: u64) -> u64 {
        16 * cells
    }

    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        Sheet::new(domain, self.width).map(drop)
    }

    fn render(&self, landscape: &Landscape) -> Result<Image, Error> {
        let sheet = Sheet::new(&landscape.domain, self.width)?;
        let paint = Paint::Tints(self.ramp.ramp());
        Ok(Scene::new(&self.shading(), landscape, sheet, paint)?.draw())
    }
}

impl Relief {
    /// All but the size and the colours.
    pub(super) fn shading(&self) -> Shading<'_> {
        Shading {
            of: &self.of.0,
            sun_azimuth_deg: self.sun_azimuth_deg,
            sun_altitude_deg: self.sun_altitude_deg,
            exaggeration: self.exaggeration,
            contours: self.contours,
            water: self.water,
            shallowest: self.shallowest,
            least_area: self.least_area,
        }
    }
}

/// Colours by height without light and shade, as a renderer wants them: tints of the layer `of` on a sheet over all cells to their outer edges, `width` pixels wide or as suits the grid.
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

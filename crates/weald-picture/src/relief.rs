//! Shaded relief: height tints lit by several lights, texture shading, aerial perspective, contours, lakes and
//! rivers.
//!
//! The surface is a cubic B-spline on a sheet at least as fine as the grid; colours are mixed in linear light.
//! Aerial perspective after Eduard Imhof, "Kartographische Geländedarstellung" (1965): contrast grows with
//! height, and valleys lie in a light haze.

use super::paint::Paint;
use super::ramp::Tint;
use super::scene::{Scene, Shading};
use super::sheet::Sheet;
use super::{Image, Picture};
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
    }
}

impl Picture for Relief {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn optional(&self) -> Vec<String> {
        if self.water { ["water", "flux_x", "flux_y"].map(str::to_owned).to_vec() } else { Vec::new() }
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
        }
    }
}

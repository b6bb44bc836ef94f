//! Shaded relief in the colours of the materials at the surface, with lakes and rivers.
//!
//! Drawn as [`Relief`], with the colour of each cell's materials in place of height tints: thin covers let
//! what they lie on shine through, and strata that crop out on slopes show as bands.

use super::colour::linear_of_srgb;
use super::legend::{Key, Legend};
use super::paint::Paint;
use super::scene::Scene;
use super::sheet::Sheet;
use super::{Image, Picture, Relief};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;

weald_core::parameters! {
    /// A map of materials.
    pub struct Materials {
        /// Layer of heights in metres, under which the materials lie.
        of: LayerName = LayerName::of("height");
        /// Width of the picture. By default the longer side has one pixel a cell, but 1024 at least and 4096 at most.
        width: Option<u32> = None, range 16..=16384, unit "px";
        /// Thickness at which a material hides half of what it lies on.
        thinnest: f64 = 0.05, range 0.0001..=1000.0, unit "m";
        /// Where the light comes from, clockwise from north.
        sun_azimuth_deg: f64 = 315.0, range 0.0..=360.0, unit "deg";
        /// Height of the sun above the horizon.
        sun_altitude_deg: f64 = 45.0, range 5.0..=90.0, unit "deg";
        /// Factor on heights before they are lit. By default as in a relief picture.
        exaggeration: Option<f64> = None, range 0.01..=1000.0;
        /// Height between contours; 0 draws none, so that the materials alone have lines.
        contours: f64 = 0.0, range 0.0..=100_000.0, unit "m";
        /// Whether lakes (layer `water`) and rivers (layers `flux_x`, `flux_y`) are drawn where they exist.
        water: bool = true;
        /// Depth of water from which its surface is drawn. By default three tenths of a cell's side: what is
        /// shallower is overland flow.
        shallowest: Option<f64> = None, range 1.0e-6..=1.0e4, unit "m", when water = true;
        /// Least upslope area of a river that is drawn. By default that of 40 cells, and a nine-hundredth of the grid.
        least_area: Option<f64> = None, range 0.0..=1.0e15, unit "m²", when water = true;
        /// Whether a strip beside the picture names the materials in their colours and has a scale bar.
        legend: bool = false;
    }
}

impl Picture for Materials {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn optional(&self) -> Vec<String> {
        self.relief().optional()
    }

    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        Sheet::new(domain, self.width).map(drop)
    }

    fn render(&self, landscape: &Landscape) -> Result<Image, Error> {
        let sheet = Sheet::new(&landscape.domain, self.width)?;
        let ground = landscape.field(&self.of.0)?;
        let paint = Paint::of_materials(landscape, ground, self.thinnest as f32, &sheet)?;
        let picture = Scene::new(&self.relief().shading(), landscape, sheet, paint)?.draw();
        if !self.legend {
            return Ok(picture);
        }
        let named = landscape.materials.iter().rev();
        let entries =
            named.map(|material| (material.name.clone(), linear_of_srgb(material.colour))).collect();
        let key = Key::Names(entries);
        Ok(Legend { title: "materials", unit: "1", key, metres_per_pixel: sheet.metres_per_pixel }
            .beside(picture))
    }
}

impl Materials {
    /// All but the colours.
    fn relief(&self) -> Relief {
        Relief {
            of: self.of.clone(),
            width: self.width,
            sun_azimuth_deg: self.sun_azimuth_deg,
            sun_altitude_deg: self.sun_altitude_deg,
            exaggeration: self.exaggeration,
            contours: Some(self.contours),
            water: self.water,
            shallowest: self.shallowest,
            least_area: self.least_area,
            ..Relief::default()
        }
    }
}

//! A map of one layer in an even colour ramp.

use rayon::prelude::*;

use super::colour::{encode, mix};
use super::colour_scale::Drape;
use super::ground::{drawable, land_share};
use super::legend::{Key, Legend};
use super::ramp::{Ramp, Scale};
use super::sheet::Sheet;
use super::spline::{Spline, SplineRow};
use super::{Image, PAPER, Picture};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;

weald_core::parameters! {
    /// A map of the values of one layer.
    pub struct Map {
        /// Layer to draw.
        of: LayerName = LayerName::needed();
        /// Width of the picture. By default the longer side has one pixel a cell, but 1024 at least and 4096 at most.
        width: Option<u32> = None, range 16..=16384, unit "px";
        /// Colours from the lowest to the highest value.
        ramp: Scale = Scale::Meadow;
        /// Whether colours follow the logarithm of the absolute value, as suits discharge.
        logarithmic: bool = false;
        /// Value of the first colour, in the layer's unit; above `high`, colours are reversed. By default the lowest; on a logarithmic map a
        /// ten-thousandth of the highest; with the ramp `balance` as far below 0 as the last is above.
        low: Option<f64> = None;
        /// Value of the last colour, in the layer's unit. By default the highest; with the ramp `balance` the
        /// greatest distance from 0.
        high: Option<f64> = None;
        /// Whether a strip beside the map has its colours with their values, the layer's name and unit, and a
        /// scale bar.
        legend: bool = true;
    }
}

impl Picture for Map {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        Sheet::new(domain, self.width).map(drop)
    }

    fn render(&self, landscape: &Landscape) -> Result<Image, Error> {
        let sheet = Sheet::new(&landscape.domain, self.width)?;
        let land = landscape.domain.valid.as_ref();
        let layer = landscape.layer(&self.of.0)?;
        let scale = self.drape().scale_of(&layer.field, land);
        let shares = drawable(&scale.shares(&layer.field), land, &sheet);
        let ticks = scale.marks();
        let inked = Inked { shares, land: land_share(land, &sheet), ramp: scale.ramp };
        let map = inked.paint(&sheet);
        if !self.legend {
            return Ok(map);
        }
        let legend = Legend {
            title: &self.of.0,
            unit: &layer.unit,
            key: Key::Bar { ramp: inked.ramp, ticks },
            metres_per_pixel: sheet.metres_per_pixel,
        };
        Ok(legend.beside(map))
    }
}

impl Map {
    fn drape(&self) -> Drape {
        let Self { of, ramp, logarithmic, low, high, .. } = self.clone();
        Drape { of, ramp, logarithmic, low, high }
    }
}

/// Places on a ramp, ready to be drawn.
struct Inked {
    shares: Field,
    land: Option<Field>,
    ramp: Ramp,
}

impl Inked {
    fn paint(&self, sheet: &Sheet) -> Image {
        let size = self.shares.size();
        let spline = Spline::new(sheet, size.columns, size.rows);
        let mut rgb = vec![0; 3 * sheet.width * sheet.height];
        let rows = <[SplineRow; 2]>::default;
        rgb.par_chunks_mut(3 * sheet.width).enumerate().for_each_init(rows, |[shares, land], (y, out)| {
            spline.row(&self.shares, y, shares);
            if let Some(field) = &self.land {
                spline.row(field, y, land);
            }
            for (x, pixel) in out.chunks_exact_mut(3).enumerate() {
                let cover = land.value.get(x).map_or(1.0, |share| f32::from(u8::from(*share >= 0.5)));
                pixel.copy_from_slice(&encode(mix(PAPER, self.ramp.at(shares.value[x]), cover)));
            }
        });
        Image { width: sheet.width, height: sheet.height, rgb }
    }
}

//! A map of one layer in an even colour ramp.

use rayon::prelude::*;

use super::colour::{encode, mix};
use super::ground::{drawable, land_share};
use super::legend::{Key, Legend};
use super::ramp::{Ramp, Scale};
use super::sheet::Sheet;
use super::spline::{Spline, SplineRow};
use super::ticks::Ticks;
use super::{Image, PAPER, Picture};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask};
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
        let range = self.range(&layer.field, land);
        let shares = drawable(&self.shares(&layer.field, range), land, &sheet);
        let inked = Inked { shares, land: land_share(land, &sheet), ramp: self.ramp.ramp() };
        let map = inked.paint(&sheet);
        if !self.legend {
            return Ok(map);
        }
        let ticks = if self.logarithmic { Ticks::logarithmic(range) } else { Ticks::linear(range) };
        let legend = Legend {
            title: &self.of.0,
            unit: &layer.unit,
            key: Key::Bar { ramp: inked.ramp, ticks },
            metres_per_pixel: sheet.metres_per_pixel,
        };
        Ok(legend.beside(map))
    }
}

/// Decades below the highest value that a logarithmic map shows.
const LOGARITHMIC_SHARE: f64 = 1e-4;

impl Map {
    /// Places on the ramp, 0 to 1.
    fn shares(&self, field: &Field, [low, high]: [f64; 2]) -> Field {
        let logarithm = |value: f64| libm::log(value.abs().max(f64::MIN_POSITIVE));
        let share = |&value: &f32| {
            let value = f64::from(value);
            let share = if self.logarithmic {
                (logarithm(value) - logarithm(low)) / (logarithm(high) - logarithm(low))
            } else {
                (value - low) / (high - low)
            };
            if share.is_finite() { share.clamp(0.0, 1.0) as f32 } else { 0.0 }
        };
        Field::from_values(field.size(), field.values().par_iter().map(share).collect())
    }

    /// Values of the first and the last colour.
    fn range(&self, field: &Field, land: Option<&Mask>) -> [f64; 2] {
        let (low, high) =
            field.range(land).map_or((0.0, 0.0), |(low, high)| (f64::from(low), f64::from(high)));
        let farthest = low.abs().max(high.abs());
        if self.logarithmic {
            let high = self.high.unwrap_or(farthest);
            return [self.low.unwrap_or(high * LOGARITHMIC_SHARE), high];
        }
        if self.ramp.is_centred() {
            let high = self.high.or(self.low.map(|low| -low)).unwrap_or(farthest);
            return [self.low.unwrap_or(-high), high];
        }
        [self.low.unwrap_or(low), self.high.unwrap_or(high)]
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

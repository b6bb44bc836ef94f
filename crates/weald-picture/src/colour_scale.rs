//! Which colour a value has: a ramp between two values, evenly or by the logarithm.

use rayon::prelude::*;

use super::colour::Linear;
use super::ramp::{Ramp, Scale};
use super::ticks::Ticks;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask};
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;

/// Decades below the highest value that a logarithmic scale shows.
const LOGARITHMIC_SHARE: f64 = 1e-4;

weald_core::parameters! {
    /// A layer whose values are shown as colours of the ground.
    pub struct Drape {
        /// The layer.
        of: LayerName = LayerName::needed();
        /// Colours from the lowest to the highest value.
        ramp: Scale = Scale::Meadow;
        /// Whether colours follow the logarithm of the absolute value, as suits discharge.
        logarithmic: bool = false;
        /// Value of the first colour, in the layer's unit; above `high`, colours are reversed. By default the lowest; on a logarithmic scale a
        /// ten-thousandth of the highest; with the ramp `balance` as far below 0 as the last is above.
        low: Option<f64> = None;
        /// Value of the last colour, in the layer's unit. By default the highest; with the ramp `balance` the
        /// greatest distance from 0.
        high: Option<f64> = None;
    }
}

impl Drape {
    /// A layer in the colours by default.
    pub fn of(layer: &str) -> Self {
        Self { of: LayerName::of(layer), ..Self::default() }
    }

    /// The scale for what the layer holds in a landscape.
    ///
    /// # Errors
    /// [`Error::Run`] for a layer that is missing.
    pub fn scale(&self, landscape: &Landscape) -> Result<ColourScale, Error> {
        let field = landscape.field(&self.of.0)?;
        Ok(self.scale_of(field, landscape.domain.valid.as_ref()))
    }

    pub(super) fn scale_of(&self, field: &Field, land: Option<&Mask>) -> ColourScale {
        ColourScale {
            ramp: self.ramp.ramp(),
            range: self.range(field, land),
            is_logarithmic: self.logarithmic,
        }
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

/// Colours between two values.
#[derive(Clone, Debug)]
pub struct ColourScale {
    /// The colours.
    pub ramp: Ramp,
    /// Values of the first and the last colour.
    pub range: [f64; 2],
    /// Whether colours follow the logarithm of the absolute value.
    pub is_logarithmic: bool,
}

impl ColourScale {
    /// The place of a value on the ramp, 0 to 1; what is no number stands at 0.
    pub fn share(&self, value: f32) -> f32 {
        let logarithm = |value: f64| libm::log(value.abs().max(f64::MIN_POSITIVE));
        let (value, [low, high]) = (f64::from(value), self.range);
        let share = if self.is_logarithmic {
            (logarithm(value) - logarithm(low)) / (logarithm(high) - logarithm(low))
        } else {
            (value - low) / (high - low)
        };
        if share.is_finite() { share.clamp(0.0, 1.0) as f32 } else { 0.0 }
    }

    /// The colour of a value.
    pub fn colour(&self, value: f32) -> Linear {
        self.ramp.at(self.share(value))
    }

    /// Round values along the scale: the place of each, 0 to 1, and how it is written.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        self.marks().0
    }

    pub(super) fn marks(&self) -> Ticks {
        if self.is_logarithmic { Ticks::logarithmic(self.range) } else { Ticks::linear(self.range) }
    }

    /// Places on the ramp of all values.
    pub(super) fn shares(&self, field: &Field) -> Field {
        Field::from_values(field.size(), field.values().par_iter().map(|value| self.share(*value)).collect())
    }
}

//! Where a file came from, as pairs of key and text that GeoTIFF and PNG carry.

use weald_core::layer_words::shown_unit;

/// Where a file came from, written into every format that can carry it.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// Version of Weald.
    pub version: String,
    /// BLAKE3 hash of the recipe, in hexadecimal.
    pub recipe_blake3: String,
    /// Seed of the landscape.
    pub seed: u64,
    /// Layer name.
    pub layer: String,
    /// Unit of the values.
    pub unit: String,
    /// Least and greatest value over the cells with data.
    pub range: (f64, f64),
    /// From which grid to which the values were brought and how, where they were.
    pub resampled: Option<String>,
}

/// Key of the version of Weald.
pub(super) const VERSION: &str = "WEALD_VERSION";
/// Key of the hash of the recipe.
pub(super) const RECIPE: &str = "WEALD_RECIPE_BLAKE3";
/// Key of the seed.
pub(super) const SEED: &str = "WEALD_SEED";
/// Key of the layer's name.
pub(super) const LAYER: &str = "WEALD_LAYER";
/// Key of the unit.
pub(super) const UNIT: &str = "WEALD_UNIT";
/// Key of the least value.
pub(super) const MINIMUM: &str = "WEALD_MINIMUM";
/// Key of what was done to bring the values to another grid.
pub(super) const RESAMPLED: &str = "WEALD_RESAMPLED";
/// Key of the greatest value.
pub(super) const MAXIMUM: &str = "WEALD_MAXIMUM";

impl Provenance {
    /// Keys and texts; numbers are written so that they read back the same.
    pub(super) fn items(&self) -> Vec<(&'static str, String)> {
        let mut items = vec![
            (VERSION, self.version.clone()),
            (RECIPE, self.recipe_blake3.clone()),
            (SEED, self.seed.to_string()),
            (LAYER, self.layer.clone()),
            (UNIT, self.unit.clone()),
            (MINIMUM, format!("{:?}", self.range.0)),
            (MAXIMUM, format!("{:?}", self.range.1)),
        ];
        items.extend(self.resampled.clone().map(|text| (RESAMPLED, text)));
        items
    }

    /// The provenance behind `text_of`, where every key is there and legible.
    pub(super) fn from_items(text_of: impl Fn(&str) -> Option<String>) -> Option<Self> {
        Some(Self {
            version: text_of(VERSION)?,
            recipe_blake3: text_of(RECIPE)?,
            seed: text_of(SEED)?.parse().ok()?,
            layer: text_of(LAYER)?,
            unit: text_of(UNIT)?,
            range: (finite(&text_of(MINIMUM)?)?, finite(&text_of(MAXIMUM)?)?),
            resampled: text_of(RESAMPLED),
        })
    }

    /// The provenance in one sentence.
    pub(super) fn sentence(&self) -> String {
        let Self { version, recipe_blake3, seed, layer, unit, range, .. } = self;
        let unit = match shown_unit(unit) {
            none if none.is_empty() => none,
            unit => format!(" {unit}"),
        };
        let (low, high) = range;
        format!(
            "Weald {version}: layer {layer}, {low} to {high}{unit}, seed {seed}, recipe BLAKE3 {recipe_blake3}"
        )
    }
}

/// A finite number from text.
pub(super) fn finite(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(crate) fn example() -> Provenance {
        Provenance {
            version: "0.1.0".to_owned(),
            recipe_blake3: "af1349b9f5f9a1a6a0404dea36dcc949".to_owned(),
            seed: u64::MAX,
            layer: "water<\"&\">".to_owned(),
            unit: "m³/step".to_owned(),
            range: (-0.1, 1.0e-30),
            resampled: None,
        }
    }

    #[test]
    fn items_read_back_as_the_same_provenance() {
        let items = example().items();
        let text_of = |key: &str| items.iter().find(|(name, _)| *name == key).map(|(_, text)| text.clone());
        assert_eq!(Provenance::from_items(text_of), Some(example()));
    }
}

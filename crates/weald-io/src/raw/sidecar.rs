//! The description beside bare numbers.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::super::{Fault, Provenance, Raster};
use weald_core::domain::Georeference;

/// What follows the whole name of the file in that of its description.
pub(super) const SIDECAR: &str = ".json";

/// What the numbers of a file are, as JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Sidecar {
    pub(super) columns: usize,
    pub(super) rows: usize,
    #[serde(rename = "type")]
    pub(super) kind: Kind,
    #[serde(default)]
    pub(super) byte_order: ByteOrder,
    /// Value, such as metres, of the number 0; with `value_of_65535` for whole numbers alone. Without both,
    /// numbers are values.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) value_of_0: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) value_of_65535: Option<f64>,
    /// The number in cells without data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) no_data: Option<NoData>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) cell_metres: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) place: Option<Georeference>,
    /// Texts by the keys that other formats have them under.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub(super) provenance: BTreeMap<String, String>,
}

/// Type of the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Kind {
    Uint16,
    Float32,
}

impl Kind {
    pub(super) fn bytes(self) -> usize {
        match self {
            Self::Uint16 => 2,
            Self::Float32 => 4,
        }
    }

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Uint16 => "uint16",
            Self::Float32 => "float32",
        }
    }
}

/// Order of the bytes of a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum ByteOrder {
    #[default]
    Little,
    Big,
}

/// What cells without data hold; JSON has no NaN.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub(super) enum NoData {
    Number(f64),
    Word(Word),
}

/// The one word among numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Word {
    NaN,
}

impl Sidecar {
    /// A description of nothing but the size and the type.
    pub(super) fn plain(columns: usize, rows: usize, kind: Kind) -> Self {
        Self {
            columns,
            rows,
            kind,
            byte_order: ByteOrder::Little,
            value_of_0: None,
            value_of_65535: None,
            no_data: None,
            cell_metres: None,
            place: None,
            provenance: BTreeMap::new(),
        }
    }

    /// The description of a raster, but for what its numbers stand for.
    pub(super) fn of(raster: &Raster, kind: Kind) -> Self {
        let size = raster.field.size();
        let items = raster.provenance.iter().flat_map(Provenance::items);
        Self {
            cell_metres: raster.cell,
            place: raster.georeference.clone(),
            provenance: items.map(|(key, text)| (key.to_owned(), text)).collect(),
            ..Self::plain(size.columns, size.rows, kind)
        }
    }

    /// Reads a description.
    pub(super) fn parse(json: &[u8]) -> Result<Self, Fault> {
        let sidecar: Self = serde_json::from_slice(json)
            .map_err(|cause| Fault::damaged(format!("the .json beside it is no description: {cause}")))?;
        sidecar.ensure_legal()?;
        Ok(sidecar)
    }

    fn ensure_legal(&self) -> Result<(), Fault> {
        let damaged = |what: String| Err(Fault::damaged(format!("the .json beside it: {what}")));
        if self.value_of_0.is_some() != self.value_of_65535.is_some() {
            return damaged("`value_of_0` and `value_of_65535` stand together or not at all".to_owned());
        }
        let bounds = [self.value_of_0, self.value_of_65535];
        // One step below the lowest value may lie beyond what a 32-bit float holds.
        if bounds.into_iter().flatten().any(|bound| bound.abs() > 2.0 * f64::from(f32::MAX)) {
            return damaged(format!("a number stands for {bounds:?}, more than 32-bit floats hold"));
        }
        if self.kind == Kind::Float32 && self.value_of_0.is_some() {
            return damaged("floats are values themselves, so `value_of_0` has no meaning".to_owned());
        }
        if let Some(cell) = self.cell_metres.filter(|cell| *cell <= 0.0) {
            return damaged(format!("`cell_metres` is {cell}, but must be above 0"));
        }
        match &self.place {
            Some(place) if place.pixel.iter().any(|side| *side <= 0.0) => {
                damaged(format!("`pixel` is {:?}, but its sides must be above 0", place.pixel))
            }
            _ => Ok(()),
        }
    }

    /// The text of the file.
    pub(super) fn to_json(&self) -> Vec<u8> {
        let mut json = serde_json::to_vec_pretty(self).expect("a description has finite numbers");
        json.push(b'\n');
        json
    }

    /// Value of a step and of the number 0, for whole numbers.
    pub(super) fn scale(&self) -> (f64, f64) {
        match (self.value_of_0, self.value_of_65535) {
            (Some(low), Some(high)) => ((high - low) / 65535.0, low),
            _ => (1.0, 0.0),
        }
    }
}

//! Level ground: the same height everywhere.

use super::Generator;
use crate::domain::Domain;
use crate::error::Error;
use crate::grid::Field;
use crate::parameters;
use crate::recipe::parameter::LayerName;
use crate::step::{Entry, Stage};

/// The step's declaration.
pub const ENTRY: Entry =
    Entry::of::<Constant>("constant", Stage::Generate, "level ground: the same height everywhere", "Weald");

parameters! {
    /// Level ground.
    pub struct Constant {
        /// Height everywhere.
        value: f64 = 0.0, range -1.0e6..=1.0e6, unit "m";
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

impl Generator for Constant {
    fn fill(&self, domain: &Domain, _: u64) -> Result<Field, Error> {
        Ok(Field::filled(domain.size, self.value as f32))
    }

    fn target(&self) -> &LayerName {
        &self.into
    }
}

//! Flat ground: the same height everywhere.

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::generator::Generator;
use weald_engine::step::{Entry, Stage};

/// The step's declaration.
pub const ENTRY: Entry =
    Entry::of::<Constant>("constant", Stage::Generate, "flat ground: the same height everywhere", "Weald");

parameters! {
    /// Flat ground.
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

//! The result of a step.

use weald_core::landscape::Landscape;
use weald_engine::report::StepReport;

/// What a step made of a landscape.
#[derive(Clone, Debug)]
pub(super) struct Kept {
    /// The layers, plants and meadows that it changed; all of them where it changed the grid.
    pub(super) changed: Landscape,
    /// Whether all that it did not change is gone.
    pub(super) whole: bool,
    pub(super) report: StepReport,
}

impl Kept {
    /// Memory that it takes, or nearly so: plants are small beside layers.
    pub(super) fn bytes(&self) -> u64 {
        let layers = self.changed.layers().map(|(_, layer)| size_of_val(layer.field.values()) as u64);
        let plants =
            self.changed.all_plants().map(|(_, plants)| size_of_val(plants.plants.as_slice()) as u64);
        layers.sum::<u64>() + plants.sum::<u64>() + 4096
    }
}

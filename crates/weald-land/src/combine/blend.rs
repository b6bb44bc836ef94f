//! Blends two layers by a mask: `(1 - mask) layer + mask with`. A mask outside 0 to 1 counts as its nearer
//! end.

use super::{store, written};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Blend>("blend", Stage::Combine, "blends two layers by a mask", "Weald");

parameters! {
    /// Blend of two layers.
    pub struct Blend {
        /// Layer that shows where the mask is 0.
        layer: LayerName = LayerName::of("height");
        /// Layer that shows where the mask is 1.
        with: LayerName = LayerName::needed();
        /// The mask, 0 to 1.
        mask: LayerName = LayerName::needed();
        /// Layer that is written. Without it, `layer`.
        into: Option<LayerName> = None;
    }
}

impl Step for Blend {
    fn reads(&self) -> Vec<String> {
        [&self.layer, &self.with, &self.mask].map(|name| name.0.clone()).to_vec()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        written(self.into.as_ref(), &self.layer)
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let [layer, with, mask] = [&self.layer, &self.with, &self.mask].map(|name| landscape.field(&name.0));
        let blended = blended(layer?, with?, mask?);
        store(landscape, &self.layer, self.into.as_ref(), blended)?;
        Ok(Outcome::default())
    }
}

fn blended(layer: &Field, with: &Field, mask: &Field) -> Field {
    let cells = layer.values().iter().zip(with.values()).zip(mask.values());
    let value = |((&a, &b), &mask): ((&f32, &f32), &f32)| {
        let mask = mask.clamp(0.0, 1.0);
        // Both ends are exact, which a + mask (b - a) is not.
        a * (1.0 - mask) + b * mask
    };
    Field::from_values(layer.size(), cells.map(value).collect())
}

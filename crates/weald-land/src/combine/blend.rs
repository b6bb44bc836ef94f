//! Blends two layers by a mask: `(1 - mask) layer + mask with`. A mask outside 0 to 1 counts as its nearer
//! end.

use super::{store, written};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::local::Reach;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Blend>("blend", Stage::Combine, "blends two layers by a mask", "Weald");

parameters! {
    /// Blend of two layers.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size, parameter::LayerName};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::combine::blend::Blend;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(5, 1)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::filled(landscape.domain.size, 100.0));
    /// landscape.insert("hills", "m", Field::filled(landscape.domain.size, 200.0));
    /// landscape.insert("mask", "1", Field::from_function(landscape.domain.size, |x, _| 0.25 * x as f32));
    /// let [with, mask] = ["hills", "mask"].map(LayerName::of);
    /// Blend { with, mask, ..Blend::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.field("height")?.values(), [100.0, 125.0, 150.0, 175.0, 200.0]);
    /// # Ok::<(), Error>(())
    /// ```
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

    fn reach(&self) -> Option<Reach> {
        Some(Reach::default())
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

//! Adds one layer to another: `layer + factor with`. A factor of -1 takes it away.

use super::{map_two, store, written};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::local::Reach;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry =
    Entry::of::<Add>("add", Stage::Combine, "adds a layer, times a factor, to another", "Weald");

parameters! {
    /// Sum of two layers.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size, parameter::LayerName};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::combine::add::Add;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::filled(landscape.domain.size, 100.0));
    /// let quarry = |x, _| if x < 4 { 30.0 } else { 0.0 };
    /// landscape.insert("quarry", "m", Field::from_function(landscape.domain.size, quarry));
    /// Add { with: LayerName::of("quarry"), factor: -1.0, ..Add::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let height = landscape.field("height")?;
    /// assert_eq!((height.at(3, 0), height.at(4, 0)), (70.0, 100.0));
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Add {
        /// Layer that is added to.
        layer: LayerName = LayerName::of("height");
        /// Layer that is added.
        with: LayerName = LayerName::needed();
        /// What `with` is multiplied by first.
        factor: f64 = 1.0, range -1.0e6..=1.0e6;
        /// Layer that is written. Without it, `layer`.
        into: Option<LayerName> = None;
    }
}

impl Step for Add {
    fn reads(&self) -> Vec<String> {
        vec![self.layer.0.clone(), self.with.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        written(self.into.as_ref(), &self.layer)
    }

    fn reach(&self) -> Option<Reach> {
        Some(Reach::default())
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let factor = self.factor as f32;
        let (layer, with) = (landscape.field(&self.layer.0)?, landscape.field(&self.with.0)?);
        let sum = map_two(layer, with, |a, b| a + factor * b);
        store(landscape, &self.layer, self.into.as_ref(), sum)?;
        Ok(Outcome::default())
    }
}

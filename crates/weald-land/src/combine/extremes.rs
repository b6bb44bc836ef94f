//! The higher (`max`) or the lower (`min`) of two layers in every cell.

use super::{map_two, store, written};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::local::Reach;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The declaration of `max`.
pub const MAX: Entry =
    Entry::of::<Max>("max", Stage::Combine, "the higher of two layers in every cell", "Weald");

/// The declaration of `min`.
pub const MIN: Entry =
    Entry::of::<Min>("min", Stage::Combine, "the lower of two layers in every cell", "Weald");

parameters! {
    /// The higher of two layers.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size, parameter::LayerName};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::combine::extremes::Max;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(5, 1)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, |x, _| x as f32));
    /// landscape.insert("level", "m", Field::filled(landscape.domain.size, 2.0));
    /// Max { with: LayerName::of("level"), ..Max::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.field("height")?.values(), [2.0, 2.0, 2.0, 3.0, 4.0]);
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Max {
        /// One layer.
        layer: LayerName = LayerName::of("height");
        /// The other.
        with: LayerName = LayerName::needed();
        /// Layer that is written. Without it, `layer`.
        into: Option<LayerName> = None;
    }
}

parameters! {
    /// The lower of two layers.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size, parameter::LayerName};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::combine::extremes::Min;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(5, 1)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, |x, _| x as f32));
    /// landscape.insert("level", "m", Field::filled(landscape.domain.size, 2.0));
    /// Min { with: LayerName::of("level"), ..Min::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.field("height")?.values(), [0.0, 1.0, 2.0, 2.0, 2.0]);
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Min {
        /// One layer.
        layer: LayerName = LayerName::of("height");
        /// The other.
        with: LayerName = LayerName::needed();
        /// Layer that is written. Without it, `layer`.
        into: Option<LayerName> = None;
    }
}

macro_rules! of_two {
    ($Step:ident, $choose:expr) => {
        impl Step for $Step {
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
                let (layer, with) = (landscape.field(&self.layer.0)?, landscape.field(&self.with.0)?);
                let chosen = map_two(layer, with, $choose);
                store(landscape, &self.layer, self.into.as_ref(), chosen)?;
                Ok(Outcome::default())
            }
        }
    };
}
of_two!(Max, f32::max);
of_two!(Min, f32::min);

//! Cuts slopes into steps: flat ground, then a rise.
//!
//! With `t = v / spacing` and `f` its fraction, the fraction becomes `smooth(1/2 + (f - 1/2) / softness)`,
//! clamped to 0 to 1, `smooth(u) = u² (3 - 2 u)`: the rise takes the middle `softness` of each step. No point
//! moves by more than half a step, and higher stays higher.

use super::{map, store, written};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::local::Reach;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Terrace>("terrace", Stage::Combine, "cuts slopes into steps", "Weald");

parameters! {
    /// Terraces.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::combine::terrace::Terrace;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(5, 1)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, |x, _| 15.0 * x as f32));
    /// Terrace { spacing: 50.0, softness: 0.1, ..Terrace::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.field("height")?.values(), [0.0, 0.0, 50.0, 50.0, 50.0], "0, 15, 30, 45 and 60 m before");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Terrace {
        /// Layer that is read.
        layer: LayerName = LayerName::of("height");
        /// Height from one level to the next; levels are whole multiples of it.
        spacing: f64 = 50.0, range 1.0e-3..=1.0e6, unit "m";
        /// Share of each step that rises: 0 is a cliff, 1 a soft wave.
        softness: f64 = 0.3, range 0.0..=1.0;
        /// Layer that is written. Without it, `layer`.
        into: Option<LayerName> = None;
    }
}

impl Step for Terrace {
    fn reads(&self) -> Vec<String> {
        vec![self.layer.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        written(self.into.as_ref(), &self.layer)
    }

    fn reach(&self) -> Option<Reach> {
        Some(Reach::default())
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let field = landscape.field(&self.layer.0)?;
        let cut = map(field, |value| self.value(f64::from(value)) as f32);
        store(landscape, &self.layer, self.into.as_ref(), cut)?;
        Ok(Outcome::default())
    }
}

impl Terrace {
    fn value(&self, height: f64) -> f64 {
        let steps = height / self.spacing;
        let level = libm::floor(steps);
        // A softness of 0 would divide nothing by nothing at the edge.
        let rise = (0.5 + (steps - level - 0.5) / self.softness.max(1e-9)).clamp(0.0, 1.0);
        (level + rise * rise * (3.0 - 2.0 * rise)) * self.spacing
    }
}

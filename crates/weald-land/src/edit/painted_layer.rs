//! A layer that is painted by hand, such as the density of plants: strokes in the recipe itself, laid one after the other on
//! another layer or on one value.
//!
//! ```text
//! layer ← layer (1 - w) + value w          w is the weight of the stroke, by its distance from the line
//! ```

use super::brush::{Brush, Effect, Falloff};
use super::keys::MAX_PLACES;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Fault, LayerName, Nested, Places};
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<PaintedLayer>(
    "paint-layer",
    Stage::Combine,
    "paints a layer by hand, such as how densely plants stand",
    "Weald",
);

parameters! {
    /// A layer painted by hand.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size, parameter::{LayerName, Nested, Places}};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::edit::{PaintedLayer, PaintedStroke};
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 8)?, 10.0)); // columns, rows, metres
    /// let clearing = PaintedStroke { path: Places(vec![[45.0, 45.0]]), radius: 20.0, value: 0.0, ..Default::default() };
    /// let (into, strokes) = (LayerName::of("density"), vec![Nested(clearing)]);
    /// let paint = PaintedLayer { into, strokes, ..PaintedLayer::default() };
    /// paint.run(&mut landscape, &Job::unwatched(0))?;
    /// let density = landscape.field("density")?;
    /// assert_eq!([density.at(4, 4), density.at(0, 0)], [0.0, 1.0], "no plant in the clearing");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct PaintedLayer {
        /// Layer that is written.
        into: LayerName = LayerName::needed();
        /// Layer that is painted on; it stays as it is. Without it, the same value everywhere.
        of: Option<LayerName> = None;
        /// That value.
        value: f64 = 1.0, range -1.0e6..=1.0e6, without of;
        /// Strokes, the first one lowest: `[{ path = [[400, 300], [900, 320]], radius = 40, value = 0 }, …]`.
        strokes: Vec<Nested<PaintedStroke>> = Vec::new();
    }
}

parameters! {
    /// A stroke of a painted layer.
    pub struct PaintedStroke {
        /// Place `[x, y]` in metres from the north-western corner, east and south, or a list of places for a line through
        /// them.
        path: Places = Places::needed();
        /// Distance from the line to the edge of the stroke.
        radius: f64 = 50.0, range 0.001..=1_000_000.0, unit "m";
        /// How the stroke falls off towards its edge.
        falloff: Falloff = Falloff::Smooth;
        /// Share of the way to the value in the middle.
        strength: f64 = 1.0, range 0.0..=1.0;
        /// Value that the layer is brought to.
        value: f64 = 1.0, range -1.0e6..=1.0e6;
    }
}

impl PaintedStroke {
    fn brush(&self) -> Brush {
        // What the brush would do to a simulation is of no interest: only its weights count.
        let (path, effect) = (self.path.0.clone(), Effect::Mask);
        let Self { radius, falloff, strength, .. } = *self;
        Brush { path, radius, falloff, strength, effect }
    }
}

impl Step for PaintedLayer {
    fn reads(&self) -> Vec<String> {
        self.of.iter().map(|name| name.0.clone()).collect()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.into.0.clone(), "1")]
    }

    fn faults(&self) -> Vec<Fault> {
        let numbered = self.strokes.iter().zip(1..);
        let long = numbered.filter(|(Nested(stroke), _)| stroke.path.0.len() > MAX_PLACES);
        let fault = |(Nested(stroke), number): (&Nested<PaintedStroke>, usize)| {
            let places = stroke.path.0.len();
            let message = format!("`path` has {places} places; a stroke has at most {MAX_PLACES}");
            Fault::of("path", message).within(&format!("strokes.{number}"))
        };
        long.map(fault).collect()
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let mut layer = match &self.of {
            Some(name) => landscape.field(&name.0)?.clone(),
            None => Field::filled(landscape.domain.size, self.value as f32),
        };
        for Nested(stroke) in &self.strokes {
            stroke.brush().blend_into(&mut layer, landscape.domain.cell, stroke.value);
        }
        landscape.insert(&self.into.0, "1", layer);
        Ok(Outcome::default())
    }
}

//! Lays the materials down: the height of the bedrock and the thickness of each material become layers.
//!
//! Simulations of layered ground do so by themselves; the step is for layers that are changed or written
//! before.

use super::map_two;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::BEDROCK;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_core::strata::stack;
use weald_engine::Job;
use weald_engine::step::{Entry, Layered, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Layers>(
    "layers",
    Stage::Combine,
    "writes the height of the bedrock and the thickness of each material on it",
    "Weald",
);

parameters! {
    /// The ground in pieces.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::combine::layers::Layers;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::filled(landscape.domain.size, 100.0));
    /// landscape.materials[1].thickness = 3.0; // rock lies below, and soil on it
    /// Layers::default().run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!((landscape.field("bedrock")?.at(0, 0), landscape.field("soil")?.at(0, 0)), (97.0, 3.0));
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Layers {
        /// Layer of the height of the ground, under which the materials lie.
        of: LayerName = LayerName::of("height");
    }
}

impl Step for Layers {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        Vec::new()
    }

    fn layered(&self) -> Layered {
        Layered::Changes
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let ground = landscape.field(&self.of.0)?;
        let stack = stack(landscape, ground)?;
        let bedrock = stack.iter().fold(ground.clone(), |roof, layer| map_two(&roof, layer, |a, b| a - b));
        landscape.insert(BEDROCK, "m", bedrock);
        let names: Vec<_> =
            landscape.materials.iter().skip(1).map(|material| material.name.clone()).collect();
        for (name, thickness) in names.iter().zip(stack) {
            landscape.insert(name, "m", thickness);
        }
        Ok(Outcome { iterations: 1, ..Outcome::default() })
    }
}

//! The material map: which material lies at the surface of each cell, counted from the bedrock as 0.

use super::CELLS_PER_TASK;
use rayon::prelude::*;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::material::topmost;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_core::strata::stack;
use weald_engine::Job;
use weald_engine::step::{Entry, Layered, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<TopMaterial>(
    "top-material",
    Stage::Combine,
    "maps the material at the surface, counted from the bedrock as 0",
    "Weald",
);

parameters! {
    /// A map of materials.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::combine::top_material::TopMaterial;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::filled(landscape.domain.size, 100.0));
    /// let soil = |x, _| if x < 4 { 0.0 } else { 2.0 };
    /// landscape.insert("soil", "m", Field::from_function(landscape.domain.size, soil));
    /// TopMaterial::default().run(&mut landscape, &Job::unwatched(0))?;
    /// let material = landscape.field("material")?;
    /// assert_eq!((material.at(3, 0), material.at(4, 0)), (0.0, 1.0), "bare rock, and soil on it");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct TopMaterial {
        /// Layer of the height of the ground, under which the materials lie.
        of: LayerName = LayerName::of("height");
        /// A material that is thinner than this does not count as lying at the surface.
        thinnest: f64 = 0.01, range 0.0..=1000.0, unit "m";
        /// Layer that is written: 0 for the bedrock, 1 for the material on it, and so on.
        into: LayerName = LayerName::of("material");
    }
}

impl Step for TopMaterial {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.into.0.clone(), "1")]
    }

    fn layered(&self) -> Layered {
        Layered::Reads
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let stack = stack(landscape, landscape.field(&self.of.0)?)?;
        let size = landscape.domain.size;
        let cells = (0..size.cells()).into_par_iter().with_min_len(CELLS_PER_TASK);
        // A thickness of 0 lies nowhere, whatever counts as thin.
        let thinnest = (self.thinnest as f32).max(f32::MIN_POSITIVE);
        let map = cells.map(|cell| topmost(&stack, cell, thinnest) as f32).collect();
        landscape.insert(&self.into.0, "1", Field::from_values(size, map));
        Ok(Outcome { iterations: 1, ..Outcome::default() })
    }
}

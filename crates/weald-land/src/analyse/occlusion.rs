//! How open the ground is to light from all around: ambient occlusion, and the share of the sky in view.
//!
//! Both come from the horizons in many directions and the integral in `analyse/sky.rs`: Dozier and Frew 1990,
//! doi 10.1109/36.58986. At the bottom of an endless valley of straight walls that rise by the angle S, both are
//! cos S.

use rayon::prelude::*;

use super::CELLS_PER_TASK;
use super::horizon::Ground;
use super::sky::{Facet, Ray};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step, Work};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Occlusion>(
    "occlusion",
    Stage::Analyse,
    "how open the ground is to light from all around, and how much sky it sees",
    "Dozier and Frew 1990, doi 10.1109/36.58986; Timonen and Westerholm 2010, doi 10.1111/j.1467-8659.2009.01642.x",
);

parameters! {
    /// Openness from 0 to 1. Writes `occlusion`, the ambient occlusion of computer graphics: 1 where nothing stands
    /// before the hemisphere over the ground, as on every plane; and `sky_view`, the share of the light of an even
    /// sky that falls on the ground: 1 on level open ground, less on slopes, since they do not face all of it.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::occlusion::Occlusion;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(9, 9)?, 10.0)); // columns, rows, metres
    /// let valley = |x, _| 10.0 * (x as f32 - 4.0).abs(); // walls of 45° on both sides
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, valley));
    /// Occlusion::default().run(&mut landscape, &Job::unwatched(0))?;
    /// let sky = landscape.field("sky_view")?;
    /// assert!(sky.at(4, 4) < 0.9 && sky.at(4, 4) < landscape.field("occlusion")?.at(0, 4));
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Occlusion {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Directions in which the horizon is looked for.
        directions: u32 = 32, range 4..=720;
    }
}

const LAYERS: [&str; 2] = ["occlusion", "sky_view"];

impl Step for Occlusion {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        LAYERS.map(|name| (name.to_owned(), "1")).into()
    }

    fn range(&self, _: &str) -> Option<(f64, f64)> {
        Some((0.0, 1.0))
    }

    fn bytes_per_cell(&self) -> u64 {
        48
    }

    fn work(&self, _: &Domain) -> Work {
        Work::of(self.directions)
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let height = landscape.field(&self.of.0)?;
        let openness = openness(height, &landscape.domain, self.directions as usize, job)?;
        for (at, name) in LAYERS.into_iter().enumerate() {
            let values = openness.iter().map(|both| both[at].clamp(0.0, 1.0)).collect();
            landscape.insert(name, "1", Field::from_values(landscape.domain.size, values));
        }
        Ok(Outcome { iterations: u64::from(self.directions), ..Outcome::default() })
    }
}

/// Ambient occlusion and sky view of every cell.
fn openness(
    height: &Field,
    domain: &Domain,
    directions: usize,
    job: &Job<'_>,
) -> Result<Vec<[f32; 2]>, Error> {
    let facets = Facet::all(height, domain);
    let weight = 2.0 / directions as f64;
    let mut sums = vec![[0.0_f32; 2]; facets.len()];
    Ground::new(height, domain).around(directions, job, |direction| {
        let ray = Ray::of(&direction);
        let cells = sums.par_iter_mut().with_min_len(CELLS_PER_TASK).zip(&facets).zip(direction.horizon);
        cells.for_each(|((sums, facet), &horizon)| {
            let horizon = f64::from(horizon);
            let shares = [facet.share(ray, horizon), facet.share(ray, horizon.max(0.0))];
            *sums = std::array::from_fn(|at| sums[at] + (weight * shares[at]) as f32);
        });
    })?;
    Ok(sums)
}

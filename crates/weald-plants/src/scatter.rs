//! Plants set on the land: by the ground that suits them, at a distance from each other, each of its own size, turn and
//! place in the wind.
//!
//! The suitability of a place is the product of conditions on layers, each a range with soft edges; it sets how densely
//! plants stand (`pattern.rs`). Asked for a number of plants, the step looks for the widest spacing at which as many find
//! room, within some hundredths (`count.rs`), and takes those of the first ranks; so the same number stands evenly.

mod bins;
mod count;
mod pattern;
mod site;
#[cfg(test)]
mod tests;
mod tiles;
mod window;

use pattern::{CUTS, DENSITY, Pattern, Place};
use rayon::prelude::*;
use site::{Site, unit};
use weald_core::condition::{self, Condition};
use weald_core::domain::Domain;
use weald_core::error::{Error, Limit, Quantity};
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Fault, LayerName, Nested};
use weald_core::parameters;
use weald_core::plants::{Plant, Plants};
use weald_core::random;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Scatter>(
    "scatter",
    Stage::Grow,
    "sets plants where the ground suits them, at a distance from each other",
    "Wei 2008, doi 10.1145/1360612.1360619; Ebeida et al. 2012, doi 10.1111/j.1467-8659.2012.03059.x; Luby 1986, doi \
     10.1137/0215074",
);

/// Most plants of a step.
pub const MAX_PLANTS: u32 = 10_000_000;

parameters! {
    /// Plants on the land. Writes, beside the plants, a layer of their name: how many stand on a square metre.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size, parameter::LayerName};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_core::{condition::Condition, parameter::Nested};
    /// # use weald_plants::scatter::Scatter;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(20, 10)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, |x, _| x as f32));
    /// let low = Condition { layer: LayerName::of("height"), below: Some(10.0), ..Condition::default() };
    /// let scatter = Scatter { spacing: 8.0, r#where: vec![Nested(low)], ..Scatter::default() };
    /// scatter.run(&mut landscape, &Job::unwatched(0))?;
    /// let plants = &landscape.plants("plants")?.plants;
    /// assert!(plants.len() > 20 && plants.iter().all(|plant| plant.place[2] <= 10.0), "on low ground alone");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Scatter {
        /// Name of the plants, and of the layer that counts them.
        into: LayerName = LayerName::of("plants");
        /// What is planted: a fractal, of the recipe or built in.
        plant: String = "fern".to_owned();
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Least distance between two plants. On ground of suitability s they stand 1/√s times as far apart, so that s
        /// is the density beside the densest; below 1/64 some are left out at random instead.
        spacing: f64 = 5.0, range 0.01..=1.0e5, unit "m";
        /// So many plants, as far apart as that lets them be but no closer than `spacing`. Without it, as many as find
        /// room.
        count: Option<u32> = None, range 1..=10_000_000;
        /// Conditions of the ground, as those of `select`: `[{ layer = "slope", below = 30, soft = 10 }, …]`. Their
        /// product is the suitability. Layers are taken between the centres of cells.
        r#where: Vec<Nested<Condition>> = Vec::new();
        /// Depth of the layer `water`, where there is one, up to which plants stand in it.
        water: f64 = 0.1, range 0.0..=1.0e4, unit "m";
        /// Least and greatest height of a plant, in metres.
        size: Vec<f64> = vec![0.6, 1.2], range 0.001..=1000.0, unit "m";
        /// Share by which suitability, and not chance, sets the size.
        vigour: f64 = 0.0, range 0.0..=1.0;
        /// 1 where stems stand upright on any slope, 0 where they stand at right angles to the ground.
        upright: f64 = 0.8, range 0.0..=1.0;
    }
}

impl Step for Scatter {
    fn reads(&self) -> Vec<String> {
        let conditions = self.r#where.iter().map(|Nested(condition)| condition.layer.0.clone());
        std::iter::once(self.of.0.clone()).chain(conditions).collect()
    }

    fn reads_where_there(&self) -> Vec<String> {
        vec!["water".to_owned()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.into.0.clone(), "1/m²")]
    }

    fn plants(&self) -> Vec<String> {
        vec![self.into.0.clone()]
    }

    fn fractals(&self) -> Vec<String> {
        vec![self.plant.clone()]
    }

    fn range(&self, _: &str) -> Option<(f64, f64)> {
        Some((0.0, f64::INFINITY))
    }

    fn faults(&self) -> Vec<Fault> {
        let size = match self.size.as_slice() {
            [least, most] if least <= most => None,
            [least, most] => {
                Some(format!("`size` is [{least}, {most}]; the first must not be over the second"))
            }
            other => {
                Some(format!("`size` has {} numbers; it needs two, the least and the greatest", other.len()))
            }
        };
        let size = size.map(|message| Fault::of("size", message));
        size.into_iter().chain(condition::faults(&self.r#where)).collect()
    }

    /// Conditions leave less ground than there is, and only the ground tells how much: a run widens the spacing then.
    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        if self.count.is_some() || !self.r#where.is_empty() {
            return Ok(());
        }
        self.ensure_possible(domain.valid_cells() as f64 * domain.cell * domain.cell)
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let conditions = self.r#where.iter().map(|Nested(condition)| condition);
        let site = Site::new(landscape, &self.of.0, conditions, self.water)?;
        let (spacing, places) = self.places(&site, job)?;
        let plants: Vec<_> = places.par_iter().map(|place| self.plant(place, &site)).collect();
        let outcome = self.outcome(spacing, plants.len());
        let density = density(&landscape.domain, &plants);
        landscape.insert(&self.into.0, "1/m²", density);
        landscape.plant(&self.into.0, Plants { kind: self.plant.clone(), spacing, plants });
        Ok(outcome)
    }
}

impl Scatter {
    /// The places of the plants, and the least distance between them.
    fn places(&self, site: &Site<'_>, job: &Job<'_>) -> Result<(f64, Vec<Place>), Error> {
        let area = site.suitable_area();
        let at = |spacing: f64, cuts: u8| {
            Pattern { ground: site, spacing, seed: job.seed, cuts }.places(job.watcher)
        };
        let Some(count) = self.count else {
            if self.r#where.is_empty() {
                self.ensure_possible(area)?;
            }
            let spacing = self.spacing.max(self.narrowest(area).unwrap_or_default());
            return Ok((spacing, at(spacing, CUTS)?));
        };
        count::widest(count as usize, self.spacing, area, at)
    }

    /// The least spacing on so much ground, where the one that is asked for would set more plants than there may be.
    fn narrowest(&self, area: f64) -> Option<f64> {
        let expected = DENSITY * area / (self.spacing * self.spacing);
        let narrowest = libm::ceil((DENSITY * area / f64::from(MAX_PLANTS)).sqrt() * 100.0) / 100.0;
        (expected > f64::from(MAX_PLANTS)).then_some(narrowest)
    }

    fn ensure_possible(&self, area: f64) -> Result<(), Error> {
        let Some(wide) = self.narrowest(area) else { return Ok(()) };
        let expected = DENSITY * area / (self.spacing * self.spacing);
        let limit = Limit::new(Quantity::Plants, expected.ceil() as u64, 0..=MAX_PLANTS.into());
        let subject = format!("scatter: expected at a `spacing` of {} m on this ground", self.spacing);
        Err(limit.of(subject).remedy(format!("choose {wide} m or more, or a `count`")).into())
    }

    fn plant(&self, place: &Place, site: &Site<'_>) -> Plant {
        let random = |purpose| random::unit(place.bits(purpose));
        let (least, most) = (self.size[0], self.size[1]);
        let share = (1.0 - self.vigour) * random(SIZE) + self.vigour * place.suitability;
        let normal = site.normal(place.at);
        let leaning = normal.map(|number| (1.0 - self.upright) * number);
        let up = unit([leaning[0], leaning[1], leaning[2] + self.upright]);
        let [x, y] = place.at;
        Plant {
            place: [x, y, site.height(place.at).expect("places lie on ground")],
            up: up.map(|number| number as f32),
            size: (least + (most - least) * share) as f32,
            turn: (std::f64::consts::TAU * random(TURN)) as f32,
            phase: random(PHASE) as f32,
            suitability: place.suitability as f32,
        }
    }

    fn outcome(&self, spacing: f64, plants: usize) -> Outcome {
        let fewer = self.count.filter(|&count| plants < count as usize).map(|count| {
            format!(
                "{plants} of {count} plants find room at a `spacing` of {} m; a smaller one, or milder conditions, give \
                 more",
                self.spacing
            )
        });
        let measures = [("plants", plants as f64), ("spacing", spacing)].into();
        let wider = (self.count.is_none() && spacing > self.spacing).then(|| {
            format!(
                "plants stand {spacing} m apart, not {} m: so much ground meets the conditions that there would be more than \
                 {MAX_PLANTS}; harder conditions, or a `count`, leave the spacing",
                self.spacing
            )
        });
        let notes = fewer.into_iter().chain(wider).collect();
        Outcome { iterations: plants as u64, measures, notes, ..Outcome::default() }
    }
}

/// Uses of a place's random bits.
const SIZE: u64 = 8;
const TURN: u64 = 9;
const PHASE: u64 = 10;

/// Plants on a square metre of each cell.
fn density(domain: &Domain, plants: &[Plant]) -> Field {
    let mut counts = Field::filled(domain.size, 0.0);
    let cell = |along: f64, count: usize| ((along / domain.cell) as usize).min(count - 1);
    for plant in plants {
        let (x, y) = (cell(plant.place[0], domain.size.columns), cell(plant.place[1], domain.size.rows));
        counts.set(x, y, counts.at(x, y) + 1.0);
    }
    for count in counts.values_mut() {
        *count = (f64::from(*count) / domain.cell_area()) as f32;
    }
    counts
}

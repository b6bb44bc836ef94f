//! The light of a day on the ground: direct sun with the shadows of the land, light of the sky, light from slopes
//! around.
//!
//! ```text
//! G = Σ beam (n·s)⁺ visible  +  V Σ sky  +  albedo (½ (1 + n_z) - V) G₀          G₀ = Σ beam s_z + Σ sky
//! light = min(1, G / G₀)
//! ```
//!
//! summed over places of the sun s from its rise to its setting (`analyse/sun.rs`), with the unit normal n of the
//! ground, its sky view V (`analyse/sky.rs`), and G₀ on level open ground: Dozier and Frew 1990, doi
//! 10.1109/36.58986, with the terrain configuration factor of Dozier 1980, doi 10.1029/WR016i004p00709. The horizon
//! at the azimuth of the sun lies between the two nearest ones of those that are looked for; as the sun rises
//! over it, it is visible for a share of its time. The air is clear all day and the same at all heights.

use rayon::prelude::*;

use super::CELLS_PER_TASK;
use super::horizon::{Direction, Ground};
use super::latitude::latitude_deg;
use super::sky::{Facet, Ray};
use super::sun::{Course, Sun};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step, Work};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Sunlight>(
    "sunlight",
    Stage::Analyse,
    "the light of a clear day on the ground, with the shadows of the land",
    "Dozier and Frew 1990, doi 10.1109/36.58986; Timonen and Westerholm 2010, doi 10.1111/j.1467-8659.2009.01642.x; \
     Spencer 1971; Kasten and Young 1989, doi 10.1364/AO.28.004735; Liu and Jordan 1960, doi \
     10.1016/0038-092X(60)90062-1",
);

/// Latitude where neither the recipe nor the ground tells it.
const SOME_LATITUDE: f64 = 45.0;

parameters! {
    /// Insolation. Writes `sunlight`, what a square metre of the ground gets in a day, in kWh/m², and `light`, its
    /// share of what level open ground gets, from 0 to 1, as plants want to know it. North is the top of the grid.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::sunlight::Sunlight;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(9, 9)?, 10.0)); // columns, rows, metres
    /// let roof = |_, y| -5.0 * (y as f32 - 4.0).abs(); // falls to the north and to the south
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, roof));
    /// Sunlight { latitude_deg: Some(45.0), ..Sunlight::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// let (north, south) = (landscape.field("light")?.at(4, 1), landscape.field("light")?.at(4, 7));
    /// assert!(north < 0.85 * south, "{north} of the light on the northern side, {south} on the southern");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Sunlight {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Day of the year, 172 being midsummer in the north. Without it, the mean day of the whole year.
        day: Option<u32> = None, range 1..=365;
        /// Latitude, south negative. Without it, that of the middle of the ground where its coordinate reference
        /// system is known, else 45.
        latitude_deg: Option<f64> = None, range -90.0..=90.0, unit "deg";
        /// Share of sunlight from the zenith that comes through the air: 0.7 on a clear day; 1 is no air.
        transmissivity: f64 = 0.7, range 0.1..=1.0;
        /// Share of the light that ground reflects: 0.2 for grass and rock, 0.8 for snow.
        albedo: f64 = 0.2, range 0.0..=1.0;
        /// Directions in which the horizon is looked for.
        directions: u32 = 64, range 4..=720;
        /// Places of the sun between its rise and its setting.
        positions: u32 = 48, range 4..=1000;
    }
}

impl Step for Sunlight {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![("sunlight".to_owned(), "kWh/m²"), ("light".to_owned(), "1")]
    }

    fn range(&self, layer: &str) -> Option<(f64, f64)> {
        Some((0.0, if layer == "light" { 1.0 } else { f64::INFINITY }))
    }

    fn bytes_per_cell(&self) -> u64 {
        52
    }

    fn work(&self, _: &Domain) -> Work {
        Work::of(self.directions)
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let (height, domain) = (landscape.field(&self.of.0)?, &landscape.domain);
        let (latitude, notes) = self.latitude(domain);
        let day = self.daylight(latitude);
        let facets = Facet::all(height, domain);
        let lit = self.lit(&Ground::new(height, domain), &facets, &day, job)?;
        let open = day.on_open_ground();
        let whole = |(lit, facet): (&Lit, &Facet)| self.whole(*lit, *facet, &day);
        let values: Vec<f32> = lit.iter().zip(&facets).map(whole).collect();
        let share = |&value: &f32| if open > 0.0 { (f64::from(value) / open).min(1.0) as f32 } else { 0.0 };
        let light = values.iter().map(share).collect();
        let size = domain.size;
        landscape.insert("sunlight", "kWh/m²", Field::from_values(size, values));
        landscape.insert("light", "1", Field::from_values(size, light));
        Ok(Outcome { iterations: u64::from(self.directions), notes, ..Outcome::default() })
    }
}

/// The suns of a day, each in the direction whose horizon comes before it.
struct Daylight {
    by_direction: Vec<Vec<(Sun, f64)>>,
    /// What the sky brings to level open ground, in kWh/m².
    sky: f64,
}

impl Daylight {
    fn on_open_ground(&self) -> f64 {
        let direct = self.by_direction.iter().flatten().map(|(sun, _)| sun.beam * sun.direction[2].max(0.0));
        direct.sum::<f64>() + self.sky
    }
}

/// What a cell has got so far.
#[derive(Clone, Copy, Debug, Default)]
struct Lit {
    /// Direct sunlight in kWh/m².
    direct: f32,
    /// Sky view.
    sky: f32,
}

impl Sunlight {
    fn latitude(&self, domain: &Domain) -> (f64, Vec<String>) {
        match self.latitude_deg.or_else(|| latitude_deg(domain)) {
            Some(latitude) => (latitude, Vec::new()),
            None => (
                SOME_LATITUDE,
                vec![format!(
                    "the ground has no known latitude: {SOME_LATITUDE}° is taken; `latitude_deg` sets it"
                )],
            ),
        }
    }

    fn daylight(&self, latitude_deg: f64) -> Daylight {
        let course = Course {
            day: self.day,
            latitude: latitude_deg.to_radians(),
            transmissivity: self.transmissivity,
            positions: self.positions,
        };
        let mut day = Daylight { by_direction: vec![Vec::new(); self.directions as usize], sky: 0.0 };
        for sun in course.suns() {
            let place = sun.azimuth() / std::f64::consts::TAU * f64::from(self.directions);
            let before = libm::floor(place);
            day.by_direction[before as usize % self.directions as usize].push((sun, place - before));
            day.sky += sun.sky;
        }
        day
    }

    fn lit(
        &self,
        ground: &Ground,
        facets: &[Facet],
        day: &Daylight,
        job: &Job<'_>,
    ) -> Result<Vec<Lit>, Error> {
        let mut lit = vec![Lit::default(); facets.len()];
        let weight = 2.0 / f64::from(self.directions);
        ground.around(self.directions as usize, job, |direction| {
            let (ray, suns) = (Ray::of(&direction), &day.by_direction[direction.number]);
            lit.par_iter_mut().with_min_len(CELLS_PER_TASK).enumerate().for_each(|(cell, lit)| {
                let facet = facets[cell];
                let horizon = f64::from(direction.horizon[cell]).max(0.0);
                lit.sky += (weight * facet.share(ray, horizon)) as f32;
                lit.direct += direct(suns, facet, &direction, cell) as f32;
            });
        })?;
        Ok(lit)
    }

    /// All light in a cell, in kWh/m².
    fn whole(&self, lit: Lit, facet: Facet, day: &Daylight) -> f32 {
        let sky_view = f64::from(lit.sky).clamp(0.0, 1.0);
        let around = (0.5 * (1.0 + facet.normal()[2]) - sky_view).max(0.0);
        let reflected = self.albedo * around * day.on_open_ground();
        (f64::from(lit.direct) + sky_view * day.sky + reflected) as f32
    }
}

/// Direct sunlight in a cell from suns between two directions, in kWh/m².
fn direct(suns: &[(Sun, f64)], facet: Facet, direction: &Direction<'_>, cell: usize) -> f64 {
    let [here, next] = [direction.horizon, direction.next].map(|horizon| f64::from(horizon[cell]).max(0.0));
    let normal = facet.normal();
    let light = |(sun, share): &(Sun, f64)| {
        let cosine: f64 = normal.iter().zip(sun.direction).map(|(n, s)| n * s).sum();
        let horizon = here * (1.0 - share) + next * share;
        sun.beam * cosine.max(0.0) * visible(sun.altitudes, horizon)
    };
    suns.iter().map(light).sum()
}

/// Least span of the tangents of altitudes: the disc of the sun is half a degree wide.
const DISC: f64 = 0.009;

/// Share of the time for which the sun is over the horizon, while it moves between two altitudes.
fn visible([low, high]: [f64; 2], horizon: f64) -> f64 {
    let span = (high - low).max(DISC);
    ((low + span - horizon) / span).clamp(0.0, 1.0)
}

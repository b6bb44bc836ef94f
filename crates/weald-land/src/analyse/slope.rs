//! How steep the ground is.
//!
//! ```text
//! slope = atan √(p² + q²)
//! ```
//!
//! with the gradient (p, q) of a quadratic fitted to the window around each cell: Evans 1972, doi
//! 10.4324/9780429273346-2.

use super::angle;
use super::quadric::{LOOKS, Quadric, Surface, window};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::{choices, parameters};
use weald_engine::Job;
use weald_engine::local::Reach;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Slope>(
    "slope",
    Stage::Analyse,
    "how steep the ground is, as an angle or as a ratio",
    "Evans 1972, doi 10.4324/9780429273346-2; Wood 1996",
);

choices! {
    /// How steepness is given.
    pub enum SlopeUnit {
        /// Angle against the level, 0 to 90 degrees.
        Degree = "degree",
        /// Rise over run, the tangent of that angle.
        Tangent = "tangent",
    }
}

parameters! {
    /// Steepness.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::slope::Slope;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, |x, _| 10.0 * x as f32));
    /// Slope::default().run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.field("slope")?.at(4, 3), 45.0, "10 m of rise over 10 m");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Slope {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Angle or ratio.
        unit: SlopeUnit = SlopeUnit::Degree;
        /// Metres from a cell to the edge of the window in which the surface is fitted: forms smaller than that
        /// do not count. The least is one cell.
        scale: f64 = 0.0, range 0.0..=1.0e6, unit "m";
        /// Layer that is written.
        into: LayerName = LayerName::of("slope");
    }
}

impl Slope {
    fn unit_and_end(&self) -> (&'static str, f64) {
        match self.unit {
            SlopeUnit::Degree => ("deg", 90.0),
            SlopeUnit::Tangent => ("1", f64::INFINITY),
        }
    }
}

impl Step for Slope {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.into.0.clone(), self.unit_and_end().0)]
    }

    fn range(&self, _: &str) -> Option<(f64, f64)> {
        Some((0.0, self.unit_and_end().1))
    }

    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        window(domain, self.scale).map(drop)
    }

    fn reach(&self) -> Option<Reach> {
        Some(Reach { metres: self.scale, cells: LOOKS })
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let domain = &landscape.domain;
        let surface = Surface::new(landscape.field(&self.of.0)?, domain).reaching(self.scale)?;
        let [slope] = match self.unit {
            SlopeUnit::Tangent => surface.fields(
                #[inline(always)]
                |_, surface| tangent(surface),
            ),
            SlopeUnit::Degree => surface.fields(
                #[inline(always)]
                |_, surface| degrees(surface),
            ),
        };
        landscape.insert(&self.into.0, self.unit_and_end().0, slope);
        Ok(Outcome { iterations: 1, ..Outcome::default() })
    }
}

#[inline(always)]
fn tangent(surface: Quadric) -> [f64; 1] {
    [surface.steepness().sqrt()]
}

#[inline(always)]
fn degrees(surface: Quadric) -> [f64; 1] {
    tangent(surface).map(|tangent| angle::of_tangent(tangent).to_degrees())
}

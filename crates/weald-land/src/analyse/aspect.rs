//! Where the ground faces.
//!
//! ```text
//! aspect = direction of (-p, -q), clockwise from north          northness = -q / √(1 + p² + q²)
//!                                                               eastness  = -p / √(1 + p² + q²)
//! ```
//!
//! with the gradient (p east, q north) of a quadratic fitted to the window around each cell: Evans 1972, doi
//! 10.4324/9780429273346-2. Northness and eastness, the horizontal parts of the upright unit normal, have no
//! jump at north and fade out on flat ground, so that masks and statistics should use them rather than the
//! angle.

use super::angle;
use super::quadric::{LOOKS, Quadric, Surface, window};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::local::Reach;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Aspect>(
    "aspect",
    Stage::Analyse,
    "where the ground faces: as an angle, and as shares of north and east",
    "Evans 1972, doi 10.4324/9780429273346-2",
);

/// Aspect of flat ground, which faces nowhere.
pub const LEVEL: f64 = -1.0;

parameters! {
    /// Direction of the slope. Writes `aspect` in degrees clockwise from north, 0 to 360, with -1 on flat ground;
    /// `northness` and `eastness` from -1 to 1, which are 0 there.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::aspect::Aspect;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// let eastward = |x, _| 100.0 - x as f32;
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, eastward));
    /// Aspect::default().run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.field("aspect")?.at(4, 3), 90.0, "the slope faces east");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Aspect {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Metres from a cell to the edge of the window in which the surface is fitted: forms smaller than that
        /// do not count. The least is one cell.
        scale: f64 = 0.0, range 0.0..=1.0e6, unit "m";
    }
}

const LAYERS: [(&str, &str); 3] = [("aspect", "deg"), ("northness", "1"), ("eastness", "1")];

impl Step for Aspect {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        LAYERS.map(|(name, unit)| (name.to_owned(), unit)).into()
    }

    fn range(&self, layer: &str) -> Option<(f64, f64)> {
        Some(if layer == "aspect" { (LEVEL, 360.0) } else { (-1.0, 1.0) })
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
        let fields = surface.fields(
            #[inline(always)]
            |_, surface| facing(surface),
        );
        for ((name, unit), field) in LAYERS.into_iter().zip(fields) {
            landscape.insert(name, unit, field);
        }
        Ok(Outcome { iterations: 1, ..Outcome::default() })
    }
}

/// Aspect, northness and eastness.
#[inline(always)]
fn facing(surface: Quadric) -> [f64; 3] {
    let normal = (1.0 + surface.steepness()).sqrt();
    [aspect_deg(surface), -surface.q / normal, -surface.p / normal]
}

#[inline(always)]
fn aspect_deg(surface: Quadric) -> f64 {
    let angle = angle::of_direction(-surface.p, -surface.q).to_degrees();
    let angle = if angle < 0.0 { angle + 360.0 } else { angle };
    if surface.steepness() == 0.0 { LEVEL } else { angle }
}

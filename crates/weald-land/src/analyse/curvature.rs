//! How the ground bends, convex positive: ridges, shoulders and summits above 0, valleys, feet and pits below.
//!
//! ```text
//! profile    = -(p² r + 2 p q s + q² t) / (g (1 + g)^1.5)        along the line of fall
//! tangential = -(q² r - 2 p q s + p² t) / (g (1 + g)^0.5)        across it, in the normal plane
//! plan       = -(q² r - 2 p q s + p² t) / g^1.5                  of the contour
//! mean       = -((1 + q²) r - 2 p q s + (1 + p²) t) / (2 (1 + g)^1.5)
//! ```
//!
//! with g = p² + q² and the derivatives of a quadratic fitted to the window around each cell: Evans 1972, doi
//! 10.4324/9780429273346-2. Zevenbergen and Thorne 1987, doi 10.1002/esp.3290120107, name profile and plan
//! curvature; the forms here are the ones that are curvatures of curves in space (Minár, Evans and Jenčo 2020,
//! doi 10.1016/j.earscirev.2020.103414). On a sphere of radius R that bulges upward profile, tangential and mean
//! are 1/R, and plan is 1 over the radius of the contour.

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
pub const ENTRY: Entry = Entry::of::<Curvature>(
    "curvature",
    Stage::Analyse,
    "how the ground bends along and across the slope, convex positive",
    "Evans 1972, doi 10.4324/9780429273346-2; Zevenbergen and Thorne 1987, doi 10.1002/esp.3290120107",
);

parameters! {
    /// Curvature. Writes `curvature_profile` along the line of fall, `curvature_plan` of the contour,
    /// `curvature_tangential` across the line of fall, and `curvature_mean`, all in 1/m and positive where the
    /// ground is convex.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::curvature::Curvature;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(9, 9)?, 10.0)); // columns, rows, metres
    /// let dome = |x, y| -0.05 * ((x as f32 - 4.0).powi(2) + (y as f32 - 4.0).powi(2)); // of radius 1000 m
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, dome));
    /// Curvature::default().run(&mut landscape, &Job::unwatched(0))?;
    /// assert!((landscape.field("curvature_mean")?.at(4, 4) - 0.001).abs() < 1.0e-6, "convex, 1 over the radius");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Curvature {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Metres from a cell to the edge of the window in which the surface is fitted: forms smaller than that
        /// do not count. The least is one cell.
        scale: f64 = 0.0, range 0.0..=1.0e6, unit "m";
        /// Ground that is gentler than this has no line of fall: profile, plan and tangential curvature are 0
        /// there.
        min_slope_deg: f64 = 0.01, range 0.000_001..=10.0, unit "deg";
    }
}

const LAYERS: [&str; 4] = ["curvature_profile", "curvature_plan", "curvature_tangential", "curvature_mean"];

impl Step for Curvature {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        LAYERS.map(|name| (name.to_owned(), "1/m")).into()
    }

    fn range(&self, _: &str) -> Option<(f64, f64)> {
        Some((f64::NEG_INFINITY, f64::INFINITY))
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
        let level = libm::tan(self.min_slope_deg.to_radians());
        let fields = surface.fields(
            #[inline(always)]
            |_, surface| curvatures(surface, level * level),
        );
        for (name, field) in LAYERS.into_iter().zip(fields) {
            landscape.insert(name, "1/m", field);
        }
        Ok(Outcome { iterations: 1, ..Outcome::default() })
    }
}

/// In the order of [`LAYERS`].
#[inline(always)]
fn curvatures(surface: Quadric, level: f64) -> [f64; 4] {
    let Quadric { p, q, r, s, t } = surface;
    let g = surface.steepness();
    let stretch = (1.0 + g).sqrt();
    let mean =
        -((1.0 + q * q) * r - 2.0 * p * q * s + (1.0 + p * p) * t) / (2.0 * stretch * stretch * stretch);
    let along = -(p * p * r + 2.0 * p * q * s + q * q * t) / g;
    let across = -(q * q * r - 2.0 * p * q * s + p * p * t) / g;
    let on_slopes = |curvature: f64| if g < level { 0.0 } else { curvature };
    [
        on_slopes(along / (stretch * stretch * stretch)),
        on_slopes(across / g.sqrt()),
        on_slopes(across / stretch),
        mean,
    ]
}

//! How much of the sky a piece of ground sees, from the horizon around it.
//!
//! ```text
//! V = 1/π ∫ dφ ∫_h^{π/2} (n·ω) cos e de
//!   = 1/2π ∫ [n_z cos² h + n_φ (π/2 - h - sin h cos h)] dφ
//! ```
//!
//! with the unit normal n of the ground, its part `n_φ` towards the azimuth φ, and the elevation h of the horizon
//! there. Dozier and Frew 1990, "Rapid calculation of terrain parameters for radiation modeling from digital
//! elevation data", doi 10.1109/36.58986, eq. 7b. Their horizon is never below the level; here that is one of two
//! ways to look: without it, V is the ambient occlusion of computer graphics, which is 1 on every plane.

use rayon::prelude::*;

use super::horizon::Direction;
use super::quadric::{Quadric, Surface};
use weald_core::domain::Domain;
use weald_core::grid::Field;

/// The ground in a cell: its rise towards the east and the north, and the upward part of its unit normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facet {
    p: f32,
    q: f32,
    up: f32,
}

impl Facet {
    fn new(surface: Quadric) -> Self {
        let up = 1.0 / libm::sqrt(1.0 + surface.steepness());
        Self { p: surface.p as f32, q: surface.q as f32, up: up as f32 }
    }

    /// The facets of all cells; level where there are no data.
    pub(super) fn all(height: &Field, domain: &Domain) -> Vec<Self> {
        let (surface, columns) = (Surface::new(height, domain), domain.size.columns);
        let facet = |cell: usize| {
            let has_data = domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
            let at = |cell: usize| surface.at(cell % columns, cell / columns);
            Self::new(if has_data { at(cell) } else { Quadric::default() })
        };
        (0..domain.size.cells()).into_par_iter().map(facet).collect()
    }

    /// Parts of the normal towards the east, the north and the zenith.
    pub(super) fn normal(self) -> [f64; 3] {
        let up = f64::from(self.up);
        [-f64::from(self.p) * up, -f64::from(self.q) * up, up]
    }

    /// The integral over one azimuth, from the horizon there, which the ground itself bounds from below.
    pub(super) fn share(self, ray: Ray, horizon: f64) -> f64 {
        let rise = f64::from(self.p) * ray.east + f64::from(self.q) * ray.north;
        let tangent = horizon.max(rise);
        let square = 1.0 / (1.0 + tangent * tangent);
        let open = std::f64::consts::FRAC_PI_2 - libm::atan(tangent);
        0.5 * f64::from(self.up) * (square - rise * (open - tangent * square))
    }
}

/// A horizontal direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    east: f64,
    north: f64,
}

impl Ray {
    pub(super) fn of(direction: &Direction<'_>) -> Self {
        Self { east: libm::sin(direction.azimuth), north: libm::cos(direction.azimuth) }
    }
}

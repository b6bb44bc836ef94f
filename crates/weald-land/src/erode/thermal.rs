//! Thermal weathering: ground steeper than its talus slides until it rests.
//!
//! Three schemes, on heights in cells (Han 2015, eq. 17–21, doi 10.7583/JKGS.2015.15.6.171):
//!
//! * `axis` (eq. 17): each edge for itself; where the step `q` exceeds `tan φ`, `K_t (q - tan φ)` slides.
//!   Cones become square pyramids.
//! * `isotropic` (eq. 18–21): the triangle of a cell with its eastern and southern neighbours has the slope
//!   `tan α = √(Dx² + Dy²)`; where it exceeds `tan φ`, `c = K_t (tan α - tan φ) / tan α` of each step slides
//!   along its edge. Cones stay round.
//! * `isotropic-symmetric`: the mean over the four triangles of a cell, which restores the symmetry of the
//!   square that the forward triangle breaks.
//!
//! All conserve the ground, and are stable for `K_t` up to 1/4.

use std::sync::Arc;

use super::pipeline::{Equations, Pipeline};
use weald_core::choices;
use weald_engine::kernel;
use weald_engine::uniform;

choices! {
    /// How slopes are compared with the talus.
    pub enum Scheme {
        /// Every edge for itself: the classic rule, square pyramids.
        Axis = "axis",
        /// By the slope of the triangle east and south of a cell: round cones.
        Isotropic = "isotropic",
        /// Mean of the four triangles of a cell: round cones, all symmetries of the square.
        IsotropicSymmetric = "isotropic-symmetric",
    }
}

uniform! {
    /// Constants of the method, heights in cells.
    pub(crate) struct SlideConstants {
        /// Steepest slope that rests, as a tangent.
        pub(crate) talus: f32,
        /// Share of the excess that slides in a step.
        pub(crate) strength: f32,
    }
}

/// The method.
#[derive(Clone, Debug)]
pub(crate) struct Slide {
    pub(crate) constants: SlideConstants,
    pub(crate) pipeline: Arc<Pipeline>,
}

kernel! {
    /// Ground of a row.
    pub(crate) struct Ground {
        reads { base, change }
        writes { ground }
    }
    fn cell() {
        ground = base + change;
    }
}

/// What slides along an edge with step `q`.
#[inline(always)]
fn along_axis(q: f32, talus: f32, strength: f32) -> f32 {
    strength * (q - q.clamp(-talus, talus))
}

kernel! {
    /// The axis scheme: what slides east and south.
    pub(crate) struct Axis {
        reads { ground, ground_east, ground_south, link_east, link_south }
        writes { to_east, to_south }
        constants { talus: f32, strength: f32 }
    }
    fn cell() {
        to_east = link_east * along_axis(ground - ground_east, talus, strength);
        to_south = link_south * along_axis(ground - ground_south, talus, strength);
    }
}

/// The share `c` of the steps of a triangle that slides.
#[inline(always)]
fn sliding_share(step_x: f32, step_y: f32, talus: f32, strength: f32) -> f32 {
    let slope = (step_x * step_x + step_y * step_y).sqrt();
    if slope > talus { strength * (slope - talus) / slope } else { 0.0 }
}

kernel! {
    /// The isotropic scheme: what slides east and south in the triangle of a cell.
    pub(crate) struct Triangle {
        reads { ground, ground_east, ground_south, link_east, link_south }
        writes { to_east, to_south }
        constants { talus: f32, strength: f32 }
    }
    fn cell() {
        let step_x = ground - ground_east;
        let step_y = ground - ground_south;
        let share = sliding_share(step_x, step_y, talus, strength) * (link_east * link_south);
        to_east = share * step_x;
        to_south = share * step_y;
    }
}

kernel! {
    /// Shares of the four triangles of a cell, added for each of its edges.
    pub(crate) struct FourTriangles {
        reads {
            ground, ground_east, ground_west, ground_south, ground_north,
            link_east, link_west, link_south, link_north,
        }
        writes { share_east, share_west, share_south, share_north }
        constants { talus: f32, strength: f32 }
    }
    fn cell() {
        let (east, west) = (ground - ground_east, ground - ground_west);
        let (south, north) = (ground - ground_south, ground - ground_north);
        let south_east = sliding_share(east, south, talus, strength) * (link_east * link_south);
        let north_east = sliding_share(east, north, talus, strength) * (link_east * link_north);
        let south_west = sliding_share(west, south, talus, strength) * (link_west * link_south);
        let north_west = sliding_share(west, north, talus, strength) * (link_west * link_north);
        share_east = south_east + north_east;
        share_west = south_west + north_west;
        share_south = south_east + south_west;
        share_north = north_east + north_west;
    }
}

kernel! {
    /// The symmetric scheme: each edge slides by the mean of the triangles at its two ends.
    pub(crate) struct MeanSlide {
        reads {
            ground, ground_east, ground_south, share_east, share_west_east, share_south, share_north_south,
        }
        writes { to_east, to_south }
    }
    fn cell() {
        to_east = (ground - ground_east) * ((share_east + share_west_east) * 0.25);
        to_south = (ground - ground_south) * ((share_south + share_north_south) * 0.25);
    }
}

kernel! {
    /// Adds what came and takes what went.
    pub(crate) struct Apply {
        reads { before, to_east, to_east_west, to_south, to_south_north }
        writes { change }
    }
    fn cell() {
        change = before + ((to_east_west - to_east) + (to_south_north - to_south));
    }
}

impl Slide {
    /// The method, with its equations in their order.
    pub(crate) fn new(scheme: Scheme, constants: SlideConstants) -> Self {
        let mut equations = Equations::new(&["base"], &[("settled", "change")], &constants);
        equations.kernel_on::<Ground>(&[("change", "settled")]);
        match scheme {
            Scheme::Axis => equations.kernel::<Axis>(),
            Scheme::Isotropic => equations.kernel::<Triangle>(),
            Scheme::IsotropicSymmetric => equations.kernel::<FourTriangles>().kernel::<MeanSlide>(),
        };
        equations.kernel_on::<Apply>(&[("before", "settled")]);
        equations.count("SCHEME", scheme as usize).pass("slide", include_str!("thermal.wgsl"));
        Self { constants, pipeline: equations.finish() }
    }
}

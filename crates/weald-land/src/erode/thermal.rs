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

mod program;

use super::sweep::Sweep;
use weald_core::choices;
use weald_engine::kernel;
use weald_engine::stencil::ring::Ring;
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slide {
    pub(crate) scheme: Scheme,
    pub(crate) constants: SlideConstants,
}

kernel! {
    /// Ground of a row.
    pub(crate) struct Ground {
        reads { base, change }
        updates {}
        writes { ground }
        constants {}
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
        updates {}
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
        updates {}
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
        updates {}
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
        reads { ground, ground_east, ground_south, from_west, from_east, from_north, from_south }
        updates {}
        writes { to_east, to_south }
        constants {}
    }
    fn cell() {
        to_east = (ground - ground_east) * ((from_west + from_east) * 0.25);
        to_south = (ground - ground_south) * ((from_north + from_south) * 0.25);
    }
}

kernel! {
    /// Adds what came and takes what went.
    pub(crate) struct Apply {
        reads { before, to_east, from_west, to_south, from_north }
        updates {}
        writes { change }
        constants {}
    }
    fn cell() {
        change = before + ((from_west - to_east) + (from_north - to_south));
    }
}

/// Rows in flight within the sliding.
pub(crate) struct SlideScratch {
    ground: Ring,
    shares: [Ring; 4],
    to_east: Ring,
    to_south: Ring,
    still: Ring,
}

impl SlideScratch {
    pub(crate) fn new(columns: usize) -> Self {
        let ring = |depth| Ring::new(columns, depth);
        Self {
            ground: ring(3),
            shares: [ring(2), ring(2), ring(2), ring(2)],
            to_east: ring(1),
            to_south: ring(2),
            still: Ring::still(columns),
        }
    }
}

/// What the sliding reads.
pub(crate) struct SlideRows<'a> {
    pub(crate) base: &'a Ring,
    pub(crate) change: &'a Ring,
    pub(crate) sweep: Sweep<'a>,
}

impl Slide {
    /// Rows by which the output lies behind the newest input.
    pub(crate) fn lag(self) -> usize {
        match self.scheme {
            Scheme::Axis | Scheme::Isotropic => 1,
            Scheme::IsotropicSymmetric => 2,
        }
    }

    /// Slides the next row that is ready.
    pub(crate) fn advance(self, rows: &SlideRows<'_>, scratch: &mut SlideScratch, output: &mut Ring) {
        if let Some(y) = rows.sweep.behind(0) {
            let ground = scratch.ground.here_mut(y);
            Ground { base: rows.base.here(y), change: rows.change.here(y), ground }.run(rows.sweep.arch);
        }
        if self.scheme == Scheme::IsotropicSymmetric
            && let Some(y) = rows.sweep.behind(1)
        {
            self.four_triangles(rows, scratch, y);
        }
        if let Some(y) = rows.sweep.behind(self.lag()) {
            match self.scheme {
                Scheme::Axis | Scheme::Isotropic => self.forward(rows, scratch, y),
                Scheme::IsotropicSymmetric => mean_slide(rows, scratch, y),
            }
            apply(rows, scratch, y, output);
        }
    }

    /// What slides from row `y` by one of the kernels that look east and south alone.
    fn forward(self, rows: &SlideRows<'_>, scratch: &mut SlideScratch, y: usize) {
        let links = rows.sweep.links(y);
        macro_rules! slide {
            ($Kernel:ident) => {
                $Kernel {
                    ground: scratch.ground.here(y),
                    ground_east: scratch.ground.east(y),
                    ground_south: scratch.ground.here(rows.sweep.next(y)),
                    link_east: links.east,
                    link_south: links.south,
                    to_east: scratch.to_east.here_mut(y),
                    to_south: scratch.to_south.here_mut(y),
                    talus: self.constants.talus,
                    strength: self.constants.strength,
                }
                .run(rows.sweep.arch)
            };
        }
        if self.scheme == Scheme::Axis { slide!(Axis) } else { slide!(Triangle) }
    }

    fn four_triangles(self, rows: &SlideRows<'_>, scratch: &mut SlideScratch, y: usize) {
        let links = rows.sweep.links(y);
        let [share_east, share_west, share_south, share_north] = &mut scratch.shares;
        let previous = rows.sweep.previous(y);
        FourTriangles {
            ground: scratch.ground.here(y),
            ground_east: scratch.ground.east(y),
            ground_west: scratch.ground.west(y),
            ground_south: scratch.ground.here(rows.sweep.next(y)),
            ground_north: scratch.ground.here(previous),
            link_east: links.east,
            link_west: links.west,
            link_south: links.south,
            link_north: links.north,
            share_east: share_east.here_mut(y),
            share_west: share_west.here_mut(y),
            share_south: share_south.here_mut(y),
            share_north: share_north.here_mut(y),
            talus: self.constants.talus,
            strength: self.constants.strength,
        }
        .run(rows.sweep.arch);
    }
}

fn mean_slide(rows: &SlideRows<'_>, scratch: &mut SlideScratch, y: usize) {
    let [share_east, share_west, share_south, share_north] = &scratch.shares;
    MeanSlide {
        ground: scratch.ground.here(y),
        ground_east: scratch.ground.east(y),
        ground_south: scratch.ground.here(rows.sweep.next(y)),
        from_west: share_east.here(y),
        from_east: share_west.east(y),
        from_north: share_south.here(y),
        from_south: share_north.here(rows.sweep.next(y)),
        to_east: scratch.to_east.here_mut(y),
        to_south: scratch.to_south.here_mut(y),
    }
    .run(rows.sweep.arch);
}

fn apply(rows: &SlideRows<'_>, scratch: &SlideScratch, y: usize, output: &mut Ring) {
    let SlideScratch { to_east, to_south, still, .. } = scratch;
    let from_north = if y > rows.sweep.span.start { to_south.here(y - 1) } else { still.here(0) };
    Apply {
        before: rows.change.here(y),
        to_east: to_east.here(y),
        from_west: to_east.west(y),
        to_south: to_south.here(y),
        from_north,
        change: output.here_mut(y),
    }
    .run(rows.sweep.arch);
}

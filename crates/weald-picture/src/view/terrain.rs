//! The ground with its water and edges, and what a ray meets of it.
//!
//! World coordinates are metres: east and north of the north-western corner, and up from the lowest ground, heights
//! times the exaggeration. What a ray meets is found on the very surface that is shaded.

use std::sync::Arc;

use super::pyramid::{Line, Pyramid};
use super::surface::Surface;
use super::vector::{Vector, add, scale, unit};
use crate::texture::smoothed;
use weald_core::grid::{Field, Size};

/// Gaps, in cells, of the smoothings after which an edge shows its direction.
const OUTLINE: [usize; 4] = [1, 2, 4, 8];

/// The ground.
#[derive(Debug)]
pub(super) struct Terrain {
    /// Side of a cell eastward and southward, in metres.
    pub(super) spacing: [f32; 2],
    /// What light falls on: the ground, or the lake over it.
    pub(super) top: Arc<Surface>,
    /// Share of land; `None` where all is land.
    pub(super) land: Option<Surface>,
    /// The same, smoothed: sides that follow the steps of a slanted edge are lit as one.
    pub(super) outline: Option<Surface>,
    /// Height of the plain that the landscape stands on, below 0.
    pub(super) base: f32,
    pub(super) pyramid: Pyramid,
}

/// A ray of light, backwards: from the eye.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Where it starts.
    pub from: [f32; 3],
    /// Where it leads, of length 1.
    pub direction: [f32; 3],
}

impl Ray {
    /// The point so many metres from the start.
    #[inline(always)]
    pub fn at(&self, ray_length: f32) -> [f32; 3] {
        add(self.from, scale(self.direction, ray_length))
    }
}

/// What a ray met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit {
    /// Metres from the start of the ray.
    pub(super) ray_length: f32,
    /// Place on the surface, in cells.
    pub(super) place: [f32; 2],
    /// The normal of the cut where the ray met a side of the landscape.
    pub(super) side: Option<Vector>,
}

/// The share of land, smoothed, with none beyond the border: where a wedge without data runs out at the border, the edge
/// goes on along it and does not turn.
fn outline(land: &Field) -> Field {
    let (size, margin) = (land.size(), OUTLINE.into_iter().sum::<usize>() + 1);
    let wider = Size { columns: size.columns + 2 * margin, rows: size.rows + 2 * margin };
    let padded = Field::from_function(wider, |x, y| {
        let inside = |at: usize, cells: usize| (margin..margin + cells).contains(&at);
        let is_inside = inside(x, size.columns) && inside(y, size.rows);
        if is_inside { land.at(x - margin, y - margin) } else { 0.0 }
    });
    let smooth = OUTLINE.into_iter().fold(padded, |land, gap| smoothed(&land, gap));
    Field::from_function(size, |x, y| smooth.at(x + margin, y + margin))
}

impl Terrain {
    pub(super) fn new(spacing: [f32; 2], top: Arc<Surface>, land: Option<Field>, base: f32) -> Self {
        let outline = land.as_ref().map(|land| Surface::new(&outline(land)));
        let land = land.map(|land| Surface::new(&land));
        let is_empty = |x: usize, y: usize| {
            land.as_ref()
                .is_some_and(|land| land.patch(x, y).into_iter().flatten().all(|&share| share <= 0.0))
        };
        let pyramid = Pyramid::new(&top, is_empty);
        Self { spacing, top, land, outline, base, pyramid }
    }

    /// The highest point that anything may have.
    pub(super) fn highest(&self) -> f32 {
        self.pyramid.highest().max(0.0)
    }

    /// The place below or above a point.
    #[inline(always)]
    pub(super) fn place(&self, point: Vector) -> [f32; 2] {
        [0.5 + point[0] / self.spacing[0], 0.5 - point[1] / self.spacing[1]]
    }

    /// The point of a place at a height.
    pub(super) fn point(&self, place: [f32; 2], height: f32) -> Vector {
        [(place[0] - 0.5) * self.spacing[0], (0.5 - place[1]) * self.spacing[1], height]
    }

    /// Whether a place is land of this landscape.
    pub(super) fn is_valid(&self, place: [f32; 2]) -> bool {
        let size = self.top.size();
        let inside = |at: f32, cells: usize| at >= 0.5 && at <= cells as f32 + 0.5;
        inside(place[0], size.columns) && inside(place[1], size.rows) && self.has_data(place)
    }

    pub(super) fn has_data(&self, place: [f32; 2]) -> bool {
        self.land.as_ref().is_none_or(|land| land.at(place) >= 0.5)
    }

    /// The upward normal of length 1 of a surface that rises so many metres a cell.
    #[inline(always)]
    pub(super) fn normal(&self, [east, south]: [f32; 2]) -> Vector {
        unit([-east / self.spacing[0], south / self.spacing[1], 1.0])
    }

    /// The line over which a direction leads.
    #[inline(always)]
    pub(super) fn line(&self, from: Vector, direction: Vector) -> Line {
        let step = [direction[0] / self.spacing[0], -direction[1] / self.spacing[1]];
        Line { start: self.place(from), step }
    }

    /// The smaller side of a cell in metres.
    pub(super) fn cell(&self) -> f32 {
        self.spacing[0].min(self.spacing[1])
    }

    /// Whether the patch of a place is partly no land.
    #[inline(always)]
    pub(super) fn is_edge(&self, place: [f32; 2]) -> bool {
        let Some(land) = &self.land else { return false };
        let [columns, rows] = land.patches();
        let x = (place[0].max(0.0) as usize).min(columns - 1);
        let y = (place[1].max(0.0) as usize).min(rows - 1);
        land.patch(x, y).into_iter().flatten().any(|&share| share < 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::random::{hash2, unit as uniform};

    const CELL: f32 = 10.0;

    fn surface(size: Size, height: impl FnMut(usize, usize) -> f32) -> Arc<Surface> {
        Arc::new(Surface::new(&Field::from_function(size, height)))
    }

    fn terrain(side: usize, height: impl FnMut(usize, usize) -> f32, land: Option<Field>) -> Terrain {
        let size = Size::square(side).expect("small");
        Terrain::new([CELL; 2], surface(size, height), land, -30.0)
    }

    fn random(seed: u64, at: i64) -> f32 {
        uniform(hash2(seed, at, 7)) as f32
    }

    /// A ray from somewhere above a landscape of that side to somewhere on it.
    fn ray(side: usize, at: i64) -> Ray {
        let extent = side as f32 * CELL;
        let place = |seed: u64| extent * (1.6 * random(seed, at) - 0.3);
        let from = [place(1), -place(2), 40.0 + 120.0 * random(3, at)];
        let onto = [extent * random(4, at), -extent * random(5, at), 20.0 * random(6, at)];
        Ray { from, direction: unit([onto[0] - from[0], onto[1] - from[1], onto[2] - from[2]]) }
    }

    #[test]
    fn rays_meet_random_ground_where_the_finest_steps_do() {
        let ground = terrain(24, |x, y| 40.0 * random(9, (24 * y + x) as i64), None);
        let mut met = 0;
        for at in 0..3000 {
            let ray = ray(24, at);
            let line = ground.line(ray.from, ray.direction);
            let above = |ray_length: f32| ray.at(ray_length)[2] - ground.top.at(line.at(ray_length));
            let Some([enter, leave]) = line.crossing(&ground.top) else { continue };
            let enter = enter.max(0.0);
            let steps = ((leave - enter) / 0.05) as usize;
            let stepped = (0..steps)
                .map(|step| enter + 0.05 * step as f32)
                .find(|&ray_length| above(ray_length) <= 0.0);
            let hit = ground.trace(&ray, [0.0, f32::INFINITY]);
            match (stepped, hit) {
                (Some(stepped), Some(hit)) => {
                    met += 1;
                    // Two centimetres of height are more than the error of a hit, and much way where a ray grazes.
                    let early = hit.ray_length <= stepped + 0.02 || above(stepped) > -0.02;
                    assert!(early, "ray {at}: {} m instead of {stepped} m", hit.ray_length);
                    // Where the ray only grazes a crest the steps may have missed it.
                    assert!(
                        hit.side.is_some() || above(hit.ray_length).abs() < 0.02,
                        "ray {at}: {} m off",
                        above(hit.ray_length)
                    );
                    assert!(
                        hit.ray_length > stepped - 0.1 || above(hit.ray_length + 0.02) < 0.02,
                        "ray {at}"
                    );
                }
                (None, None) => {}
                (None, Some(hit)) => {
                    assert!(
                        above(hit.ray_length).abs() < 0.02 || ray.at(hit.ray_length)[2] < 0.0,
                        "ray {at}"
                    );
                }
                (Some(stepped), None) => {
                    assert!(ray.at(stepped)[2] < ground.base, "ray {at} missed the ground at {stepped} m");
                }
            }
        }
        assert!(met > 1800, "{met} rays met the ground");
    }

    #[test]
    fn a_ray_that_cuts_a_crest_by_a_centimetre_meets_it() {
        for lee in [5.0_f32, 12.0, 20.0, 28.0] {
            let ridge =
                terrain(24, |x, _| [30.0, 40.0, lee].get(x.wrapping_sub(11)).copied().unwrap_or(0.0), None);
            let crest =
                (0..24_000).map(|at| ridge.top.at([at as f32 * 1e-3 + 0.5, 12.0])).fold(0.0, f32::max);
            let ray = |below: f32| Ray { from: [-50.0, -115.0, crest - below], direction: [1.0, 0.0, 0.0] };
            let met = |below: f32| ridge.trace(&ray(below), [0.0, f32::INFINITY]).is_some();
            assert!(met(0.01), "behind the crest the ground falls to {lee} m");
            assert!(!met(-0.01));
        }
    }

    #[test]
    fn a_ray_meets_a_tilted_plane_where_geometry_says() {
        let plane = terrain(40, |x, y| 2.0 * x as f32 + y as f32, None);
        for at in 0..100 {
            let ray = Ray {
                from: [200.0, -200.0, 300.0],
                direction: unit([random(1, at) - 0.5, random(2, at) - 0.5, -0.8]),
            };
            let hit = plane.trace(&ray, [0.0, f32::INFINITY]).expect("it looks down");
            // Height = 0.2 east + 0.1 south of the centre of the first cell.
            let rise = |v: Vector| 0.2 * v[0] - 0.1 * v[1] - v[2];
            let expected = -(rise(ray.from) - 1.5) / rise(ray.direction);
            assert!((hit.ray_length - expected).abs() < 0.03, "{} m instead of {expected} m", hit.ray_length);
        }
    }

    #[test]
    fn a_cliff_throws_a_shadow_as_long_as_its_height_over_the_tangent_of_the_sun() {
        let cliff = terrain(200, |x, _| if x < 40 { 300.0 } else { 0.0 }, None);
        for altitude in [15.0_f64, 25.0, 40.0] {
            let sun = crate::view::vector::towards(270.0, altitude);
            let steep = libm::tan(altitude.to_radians()) as f32;
            let dark = |metres: f32| {
                let from = [400.0 + metres, -1000.0, 0.0];
                cliff.horizon(from, sun, [0.5 * steep, 2.0 * steep]) > steep
            };
            let end = (0..1500).find(|&metres| metres > 30 && !dark(metres as f32)).expect("the shadow ends");
            let expected = 300.0 / steep;
            assert!((end as f32 - expected).abs() < 1.5 * CELL, "{end} m instead of {expected} m");
        }
    }

    #[test]
    fn what_has_no_data_is_never_met() {
        let size = Size::square(24).expect("small");
        let is_valid =
            |x: usize, y: usize| (x as f32 - 11.5).hypot(y as f32 - 11.5) < 8.0 && (x, y) != (12, 12);
        let land = Field::from_function(size, |x, y| f32::from(u8::from(is_valid(x, y))));
        let ground = terrain(24, |x, y| 60.0 * random(9, (24 * y + x) as i64), Some(land));
        let (mut met, mut sides) = (0, 0);
        for at in 0..400 {
            let Some(hit) = ground.trace(&ray(24, at), [0.0, f32::INFINITY]) else { continue };
            met += 1;
            sides += usize::from(hit.side.is_some());
            assert!(ground.is_valid(hit.place), "ray {at} met {:?}", hit.place);
        }
        assert!(met > 60 && sides > 10, "{met} met, {sides} of them sides");
    }

    #[test]
    fn the_edge_of_a_wedge_without_data_faces_away_from_the_land_up_to_its_tip() {
        let size = Size::new(120, 60).expect("small");
        // The northern border, from which a wedge of three cells is cut off, that runs out after 90.
        let land = Field::from_function(size, |x, y| f32::from(u8::from(y as f32 >= 3.0 - x as f32 / 30.0)));
        let ground = Terrain::new([CELL; 2], surface(size, |_, _| 5.0), Some(land), -30.0);
        let outline = ground.outline.expect("there is an edge");
        for x in [20.0, 45.0, 70.0, 88.0, 95.0] {
            let [_, east, south] = outline.with_slope([x, 1.0]);
            assert!(south > 0.0 && east.abs() < 0.2 * south, "at {x} it rises by {east} and {south}");
        }
    }

    #[test]
    fn a_ray_from_outside_meets_the_side_that_faces_it() {
        let ground = terrain(12, |_, _| 5.0, None);
        for (from, normal) in [
            ([-50.0, -60.0], [-1.0, 0.0, 0.0]),
            ([170.0, -60.0], [1.0, 0.0, 0.0]),
            ([60.0, 50.0], [0.0, 1.0, 0.0]),
            ([60.0, -170.0], [0.0, -1.0, 0.0]),
        ] {
            let [x, y] = from;
            let ray = Ray { from: [x, y, 0.0], direction: unit([60.5 - x, -60.5 - y, -1.0]) };
            let hit = ground.trace(&ray, [0.0, f32::INFINITY]).expect("the side is met");
            assert_eq!(hit.side, Some(normal), "from {from:?}");
        }
    }
}

//! Where a ray meets the ground within a patch.
//!
//! The height of the ray above the spline is looked at in four places and at the lowest points of the parabolas through
//! them; where it changes its sign, the root is closed in on by false position (the Illinois variant: Dowell and Jarratt
//! 1971, doi 10.1007/BF01934364). In patches on the edge of the land, being inside it is looked at and halved instead.

use super::pyramid::{Line, LineSearch};
use super::terrain::{Hit, Ray, Terrain};
use super::vector::{Vector, unit};

/// Error of a hit, as a share of the side of a cell.
pub(super) const CLOSE: f32 = 5e-4;

/// Most steps of false position.
const STEPS: usize = 24;

/// Halvings that find the edge of the land.
const HALVINGS: usize = 16;

/// Pieces of a patch in each of which the ray's height above the ground is taken as a parabola.
const PIECES: usize = 2;

/// Looks into each patch that the edge of the land crosses.
const EDGE_SAMPLES: usize = 6;

impl Terrain {
    /// What a ray meets of the landscape between two ways.
    pub(super) fn trace(&self, ray: &Ray, [near, far]: [f32; 2]) -> Option<Hit> {
        let line = self.line(ray.from, ray.direction);
        let [enter, leave] = line.crossing(&self.top)?;
        let [start, end] = self.below_the_highest(ray, [near.max(enter), far.min(leave)])?;
        if start == enter {
            let place = line.at(start);
            let height = ray.at(start)[2];
            if height < self.top.at(place) && height >= self.base && self.has_data(place) {
                return Some(Hit { ray_length: start, place, side: Some(self.rim_normal(place)) });
            }
        }
        let mut seeker = RayIntersection { terrain: self, ray, line: &line, hit: None };
        self.pyramid.follow(&line, [start, end], &mut seeker);
        seeker.hit.filter(|hit| ray.at(hit.ray_length)[2] >= self.base)
    }

    /// The part of a span in which a ray is between the base and the highest ground.
    fn below_the_highest(&self, ray: &Ray, [mut near, mut far]: [f32; 2]) -> Option<[f32; 2]> {
        let (height, rise) = (ray.from[2], ray.direction[2]);
        let to_top = (self.highest() - height) / rise;
        let to_base = (self.base - height) / rise;
        if rise > 0.0 {
            far = far.min(to_top);
            near = near.max(to_base);
        } else if rise < 0.0 {
            near = near.max(to_top);
            far = far.min(to_base);
        } else if height > self.highest() {
            return None;
        }
        (near < far).then_some([near, far])
    }

    /// The outward normal of the outer side that a place lies on.
    fn rim_normal(&self, place: [f32; 2]) -> Vector {
        let size = self.top.size();
        let sides = [
            (place[0] - 0.5, [-1.0, 0.0, 0.0]),
            (size.columns as f32 + 0.5 - place[0], [1.0, 0.0, 0.0]),
            (place[1] - 0.5, [0.0, 1.0, 0.0]),
            (size.rows as f32 + 0.5 - place[1], [0.0, -1.0, 0.0]),
        ];
        let nearest = sides.into_iter().min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
        nearest.map_or([0.0, 0.0, 1.0], |(_, normal)| normal)
    }
}

/// Looks for the first intersection of a ray with the ground.
pub(super) struct RayIntersection<'a> {
    pub(super) terrain: &'a Terrain,
    pub(super) ray: &'a Ray,
    pub(super) line: &'a Line,
    pub(super) hit: Option<Hit>,
}

impl RayIntersection<'_> {
    #[inline(always)]
    fn height(&self, ray_length: f32) -> f32 {
        self.ray.from[2] + self.ray.direction[2] * ray_length
    }

    /// Height of the ray above the ground.
    #[inline(always)]
    fn above(&self, ray_length: f32) -> f32 {
        self.height(ray_length) - self.terrain.top.at(self.line.at(ray_length))
    }

    /// A span at whose end the ray is below the ground, and at whose start above it.
    fn bracket(&self, [near, far]: [f32; 2]) -> Option<[(f32, f32); 2]> {
        let mut before = (near, self.above(near));
        if before.1 <= 0.0 {
            return Some([before, before]);
        }
        let piece = (far - near) / PIECES as f32;
        for look in 0..PIECES {
            let at = |share: f32| {
                let ray_length = near + (look as f32 + share) * piece;
                (ray_length, self.above(ray_length))
            };
            let (middle, last) = (at(0.5), at(1.0));
            if middle.1 <= 0.0 {
                return Some([before, middle]);
            }
            if let Some(dip) = self.dip([before, middle, last]) {
                return Some([if dip.0 < middle.0 { before } else { middle }, dip]);
            }
            if last.1 <= 0.0 {
                return Some([middle, last]);
            }
            before = last;
        }
        None
    }

    /// The lowest point of the parabola through three places, if the ray is below the ground there.
    fn dip(&self, [first, middle, last]: [(f32, f32); 3]) -> Option<(f32, f32)> {
        let bend = first.1 - 2.0 * middle.1 + last.1;
        let turn = 0.5 * (first.1 - last.1) / bend;
        if bend <= 0.0 || turn.abs() >= 1.0 {
            return None;
        }
        let ray_length = middle.0 + turn * (last.0 - middle.0);
        let above = self.above(ray_length);
        (above <= 0.0).then_some((ray_length, above))
    }

    fn is_inside(&self, ray_length: f32) -> bool {
        self.above(ray_length) <= 0.0 && self.terrain.has_data(self.line.at(ray_length))
    }

    /// The first way within a patch on the edge of the land at which the ray is in the ground.
    fn enter_edge(&self, [near, far]: [f32; 2]) -> Option<f32> {
        let at = |look: usize| near + (far - near) * look as f32 / EDGE_SAMPLES as f32;
        let first = (0..=EDGE_SAMPLES).find(|&look| self.is_inside(at(look)))?;
        let (mut outside, mut inside) = (at(first.saturating_sub(1)), at(first));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (outside + inside);
            if self.is_inside(middle) { inside = middle } else { outside = middle }
        }
        Some(inside)
    }

    /// The normal of the edge where the ray passed it below the surface.
    fn edge_normal(&self, ray_length: f32) -> Option<Vector> {
        let outline = self.terrain.outline.as_ref()?;
        if self.above(ray_length) > -40.0 * CLOSE * self.terrain.cell() {
            return None;
        }
        let [_, east, south] = outline.with_slope(self.line.at(ray_length));
        let outward = [-east / self.terrain.spacing[0], south / self.terrain.spacing[1], 0.0];
        (outward[0] != 0.0 || outward[1] != 0.0).then(|| unit(outward))
    }
}

/// The root between a length above the ground and one below it by false position, each with its height; so close that the
/// height there is less than a tolerance.
#[inline(always)]
pub(super) fn close_in(
    [mut near, mut far]: [(f32, f32); 2],
    tolerance: f32,
    above: impl Fn(f32) -> f32,
) -> f32 {
    for _ in 0..STEPS {
        if near.1 - far.1 <= 0.0 {
            break;
        }
        let ray_length = near.0 + (far.0 - near.0) * near.1 / (near.1 - far.1);
        let height = above(ray_length);
        if height.abs() < tolerance {
            return ray_length;
        }
        if height > 0.0 {
            near = (ray_length, height);
            far.1 *= 0.5;
        } else {
            far = (ray_length, height);
            near.1 *= 0.5;
        }
    }
    far.0
}

impl LineSearch for RayIntersection<'_> {
    #[inline(always)]
    fn may_find(&self, [near, far]: [f32; 2], highest: f32) -> bool {
        self.height(near).min(self.height(far)) <= highest
    }

    #[inline(always)]
    fn look(&mut self, span: [f32; 2]) -> bool {
        if self.terrain.is_edge(self.line.at(0.5 * (span[0] + span[1]))) {
            let Some(ray_length) = self.enter_edge(span) else { return false };
            self.hit =
                Some(Hit { ray_length, place: self.line.at(ray_length), side: self.edge_normal(ray_length) });
            return true;
        }
        let Some(bracket) = self.bracket(span) else { return false };
        let tolerance = CLOSE * self.terrain.cell();
        let ray_length = close_in(bracket, tolerance, |ray_length| self.above(ray_length));
        self.hit = Some(Hit { ray_length, place: self.line.at(ray_length), side: None });
        true
    }
}

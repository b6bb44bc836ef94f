//! The ground with its water and edges, and what a ray meets of it.
//!
//! World coordinates are metres: east and north of the north-western corner, and up from the lowest ground, heights
//! times the exaggeration. What a ray meets is found on the very surface that is shaded: in each patch the height of
//! the ray above the spline is looked at in both halves and at the lowest point of the parabola through them, and its
//! root is closed in on by false position (the Illinois variant).

use super::pyramid::{Line, Pyramid, Seeker};
use super::surface::Surface;
use super::vector::{Vector, add, scale, unit};

/// Error of a hit, as a share of the side of a cell.
const CLOSE: f32 = 5e-4;

/// Most steps of false position.
const STEPS: usize = 24;

/// Halvings that find the edge of the land.
const HALVINGS: usize = 16;

/// Looks into each patch that the edge of the land crosses.
const EDGE_LOOKS: usize = 6;

/// The ground.
#[derive(Debug)]
pub(super) struct Terrain {
    /// Side of a cell eastward and southward, in metres.
    pub(super) spacing: [f32; 2],
    /// What light falls on: the ground, or the lake over it.
    pub(super) top: Surface,
    /// Share of land; `None` where all is land.
    pub(super) land: Option<Surface>,
    /// Height of the plain that the landscape stands on, below 0.
    pub(super) base: f32,
    pyramid: Pyramid,
}

/// A ray of light, backwards: from the eye.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    pub(super) from: Vector,
    /// Of length 1.
    pub(super) direction: Vector,
}

impl Ray {
    #[inline(always)]
    pub(super) fn at(&self, way: f32) -> Vector {
        add(self.from, scale(self.direction, way))
    }
}

/// What a ray met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit {
    /// Metres from the start of the ray.
    pub(super) way: f32,
    /// Place on the surface, in cells.
    pub(super) place: [f32; 2],
    /// The normal of the cut where the ray met a side of the landscape.
    pub(super) side: Option<Vector>,
}

impl Terrain {
    pub(super) fn new(spacing: [f32; 2], top: Surface, land: Option<Surface>, base: f32) -> Self {
        let is_empty = |x: usize, y: usize| {
            land.as_ref()
                .is_some_and(|land| land.patch(x, y).into_iter().flatten().all(|&share| share <= 0.0))
        };
        let pyramid = Pyramid::new(&top, is_empty);
        Self { spacing, top, base, pyramid, land }
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
    pub(super) fn is_land(&self, place: [f32; 2]) -> bool {
        let size = self.top.size();
        let inside = |at: f32, cells: usize| at >= 0.5 && at <= cells as f32 + 0.5;
        inside(place[0], size.columns) && inside(place[1], size.rows) && self.has_data(place)
    }

    fn has_data(&self, place: [f32; 2]) -> bool {
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

    /// What a ray meets of the landscape between two ways.
    pub(super) fn trace(&self, ray: &Ray, [near, far]: [f32; 2]) -> Option<Hit> {
        let line = self.line(ray.from, ray.direction);
        let [enter, leave] = line.crossing(&self.top)?;
        let [start, end] = self.below_the_highest(ray, [near.max(enter), far.min(leave)])?;
        if start == enter {
            let place = line.at(start);
            let height = ray.at(start)[2];
            if height < self.top.at(place) && height >= self.base && self.has_data(place) {
                return Some(Hit { way: start, place, side: Some(self.rim_normal(place)) });
            }
        }
        let mut seeker = Meeting { terrain: self, ray, line: &line, hit: None };
        self.pyramid.follow(&line, [start, end], &mut seeker);
        seeker.hit.filter(|hit| ray.at(hit.way)[2] >= self.base)
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

    /// The steepest rise from a point to the ground in a direction, as rise over run; a search that found more than
    /// `enough` ends, and rises of less than `least` count as that.
    pub(super) fn horizon(&self, from: Vector, direction: Vector, [least, enough]: [f32; 2]) -> f32 {
        let run = (direction[0] * direction[0] + direction[1] * direction[1]).sqrt();
        if run < 1e-6 {
            return least;
        }
        let line = self.line(from, [direction[0] / run, direction[1] / run, 0.0]);
        let Some([enter, leave]) = line.crossing(&self.top) else { return least };
        let start = enter.max(0.05 * self.cell());
        let room = (self.highest() - from[2]) / least.max(1e-6);
        let end = leave.min(room);
        let mut seeker = Rising { terrain: self, line: &line, height: from[2], steepest: least, enough };
        if start < end {
            self.pyramid.follow(&line, [start, end], &mut seeker);
        }
        seeker.steepest
    }
}

/// Looks for the first meeting of a ray with the ground.
struct Meeting<'a> {
    terrain: &'a Terrain,
    ray: &'a Ray,
    line: &'a Line,
    hit: Option<Hit>,
}

impl Meeting<'_> {
    #[inline(always)]
    fn height(&self, way: f32) -> f32 {
        self.ray.from[2] + self.ray.direction[2] * way
    }

    /// Height of the ray above the ground.
    #[inline(always)]
    fn above(&self, way: f32) -> f32 {
        self.height(way) - self.terrain.top.at(self.line.at(way))
    }

    /// A span at whose end the ray is below the ground, and at whose start above it.
    fn bracket(&self, [near, far]: [f32; 2]) -> Option<[(f32, f32); 2]> {
        let ends = [near, 0.5 * (near + far), far].map(|way| (way, self.above(way)));
        let [first, middle, last] = ends;
        if first.1 <= 0.0 {
            return Some([first, first]);
        }
        if middle.1 <= 0.0 {
            return Some([first, middle]);
        }
        let dip = self.dip(ends);
        match dip {
            Some(dip) if dip.0 < middle.0 => Some([first, dip]),
            Some(dip) => Some([middle, dip]),
            None => (last.1 <= 0.0).then_some([middle, last]),
        }
    }

    /// The lowest point of the parabola through three places, if the ray is below the ground there.
    fn dip(&self, [first, middle, last]: [(f32, f32); 3]) -> Option<(f32, f32)> {
        let bend = first.1 - 2.0 * middle.1 + last.1;
        let turn = 0.5 * (first.1 - last.1) / bend;
        if bend <= 0.0 || turn.abs() >= 1.0 {
            return None;
        }
        let way = middle.0 + turn * (last.0 - middle.0);
        let above = self.above(way);
        (above <= 0.0).then_some((way, above))
    }

    /// The root between two ways by false position.
    fn close_in(&self, [mut near, mut far]: [(f32, f32); 2]) -> f32 {
        let tolerance = CLOSE * self.terrain.cell();
        for _ in 0..STEPS {
            if near.1 - far.1 <= 0.0 {
                break;
            }
            let way = near.0 + (far.0 - near.0) * near.1 / (near.1 - far.1);
            let above = self.above(way);
            if above.abs() < tolerance {
                return way;
            }
            if above > 0.0 {
                near = (way, above);
                far.1 *= 0.5;
            } else {
                far = (way, above);
                near.1 *= 0.5;
            }
        }
        far.0
    }

    fn is_inside(&self, way: f32) -> bool {
        self.above(way) <= 0.0 && self.terrain.has_data(self.line.at(way))
    }

    /// The first way within a patch on the edge of the land at which the ray is in the ground.
    fn enter_edge(&self, [near, far]: [f32; 2]) -> Option<f32> {
        let at = |look: usize| near + (far - near) * look as f32 / EDGE_LOOKS as f32;
        let first = (0..=EDGE_LOOKS).find(|&look| self.is_inside(at(look)))?;
        let (mut outside, mut inside) = (at(first.saturating_sub(1)), at(first));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (outside + inside);
            if self.is_inside(middle) { inside = middle } else { outside = middle }
        }
        Some(inside)
    }

    /// The normal of the edge where the ray passed it below the surface.
    fn edge_normal(&self, way: f32) -> Option<Vector> {
        let land = self.terrain.land.as_ref()?;
        if self.above(way) > -40.0 * CLOSE * self.terrain.cell() {
            return None;
        }
        let [_, east, south] = land.with_slope(self.line.at(way));
        let outward = [-east / self.terrain.spacing[0], south / self.terrain.spacing[1], 0.0];
        (outward[0] != 0.0 || outward[1] != 0.0).then(|| unit(outward))
    }
}

impl Seeker for Meeting<'_> {
    #[inline(always)]
    fn may_find(&self, [near, far]: [f32; 2], highest: f32) -> bool {
        self.height(near).min(self.height(far)) <= highest
    }

    #[inline(always)]
    fn look(&mut self, span: [f32; 2]) -> bool {
        if self.terrain.is_edge(self.line.at(0.5 * (span[0] + span[1]))) {
            let Some(way) = self.enter_edge(span) else { return false };
            self.hit = Some(Hit { way, place: self.line.at(way), side: self.edge_normal(way) });
            return true;
        }
        let Some(bracket) = self.bracket(span) else { return false };
        let way = self.close_in(bracket);
        self.hit = Some(Hit { way, place: self.line.at(way), side: None });
        true
    }
}

impl Terrain {
    /// Whether the patch of a place is partly no land.
    #[inline(always)]
    fn is_edge(&self, place: [f32; 2]) -> bool {
        let Some(land) = &self.land else { return false };
        let [columns, rows] = land.patches();
        let x = (place[0].max(0.0) as usize).min(columns - 1);
        let y = (place[1].max(0.0) as usize).min(rows - 1);
        land.patch(x, y).into_iter().flatten().any(|&share| share < 1.0)
    }
}

/// Looks for the steepest rise along a line.
struct Rising<'a> {
    terrain: &'a Terrain,
    line: &'a Line,
    height: f32,
    steepest: f32,
    enough: f32,
}

impl Seeker for Rising<'_> {
    #[inline(always)]
    fn may_find(&self, [near, _]: [f32; 2], highest: f32) -> bool {
        highest - self.height > self.steepest * near
    }

    #[inline(always)]
    fn look(&mut self, [near, far]: [f32; 2]) -> bool {
        for share in [0.0_f32, 0.35, 0.7, 1.0] {
            let way = near + (far - near) * share;
            let place = self.line.at(way);
            let rise = (self.terrain.top.at(place) - self.height) / way;
            if rise > self.steepest && (self.terrain.land.is_none() || self.terrain.has_data(place)) {
                self.steepest = rise;
            }
        }
        self.steepest >= self.enough
    }
}

//! How steeply the ground rises along a line: the horizon that the sun sinks behind.

use super::pyramid::{Line, LineSearch};
use super::terrain::Terrain;
use super::vector::Vector;

impl Terrain {
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
        let mut seeker =
            HorizonSearch { terrain: self, line: &line, height: from[2], steepest: least, enough };
        if start < end {
            self.pyramid.follow(&line, [start, end], &mut seeker);
        }
        seeker.steepest
    }
}

/// Looks for the steepest rise along a line.
pub(super) struct HorizonSearch<'a> {
    pub(super) terrain: &'a Terrain,
    pub(super) line: &'a Line,
    /// Height from which it rises.
    pub(super) height: f32,
    /// The steepest rise so far.
    pub(super) steepest: f32,
    /// The rise at which the search ends.
    pub(super) enough: f32,
}

impl LineSearch for HorizonSearch<'_> {
    #[inline(always)]
    fn may_find(&self, [near, _]: [f32; 2], highest: f32) -> bool {
        highest - self.height > self.steepest * near
    }

    #[inline(always)]
    fn look(&mut self, [near, far]: [f32; 2]) -> bool {
        for share in [0.0_f32, 0.35, 0.7, 1.0] {
            let ray_length = near + (far - near) * share;
            let place = self.line.at(ray_length);
            let rise = (self.terrain.top.at(place) - self.height) / ray_length;
            if rise > self.steepest && (self.terrain.land.is_none() || self.terrain.has_data(place)) {
                self.steepest = rise;
            }
        }
        self.steepest >= self.enough
    }
}

//! What a picture shows: a fractal, what moves its points, and where it is seen from.

use std::fmt;

use super::camera::Camera;
use crate::grow::ifs::{Block, Code, Ifs, Packer, Point};

/// Moves the points of a fractal before they are drawn: a deformation, the wind, several of them in turn.
pub type Motion<'a> = dyn Fn(Point, &Code) -> Point + Sync + 'a;

/// A fractal to be drawn.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// The fractal.
    pub ifs: &'a Ifs,
    /// What moves its points; points without it cost no codes.
    pub motion: Option<&'a Motion<'a>>,
    /// Where it is seen from.
    pub camera: Camera,
    /// Whether the camera stands in front of a fractal of the plane.
    pub frontal: bool,
    /// Seed of random iteration.
    pub seed: u64,
}

impl Subject<'_> {
    /// What packs the codes of its points, where something moves them.
    pub(super) fn packer(&self) -> Option<Packer> {
        self.motion.map(|_| Packer::of(self.ifs))
    }

    /// Where a point of the game is seen: right, up, nearer. Of points that move, the block has been packed.
    #[inline]
    pub(super) fn seen(&self, block: &Block, number: usize, packer: Option<&Packer>) -> Point {
        let at = block.point(number).map(f64::from);
        let at = match self.motion.zip(packer) {
            Some((motion, packer)) => motion(at, &packer.code(number)),
            None => at,
        };
        self.camera.seen(at)
    }

    /// Where a point with a code is seen.
    #[inline]
    pub(super) fn seen_at(&self, at: Point, code: &Code) -> Point {
        self.camera.seen(self.motion.map_or(at, |motion| motion(at, code)))
    }
}

impl fmt::Debug for Subject<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let moved = if self.motion.is_some() { ", moved" } else { "" };
        write!(formatter, "Subject({}{moved})", self.ifs.name())
    }
}

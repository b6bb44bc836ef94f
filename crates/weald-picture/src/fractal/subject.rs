//! What a picture shows: a fractal, what moves its points, and where it is seen from.

use std::fmt;

use super::camera::Camera;
use weald_plants::ifs::lanes::LANES;
use weald_plants::ifs::{Block, Code, Ifs, Packer, Point};

/// Moves the points of a fractal before they are drawn: a deformation, the wind, several of them in turn.
pub trait Motion: Sync {
    /// Where a point with that code goes.
    fn moved(&self, point: Point, code: &Code) -> Point;

    /// Where a row of points of the game goes, whose codes are packed.
    fn row(&self, block: &Block, row: usize, packer: &Packer) -> [[f64; LANES]; 3] {
        let mut moved = [[0.0; LANES]; 3];
        for lane in 0..LANES.min(block.len() - row * LANES) {
            let number = row * LANES + lane;
            let point = self.moved(block.point(number).map(f64::from), &packer.code(number));
            for (axis, x) in moved.iter_mut().zip(point) {
                axis[lane] = x;
            }
        }
        moved
    }
}

impl<F: Fn(Point, &Code) -> Point + Sync> Motion for F {
    fn moved(&self, point: Point, code: &Code) -> Point {
        self(point, code)
    }
}

/// A fractal to be drawn.
#[derive(Clone, Copy)]
pub struct Subject<'a> {
    /// The fractal.
    pub ifs: &'a Ifs,
    /// What moves its points; points without it cost no codes.
    pub motion: Option<&'a dyn Motion>,
    /// Where it is seen from.
    pub camera: Camera,
    /// Whether the camera stands in front of a 2D fractal.
    pub frontal: bool,
    /// Seed of random iteration.
    pub seed: u64,
}

impl Subject<'_> {
    /// What packs the codes of its points, where something moves them.
    pub(super) fn packer(&self) -> Option<Packer> {
        self.motion.map(|_| Packer::of(self.ifs))
    }

    /// Where the points of a row of the game are seen: right, up, nearer. Of points that move, the block has been
    /// packed.
    #[inline]
    pub(super) fn seen(
        &self,
        block: &Block,
        row: usize,
        packer: Option<&Packer>,
    ) -> impl Iterator<Item = Point> {
        let at = match self.motion.zip(packer) {
            Some((motion, packer)) => motion.row(block, row, packer),
            None => block.rows()[row].map(|axis| axis.map(f64::from)),
        };
        let lanes = LANES.min(block.len() - row * LANES);
        let camera = self.camera;
        (0..lanes).map(move |lane| camera.seen(at.each_ref().map(|axis| axis[lane])))
    }

    /// Where a point with a code is seen.
    #[inline]
    pub(super) fn seen_at(&self, at: Point, code: &Code) -> Point {
        self.camera.seen(self.motion.map_or(at, |motion| motion.moved(at, code)))
    }
}

impl fmt::Debug for Subject<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let moved = if self.motion.is_some() { ", moved" } else { "" };
        write!(formatter, "Subject({}{moved})", self.ifs.name())
    }
}

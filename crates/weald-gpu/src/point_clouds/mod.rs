//! Fractals on a device: clouds of points, at rest or swaying in the wind.

mod blades;
mod limbs;
mod pass;
mod play;
mod points;
mod rates;

pub use blades::grow_blades;
pub use limbs::{Swayed, bend_limbs};
pub use rates::PointRates;

use weald::Error;
use weald::engine::uniform::Uniform;
use weald::grow::ifs::device::{digits_on_a_device, packed, unpacked};
use weald::grow::ifs::wind::SWAY;
use weald::grow::ifs::{Code, Digits, Game, Ifs, Pose, Sway};
use wgpu::BindGroup;

use crate::gpu::Gpu;
use crate::memory::Store;
use crate::slots::Slots;
use pass::{Pass, Work};
use play::Play;
use points::{BYTES, Points, fours};

/// Points of a fractal on a device, made there by random iteration.
#[derive(Debug)]
pub struct PointCloud {
    points: Points,
}

impl PointCloud {
    /// The first `count` points of the [`Game`] with that seed: the same digits as on the CPU, and the same points to
    /// rounding. A point takes 16 bytes.
    ///
    /// # Errors
    /// [`Error::Device`] where the device's memory does not hold them, or it fails.
    pub fn new(gpu: &Gpu, ifs: &Ifs, seed: u64, count: u64) -> Result<Self, Error> {
        let mut points = Points::new(gpu, count, false, BYTES)?;
        Play::new(gpu, Game::new(ifs, seed), false)?.fill(&mut points)?;
        Ok(Self { points })
    }

    /// Number of points.
    pub fn len(&self) -> u64 {
        self.points.len()
    }

    /// Whether it has no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All points, read back, in the order of the game.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn points(&mut self) -> Result<Vec<[f32; 3]>, Error> {
        self.points.read(|_, piece| &piece.rests).map(without_fourth)
    }
}

/// A plant on a device: points at rest with their codes, which stay there, and where a pose of the wind puts them.
#[derive(Debug)]
pub struct SwayingPoints {
    points: Points,
    digits: Digits,
    length: usize,
    pass: Pass,
    pose: Slots,
    /// For each piece: where points sway to, and all that the shader is bound to.
    swayed: Vec<(Store, BindGroup)>,
    /// What is bound beside the points.
    _plant: (Slots, Store),
}

/// Bytes of a swaying point.
const SWAYING_POINT_BYTES: u64 = 3 * BYTES;

impl SwayingPoints {
    /// The first `count` points of the [`Game`] with that seed, made on the device, with their codes: digits as on the
    /// CPU, points to rounding. A point takes 48 bytes.
    ///
    /// # Errors
    /// [`Error::Device`] where the device's memory does not hold them, or it fails.
    pub fn new(gpu: &Gpu, ifs: &Ifs, seed: u64, count: u64) -> Result<Self, Error> {
        let mut points = Points::new(gpu, count, true, SWAYING_POINT_BYTES)?;
        Play::new(gpu, Game::new(ifs, seed), true)?.fill(&mut points)?;
        Self::at_rest(points, ifs)
    }

    /// Points of a plant with their codes, of which as many digits count as those of the fractal have and 128 bits hold.
    ///
    /// # Errors
    /// As [`SwayingPoints::new`].
    pub fn of(gpu: &Gpu, ifs: &Ifs, coded: &[([f32; 3], Code)]) -> Result<Self, Error> {
        let points = Points::new(gpu, coded.len() as u64, true, SWAYING_POINT_BYTES)?;
        let rests: Vec<_> = coded.iter().map(|&([x, y, z], _)| [x, y, z, 0.0]).collect();
        let length = digits_on_a_device(ifs);
        let codes: Vec<_> = coded.iter().map(|(_, code)| packed(&code.prefix(length))).collect();
        points.write(&rests, |piece| &piece.rests)?;
        points.write(&codes, |piece| &piece.codes)?;
        Self::at_rest(points, ifs)
    }

    fn at_rest(points: Points, ifs: &Ifs) -> Result<Self, Error> {
        let (gpu, sway, calm) = (&points.gpu, Sway::of(ifs), Pose::calm());
        let pass = Pass::new(gpu, &SWAY)?;
        let plant = pass::uniform(gpu, "a plant", &sway.plant())?;
        let pose = Slots::new(gpu, "a pose of the wind", calm.words().len(), 1)?;
        let rows = pass::table(gpu, "the maps of a plant", &sway.rows())?;
        let swayed = points.pieces.iter().map(|piece| {
            let swayed = fours(gpu, "swayed points", u64::from(piece.count))?;
            let buffers = [&rows, &piece.rests, &piece.codes, &swayed];
            let bound = pass.bind(gpu, &[&plant, &pose], &buffers)?;
            Ok((swayed, bound))
        });
        let swayed = swayed.collect::<Result<_, Error>>()?;
        let (digits, length) = (ifs.digits(), digits_on_a_device(ifs));
        let mut swaying = Self { points, digits, length, pass, pose, swayed, _plant: (plant, rows) };
        swaying.sway(&calm)?;
        Ok(swaying)
    }

    /// Number of points.
    pub fn len(&self) -> u64 {
        self.points.len()
    }

    /// Whether it has no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All points at rest, read back, in their order.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn points(&mut self) -> Result<Vec<[f32; 3]>, Error> {
        self.points.read(|_, piece| &piece.rests).map(without_fourth)
    }

    /// The codes of all points, read back: as many digits as those of the fractal have and 128 bits hold. Shorter ones
    /// that were given go on with zeros.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn codes(&mut self) -> Result<Vec<Code>, Error> {
        let words = self.points.read(|_, piece| &piece.codes)?;
        let code = |words: [f32; 4]| unpacked(self.digits, self.length, words.map(f32::to_bits));
        Ok(words.into_iter().map(code).collect())
    }

    /// Puts all points where a pose wants them. The device may still be at work when this returns; the pose is all that
    /// goes there.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn sway(&mut self, pose: &Pose) -> Result<(), Error> {
        let Points { gpu, pace, pieces, .. } = &mut self.points;
        let mut given = Some((&self.pose, pass::packed(&self.pose, pose)?));
        for (piece, (_, bound)) in pieces.iter().zip(&self.swayed) {
            let (points, given) = (piece.count, given.take());
            self.pass.run(
                gpu,
                pace,
                Work { bound, points, of_a_group: SWAY.group, bytes: SWAYING_POINT_BYTES, given },
            )?;
        }
        Ok(())
    }

    /// Waits until all points are where the last pose wants them.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn wait(&mut self) -> Result<(), Error> {
        let Points { gpu, pace, .. } = &mut self.points;
        pace.drain(gpu)
    }

    /// Where the last pose put all points, read back; at rest before there was one.
    ///
    /// # Errors
    /// [`Error::Device`] where the device fails.
    pub fn swayed(&mut self) -> Result<Vec<[f32; 3]>, Error> {
        let swayed = &self.swayed;
        self.points.read(|number, _| &swayed[number].0).map(without_fourth)
    }
}

fn without_fourth(fours: Vec<[f32; 4]>) -> Vec<[f32; 3]> {
    fours.into_iter().map(|[x, y, z, _]| [x, y, z]).collect()
}

//! What is known of the border cells of tiles, and how ranks tell each other of those between them.

use super::tiling::Tiling;
use weald_core::error::Error;
use weald_engine::ranks::{Reader, Writer};

/// Something that is known of a border cell.
pub(super) trait Sent: Sized {
    fn write(&self, writer: &mut Writer);

    fn read(reader: &mut Reader<'_>) -> Result<Self, Error>;
}

impl Sent for bool {
    fn write(&self, writer: &mut Writer) {
        writer.words(&[u32::from(*self)]);
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, Error> {
        reader.words(1).map(|words| words == [1])
    }
}

impl Sent for [u32; 2] {
    fn write(&self, writer: &mut Writer) {
        writer.words(self);
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, Error> {
        reader.words(2).map(|words| [words[0], words[1]])
    }
}

/// A sum is no NaN where it is known.
impl Sent for Option<f64> {
    fn write(&self, writer: &mut Writer) {
        writer.doubles(&[self.unwrap_or(f64::NAN)]);
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, Error> {
        let mut sum = [0.0];
        reader.doubles(&mut sum)?;
        Ok(Some(sum[0]).filter(|sum| !sum.is_nan()))
    }
}

/// Something that is known of each border cell of this rank's tiles and of the tiles beside them.
pub(super) struct Borders<T> {
    first: usize,
    known: Vec<T>,
    /// This rank's rows beside those of its neighbours as they were told before.
    told: Vec<Vec<T>>,
}

impl<T: Copy + PartialEq + Sent> Borders<T> {
    /// The same of all of them.
    pub(super) fn filled(tiling: &Tiling, value: T) -> Self {
        let range = tiling.known();
        let told = tiling.neighbours().map(|_| vec![value; tiling.size().columns]).collect();
        Self { first: range.start, known: vec![value; range.len()], told }
    }

    /// Of a border cell, by its number.
    pub(super) fn at(&self, border: usize) -> T {
        self.known[border - self.first]
    }

    /// Replaces what is known of it.
    pub(super) fn set(&mut self, border: usize, value: T) {
        self.known[border - self.first] = value;
    }

    /// Tells the neighbours what has changed beside them, and hears it from them; gives the cells of theirs that have changed.
    pub(super) fn swap(&mut self, tiling: &Tiling) -> Result<Vec<[usize; 2]>, Error> {
        let neighbours: Vec<_> = tiling.neighbours().collect();
        let mut given = Vec::with_capacity(neighbours.len());
        for (side, (with, [own, _])) in neighbours.iter().enumerate() {
            let mut writer = Writer::default();
            for x in 0..tiling.size().columns {
                let now = self.at(tiling.border([x, *own]));
                if std::mem::replace(&mut self.told[side][x], now) != now {
                    writer.count(x);
                    now.write(&mut writer);
                }
            }
            given.push((*with, writer.0));
        }
        let taken = if given.is_empty() { Vec::new() } else { tiling.ranks().trade(given)? };
        let mut changed = Vec::new();
        for ((_, [_, theirs]), message) in neighbours.iter().zip(taken) {
            let mut reader = Reader(&message);
            while !reader.is_empty() {
                let cell = [reader.count()?, *theirs];
                self.set(tiling.border(cell), T::read(&mut reader)?);
                changed.push(cell);
            }
        }
        Ok(changed)
    }
}

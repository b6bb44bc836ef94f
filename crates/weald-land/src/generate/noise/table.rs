//! What the shader of the noise is given of an octave.

use super::{Axis, Octave};

impl Axis {
    /// Whole steps and the rest of each cell, in both directions.
    fn words(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.rest[0].len()).flat_map(|at| {
            let (whole, rest) = self.at(at);
            [whole[0] as u32, whole[1] as u32, rest[0].to_bits(), rest[1].to_bits()]
        })
    }
}

impl Octave {
    /// Four words a column.
    pub(crate) fn column_words(&self) -> impl Iterator<Item = u32> + '_ {
        self.columns.words()
    }

    /// Four words a row.
    pub(crate) fn row_words(&self) -> impl Iterator<Item = u32> + '_ {
        self.rows.words()
    }

    /// Eight words: the plane and the amplitude, then the lattice's turn by its steps a metre.
    pub(crate) fn own_words(&self, amplitude: f32) -> [u32; 8] {
        let [start, key] = self.plane.words();
        let [cos, sin] = self.turn.map(|part| (part as f32).to_bits());
        [start, key, amplitude.to_bits(), 0, cos, sin, 0, 0]
    }
}

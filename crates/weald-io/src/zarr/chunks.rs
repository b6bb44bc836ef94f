//! Where the cells of a chunk lie in their array.

use super::metadata::MAX_DIMENSIONS;

/// Positions along each dimension; those beyond the last are 0.
pub(super) type Place = [usize; MAX_DIMENSIONS];

/// The place of the element at a row-major position.
pub(super) fn place(mut position: usize, shape: &[usize]) -> Place {
    let mut place = [0; MAX_DIMENSIONS];
    for (axis, length) in shape.iter().enumerate().rev() {
        place[axis] = position % length;
        position /= length;
    }
    place
}

/// The row-major position of an element.
fn position(place: &Place, shape: &[usize]) -> usize {
    shape.iter().zip(place).fold(0, |position, (length, at)| position * length + at)
}

/// The part of a chunk that lies within its array, row by row along the last dimension.
pub(super) struct Rows<'a> {
    shape: &'a [usize],
    chunk: &'a [usize],
    /// First element of the chunk.
    origin: Place,
    /// Elements of the chunk within the array along each dimension.
    extent: Vec<usize>,
}

impl<'a> Rows<'a> {
    /// Of the chunk at `place` among the chunks.
    pub(super) fn of(shape: &'a [usize], chunk: &'a [usize], place: &Place) -> Self {
        let mut origin = [0; MAX_DIMENSIONS];
        for (axis, length) in chunk.iter().enumerate() {
            origin[axis] = place[axis] * length;
        }
        let extent =
            shape.iter().zip(chunk).zip(&origin).map(|((all, chunk), first)| (*chunk).min(all - first));
        Self { shape, chunk, origin, extent: extent.collect() }
    }

    /// Elements in a row.
    pub(super) fn length(&self) -> usize {
        self.extent.last().copied().unwrap_or(1)
    }

    /// Where each row begins: its position in the array and in the chunk.
    pub(super) fn starts(&self) -> impl Iterator<Item = (usize, usize)> {
        let rows = self.extent.len().saturating_sub(1);
        let (across, count) = (&self.extent[..rows], self.extent[..rows].iter().product());
        (0..count).map(move |row| {
            let inside = place(row, across);
            let mut whole = inside;
            whole.iter_mut().zip(&self.origin).for_each(|(at, first)| *at += first);
            (position(&whole, self.shape), position(&inside, self.chunk))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chunk_at_the_edge_has_only_the_rows_within_the_array() {
        let rows = Rows::of(&[5, 7], &[3, 4], &place(3, &[2, 2]));
        assert_eq!(rows.length(), 3);
        // Rows 3 and 4 from column 4.
        assert_eq!(rows.starts().collect::<Vec<_>>(), [(25, 0), (32, 4)]);
    }

    #[test]
    fn a_single_number_is_a_row_of_one() {
        let rows = Rows::of(&[], &[], &place(0, &[]));
        assert_eq!((rows.length(), rows.starts().collect::<Vec<_>>()), (1, vec![(0, 0)]));
    }
}

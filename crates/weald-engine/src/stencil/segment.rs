//! One row of one plane in memory: its cells on a cache line, with room for a neighbour on both sides.

/// Values of one cache line.
pub(super) const CACHE_LINE: usize = 16;

/// Cells before the first cell of a row, so that the western neighbour of column 0 exists and rows start on
/// a cache line: vectors that straddle two lines load at half the speed.
const MARGIN: usize = CACHE_LINE;

/// Length of a row in memory: margin, cells, an eastern neighbour, rounded up to whole cache lines.
pub(super) fn length(columns: usize) -> usize {
    MARGIN + (columns + 1).next_multiple_of(CACHE_LINE)
}

/// Distance of two rows that lie one after the other. Rows that share an offset within a 4 KiB page would make the
/// processor take a load for a later store's neighbour and wait, so they are kept apart.
pub(super) fn stride(columns: usize) -> usize {
    const PAGE: usize = 1024;
    const APART: usize = 64;
    let length = length(columns);
    if (APART..=PAGE - APART).contains(&(length % PAGE)) { length } else { length + 2 * APART }
}

/// The cells of a row that begins with its margin.
#[inline]
pub(super) fn here(row: &[f32], columns: usize) -> &[f32] {
    &row[MARGIN..][..columns]
}

/// The cells of a row that begins with its margin.
#[inline]
pub(super) fn here_mut(row: &mut [f32], columns: usize) -> &mut [f32] {
    &mut row[MARGIN..][..columns]
}

/// A row of one plane that owns its memory, so that it changes hands without a copy. What lies beside its cells is 0.
#[derive(Clone, Debug)]
pub struct Segment {
    values: Vec<f32>,
    /// Where the first cell lies, on a cache line.
    first: usize,
    columns: usize,
}

/// A row of all planes.
pub type PlaneRow = Vec<Segment>;

impl Segment {
    /// A row of zeros.
    pub fn new(columns: usize) -> Self {
        let values = vec![0.0_f32; stride(columns) + CACHE_LINE];
        // It says where to work fast, nothing else: a wrong place would give the same results.
        let line = values.as_ptr().align_offset(CACHE_LINE * size_of::<f32>()).min(CACHE_LINE);
        Self { values, first: line + MARGIN, columns }
    }

    /// The cells.
    #[inline]
    pub fn here(&self) -> &[f32] {
        &self.values[self.first..][..self.columns]
    }

    /// The cells.
    #[inline]
    pub fn here_mut(&mut self) -> &mut [f32] {
        &mut self.values[self.first..][..self.columns]
    }

    /// The western neighbours of the cells.
    #[inline]
    pub fn west(&self) -> &[f32] {
        &self.values[self.first - 1..][..self.columns]
    }

    /// The eastern neighbours of the cells.
    #[inline]
    pub fn east(&self) -> &[f32] {
        &self.values[self.first + 1..][..self.columns]
    }
}

//! Rows in flight: a short memory of the latest rows of one plane, and a row of zeros beyond the edge.

/// Values of one cache line.
pub const CACHE_LINE: usize = 16;

/// Cells before the first cell of a row, so that the western neighbour of column 0 exists and rows start on
/// a cache line: vectors that straddle two lines load at half the speed.
pub const MARGIN: usize = CACHE_LINE;

/// Position of the first value that begins a cache line. It says where to work fast, nothing else: a wrong
/// one would give the same results.
pub fn cache_line_start(values: &[f32]) -> usize {
    values.as_ptr().align_offset(CACHE_LINE * size_of::<f32>()).min(CACHE_LINE)
}

/// Length of a row in memory: margin, cells, an eastern neighbour, rounded up to whole cache lines.
pub fn segment(columns: usize) -> usize {
    MARGIN + (columns + 1).next_multiple_of(16)
}

/// The cells of a row.
#[inline]
pub fn here(row: &[f32], columns: usize) -> &[f32] {
    &row[MARGIN..][..columns]
}

/// The cells of a row.
#[inline]
pub fn here_mut(row: &mut [f32], columns: usize) -> &mut [f32] {
    &mut row[MARGIN..][..columns]
}

/// The western neighbours of the cells of a row.
#[inline]
pub fn west(row: &[f32], columns: usize) -> &[f32] {
    &row[MARGIN - 1..][..columns]
}

/// The eastern neighbours of the cells of a row.
#[inline]
pub fn east(row: &[f32], columns: usize) -> &[f32] {
    &row[MARGIN + 1..][..columns]
}

/// The latest `depth` rows of one plane. Row `y` stays until row `y + depth` takes its place.
#[derive(Clone, Debug)]
pub struct Ring {
    cells: Vec<f32>,
    /// Where the first cache line of `cells` begins.
    start: usize,
    columns: usize,
    depth: usize,
}

impl Ring {
    /// A ring of so many rows, all zero.
    pub fn new(columns: usize, depth: usize) -> Self {
        let cells = vec![0.0_f32; segment(columns) * depth + CACHE_LINE];
        let start = cache_line_start(&cells);
        Self { cells, start, columns, depth }
    }

    fn slot(&self, y: usize) -> std::ops::Range<usize> {
        let segment = segment(self.columns);
        let start = self.start + y % self.depth * segment;
        start..start + segment
    }

    fn row(&self, y: usize) -> &[f32] {
        &self.cells[self.slot(y)]
    }

    /// Row `y`.
    pub fn here(&self, y: usize) -> &[f32] {
        here(self.row(y), self.columns)
    }

    /// Western neighbours of row `y`.
    pub fn west(&self, y: usize) -> &[f32] {
        west(self.row(y), self.columns)
    }

    /// Eastern neighbours of row `y`.
    pub fn east(&self, y: usize) -> &[f32] {
        east(self.row(y), self.columns)
    }

    /// Row `y`, to write.
    pub fn here_mut(&mut self, y: usize) -> &mut [f32] {
        let slot = self.slot(y);
        here_mut(&mut self.cells[slot], self.columns)
    }
}

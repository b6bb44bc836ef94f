//! Where the water of each cell goes: one of eight neighbours, over the edge, or into the sea.
//!
//! Codes are whole numbers, so that a layer can hold them:
//!
//! ```text
//! 6 7 8        0  an outlet: water leaves over the border of the grid or of the data
//! 5 · 1        9  sea: water that arrives stays
//! 4 3 2
//! ```

use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicU8, AtomicU32};

use rayon::prelude::*;

use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};

/// Code of a cell from which water leaves over the border of the grid or of the data.
pub const OUTLET: u8 = 0;

/// Code of a cell of the sea.
pub const SEA: u8 = 9;

/// Columns eastward and rows southward to the neighbour of code `index + 1`: from east over south.
pub const STEPS: [(isize, isize); 8] = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

/// The ways, 0 to 7, in the order of the numbers of the cells that they lead to.
const BY_NUMBER: [u8; 8] = [5, 6, 7, 4, 0, 3, 2, 1];

/// Cells that one task begins at; no result depends on it.
pub(super) const CELLS_PER_TASK: usize = 1 << 14;

/// No code.
const NONE: u8 = u8::MAX;

/// Of a path: not yet known what is on it, and known that nothing is.
const UNKNOWN: u32 = u32::MAX;
const NOTHING: u32 = u32::MAX - 1;

/// The way back: of the eight ways, the fourth on.
pub(super) fn opposite(direction: u8) -> u8 {
    (direction + 4) % 8
}

/// The direction of flow of each cell, checked: no code leads out of the grid, or onto a cell without data.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Directions {
    size: Size,
    codes: Vec<u8>,
}

impl Directions {
    /// Directions that are known to be right.
    ///
    /// # Panics
    /// If `codes` does not hold one code a cell: a bug of the caller.
    pub fn new(size: Size, codes: Vec<u8>) -> Self {
        assert_eq!(codes.len(), size.cells(), "one code a cell");
        Self { size, codes }
    }

    /// Reads a layer of codes, as the step `flow` writes it. Cells without data count as outlets.
    ///
    /// # Errors
    /// [`Error::Run`] naming the first cell whose code is none, leads out of the data, or belongs to a cycle.
    pub fn of(layer: &Field, valid: Option<&Mask>) -> Result<Self, Error> {
        let size = layer.size();
        let has_data = |cell: usize| valid.is_none_or(|valid| valid.is_valid_at(cell));
        let code = |(cell, &value): (usize, &f32)| {
            // What is no number becomes 0, which it does not equal.
            let code = value as u8;
            let is_one = f32::from(code) == value && code <= SEA && leads_within(size, cell, code, has_data);
            if has_data(cell) && !is_one { Err(cell) } else { Ok(if has_data(cell) { code } else { OUTLET }) }
        };
        let cells = layer.values().par_iter().enumerate().with_min_len(CELLS_PER_TASK);
        let codes: Vec<u8> = cells.clone().map(|cell| code(cell).unwrap_or(NONE)).collect();
        if codes.par_iter().with_min_len(CELLS_PER_TASK).any(|&code| code == NONE) {
            let wrong = codes.iter().position(|&code| code == NONE).unwrap_or_default();
            return Err(bad_code(size, wrong, layer.values()[wrong]));
        }
        let directions = Self { size, codes };
        directions.cell_of_cycle().map_or(Ok(directions), |cell| Err(cycle_error(size, cell)))
    }

    /// Columns and rows.
    pub fn size(&self) -> Size {
        self.size
    }

    /// All codes, row-major.
    pub fn codes(&self) -> &[u8] {
        &self.codes
    }

    /// The cell that a cell drains to; `None` for outlets and the sea.
    #[inline]
    pub fn downstream(&self, cell: usize) -> Option<usize> {
        let code = self.codes[cell];
        if code == OUTLET || code == SEA {
            return None;
        }
        let (east, south) = STEPS[usize::from(code) - 1];
        Some(cell.wrapping_add_signed(south * self.size.columns as isize + east))
    }

    /// Whether a cell is of the sea.
    pub fn is_sea(&self, cell: usize) -> bool {
        self.codes[cell] == SEA
    }

    /// The cells that drain to a cell, in the order of their numbers.
    pub fn upstream(&self, cell: usize) -> impl Iterator<Item = usize> {
        self.size.neighbours(cell).filter(move |&other| self.downstream(other) == Some(cell))
    }

    /// The cells from an outlet or the sea upward, so that each comes after the one it drains to, as far as
    /// `member` says.
    pub fn upward(&self, member: impl Fn(usize) -> bool) -> Vec<usize> {
        let ends = |&cell: &usize| {
            member(cell) && self.downstream(cell).is_none_or(|downstream| !member(downstream))
        };
        let donors = self.donors();
        let mut order: Vec<usize> = (0..self.size.cells()).filter(ends).collect();
        let mut done = 0;
        while let Some(&cell) = order.get(done) {
            let donors = BY_NUMBER.into_iter().filter(|direction| donors[cell] >> direction & 1 == 1);
            order.extend(donors.map(|direction| self.beside(cell, direction)).filter(|&other| member(other)));
            done += 1;
        }
        order
    }

    /// The neighbours from which each cell receives: bit `code - 1` for the neighbour in the direction of `code`.
    pub(super) fn donors(&self) -> Vec<u8> {
        let cells = || (0..self.codes.len()).into_par_iter().with_min_len(CELLS_PER_TASK);
        let donors: Vec<AtomicU8> = cells().map(|_| AtomicU8::new(0)).collect();
        cells().for_each(|cell| {
            if let Some(next) = self.downstream(cell) {
                donors[next].fetch_or(1 << opposite(self.codes[cell] - 1), Relaxed);
            }
        });
        donors.into_par_iter().with_min_len(CELLS_PER_TASK).map(AtomicU8::into_inner).collect()
    }

    /// What `own` says, for each cell, of the first cell on its flow path of which it says something, the cell itself
    /// included; `None` where it says nothing of any. It says less than 2³² - 2.
    pub fn first_on_path(&self, own: impl Fn(usize) -> Option<u32> + Sync) -> impl Fn(usize) -> Option<u32> {
        let found = self.walked(own).expect("these directions were checked, or made by `flow`");
        move |cell| Some(found[cell]).filter(|&found| found != NOTHING)
    }

    /// The same as numbers; `None` where water of some cell comes to no end. Threads that follow the same path write the
    /// same numbers.
    fn walked(&self, own: impl Fn(usize) -> Option<u32> + Sync) -> Option<Vec<u32>> {
        let cells = || (0..self.codes.len()).into_par_iter().with_min_len(CELLS_PER_TASK);
        let at = |cell: usize| own(cell).unwrap_or(if self.ends(cell) { NOTHING } else { UNKNOWN });
        let found: Vec<AtomicU32> = cells().map(|cell| AtomicU32::new(at(cell))).collect();
        let all_end = cells().map(|cell| self.walk(cell, &found)).try_reduce(|| (), |(), ()| Some(()));
        all_end.map(|()| {
            let found = found.into_par_iter().with_min_len(CELLS_PER_TASK);
            found.map(AtomicU32::into_inner).collect()
        })
    }

    /// Follows a path to what is known, and makes it known all the way.
    fn walk(&self, start: usize, found: &[AtomicU32]) -> Option<()> {
        let (mut cell, mut steps) = (start, 0);
        let mut known = found[cell].load(Relaxed);
        while known == UNKNOWN {
            cell = self.downstream(cell)?;
            known = found[cell].load(Relaxed);
            steps += 1;
            if steps > self.codes.len() {
                return None;
            }
        }
        cell = start;
        while found[cell].load(Relaxed) == UNKNOWN {
            found[cell].store(known, Relaxed);
            cell = self.downstream(cell)?;
        }
        Some(())
    }

    fn ends(&self, cell: usize) -> bool {
        self.codes[cell] == OUTLET || self.codes[cell] == SEA
    }

    fn beside(&self, cell: usize, direction: u8) -> usize {
        let (east, south) = STEPS[usize::from(direction)];
        cell.wrapping_add_signed(south * self.size.columns as isize + east)
    }

    /// The codes as a layer.
    pub fn layer(&self) -> Field {
        let codes = self.codes.par_iter().with_min_len(CELLS_PER_TASK);
        Field::from_values(self.size, codes.map(|&code| f32::from(code)).collect())
    }

    /// A cell from which water comes to no end.
    fn cell_of_cycle(&self) -> Option<usize> {
        if self.walked(|_| None).is_some() {
            return None;
        }
        let ending = self.upward(|_| true);
        let mut ends = vec![false; self.codes.len()];
        for cell in ending {
            ends[cell] = true;
        }
        ends.iter().position(|ends| !ends)
    }
}

fn leads_within(size: Size, cell: usize, code: u8, has_data: impl Fn(usize) -> bool) -> bool {
    if code == OUTLET || code == SEA {
        return true;
    }
    let (east, south) = STEPS[usize::from(code) - 1];
    let x = (cell % size.columns).checked_add_signed(east).filter(|&x| x < size.columns);
    let y = (cell / size.columns).checked_add_signed(south).filter(|&y| y < size.rows);
    x.zip(y).is_some_and(|(x, y)| has_data(size.index(x, y)))
}

fn bad_code(size: Size, cell: usize, value: f32) -> Error {
    let (x, y) = (cell % size.columns, cell / size.columns);
    Error::Run(format!(
        "the direction of flow in column {x}, row {y} is {value}, but must be 0 (outlet), 9 (sea), or 1 to 8 \
         (from east over south) towards a cell with data; make the layer with the step `flow`"
    ))
}

fn cycle_error(size: Size, cell: usize) -> Error {
    let (x, y) = (cell % size.columns, cell / size.columns);
    Error::Run(format!(
        "water of column {x}, row {y} flows in a cycle and reaches no outlet; make the layer of directions \
         with the step `flow`"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(values: &[f32]) -> Field {
        Field::from_values(Size::new(3, values.len() / 3).expect("legal"), values.to_vec())
    }

    #[test]
    fn every_code_leads_to_its_neighbour() {
        let size = Size::square(3).expect("legal");
        let targets = (1..=8).map(|code| {
            let mut codes = vec![OUTLET; 9];
            codes[4] = code;
            Directions::new(size, codes).downstream(4).expect("there is one")
        });
        assert_eq!(targets.collect::<Vec<_>>(), [5, 8, 7, 6, 3, 0, 1, 2]);
    }

    #[test]
    fn what_is_no_direction_is_refused_with_its_place() {
        let refused = |values: &[f32], words: &str| {
            let error = Directions::of(&layer(values), None).expect_err("refused").to_string();
            assert!(error.contains(words), "{error}");
        };
        refused(&[0.0, 0.0, 0.0, 0.0, 2.5, 0.0], "column 1, row 1 is 2.5");
        refused(&[0.0, 0.0, 1.0, 0.0, 0.0, 0.0], "column 2, row 0 is 1");
        refused(&[0.0, 1.0, 5.0, 0.0, 0.0, 0.0], "column 1, row 0 flows in a cycle");
        refused(&[0.0, f32::NAN, 0.0], "column 1, row 0 is NaN");
    }

    #[test]
    fn directions_come_back_from_their_layer() {
        let drawn = layer(&[1.0, 3.0, 5.0, 9.0, 0.0, 6.0]);
        let directions = Directions::of(&drawn, None).expect("right");
        assert_eq!(directions.layer(), drawn);
        assert_eq!(directions.upstream(1).collect::<Vec<_>>(), [0, 2, 5]);
        assert_eq!(directions.upward(|_| true), [3, 4, 1, 0, 2, 5]);
    }
}

//! Where the water of each cell goes: one of eight neighbours, over the edge, or into the sea.
//!
//! Codes are whole numbers, so that a layer can hold them:
//!
//! ```text
//! 6 7 8        0  an outlet: water leaves over the border of the grid or of the data
//! 5 · 1        9  sea: water that arrives stays
//! 4 3 2
//! ```

use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};

/// Code of a cell from which water leaves over the border of the grid or of the data.
pub const OUTLET: u8 = 0;

/// Code of a cell of the sea.
pub const SEA: u8 = 9;

/// Columns eastward and rows southward to the neighbour of code `index + 1`: from east over south.
pub const STEPS: [(isize, isize); 8] = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

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
        let mut codes = vec![OUTLET; size.cells()];
        for cell in (0..size.cells()).filter(|&cell| has_data(cell)) {
            let value = layer.values()[cell];
            let code = (0..=SEA).find(|&code| f32::from(code) == value);
            let within = code.filter(|&code| leads_within(size, cell, code, has_data));
            codes[cell] = within.ok_or_else(|| bad_code(size, cell, value))?;
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
        let mut order: Vec<usize> = (0..self.size.cells()).filter(ends).collect();
        let mut done = 0;
        while let Some(&cell) = order.get(done) {
            order.extend(self.upstream(cell).filter(|&other| member(other)));
            done += 1;
        }
        order
    }

    /// The codes as a layer.
    pub fn layer(&self) -> Field {
        Field::from_values(self.size, self.codes.iter().map(|&code| f32::from(code)).collect())
    }

    /// A cell from which water comes to no end.
    fn cell_of_cycle(&self) -> Option<usize> {
        let ending = self.upward(|_| true);
        if ending.len() == self.codes.len() {
            return None;
        }
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

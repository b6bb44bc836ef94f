//! Lengths of which the default is a share of a cell.

use super::declaration::ParameterValue;
use super::diagnostics::Diagnostics;
use super::kind::Kind;
use crate::source::Node;

/// A length in metres, or in cells where nobody chooses: so a default goes with the size of the cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// Metres, as a recipe gives them.
    Metres(f64),
    /// Sides of a cell.
    Cells(f64),
}

impl Length {
    /// The length in sides of a cell of so many metres.
    pub fn in_cells(self, cell: f64) -> f64 {
        match self {
            Self::Metres(metres) => metres / cell,
            Self::Cells(cells) => cells,
        }
    }
}

impl From<f64> for Length {
    fn from(metres: f64) -> Self {
        Self::Metres(metres)
    }
}

impl ParameterValue for Length {
    fn kind(range: (f64, f64)) -> Kind {
        f64::kind(range)
    }

    fn read(node: &Node, range: (f64, f64), diagnostics: &mut Diagnostics) -> Result<Self, String> {
        f64::read(node, range, diagnostics).map(Self::Metres)
    }

    fn shown(&self) -> Option<String> {
        match self {
            Self::Metres(metres) => metres.shown(),
            Self::Cells(_) => None,
        }
    }

    fn in_words(&self) -> Option<String> {
        match self {
            Self::Metres(metres) => metres.in_words(),
            Self::Cells(cells) => Some(format!("{cells:?} × cell size")),
        }
    }
}

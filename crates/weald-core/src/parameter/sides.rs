//! The size of a grid in a recipe.

use super::declaration::ParameterValue;
use super::diagnostics::Diagnostics;
use super::kind::Kind;
use super::values::wrong;
use crate::source::{Node, Value};

/// Columns and rows of a grid as a recipe gives them: one number for a square, or a list of two.
///
/// The upper limit is that of [`Size`](crate::Size), which has an error of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sides {
    /// Cells from west to east.
    pub columns: u64,
    /// Cells from north to south.
    pub rows: u64,
}

impl Sides {
    /// The default of a key that must be given.
    pub const NEEDED: Self = Self { columns: 0, rows: 0 };
}

impl ParameterValue for Sides {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Sides
    }

    fn read(node: &Node, _: (f64, f64), _: &mut Diagnostics) -> Result<Self, String> {
        let side = |value: &Value| match value {
            Value::Integer(side) => u64::try_from(*side).ok().filter(|&side| side >= 1),
            _ => None,
        };
        let sides = match &node.value {
            Value::List(items) => match items.as_slice() {
                [columns, rows] => side(&columns.value).zip(side(&rows.value)),
                _ => None,
            },
            value => side(value).map(|side| (side, side)),
        };
        let (columns, rows) = sides.ok_or_else(|| wrong(node, &format!("a {}", Kind::Sides.in_words())))?;
        Ok(Self { columns, rows })
    }

    fn shown(&self) -> Option<String> {
        (!self.must_be_given()).then(|| format!("[{}, {}]", self.columns, self.rows))
    }

    fn must_be_given(&self) -> bool {
        *self == Self::NEEDED
    }
}

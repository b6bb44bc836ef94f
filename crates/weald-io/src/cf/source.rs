//! A file of arrays as reading sees it, whatever its format.

use super::super::Fault;
use super::attribute::Attributes;

/// An array in a file, before any of its numbers is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Described {
    /// Its name.
    pub name: String,
    /// Names of its dimensions, slowest first.
    pub dimensions: Vec<String>,
    /// Length of each.
    pub shape: Vec<usize>,
    /// Its attributes.
    pub attributes: Attributes,
    /// Type of the numbers.
    pub stored: &'static str,
    /// Whether it holds numbers and not letters.
    pub is_number: bool,
    /// What stands where nothing was ever written, unless an attribute says otherwise.
    pub default_fill: Option<f64>,
}

/// A file of arrays.
pub trait Source {
    /// What is said of the whole file.
    fn attributes(&self) -> &Attributes;

    /// All arrays.
    fn variables(&self) -> &[Described];

    /// Hands each number of an array to `take` with its position in row-major order.
    ///
    /// # Errors
    /// [`Fault`] for numbers that are damaged or of a kind that is not read.
    fn each(&self, variable: &Described, take: &mut dyn FnMut(usize, f64)) -> Result<(), Fault>;
}

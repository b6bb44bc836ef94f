//! Attributes: what is said of a variable or of a whole file; and a file of arrays as reading sees it, whatever its
//! format.

use super::super::Fault;

/// The value of an attribute.
#[derive(Clone, Debug, PartialEq)]
pub enum Attribute {
    /// Text.
    Text(String),
    /// One number of 32 bits.
    Float(f32),
    /// Numbers.
    Doubles(Vec<f64>),
    /// Whole numbers.
    Integers(Vec<i32>),
}

impl Attribute {
    /// Whole numbers, as such where they fit.
    pub(crate) fn of_whole(numbers: Vec<f64>) -> Self {
        let fits = |number: &f64| f64::from(*number as i32) == *number;
        if numbers.iter().all(fits) {
            return Self::Integers(numbers.into_iter().map(|number| number as i32).collect());
        }
        Self::Doubles(numbers)
    }
}

impl From<&str> for Attribute {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Attribute {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<f64> for Attribute {
    fn from(number: f64) -> Self {
        Self::Doubles(vec![number])
    }
}

/// Attributes in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes(pub(crate) Vec<(String, Attribute)>);

impl Attributes {
    /// Adds one.
    pub fn add(&mut self, name: &str, value: impl Into<Attribute>) {
        self.0.push((name.to_owned(), value.into()));
    }

    /// The attribute of that name.
    pub fn get(&self, name: &str) -> Option<&Attribute> {
        self.0.iter().find(|(known, _)| known == name).map(|(_, value)| value)
    }

    /// The text of that name, without the zeros that some writers end it with.
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.get(name)? {
            Attribute::Text(text) => Some(text.trim_end_matches('\0')),
            _ => None,
        }
    }

    /// The numbers of that name.
    pub fn numbers(&self, name: &str) -> Option<Vec<f64>> {
        match self.get(name)? {
            Attribute::Text(_) => None,
            Attribute::Float(number) => Some(vec![f64::from(*number)]),
            Attribute::Doubles(numbers) => Some(numbers.clone()),
            Attribute::Integers(numbers) => Some(numbers.iter().map(|&number| f64::from(number)).collect()),
        }
    }

    /// The first number of that name.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.numbers(name)?.first().copied()
    }
}

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

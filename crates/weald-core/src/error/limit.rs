//! Limits: what was asked for, what is allowed, and what to do.

use std::fmt::{self, Display, Formatter};
use std::ops::RangeInclusive;

/// More than a stated limit allows, or less. Nothing was allocated, so a program may ask for less and go on:
///
/// ```
/// use weald_core::error::{Error, Limit, Quantity};
/// use weald_core::grid::Size;
///
/// let Err(Error::Limit(Limit { what, asked, allowed, .. })) = Size::new(20_000, 20_000) else {
///     panic!("that many cells are refused");
/// };
/// assert_eq!((what, asked), (Quantity::Cells, Some(400_000_000)));
/// let finest = (*allowed.end() as f64).sqrt() as usize;
/// assert!(Size::square(finest).is_ok());
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Limit {
    /// What is counted, and in which unit.
    pub what: Quantity,
    /// How much was asked for; `None` where it was not counted to its end, and for more than `u64` holds.
    pub asked: Option<u64>,
    /// From the least to the most that is allowed.
    pub allowed: RangeInclusive<u64>,
    /// What asked for it, as sentences begin: the file, the step, the picture with its sides.
    pub subject: String,
    /// What to do, as sentences go on.
    pub remedy: String,
}

impl Limit {
    /// So much is not allowed; [`Limit::of`] and [`Limit::remedy`] say what asked for it and what to do.
    pub fn new(what: Quantity, asked: impl Into<Option<u64>>, allowed: RangeInclusive<u64>) -> Self {
        Self { what, asked: asked.into(), allowed, subject: String::new(), remedy: String::new() }
    }

    /// Names what asked for it, before what was named so far.
    #[must_use]
    pub fn of(self, subject: impl Display) -> Self {
        let subject = match self.subject.as_str() {
            "" => subject.to_string(),
            inner => format!("{subject}: {inner}"),
        };
        Self { subject, ..self }
    }

    /// Says what to do.
    #[must_use]
    pub fn remedy(self, remedy: impl Into<String>) -> Self {
        Self { remedy: remedy.into(), ..self }
    }

    /// Numbers in the unit of the quantity; bytes are exact where two amounts would read the same.
    fn in_words(&self, amount: u64) -> String {
        let most = *self.allowed.end();
        let alike = |asked: u64| asked != most && bytes_in_words(asked) == bytes_in_words(most);
        match self.what {
            Quantity::FileBytes | Quantity::MemoryBytes if self.asked.is_some_and(alike) => {
                format!("{amount} bytes")
            }
            Quantity::FileBytes | Quantity::MemoryBytes => bytes_in_words(amount),
            _ => amount.to_string(),
        }
    }
}

impl Display for Limit {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        if !self.subject.is_empty() {
            write!(formatter, "{}: ", self.subject)?;
        }
        let (least, most) = (*self.allowed.start(), *self.allowed.end());
        let (unit, limit) = (self.what.unit(), self.in_words(most));
        match self.asked.map(|asked| self.in_words(asked)) {
            None => write!(formatter, "more than the {limit}{unit} that are allowed")?,
            Some(asked) if least == 0 => write!(formatter, "{asked}{unit}, at most {limit} are allowed")?,
            Some(asked) if least == most => write!(formatter, "{asked}{unit}, only {limit} are allowed")?,
            Some(asked) => {
                let between = self.what.between();
                write!(formatter, "{asked}{unit}, {least} {between} {limit} are allowed")?;
            }
        }
        if self.remedy.is_empty() { Ok(()) } else { write!(formatter, "; {}", self.remedy) }
    }
}

impl std::error::Error for Limit {}

/// What a limit counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Quantity {
    /// Cells of a grid.
    Cells,
    /// Cells along one side of a grid or of a tile of it.
    CellsPerSide,
    /// Cells from the middle of a window to its edge.
    WindowCells,
    /// Pixels of a picture.
    Pixels,
    /// Pixels along one side of a picture.
    PixelsPerSide,
    /// Samples of one pixel: the least or the most that are allowed, and no number between.
    SamplesPerPixel,
    /// Rays of a picture.
    Rays,
    /// Bytes of a file.
    FileBytes,
    /// Bytes of memory.
    MemoryBytes,
    /// Buffers that one pass of a device sees.
    Buffers,
    /// Numbers of an array.
    Numbers,
    /// Elements and texts of an XML file.
    Elements,
    /// Flames of a file.
    Flames,
    /// Strokes of a script.
    Strokes,
    /// Vertices of a mesh.
    Vertices,
    /// Regions along one side of a terrain.
    RegionsPerSide,
    /// Points of a fractal.
    Points,
    /// Parts of a fractal.
    Parts,
    /// Plants.
    Plants,
    /// Sets of grass.
    GrassSets,
}

impl Quantity {
    /// What follows the number of a sentence.
    fn unit(self) -> &'static str {
        match self {
            Self::Cells => " cells",
            Self::CellsPerSide => " cells a side",
            Self::WindowCells => " cells to each side",
            Self::Pixels => " pixels",
            Self::PixelsPerSide => " pixels a side",
            Self::SamplesPerPixel => " samples per pixel",
            Self::Rays => " rays",
            // Such amounts have their unit, and the subject is a file.
            Self::FileBytes => "",
            Self::MemoryBytes => " of memory",
            Self::Buffers => " buffers",
            Self::Numbers => " numbers",
            Self::Elements => " elements and texts",
            Self::Flames => " flames",
            Self::Strokes => " strokes",
            Self::Vertices => " vertices",
            Self::RegionsPerSide => " regions a side",
            Self::Points => " points",
            Self::Parts => " parts",
            Self::Plants => " plants",
            Self::GrassSets => " sets of grass",
        }
    }

    /// What stands between the least and the most.
    fn between(self) -> &'static str {
        if self == Self::SamplesPerPixel { "or" } else { "to" }
    }
}

/// Least and most memory that can be asked for.
const MEMORY: RangeInclusive<u64> = 1 << 20..=1 << 50;

/// Reads an amount of memory: bytes, or a whole number of KiB, MiB or GiB.
///
/// # Errors
/// What is wrong with the text.
pub fn bytes_from_words(text: &str) -> Result<u64, String> {
    let digits = text.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(text.len());
    let unit: u64 = match text[digits..].trim() {
        "" | "B" => 1,
        "KiB" => 1 << 10,
        "MiB" => 1 << 20,
        "GiB" => 1 << 30,
        other => return Err(format!("`{other}` is no unit; give bytes, KiB, MiB or GiB, as in 512MiB")),
    };
    let number = text[..digits].parse::<u64>().map_err(|_| "it is written as in 512MiB".to_owned())?;
    let bytes = number.checked_mul(unit).filter(|bytes| MEMORY.contains(bytes));
    bytes.ok_or_else(|| "it is at least 1MiB and at most 1048576GiB".to_owned())
}

/// Bytes as a person reads them.
pub fn bytes_in_words(bytes: u64) -> String {
    match bytes {
        0..1024 => format!("{bytes} bytes"),
        1024..1_048_576 => format!("{:.1} KiB", bytes as f64 / 1024.0),
        _ => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_read_in_all_its_units() {
        assert_eq!(bytes_from_words("64MiB"), Ok(64 << 20));
        assert_eq!(bytes_from_words("2 GiB"), Ok(2 << 30));
        assert_eq!(bytes_from_words("2048KiB"), Ok(2 << 20));
        assert_eq!(bytes_from_words("1048576"), Ok(1 << 20));
        assert_eq!(bytes_from_words("1048577B"), Ok((1 << 20) + 1));
    }

    #[test]
    fn memory_that_makes_no_sense_is_refused_with_what_would() {
        for (text, part) in [
            ("64MB", "`MB` is no unit"),
            ("", "as in 512MiB"),
            ("MiB", "as in 512MiB"),
            ("-5MiB", "no unit"),
            ("1.5GiB", "no unit"),
            ("1000", "at least 1MiB"),
            ("99999999999GiB", "at most"),
            ("99999999999999999999999", "as in 512MiB"),
        ] {
            let error = bytes_from_words(text).expect_err("it makes no sense");
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn the_message_says_what_where_the_value_what_is_legal_and_what_to_do() {
        let limit = Limit::new(Quantity::Plants, 12, 0..=10).of("on this ground").of("scatter");
        let message = limit.remedy("choose a wider `spacing`").to_string();
        let expected = "scatter: on this ground: 12 plants, at most 10 are allowed; choose a wider `spacing`";
        assert_eq!(message, expected);
        let zero = Limit::new(Quantity::CellsPerSide, 0, 1..=9).to_string();
        assert_eq!(zero, "0 cells a side, 1 to 9 are allowed");
        let samples = Limit::new(Quantity::SamplesPerPixel, 3, 1..=4).to_string();
        assert_eq!(samples, "3 samples per pixel, 1 or 4 are allowed");
        let other = Limit::new(Quantity::CellsPerSide, 8, 9..=9).to_string();
        assert_eq!(other, "8 cells a side, only 9 are allowed");
        let uncounted = Limit::new(Quantity::Vertices, None, 0..=100).of("a mesh").to_string();
        assert_eq!(uncounted, "a mesh: more than the 100 vertices that are allowed");
    }

    #[test]
    fn bytes_are_rounded_only_where_both_amounts_stay_apart() {
        let file = |bytes: u64| Limit::new(Quantity::FileBytes, bytes, 0..=u64::from(u32::MAX)).to_string();
        assert_eq!(file(5 << 30), "5120.0 MiB, at most 4096.0 MiB are allowed");
        assert_eq!(file(1 << 32), "4294967296 bytes, at most 4294967295 bytes are allowed");
        let memory = Limit::new(Quantity::MemoryBytes, 3000, 0..=100).to_string();
        assert_eq!(memory, "2.9 KiB of memory, at most 100 bytes are allowed");
    }
}

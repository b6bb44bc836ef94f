//! The words and numbers above the rows.

use super::super::{Fault, Limits};
use weald_core::grid::Size;

/// What the words above the rows say.
#[derive(Debug)]
pub(super) struct Header {
    pub(super) size: Size,
    /// South-western corner of the grid, in CRS units.
    pub(super) corner: [f64; 2],
    /// Width and height of a cell, in CRS units.
    pub(super) pixel: [f64; 2],
    /// The number that stands for no-data.
    pub(super) no_data: f32,
}

/// The number that stands for no-data where the header names none (Esri, "Esri ASCII raster format").
pub(super) const USUAL_NO_DATA: f32 = -9999.0;

/// The words as they stand.
#[derive(Debug, Default)]
struct Words {
    columns: Option<usize>,
    rows: Option<usize>,
    /// Coordinates, and whether they are those of the middle of the cell.
    x: Option<(f64, bool)>,
    y: Option<(f64, bool)>,
    cell: Option<f64>,
    dx: Option<f64>,
    dy: Option<f64>,
    no_data: Option<f32>,
}

impl Header {
    /// Reads the words; `tokens` then stands at the first value.
    pub(super) fn parse<'a>(
        tokens: &mut std::iter::Peekable<impl Iterator<Item = &'a str>>,
        limits: Limits,
    ) -> Result<Self, Fault> {
        let mut words = Words::default();
        while let Some(word) = tokens.next_if(|token| is_word(token)) {
            let number =
                tokens.next().ok_or_else(|| Fault::damaged(format!("the file ends after {word}")))?;
            words.set(word, number)?;
        }
        words.header(limits)
    }
}

/// Whether a token is a word of the header; `nan` and `inf` are numbers.
fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_ascii_alphabetic()) && token.parse::<f32>().is_err()
}

impl Words {
    fn set(&mut self, word: &str, number: &str) -> Result<(), Fault> {
        match word.to_ascii_lowercase().as_str() {
            "ncols" => self.columns = Some(parsed(word, number)?),
            "nrows" => self.rows = Some(parsed(word, number)?),
            "xllcorner" => self.x = Some((parsed(word, number)?, false)),
            "yllcorner" => self.y = Some((parsed(word, number)?, false)),
            "xllcenter" => self.x = Some((parsed(word, number)?, true)),
            "yllcenter" => self.y = Some((parsed(word, number)?, true)),
            "cellsize" => self.cell = Some(parsed(word, number)?),
            "dx" => self.dx = Some(parsed(word, number)?),
            "dy" => self.dy = Some(parsed(word, number)?),
            "nodata_value" => self.no_data = Some(parsed(word, number)?),
            _ => {
                return Err(Fault::damaged(format!(
                    "{word:?} is no word of an ESRI ASCII grid; those are ncols, nrows, xllcorner or xllcenter, \
                     yllcorner or yllcenter, cellsize (or dx and dy) and NODATA_value"
                )));
            }
        }
        Ok(())
    }

    fn header(&self, limits: Limits) -> Result<Header, Fault> {
        let size = limits.size(needed("ncols", self.columns)?, needed("nrows", self.rows)?)?;
        let pixel = match (self.cell, self.dx, self.dy) {
            (_, Some(dx), Some(dy)) => [dx, dy],
            (cell, _, _) => [needed("cellsize", cell)?; 2],
        };
        let corner = |(at, is_middle): (f64, bool), side: f64| if is_middle { at - 0.5 * side } else { at };
        let corner =
            [corner(needed("xllcorner", self.x)?, pixel[0]), corner(needed("yllcorner", self.y)?, pixel[1])];
        let is_legal = pixel.iter().all(|side| *side > 0.0 && side.is_finite());
        if !is_legal || !corner.iter().all(|coordinate| coordinate.is_finite()) {
            return Err(Fault::damaged(format!(
                "cells of {} × {} at {}, {}; sides must be above 0",
                pixel[0], pixel[1], corner[0], corner[1]
            )));
        }
        Ok(Header { size, corner, pixel, no_data: self.no_data.unwrap_or(USUAL_NO_DATA) })
    }
}

fn parsed<T: std::str::FromStr>(word: &str, number: &str) -> Result<T, Fault> {
    number.parse().map_err(|_| Fault::damaged(format!("{word} is {number:?}, which is no number for it")))
}

fn needed<T>(word: &str, value: Option<T>) -> Result<T, Fault> {
    value.ok_or_else(|| Fault::damaged(format!("the header has no {word}; this is no ESRI ASCII grid")))
}

//! Writing: `f32` in the fewest digits that bring the same bits back.

use std::fmt::Write;

use super::super::{Part, Raster};
use super::crs::{self, CRS_FILE};
use super::header::USUAL_NO_DATA;
use weald_core::error::Error;

/// The grid, and its CRS beside it where that can be spelled.
///
/// # Errors
/// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
pub fn encode(raster: &Raster) -> Result<Vec<Part>, Error> {
    raster.ensure_finite()?;
    // Where no number is declared, readers take the usual one for no-data.
    let is_usual = |value: &f32| *value == USUAL_NO_DATA;
    let declares = raster.valid.is_some() || raster.field.values().iter().any(is_usual);
    let no_data = declares.then(|| raster.number_for_no_data());
    let mut text = header(raster, no_data);
    for (y, row) in raster.field.values().chunks(raster.field.size().columns).enumerate() {
        for (x, value) in row.iter().enumerate() {
            let is_valid = raster.is_valid_at(y * row.len() + x);
            let value = if is_valid { *value } else { no_data.unwrap_or_default() };
            let space = if x + 1 == row.len() { '\n' } else { ' ' };
            write!(text, "{}{space}", digits(value)).expect("memory takes every byte");
        }
    }
    let wkt = raster.georeference.as_ref().and_then(crs::wkt);
    let beside = wkt.map(|wkt| Part::sibling(CRS_FILE, wkt.into_bytes()));
    Ok([Part::own(text.into_bytes())].into_iter().chain(beside).collect())
}

/// The words above the rows. A grid of unknown cells gets sides of 1, since the format must have some.
fn header(raster: &Raster, no_data: Option<f32>) -> String {
    let size = raster.field.size();
    let (corner, pixel) = match (&raster.georeference, raster.cell) {
        (Some(place), _) => {
            let height = size.rows as f64 * place.pixel[1];
            ([place.origin[0], south_of(place.origin[1], height)], place.pixel)
        }
        (None, cell) => ([0.0; 2], [cell.unwrap_or(1.0); 2]),
    };
    let sides = if pixel[0] == pixel[1] {
        format!("cellsize     {:?}", pixel[0])
    } else {
        format!("dx           {:?}\ndy           {:?}", pixel[0], pixel[1])
    };
    let mut text = format!(
        "ncols        {}\nnrows        {}\nxllcorner    {:?}\nyllcorner    {:?}\n{sides}\n",
        size.columns, size.rows, corner[0], corner[1]
    );
    if let Some(number) = no_data {
        writeln!(text, "NODATA_value {}", digits(number)).expect("memory takes every byte");
    }
    text
}

/// The southern edge from which the northern one comes back to the bit, or as near as its digits allow.
fn south_of(north: f64, height: f64) -> f64 {
    let south = north - height;
    let candidates = [south, south.next_up(), south.next_down()];
    candidates.into_iter().find(|south| south + height == north).unwrap_or(south)
}

/// The fewest digits; a point or an exponent tells clients that the grid holds no integers. NaN in the
/// spelling that GDAL reads.
fn digits(value: f32) -> String {
    if value.is_nan() { "nan".to_owned() } else { format!("{value:?}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_northern_edge_comes_back() {
        for (north, height) in
            [(4_069_271.263_471_795, 32_640.0), (36.733_333_333_333_334, 0.286_666_7), (0.1, 0.3)]
        {
            assert_eq!(south_of(north, height) + height, north, "{north} and {height}");
        }
    }
}

//! Georeferencing: the GeoTIFF keys, the pixel scale and the tie point.

use super::super::Fault;
use super::super::geokeys::{
    PIXEL_IS_AREA, PIXEL_IS_POINT, RASTER_TYPE, ensure_mapped, epsg, metres_per_unit, set_short,
    vertical_unit,
};
use super::directory::Directory;
use super::directory::tag;
use weald_core::domain::{GeoKeys, Georeference};

/// Sides of a cell may differ by this share and still be called square: what decimal digits lose.
const SQUARE: f64 = 1e-9;

/// What a file says about its place.
#[derive(Debug)]
pub(super) struct Place {
    /// Side of the cells in metres, where they are square and not in degrees.
    pub(super) cell: Option<f64>,
    pub(super) georeference: Option<Georeference>,
    /// Whether the first row of the file is the southern one.
    pub(super) is_south_up: bool,
    /// Unit of the heights by the CRS, where it has one for them.
    pub(super) vertical: Option<String>,
}

/// Where the cells of a file lie.
pub(super) fn place(directory: &Directory<'_>) -> Result<Place, Fault> {
    let mut keys = keys_of(directory)?;
    let vertical = keys.as_ref().and_then(vertical_unit);
    keys.as_ref().map(ensure_mapped).transpose()?;
    let Some(Affine { mut origin, steps }) = affine(directory)? else {
        return Ok(Place { cell: None, georeference: None, is_south_up: false, vertical });
    };
    if let Some(keys) = &mut keys
        && keys.short(RASTER_TYPE) == Some(PIXEL_IS_POINT)
    {
        // The tie point is the centre of its cell; Weald and most software count from the corner.
        origin = [origin[0] - 0.5 * steps[0], origin[1] - 0.5 * steps[1]];
        set_short(keys, RASTER_TYPE, PIXEL_IS_AREA);
    }
    let is_south_up = steps[1] > 0.0;
    if is_south_up {
        origin[1] += directory.needed(tag::IMAGE_LENGTH)? as f64 * steps[1];
    }
    let pixel = [steps[0], steps[1].abs()];
    let metres = metres_per_unit(keys.as_ref())?;
    let georeference = Georeference { epsg: keys.as_ref().and_then(epsg), origin, pixel, keys };
    let square = (pixel[0] - pixel[1]).abs() <= SQUARE * pixel[0];
    let cell = (square && !georeference.is_geographic()).then_some(pixel[0] * metres);
    Ok(Place { cell, georeference: Some(georeference), is_south_up, vertical })
}

/// Corner of the first cell, and the steps to the next column and the next row, in CRS units.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Affine {
    origin: [f64; 2],
    steps: [f64; 2],
}

fn affine(directory: &Directory<'_>) -> Result<Option<Affine>, Fault> {
    if let Some(matrix) = directory.doubles(tag::MODEL_TRANSFORMATION)? {
        return from_matrix(&matrix).map(Some);
    }
    let tie = directory.doubles(tag::MODEL_TIE_POINT)?.unwrap_or_default();
    match (directory.doubles(tag::MODEL_PIXEL_SCALE)?.as_deref(), tie.as_slice()) {
        (None, []) => Ok(None),
        (Some([width, height, ..]), [column, row, _, x, y, _]) => {
            // Some writers give the step to the south its sign.
            let height = height.abs();
            checked([x - column * width, y + row * height], [*width, -height]).map(Some)
        }
        (scale, tie) => Err(Fault::damaged(format!(
            "{} numbers of pixel scale and {} of tie points place the file; one tie point of 6 numbers with a \
             scale of 3 is read: rectify control points with gdalwarp",
            scale.map_or(0, <[f64]>::len),
            tie.len()
        ))),
    }
}

fn from_matrix(matrix: &[f64]) -> Result<Affine, Fault> {
    let &[width, shear_x, _, x, shear_y, down, _, y, ..] = matrix else {
        return Err(Fault::damaged(format!("a model transformation of {} numbers, not 16", matrix.len())));
    };
    if shear_x != 0.0 || shear_y != 0.0 {
        return Err(Fault::damaged(format!(
            "the grid is rotated or sheared (model transformation terms {shear_x} and {shear_y}); turn it north \
             with gdalwarp"
        )));
    }
    checked([x, y], [width, down])
}

fn checked(origin: [f64; 2], steps: [f64; 2]) -> Result<Affine, Fault> {
    let proper = steps[0] > 0.0 && steps[1] != 0.0 && steps.iter().all(|step| step.is_finite());
    if proper && origin.iter().all(|coordinate| coordinate.is_finite()) {
        return Ok(Affine { origin, steps });
    }
    Err(Fault::damaged(format!(
        "cells of {} × {} at {}, {}; sides must be above 0 with columns from west to east: gdalwarp rectifies",
        steps[0], -steps[1], origin[0], origin[1]
    )))
}

fn keys_of(directory: &Directory<'_>) -> Result<Option<GeoKeys>, Fault> {
    let Some(numbers) = directory.numbers(tag::GEO_KEY_DIRECTORY)? else { return Ok(None) };
    let ascii = directory.text(tag::GEO_ASCII_PARAMETERS)?.unwrap_or_default();
    Ok(Some(GeoKeys {
        directory: numbers.into_iter().map(|number| number as u16).collect(),
        doubles: directory.doubles(tag::GEO_DOUBLE_PARAMETERS)?.unwrap_or_default(),
        // One character a byte, as the keys count bytes; the standard allows 7-bit ASCII alone.
        ascii: ascii.iter().map(|&byte| if byte.is_ascii() { byte as char } else { '?' }).collect(),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_without_rotation_is_a_corner_and_a_cell() {
        let mut matrix = [0.0; 16];
        (matrix[0], matrix[3], matrix[5], matrix[7]) = (30.0, 500.0, -20.0, 900.0);
        let expected = Affine { origin: [500.0, 900.0], steps: [30.0, -20.0] };
        assert_eq!(from_matrix(&matrix), Ok(expected));
        matrix[1] = 1e-3;
        assert!(from_matrix(&matrix).is_err_and(|fault| fault.to_string().contains("gdalwarp")));
        assert!(from_matrix(&matrix[..4]).is_err());
    }

    #[test]
    fn cells_without_a_size_or_a_place_are_refused() {
        for (origin, pixel) in [
            ([0.0, 0.0], [0.0, 1.0]),
            ([0.0, 0.0], [1.0, 0.0]),
            ([0.0, 0.0], [-1.0, 1.0]),
            ([0.0, 0.0], [f64::NAN, 1.0]),
            ([0.0, 0.0], [1.0, f64::INFINITY]),
            ([f64::NAN, 0.0], [1.0, 1.0]),
        ] {
            assert!(checked(origin, pixel).is_err(), "cells of {pixel:?} at {origin:?}");
        }
    }
}

//! Where a landscape lies, on its way from and to Python.

use pyo3::prelude::*;
use weald::domain::Georeference;
use weald::{Domain, Error, Size};

/// What a caller says of the grid of an array.
#[derive(FromPyObject)]
pub(crate) struct Place {
    /// Width of the square cells in metres.
    #[pyo3(item)]
    cell: Option<f64>,
    /// EPSG code of the CRS.
    #[pyo3(item)]
    epsg: Option<u32>,
    /// Easting and northing of the outer north-western corner, in units of the CRS.
    #[pyo3(item)]
    origin: Option<[f64; 2]>,
    /// Width and height of a cell in units of the CRS, both positive.
    #[pyo3(item)]
    pixel: Option<[f64; 2]>,
}

/// Widths of cells that differ by no more than this share are the same: they come out of divisions.
const ALIKE: f64 = 1e-6;

impl Place {
    /// The grid of so many cells at this place.
    pub(crate) fn domain(&self, size: Size) -> Result<Domain, Error> {
        let georeference = match (self.origin, self.pixel) {
            (Some(origin), Some(pixel)) => Some(Georeference { epsg: self.epsg, origin, pixel, keys: None }),
            _ => None,
        };
        let cell = self.cell.or(self.pixel.map(|pixel| pixel[0]));
        let cell = cell.filter(|cell| cell.is_finite() && *cell > 0.0);
        let Some(cell) = cell else {
            return Err(Error::Run("give `cell`, the width of a cell in metres, above 0".to_owned()));
        };
        if let (Some(place), Some([width, height])) = (&georeference, self.pixel) {
            let are_metres = !place.is_geographic();
            let are_square = [width, height].iter().all(|side| (side - cell).abs() <= ALIKE * cell);
            if !(are_metres && are_square) {
                let unit = if are_metres { "CRS units" } else { "degrees" };
                return Err(Error::Run(format!(
                    "cells of {width} × {height} {unit} are no squares of {cell} m: reproject the raster to a CRS of \
                     metres (`da.rio.reproject`), or give its file to `Landscape.open`, which does that"
                )));
            }
        }
        Ok(Domain { georeference, ..Domain::new(size, cell) })
    }
}

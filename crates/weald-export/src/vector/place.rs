//! From metres on the grid to coordinates of a map.

use weald_core::domain::{Domain, Georeference};

/// The coordinates of a file: those of the CRS, or metres from the south-western corner where there is none.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place<'a>(pub(crate) &'a Domain);

impl Place<'_> {
    /// Easting (or longitude) and northing (or latitude) of a point that lies `x` metres east of the western and `y`
    /// metres south of the northern edge of the grid.
    pub(crate) fn at(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let domain = self.0;
        match &domain.georeference {
            Some(place) => place.at([x / domain.cell, y / domain.cell]),
            None => [x, domain.size.rows as f64 * domain.cell - y],
        }
    }

    /// Digits behind the point of a coordinate that stand for a millimetre or so.
    pub(crate) fn digits(self) -> u32 {
        if self.0.georeference.as_ref().is_some_and(Georeference::is_geographic) { 8 } else { 3 }
    }

    /// The EPSG code of the CRS.
    pub(crate) fn epsg(self) -> Option<u32> {
        self.0.georeference.as_ref()?.epsg
    }

    /// What the user should know of coordinates that no CRS is named for.
    pub(crate) fn note(self) -> Option<String> {
        let text = match &self.0.georeference {
            Some(place) if place.epsg.is_some() => return None,
            Some(_) => {
                "the CRS has no EPSG code, without which GeoJSON cannot name it; coordinates are in its units"
            }
            None => {
                "the landscape is not georeferenced; coordinates are metres from its south-western corner, y \
                 northward, and the file says so in words that GDAL and QGIS read"
            }
        };
        Some(text.to_owned())
    }
}

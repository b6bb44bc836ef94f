//! The ground a landscape stands on: its grid, the size of its cells, its georeference, its no-data mask.

use serde::{Deserialize, Serialize};

use crate::grid::{Mask, Size};

/// Grid, cell size, georeference and no-data mask, shared by all layers of a landscape.
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    /// Columns and rows.
    pub size: Size,
    /// Side of the square cells in metres.
    pub cell: f64,
    /// CRS and origin, where the ground came from a georeferenced file.
    pub georeference: Option<Georeference>,
    /// Cells with data; `None` where all have.
    pub valid: Option<Mask>,
    /// The finest grid over the same ground on which this landscape is meant to be made. Where it is finer than `size`,
    /// ground is generated on it and a cell has the mean; a recipe's first steps that shape ground all run on it.
    pub finest: Option<Size>,
    /// Height of the [sea](crate::sea) in metres, where there is one.
    pub sea_level: Option<f64>,
}

impl Domain {
    /// A domain without a georeference, no-data cells and a sea.
    pub fn new(size: Size, cell: f64) -> Self {
        Self { size, cell, georeference: None, valid: None, finest: None, sea_level: None }
    }

    /// Number of cells with data.
    pub fn valid_cells(&self) -> usize {
        self.valid.as_ref().map_or(self.size.cells(), Mask::valid_cells)
    }

    /// Metres from west to east and from north to south.
    pub fn extent(&self) -> [f64; 2] {
        [self.size.columns, self.size.rows].map(|count| count as f64 * self.cell)
    }

    /// Area of one cell in square metres.
    pub fn cell_area(&self) -> f64 {
        self.cell * self.cell
    }
}

/// Where the grid lies in a coordinate reference system (CRS).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Georeference {
    /// EPSG code of the CRS, where the file names one.
    pub epsg: Option<u32>,
    /// CRS coordinates of the outer corner of the north-western cell: easting (or longitude) and northing
    /// (or latitude).
    pub origin: [f64; 2],
    /// Width and height of a cell in CRS units (metres or degrees), both positive; rows go south.
    pub pixel: [f64; 2],
    /// The GeoTIFF keys as read, so that a CRS without an EPSG code survives unchanged.
    pub keys: Option<GeoKeys>,
}

impl Georeference {
    /// CRS coordinates of the point that lies so many `columns` east and `rows` south of the north-western corner;
    /// the centre of cell (`x`, `y`) is at `[x + 0.5, y + 0.5]`.
    pub fn at(&self, [columns, rows]: [f64; 2]) -> [f64; 2] {
        [self.origin[0] + columns * self.pixel[0], self.origin[1] - rows * self.pixel[1]]
    }

    /// CRS coordinates of the middle of a grid.
    pub fn middle(&self, size: Size) -> [f64; 2] {
        self.at([size.columns, size.rows].map(|count| 0.5 * count as f64))
    }

    /// Whether the CRS counts in degrees of longitude and latitude.
    pub fn is_geographic(&self) -> bool {
        match &self.keys {
            Some(keys) => keys.is_geographic(),
            None => self.epsg.is_some_and(|code| (4000..5000).contains(&code)),
        }
    }
}

/// The three GeoTIFF key tags as they stand in a file.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub struct GeoKeys {
    /// `GeoKeyDirectoryTag` (34735): header of four numbers, then four a key.
    pub directory: Vec<u16>,
    /// `GeoDoubleParamsTag` (34736).
    pub doubles: Vec<f64>,
    /// `GeoAsciiParamsTag` (34737).
    pub ascii: String,
}

impl GeoKeys {
    const MODEL_TYPE: u16 = 1024;
    const MODEL_GEOGRAPHIC: u16 = 2;

    /// The value of a key that is stored in the directory itself.
    pub fn short(&self, key: u16) -> Option<u16> {
        self.directory.get(4..)?.chunks_exact(4).find(|entry| entry[0] == key && entry[1] == 0).map(|e| e[3])
    }

    /// Whether the model type is longitude and latitude.
    pub fn is_geographic(&self) -> bool {
        self.short(Self::MODEL_TYPE) == Some(Self::MODEL_GEOGRAPHIC)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_go_east_and_rows_go_south() {
        let place = Georeference { epsg: None, origin: [10.0, 40.0], pixel: [2.0, 3.0], keys: None };
        assert_eq!(place.at([0.0; 2]), [10.0, 40.0]);
        assert_eq!(place.at([0.5, 0.5]), [11.0, 38.5]);
        assert_eq!(place.middle(Size { columns: 5, rows: 4 }), [15.0, 34.0]);
    }
}

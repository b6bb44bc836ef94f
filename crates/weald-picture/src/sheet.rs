//! The sheet a landscape is drawn on: how many pixels, and where each lies on the grid.

use weald_core::domain::Domain;
use weald_core::error::{Error, Limit, Quantity};
use weald_core::grid::Size;

/// Least length of a picture's longer side where the recipe does not choose, in pixels: small grids are
/// drawn on a finer sheet, so that their slopes and lines come out smooth.
const MIN_DEFAULT_SIDE: usize = 1024;

/// Greatest length of a picture's longer side where the recipe does not choose, in pixels.
const MAX_DEFAULT_SIDE: usize = 4096;

/// Most pixels of a picture: 2^27, 400 MB of colour.
const MAX_PIXELS: f64 = (1_u32 << 27) as f64;

/// Width and height of a picture in pixels, and its scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sheet {
    /// Pixels from west to east.
    pub(super) width: usize,
    /// Pixels from north to south.
    pub(super) height: usize,
    /// Columns and rows of the grid that is drawn.
    pub(super) grid: Size,
    /// Side of a pixel in metres.
    pub(super) metres_per_pixel: f64,
}

/// Whether a texture of that width over all cells, or of one that suits the grid, is within the limit of pictures.
///
/// # Errors
/// [`Error::Limit`] where it is not.
pub fn fits_on_sheet(domain: &Domain, width: Option<u32>) -> Result<(), Error> {
    Sheet::new(domain, width).map(drop)
}

impl Sheet {
    /// A sheet of that width, or of one that suits the grid.
    ///
    /// # Errors
    /// [`Error::Limit`] where the picture would hold more than 2^27 pixels.
    pub(super) fn new(domain: &Domain, width: Option<u32>) -> Result<Self, Error> {
        let grid = domain.size;
        let width = width.map_or_else(|| default_width(grid), |width| width as usize);
        let height = (grid.rows as f64 * width as f64 / grid.columns as f64).round().max(1.0);
        if width as f64 * height > MAX_PIXELS {
            let limit = Limit::new(Quantity::Pixels, (width as f64 * height) as u64, 0..=MAX_PIXELS as u64);
            let subject = format!("a picture of {width} × {height} pixels for a grid of {grid} cells");
            return Err(limit.of(subject).remedy("choose a smaller `width`").into());
        }
        let metres_per_pixel = domain.cell * grid.columns as f64 / width as f64;
        Ok(Self { width, height: height as usize, grid, metres_per_pixel })
    }

    /// Pixels a cell along a row.
    pub(super) fn across(&self) -> f64 {
        self.width as f64 / self.grid.columns as f64
    }

    /// Pixels a cell along a column.
    pub(super) fn down(&self) -> f64 {
        self.height as f64 / self.grid.rows as f64
    }

    /// Width in pixels of a line that is one pixel wide on a sheet of 1024: lines keep their share of the
    /// picture.
    pub(super) fn line(&self) -> f32 {
        (self.width.max(self.height) as f32 / 1024.0).clamp(0.5, 4.0)
    }
}

fn default_width(grid: Size) -> usize {
    let longer = grid.columns.max(grid.rows);
    let wanted = longer.clamp(MIN_DEFAULT_SIDE, MAX_DEFAULT_SIDE);
    (grid.columns * wanted).div_ceil(longer)
}

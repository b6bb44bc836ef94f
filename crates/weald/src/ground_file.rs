//! A raster file that becomes the ground of a landscape.

use std::path::Path;

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Mask;
use weald_core::landscape::Landscape;
use weald_io as io;

/// The landscape whose layer `height` is a raster file, in square cells of metres, and texts that tell the user what had
/// to be done to it. `cell` is the width of the cells in metres, for a file that does not say it.
pub(crate) fn read(path: &Path, cell: Option<f64>) -> Result<(Landscape, Vec<String>), Error> {
    let mut raster = io::read(path)?;
    let mut notes = raster.notes.clone();
    match (raster.cell, cell) {
        (Some(found), Some(given)) if found != given => {
            return Err(Error::input(
                path,
                format!("its cells are {found} m wide, but the recipe says `cell = {given}`; remove `cell`"),
            ));
        }
        (None, Some(given)) if raster.georeference.is_none() => raster.cell = Some(given),
        _ => {}
    }
    let (raster, note) = io::square(raster).map_err(|error| match error {
        Error::Run(what) => Error::input(path, what),
        other => other,
    })?;
    notes.extend(note);
    let side = raster.cell.filter(|side| side.is_finite() && *side > 0.0);
    let side = side.ok_or_else(|| Error::input(path, "has no cell size; give `cell` in [landscape]"))?;
    if raster.valid.as_ref().map_or(0, Mask::valid_cells) == 0 && raster.valid.is_some() {
        return Err(Error::input(path, "has no cell with data, so there is no ground to work on"));
    }
    let size = raster.field.size();
    let domain = Domain { size, cell: side, georeference: raster.georeference, valid: raster.valid };
    let mut landscape = Landscape::new(domain);
    landscape.insert("height", "m", raster.field);
    Ok((landscape, notes))
}

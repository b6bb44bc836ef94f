//! A layer as a raster: with the cell, the georeferencing and the mask of its landscape.

use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_export::classes::classes;
use weald_export::shades::shades;
use weald_io::Raster;

/// The layer with 0 in its no-data cells.
pub(crate) fn raster(landscape: &Landscape, name: &str) -> Result<Raster, Error> {
    let domain = &landscape.domain;
    let mut field = landscape.field(name)?.clone();
    if let Some(valid) = &domain.valid {
        for (value, &is_valid) in field.values_mut().iter_mut().zip(valid.flags()) {
            *value = if is_valid { *value } else { 0.0 };
        }
    }
    Ok(Raster {
        classes: classes(landscape, name)?,
        shades: shades(name),
        valid: domain.valid.clone(),
        cell: Some(domain.cell),
        georeference: domain.georeference.clone(),
        ..Raster::from(field)
    })
}

//! A raster file that becomes a layer on ground which is there already.

use std::path::PathBuf;

use weald_core::domain::{Domain, Georeference};
use weald_core::error::Error;
use weald_core::grid::{Field, Mask};
use weald_io::{self as io, Raster};
use weald_land::combine::resample::resampled;

/// A file and what its values mean: `scale` times the value, plus `offset`.
#[derive(Clone, Debug)]
pub(super) struct LayerFile {
    pub(super) path: PathBuf,
    pub(super) scale: f64,
    pub(super) offset: f64,
    /// Whether another number of cells is brought to that of the landscape.
    pub(super) resample: bool,
    /// Value of the layer where the file has no data.
    pub(super) no_data: Option<f64>,
}

/// What to do where a file is in another coordinate reference system than the landscape, as the beginning of advice.
fn other_crs(place: Option<&Georeference>, domain: &Domain) -> String {
    let [there, here] = [place, domain.georeference.as_ref()].map(|place| place.and_then(|place| place.epsg));
    match (there, here) {
        (Some(there), Some(here)) if there != here => format!(
            "it is in EPSG:{there}, the landscape in EPSG:{here}: warp it, as by gdalwarp -t_srs EPSG:{here}; or "
        ),
        _ => String::new(),
    }
}

impl LayerFile {
    /// The layer, and texts that tell the user what had to be done to it.
    pub(super) fn read(&self, domain: &Domain) -> Result<(Field, Vec<String>), Error> {
        let mut raster = io::read(&self.path)?;
        let mut notes = std::mem::take(&mut raster.notes);
        if raster.georeference.is_some() {
            let (square, note) = io::square(raster).map_err(|error| self.of_this_file(error))?;
            raster = square;
            notes.extend(note);
        }
        notes.extend(self.elsewhere(raster.georeference.as_ref(), domain));
        let (mut field, valid) = self.fitted(raster, domain)?;
        for value in field.values_mut() {
            *value = (f64::from(*value) * self.scale + self.offset) as f32;
        }
        self.fill(&mut field, valid.as_ref(), domain.valid.as_ref())?;
        Ok((field, notes))
    }

    fn of_this_file(&self, error: Error) -> Error {
        match error {
            Error::Run(what) => Error::input(&self.path, what),
            other => other,
        }
    }

    /// The values and the cells with data, as many as the landscape has.
    fn fitted(&self, raster: Raster, domain: &Domain) -> Result<(Field, Option<Mask>), Error> {
        let size = raster.field.size();
        if size == domain.size {
            return Ok((raster.field, raster.valid));
        }
        let crs = other_crs(raster.georeference.as_ref(), domain);
        if self.resample {
            let old = Domain { valid: raster.valid, ..Domain::new(size, 1.0) };
            return resampled(&old, &raster.field, domain.size).map_err(|error| self.of_this_file(error));
        }
        Err(Error::input(
            &self.path,
            format!(
                "has {size} cells, but the landscape has {}; {crs}give a file of that size, or `resample = true` in \
                 its `load` step",
                domain.size
            ),
        ))
    }

    /// Gives cells without data their value, where the landscape has any.
    fn fill(&self, field: &mut Field, data: Option<&Mask>, valid: Option<&Mask>) -> Result<(), Error> {
        let Some(data) = data else { return Ok(()) };
        let columns = field.size().columns;
        for (cell, value) in field.values_mut().iter_mut().enumerate() {
            if data.is_valid_at(cell) {
                continue;
            }
            *value = self.no_data.unwrap_or(0.0) as f32;
            if self.no_data.is_none() && valid.is_none_or(|valid| valid.is_valid_at(cell)) {
                let (x, y) = (cell % columns, cell / columns);
                return Err(Error::input(
                    &self.path,
                    format!(
                        "column {x}, row {y} has no data, where the landscape has ground; mend the file, or \
                         load it in a step that gives `no_data` a value"
                    ),
                ));
            }
        }
        Ok(())
    }

    /// A note where the file lies elsewhere on Earth than the landscape.
    fn elsewhere(&self, place: Option<&Georeference>, domain: &Domain) -> Option<String> {
        let (there, here) = (place?, domain.georeference.as_ref()?);
        let apart = |axis: usize| (there.origin[axis] - here.origin[axis]).abs() > 0.5 * here.pixel[axis];
        (apart(0) || apart(1)).then(|| {
            format!(
                "{} begins at {}, {} on Earth, the landscape at {}, {}; it is laid on the landscape cell by \
                 cell all the same",
                self.path.display(),
                there.origin[0],
                there.origin[1],
                here.origin[0],
                here.origin[1]
            )
        })
    }
}

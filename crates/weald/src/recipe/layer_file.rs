//! A raster file that becomes a layer on ground which is there already.

use std::ops::Range;
use std::path::PathBuf;

use crate::file_rows;
use weald_core::domain::{Domain, Georeference};
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};
use weald_core::parameter::{Choice, CrsCode};
use weald_io::{self as io, Raster, RowsOfFile, Said};
use weald_land::combine::resample::resampled;

weald_core::choices! {
    /// Units of the values of a file.
    pub enum FileUnit {
        /// Metres.
        Metre = "m",
        /// Feet of 0.3048 m.
        Foot = "ft",
        /// Feet of surveys in the United States, of 1200/3937 m.
        SurveyFoot = "us-ft",
        /// Kilometres.
        Kilometre = "km",
        /// Decimetres.
        Decimetre = "dm",
        /// Centimetres.
        Centimetre = "cm",
        /// Millimetres.
        Millimetre = "mm",
        /// Numbers that are no lengths, as masks have; they stay what they are.
        None = "1",
    }
}

/// What keys say of a file.
pub(super) fn said(crs: Option<CrsCode>, unit: Option<FileUnit>, no_data: Option<f64>) -> Said {
    let unit = unit.map(|unit| unit.as_word().to_owned());
    Said { crs: crs.map(|code| code.0), unit, no_data }
}

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
    /// What the file does not say itself; its `no_data` is a number in the file, the one above a value of the layer.
    pub(super) said: Said,
    /// Whether it may lie elsewhere on Earth than the landscape.
    pub(super) elsewhere: bool,
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
    /// A file whose values are metres.
    pub(super) fn plain(path: PathBuf) -> Self {
        let (scale, offset) = (1.0, 0.0);
        let said = Said::default();
        Self { path, scale, offset, resample: false, no_data: None, said, elsewhere: false }
    }

    /// The layer, and texts that tell the user what had to be done to it.
    pub(super) fn read(&self, domain: &Domain) -> Result<(Field, Vec<String>), Error> {
        let (mut raster, mut notes) = self.known(io::read(&self.path)?)?;
        if raster.georeference.is_some() {
            let (square, note) = io::square(raster).map_err(|error| self.of_this_file(error))?;
            raster = square;
            notes.extend(note);
        }
        notes.extend(self.elsewhere((&raster, raster.field.size()), domain)?);
        let (field, valid) = self.fitted(raster, domain)?;
        Ok((self.metres(field, valid.as_ref(), (domain.valid.as_ref(), 0))?, notes))
    }

    /// Opens the file, of as many square cells as the landscape, to read rows of it.
    ///
    /// # Errors
    /// As [`LayerFile::read`], as far as the first row shows it; [`Error::Input`] where the whole would be needed.
    pub(super) fn rows(&self, domain: &Domain) -> Result<LayerRows<'_>, Error> {
        let mut rows = LayerRows { of: self, file: io::open_rows(&self.path)?, notes: Vec::new() };
        let size = rows.file.size();
        if size != domain.size {
            let Size { columns, rows } = domain.size;
            return Err(Error::input(
                &self.path,
                format!(
                    "has {size} cells, but the landscape has {}; on disk or over ranks it must have as many: gdalwarp -ts \
                     {columns} {rows}",
                    domain.size
                ),
            ));
        }
        let (raster, notes) = rows.read(0..1)?;
        rows.notes = notes;
        rows.notes.extend(self.elsewhere((&raster, size), domain)?);
        Ok(rows)
    }

    /// What a file holds, with what the recipe says of it.
    fn known(&self, raster: Raster) -> Result<(Raster, Vec<String>), Error> {
        let mut raster = self.said.of(raster).map_err(|what| Error::input(&self.path, what))?;
        let notes = std::mem::take(&mut raster.notes);
        self.ensure_unit(raster.unit())?;
        Ok((raster, notes))
    }

    /// Rows of the layer, from one of the landscape on, in metres.
    fn metres(
        &self,
        mut field: Field,
        data: Option<&Mask>,
        (valid, first): (Option<&Mask>, usize),
    ) -> Result<Field, Error> {
        for value in field.values_mut() {
            *value = (f64::from(*value) * self.scale + self.offset) as f32;
        }
        self.fill(&mut field, data, (valid, first))?;
        Ok(field)
    }

    /// Refuses values that are neither lengths nor numbers alone, unless the recipe says what they stand for.
    fn ensure_unit(&self, unit: Option<&str>) -> Result<(), Error> {
        let unit = unit.filter(|unit| !["m", "1"].contains(unit));
        let Some(unit) = unit.filter(|_| self.scale == 1.0) else { return Ok(()) };
        Err(Error::input(
            &self.path,
            format!(
                "its values are in {unit}, and a layer is in metres; say what a 1 stands for in a `load` step: `unit = \
                 \"1\"` takes the numbers as they are, `scale` makes metres of them"
            ),
        ))
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
    fn fill(
        &self,
        field: &mut Field,
        data: Option<&Mask>,
        (valid, first): (Option<&Mask>, usize),
    ) -> Result<(), Error> {
        let Some(data) = data else { return Ok(()) };
        let columns = field.size().columns;
        for (cell, value) in field.values_mut().iter_mut().enumerate() {
            if data.is_valid_at(cell) {
                continue;
            }
            *value = self.no_data.unwrap_or(0.0) as f32;
            if self.no_data.is_none() && valid.is_none_or(|valid| valid.is_valid_at(cell)) {
                let (x, y) = (cell % columns, first + cell / columns);
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

    /// Where the file lies elsewhere on Earth than the landscape: an error, or a note where that is wanted.
    fn elsewhere(&self, (raster, size): (&Raster, Size), domain: &Domain) -> Result<Option<String>, Error> {
        let (Some(there), Some(here)) = (&raster.georeference, &domain.georeference) else { return Ok(None) };
        let corners = |place: &Georeference, size: Size| {
            let far = [size.columns as f64, size.rows as f64];
            [place.at([0.0; 2]), place.at(far)].concat()
        };
        let (theirs, ours) = (corners(there, size), corners(here, domain.size));
        let apart = |axis: usize| (theirs[axis] - ours[axis]).abs() > 0.5 * here.pixel[axis % 2];
        let crs = other_crs(Some(there), domain);
        // A grid of no place, as Weald writes it.
        let is_nowhere = there.epsg.is_none() && there.keys.is_none() && theirs[0] == 0.0 && theirs[3] == 0.0;
        if is_nowhere || (crs.is_empty() && !(0..4).any(apart)) {
            return Ok(None);
        }
        let reaches = |at: &[f64]| format!("from {}, {} to {}, {}", at[0], at[1], at[2], at[3]);
        let (theirs, ours) = (reaches(&theirs), reaches(&ours));
        let told = format!("it reaches {theirs} on Earth, the landscape {ours}");
        if self.elsewhere {
            let path = self.path.display();
            return Ok(Some(format!(
                "{path}: {told}; it is laid on the landscape cell by cell all the same"
            )));
        }
        let remedy = format!(
            "{crs}cut it out of a larger file, as by gdalwarp -te; or load it in a step that says `elsewhere = true`, \
             which lays it on the landscape cell by cell"
        );
        Err(Error::input(&self.path, format!("{told}: {remedy}")))
    }
}

/// A file of which rows become those of a layer.
pub(super) struct LayerRows<'a> {
    of: &'a LayerFile,
    file: Box<dyn RowsOfFile>,
    /// What the user should know of the file.
    pub(super) notes: Vec<String>,
}

impl LayerRows<'_> {
    /// Some rows in runs that are worth reading at a time.
    pub(super) fn runs_of_rows(&self, rows: Range<usize>) -> impl Iterator<Item = Range<usize>> + use<> {
        file_rows::runs_of_rows(&*self.file, rows)
    }

    /// Rows of the layer, of which these cells have data in the landscape.
    ///
    /// # Errors
    /// As [`LayerFile::read`], where these rows show it; [`Error::Limit`] where the memory is too little.
    pub(super) fn values(
        &self,
        rows: Range<usize>,
        valid: Option<&Mask>,
        memory: u64,
    ) -> Result<Field, Error> {
        file_rows::ensure_memory(&self.of.path, &*self.file, memory)?;
        let first = rows.start;
        let (raster, _) = self.read(rows)?;
        self.of.metres(raster.field, raster.valid.as_ref(), (valid, first))
    }

    fn read(&self, rows: Range<usize>) -> Result<(Raster, Vec<String>), Error> {
        let path = &self.of.path;
        let (raster, notes) = self.of.known(self.file.rows(rows).map_err(|fault| fault.of(path))?)?;
        if raster.georeference.is_none() {
            return Ok((raster, notes));
        }
        match io::square(raster).map_err(|error| self.of.of_this_file(error))? {
            (raster, None) => Ok((raster, notes)),
            (_, Some(note)) => {
                let remedy = "which needs the whole in memory: gdalwarp it to square cells of metres";
                Err(Error::input(path, format!("{note}; {remedy}")))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(east: f64, epsg: u32) -> Georeference {
        Georeference { epsg: Some(epsg), origin: [east, 4e6], pixel: [10.0; 2], keys: None }
    }

    /// A file on a landscape of 4 × 3 cells at 500,000 m east in EPSG:32633.
    fn load(
        georeference: Option<Georeference>,
        change: impl Fn(&mut LayerFile),
    ) -> Result<(f32, usize), String> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("layer.tif");
        let size = Size { columns: 4, rows: 3 };
        let raster = Raster { georeference, cell: Some(10.0), ..Raster::from(Field::filled(size, 2.0)) };
        io::write(&path, &raster).expect("written");
        let domain = Domain { georeference: Some(place(5e5, 32633)), ..Domain::new(size, 10.0) };
        let mut file = LayerFile::plain(path);
        change(&mut file);
        let read = file.read(&domain).map(|(field, notes)| (field.at(0, 0), notes.len()));
        read.map_err(|error| error.to_string())
    }

    #[test]
    fn a_file_of_elsewhere_is_refused_unless_that_is_wanted() {
        assert_eq!(load(Some(place(5e5, 32633)), |_| ()), Ok((2.0, 0)));
        assert_eq!(load(Some(place(5e5 + 4.0, 32633)), |_| ()), Ok((2.0, 0)), "less than half a cell");
        let error = load(Some(place(5e5 + 30.0, 32633)), |_| ()).expect_err("elsewhere");
        assert!(
            error.contains("from 500030, 4000000 to 500070, 3999970 on Earth, the landscape from 500000"),
            "{error}"
        );
        assert!(error.contains("`elsewhere = true`"), "{error}");
        let other = load(Some(place(5e5, 32632)), |_| ()).expect_err("another CRS");
        assert!(other.contains("gdalwarp -t_srs EPSG:32633"), "{other}");
        let mut finer = place(5e5, 32633);
        finer.pixel = [5.0; 2];
        assert!(load(Some(finer), |_| ()).is_err(), "the same corner and half the extent");
        assert_eq!(load(Some(place(7e5, 32633)), |file| file.elsewhere = true), Ok((2.0, 1)), "with a note");
    }

    #[test]
    fn feet_become_metres_where_the_recipe_says_so() {
        let feet = |file: &mut LayerFile| file.said = said(None, Some(FileUnit::Foot), None);
        let (value, notes) = load(None, feet).expect("feet");
        assert_eq!((value, notes), (0.6096, 1));
        let none = |file: &mut LayerFile| {
            file.said = said(None, None, Some(2.0));
            file.no_data = Some(7.0);
        };
        assert_eq!(load(None, none), Ok((7.0, 0)), "what is no data has the value for such cells");
    }
}

//! A raster file that becomes the ground of a landscape.

use std::ops::Range;
use std::path::{Path, PathBuf};

use crate::file_rows;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask};
use weald_core::landscape::Landscape;
use weald_io::{self as io, Raster, RowsOfFile, Said};

/// The landscape whose layer `height` is a raster file, in square cells of metres, and texts that tell the user what had
/// to be done to it. `cell` is the width of the cells in metres and `said` is more, for a file that does not say it.
pub(crate) fn read(path: &Path, cell: Option<f64>, said: &Said) -> Result<(Landscape, Vec<String>), Error> {
    let (raster, mut notes) = of_heights(path, (cell, said), io::read(path)?, Raster::likely_degrees)?;
    let (raster, note) = io::square(raster).map_err(|error| match error {
        Error::Run(what) => Error::input(path, what),
        other => other,
    })?;
    notes.extend(note);
    let side = side_of(path, &raster)?;
    if raster.valid.as_ref().map_or(0, Mask::valid_cells) == 0 && raster.valid.is_some() {
        return Err(without_data(path));
    }
    let size = raster.field.size();
    let (georeference, valid) = (raster.georeference, raster.valid);
    let domain = Domain { georeference, valid, ..Domain::new(size, side) };
    let mut landscape = Landscape::new(domain);
    landscape.insert("height", "m", raster.field);
    Ok((landscape, notes))
}

fn without_data(path: &Path) -> Error {
    Error::input(path, "has no cell with data, so there is no ground to work on")
}

fn side_of(path: &Path, raster: &Raster) -> Result<f64, Error> {
    let side = raster.cell.filter(|side| side.is_finite() && *side > 0.0);
    side.ok_or_else(|| Error::input(path, "has no cell size; give `cell` in [landscape]"))
}

/// A raster, or rows of it, as heights in metres, and what had to be done to it.
fn of_heights(
    path: &Path,
    (cell, said): (Option<f64>, &Said),
    raster: Raster,
    may_be_degrees: impl Fn(&Raster) -> Option<String>,
) -> Result<(Raster, Vec<String>), Error> {
    let wrong = |what: String| Error::input(path, what);
    let mut raster = said.of(raster).map_err(wrong)?;
    if let Some(question) = may_be_degrees(&raster).filter(|_| cell.is_none()) {
        return Err(wrong(question + ", in [landscape]"));
    }
    if let Some(unit) = raster.unit().filter(|unit| !["m", "1"].contains(unit)) {
        let remedy = "give their unit, as `unit = \"m\"` in [landscape], if the file is wrong";
        return Err(wrong(format!("its values are in {unit}, which are no heights; {remedy}")));
    }
    let notes = std::mem::take(&mut raster.notes);
    set_cell(&mut raster, cell).map_err(wrong)?;
    Ok((raster, notes))
}

/// A raster file of which the ground is read row by row, as it becomes in [`read`].
#[derive(Debug)]
pub(crate) struct GroundRows {
    path: PathBuf,
    cell: Option<f64>,
    said: Said,
    file: Box<dyn RowsOfFile>,
    /// Its grid; rows tell which of their cells have data.
    pub(crate) domain: Domain,
    /// What had to be done to it.
    pub(crate) notes: Vec<String>,
}

impl GroundRows {
    /// Opens a file of square cells of metres.
    ///
    /// # Errors
    /// As [`read`], as far as the first row shows it; [`Error::Input`] where the whole would be needed.
    pub(crate) fn open(path: &Path, cell: Option<f64>, said: &Said) -> Result<Self, Error> {
        let file = io::open_rows(path)?;
        let (path, said, domain) = (path.to_owned(), said.clone(), Domain::new(file.size(), 1.0));
        let mut this = Self { path, cell, said, file, domain, notes: Vec::new() };
        let (raster, notes) = this.read(0..1)?;
        let side = side_of(&this.path, &raster)?;
        this.domain = Domain { georeference: raster.georeference, ..Domain::new(this.domain.size, side) };
        this.notes = notes;
        Ok(this)
    }

    /// Rows that are worth reading at a time, from these on.
    pub(crate) fn runs_of_rows(&self, rows: Range<usize>) -> impl Iterator<Item = Range<usize>> + use<> {
        file_rows::runs_of_rows(&*self.file, rows)
    }

    /// Heights of some rows, and which cells have data; `None` where all have.
    ///
    /// # Errors
    /// [`Error::Input`] for rows that are damaged; [`Error::Limit`] where the memory is too little.
    pub(crate) fn heights(&self, rows: Range<usize>, memory: u64) -> Result<(Field, Option<Mask>), Error> {
        file_rows::ensure_memory(&self.path, &*self.file, memory)?;
        let (raster, _) = self.read(rows)?;
        Ok((raster.field, raster.valid))
    }

    /// That there is no cell with data.
    pub(crate) fn without_data(&self) -> Error {
        without_data(&self.path)
    }

    fn read(&self, rows: Range<usize>) -> Result<(Raster, Vec<String>), Error> {
        let raster = self.file.rows(rows).map_err(|fault| fault.of(&self.path))?;
        let whole = self.file.size();
        let degrees = |raster: &Raster| raster.possible_degrees(whole);
        let (raster, notes) = of_heights(&self.path, (self.cell, &self.said), raster, degrees)?;
        let resampled = |what: String| {
            let remedy = "which needs the whole in memory: gdalwarp it to square cells of metres";
            Error::input(&self.path, format!("{what}; {remedy}"))
        };
        match io::square(raster) {
            Ok((raster, None)) => Ok((raster, notes)),
            Ok((_, Some(note))) => Err(resampled(note)),
            Err(Error::Run(what)) => Err(resampled(what)),
            Err(other) => Err(other),
        }
    }
}

/// Takes the width of the cells from the recipe, where the file leaves it open.
fn set_cell(raster: &mut Raster, given: Option<f64>) -> Result<(), String> {
    let Some(given) = given else { return Ok(()) };
    match (raster.cell, &raster.georeference) {
        (Some(found), _) if found == given => Ok(()),
        (Some(found), _) => {
            Err(format!("its cells are {found} m wide, but the recipe says `cell = {given}`; remove `cell`"))
        }
        (None, None) => {
            raster.cell = Some(given);
            Ok(())
        }
        (None, Some(place)) => {
            let unit = if place.is_geographic() { "°" } else { " CRS units" };
            let [width, height] = place.pixel;
            Err(format!(
                "its cells are {width} × {height}{unit} and become squares of metres by their place, so `cell = \
                 {given}` has no effect; remove `cell`, and change the cells in a `resample` step"
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Georeference;
    use weald_core::grid::{Field, Size};

    /// A file of four cells at a place without a CRS, or with one; the ground that it becomes.
    fn ground(pixel: f64, epsg: Option<u32>, cell: Option<f64>, said: &Said) -> Result<Landscape, String> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("land.tif");
        let field = Field::from_function(Size { columns: 2, rows: 2 }, |x, y| (100 * x + y) as f32);
        let georeference = Some(Georeference { epsg, origin: [10.0, 40.0], pixel: [pixel; 2], keys: None });
        io::write(&path, &Raster { georeference, ..Raster::from(field) }).expect("written");
        read(&path, cell, said).map(|(landscape, _)| landscape).map_err(|error| error.to_string())
    }

    #[test]
    fn small_cells_without_a_crs_are_asked_about_and_taken_as_what_the_recipe_says() {
        let question = ground(0.005, None, None, &Said::default()).expect_err("degrees or metres");
        assert!(
            question.contains("say `crs = \"EPSG:4326\"`") && question.contains("`cell = 0.005`"),
            "{question}"
        );
        let metres = ground(0.005, None, Some(0.005), &Said::default()).expect("metres");
        assert_eq!(metres.domain.cell, 0.005);
        let said = Said { crs: Some(4326), ..Said::default() };
        let degrees = ground(0.005, None, None, &said).expect("degrees");
        assert!((degrees.domain.cell - 427.1).abs() < 0.5, "{}", degrees.domain.cell);
    }

    #[test]
    fn a_cell_beside_degrees_is_refused_and_not_ignored() {
        let error = ground(0.005, Some(4326), Some(30.0), &Said::default()).expect_err("degrees");
        assert!(error.contains("`cell = 30` has no effect; remove `cell`"), "{error}");
    }

    #[test]
    fn heights_in_feet_become_metres_where_the_recipe_says_so() {
        let said = Said { unit: Some("ft".to_owned()), no_data: Some(101.0), ..Said::default() };
        let land = ground(20.0, Some(32633), None, &said).expect("feet");
        let heights = land.field("height").expect("is").values();
        assert_eq!(heights, [0.0, 30.48, 0.3048, 0.0]);
        assert_eq!(land.domain.valid_cells(), 3);
    }

    #[test]
    fn what_is_no_height_is_refused_unless_the_recipe_says_its_unit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("heat.asc.tif");
        let field = Field::filled(Size { columns: 2, rows: 2 }, 280.0);
        let provenance = io::Provenance {
            version: "0".to_owned(),
            recipe_blake3: "0".to_owned(),
            seed: 0,
            layer: "heat".to_owned(),
            unit: "m³/s".to_owned(),
            range: (280.0, 280.0),
            resampled: None,
        };
        let raster = Raster { cell: Some(5.0), provenance: Some(provenance), ..Raster::from(field) };
        io::write(&path, &raster).expect("written");
        let error = read(&path, None, &Said::default()).expect_err("no height").to_string();
        assert!(error.contains("in m³/s, which are no heights"), "{error}");
        let said = Said { unit: Some("m".to_owned()), ..Said::default() };
        assert!(read(&path, None, &said).is_ok());
    }
}

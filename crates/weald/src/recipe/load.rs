//! Loads a layer from a raster file: `value · scale + offset` in each cell.
//!
//! It stands beside [`catalog`](super::catalog) and not among the stages, which know no files.

use std::collections::BTreeSet;
use std::path::PathBuf;

use super::layer_file::{FileUnit, LayerFile, said};
use super::parameter::{CrsCode, LayerName, RasterFile};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameters;
use weald_engine::Job;
use weald_engine::ranks::agreed;
use weald_engine::step::{Entry, Outcome, Stage, Step};
use weald_engine::stored::StoredLandscape;

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Load>("load", Stage::Load, "loads a layer from a raster file", "Weald");

parameters! {
    /// A layer from a file.
    ///
    /// ```
    /// # use weald::prelude::*;
    /// # use weald::recipe::parameter::{LayerName, RasterFile};
    /// # let folder = tempfile::tempdir().expect("a folder");
    /// # let file = folder.path().join("soil.tif");
    /// let mut landscape = Landscape::empty(8, 6, 10.0)?; // columns, rows, metres
    /// landscape.run(&steps::Constant { height: 3.0, ..Default::default() })?;
    /// landscape.save("height", &file)?;
    /// let file = RasterFile(file.display().to_string());
    /// landscape.run(&steps::Load { file, into: LayerName::of("soil"), scale: 0.5, ..Default::default() })?;
    /// assert_eq!(landscape.field("soil")?.at(4, 3), 1.5, "metres, half of what the file holds");
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Load {
        /// Raster file of any format that is read, as many cells as the landscape; its path starts at the
        /// folder of the recipe.
        file: RasterFile = RasterFile::needed();
        /// Layer that is written, in metres: heights, or the thickness of the material of that name.
        into: LayerName = LayerName::needed();
        /// Metres that a 1 in the file stands for. A 16-bit PNG holds 0 to 65535 where it says nothing else.
        scale: f64 = 1.0, range -1.0e9..=1.0e9;
        /// Metres that are added.
        offset: f64 = 0.0, range -1.0e9..=1.0e9, unit "m";
        /// Whether a file of another number of cells is brought to that of the landscape, as by a `resample`
        /// step.
        resample: bool = false;
        /// Value, in metres, of cells without data. Without it, they are an error where the landscape has
        /// ground.
        no_data: Option<f64> = None, range -1.0e9..=1.0e9, unit "m";
        /// Unit of the values of a file that names none; without it they are metres.
        unit: Option<FileUnit> = None;
        /// Coordinate reference system of a file that names none.
        crs: Option<CrsCode> = None;
        /// Number of the cells without data, as `weald info` shows it, in a file that does not say it.
        nodata: Option<f64> = None;
        /// Whether a file that lies elsewhere on Earth than the landscape is laid on it all the same, cell by cell.
        elsewhere: bool = false;
    }
}

impl Step for Load {
    fn reads(&self) -> Vec<String> {
        Vec::new()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.into.0.clone(), "m")]
    }

    fn files(&self) -> Vec<PathBuf> {
        vec![self.file.path()]
    }

    fn look_ahead(&self, _: &[Material], domain: &Domain) -> Result<(), Error> {
        self.layer_file().read(domain).map(drop)
    }

    fn look_ahead_by_rows(&self, domain: &Domain) -> Result<(), Error> {
        self.layer_file().rows(domain).map(drop)
    }

    fn scratch_per_cell(&self, _: &BTreeSet<String>) -> Result<u64, String> {
        if self.resample { Err("`resample = true` needs the whole file in memory".to_owned()) } else { Ok(0) }
    }

    fn run_on_disk(&self, landscape: &mut StoredLandscape<'_>, job: &Job<'_>) -> Result<Outcome, Error> {
        let file = self.layer_file();
        let file = agreed(&*landscape.ranks, file.rows(&landscape.domain))?;
        let mut layer = landscape.plane(&self.into.0)?;
        let read = file.runs_of_rows(layer.own()).try_for_each(|rows| {
            if job.watcher.cancelled() {
                let all = landscape.domain.size.rows;
                return Err(Error::Interrupted(format!("interrupted in row {} of {all}", rows.start)));
            }
            let valid = landscape.valid_rows(rows.clone())?;
            let values = file.values(rows.clone(), valid.as_ref(), landscape.memory)?;
            layer.set_rows(rows, values.values())
        });
        agreed(&*landscape.ranks, read)?;
        landscape.insert(&self.into.0, "m", layer);
        Ok(Outcome { iterations: 1, notes: file.notes, ..Outcome::default() })
    }

    fn run(&self, landscape: &mut Landscape, _: &Job<'_>) -> Result<Outcome, Error> {
        let (field, notes) = self.layer_file().read(&landscape.domain)?;
        landscape.insert(&self.into.0, "m", field);
        Ok(Outcome { iterations: 1, notes, ..Outcome::default() })
    }
}

impl Load {
    fn layer_file(&self) -> LayerFile {
        LayerFile {
            path: self.file.path(),
            scale: self.scale,
            offset: self.offset,
            resample: self.resample,
            no_data: self.no_data,
            said: said(self.crs, self.unit, self.nodata),
            elsewhere: self.elsewhere,
        }
    }
}

//! What a program does with a landscape of its own: open, run steps, paint, save.

use std::path::Path;

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_engine::Job;
use weald_engine::step::{Outcome, Step};
use weald_io as io;
use weald_land::edit::{Brush, Volumes};

use crate::{ground_file, layer_raster, written};

/// Files, steps and strokes of a [`Landscape`], without a recipe.
///
/// ```
/// use weald::prelude::{Brush, Effect, Landscape, LandscapeExt, steps};
///
/// let mut landscape = Landscape::empty(48, 32, 20.0)?; // columns, rows, metres
/// landscape.run_with(&steps::Fbm::default(), 7)?;
/// landscape.paint(&Brush::dab(Effect::Flatten { height: 400.0 }, [480.0, 320.0], 200.0))?;
/// landscape.run(&steps::Slope::default())?;
/// assert!(landscape.field("slope")?.at(24, 16) < 10.0, "the middle is nearly flat");
///
/// let missing = landscape.run(&steps::Rivers::default()).expect_err("no flow was run");
/// assert!(missing.to_string().contains("no layer `flow_direction`"), "{missing}");
/// # Ok::<(), weald::Error>(())
/// ```
pub trait LandscapeExt: Sized {
    /// A landscape without layers: columns, rows, and the side of its square cells in metres.
    ///
    /// # Errors
    /// [`Error::Limit`] for too many cells, [`Error::Run`] for a cell that has no size.
    fn empty(columns: usize, rows: usize, cell: f64) -> Result<Self, Error>;

    /// A raster file of any format that Weald reads as the layer `height`, with its cell size, its georeferencing and
    /// its no-data cells. A file in degrees, or of oblong cells, comes out in square cells of metres.
    ///
    /// # Errors
    /// [`Error::Input`] for a file that is missing, damaged or without a cell size, [`Error::Limit`] for one that is
    /// too large.
    fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::open_with(path, None).map(|(landscape, _)| landscape)
    }

    /// The same for a file that does not say how wide its cells are, and with the notes on what was done to the file.
    ///
    /// # Errors
    /// As [`LandscapeExt::open`], and where the file says another width.
    fn open_with(path: impl AsRef<Path>, cell: Option<f64>) -> Result<(Self, Vec<String>), Error>;

    /// Writes a layer into a raster file, whose format follows from the extension, with all of cell size,
    /// georeferencing and no-data cells that the format can hold.
    ///
    /// # Errors
    /// [`Error::Run`] where there is no such layer or format, or the file cannot be written.
    fn save(&self, layer: &str, path: impl AsRef<Path>) -> Result<(), Error>;

    /// Runs a step on all cores with seed 0, which is also the seed of a recipe that names none.
    ///
    /// # Errors
    /// [`Error::Run`] where its parameters contradict each other, a layer that it reads is missing, or a layer that it
    /// writes is not of finite numbers.
    fn run(&mut self, step: &dyn Step) -> Result<Outcome, Error> {
        self.run_with(step, 0)
    }

    /// The same with another seed.
    ///
    /// # Errors
    /// As [`LandscapeExt::run`].
    fn run_with(&mut self, step: &dyn Step, seed: u64) -> Result<Outcome, Error>;

    /// Paints a stroke, as [`Brush::paint_at_rest`].
    ///
    /// # Errors
    /// As there.
    fn paint(&mut self, brush: &Brush) -> Result<Volumes, Error>;
}

impl LandscapeExt for Landscape {
    fn empty(columns: usize, rows: usize, cell: f64) -> Result<Self, Error> {
        let size = Size::new(columns, rows)?;
        if cell.is_finite() && cell > 0.0 {
            return Ok(Self::new(Domain::new(size, cell)));
        }
        Err(Error::Run(format!("cells cannot be {cell} m wide; give a finite width above 0")))
    }

    fn open_with(path: impl AsRef<Path>, cell: Option<f64>) -> Result<(Self, Vec<String>), Error> {
        ground_file::read(path.as_ref(), cell, &io::Said::default())
    }

    fn save(&self, layer: &str, path: impl AsRef<Path>) -> Result<(), Error> {
        io::write(path.as_ref(), &layer_raster::raster(self, layer)?)
    }

    fn run_with(&mut self, step: &dyn Step, seed: u64) -> Result<Outcome, Error> {
        let faults = step.faults().into_iter().chain(step.faults_among(&self.materials));
        let faults: Vec<_> = faults.map(|fault| fault.to_string()).collect();
        if !faults.is_empty() {
            return Err(Error::Run(format!("a step cannot run: {}", faults.join("; "))));
        }
        step.reads().iter().try_for_each(|name| self.layer(name).map(drop))?;
        step.look_ahead(&self.materials, &self.domain)?;
        let outcome = step.run(self, &Job::unwatched(seed))?;
        written::finish(step, self)?;
        Ok(outcome)
    }

    fn paint(&mut self, brush: &Brush) -> Result<Volumes, Error> {
        brush.paint_at_rest(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Georeference;
    use weald_core::grid::{Field, Mask};

    #[test]
    fn what_is_saved_opens_with_its_values_cell_place_and_mask() {
        let mut saved = Landscape::empty(7, 5, 20.0).expect("small");
        let place = Georeference {
            epsg: Some(32616),
            origin: [730_900.0, 4_069_280.0],
            pixel: [20.0; 2],
            keys: None,
        };
        saved.domain.georeference = Some(place);
        saved.domain.valid = Mask::new(saved.domain.size, (0..35).map(|cell| cell != 9).collect());
        let height = Field::from_function(saved.domain.size, |x, y| (10 * y + x) as f32);
        saved.insert("height", "m", height);
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("height.tif");
        saved.save("height", &path).expect("written");

        let opened = Landscape::open(&path).expect("read");
        assert_eq!((opened.domain.cell, &opened.domain.valid), (20.0, &saved.domain.valid));
        let place = opened.domain.georeference.as_ref().expect("a place");
        assert_eq!((place.epsg, place.origin), (Some(32616), [730_900.0, 4_069_280.0]));
        for cell in (0..35).filter(|cell| *cell != 9) {
            let [before, after] =
                [&saved, &opened].map(|land| land.field("height").expect("is").values()[cell]);
            assert_eq!(before, after);
        }
        assert!(Landscape::open_with(&path, Some(30.0)).is_err(), "another width");
        assert!(Landscape::empty(7, 5, f64::NAN).is_err() && Landscape::empty(7, 5, 0.0).is_err());
    }

    #[test]
    fn the_program_in_the_readme_is_the_example() {
        let readme = include_str!("../../../README.md");
        let (_, program) = include_str!("../examples/six_names.rs").split_once("\n\n").expect("a title");
        assert!(readme.contains(&format!("```rust\n{program}```\n")), "copy the example into README.md");
    }
}

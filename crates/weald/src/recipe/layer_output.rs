//! How a layer is written: on which grid, and in whose numbers.

use std::path::Path;

use weald_core::error::Error;
use weald_core::parameter::Choice as _;
use weald_export::classes::{self, DIRECTIONS};
use weald_io::{self as io, Grid, Raster, Resampling, Said, regrid};
use weald_land::flow::DirectionCodes;

weald_core::choices! {
    /// Grids on which a layer can be written.
    pub enum OutputGrid {
        /// That of the landscape: square cells of metres.
        Landscape = "landscape",
        /// That of the file from which the ground came, with its size, origin, cells and CRS.
        Source = "source",
    }
}

/// What is done to a layer before it is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Treatment {
    /// How it comes to the grid of the source, where it is written there.
    pub(super) to_source: Option<Resampling>,
    /// Whose numbers directions of flow have.
    pub(super) codes: Option<DirectionCodes>,
}

/// Layers of lines a cell wide, of which a mean or a cell left out would break some.
const LINES: [&str; 6] = ["river", "strahler", "accumulation", "discharge", "river_width", "river_depth"];

/// Layers whose values have no mean: numbers of things, and angles that go round.
const UNMIXED: [&str; 5] = ["lake", "watershed", "material", "aspect", DIRECTIONS];

/// How a layer comes to another grid where the recipe does not say it.
pub(super) fn usual(layer: &str) -> Resampling {
    if LINES.contains(&layer) {
        Resampling::Greatest
    } else if UNMIXED.contains(&layer) {
        Resampling::Nearest
    } else {
        Resampling::Linear
    }
}

impl Treatment {
    /// The raster as it is written, and a text for the user where it was brought to another grid. `source` is the file
    /// from which the ground came, with what the recipe says of it.
    pub(super) fn of(
        self,
        raster: Raster,
        source: Option<(&Path, &Said)>,
    ) -> Result<(Raster, Option<String>), Error> {
        let mut raster = raster;
        if let Some(codes) = self.codes {
            raster.field = classes::recoded(&raster.field, codes);
            raster.classes = raster.classes.map(|_| classes::directions(codes));
        }
        let mut note = None;
        if let (Some(how), Some((path, said))) = (self.to_source, source) {
            let (back, text) = back_on(&raster, path, &grid_of(path, said)?, how)?;
            raster = back;
            note = Some(text);
        }
        let range = raster.field.range(raster.valid.as_ref()).unwrap_or_default();
        if let Some(provenance) = &mut raster.provenance {
            provenance.range = (range.0.into(), range.1.into());
            provenance.resampled.clone_from(&note);
        }
        Ok((raster, note))
    }
}

fn back_on(raster: &Raster, file: &Path, grid: &Grid, how: Resampling) -> Result<(Raster, String), Error> {
    let back = regrid(raster, grid, how)?;
    let name = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy();
    let cell = raster.cell.map_or_else(String::new, |cell| format!(" of {cell:.1} m"));
    let text = format!(
        "from {} cells{cell} back to the {} cells of {name}: {}",
        raster.field.size(),
        grid.size,
        how.as_word()
    );
    Ok((back, text))
}

/// The grid of a file.
fn grid_of(path: &Path, said: &Said) -> Result<Grid, Error> {
    let raster = said.of(io::read(path)?).map_err(|what| Error::input(path, what))?;
    let Some(georeference) = raster.georeference else { return Err(placeless(path)) };
    Ok(Grid { size: raster.field.size(), georeference, valid: raster.valid })
}

/// A file that says not where it lies has no grid to go back to.
pub(super) fn placeless(path: &Path) -> Error {
    Error::input(
        path,
        "says not where it lies, so no result goes back to its grid; its cells are those of the landscape: leave \
         `grid = \"source\"` out",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_keep_their_greatest_and_numbers_of_things_do_not_mix() {
        assert_eq!(usual("river"), Resampling::Greatest);
        assert_eq!(usual("watershed"), Resampling::Nearest);
        assert_eq!(usual("height"), Resampling::Linear);
    }
}

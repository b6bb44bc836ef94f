//! The ground of a file, of which each rank reads its own rows.

use std::ops::Range;

use crate::ground_file::GroundRows;
use weald_core::error::Error;
use weald_engine::ranks::{agreed, any};
use weald_engine::stored::{StoredLandscape, StoredPlane};

/// Makes the layer `height` of the file, and says which cells have data. All ranks call it together.
///
/// # Errors
/// Those of the file and of the disk, on all ranks; [`Error::Input`] where no cell has data.
pub(super) fn read(ground: &GroundRows, landscape: &mut StoredLandscape<'_>) -> Result<(), Error> {
    let mut rows = OwnRows { height: landscape.plane("height")?, valid: None, has_data: false };
    let read = ground.runs_of_rows(rows.height.own()).try_for_each(|run| rows.read(ground, landscape, run));
    let ranks = landscape.ranks.clone();
    agreed(&*ranks, read)?;
    if !any(&*ranks, rows.has_data)? {
        return Err(ground.without_data());
    }
    if any(&*ranks, rows.valid.is_some())? {
        let valid = rows.valid.map_or_else(|| all_valid(landscape, rows.height.own().end), Ok);
        landscape.set_valid(Some(agreed(&*ranks, valid)?));
    }
    landscape.insert("height", "m", rows.height);
    Ok(())
}

/// What a rank has read of its own rows.
struct OwnRows {
    height: StoredPlane,
    /// Which cells have data, from the first on that has none.
    valid: Option<StoredPlane>,
    /// Whether any has.
    has_data: bool,
}

impl OwnRows {
    fn read(
        &mut self,
        ground: &GroundRows,
        landscape: &StoredLandscape<'_>,
        rows: Range<usize>,
    ) -> Result<(), Error> {
        let (heights, valid) = ground.heights(rows.clone(), landscape.memory)?;
        self.height.set_rows(rows.clone(), heights.values())?;
        self.has_data |= valid.as_ref().is_none_or(|valid| valid.valid_cells() > 0);
        if self.valid.is_none() && valid.is_some() {
            self.valid = Some(all_valid(landscape, rows.start)?);
        }
        let Some(plane) = &mut self.valid else { return Ok(()) };
        let flags = valid.map(|valid| valid.flags().iter().map(|&flag| f32::from(u8::from(flag))).collect());
        plane.set_rows(rows, &flags.unwrap_or_else(|| vec![1.0; heights.size().cells()]))
    }
}

/// A plane that says of this rank's rows before one that all cells have data.
fn all_valid(landscape: &StoredLandscape<'_>, end: usize) -> Result<StoredPlane, Error> {
    let columns = landscape.domain.size.columns;
    let mut valid = landscape.plane_alone("cells with data", (columns, landscape.rows()))?;
    for rows in valid.runs_of_rows() {
        let rows = rows.start..rows.end.min(end);
        if !rows.is_empty() {
            valid.set_rows(rows.clone(), &vec![1.0; rows.len() * columns])?;
        }
    }
    Ok(valid)
}

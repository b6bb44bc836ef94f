//! How much of a landscape a simulation takes: all of it, or a region and no more around it than needed.

use std::ops::Range;

use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_engine::device::Window;

/// How much of a landscape is simulated.
pub(crate) struct Extent<'a> {
    /// Whether water leaves over the edges.
    pub(crate) open: bool,
    /// Layer of a region with walls around it: cells where it is below 0.5 take no part.
    pub(crate) region: Option<&'a str>,
    /// Whether the rows and columns around the region are left out, which changes nothing but the speed.
    pub(crate) cropped: bool,
}

impl Extent<'_> {
    /// The smallest window around the region.
    pub(crate) fn window(&self, landscape: &Landscape) -> Result<Window, Error> {
        let whole = Window::whole(landscape.domain.size);
        let Some(name) = self.region else { return Ok(whole) };
        let region = landscape.field(name)?;
        let is_in = |x: usize, y: usize| region.at(x, y) >= 0.5;
        let rows = whole.rows.clone().filter(|&y| whole.columns.clone().any(|x| is_in(x, y)));
        let columns = whole.columns.clone().filter(|&x| whole.rows.clone().any(|y| is_in(x, y)));
        match (around(columns), around(rows)) {
            (Some(columns), Some(rows)) if self.cropped => Ok(Window { columns, rows }),
            // Where the region holds no cell there are walls around nothing, and the ground stays.
            _ => Ok(whole),
        }
    }
}

/// Tells that a region holds no cell.
pub(crate) fn empty_note(landscape: &Landscape, region: Option<&LayerName>) -> Option<String> {
    let LayerName(name) = region?;
    let is_empty = landscape.field(name).ok()?.values().iter().all(|&here| here < 0.5);
    is_empty.then(|| {
        format!("layer `{name}` is below 0.5 everywhere: the region holds no cell, and nothing is simulated")
    })
}

/// From the first to the last of them.
fn around(mut places: impl Iterator<Item = usize>) -> Option<Range<usize>> {
    let first = places.next()?;
    Some(first..places.last().unwrap_or(first) + 1)
}

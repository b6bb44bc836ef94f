//! The ground with which a simulation on a stored landscape starts, and the layers that it leaves.

use std::ops::Range;
use std::sync::Arc;

use super::super::keys::{Boundary, Hydraulic};
use crate::erode::links::mask_planes;
use crate::erode::water_planes as plane;
use crate::erode::working::Totals;
use weald_core::error::Error;
use weald_core::grid::{Mask, Size};
use weald_core::plane::{Plane, Window};
use weald_engine::ranks::SharedRows;
use weald_engine::stored::{StoredLandscape, StoredPlane, swap_margins};
use weald_engine::sums::RowSums;

/// Layers of the means.
pub(super) const MEANS: [&str; 2] = ["flux_x", "flux_y"];

/// The ground of the start, and how it lies in the planes of the simulation.
pub(super) struct StartOnDisk {
    pub(super) height: StoredPlane,
    /// Which cells have data, as 1 and 0; `None` where all have.
    valid: Option<Arc<StoredPlane>>,
    /// Columns and rows of the simulation, with the ring of an open border.
    pub(super) columns: usize,
    pub(super) rows: SharedRows,
    /// Width of the ring: 1 around an open domain, else 0.
    ring: usize,
    lowest: f64,
    pub(super) cell: f64,
}

impl Totals {
    /// From the sums of rows that [`StartOnDisk::sums`] gives.
    pub(super) fn of([bedrock, change, water, suspended, changed]: RowSums) -> Self {
        Self { bedrock, water, change, changed, suspended, ..Self::default() }
    }
}

impl StartOnDisk {
    /// Takes the ground out of the landscape, which gets it back as it has become.
    pub(super) fn of(step: &Hydraulic, landscape: &mut StoredLandscape<'_>) -> Result<Self, Error> {
        let (lowest, _) = landscape.range(&step.layer.0)?;
        let ring = usize::from(step.boundary == Boundary::Open);
        let (columns, rows) = (landscape.domain.size.columns + 2 * ring, landscape.rows().ringed(ring));
        let cell = landscape.domain.cell;
        let layer = landscape.remove(&step.layer.0);
        let height =
            layer.ok_or_else(|| Error::Run(format!("the landscape has no layer `{}`", step.layer.0)))?;
        Ok(Self { height: height.plane, valid: None, columns, rows, ring, lowest: f64::from(lowest), cell })
    }

    /// Gets so many rows around its own from the neighbours, and with them which cells have data.
    pub(super) fn swap(&mut self, margin: usize, landscape: &mut StoredLandscape<'_>) -> Result<(), Error> {
        swap_margins(&mut [&mut self.height], margin, &*landscape.ranks)?;
        // What a cell does depends on whether there are data beside it.
        self.valid = landscape.valid_around(margin + 1)?;
        Ok(())
    }

    pub(super) fn size(&self) -> Size {
        Size { columns: self.columns, rows: self.rows.count() }
    }

    fn is_open(&self) -> bool {
        self.ring > 0
    }

    /// Whether there are cells without data, or a ring of such.
    pub(super) fn is_masked(&self, landscape: &StoredLandscape<'_>) -> bool {
        self.is_open() || landscape.valid().is_some()
    }

    /// The rows of the landscape among those of the simulation.
    fn inner(&self, rows: &Range<usize>) -> Range<usize> {
        let last = self.height.size().rows;
        rows.start.saturating_sub(self.ring).min(last)..rows.end.saturating_sub(self.ring).min(last)
    }

    /// The constant planes of some rows of the simulation.
    pub(super) fn constants(&self, rows: Range<usize>) -> Result<Vec<Vec<f32>>, Error> {
        let (columns, inner) = (self.columns, self.inner(&rows));
        let mut base = vec![0.0; columns * rows.len()];
        let mut heights = self.height.rows(inner.clone())?;
        for height in &mut heights {
            *height = ((f64::from(*height) - self.lowest) / self.cell) as f32;
        }
        self.clear_without_data(&inner, &mut heights)?;
        let wide = self.height.size().columns;
        for (y, heights) in inner.zip(heights.chunks_exact(wide)) {
            let first = (y + self.ring - rows.start) * columns + self.ring;
            base[first..first + wide].copy_from_slice(heights);
        }
        let mut planes = vec![base];
        if self.is_open() || self.valid.is_some() {
            planes.extend(self.masks(&rows)?);
        }
        Ok(planes)
    }

    /// The planes of the mask, which the rows beside these have a part in.
    fn masks(&self, rows: &Range<usize>) -> Result<impl Iterator<Item = Vec<f32>> + use<>, Error> {
        let (columns, wide) = (self.columns, self.height.size().columns);
        let around = rows.start.saturating_sub(1)..(rows.end + 1).min(self.rows.count());
        let inner = self.inner(&around);
        let valid = self.valid.as_ref().map(|valid| valid.rows(inner.clone())).transpose()?;
        let has_data = |at: usize| valid.as_ref().is_none_or(|valid| valid[at] > 0.0);
        let mut flags = vec![false; columns * around.len()];
        for y in inner.clone() {
            let first = (y + self.ring - around.start) * columns + self.ring;
            for x in 0..wide {
                flags[first + x] = has_data((y - inner.start) * wide + x);
            }
        }
        let cells = (rows.start - around.start) * columns..(rows.end - around.start) * columns;
        let mask = Mask::always(Size { columns, rows: around.len() }, flags);
        let planes = mask_planes(&mask, self.is_open());
        Ok(planes.into_iter().map(move |mut plane| {
            plane.truncate(cells.end);
            plane.drain(..cells.start);
            plane
        }))
    }

    /// Puts 0 into the cells without data of some rows of the landscape.
    fn clear_without_data(&self, rows: &Range<usize>, values: &mut [f32]) -> Result<(), Error> {
        let Some(valid) = &self.valid else { return Ok(()) };
        for (value, has_data) in values.iter_mut().zip(valid.rows(rows.clone())?) {
            *value = if has_data > 0.0 { *value } else { 0.0 };
        }
        Ok(())
    }

    /// Lets the water of a layer stand at the start; gives the sum of each row of the simulation.
    pub(super) fn pour(&self, layer: &StoredPlane, depth: &mut StoredPlane) -> Result<Vec<RowSums>, Error> {
        for rows in layer.runs_of_rows() {
            let metres = layer.rows(rows.clone())?.into_iter();
            let mut depths: Vec<f32> =
                metres.map(|depth| (f64::from(depth.max(0.0)) / self.cell) as f32).collect();
            self.clear_without_data(&rows, &mut depths)?;
            let columns = self.ring..self.ring + layer.size().columns;
            let rows = rows.start + self.ring..rows.end + self.ring;
            depth.write(&Window { columns, rows }, &depths)?;
        }
        let mut sums = Vec::with_capacity(depth.own().len());
        for rows in depth.runs_of_rows() {
            let cells = depth.rows(rows)?;
            let rows = cells.chunks_exact(self.columns);
            sums.extend(rows.map(|row| [row.iter().map(|&cell| f64::from(cell)).sum(), 0.0, 0.0, 0.0, 0.0]));
        }
        Ok(sums)
    }

    /// Of each of its own rows the sums that make [`Totals`].
    pub(super) fn sums(&self, state: &[StoredPlane]) -> Result<Vec<RowSums>, Error> {
        let mut sums = Vec::with_capacity(self.rows.own().len());
        for rows in state[plane::CHANGE].runs_of_rows() {
            let base = self.constants(rows.clone())?.swap_remove(0);
            let of = |at: usize| state[at].rows(rows.clone());
            let planes = [base, of(plane::CHANGE)?, of(plane::DEPTH)?, of(plane::SEDIMENT)?];
            for first in (0..rows.len()).map(|y| y * self.columns) {
                let row = planes.each_ref().map(|plane| &plane[first..first + self.columns]);
                let [bedrock, change, water, suspended] =
                    row.map(|cells| cells.iter().map(|&cell| f64::from(cell)).sum());
                let changed = row[1].iter().map(|&cell| f64::from(cell).abs()).sum();
                sums.push([bedrock, change, water, suspended, changed]);
            }
        }
        Ok(sums)
    }

    /// Writes the layers, and lets go of each plane as soon as it is not needed any more.
    pub(super) fn store(
        self,
        landscape: &mut StoredLandscape<'_>,
        layer: &str,
        (state, means): (Vec<StoredPlane>, Vec<StoredPlane>),
        steps: u64,
    ) -> Result<(), Error> {
        let (cell, scale) = (self.cell as f32, 1.0 / steps.max(1) as f32);
        let cubic = cell * cell * cell;
        let mut state = state.into_iter();
        let mut next = || state.next().ok_or_else(|| Error::Run("a simulation lost a plane".to_owned()));
        let [change, depth, sediment] = [next()?, next()?, next()?];
        drop(state);
        self.write(landscape, ("water", "m"), &depth, |depth| depth * cell)?;
        drop(depth);
        self.write(landscape, ("sediment", "m"), &sediment, |sediment| sediment * cell)?;
        drop(sediment);
        for (name, mean) in MEANS.into_iter().zip(means) {
            self.write(landscape, (name, "m³/step"), &mean, |sum| (sum * scale) * cubic)?;
        }
        self.write(landscape, ("erosion", "m"), &change, |change| (-change).max(0.0) * cell)?;
        self.write(landscape, ("deposition", "m"), &change, |change| change.max(0.0) * cell)?;
        self.write_ground(landscape, layer, &change)
    }

    /// Writes a layer from a plane of the simulation, if it is wanted.
    fn write(
        &self,
        landscape: &mut StoredLandscape<'_>,
        (name, unit): (&str, &str),
        plane: &StoredPlane,
        convert: impl Fn(f32) -> f32,
    ) -> Result<(), Error> {
        if !landscape.wants(name) {
            return Ok(());
        }
        let mut layer = landscape.plane_alone(name, self.grid())?;
        for rows in layer.runs_of_rows() {
            let values: Vec<f32> = self.read(plane, &rows)?.into_iter().map(&convert).collect();
            layer.set_rows(rows, &values)?;
        }
        landscape.insert(name, unit, layer);
        Ok(())
    }

    /// Writes the ground: the start stays to the bit where nothing changed.
    fn write_ground(
        &self,
        landscape: &mut StoredLandscape<'_>,
        name: &str,
        change: &StoredPlane,
    ) -> Result<(), Error> {
        let mut layer = landscape.plane_alone(name, self.grid())?;
        for rows in layer.runs_of_rows() {
            let (start, change) = (self.height.rows(rows.clone())?, self.read(change, &rows)?);
            let raised = start.iter().zip(&change);
            let raised: Vec<f32> = raised
                .map(|(&start, &change)| (f64::from(start) + f64::from(change) * self.cell) as f32)
                .collect();
            layer.set_rows(rows, &raised)?;
        }
        landscape.insert(name, "m", layer);
        Ok(())
    }

    /// The grid of the landscape.
    fn grid(&self) -> (usize, &SharedRows) {
        (self.height.size().columns, self.height.shared())
    }

    /// Rows of the landscape from a plane of the simulation, 0 in cells without data.
    fn read(&self, plane: &StoredPlane, rows: &Range<usize>) -> Result<Vec<f32>, Error> {
        let columns = self.ring..self.ring + self.height.size().columns;
        let window = Window { columns, rows: rows.start + self.ring..rows.end + self.ring };
        let mut values = plane.read(&window)?;
        self.clear_without_data(rows, &mut values)?;
        Ok(values)
    }
}

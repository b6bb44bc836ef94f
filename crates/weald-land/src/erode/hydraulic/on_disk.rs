//! The model of Han on a landscape that lies on disk: in bands of rows, some steps at a time, to the bit as in memory.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use super::defaults::ResolvedKeys;
use super::keys::{Boundary, Hydraulic, Model};
use super::pipe_models::han_constants;
use crate::erode::finished::Flows;
use crate::erode::han::{Han, MEAN_FLUXES};
use crate::erode::links::mask_planes;
use crate::erode::look::total;
use crate::erode::stored::lost_note;
use crate::erode::water_planes as plane;
use crate::erode::working::Totals;
use weald_core::error::{Error, NotFinite};
use weald_core::file_plane::{FilePlane, VALUE};
use weald_core::grid::{Mask, Size};
use weald_core::plane::{Plane, Window};
use weald_engine::Job;
use weald_engine::bands_on_disk::BandsOnDisk;
use weald_engine::step::{Outcome, Step};
use weald_engine::stored::StoredLandscape;

/// Names of the state planes.
const PLANES: [&str; 5] = ["change", "water", "sediment", "flux_east", "flux_south"];

/// Layers of the means.
const MEANS: [&str; 2] = ["flux_x", "flux_y"];

/// State planes that layers are made of, after the simulation.
const OF_LAYERS: usize = 3;

impl Hydraulic {
    /// Bytes on disk for a cell beside the layers, or what of the keys needs the whole in memory.
    pub(super) fn scratch_on_disk(&self, wanted: &BTreeSet<String>) -> Result<u64, String> {
        let cannot = [
            (!matches!(self.model, Model::Han(_)), "the models `mei` and `stava`"),
            (self.edits.is_some(), "`edits`"),
            (self.region.is_some(), "`region`"),
            (self.initial_water.is_some(), "`initial_water`"),
        ];
        if let Some((_, what)) = cannot.into_iter().find(|(asked, _)| *asked) {
            return Err(format!("{what} need the landscape in memory"));
        }
        let written = self.writes().iter().filter(|(name, _)| wanted.contains(name)).count();
        let means = if MEANS.iter().any(|name| wanted.contains(*name)) { MEAN_FLUXES.len() } else { 0 };
        // Layers are written when the simulation has ended, and so in the room of the fluxes.
        let planes = (PLANES.len() + means).saturating_sub(written).max(OF_LAYERS + means);
        Ok(VALUE * planes as u64)
    }

    /// Runs the model on a landscape on disk.
    pub(super) fn run_bands_on_disk(
        &self,
        landscape: &mut StoredLandscape<'_>,
        job: &Job<'_>,
    ) -> Result<Outcome, Error> {
        let Model::Han(keys) = &self.model else { return Err(super::models::another_model(self)) };
        let filled = self.filled(landscape.domain.cell);
        let ground = StartOnDisk::of(self, landscape)?;
        let process = Han {
            constants: han_constants(keys, &filled),
            limiter: keys.limiter,
            setting: self.setting(&filled, (ground.size, ground.is_open())),
        };
        let bytes = landscape.memory;
        let new = || landscape.plane("simulation", ground.size);
        let all = u64::from(self.iterations);
        let (means, recorded) = if MEANS.iter().any(|name| landscape.wants(name)) {
            (MEAN_FLUXES, self.recorded(ground.cell))
        } else {
            (&[][..], all..all)
        };
        let mut bands = BandsOnDisk::new(Arc::new(process), (ground.size, means), bytes, &new)?;
        self.advance_on_disk(&mut bands, (&ground, &filled), recorded.clone(), job)?;
        let budget = ground.totals(&bands.state)?.budget(&Flows::from(total(&bands.row_sums)), ground.cell);
        ground.store(landscape, &self.layer.0, (bands.state, bands.means), recorded.end - recorded.start)?;
        let notes = if self.conserves() { Vec::new() } else { vec![lost_note(&budget)] };
        Ok(Outcome {
            iterations: u64::from(self.iterations),
            budget: Some(budget),
            notes,
            ..Outcome::default()
        })
    }

    /// All steps, in passes over the disk; those that are recorded and the others apart.
    fn advance_on_disk(
        &self,
        bands: &mut BandsOnDisk<Han>,
        (ground, filled): (&StartOnDisk, &ResolvedKeys),
        recorded: Range<u64>,
        job: &Job<'_>,
    ) -> Result<(), Error> {
        let all = u64::from(self.iterations);
        let mut done = 0;
        while done < all {
            let is_recorded = recorded.contains(&done);
            let border = if is_recorded { recorded.end } else { recorded.start };
            let end = all.min(done + bands.steps() as u64);
            let end = if border > done { end.min(border) } else { end };
            let weather: Vec<_> = (done..end).map(|step| self.forcing(filled, step)).collect();
            let passed = &mut |rows: usize| {
                let share = rows as f64 / ground.size.rows as f64;
                let steps = ((end - done) as f64 * share) as u64;
                job.watcher.progress(done + steps, all, ground.size.cells());
                if job.watcher.cancelled() {
                    let what = format!("interrupted between the iterations {done} and {end} of {all}");
                    return Err(Error::Interrupted(what));
                }
                Ok(())
            };
            let constants = |rows| ground.constants(rows);
            if let Some(wrong) = bands.advance(&weather, is_recorded, (&constants, passed))? {
                return Err(not_finite(wrong, done..end));
            }
            done = end;
        }
        Ok(())
    }
}

fn not_finite([x, y, plane]: [usize; 3], steps: Range<u64>) -> Error {
    let (name, Range { start, end }) = (PLANES[plane], steps);
    let message = format!(
        "between the iterations {start} and {end}, `{name}` at column {x}, row {y} became no finite number; a lower \
         `flow_rate` or `erosion`, or `limiter = true`, makes the scheme stable"
    );
    NotFinite { step: None, iteration: Some(end), layer: name.to_owned(), cell: [x, y], message }.into()
}

/// The ground of the start, and how it lies in the planes of the simulation.
struct StartOnDisk {
    height: FilePlane,
    /// Columns and rows of the simulation, with the ring of an open border.
    size: Size,
    /// Width of the ring: 1 around an open domain, else 0.
    ring: usize,
    lowest: f64,
    cell: f64,
}

impl StartOnDisk {
    /// Takes the ground out of the landscape, which gets it back as it has become.
    fn of(step: &Hydraulic, landscape: &mut StoredLandscape<'_>) -> Result<Self, Error> {
        let (lowest, _) = landscape.range(&step.layer.0)?;
        let ring = usize::from(step.boundary == Boundary::Open);
        let Size { columns, rows } = landscape.domain.size;
        let size = Size { columns: columns + 2 * ring, rows: rows + 2 * ring };
        let cell = landscape.domain.cell;
        let layer = landscape.remove(&step.layer.0);
        let height =
            layer.ok_or_else(|| Error::Run(format!("the landscape has no layer `{}`", step.layer.0)))?;
        Ok(Self { height: height.plane, size, ring, lowest: f64::from(lowest), cell })
    }

    fn is_open(&self) -> bool {
        self.ring > 0
    }

    /// The rows of the landscape among those of the simulation.
    fn inner(&self, rows: &Range<usize>) -> Range<usize> {
        let last = self.height.size().rows;
        rows.start.saturating_sub(self.ring).min(last)..rows.end.saturating_sub(self.ring).min(last)
    }

    /// The constant planes of some rows of the simulation.
    fn constants(&self, rows: Range<usize>) -> Result<Vec<Vec<f32>>, Error> {
        let (columns, inner) = (self.size.columns, self.inner(&rows));
        let mut base = vec![0.0; columns * rows.len()];
        let heights = self.height.rows(inner.clone())?;
        let wide = self.height.size().columns;
        for (y, heights) in inner.zip(heights.chunks_exact(wide)) {
            let first = (y + self.ring - rows.start) * columns + self.ring;
            for (base, &height) in base[first..first + wide].iter_mut().zip(heights) {
                *base = ((f64::from(height) - self.lowest) / self.cell) as f32;
            }
        }
        let mut planes = vec![base];
        if self.is_open() {
            planes.extend(self.masks(&rows));
        }
        Ok(planes)
    }

    /// The planes of the mask, which the rows beside these have a part in.
    fn masks(&self, rows: &Range<usize>) -> impl Iterator<Item = Vec<f32>> + use<> {
        let Size { columns, rows: all } = self.size;
        let around = rows.start.saturating_sub(1)..(rows.end + 1).min(all);
        let is_inner = |x: usize, y: usize| (1..columns - 1).contains(&x) && (1..all - 1).contains(&y);
        let size = Size { columns, rows: around.len() };
        let flags = around.clone().flat_map(|y| (0..columns).map(move |x| is_inner(x, y))).collect();
        let cells = (rows.start - around.start) * columns..(rows.end - around.start) * columns;
        let planes = mask_planes(&Mask::always(size, flags), true);
        planes.into_iter().map(move |mut plane| {
            plane.truncate(cells.end);
            plane.drain(..cells.start);
            plane
        })
    }

    /// Sums over all cells, row by row from the north.
    fn totals(&self, state: &[FilePlane]) -> Result<Totals, Error> {
        let mut totals = Totals::default();
        let row_sum = |row: &[f32]| row.iter().map(|&cell| f64::from(cell)).sum::<f64>();
        for rows in state[plane::CHANGE].runs_of_rows() {
            let base = self.constants(rows.clone())?.swap_remove(0);
            let change = state[plane::CHANGE].rows(rows.clone())?;
            let (depth, sediment) =
                (state[plane::DEPTH].rows(rows.clone())?, state[plane::SEDIMENT].rows(rows)?);
            let sums = [
                (&base, &mut totals.bedrock),
                (&change, &mut totals.change),
                (&depth, &mut totals.water),
                (&sediment, &mut totals.suspended),
            ];
            for (cells, sum) in sums {
                cells.chunks_exact(self.size.columns).for_each(|row| *sum += row_sum(row));
            }
            for &change in &change {
                totals.changed += f64::from(change).abs();
            }
        }
        Ok(totals)
    }

    /// Writes the layers, and lets go of each plane as soon as it is not needed any more.
    fn store(
        self,
        landscape: &mut StoredLandscape<'_>,
        layer: &str,
        (state, means): (Vec<FilePlane>, Vec<FilePlane>),
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
        plane: &FilePlane,
        convert: impl Fn(f32) -> f32,
    ) -> Result<(), Error> {
        if !landscape.wants(name) {
            return Ok(());
        }
        let mut layer = landscape.plane(name, self.height.size())?;
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
        change: &FilePlane,
    ) -> Result<(), Error> {
        let mut layer = landscape.plane(name, self.height.size())?;
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

    /// Rows of the landscape from a plane of the simulation.
    fn read(&self, plane: &FilePlane, rows: &Range<usize>) -> Result<Vec<f32>, Error> {
        let columns = self.ring..self.ring + self.height.size().columns;
        plane.read(&Window { columns, rows: rows.start + self.ring..rows.end + self.ring })
    }
}

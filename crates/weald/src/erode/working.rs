//! The ground in working units: lengths in cells, a ring of no-data cells around an open domain, and back.

use super::links::mask_planes;
use super::setting::plane;
use super::simulation::{Finished, Flows};
use crate::engine::{Budget, SolidBudget, WaterBudget};
use crate::error::Error;
use crate::grid::{Field, Mask, Size};
use crate::landscape::Landscape;
use crate::stencil::rows::{Layout, Rows};
use crate::step::Outcome;

/// The start of a simulation.
pub(crate) struct Working {
    /// Columns and rows, the ring included.
    pub(crate) size: Size,
    /// Cells with data; `None` where all have.
    pub(crate) mask: Option<Mask>,
    /// Width of the ring: 1 around an open domain, else 0.
    ring: usize,
    cell: f64,
    /// Ground at the start, in metres, without the ring.
    start: Field,
    /// The same in cells, with the ring, above the lowest ground.
    base: Vec<f32>,
    /// Depth of water at the start, in cells.
    water: Vec<f32>,
}

/// What [`Working::store`] has to know of the run.
#[derive(Clone, Copy)]
pub(crate) struct Kept {
    pub(crate) iterations: u64,
    /// Whether the transport loses no sediment.
    pub(crate) conserving: bool,
}

impl Working {
    /// Takes the ground from a layer. Heights count from the lowest ground, which keeps their digits.
    pub(crate) fn new(landscape: &Landscape, layer: &str, open: bool) -> Result<Self, Error> {
        let start = landscape.field(layer)?.clone();
        let domain = &landscape.domain;
        let ring = usize::from(open);
        let size = Size { columns: domain.size.columns + 2 * ring, rows: domain.size.rows + 2 * ring };
        let lowest = start.range(domain.land.as_ref()).map_or(0.0, |(lowest, _)| f64::from(lowest));
        let mut working = Self {
            size,
            mask: ringed_mask(domain.land.as_ref(), domain.size, ring),
            ring,
            cell: domain.cell,
            base: vec![0.0; size.cells()],
            water: vec![0.0; size.cells()],
            start,
        };
        working.base =
            working.ringed(|height| ((f64::from(height) - lowest) / domain.cell) as f32, &working.start);
        Ok(working)
    }

    /// Takes the depth of standing water from a layer.
    pub(crate) fn set_water(&mut self, landscape: &Landscape, layer: &str) -> Result<(), Error> {
        let cell = self.cell;
        self.water = self.ringed(|depth| (f64::from(depth.max(0.0)) / cell) as f32, landscape.field(layer)?);
        Ok(())
    }

    /// A field with the ring, zero there and on cells without data.
    fn ringed(&self, convert: impl Fn(f32) -> f32, field: &Field) -> Vec<f32> {
        let mut cells = vec![0.0; self.size.cells()];
        for y in 0..field.size().rows {
            for (x, &value) in field.row(y).iter().enumerate() {
                let at = self.size.index(x + self.ring, y + self.ring);
                if self.is_land(at) {
                    cells[at] = convert(value);
                }
            }
        }
        cells
    }

    fn is_land(&self, at: usize) -> bool {
        self.mask.as_ref().is_none_or(|mask| mask.is_land_at(at))
    }

    /// State planes of zeros, water in that of the depth where there is one, and the constant planes behind.
    pub(crate) fn state(&self, planes: usize) -> Rows {
        let masks = self.mask.as_ref().map(|mask| mask_planes(mask, self.ring > 0));
        let constants = 1 + masks.as_ref().map_or(0, |masks| masks.len());
        let layout = Layout { columns: self.size.columns, planes: planes + constants };
        let mut rows = Rows::new(layout, self.size.rows);
        if plane::DEPTH < planes {
            rows.scatter(plane::DEPTH, &self.water);
        }
        rows.scatter(planes, &self.base);
        for (at, plane) in masks.iter().flatten().enumerate() {
            rows.scatter(planes + 1 + at, plane);
        }
        rows
    }

    /// A working plane without the ring, converted.
    fn field(&self, plane: &[f32], convert: impl Fn(f32) -> f32) -> Field {
        Field::from_function(self.start.size(), |x, y| {
            let at = self.size.index(x + self.ring, y + self.ring);
            if self.is_land(at) { convert(plane[at]) } else { 0.0 }
        })
    }

    /// Ground after a change in cells: the start stays to the bit where nothing changed.
    fn ground(&self, change: &Field) -> Field {
        let cell = self.cell;
        let raise = |start: f32, change: f32| (f64::from(start) + f64::from(change) * cell) as f32;
        let values = self.start.values().iter().zip(change.values()).map(|(&s, &c)| raise(s, c)).collect();
        Field::from_values(self.start.size(), values)
    }

    /// Writes the layers of a water simulation, whose planes begin with change, depth and sediment.
    pub(crate) fn store(
        &self,
        landscape: &mut Landscape,
        layer: &str,
        finished: &Finished,
        kept: Kept,
    ) -> Outcome {
        let [change, depth, sediment] =
            [plane::CHANGE, plane::DEPTH, plane::SEDIMENT].map(|at| finished.state.gather(at));
        let cell = self.cell as f32;
        let moved = self.field(&change, |change| change);
        let budget = self.budget(&change, &depth, &sediment, finished);
        landscape.insert(layer, "m", self.ground(&moved));
        landscape.insert("water", "m", self.field(&depth, |depth| depth * cell));
        landscape.insert("sediment", "m", self.field(&sediment, |sediment| sediment * cell));
        let volume = cell * cell * cell;
        landscape.insert("flux_x", "m³/step", self.field(&finished.means[0], |flux| flux * volume));
        landscape.insert("flux_y", "m³/step", self.field(&finished.means[1], |flux| flux * volume));
        landscape.insert("erosion", "m", self.field(&change, |change| (-change).max(0.0) * cell));
        landscape.insert("deposition", "m", self.field(&change, |change| change.max(0.0) * cell));
        let mut notes = Vec::new();
        if !kept.conserving {
            notes.push(format!(
                "this transport does not conserve sediment: {:.3e} m³ of solid were {}; transport = \"upwind\", or \
                 \"maccormack\" with `conserve`, conserves it",
                (budget.solid.error() * budget.solid.start).abs(),
                if budget.solid.error() > 0.0 { "lost" } else { "made" },
            ));
        }
        Outcome { iterations: kept.iterations, budget: Some(budget), notes }
    }

    /// Writes the ground alone.
    pub(crate) fn store_ground(
        &self,
        landscape: &mut Landscape,
        layer: &str,
        finished: &Finished,
        iterations: u64,
    ) -> Outcome {
        let change = finished.state.gather(0);
        landscape.insert(layer, "m", self.ground(&self.field(&change, |change| change)));
        let nothing = vec![0.0; change.len()];
        let mut budget = self.budget(&change, &nothing, &nothing, finished);
        budget.water = WaterBudget::default();
        Outcome { iterations, budget: Some(budget), notes: Vec::new() }
    }

    fn budget(&self, change: &[f32], depth: &[f32], sediment: &[f32], finished: &Finished) -> Budget {
        let volume = self.cell * self.cell * self.cell;
        let columns = self.size.columns;
        let total = |cells: &[f32]| -> f64 {
            cells.chunks(columns).map(|row| row.iter().map(|&cell| f64::from(cell)).sum::<f64>()).sum()
        };
        let flows = Flows::from(finished.sums);
        let start = total(&self.base);
        Budget {
            water: WaterBudget {
                incoming: (flows.rained + total(&self.water)) * volume,
                outgoing: flows.water_out * volume,
                stored: total(depth) * volume,
            },
            solid: SolidBudget {
                start: start * volume,
                ground: (start + total(change)) * volume,
                suspended: total(sediment) * volume,
                outgoing: flows.solid_out * volume,
            },
        }
    }
}

/// The mask with a ring of no-data cells around it.
fn ringed_mask(land: Option<&Mask>, size: Size, ring: usize) -> Option<Mask> {
    let ringed = Size { columns: size.columns + 2 * ring, rows: size.rows + 2 * ring };
    let inside = |at: usize, side: usize| at.checked_sub(ring).filter(|at| *at < side);
    let flags = (0..ringed.cells()).map(|at| {
        match (inside(at % ringed.columns, size.columns), inside(at / ringed.columns, size.rows)) {
            (Some(x), Some(y)) => land.is_none_or(|land| land.is_land(x, y)),
            _ => false,
        }
    });
    Mask::new(ringed, flags.collect())
}

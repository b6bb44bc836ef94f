//! The ground in working units: lengths in cells, a ring of no-data cells around an open domain, and back.

use super::extent::Extent;
use super::links::mask_planes;
use super::stack::Stack;
use super::water_planes as plane;
use crate::erode::finished::Finished;
use crate::erode::finished::Flows;
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};
use weald_core::landscape::Landscape;
use weald_core::sea;
use weald_engine::device::{ShownGround, Window};
use weald_engine::stencil::rows::{Layout, Rows};
use weald_engine::{Budget, Engine, SolidBudget, WaterBudget};

/// The start of a simulation.
pub(crate) struct WorkingGrid {
    /// Columns and rows, the ring included.
    pub(crate) size: Size,
    /// The part of the landscape that is simulated.
    window: Window,
    /// Cells with data; `None` where all have.
    pub(crate) mask: Option<Mask>,
    /// Width of the ring: 1 around an open domain, else 0.
    pub(super) ring: usize,
    pub(super) cell: f64,
    /// Ground at the start, in metres, without the ring.
    pub(super) start: Field,
    /// The lowest of it.
    pub(super) lowest: f64,
    /// The same in cells, with the ring, above the lowest ground; that of the bedrock where there is a stack.
    pub(super) base: Vec<f32>,
    /// Depth of water at the start, in cells.
    water: Vec<f32>,
    /// The same in metres, where some stands.
    standing: Option<Field>,
    /// Materials on the bedrock, for processes that tell them apart.
    pub(super) stack: Option<Stack>,
}

/// What [`WorkingGrid::store`] has to know of the run.
#[derive(Clone, Copy)]
pub(crate) struct RunResult {
    pub(crate) iterations: u64,
    /// Whether the transport loses no sediment.
    pub(crate) conserving: bool,
}

impl WorkingGrid {
    /// Takes the ground from a layer. Heights count from the lowest ground, which keeps their digits.
    pub(crate) fn new(landscape: &Landscape, layer: &str, open: bool) -> Result<Self, Error> {
        Self::within(landscape, layer, &Extent { open, region: None, cropped: false })
    }

    /// The same over a part of the landscape.
    pub(crate) fn within(landscape: &Landscape, layer: &str, extent: &Extent<'_>) -> Result<Self, Error> {
        let start = landscape.field(layer)?.clone();
        let region = extent.region.map(|name| landscape.field(name)).transpose()?;
        let sea = sea::cells(landscape, &start);
        let domain = &landscape.domain;
        let ring = usize::from(extent.open);
        let window = extent.window(landscape)?;
        let size = Size { columns: window.columns.len() + 2 * ring, rows: window.rows.len() + 2 * ring };
        let first = [window.columns.start, window.rows.start];
        let lowest = start.range(domain.valid.as_ref()).map_or(0.0, |(lowest, _)| f64::from(lowest));
        let mut working = Self {
            size,
            window,
            mask: ringed_mask(size, ring, |x, y| {
                let [x, y] = [x + first[0], y + first[1]];
                let here = region.is_none_or(|region| region.at(x, y) >= 0.5)
                    && sea.as_ref().is_none_or(|sea| !sea[domain.size.index(x, y)]);
                here && domain.valid.as_ref().is_none_or(|valid| valid.is_valid(x, y))
            }),
            ring,
            cell: domain.cell,
            lowest,
            base: Vec::new(),
            water: vec![0.0; size.cells()],
            standing: None,
            stack: None,
            start,
        };
        working.base =
            working.ringed(|x, y| ((f64::from(working.start.at(x, y)) - lowest) / domain.cell) as f32);
        Ok(working)
    }

    /// Makes room for a mask that may change.
    pub(super) fn set_changing_mask(&mut self) {
        let size = self.size;
        self.mask.get_or_insert_with(|| Mask::always(size, vec![true; size.cells()]));
    }

    /// Takes the depth of standing water from a layer.
    pub(crate) fn set_water(&mut self, landscape: &Landscape, layer: &str) -> Result<(), Error> {
        self.set_standing(landscape.field(layer)?.clone());
        Ok(())
    }

    /// The same from a field.
    pub(crate) fn set_standing(&mut self, standing: Field) {
        self.water = self.lengths(&standing);
        self.standing = Some(standing);
    }

    /// Tells a device where the ground lies, for those who look on.
    pub(crate) fn show(&self, engine: &Engine) -> Result<(), Error> {
        let ring = self.ring as i32;
        engine.shows(&ShownGround {
            start: &self.start,
            water: self.standing.as_ref(),
            size: self.size,
            first: [self.window.columns.start as i32 - ring, self.window.rows.start as i32 - ring],
            unit: self.cell as f32,
            lowest: self.lowest as f32,
        })
    }

    /// Where a cell of the landscape stands in the working planes, if it is simulated.
    pub(super) fn place(&self, x: usize, y: usize) -> Option<usize> {
        let Window { columns, rows } = &self.window;
        let inside = columns.contains(&x) && rows.contains(&y);
        inside.then(|| self.size.index(x - columns.start + self.ring, y - rows.start + self.ring))
    }

    /// Lengths of a field in cells, none below 0, as [`WorkingGrid::ringed`].
    pub(super) fn lengths(&self, metres: &Field) -> Vec<f32> {
        self.ringed(|x, y| (f64::from(metres.at(x, y).max(0.0)) / self.cell) as f32)
    }

    /// Values with the ring, zero there and on cells without data.
    pub(super) fn ringed(&self, value: impl Fn(usize, usize) -> f32) -> Vec<f32> {
        let mut cells = vec![0.0; self.size.cells()];
        for y in self.window.rows.clone() {
            for x in self.window.columns.clone() {
                if let Some(at) = self.place(x, y).filter(|&at| self.is_valid(at)) {
                    cells[at] = value(x, y);
                }
            }
        }
        cells
    }

    /// Depth of water at the start, in cells, with the ring.
    pub(super) fn water(&self) -> &[f32] {
        &self.water
    }

    fn is_valid(&self, at: usize) -> bool {
        self.mask.as_ref().is_none_or(|mask| mask.is_valid_at(at))
    }

    /// State planes of zeros with the materials in theirs, and the constant planes behind: the ground, the
    /// mask, and those that are given.
    pub(crate) fn state(&self, planes: usize, more: &[Vec<f32>]) -> Rows {
        let masks = self.mask.as_ref().map(|mask| mask_planes(mask, self.ring > 0));
        let constants = std::iter::once(&self.base).chain(masks.iter().flatten()).chain(more);
        let layout = Layout { columns: self.size.columns, planes: planes + constants.clone().count() };
        let mut rows = Rows::new(layout, self.size.rows);
        for (at, plane) in constants.enumerate() {
            rows.scatter(planes + at, plane);
        }
        if let Some(stack) = &self.stack {
            stack.scatter(&mut rows);
        }
        rows
    }

    /// The same with the water that stands, for states that begin with change, depth and sediment.
    pub(crate) fn water_state(&self, planes: usize, more: &[Vec<f32>]) -> Rows {
        let mut rows = self.state(planes, more);
        rows.scatter(plane::DEPTH, &self.water);
        rows
    }

    /// A working plane without the ring, converted; 0 on cells that take no part.
    pub(super) fn field(&self, plane: &[f32], convert: impl Fn(f32) -> f32) -> Field {
        self.field_or(|at| convert(plane[at]), |_, _| 0.0)
    }

    /// Values by the place in the working planes, and other values by column and row on cells that take no part.
    pub(super) fn field_or(
        &self,
        value: impl Fn(usize) -> f32,
        elsewhere: impl Fn(usize, usize) -> f32,
    ) -> Field {
        Field::from_function(self.start.size(), |x, y| match self.place(x, y) {
            Some(at) if self.is_valid(at) => value(at),
            _ => elsewhere(x, y),
        })
    }

    /// Depths of water in metres; where a region leaves cells out, water stands there as it did.
    pub(super) fn depths(&self, depth: &[f32], valid: Option<&Mask>) -> Field {
        let cell = self.cell as f32;
        self.field_or(
            |at| depth[at] * cell,
            |x, y| match &self.standing {
                Some(standing) if valid.is_none_or(|valid| valid.is_valid(x, y)) => {
                    standing.at(x, y).max(0.0)
                }
                _ => 0.0,
            },
        )
    }

    /// Ground after a change in cells: the start stays to the bit where nothing changed.
    pub(super) fn ground(&self, change: &Field) -> Field {
        let cell = self.cell;
        let raise = |start: f32, change: f32| (f64::from(start) + f64::from(change) * cell) as f32;
        let values = self.start.values().iter().zip(change.values()).map(|(&s, &c)| raise(s, c)).collect();
        Field::from_values(self.start.size(), values)
    }

    /// Sum over all cells, row by row.
    pub(super) fn total(&self, cells: &[f32]) -> f64 {
        let rows = cells.chunks(self.size.columns);
        rows.map(|row| row.iter().map(|&cell| f64::from(cell)).sum::<f64>()).sum()
    }

    /// Columns and rows, and whether there is a mask.
    pub(super) fn shape(&self) -> (Size, bool) {
        (self.size, self.mask.is_some())
    }

    pub(super) fn budget(&self, depth: &[f32], sediment: &[f32], finished: &Finished) -> Budget {
        let total = |cells: &[f32]| self.total(cells);
        let change = finished.state.gather(plane::CHANGE);
        let totals = Totals {
            bedrock: total(&self.base),
            standing: total(&self.water),
            water: total(depth),
            change: total(&change),
            changed: total(&change.iter().map(|change| change.abs()).collect::<Vec<_>>()),
            suspended: total(sediment),
            loose: self.loose(finished),
        };
        totals.budget(&Flows::from(finished.sums), self.cell)
    }
}

/// Sums over all cells of a simulation of water, in cells³.
#[derive(Default)]
pub(super) struct Totals {
    /// The ground of the start above its lowest place, or the bedrock of a stack.
    pub(super) bedrock: f64,
    /// Water at the start and at the end.
    pub(super) standing: f64,
    pub(super) water: f64,
    /// Change of the ground, and without its sign.
    pub(super) change: f64,
    pub(super) changed: f64,
    /// Sediment in the water.
    pub(super) suspended: f64,
    /// What lay on the bedrock before, and lies there after.
    pub(super) loose: [f64; 2],
}

impl Totals {
    /// Where water and solid went, with cells of so many metres.
    pub(super) fn budget(&self, flows: &Flows, cell: f64) -> Budget {
        let volume = cell * cell * cell;
        let [loose_before, loose] = self.loose;
        let moved =
            self.changed + (loose - loose_before).abs() + self.suspended.abs() + flows.solid_out.abs();
        Budget {
            water: WaterBudget {
                incoming: (flows.rained + self.standing) * volume,
                outgoing: flows.water_out * volume,
                stored: self.water * volume,
            },
            solid: SolidBudget {
                start: (self.bedrock + loose_before) * volume,
                uplifted: 0.0,
                ground: (self.bedrock + self.change) * volume,
                layers: loose * volume,
                suspended: self.suspended * volume,
                outgoing: flows.solid_out * volume,
                moved: moved * volume,
            },
        }
    }
}

/// The mask of a working grid with a ring of no-data cells around the cells that take part.
fn ringed_mask(ringed: Size, ring: usize, takes_part: impl Fn(usize, usize) -> bool) -> Option<Mask> {
    let inside = |at: usize, side: usize| at.checked_sub(ring).filter(|at| *at + 2 * ring < side);
    let flags = (0..ringed.cells()).map(|at| {
        match (inside(at % ringed.columns, ringed.columns), inside(at / ringed.columns, ringed.rows)) {
            (Some(x), Some(y)) => takes_part(x, y),
            _ => false,
        }
    });
    Mask::new(ringed, flags.collect())
}

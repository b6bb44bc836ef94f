//! Rivers that cut into ground that rises: the stream-power equation with creep and deposits.
//!
//! ```text
//! dh/dt = U − K Aᵐ Sⁿ + G Q / A + D ∇²h
//! ```
//!
//! with uplift U, upslope area A, slope S and the flux Q of sediment (Howard 1994, doi 10.1029/94WR00757; implicit along the
//! rivers, Braun and Willett 2013, doi 10.1016/j.geomorph.2012.10.008; deposits, Yuan et al. 2019, doi
//! 10.1029/2018JF004867). Where uplift and rivers are in balance, S = (U (1 + G) / K)^(1/n) A^(−m/n).
//!
//! What differs: receivers are found between points that lie off the middles of their cells (`mesh`), rivers run through lakes
//! (`lakes`), A is at least that from which on there is a river, so that ridges do not depend on the cell, rivers carry off what
//! creeps into them (`creep`), slopes stand at a critical slope or at the talus of their material at most, and lakes and sea trap sediment (`incise`). A step of time is one pass through the files: receivers, lakes, the order of cells
//! along the rivers with their areas, incision, creep. Its cost is linear in the cells, and its result the same for any number
//! of threads: they share rows where cells do not depend on each other, and rivers are followed by one.

mod creep;
mod incise;
mod lakes;
mod mesh;
mod order;
mod receivers;
mod sea;
#[cfg(test)]
mod tests;

use rayon::prelude::*;

use creep::Slopes;
use incise::{Law, Rivers};
use lakes::Lakes;
pub(super) use mesh::Mesh;
use order::Order;
use receivers::Receivers;
use weald_core::domain::Domain;
use weald_core::grid::Field;

/// What drives the ground and how it resists.
#[derive(Clone, Debug)]
pub(super) struct Conditions {
    /// Uplift of each cell in a step of time, in metres.
    pub(super) uplift: Field,
    /// K dt of each cell, in m^(1 - 2m).
    pub(super) erodibility: Field,
    /// m.
    pub(super) area_exponent: f64,
    /// Upslope area from which on there is a river, in m²; slopes with less count as having so much.
    pub(super) hillslope_area: f64,
    /// n.
    pub(super) slope_exponent: f64,
    /// G.
    pub(super) deposition: f64,
    /// D dt in m².
    pub(super) creep: f64,
    /// Steepest slope that stands, as a tangent.
    pub(super) critical: f64,
    /// The same for each cell, where materials stand at slopes of their own.
    pub(super) taluses: Option<Field>,
    /// Height of the sea in metres.
    pub(super) sea_level: Option<f64>,
    /// Whether sediment settles in lakes as it does in the sea.
    pub(super) lakes_fill: bool,
    /// Distance in which most of what a river carries settles under water, in metres; 0 where nothing does.
    pub(super) settling: f64,
}

/// Ground on its way.
#[derive(Debug)]
pub(super) struct Evolution {
    mesh: Mesh,
    /// Heights in metres, infinite where there is no data.
    heights: Vec<f64>,
    spare: Vec<f64>,
    /// Cells whose height does not change, at the border of the grid or of the data.
    base: Vec<bool>,
    receivers: Receivers,
    order: Order,
    area: Vec<f64>,
    power: Vec<f32>,
    /// Steepest slope that stands in each cell, where that is not the same everywhere.
    steepest: Vec<f32>,
    raised: Vec<f64>,
    /// What has crept into each river, in metres over its cell.
    crept: Vec<f64>,
    water: Lakes,
}

/// What came and went in a step of time, in metres over all cells together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Volumes {
    /// Raised by uplift.
    pub(super) uplifted: f64,
    /// Carried or crept over the border.
    pub(super) outgoing: f64,
}

impl Evolution {
    /// From heights in metres over a mesh. Rivers leave the grid or the data over those cells of its border where `leave`.
    pub(super) fn new(
        domain: &Domain,
        heights: &[f64],
        mesh: Mesh,
        leave: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let has_data = |x, y| domain.valid.as_ref().is_none_or(|valid| valid.is_valid(x, y));
        let heights = mesh.ringed(f64::INFINITY, |x, y| {
            if has_data(x, y) { heights[domain.size.index(x, y)] } else { f64::INFINITY }
        });
        let mut base = vec![false; mesh.cells()];
        for (at, cell) in mesh.inner().enumerate() {
            let is_border = mesh.around(cell).iter().any(|&beside| heights[beside].is_infinite());
            base[cell] = is_border && leave(at % domain.size.columns, at / domain.size.columns);
        }
        let cells = mesh.cells();
        Self {
            spare: heights.clone(),
            receivers: Receivers::none(&mesh),
            order: Order::none(cells),
            area: vec![0.0; cells],
            power: vec![0.0; cells],
            steepest: Vec::new(),
            raised: heights.clone(),
            crept: vec![0.0; cells],
            water: Lakes::none(&mesh),
            mesh,
            heights,
            base,
        }
    }

    /// Whether rivers can leave anywhere.
    pub(super) fn has_outlet(&self) -> bool {
        self.base.contains(&true)
    }

    /// A step of time.
    pub(super) fn step(&mut self, conditions: &Conditions) -> Volumes {
        self.lead_rivers(conditions.sea_level);
        self.gather_power(conditions);
        self.gather_taluses(conditions);
        let uplifted = self.raise(&conditions.uplift);
        let risen = self.total(&self.raised);
        self.creep(conditions);
        let law = Law {
            slope_exponent: conditions.slope_exponent,
            deposition: conditions.deposition,
            critical: conditions.critical,
            trapped: trapped(conditions.settling, self.mesh.cell),
            passing_above: if conditions.lakes_fill {
                f64::INFINITY
            } else {
                conditions.sea_level.unwrap_or(f64::NEG_INFINITY)
            },
        };
        let rivers = Rivers {
            mesh: &self.mesh,
            receivers: &self.receivers,
            order: &self.order,
            area: &self.area,
            raised: &self.raised,
            crept: &self.crept,
            water: self.water.stand.then_some(&self.water.level),
            power: &self.power,
            steepest: conditions.taluses.is_some().then_some(&self.steepest),
        };
        law.incise(&rivers, &mut self.heights, &mut self.spare);
        Volumes { uplifted, outgoing: risen - self.total(&self.heights) }
    }

    fn creep(&mut self, conditions: &Conditions) {
        let Self { mesh, base, area, raised, spare, crept, .. } = self;
        if conditions.creep > 0.0 {
            crept.fill(0.0);
            let slopes = Slopes { mesh, base, area, river_from: conditions.hillslope_area };
            slopes.creep(conditions.creep, (raised, spare), crept);
        }
    }

    /// Sum over all cells with data, row by row.
    fn total(&self, heights: &[f64]) -> f64 {
        let rows = heights.par_chunks(self.mesh.stride);
        let of_row = |row: &[f64]| row.iter().filter(|height| height.is_finite()).sum::<f64>();
        let rows: Vec<f64> = rows.map(of_row).collect();
        rows.iter().sum()
    }

    /// Finds where water runs and stands, and upslope areas.
    fn lead_rivers(&mut self, sea_level: Option<f64>) {
        let Self { mesh, heights, base, receivers, order, area, water, .. } = self;
        receivers.find(mesh, heights, base);
        water.drain(mesh, heights, base, receivers);
        area.fill(mesh.area);
        order.find(&receivers.of, heights, area);
        if let Some(level) = sea_level {
            sea::flood(mesh, heights, level, water);
        }
    }

    /// K Aᵐ dt.
    fn gather_power(&mut self, conditions: &Conditions) {
        let Self { mesh, area, power, .. } = self;
        let (m, hillslope) = (conditions.area_exponent, conditions.hillslope_area);
        let rows = power.par_chunks_mut(mesh.stride).zip(area.par_chunks(mesh.stride)).skip(1);
        rows.take(mesh.size.rows).enumerate().for_each(|(y, (power, area))| {
            let cells = power[1..].iter_mut().zip(&area[1..]).zip(conditions.erodibility.row(y));
            for ((power, &area), &erodibility) in cells {
                let area = area.max(hillslope) as f32;
                let of_area = if m == 0.5 { area.sqrt() } else { libm::powf(area, m as f32) };
                *power = erodibility * of_area;
            }
        });
    }

    /// The steepest slopes of cells, where they have their own.
    fn gather_taluses(&mut self, conditions: &Conditions) {
        let Some(taluses) = &conditions.taluses else { return };
        let critical = conditions.critical as f32;
        self.steepest.resize(self.mesh.cells(), critical);
        let rows = self.steepest.par_chunks_mut(self.mesh.stride).skip(1);
        rows.take(self.mesh.size.rows).enumerate().for_each(|(y, steepest)| {
            for (steepest, &talus) in steepest[1..].iter_mut().zip(taluses.row(y)) {
                *steepest = talus.min(critical);
            }
        });
    }

    /// Gives the metres by which all cells together rise.
    fn raise(&mut self, uplift: &Field) -> f64 {
        let Self { mesh, heights, base, raised, .. } = self;
        let rows = raised.par_chunks_mut(mesh.stride).zip(heights.par_chunks(mesh.stride)).enumerate();
        let rows = rows.skip(1).take(mesh.size.rows).map(|(y, (raised, heights))| {
            let cells = raised[1..].iter_mut().zip(&heights[1..]).zip(&base[y * mesh.stride + 1..]);
            let mut risen = 0.0;
            for (((raised, &height), &base), &uplift) in cells.zip(uplift.row(y - 1)) {
                let uplift = if base || height.is_infinite() { 0.0 } else { f64::from(uplift) };
                *raised = height + uplift;
                risen += uplift;
            }
            risen
        });
        // Gathered in the order of the rows, so that the sum does not depend on the threads.
        let risen: Vec<f64> = rows.collect();
        risen.iter().sum()
    }

    /// Heights of the grid, row by row; infinite where there is no data.
    pub(super) fn heights(&self) -> Vec<f64> {
        self.mesh.inner().map(|cell| self.heights[cell]).collect()
    }

    /// Goes on from kept heights.
    pub(super) fn resume(&mut self, heights: &[f64]) {
        let cells: Vec<_> = self.mesh.inner().collect();
        for (cell, &height) in cells.into_iter().zip(heights) {
            self.heights[cell] = height;
        }
    }

    /// Depth of the lakes that stand on the ground, in metres; the sea is not among them.
    pub(super) fn lake_depths(&mut self, sea_level: Option<f64>) -> Vec<f64> {
        self.lead_rivers(sea_level);
        let sea = sea_level.unwrap_or(f64::NEG_INFINITY);
        let stands = |cell: usize| self.water.stand && self.water.level[cell] > sea;
        let depth =
            |cell: usize| if stands(cell) { self.water.level[cell] - self.heights[cell] } else { 0.0 };
        self.mesh.inner().map(|cell| depth(cell).max(0.0)).collect()
    }
}

/// Share of the flux that settles in a cell, where 63 % of it do in the settling length.
fn trapped(settling: f64, cell: f64) -> f64 {
    if settling > 0.0 { -libm::expm1(-cell / settling) } else { 0.0 }
}

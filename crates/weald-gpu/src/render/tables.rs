//! Frames per second of grass as the source measured them (Kim and Cho 2009, tables 1 to 3), beside its own numbers,
//! and the frame budget: what the parts of a picture take.
//!
//! The source drew on a Core 2 Duo E8500 with a `GeForce` 9600 GT. Tables 1 and 2 draw all sets of a field, each blade
//! with ten vertices a level of growth, from where the whole field is seen, without culling or thinning. Table 3 looks
//! from far, from the eye level and from near; its scene is not described but for "40,000 to 50,000 blocks" in the far
//! view: here it is a field of 50,000 sets, of which those out of sight are left out.

use weald::Error;

use super::field::{GrassField, GrassStandpoint};
use super::grass_look::GrassLook;
use super::timing::Timings;
use crate::gpu::Gpu;

/// One measured picture of a field, and what the source has.
#[derive(Clone, Debug, PartialEq)]
pub struct GrassRow {
    /// Number of the source's table, 1 to 3; 0 for the frame budget.
    pub table: u8,
    /// From where the field is seen.
    pub standpoint: GrassStandpoint,
    /// What is shown of its grass.
    pub look: GrassLook,
    /// Sets that the field was to have.
    pub wanted: u32,
    /// Sets that are sown on the device, around the camera where they are thinned, and that are drawn.
    pub sets: [u64; 2],
    /// What the parts took.
    pub timings: Timings,
    /// Frames per second in the source.
    pub source: Option<f64>,
}

impl GrassRow {
    /// Frames per second, drawn one after the other.
    pub fn frames_per_second(&self) -> f64 {
        1.0 / self.timings.picture.as_secs_f64().max(1e-9)
    }
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Measuring {
    /// Width and height of the pictures in pixels.
    pub size: [u32; 2],
    /// Pictures of each row, of which the fastest counts.
    pub times: u32,
    /// Most sets that a picture may draw; rows of more are left out.
    pub most_drawn: u32,
}

impl Measuring {
    /// What suits a device: all rows in full size on a card; on software a small picture, and sets that are drawn within
    /// seconds.
    pub fn of(gpu: &Gpu) -> Self {
        if gpu.is_software() {
            Self { size: [480, 270], times: 1, most_drawn: 50_100 }
        } else {
            Self { size: [1920, 1080], times: 40, most_drawn: u32::MAX }
        }
    }
}

/// Is called with each row as it is measured; an error ends the measurement.
pub type OnRow<'a> = dyn FnMut(&GrassRow) -> Result<(), Error> + 'a;

/// A row to be measured.
#[derive(Clone, Copy, Debug)]
struct Plan {
    table: u8,
    standpoint: GrassStandpoint,
    look: GrassLook,
    sets: u32,
    source: Option<f64>,
}

impl Plan {
    /// Sets that are drawn from wherever one looks, but for the few that a field lacks.
    fn draws_at_least(&self) -> u32 {
        if self.look.culled || self.look.thinned { 0 } else { self.sets - self.sets / 50 }
    }
}

/// Sets and frames per second of table 1.
const TABLE_1: [(u32, f64); 8] = [
    (1, 693.05),
    (100, 548.28),
    (1_000, 481.10),
    (5_000, 223.76),
    (10_000, 117.30),
    (30_000, 38.47),
    (50_000, 24.70),
    (100_000, 12.46),
];

/// Sets, and frames per second of levels 1 to 4, of table 2.
const TABLE_2: [(u32, [f64; 4]); 2] =
    [(50_000, [73.40, 45.29, 30.88, 24.47]), (100_000, [39.16, 22.01, 15.27, 12.02])];

/// Views, and frames per second of levels 1 to 4, of table 3.
const TABLE_3: [(GrassStandpoint, [f64; 4]); 3] = [
    (GrassStandpoint::Far, [110.46, 80.52, 41.22, 28.70]),
    (GrassStandpoint::Eye, [212.88, 109.58, 85.26, 56.25]),
    (GrassStandpoint::Near, [301.58, 229.46, 191.62, 150.25]),
];

/// Sets of the field of table 3.
const SETS_OF_TABLE_3: u32 = 50_000;

/// Sets of the fields of the frame budget.
const BUDGETS: [u32; 3] = [10_000, 100_000, 1_000_000];

/// All sets as the source draws them, of a level from 1 to 4.
fn as_in_the_source(level: usize, culled: bool) -> GrassLook {
    GrassLook { culled, thinned: false, reach: 1.0, level: Some(level as f32) }
}

fn plans_of_the_source() -> Vec<Plan> {
    let far = GrassStandpoint::Far;
    let all = |table, sets, level, fps| {
        let look = as_in_the_source(level, false);
        Plan { table, standpoint: far, look, sets, source: Some(fps) }
    };
    let first = TABLE_1.into_iter().map(|(sets, fps)| all(1, sets, 4, fps));
    let second = TABLE_2
        .into_iter()
        .flat_map(|(sets, fps)| (1..).zip(fps).map(move |(level, fps)| all(2, sets, level, fps)));
    let third = TABLE_3.into_iter().flat_map(|(standpoint, fps)| {
        (1..).zip(fps).map(move |(level, fps)| {
            let look = as_in_the_source(level, true);
            Plan { table: 3, standpoint, look, sets: SETS_OF_TABLE_3, source: Some(fps) }
        })
    });
    first.chain(second).chain(third).collect()
}

fn plans_of_the_budget() -> Vec<Plan> {
    let looks = [(true, true), (false, true), (true, false), (false, false)];
    let plan = |sets, (culled, thinned)| {
        let look = GrassLook { culled, thinned, reach: 1.0, level: None };
        Plan { table: 0, standpoint: GrassStandpoint::Eye, look, sets, source: None }
    };
    BUDGETS.into_iter().flat_map(|sets| looks.map(|look| plan(sets, look))).collect()
}

/// The source's tables, measured on a device.
///
/// # Errors
/// [`Error::Device`] for a device without a clock or that fails; those of `on_row`.
pub fn grass_tables(gpu: &Gpu, what: Measuring, on_row: &mut OnRow<'_>) -> Result<Vec<GrassRow>, Error> {
    measured(gpu, what, plans_of_the_source(), on_row)
}

/// What the parts of a picture take from a person's height in fields of 10,000, 100,000 and 1,000,000 sets, with and
/// without culling and thinning.
///
/// # Errors
/// As [`grass_tables`].
pub fn frame_budget(gpu: &Gpu, what: Measuring, on_row: &mut OnRow<'_>) -> Result<Vec<GrassRow>, Error> {
    measured(gpu, what, plans_of_the_budget(), on_row)
}

fn measured(
    gpu: &Gpu,
    what: Measuring,
    plans: Vec<Plan>,
    on_row: &mut OnRow<'_>,
) -> Result<Vec<GrassRow>, Error> {
    let (mut rows, mut field): (Vec<GrassRow>, Option<(u32, GrassField)>) = (Vec::new(), None);
    // Fields that draw all their sets, and would draw too many, need not be sown to be left out.
    for plan in plans.into_iter().filter(|plan| plan.draws_at_least() <= what.most_drawn) {
        let (_, field) = match field.take() {
            Some(known) if known.0 == plan.sets => field.insert(known),
            _ => field.insert((plan.sets, GrassField::new(gpu, plan.sets, plan.table == 0, what.size)?)),
        };
        field.show(plan.look);
        let camera = field.camera(plan.standpoint);
        let sets = field.count(&camera)?;
        if sets[1] > u64::from(what.most_drawn) {
            continue;
        }
        let timings = field.renderer.measure(&camera, what.times)?;
        let Plan { table, standpoint, look, sets: wanted, source } = plan;
        let row = GrassRow { table, standpoint, look, wanted, sets, timings, source };
        on_row(&row)?;
        rows.push(row);
    }
    Ok(rows)
}

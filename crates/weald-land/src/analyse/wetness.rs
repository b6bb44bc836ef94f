//! The topographic wetness index: how much land drains through a cell, against how steep it is.
//!
//! ```text
//! wetness = ln(a / tan β)        a = upslope area by length of contour, β = slope
//! ```
//!
//! Beven and Kirkby 1979, "A physically based, variable contributing area model of basin hydrology", doi
//! 10.1080/02626667909491834. Areas come from flow that divides, the slope is that of the ways down in
//! proportion to their shares (Quinn et al. 1991, doi 10.1002/hyp.3360050106). Differs: the length of contour
//! is not a constant of the direction. What leaves a cell moves on by `d`, the mean of the steps to its
//! neighbours by their shares, and falls by `h`, the mean of the falls. So `a = A |d| / cell²` and `tan β = h / |d|`:
//! both are those of the plane on planes along the axes and the diagonals.

use std::f64::consts::LN_2;

use rayon::prelude::*;

use super::ensure_finite;
use super::stages::Stages;
use crate::exponential::log2;
use crate::flow::directions::STEPS;
use crate::flow::row_weights::{RowOutflow, RowWeights};
use crate::flow::{MultipleFlow, Routed, Routing, STAGES, accumulate_multiple, route_watched};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_core::vectors;
use weald_engine::Job;
use weald_engine::step::{Entry, Outcome, Stage, Step};

/// The step's declaration.
pub const ENTRY: Entry = Entry::of::<Wetness>(
    "wetness",
    Stage::Analyse,
    "the topographic wetness index ln(a / tan β)",
    "Beven and Kirkby 1979; Quinn et al. 1991",
);

parameters! {
    /// The topographic wetness index.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Field, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::analyse::wetness::Wetness;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// landscape.insert("height", "m", Field::from_function(landscape.domain.size, |_, y| 100.0 - y as f32));
    /// Wetness::default().run(&mut landscape, &Job::unwatched(0))?;
    /// let expected = (10.0_f32 / 0.1).ln(); // a cell of 10 m drains through 10 m of contour, on a slope of 0.1
    /// assert!((landscape.field("wetness")?.at(4, 0) - expected).abs() < 1.0e-4);
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Wetness {
        /// Layer of heights.
        of: LayerName = LayerName::of("height");
        /// Shares of lower neighbours are in proportion to slope to this power.
        exponent: f64 = 1.1, range 0.0..=20.0;
        /// Gentler slopes count as this one, so that flat ground has an index: a metre in a kilometre.
        min_slope: f64 = 0.001, range 1.0e-6..=1.0;
        /// Height of the sea, in which flow ends. Default: that of the landscape.
        sea_level: Option<f64> = None, range -1.0e6..=1.0e6, unit "m";
        /// Layer that is written.
        into: LayerName = LayerName::of("wetness");
    }
}

impl Step for Wetness {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.into.0.clone(), "1")]
    }

    fn range(&self, _: &str) -> Option<(f64, f64)> {
        Some((f64::NEG_INFINITY, f64::INFINITY))
    }

    fn bytes_per_cell(&self) -> u64 {
        32
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        ensure_finite(landscape, &self.of.0)?;
        let domain = &landscape.domain;
        let mut stages = Stages::of(job, STAGES + 1, domain.size.cells());
        let routing = Routing { sea_level: self.sea_level.or(domain.sea_level), ..Routing::default() };
        let (ground, valid) = (landscape.field(&self.of.0)?, domain.valid.as_ref());
        let routed = route_watched(ground, valid, &routing, &mut || stages.passed())?;
        let flow = MultipleFlow { routed: &routed, valid: domain.valid.as_ref(), exponent: self.exponent };
        let index = wetness(&flow, domain.cell, self.min_slope);
        stages.passed()?;
        landscape.insert(&self.into.0, "1", index);
        Ok(Outcome { iterations: 1, ..Outcome::default() })
    }
}

/// The index of each cell, for cells of `cell` metres; slopes below `least_slope` count as that.
pub fn wetness(flow: &MultipleFlow<'_>, cell: f64, least_slope: f64) -> Field {
    let upslope = accumulate_multiple(flow, None);
    let (columns, mut values) = (flow.routed.surface.size().columns, vec![0.0; upslope.len()]);
    let by_rows = values.par_chunks_mut(columns).zip(upslope.par_chunks(columns));
    by_rows.enumerate().for_each(|(y, (values, upslope))| {
        let outflows = Outflow::of_row(flow, y);
        vectors::widest(
            #[inline(always)]
            || {
                for ((value, &cells), outflow) in values.iter_mut().zip(upslope).zip(&outflows) {
                    let by_contour = cells * outflow.step * cell;
                    let slope = (outflow.fall / (outflow.step * cell)).max(least_slope);
                    let index = (LN_2 * log2(by_contour / slope)) as f32;
                    *value = if cells == 0.0 { 0.0 } else { index };
                }
            },
        );
    });
    Field::from_values(flow.routed.surface.size(), values)
}

/// How water leaves a cell.
struct Outflow {
    /// How far it moves on, in cells.
    step: f64,
    /// How far it falls, in metres.
    fall: f64,
}

impl Outflow {
    /// Those of the cells of a row.
    fn of_row(flow: &MultipleFlow<'_>, y: usize) -> Vec<Self> {
        let columns = flow.routed.surface.size().columns;
        let of_cell = |x: usize| Self::of(flow, y * columns + x);
        let Some(weights) = RowWeights::of(flow, y) else { return (0..columns).map(of_cell).collect() };
        let RowOutflow { to: [east, south], fall } = weights.outflow(flow, y);
        let inner = |at: usize| Self { step: Self::step([east[at], south[at]]), fall: fall[at] };
        let of = |x: usize| {
            let is_inner = x > 0 && x + 1 < columns && weights.totals()[x - 1] > 0.0;
            let is_steep = is_inner && flow.routed.directions.downstream(y * columns + x).is_some();
            if is_steep { inner(x - 1) } else { of_cell(x) }
        };
        (0..columns).map(of).collect()
    }

    /// How far water moves on that goes so far eastward and southward.
    fn step(to: [f64; 2]) -> f64 {
        (to[0] * to[0] + to[1] * to[1]).sqrt().max(MIN_STEP)
    }

    fn of(flow: &MultipleFlow<'_>, cell: usize) -> Self {
        let Routed { surface, directions, .. } = flow.routed;
        if directions.downstream(cell).is_none() {
            // Water leaves straight over the edge.
            return Self { step: 1.0, fall: 0.0 };
        }
        let columns = surface.size().columns as isize;
        let (mut to, mut fall) = ([0.0, 0.0], 0.0);
        for (share, (east, south)) in
            flow.shares(cell).into_iter().zip(STEPS).filter(|(share, _)| *share > 0.0)
        {
            to = [to[0] + share * east as f64, to[1] + share * south as f64];
            let other = cell.wrapping_add_signed(south * columns + east);
            fall += share * (f64::from(surface.values()[cell]) - f64::from(surface.values()[other]));
        }
        Self { step: Self::step(to), fall }
    }
}

/// Water that parts in opposite directions, as on a ridge, moves on by nothing on average; a quarter of a cell
/// keeps the logarithm finite.
const MIN_STEP: f64 = 0.25;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::route;
    use weald_core::grid::Size;

    /// Wetness of a plane that falls by `slope` towards an angle, and distance from its top along the fall, in
    /// the middle of the grid.
    fn on_a_plane(angle: f64, slope: f64) -> f64 {
        let size = Size::square(121).expect("legal");
        let (east, south) = (libm::cos(angle), libm::sin(angle));
        let height = Field::from_function(size, |x, y| {
            (1000.0 - slope * 10.0 * (x as f64 * east + y as f64 * south)) as f32
        });
        let routed = route(&height, None, &Routing::default());
        let flow = MultipleFlow { routed: &routed, valid: None, exponent: 1.1 };
        f64::from(wetness(&flow, 10.0, 0.001).at(60, 60))
    }

    #[test]
    fn on_planes_it_is_the_distance_from_the_top_over_the_slope() {
        let straight = on_a_plane(0.0, 0.2);
        assert!((straight - libm::log(61.0 * 10.0 / 0.2)).abs() < 0.06, "{straight}");
        // The corner is the top of the diagonal: √2 as far, but less of the land drains far.
        let diagonal = on_a_plane(std::f64::consts::FRAC_PI_4, 0.2);
        assert!(
            (diagonal - libm::log(61.0 * 10.0 * std::f64::consts::SQRT_2 / 0.2)).abs() < 0.15,
            "{diagonal}"
        );
        assert!((on_a_plane(0.0, 0.1) - straight - LN_2).abs() < 0.02);
    }

    #[test]
    fn flat_ground_has_the_least_slope() {
        let level = Field::filled(Size::square(9).expect("legal"), 5.0);
        let routed = route(&level, None, &Routing::default());
        let flow = MultipleFlow { routed: &routed, valid: None, exponent: 1.1 };
        let corner = wetness(&flow, 10.0, 0.01).at(0, 0);
        assert!((f64::from(corner) - libm::log(10.0 / 0.01)).abs() < 1e-6, "{corner}");
    }
}

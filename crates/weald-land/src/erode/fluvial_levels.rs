//! Coarse first: most of the time of a flood runs on coarser grids, each with cells twice as long, which hand change of
//! the ground, water and sediment down with their volumes.
//!
//! Where valleys lie is decided on the coarsest grid. Landscapes of any size that begin on the same one have the same
//! valleys; a number of levels counted from the finest gave each size its own.
//!
//! A coarse cell begins as the mean of its fine ones. What it has become goes down by bilinear interpolation between
//! the middles of cells, which gives every coarse cell's volume to fine ones whole: 9, 3, 3 and 1 sixteenths.

use rayon::prelude::*;

use super::fluvial::edges::{AXIS, DIAGONAL};
use weald_core::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_engine::Budget;

/// What a level hands down: metres, and the discharge to the east and south in m²/s, so that water goes on as it ran.
#[derive(Clone, Debug)]
pub(crate) struct HandedDown {
    pub(crate) change: Field,
    pub(crate) water: Field,
    pub(crate) sediment: Field,
    pub(crate) discharge: [Field; 2],
    /// How the top of the rock has changed, where the ground is of several materials.
    pub(crate) worn: Option<Field>,
}

impl HandedDown {
    /// The same on cells half as long.
    pub(crate) fn refined(&self) -> Self {
        Self {
            change: refined(&self.change),
            water: refined(&self.water),
            sediment: refined(&self.sediment),
            discharge: self.discharge.each_ref().map(refined),
            worn: self.worn.as_ref().map(refined),
        }
    }
}

/// On how many grids a landscape runs with cells of that many metres: `levels` at most, none with cells longer than
/// `coarsest`.
pub(crate) fn grids(levels: u32, coarsest: f64, cell: f64) -> u32 {
    // A cell of a third of 40 m is not longer than it for the rounding.
    let fits = |level: &u32| cell * f64::from(1 << level) <= coarsest * (1.0 + 1e-9);
    1 + (1..levels).take_while(fits).count() as u32
}

/// Shares of the time that pass on the finest grid and on each between it and the coarsest, which decides where valleys
/// lie and has the rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shares {
    pub(crate) finest: f64,
    pub(crate) between: f64,
}

impl Shares {
    /// Those of floods. What a grid does in its time is its own: the less of it, the more alike are landscapes of 512 and
    /// of 2048 cells. With eighths their heights differed by 0.50 % of the relief, with these by 0.37 %, and relief at 2
    /// to 8 cells was 1 % lower.
    pub(crate) const FLOOD: Self = Self { finest: 0.1, between: 0.03 };

    /// Those of rivers that keep pace with uplift.
    pub(crate) const UPLIFT: Self = Self { finest: 0.125, between: 0.125 };

    /// Share of the time on one of so many levels, counted from the finest, 0.
    pub(crate) fn of(self, level: u32, levels: u32) -> f64 {
        let finer = |level: u32| if level == 0 { self.finest } else { self.between };
        if level + 1 < levels { finer(level) } else { 1.0 - (0..levels - 1).map(finer).sum::<f64>() }
    }
}

/// Passes in which detail wears: enough that what is four cells long vanishes where ground has changed by much more.
const PASSES: usize = 6;

/// Part of the step between neighbours that goes in a pass. Stable up to 3/8.
const MOST_WORN: f64 = 0.3;

/// How the detail that a coarser level does not have has worn while ground changed by so many metres there: wholly where
/// that is much more than the detail is high. For landscapes that rose and were cut for millions of years, of whose start
/// nothing is left.
pub(crate) fn worn_by_change(start: &Field, change: &Field) -> Field {
    worn_detail(start, |x, y| change.at(x, y).abs())
}

/// The same under deposits alone: what floods cut down keeps its detail. Without it bumps of the start would stand anew on
/// fans; without any, smooth slopes of finer cells would be furrowed by rills side by side, along the axes of the grid.
pub(crate) fn worn_by_deposits(start: &Field, change: &Field) -> Field {
    worn_detail(start, |x, y| change.at(x, y).max(0.0))
}

/// How detail has worn where so many metres of change hide it. It spreads along edges, so that no volume is lost.
fn worn_detail(start: &Field, hidden: impl Fn(usize, usize) -> f32) -> Field {
    let Size { columns, rows } = start.size();
    let coarse = mean(start, Size { columns: columns / 2, rows: rows / 2 }, 2);
    let smooth = refined(&coarse);
    let detail = Field::from_function(start.size(), |x, y| start.at(x, y) - smooth.at(x, y));
    let heights: f64 = detail.values().iter().map(|value| f64::from(value.abs())).sum();
    let typical = (heights / start.size().cells() as f64) as f32;
    let share = Field::from_function(start.size(), |x, y| {
        let hidden = hidden(x, y);
        if hidden > 0.0 { hidden / (hidden + typical) } else { 0.0 }
    });
    let worn = (0..PASSES).fold(detail.clone(), |detail, _| spread(&detail, &share));
    Field::from_function(start.size(), |x, y| worn.at(x, y) - detail.at(x, y))
}

/// A pass: each edge takes its weight of the step between its cells, by the mean of their shares.
fn spread(detail: &Field, share: &Field) -> Field {
    let size = detail.size();
    let mut after = detail.clone();
    after.values_mut().par_chunks_mut(size.columns).enumerate().for_each(|(y, row)| {
        for (x, value) in row.iter_mut().enumerate() {
            let [here, own] = [detail.at(x, y), share.at(x, y)].map(f64::from);
            let from = |(east, south, weight): (isize, isize, f32)| {
                let next = x.checked_add_signed(east).zip(y.checked_add_signed(south));
                let next = next.filter(|&(x, y)| x < size.columns && y < size.rows);
                next.map_or(0.0, |(x, y)| {
                    let [there, its] = [detail.at(x, y), share.at(x, y)].map(f64::from);
                    f64::from(weight) * 0.5 * (own + its) * (there - here)
                })
            };
            *value = (here + MOST_WORN * AROUND.into_iter().map(from).sum::<f64>()) as f32;
        }
    });
    after
}

/// Steps to the eight neighbours, and the weights of the edges there.
const AROUND: [(isize, isize, f32); 8] = [
    (1, 0, AXIS),
    (-1, 0, AXIS),
    (0, 1, AXIS),
    (0, -1, AXIS),
    (1, 1, DIAGONAL),
    (-1, -1, DIAGONAL),
    (-1, 1, DIAGONAL),
    (1, -1, DIAGONAL),
];

/// The budget of a level with that of a coarser one before it, whose water it began with.
pub(crate) fn joined(fine: Budget, before: &Budget) -> Budget {
    let Budget { mut water, mut solid } = fine;
    water.incoming += before.water.incoming - before.water.stored;
    water.outgoing += before.water.outgoing;
    solid.outgoing += before.solid.outgoing;
    solid.moved += before.solid.outgoing;
    Budget { water, solid }
}

/// Whether a landscape can be made so many levels coarser.
///
/// # Errors
/// [`Error::Limit`] where its cells do not divide or some hold no data.
pub(crate) fn check(domain: &Domain, levels: u32) -> Result<(), Error> {
    let every = 1_usize << (levels - 1);
    let Size { columns, rows } = domain.size;
    let whole = columns.is_multiple_of(every) && rows.is_multiple_of(every);
    if levels == 1 || (whole && columns > every && rows > every && domain.valid.is_none()) {
        return Ok(());
    }
    let message = if whole && domain.valid.is_some() {
        format!("`levels` is {levels}, but must be 1 where cells hold no data")
    } else {
        format!(
            "`levels` is {levels}, for which the numbers of cells must be multiples of {every}, twice that at least; the \
             landscape has {columns} × {rows}"
        )
    };
    Err(Error::Run(message))
}

/// The landscape with cells so many times as long, of the same materials and with these layers alone.
pub(crate) fn coarsened(
    landscape: &Landscape,
    every: usize,
    layers: &[(String, Field)],
) -> Result<Landscape, Error> {
    let Size { columns, rows } = landscape.domain.size;
    let size = Size::new(columns / every, rows / every)?;
    let domain = Domain::new(size, landscape.domain.cell * every as f64);
    let mut coarse = Landscape::new(Domain { sea_level: landscape.domain.sea_level, ..domain });
    coarse.materials.clone_from(&landscape.materials);
    for (name, field) in layers {
        coarse.insert(name, "m", mean(field, size, every));
    }
    Ok(coarse)
}

fn mean(fine: &Field, size: Size, every: usize) -> Field {
    let share = 1.0 / (every * every) as f64;
    Field::from_function(size, |x, y| {
        let cells = (0..every * every).map(|at| (x * every + at % every, y * every + at / every));
        (cells.map(|(x, y)| f64::from(fine.at(x, y))).sum::<f64>() * share) as f32
    })
}

/// Bilinear between the middles of cells; beyond the edge lies the cell itself.
pub(super) fn refined(coarse: &Field) -> Field {
    let Size { columns, rows } = coarse.size();
    let size = Size { columns: 2 * columns, rows: 2 * rows };
    let beside = |at: usize, cells: usize| {
        let (here, beside) =
            (at / 2, if at.is_multiple_of(2) { (at / 2).wrapping_sub(1) } else { at / 2 + 1 });
        (here, if beside < cells { beside } else { here })
    };
    Field::from_function(size, |x, y| {
        let ((x, next_x), (y, next_y)) = (beside(x, columns), beside(y, rows));
        let along = |y: usize| 0.75 * f64::from(coarse.at(x, y)) + 0.25 * f64::from(coarse.at(next_x, y));
        (0.75 * along(y) + 0.25 * along(next_y)) as f32
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::random::signed2;

    #[test]
    fn what_is_handed_down_keeps_its_volume_and_a_slope_stays_a_slope() {
        let size = Size { columns: 7, rows: 5 };
        let rough = Field::from_function(size, |x, y| signed2(1, x as i64, y as i64) as f32);
        let sum = |field: &Field| field.values().iter().map(|&value| f64::from(value)).sum::<f64>();
        assert!((sum(&refined(&rough)) - 4.0 * sum(&rough)).abs() < 1e-5);
        let slope = refined(&Field::from_function(size, |x, y| (4 * x + 8 * y) as f32));
        for (x, y) in [(3, 3), (4, 7), (10, 6)] {
            assert_eq!(slope.at(x + 1, y) - slope.at(x, y), 2.0);
            assert_eq!(slope.at(x, y + 1) - slope.at(x, y), 4.0);
        }
    }

    #[test]
    fn all_time_passes_and_a_tenth_of_it_at_least_on_the_finest_level() {
        for (kind, levels) in
            [Shares::FLOOD, Shares::UPLIFT].into_iter().flat_map(|kind| (1..=8).map(move |n| (kind, n)))
        {
            let shares: Vec<_> = (0..levels).map(|level| kind.of(level, levels)).collect();
            assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{shares:?}");
            assert!(levels == 1 || shares[0] == kind.finest && kind.finest >= 0.1);
            assert!(shares[1..].iter().all(|share| *share > 0.0), "{shares:?}");
        }
    }

    #[test]
    fn detail_wears_where_ground_has_changed_or_deposits_lie_and_keeps_its_volume() {
        let size = Size { columns: 24, rows: 16 };
        let start = Field::from_function(size, |x, y| 8.0 * signed2(3, x as i64, y as i64) as f32 + x as f32);
        // The west has not changed, the east by much more than the detail is high.
        let east = |change: f32| Field::from_function(size, |x, _| if x < 12 { 0.0 } else { change });
        let [cut, buried] = [-900.0, 900.0].map(east);
        for worn in [worn_by_change(&start, &cut), worn_by_deposits(&start, &buried)] {
            let sum: f64 = worn.values().iter().map(|&value| f64::from(value)).sum();
            assert!(sum.abs() < 1e-4, "{sum} m");
            assert!(
                (0..10).all(|x| (0..16).all(|y| worn.at(x, y) == 0.0)),
                "where nothing changed, nothing wears"
            );
            let rough = |share: f32| -> f64 {
                let at = |x, y| f64::from(start.at(x, y) + share * worn.at(x, y));
                let cells = (15..22).flat_map(|x| (2..13).map(move |y| (x, y)));
                cells.map(|(x, y)| (at(x, y) - at(x, y + 1)).powi(2)).sum()
            };
            assert!(rough(1.0) < 0.3 * rough(0.0), "{} of {}", rough(1.0), rough(0.0));
        }
        assert!(
            worn_by_deposits(&start, &cut).values().iter().all(|&worn| worn == 0.0),
            "what is cut keeps it"
        );
    }
}

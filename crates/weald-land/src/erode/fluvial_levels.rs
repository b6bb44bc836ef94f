//! Coarse first: most of the time of a flood runs on coarser grids, each with cells twice as long, which hand change of
//! the ground, water and sediment down with their volumes.
//!
//! A coarse cell begins as the mean of its fine ones. What it has become goes down by bilinear interpolation between
//! the middles of cells, which gives every coarse cell's volume to fine ones whole: 9, 3, 3 and 1 sixteenths.

use weald_core::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_engine::{Budget, Job, Watcher};

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

/// Share of the time that runs on a level, counted from the finest, 0: an eighth on that, the rest on the others alike.
pub(crate) fn share_of_time(level: u32, levels: u32) -> f64 {
    const FINEST: f64 = 0.125;
    match (levels, level) {
        (1, _) => 1.0,
        (_, 0) => FINEST,
        _ => (1.0 - FINEST) / f64::from(levels - 1),
    }
}

/// The budget of a level with that of a coarser one before it, whose water it began with.
pub(crate) fn joined(fine: Budget, before: &Budget) -> Budget {
    let Budget { mut water, mut solid } = fine;
    water.incoming += before.water.incoming - before.water.stored;
    water.outgoing += before.water.outgoing;
    solid.outgoing += before.solid.outgoing;
    Budget { water, solid }
}

/// Whether a landscape can be made so many levels coarser.
///
/// # Errors
/// [`Error::Limit`] where its cells do not divide or some hold no data.
pub(crate) fn check(landscape: &Landscape, levels: u32) -> Result<(), Error> {
    let every = 1_usize << (levels - 1);
    let Size { columns, rows } = landscape.domain.size;
    let whole = columns.is_multiple_of(every) && rows.is_multiple_of(every);
    if levels == 1 || (whole && columns > every && rows > every && landscape.domain.valid.is_none()) {
        return Ok(());
    }
    let message = if whole && landscape.domain.valid.is_some() {
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
    let mut coarse = Landscape::new(Domain::new(size, landscape.domain.cell * every as f64));
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
fn refined(coarse: &Field) -> Field {
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

/// Hears of a coarse level whether to stop, and nothing else: its states are none of the landscape's.
pub(crate) struct OfCoarse<'a>(pub(crate) &'a dyn Watcher);

impl Watcher for OfCoarse<'_> {
    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}

impl OfCoarse<'_> {
    /// The job of a coarse level.
    pub(crate) fn job<'a>(&'a self, job: &Job<'_>) -> Job<'a> {
        Job { seed: job.seed, engine: job.engine.clone(), watcher: self, resume: None }
    }
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
    fn all_time_passes_and_an_eighth_of_it_on_the_finest_level() {
        for levels in 1..8 {
            let shares: Vec<_> = (0..levels).map(|level| share_of_time(level, levels)).collect();
            assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{shares:?}");
            assert!(levels == 1 || (shares[0] - 0.125).abs() < 1e-12);
            assert!(shares[1..].iter().all(|share| *share > 0.0), "{shares:?}");
        }
    }
}

//! Looks at a flood by the years that have passed, whichever of its grids they pass on.

use super::fluvial_levels::refined;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::material::BEDROCK;
use weald_engine::{Job, SavedSimulation, Watcher};

/// Part of a step that a year may lie behind its end, for rounding.
const ROUNDING: f64 = 1e-6;

/// The years of a level.
#[derive(Clone, Copy, Debug)]
pub(super) struct Years {
    /// Those that have passed on coarser levels.
    pub(super) before: f64,
    /// Years that pass in a step.
    pub(super) a_step: f64,
}

impl Years {
    /// The step after which a year has passed.
    fn step_of(self, year: u64) -> u64 {
        ((year as f64 - self.before) / self.a_step - ROUNDING).ceil().max(0.0) as u64
    }

    /// The first whole year that has passed after so many steps and not before; on finer levels none of those before.
    fn first_after(self, done: u64) -> u64 {
        let least = if self.before > 0.0 { self.before.floor() as u64 + 1 } else { 0 };
        let passed = self.before + (done as f64 - 1.0) * self.a_step;
        let about = passed.max(0.0) as u64;
        // The next one at most, or for rounding the one after it.
        let first = (about..about + 2).find(|&year| self.step_of(year) >= done);
        first.unwrap_or(about + 2).max(least)
    }
}

/// Makes the landscape of what a coarser level sees.
pub(super) type Finer<'a> = &'a (dyn Fn(&Landscape) -> Result<Landscape, Error> + Sync);

/// Passes on what a level does, in years, to whoever wants to see the landscape.
pub(super) struct InYears<'a> {
    pub(super) watcher: &'a dyn Watcher,
    pub(super) years: Years,
    /// On a coarser level.
    pub(super) coarse: Option<Finer<'a>>,
}

impl InYears<'_> {
    /// The job of the level. A coarse one hears whether to stop and shows its landscape; its states are none of the
    /// landscape's, so that it keeps no checkpoints and tells no progress.
    pub(super) fn job<'a>(&'a self, job: &Job<'_>) -> Job<'a> {
        let resume = job.resume.clone().filter(|_| self.coarse.is_none());
        Job { seed: job.seed, engine: job.engine.clone(), watcher: self, resume }
    }
}

impl Watcher for InYears<'_> {
    fn progress(&self, done: u64, total: u64, cells: usize) {
        if self.coarse.is_none() {
            self.watcher.progress(done, total, cells);
        }
    }

    fn cancelled(&self) -> bool {
        self.watcher.cancelled()
    }

    fn checkpoint_due(&self) -> bool {
        self.coarse.is_none() && self.watcher.checkpoint_due()
    }

    fn checkpoint(&self, state: &SavedSimulation) -> Result<(), Error> {
        if self.coarse.is_none() { self.watcher.checkpoint(state) } else { Ok(()) }
    }

    fn next_look(&self, done: u64) -> Option<u64> {
        let year = self.watcher.next_look(self.years.first_after(done))?;
        Some(self.years.step_of(year).max(done))
    }

    fn look(&self, done: u64, landscape: &Landscape) -> Result<(), Error> {
        let finer = self.coarse.map(|finer| finer(landscape)).transpose()?;
        let landscape = finer.as_ref().unwrap_or(landscape);
        let mut next = self.watcher.next_look(self.years.first_after(done));
        let mut is_first = true;
        while let Some(year) = next.filter(|&year| self.years.step_of(year) <= done) {
            // A step of many years is seen as often: who wants it to end need not wait for the last of them.
            if !is_first && self.watcher.cancelled() {
                return Err(Error::Interrupted(format!("interrupted before year {year} was seen")));
            }
            is_first = false;
            self.watcher.look(year, landscape)?;
            next = self.watcher.next_look(year + 1);
        }
        Ok(())
    }
}

/// The landscape of the start as it looks when a coarser one, with cells half as long so many times, has become `coarse`;
/// its heights are those of `layer`.
pub(super) fn as_seen(
    start: &Landscape,
    coarse: &Landscape,
    (layer, times): (&str, u32),
) -> Result<Landscape, Error> {
    let fine = |field: &Field| (0..times).fold(field.clone(), |field, _| refined(&field));
    let mut seen = start.clone();
    let change = |by: &str| coarse.field(by).map(fine);
    let (lost, gained) = (change("erosion")?, change("deposition")?);
    let mut height = start.field(layer)?.clone();
    for ((height, lost), gained) in height.values_mut().iter_mut().zip(lost.values()).zip(gained.values()) {
        *height += gained - lost;
    }
    for (name, found) in coarse.layers().filter(|&(name, _)| name != layer && name != BEDROCK) {
        seen.insert(name, &found.unit, fine(&found.field));
    }
    if coarse.layer(BEDROCK).is_ok() {
        let mut bedrock = height.clone();
        for material in start.materials.iter().skip(1) {
            let thickness = seen.field(&material.name)?.values().to_vec();
            bedrock.values_mut().iter_mut().zip(thickness).for_each(|(rock, above)| *rock -= above);
        }
        seen.insert(BEDROCK, "m", bedrock);
    }
    seen.insert(layer, "m", height);
    Ok(seen)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU64, Ordering};

    use super::*;
    use weald_core::Domain;
    use weald_core::grid::Size;

    /// Looks every year, and wants to end after so many looks.
    struct Impatient(AtomicU64, u64);

    impl Watcher for Impatient {
        fn cancelled(&self) -> bool {
            self.0.load(Ordering::Relaxed) >= self.1
        }

        fn next_look(&self, done: u64) -> Option<u64> {
            Some(done)
        }

        fn look(&self, _: u64, _: &Landscape) -> Result<(), Error> {
            self.0.fetch_add(1, Ordering::Relaxed);
            Ok(())
        }
    }

    #[test]
    fn a_step_of_many_years_is_left_between_two_of_them() {
        let landscape = Landscape::new(Domain::new(Size::square(4).expect("small"), 1.0));
        let years = Years { before: 0.0, a_step: 1000.0 };
        for (patience, seen) in [(3, 3), (1, 1), (5000, 1000)] {
            let watcher = Impatient(AtomicU64::new(0), patience);
            let done = InYears { watcher: &watcher, years, coarse: None }.look(1, &landscape);
            assert_eq!(watcher.0.load(Ordering::Relaxed), seen);
            assert_eq!(matches!(done, Err(Error::Interrupted(_))), patience < 1000, "{done:?}");
        }
    }

    #[test]
    fn every_year_is_seen_once_on_one_of_the_levels() {
        // 700 years in 93 steps and 100 years in 7; 0.3 steps a year and less.
        let levels = [
            (Years { before: 0.0, a_step: 700.0 / 93.0 }, 93),
            (Years { before: 700.0, a_step: 100.0 / 7.0 }, 7),
        ];
        let mut seen = Vec::new();
        for (years, steps) in levels {
            for done in 0..=steps {
                let first = years.first_after(done);
                seen.extend((first..=800).take_while(|&year| years.step_of(year) == done));
            }
        }
        assert_eq!(seen, (0..=800).collect::<Vec<_>>());
    }

    #[test]
    fn years_longer_than_steps_are_seen_after_the_step_in_which_they_end() {
        let years = Years { before: 0.0, a_step: 0.25 };
        assert_eq!((0..4).map(|year| years.step_of(year)).collect::<Vec<_>>(), [0, 4, 8, 12]);
        assert_eq!([0, 1, 4, 5].map(|done| years.first_after(done)), [0, 1, 1, 2]);
    }
}

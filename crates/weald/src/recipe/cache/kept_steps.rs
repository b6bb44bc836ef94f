//! The steps of one run, with what earlier runs have left of them.

use std::sync::Arc;

use web_time::Instant;

use super::Cache;
use super::follows::Follows;
use super::kept::Kept;
use crate::recipe::memory;
use crate::recipe::plan::{Planned, Recipe};
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_engine::report::StepReport;
use weald_engine::{Engine, WENT_ON_ON_CPU};
use weald_plants::Vegetation;
use weald_plants::grass::Meadow;

/// The steps of a run, one after the other.
#[derive(Clone, Debug)]
pub(in crate::recipe) struct KeptSteps {
    cache: Arc<Cache>,
    follows: Follows,
    /// Whether it was told that results cannot be kept.
    is_told: bool,
}

impl KeptSteps {
    /// For a run on an engine that begins with a landscape.
    ///
    /// # Errors
    /// [`Error::Input`] for a file that the recipe names and that cannot be read.
    pub(in crate::recipe) fn new(
        cache: &Arc<Cache>,
        recipe: &Recipe,
        (landscape, engine): (&Landscape, &Engine),
    ) -> Result<Self, Error> {
        let follows = Follows::start(recipe, landscape, engine)?;
        Ok(Self { cache: Arc::clone(cache), follows, is_told: false })
    }

    /// Gives a landscape what a step would make of it, where that was kept. A file that cannot be read is told by the step.
    pub(in crate::recipe) fn fetch(
        &mut self,
        (recipe, planned): (&Recipe, &Planned),
        landscape: &mut Landscape,
    ) -> Option<StepReport> {
        let started = Instant::now();
        let text = self.follows.text(recipe, planned, landscape).ok()?;
        let Kept { changed, whole, report } = self.cache.get(&text)?;
        let before = landscape.clone();
        if whole {
            let mut next = Landscape::new(changed.domain.clone());
            next.materials = std::mem::take(&mut landscape.materials);
            next.attach_all_of(landscape);
            next.detach_all::<Meadow>();
            *landscape = next;
        }
        for (name, _) in changed.layers() {
            landscape.share_layer(&changed, name);
        }
        for (name, plants) in changed.all_plants() {
            landscape.plant(name, Arc::clone(plants));
        }
        for (name, meadow) in changed.all_meadows() {
            landscape.sow(name, meadow);
        }
        self.follows.follow(&text, [&before, landscape]);
        let seconds = started.elapsed().as_secs_f64();
        Some(StepReport { cached: true, seconds, peak_memory: memory::taken(), ..report })
    }

    /// Keeps what a step has made of a landscape, if it is worth it. What cannot be kept is told, and the run goes on.
    pub(in crate::recipe) fn keep(
        &mut self,
        (recipe, planned): (&Recipe, &Planned),
        (before, after): (&Landscape, &Landscape),
        report: &StepReport,
        note: &dyn Fn(&str),
    ) {
        let Ok(text) = self.follows.text(recipe, planned, before) else { return };
        self.follows.follow(&text, [before, after]);
        let kept = Kept {
            changed: changed(before, after),
            whole: before.domain != after.domain,
            report: report.clone(),
        };
        let partly_cpu = report.notes.iter().any(|note| note.contains(WENT_ON_ON_CPU));
        if partly_cpu || !self.cache.is_worth(&kept) {
            return;
        }
        if let Err(error) = self.cache.put(&text, &kept)
            && !std::mem::replace(&mut self.is_told, true)
        {
            note(&format!("results of steps are not kept for later runs: {error}"));
        }
    }

    /// Says that a step was held, and what was done to it.
    pub(in crate::recipe) fn held(
        &mut self,
        planned: &Planned,
        (before, after): (&Landscape, &Landscape),
        script: &str,
    ) {
        let text = format!("held {}\n{script}", planned.entry.name);
        self.follows.hold(&text, [before, after]);
    }
}

/// What differs between two landscapes; all of the second where its grid is another.
fn changed(before: &Landscape, after: &Landscape) -> Landscape {
    let other_grid = before.domain != after.domain;
    let mut changed = Landscape::new(after.domain.clone());
    for (name, _) in after.layers() {
        if other_grid || !after.shares_layer(before, name) {
            changed.share_layer(after, name);
        }
    }
    for (name, plants) in after.all_plants() {
        let is_same = before.plants(name).is_ok_and(|before| Arc::ptr_eq(before, plants));
        if other_grid || !is_same {
            changed.plant(name, Arc::clone(plants));
        }
    }
    for (name, meadow) in after.all_meadows() {
        let is_same = before.meadow(name).is_ok_and(|before| Arc::ptr_eq(&before, &meadow));
        if other_grid || !is_same {
            changed.sow(name, meadow);
        }
    }
    changed
}

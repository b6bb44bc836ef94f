//! Runs a process for many steps: progress, interruption, checkpoints, the watch for NaN, mean fluxes.

use std::sync::Arc;

use web_time::Instant;

use super::edits::Before;
use super::finished::Finished;
use super::look::{self, Seen};
use super::over_ranks::{self, Beginning};
use super::pace::Pace;
use super::painted_mask::PaintedMask;
use super::saved::Saved;
use super::scripted::{Edits, Numbers};
use crate::edit::{Change, Setting};
use weald_core::error::{Error, NotFinite};
use weald_engine::machine::{Machine, Means, Snapshot};
use weald_engine::machine_of_engine;
use weald_engine::patch::{Patch, Patched};
use weald_engine::ranks::Ranks;
use weald_engine::stencil::chain::Process;
use weald_engine::stencil::rows::Rows;
use weald_engine::{Engine, Job, SavedSimulation, WENT_ON_ON_CPU};

/// Steps after which the state is kept anew. On large grids a look comes every few steps, and a copy of all planes with
/// each would take as long as they do; who goes back takes as many steps again to find the fault.
const KEPT_EVERY: u64 = 32;

/// A process and how long it runs.
pub(crate) struct Simulation<'a, P: Process> {
    pub(crate) numbers: &'a Numbers<P>,
    /// Names of the state planes, for checkpoints and errors.
    pub(crate) plane_names: &'a [String],
    /// Iterations to run.
    pub(crate) iterations: u64,
    /// Fluxes to average, and over which steps.
    pub(crate) record: Option<Record>,
    /// What a person changes between the steps.
    pub(crate) edits: Option<&'a Edits<P>>,
    /// What its states look like, where it can be looked at.
    pub(crate) seen: Option<Seen<'a>>,
}

/// A wish for mean values.
pub(crate) struct Record {
    /// Steps over which to average.
    pub(crate) steps: std::ops::Range<u64>,
    /// Parts of each mean.
    pub(crate) means: Means<'static>,
}

impl<P: Process> Simulation<'_, P> {
    /// Runs from its beginning, or from where `job` resumes. Where the engine is a device that may be replaced, a
    /// failure of it is followed by the CPU from the last state that came back. Over ranks the end is with the first
    /// alone.
    pub(super) fn run(&self, beginning: Beginning<'_>, job: &Job<'_>) -> Result<Option<Finished>, Error> {
        match beginning {
            Beginning::With(start) => self.lead(start, job).map(Some),
            Beginning::Led(ranks) => self.follow(ranks).map(|()| None),
        }
    }

    /// Does what the first rank says, to the end of the simulation.
    fn follow(&self, ranks: &Arc<dyn Ranks>) -> Result<(), Error> {
        let done = over_ranks::learn(&**ranks)?;
        let mut settings = self.edits.map(|edits| edits.settings_before(done)).unwrap_or_default();
        let mut later = self.edits.map(|edits| edits.settings_from(done)).unwrap_or_default().into_iter();
        let mut has_begun = false;
        weald_engine::ranks::follow(self.means(), ranks, &mut || {
            if has_begun {
                settings.extend(later.next());
            }
            has_begun = true;
            Ok(self.numbers_after(&settings)?.process)
        })
    }

    fn lead(&self, start: Rows, job: &Job<'_>) -> Result<Finished, Error> {
        let start = Snapshot::start(start, self.means().len());
        let first = Saved { done: 0, snapshot: start };
        let mut first = match &job.resume {
            Some(saved) => first.resumed(saved, self.plane_names)?,
            None => first,
        };
        if let (Some(edits), 1..) = (self.edits, first.done) {
            edits.catch_up(first.done, &mut first.snapshot)?;
        }
        let mut finished = self.run_from(first, job)?;
        finished.notes.extend(self.edits.iter().flat_map(|edits| edits.notes(self.iterations)));
        Ok(finished)
    }

    fn run_from(&self, first: Saved, job: &Job<'_>) -> Result<Finished, Error> {
        let mut last = matches!(job.engine, Engine::DeviceElseCpu(_)).then(|| first.clone());
        match (self.run_on(&job.engine, first, job, last.as_mut()), last) {
            (Err(Error::Device(what)), Some(last)) => {
                let note = format!("{what}; {WENT_ON_ON_CPU} after {} iterations", last.done);
                let mut finished = self.run_on(&Engine::Cpu, last, job, None)?;
                finished.notes.push(note);
                Ok(finished)
            }
            (result, _) => result,
        }
    }

    /// Runs on one engine; `last` becomes the last state that was taken from it.
    fn run_on(
        &self,
        engine: &Engine,
        from: Saved,
        job: &Job<'_>,
        last: Option<&mut Saved>,
    ) -> Result<Finished, Error> {
        let mut running = Running::new(self, engine, &from, job, last)?;
        // The machine has taken its own copy, and states are large.
        drop(from);
        while running.done < self.iterations {
            running.look()?;
            running.edit()?;
            running.stretch()?;
            job.watcher.progress(running.done, self.iterations, running.cells);
            running.stop_or_checkpoint()?;
        }
        // What happens after the last step happens as well, before anybody looks.
        running.edit()?;
        running.look()?;
        running.finish()
    }

    fn means(&self) -> Means<'static> {
        self.record.as_ref().map_or(&[], |record| record.means)
    }

    /// What the keys say after some were set.
    fn numbers_after(&self, settings: &[Setting]) -> Result<Numbers<P>, Error> {
        match self.edits {
            Some(edits) => edits.numbers(settings, self.numbers),
            None => Ok(self.numbers.clone()),
        }
    }
}

struct Running<'a, P: Process> {
    simulation: &'a Simulation<'a, P>,
    job: &'a Job<'a>,
    machine: Box<dyn Machine<P>>,
    /// What the keys say now.
    numbers: Numbers<P>,
    settings: Vec<Setting>,
    mask: PaintedMask,
    pace: Pace,
    done: u64,
    cells: usize,
    /// Steps when the state was kept, which was well.
    good: u64,
    last: Option<&'a mut Saved>,
    /// Steps after which the edits came that were the last, and what they painted over.
    unedited: Option<(u64, Vec<Patch>)>,
}

impl<'a, P: Process> Running<'a, P> {
    fn new(
        simulation: &'a Simulation<'a, P>,
        engine: &Engine,
        from: &Saved,
        job: &'a Job<'a>,
        last: Option<&'a mut Saved>,
    ) -> Result<Self, Error> {
        let state = &from.snapshot.state;
        if let Some([x, y, plane]) = state.first_not_finite(simulation.numbers.process.state_planes()) {
            let name = &simulation.plane_names[plane];
            let message = format!(
                "the simulation starts with a value of `{name}` at column {x}, row {y} that is no number"
            );
            let layer = name.clone();
            return Err(
                NotFinite { step: None, iteration: Some(from.done), layer, cell: [x, y], message }.into()
            );
        }
        let cells = from.snapshot.size().cells();
        let settings = simulation.edits.map(|edits| edits.settings_before(from.done)).unwrap_or_default();
        let numbers = simulation.numbers_after(&settings)?;
        let mask =
            simulation.edits.map(|edits| edits.mask_before(from.done)).transpose()?.unwrap_or_default();
        over_ranks::announce(engine, from.done)?;
        let machine = machine_of_engine::start(&numbers.process, simulation.means(), &from.snapshot, engine)?;
        let pace = Pace::new(engine, cells, machine.block());
        Ok(Self {
            simulation,
            job,
            machine,
            numbers,
            settings,
            mask,
            pace,
            done: from.done,
            cells,
            good: from.done,
            last,
            unedited: None,
        })
    }

    /// Shows the state to whoever wants to see it here.
    fn look(&mut self) -> Result<(), Error> {
        let means = self.simulation.means();
        let finished = || Ok(Finished::of_moment(self.machine.snapshot()?, means));
        look::show(self.job.watcher, self.done, finished, self.simulation.seen)
    }

    /// The edits that happen here. Every state that is kept at their step is the one before them.
    fn edit(&mut self) -> Result<(), Error> {
        let Some(edits) = self.simulation.edits.filter(|edits| edits.next_from(self.done) == Some(self.done))
        else {
            return Ok(());
        };
        let mut before = Vec::new();
        for edit in edits.script.before(self.done) {
            match &edit.change {
                Change::Stroke(brush) => {
                    let painted = edits.place()?.stroke(brush, &mut *self.machine, &mut self.mask)?;
                    if let Before::State(patch) = painted {
                        before.push(patch);
                    }
                }
                Change::Set(setting) => {
                    self.settings.push(setting.clone());
                    self.numbers = (edits.remake)(&self.settings)?;
                    self.machine.follow(&self.numbers.process)?;
                }
            }
        }
        self.unedited = Some((self.done, before));
        self.keep()
    }

    /// One stretch of steps, and a look at the result.
    fn stretch(&mut self) -> Result<(), Error> {
        let end = (self.done + self.pace.steps()).min(self.simulation.iterations);
        let next = self.simulation.edits.and_then(|edits| edits.next_from(self.done + 1));
        let look = self.simulation.seen.and_then(|_| self.job.watcher.next_look(self.done + 1));
        let end = next.into_iter().chain(look).fold(end, u64::min);
        let begun = Instant::now();
        self.advance_to(end)?;
        if self.machine.first_not_finite()?.is_some() {
            return Err(self.find_the_fault(end)?);
        }
        self.pace.took(begun.elapsed());
        if self.done - self.good >= KEPT_EVERY { self.keep() } else { Ok(()) }
    }

    /// Keeps the state, to go back to when something goes wrong later.
    fn keep(&mut self) -> Result<(), Error> {
        self.good = self.done;
        self.machine.keep()
    }

    /// Steps within the record, and those before and after it, are given to the machine apart.
    fn advance_to(&mut self, end: u64) -> Result<(), Error> {
        let record = self.simulation.record.as_ref().map_or(end..end, |record| record.steps.clone());
        while self.done < end {
            let recorded = record.contains(&self.done);
            let border = if recorded { record.end } else { record.start };
            let stop = if border > self.done { end.min(border) } else { end };
            let weather: Vec<_> = (self.done..stop).map(|step| (self.numbers.weather)(step)).collect();
            self.machine.advance(&weather, recorded)?;
            self.done = stop;
        }
        Ok(())
    }

    /// Goes back to the last good state, steps one by one to the fault, and keeps the state before it.
    fn find_the_fault(&mut self, end: u64) -> Result<Error, Error> {
        self.machine.go_back()?;
        self.done = self.good;
        while self.done < end {
            let before = self.unedited()?;
            self.advance_to(self.done + 1)?;
            let Some([x, y, plane]) = self.machine.first_not_finite()? else { continue };
            let name = &self.simulation.plane_names[plane];
            let kept = match self.job.watcher.checkpoint(&before) {
                Ok(()) => "the last good state was kept".to_owned(),
                Err(error) => format!("the last good state could not be kept: {error}"),
            };
            let iteration = self.done;
            let message = format!(
                "iteration {iteration}: `{name}` at column {x}, row {y} is no longer a finite number; {kept}; a lower \
                 `flow_rate` or `erosion`, or `limiter = true`, makes the scheme stable"
            );
            let (iteration, layer) = (Some(iteration), name.clone());
            return Ok(NotFinite { step: None, iteration, layer, cell: [x, y], message }.into());
        }
        Ok(Error::Run(format!(
            "a value that is not finite appeared before iteration {end} and did not appear again"
        )))
    }

    /// The state as it was before the edits that happen at its step.
    fn unedited(&mut self) -> Result<SavedSimulation, Error> {
        let Some((_, patches)) = self.unedited.as_ref().filter(|(done, _)| *done == self.done) else {
            return self.saved();
        };
        let mut snapshot = self.machine.snapshot()?;
        patches.iter().rev().try_for_each(|patch| snapshot.lay(patch))?;
        Ok(Saved { done: self.done, snapshot }.named(self.simulation.plane_names))
    }

    /// Ends when the user wants it, and keeps a checkpoint then and when one is due.
    fn stop_or_checkpoint(&mut self) -> Result<(), Error> {
        let watcher = self.job.watcher;
        let stop = watcher.cancelled() && self.done < self.simulation.iterations;
        if stop || watcher.checkpoint_due() {
            let saved = self.saved()?;
            watcher.checkpoint(&saved)?;
        }
        if stop {
            let all = self.simulation.iterations;
            return Err(Error::Interrupted(format!("interrupted after {} of {all} steps", self.done)));
        }
        Ok(())
    }

    fn saved(&mut self) -> Result<SavedSimulation, Error> {
        let saved = Saved { done: self.done, snapshot: self.machine.snapshot()? };
        let named = saved.named(self.simulation.plane_names);
        if let Some(last) = &mut self.last {
            **last = saved;
        }
        Ok(named)
    }

    fn finish(mut self) -> Result<Finished, Error> {
        let steps = self.simulation.record.as_ref().map_or(1, |record| record.steps.end - record.steps.start);
        let scale = 1.0 / steps.max(1) as f32;
        let Snapshot { state, row_sums, mut means } = self.machine.snapshot()?;
        means.iter_mut().flatten().for_each(|sum| *sum *= scale);
        Ok(Finished {
            state,
            sums: look::total(&row_sums),
            means,
            notes: self.machine.note().into_iter().collect(),
        })
    }
}

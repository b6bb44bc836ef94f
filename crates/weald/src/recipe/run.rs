//! Runs a checked recipe: ground, steps, files, report.

mod explained;
mod film;
pub(super) mod finished;
mod folder;
mod ground_in_parts;
mod in_parts;
pub(super) mod inputs;
mod kept_parts;
mod options;
mod outputs;
mod outputs_in_parts;
mod step_watcher;
#[cfg(test)]
mod tests;
mod video;
mod work;
mod writer;

pub use inputs::Outlook;
pub use options::{Options, Progress, Run, Silent};
use std::path::PathBuf;

use web_time::Instant;

use super::cache::KeptSteps;
use super::checkpoint::{self, CHECKPOINT_FILE, State};
use super::ground;
use super::over_ranks;
use super::plan::{Output, Planned, Recipe};
use super::report::{OutputReport, REPORT_FILE, Report};
use super::timings::Timings;
use crate::written;
use film::TimeLapses;
use finished::step_report;
use step_watcher::{CheckpointTimer, StepWatcher};
pub use video::Frames;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::files;
use weald_core::landscape::Landscape;
use weald_engine::Job;
use weald_plants::Vegetation;
use work::{Leaves, WorkFolder, new_files, remove_checkpoint};

impl Recipe {
    /// Runs the steps in memory on the current rayon pool and gives the landscape; no file is written and no
    /// checkpoint kept.
    ///
    /// # Errors
    /// [`Error::Input`] for a damaged elevation model, [`Error::Run`] where a step fails.
    pub fn landscape(&self) -> Result<Landscape, Error> {
        let (mut landscape, _) = ground::load(self)?;
        for planned in &self.steps {
            planned.step.run(&mut landscape, &Job::unwatched(planned.seed(self.seed)))?;
            written::finish(planned.step.as_ref(), &mut landscape)?;
        }
        Ok(landscape)
    }
}

impl Run<'_> {
    /// Runs the recipe and writes its files, the report last if it is wanted. Of [distributed](Options::distributed) ranks
    /// all call it: the first writes, and each gets the report.
    ///
    /// # Errors
    /// [`Error::Input`] for a damaged elevation model or checkpoint, [`Error::Run`] where a step or a file
    /// fails, [`Error::Interrupted`] where `progress` says so; the last two name the checkpoint, if any.
    pub fn execute(&self, progress: &dyn Progress) -> Result<Report, Error> {
        if self.options.distributed {
            return self.execute_on_threads(progress);
        }
        over_ranks::leading(&self.options.engine, || self.execute_on_threads(progress))
    }

    fn execute_on_threads(&self, progress: &dyn Progress) -> Result<Report, Error> {
        self.recipe.outputs.iter().try_for_each(|output| self.check_drawing(output))?;
        // Where no number is asked for, the threads that there are do it: a browser has one, and can start no others.
        let Some(threads) = self.options.threads.filter(|&threads| threads > 0) else {
            return self.execute_here(progress);
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|cause| Error::Run(format!("cannot start {threads} threads: {cause}")))?;
        pool.install(|| self.execute_here(progress))
    }

    /// Runs the steps on the current rayon pool and gives the landscape in place of files. Checkpoints are kept in the
    /// folder as [`Run::execute`] keeps them.
    ///
    /// # Errors
    /// As [`Run::execute`].
    pub fn landscape(&self, progress: &dyn Progress) -> Result<Landscape, Error> {
        over_ranks::leading(&self.options.engine, || {
            let place = self.prepare(progress)?;
            let (state, _) = self.finish_steps(progress)?;
            remove_checkpoint(&self.checkpoint())?;
            drop(place);
            Ok(state.landscape)
        })
    }

    /// What cannot be drawn is reported before an hour of simulation.
    fn check_drawing(&self, output: &Output) -> Result<(), Error> {
        match (output.render(), &self.options.render) {
            (None, _) => Ok(()),
            (Some(render), Some(device)) => render.check(device.as_ref()),
            (Some(_), None) => Err(Error::Run(format!(
                "{} is a picture of kind `render`, which needs a device that draws; none was given to this run",
                output.file.display()
            ))),
        }
    }

    fn execute_here(&self, progress: &dyn Progress) -> Result<Report, Error> {
        if self.options.out_of_core.is_some() || self.options.distributed {
            return self.execute_in_parts(progress);
        }
        let mut place = self.prepare(progress)?;
        if self.options.resume && place.has_finished_this() {
            place.leaves = Leaves::Nothing;
            return Report::read(&self.options.out.join(REPORT_FILE));
        }
        let done = self.finish_steps(progress);
        let done = done.and_then(|(state, first)| Ok((self.write(state, progress)?, first)));
        // The frames of a time-lapse go with the checkpoint from which the run goes on.
        if done.is_err()
            && self.recipe.outputs.iter().any(Output::lapses)
            && files::exists(&self.checkpoint())
        {
            place.leaves = Leaves::Frames;
        }
        let (report, first) = done?;
        let files = report.outputs.iter().flat_map(OutputReport::files).collect();
        place.publish(files)?;
        place.leaves = Leaves::Nothing;
        self.keep_timings(&report, &first, progress);
        Ok(report)
    }

    /// Leaves what the run took for estimates of later ones. A run that went on from a checkpoint has the times of a part.
    fn keep_timings(&self, report: &Report, first: &Domain, progress: &dyn Progress) {
        let Some(folder) = self.options.timings.as_ref().filter(|_| !self.options.resume) else { return };
        let timings = self.recipe.timings(first, report, rayon::current_num_threads(), &self.options.out);
        if let Err(error) = Timings::keep(folder, timings) {
            progress.note(&format!("times of this run are not kept for estimates: {error}"));
        }
    }

    fn prepare(&self, progress: &dyn Progress) -> Result<WorkFolder, Error> {
        let (place, notes) = folder::prepare(self.recipe, &self.options.out)?;
        for note in &notes {
            progress.note(note);
        }
        Ok(place)
    }

    /// Runs all steps that are left; gives what they made, and the grid that this run began on.
    fn finish_steps(&self, progress: &dyn Progress) -> Result<(State, Domain), Error> {
        let mut state = self.start(progress)?;
        let first = state.landscape.domain.clone();
        let mut kept = self.kept_steps(&state)?;
        let clock = CheckpointTimer::start(self.options.checkpoint_every);
        while let Some(planned) = self.recipe.steps.get(state.done) {
            self.stop_if_cancelled(&state, progress)?;
            progress.step(state.done + 1, self.recipe.steps.len(), planned.entry.name);
            if !self.fetch(planned, &mut state, kept.as_mut(), progress) {
                self.advance(planned, &mut state, (progress, &clock), kept.as_mut())?;
            }
            self.keep_if_due(&state, &clock, progress)?;
        }
        progress.made(&state.landscape, &state.steps);
        Ok((state, first))
    }

    fn checkpoint(&self) -> PathBuf {
        self.options.out.join(CHECKPOINT_FILE)
    }

    fn start(&self, progress: &dyn Progress) -> Result<State, Error> {
        let path = self.checkpoint();
        if self.options.resume {
            let allowed = self.options.memory;
            let accept = |head: &checkpoint::Head| self.recipe.ensure_memory_after(head, allowed);
            let mut state = checkpoint::read_if(&path, self.recipe.effective(), accept)?;
            state.landscape.materials = ground::materials(self.recipe);
            state.landscape.set_fractals(ground::fractals(self.recipe)?);
            TimeLapses::during(self.recipe, state.done, &self.options).ensure_drawn(&state, &path)?;
            let done = state.simulation.as_ref().map_or(0, |simulation| simulation.iteration);
            progress.note(&format!("going on after {} steps and {done} iterations", state.done));
            return Ok(state);
        }
        if files::exists(&path) {
            let path = path.display();
            progress.note(&format!("starting anew; the checkpoint {path} is used with --resume only"));
        }
        let (landscape, notes) = inputs::start(self.recipe, self.options.memory)?;
        for note in &notes {
            progress.note(note);
        }
        Ok(State { landscape, done: 0, simulation: None, steps: Vec::new(), notes })
    }

    /// Between two steps, for those that keep no checkpoints of their own.
    fn keep_if_due(
        &self,
        state: &State,
        clock: &CheckpointTimer,
        progress: &dyn Progress,
    ) -> Result<(), Error> {
        if clock.is_due() {
            let written = checkpoint::write(&self.checkpoint(), self.recipe.effective(), state, None);
            step_watcher::note_failure(written, progress)?;
            clock.restart();
        }
        Ok(())
    }

    fn stop_if_cancelled(&self, state: &State, progress: &dyn Progress) -> Result<(), Error> {
        if progress.cancelled() { Err(self.stopped(state)) } else { Ok(()) }
    }

    /// Keeps what there is, and says how to go on.
    fn stopped(&self, state: &State) -> Error {
        if self.recipe.steps.is_empty() {
            return Error::Interrupted("interrupted; every file that is there is whole".to_owned());
        }
        let (path, recipe) = (self.checkpoint(), self.recipe.effective());
        match checkpoint::write(&path, recipe, state, state.simulation.as_ref()) {
            Err(error) => error,
            Ok(()) => self.interrupted(&format!("after {} of {} steps", state.done, self.recipe.steps.len())),
        }
    }

    /// Runs one step on a copy of the landscape, so that a checkpoint can hold what the step began with.
    fn advance(
        &self,
        planned: &Planned,
        state: &mut State,
        (progress, clock): (&dyn Progress, &CheckpointTimer),
        kept: Option<&mut KeptSteps>,
    ) -> Result<(), Error> {
        let resume = state.simulation.take();
        let resumed_at = resume.as_ref().map(|simulation| simulation.iteration);
        let mut landscape = state.landscape.clone();
        let started = Instant::now();
        let desk = StepWatcher::new(self, state, progress, clock);
        let seed = planned.seed(self.recipe.seed);
        let engine = over_ranks::engine_of(planned, &self.options.engine);
        let job = Job { seed, engine, watcher: &desk, resume };
        let result = over_ranks::with_others(&job.engine, (state.done, planned), &state.landscape, || {
            planned.step.run(&mut landscape, &job)
        });
        drop(job);
        let result = result.and_then(|outcome| {
            written::finish(planned.step.as_ref(), &mut landscape)?;
            Ok(outcome)
        });
        let outcome = result.map_err(|error| self.explain(error, planned, &desk, resumed_at))?;
        for note in &outcome.notes {
            progress.note(note);
        }
        let seconds = started.elapsed().as_secs_f64();
        let report = step_report(planned, landscape.domain.size.cells(), outcome, seconds, resumed_at);
        if let Some(kept) = kept {
            kept.keep((self.recipe, planned), (&state.landscape, &landscape), &report, &|note| {
                progress.note(note);
            });
        }
        state.steps.push(report);
        state.landscape = landscape;
        state.done += 1;
        Ok(())
    }

    /// What earlier runs have left of the steps to come. One that goes on from a checkpoint does not know what its layers
    /// follow from.
    fn kept_steps(&self, state: &State) -> Result<Option<KeptSteps>, Error> {
        match &self.options.cache {
            Some(cache) if !self.options.resume => {
                KeptSteps::new(cache, self.recipe, (&state.landscape, &self.options.engine)).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// Takes the result of the next step from an earlier run, where there is one. A film needs to see the step run.
    fn fetch(
        &self,
        planned: &Planned,
        state: &mut State,
        kept: Option<&mut KeptSteps>,
        progress: &dyn Progress,
    ) -> bool {
        let is_filmed = planned.step.watched() > 0 && self.recipe.outputs.iter().any(Output::lapses);
        let Some(kept) = kept.filter(|_| !is_filmed) else { return false };
        let Some(report) = kept.fetch((self.recipe, planned), &mut state.landscape) else { return false };
        progress.note(&format!(
            "step {} (`{}`): kept from an earlier run",
            state.done + 1,
            planned.entry.name
        ));
        state.steps.push(report);
        state.done += 1;
        true
    }

    /// Makes all outputs, and the report when they are whole. Where that fails, the landscape is kept.
    fn write(&self, state: State, progress: &dyn Progress) -> Result<Report, Error> {
        let hash = self.recipe.hash();
        let outputs = self.outputs(&state, &hash, progress);
        let outputs = outputs.map_err(|error| self.with_landscape_kept(self.by_its_name(error), &state))?;
        let State { steps, notes, .. } = state;
        let report = Report {
            engine: self.options.engine.name().to_owned(),
            adapter: self.options.engine.adapter(),
            seed: self.recipe.seed,
            recipe_blake3: hash,
            version: env!("CARGO_PKG_VERSION").to_owned(),
            steps,
            outputs,
            notes,
        };
        if self.options.report {
            report
                .write(&new_files(&self.options.out, self.recipe).join(REPORT_FILE))
                .map_err(|error| self.by_its_name(error))?;
        }
        Ok(report)
    }

    /// An error of a file by the name that the file was to have.
    fn by_its_name(&self, error: Error) -> Error {
        let folder = new_files(&self.options.out, self.recipe).display().to_string();
        match error {
            Error::Run(what) => Error::Run(what.replace(&folder, &self.options.out.display().to_string())),
            other => other,
        }
    }

    /// Keeps what the steps made when a file cannot be written, so that the run can go on when there is room again.
    fn with_landscape_kept(&self, error: Error, state: &State) -> Error {
        let Error::Run(what) = error else { return error };
        if self.recipe.steps.is_empty() {
            return Error::Run(what);
        }
        let path = self.checkpoint();
        let keep = || checkpoint::write(&path, self.recipe.effective(), state, None);
        match keep().or_else(|_| self.make_room().and_then(|()| keep())) {
            Ok(()) => Error::Run(format!(
                "{what}; no file has changed, and the same command with --resume goes on from {}",
                path.display()
            )),
            Err(_) => Error::Run(format!("{what}; no file has changed, nor was there room for a checkpoint")),
        }
    }

    /// Removes the files that were made until now, but for the frames with which a run goes on.
    fn make_room(&self) -> Result<(), Error> {
        let made = new_files(&self.options.out, self.recipe);
        if self.recipe.outputs.iter().any(Output::lapses) {
            return Ok(());
        }
        files::remove_dir_all(&made).map_err(|cause| Error::write(&made, &cause))
    }
}

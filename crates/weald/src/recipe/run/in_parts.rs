//! A run whose landscape no process holds as a whole: its layers lie on disk, or each rank has its own rows of them. It gives
//! the files of a run in memory, to the byte.
//!
//! Over ranks all run the same program, each on its own rows, and an error of one is one of all. The first writes the files.

use std::path::PathBuf;
use std::sync::Arc;

use web_time::Instant;

use super::finished::step_report;
use super::kept_parts::PartsWatcher;
use super::options::{Progress, Run};
use super::step_watcher::CheckpointTimer;
use super::work::{Leaves, WorkFolder, new_files};
use crate::recipe::memory;
use crate::recipe::plan::Planned;
use crate::recipe::report::{OutputReport, REPORT_FILE, Report};
use weald_core::domain::Domain;
use weald_core::error::{Error, Limit, Quantity};
use weald_core::files::File;
use weald_engine::ranks::{Alone, Ranks, SharedRows, agreed, any, greatest, least};
use weald_engine::report::StepReport;
use weald_engine::stored::{Scratch, StoredLandscape};
use weald_engine::{Engine, Job};

/// What the program, its threads and the buffers of files take beside the steps.
const BESIDE: u64 = 64 << 20;

/// The part of the rest that steps count on. Allocators keep some of what one band or tile gave back from the next: peaks
/// were up to an eighth above what steps count.
const COUNTED: u64 = 4;
const OF: u64 = 5;

/// A folder in which files are made that have no name: the system takes them away when the process ends, however it ends.
/// Without one planes lie in memory.
#[derive(Debug)]
struct ScratchFolder(Option<PathBuf>);

impl Scratch for ScratchFolder {
    #[cfg(not(target_arch = "wasm32"))]
    fn file(&self) -> Result<Option<File>, Error> {
        let made =
            |folder: &PathBuf| tempfile::tempfile_in(folder).map_err(|cause| Error::write(folder, &cause));
        self.0.as_ref().map(made).transpose()
    }

    #[cfg(target_arch = "wasm32")]
    fn file(&self) -> Result<Option<File>, Error> {
        match self.0 {
            Some(_) => Err(Error::Run("a browser has no disk to run from".to_owned())),
            None => Ok(None),
        }
    }
}

impl Run<'_> {
    /// Runs the recipe with its layers in a scratch folder, or with those of its own rows.
    pub(super) fn execute_in_parts(&self, progress: &dyn Progress) -> Result<Report, Error> {
        let ranks = self.sharing()?;
        let (domain, file) = agreed(&*ranks, self.recipe.start_on_disk())?;
        self.ensure_neighbours_suffice(&domain, &*ranks)?;
        let (size, bytes) = (domain.size, self.recipe.scratch_on(domain.size));
        let scratch = ScratchFolder(self.options.out_of_core.clone());
        let memory = self.memory_of_steps(bytes.div_ceil(size.rows as u64), (size.rows, &*ranks))?;
        let mut place = self.place(&*ranks, progress)?;
        let finished = place.as_ref().is_some_and(WorkFolder::has_finished_this);
        if self.options.resume && any(&*ranks, finished)? {
            return self.finished_before(&mut place, &*ranks);
        }
        let mut landscape = StoredLandscape::new(domain, memory, (&scratch, Arc::clone(&ranks)));
        let mut so_far = self.start_in_parts(&mut landscape, file.as_ref(), progress)?;
        let clock = CheckpointTimer::start(self.options.checkpoint_every);
        while let Some(planned) = self.recipe.steps.get(so_far.done()) {
            progress.step(so_far.done() + 1, self.recipe.steps.len(), planned.entry.name);
            let watcher = PartsWatcher::new(self, &so_far, (progress, &clock));
            let report = self.step_in_parts(planned, &mut landscape, &watcher);
            let report = report.map_err(|error| self.explain_in_parts(error, &landscape, &watcher))?;
            so_far.steps.push(report);
            self.keep_between_steps(&landscape, &so_far, (progress, &clock))?;
        }
        let outputs = self.outputs_in_parts(&landscape, progress);
        let outputs = outputs.map_err(|error| self.with_rows_kept(error, &landscape, &so_far))?;
        let report = Report {
            engine: self.options.engine.name().to_owned(),
            adapter: None,
            seed: self.recipe.seed,
            recipe_blake3: self.recipe.hash(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            steps: so_far.steps,
            outputs,
            notes: so_far.notes,
        };
        let published = place.as_mut().map_or(Ok(()), |place| self.publish(place, &report));
        agreed(&*ranks, published)?;
        Ok(report)
    }

    fn publish(&self, place: &mut WorkFolder, report: &Report) -> Result<(), Error> {
        if self.options.report {
            report.write(&new_files(&self.options.out, self.recipe).join(REPORT_FILE))?;
        }
        place.publish(report.outputs.iter().flat_map(OutputReport::files).collect())?;
        place.leaves = Leaves::Nothing;
        Ok(())
    }

    /// The ranks that share the landscape: this process alone where the engine has no others.
    fn sharing(&self) -> Result<Arc<dyn Ranks>, Error> {
        let is_distributed = self.options.distributed;
        let kind = if is_distributed { "a distributed run" } else { "a run out of core" };
        match &self.options.engine {
            Engine::Cpu if !is_distributed => Ok(Arc::new(Alone)),
            Engine::Ranks(ranks) if is_distributed => Ok(Arc::clone(ranks)),
            Engine::Ranks(_) => {
                Err(Error::Run(format!("{kind} over ranks is distributed, which was not asked for")))
            }
            other => {
                let (where_it_is, other) =
                    (if is_distributed { "by ranks" } else { "on the processor" }, other.name());
                Err(Error::Run(format!("{kind} is made {where_it_is}, and not on the engine `{other}`")))
            }
        }
    }

    /// Whether each step finds the rows around those of a rank with its neighbours.
    fn ensure_neighbours_suffice(&self, domain: &Domain, ranks: &dyn Ranks) -> Result<(), Error> {
        let rows = SharedRows::of((ranks.rank(), ranks.count()), domain.size.rows);
        for (number, planned) in self.recipe.steps.iter().enumerate() {
            let around = planned.step.reach().map_or(0, |reach| reach.rows(domain.cell));
            if !rows.is_whole() && around > rows.least() {
                let (number, name, least) = (number + 1, planned.entry.name, rows.least());
                return Err(Error::Run(format!(
                    "step {number} (`{name}`) looks {around} rows far, and a rank has {least}; run over fewer ranks"
                )));
            }
        }
        Ok(())
    }

    /// Memory that a step may count on, the same on all ranks: what is left beside the planes that lie there, which take so
    /// many bytes for a row.
    fn memory_of_steps(&self, bytes: u64, (rows, ranks): (usize, &dyn Ranks)) -> Result<u64, Error> {
        let memory = least(ranks, memory::allowed(self.options.memory))?;
        let own = SharedRows::of((ranks.rank(), ranks.count()), rows).most() as u64;
        let planes = if self.options.out_of_core.is_some() { 0 } else { bytes * own };
        let beside = BESIDE + planes;
        if planes > 0 && memory <= beside {
            let limit = Limit::new(Quantity::MemoryBytes, beside, 0..=memory);
            let remedy =
                "allow more memory, run over more ranks, or keep the rows on disk with --out-of-core";
            return Err(limit.of("the rows of one rank").remedy(remedy).into());
        }
        Ok(memory.saturating_sub(beside) / OF * COUNTED)
    }

    /// The output folder, which the first rank takes.
    fn place(&self, ranks: &dyn Ranks, progress: &dyn Progress) -> Result<Option<WorkFolder>, Error> {
        agreed(ranks, if ranks.leads() { self.prepare(progress).map(Some) } else { Ok(None) })
    }

    /// What a run has left that was killed when all its files were whole.
    fn finished_before(&self, place: &mut Option<WorkFolder>, ranks: &dyn Ranks) -> Result<Report, Error> {
        if let Some(place) = place {
            place.leaves = Leaves::Nothing;
        }
        let read = || {
            let report = Report::read(&self.options.out.join(REPORT_FILE))?;
            Ok(serde_json::to_vec(&report).expect("it was read as JSON"))
        };
        let report = ranks.tell(agreed(ranks, if ranks.leads() { read() } else { Ok(Vec::new()) })?)?;
        serde_json::from_slice(&report)
            .map_err(|error| Error::Run(format!("the first rank told of no report: {error}")))
    }

    fn step_in_parts(
        &self,
        planned: &Planned,
        landscape: &mut StoredLandscape<'_>,
        watcher: &PartsWatcher<'_>,
    ) -> Result<StepReport, Error> {
        let started = Instant::now();
        let (step, done) = (&planned.step, watcher.so_far.done());
        // What the step reads is there while it runs, and what it writes only where that is read later.
        let mut wanted = self.recipe.wanted_after(done + 1);
        wanted.extend(step.reads());
        landscape.want(wanted);
        let resumed_at = landscape.resumed.as_ref().map(|resumed| resumed.iteration);
        let engine = self.options.engine.clone();
        let job = Job { seed: planned.seed(self.recipe.seed), engine, watcher, resume: None };
        let outcome = step.run_on_disk(landscape, &job)?;
        landscape.want(self.recipe.wanted_after(done + 1));
        for (name, _) in step.writes() {
            if landscape.wants(&name) {
                landscape.range(&name)?;
            }
        }
        outcome.notes.iter().for_each(|note| watcher.progress.note(note));
        let cells = landscape.domain.size.cells();
        let report = step_report(planned, cells, outcome, started.elapsed().as_secs_f64(), resumed_at);
        Ok(StepReport { peak_memory: peak_memory(&*landscape.ranks)?, ..report })
    }
}

/// The most memory that any of the ranks has taken so far.
pub(super) fn peak_memory(ranks: &dyn Ranks) -> Result<Option<u64>, Error> {
    let most = greatest(ranks, memory::taken().unwrap_or_default())?;
    Ok(Some(most).filter(|&most| most > 0))
}

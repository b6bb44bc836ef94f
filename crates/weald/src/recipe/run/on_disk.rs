//! A run whose landscape lies on disk. It gives the files of a run in memory, to the byte, and keeps no checkpoints.

use std::path::Path;

use web_time::Instant;

use super::film::make_folder_of;
use super::finished::step_report;
use super::options::{Progress, Run};
use super::work::{Leaves, new_files};
use crate::recipe::memory;
use crate::recipe::plan::{Content, Ground, Output, Planned};
use crate::recipe::report::{OutputReport, REPORT_FILE, Report};
use weald_core::domain::Domain;
use weald_core::error::{Error, NotFinite};
use weald_core::files::File;
use weald_core::grid::{Field, Size};
use weald_core::plane::Plane;
use weald_engine::report::StepReport;
use weald_engine::stored::{Scratch, StoredLandscape};
use weald_engine::{Engine, Job, Watcher};
use weald_export::classes::{DIRECTIONS, directions};
use weald_io::{Capabilities, Encode, Provenance, Raster, WindowedRaster, WriteWindows, write_through};
use weald_land::flow::DirectionCodes;

/// What the program, its threads and the buffers of files take beside the steps.
const BESIDE: u64 = 64 << 20;

/// The part of the rest that steps count on. Allocators keep some of what one band or tile gave back from the next: peaks
/// were up to an eighth above what steps count.
const COUNTED: u64 = 4;
const OF: u64 = 5;

/// A folder in which files are made that have no name: the system takes them away when the process ends, however it ends.
#[derive(Debug)]
struct ScratchFolder<'a>(&'a Path);

impl Scratch for ScratchFolder<'_> {
    #[cfg(not(target_arch = "wasm32"))]
    fn file(&self) -> Result<File, Error> {
        tempfile::tempfile_in(self.0).map_err(|cause| Error::write(self.0, &cause))
    }

    #[cfg(target_arch = "wasm32")]
    fn file(&self) -> Result<File, Error> {
        Err(Error::Run("a browser has no disk to run from".to_owned()))
    }
}

/// What a step tells, and when it is to stop.
struct ToldOn<'a>(&'a dyn Progress);

impl Watcher for ToldOn<'_> {
    fn progress(&self, done: u64, total: u64, cells: usize) {
        self.0.progress(done, total, cells);
    }

    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}

impl Run<'_> {
    /// Runs the recipe with its layers in a scratch folder.
    pub(super) fn execute_on_disk(&self, scratch: &Path, progress: &dyn Progress) -> Result<Report, Error> {
        self.recipe.scratch()?;
        self.ensure_goes_on_disk()?;
        let Ground::Empty { size, cell, .. } = self.recipe.ground else {
            unreachable!("`scratch` refuses files")
        };
        let mut place = self.prepare(progress)?;
        let folder = ScratchFolder(scratch);
        let memory = memory::allowed(self.options.memory).saturating_sub(BESIDE) / OF * COUNTED;
        let mut landscape = StoredLandscape::new(Domain::new(size, cell), memory, &folder);
        let mut steps = Vec::with_capacity(self.recipe.steps.len());
        for (number, planned) in self.recipe.steps.iter().enumerate() {
            progress.step(number + 1, self.recipe.steps.len(), planned.entry.name);
            steps.push(self.step_on_disk((number, planned), &mut landscape, progress)?);
        }
        let outputs = self.outputs_from_disk(&landscape, progress)?;
        let report = Report {
            engine: Engine::Cpu.name().to_owned(),
            adapter: None,
            seed: self.recipe.seed,
            recipe_blake3: self.recipe.hash(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            steps,
            outputs,
            notes: Vec::new(),
        };
        if self.options.report {
            report.write(&new_files(&self.options.out, self.recipe).join(REPORT_FILE))?;
        }
        place.publish(report.outputs.iter().flat_map(OutputReport::files).collect())?;
        place.leaves = Leaves::Nothing;
        Ok(report)
    }

    fn ensure_goes_on_disk(&self) -> Result<(), Error> {
        if self.options.resume {
            return Err(Error::Run(
                "a run out of core keeps no checkpoint to go on from; run it without --resume".to_owned(),
            ));
        }
        match &self.options.engine {
            Engine::Cpu => Ok(()),
            other => Err(Error::Run(format!(
                "a run out of core is made on the processor, and not on the engine `{}`",
                other.name()
            ))),
        }
    }

    fn step_on_disk(
        &self,
        (number, planned): (usize, &Planned),
        landscape: &mut StoredLandscape<'_>,
        progress: &dyn Progress,
    ) -> Result<StepReport, Error> {
        let started = Instant::now();
        let step = &planned.step;
        // What the step reads is there while it runs, and what it writes only where that is read later.
        let mut wanted = self.recipe.wanted_after(number + 1);
        wanted.extend(step.reads());
        landscape.want(wanted);
        let watcher = ToldOn(progress);
        let job = Job {
            seed: planned.seed(self.recipe.seed),
            engine: Engine::Cpu,
            watcher: &watcher,
            resume: None,
        };
        let located = |error| located(error, number, planned);
        let outcome = step.run_on_disk(landscape, &job).map_err(located)?;
        landscape.want(self.recipe.wanted_after(number + 1));
        for (name, _) in step.writes() {
            if landscape.wants(&name) {
                landscape.range(&name).map_err(located)?;
            }
        }
        outcome.notes.iter().for_each(|note| progress.note(note));
        let cells = landscape.domain.size.cells();
        Ok(step_report(planned, cells, outcome, started.elapsed().as_secs_f64(), None))
    }

    fn outputs_from_disk(
        &self,
        landscape: &StoredLandscape<'_>,
        progress: &dyn Progress,
    ) -> Result<Vec<OutputReport>, Error> {
        let outputs = &self.recipe.outputs;
        let made = outputs.iter().enumerate().map(|(number, output)| {
            if progress.cancelled() {
                return Err(Error::Interrupted("interrupted; no file has changed".to_owned()));
            }
            progress.output(number + 1, outputs.len(), &output.file);
            let Content::Layer { name, encode: Encode::Windows { write, .. }, holds, .. } = &output.content
            else {
                unreachable!("`scratch` refuses other outputs");
            };
            self.layer_from_disk(output, landscape, (name, *write, *holds))
        });
        made.collect()
    }

    fn layer_from_disk(
        &self,
        output: &Output,
        landscape: &StoredLandscape<'_>,
        (name, write, holds): (&str, WriteWindows, Capabilities),
    ) -> Result<OutputReport, Error> {
        let started = Instant::now();
        let (layer, range) = (landscape.layer(name)?, landscape.range(name)?);
        let head = self.head(landscape, name, (&layer.unit, range));
        let scratch =
            |size: Size| -> Result<Box<dyn Plane<f32>>, Error> { Ok(Box::new(landscape.plane(name, size)?)) };
        let windowed = WindowedRaster { head: &head, values: &layer.plane, range, scratch: &scratch };
        let path = new_files(&self.options.out, self.recipe).join(&output.file);
        make_folder_of(&path)?;
        let mut parts = Vec::new();
        write_through(&path, |path| {
            let failed = |cause: std::io::Error| Error::write(path, &cause);
            let mut file = File::create(path).map_err(failed)?;
            parts = write(&windowed, &mut file)?;
            file.sync_all().map_err(failed)
        })
        .map_err(|error| self.by_its_name(error))?;
        for part in &parts {
            weald_io::write_whole(&part.name.path(&path), &part.bytes)?;
        }
        let companions = parts.iter().map(|part| part.name.path(&output.file).display().to_string());
        Ok(OutputReport {
            file: output.file.display().to_string(),
            seconds: started.elapsed().as_secs_f64(),
            peak_memory: memory::taken(),
            layer: Some(name.to_owned()),
            unit: Some(layer.unit.clone()),
            range: Some((range.0.into(), range.1.into())),
            companions: companions.collect(),
            notes: holds.losses(&head),
            ..OutputReport::default()
        })
    }

    /// All that a file says of a layer but its values.
    fn head(&self, landscape: &StoredLandscape<'_>, name: &str, (unit, range): (&str, (f32, f32))) -> Raster {
        let provenance = Provenance {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            recipe_blake3: self.recipe.hash(),
            seed: self.recipe.seed,
            layer: name.to_owned(),
            unit: unit.to_owned(),
            range: (range.0.into(), range.1.into()),
            resampled: None,
        };
        Raster {
            provenance: Some(provenance),
            cell: Some(landscape.domain.cell),
            classes: (name == DIRECTIONS).then(|| directions(DirectionCodes::Weald)),
            ..Raster::from(Field::filled(Size { columns: 1, rows: 1 }, range.0))
        }
    }
}

/// Says in which step an error arose, and that nothing is kept of it.
fn located(error: Error, number: usize, planned: &Planned) -> Error {
    let step = format!("step {} (`{}`)", number + 1, planned.entry.name);
    match error {
        Error::Run(what) => Error::Run(format!("{step}: {what}")),
        Error::Interrupted(what) => {
            Error::Interrupted(format!("{step}: {what}; a run out of core keeps nothing to go on from"))
        }
        Error::NotFinite(fault) => {
            let message = format!("{step}: {}", fault.message);
            NotFinite { step: Some(planned.entry.name.to_owned()), message, ..fault }.into()
        }
        other => other,
    }
}

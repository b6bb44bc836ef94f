//! What a run would take of the disk and of time, by the recipe, the grid and the times of earlier runs on this machine.
//!
//! Files of layers are as long as their format makes heights, pictures a byte a pixel; where the recipe has run at another
//! size, its own files say more. Times are those of earlier runs alone, since machines differ by more than any guess is
//! worth: what has never run here is named.

use std::collections::BTreeSet;
use std::fmt::{Display, Formatter};
use std::path::Path;

use super::memory::SIDE_BY_SIDE;
use super::plan::{Content, Output, Planned, Recipe};
use super::report::{OutputReport, Report};
use super::timings::{Task, Timing, Timings};
use weald_core::domain::Domain;
use weald_core::error::bytes_in_words;
use weald_core::files;

/// Bytes of a pixel of a picture, as measured on maps and views of the templates: 0.5 to 1.4.
const A_PIXEL: f64 = 1.0;

/// Bytes of a cell in files of layers, as measured on heights of the templates; masks take less.
const A_CELL: &[(&str, f64)] = &[("tif", 3.0), ("png", 1.6), ("exr", 3.4), ("asc", 8.0), ("zarr", 3.3)];

/// Bytes of a cell in files that hold every number as it is.
const PLAIN: f64 = 4.0;

/// Where and how a run is made whose time is wanted.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Name of the engine; that of earlier runs where there is none.
    pub engine: Option<String>,
    /// Threads.
    pub threads: usize,
}

/// What a run takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Bytes of all files, and the outputs of which nobody knows.
    pub disk: (u64, Vec<String>),
    /// Seconds of all steps and outputs, and those of which nobody knows.
    pub time: (f64, Vec<String>),
}

impl Display for Estimate {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> std::fmt::Result {
        let beside = |unknown: &[String]| {
            let names: BTreeSet<_> = unknown.iter().map(String::as_str).collect();
            let names: Vec<_> = names.into_iter().collect();
            if names.is_empty() {
                return String::new();
            }
            format!(", beside {}, which no run has shown yet", names.join(", "))
        };
        let ((bytes, files), (seconds, parts)) = (&self.disk, &self.time);
        writeln!(formatter, "disk: about {}{}", bytes_in_words(*bytes), beside(files))?;
        if *seconds == 0.0 && !parts.is_empty() {
            return write!(
                formatter,
                "time: no run on this machine has shown it yet (`weald bench --calibrate` does)"
            );
        }
        write!(formatter, "time: about {}{}", in_words(*seconds), beside(parts))
    }
}

/// Seconds as people say them.
fn in_words(seconds: f64) -> String {
    match seconds {
        ..10.0 => format!("{seconds:.1} s"),
        ..120.0 => format!("{seconds:.0} s"),
        ..7200.0 => format!("{:.0} minutes", seconds / 60.0),
        _ => format!("{:.1} hours", seconds / 3600.0),
    }
}

/// A part of a recipe and how much it has to do.
struct Part {
    task: Task,
    amount: f64,
    /// As a person would call it.
    name: String,
}

impl Recipe {
    /// What a run on this grid takes, by times of earlier runs.
    pub fn estimate(&self, first: &Domain, machine: &Machine, timings: &Timings) -> Estimate {
        let (steps, last) = self.grids(first);
        let mut estimate = Estimate { disk: (0, Vec::new()), time: (0.0, Vec::new()) };
        for (number, (planned, grid)) in steps.iter().enumerate() {
            let part = self.part_of_step(number, planned, grid, machine);
            match timings.seconds(&part.task, part.amount) {
                Some(seconds) => estimate.time.0 += seconds,
                None => estimate.time.1.push(part.name),
            }
        }
        let cells = last.size.cells() as u64;
        let parts: Vec<_> =
            self.outputs.iter().map(|output| self.part_of_output(output, cells, machine)).collect();
        for (output, part) in self.outputs.iter().zip(&parts) {
            let bytes = timings.bytes(&part.task, part.amount);
            match bytes.or_else(|| output.length(part.amount, cells)) {
                Some(bytes) => estimate.disk.0 += bytes,
                None => estimate.disk.1.push(part.name.clone()),
            }
        }
        for group in parts.chunks(SIDE_BY_SIDE) {
            let seconds = |part: &Part| timings.seconds(&part.task, part.amount);
            let known: Vec<_> = group.iter().filter_map(seconds).collect();
            // Those that are made side by side have shared the processors when they were timed, too.
            let shared = known.iter().sum::<f64>() / machine.threads.min(known.len().max(1)) as f64;
            estimate.time.0 += known.into_iter().fold(shared, f64::max);
            let unknown = group.iter().filter(|part| seconds(part).is_none());
            estimate.time.1.extend(unknown.map(|part| part.name.clone()));
        }
        estimate
    }

    fn part_of_step(&self, number: usize, planned: &Planned, grid: &Domain, machine: &Machine) -> Part {
        let work = planned.step.work(grid);
        let name = format!("`{}`", planned.entry.name);
        let what = format!("{} {}", planned.entry.name, work.method);
        let part = (self.file.clone(), format!("step {}", number + 1));
        let Machine { engine, threads } = machine.clone();
        let engine = engine.unwrap_or_default();
        Part {
            task: Task { what, part, engine, threads },
            amount: work.passes * grid.size.cells() as f64,
            name,
        }
    }

    fn part_of_output(&self, output: &Output, cells: u64, machine: &Machine) -> Part {
        let name = output.file.display().to_string();
        let extension = output.file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        let frames = match &output.content {
            Content::Film { film, .. } => film.motion.frames(&self.steps),
            _ => 1,
        };
        let (what, amount) = match &output.content {
            Content::Layer { .. } => (format!("layer .{extension}"), cells),
            Content::Picture { name, .. } => (format!("picture {name}"), output.pixels(cells)),
            Content::Film { name, .. } => {
                (format!("film {name} .{extension}"), frames * output.pixels(cells))
            }
            Content::Export { name, .. } => (format!("export {name} .{extension}"), cells),
        };
        let Machine { engine, threads } = machine.clone();
        let engine = engine.unwrap_or_default();
        let task = Task { what, part: (self.file.clone(), name.clone()), engine, threads };
        Part { task, amount: amount as f64, name }
    }

    /// What the steps and outputs of a run took whose files are in a folder. What was fetched from an earlier run, or
    /// went on from a checkpoint, tells nothing.
    pub(super) fn timings(&self, first: &Domain, report: &Report, threads: usize, out: &Path) -> Vec<Timing> {
        let machine = Machine { engine: Some(report.engine.clone()), threads };
        let (steps, last) = self.grids(first);
        let cells = last.size.cells() as u64;
        let of_steps = steps.iter().zip(&report.steps).enumerate().filter(|(_, (_, done))| !done.cached);
        let of_steps = of_steps.map(|(number, ((planned, grid), done))| {
            let Part { task, amount, .. } = self.part_of_step(number, planned, grid, &machine);
            Timing { task, amount, seconds: done.seconds, bytes: None }
        });
        let of_outputs = self.outputs.iter().zip(&report.outputs).map(|(output, done)| {
            let Part { task, amount, .. } = self.part_of_output(output, cells, &machine);
            Timing { task, amount, seconds: done.seconds, bytes: Some(length_of(done, out)) }
        });
        of_steps.chain(of_outputs).collect()
    }
}

/// Bytes of all files of an output.
fn length_of(output: &OutputReport, out: &Path) -> u64 {
    output.files().iter().map(|file| length(&out.join(file))).sum()
}

/// Bytes of a file, or of all files below a folder. What is gone has none.
fn length(path: &Path) -> u64 {
    let Ok(about) = files::metadata(path) else { return 0 };
    if about.is_file() {
        return about.len();
    }
    let entries = files::read_dir(path).into_iter().flatten().flatten();
    entries.map(|entry| length(&entry.path())).sum()
}

impl Output {
    /// Bytes of its files where the recipe has never run, with that amount of cells or pixels; `None` for exports and
    /// films, which depend on what is in the landscape.
    fn length(&self, amount: f64, cells: u64) -> Option<u64> {
        let extension = self.file.extension()?.to_string_lossy().to_lowercase();
        let a_cell = A_CELL.iter().find(|(name, _)| *name == extension).map_or(PLAIN, |&(_, bytes)| bytes);
        match &self.content {
            Content::Layer { .. } => Some((a_cell * cells as f64) as u64),
            Content::Picture { .. } => Some((A_PIXEL * amount) as u64),
            Content::Film { .. } | Content::Export { .. } => None,
        }
    }
}

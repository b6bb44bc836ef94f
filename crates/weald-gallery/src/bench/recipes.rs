//! Rates of what people run: each step and each output of recipes, as their reports have them.

use std::path::{Path, PathBuf};

use super::rate::pace;
use super::record::Record;
use weald::recipe::{Options, Overrides, Recipe, Report, Run, Silent};
use weald_core::error::Error;

/// A recipe that is measured, and how.
#[derive(Clone, Debug)]
pub struct Measured<'a> {
    /// The recipe.
    pub recipe: &'a Path,
    /// Cells along the longer side, in place of its own.
    pub size: Option<u64>,
    /// Runs of which the best counts, line by line.
    pub runs: usize,
    /// Folder for its files.
    pub out: PathBuf,
}

/// Runs a recipe with each number of threads; `report` is called with each step and each output.
///
/// # Errors
/// Those of the recipe and its run, and [`Error::Run`] where threads cannot be started.
pub fn recipe(
    measured: &Measured<'_>,
    threads: &[usize],
    report: &mut (dyn FnMut(Record) + Send),
) -> Result<(), Error> {
    let overrides = Overrides { size: measured.size, ..Overrides::default() };
    let recipe = Recipe::load(measured.recipe, &overrides)?;
    for &count in threads {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
        let pool = pool.map_err(|cause| Error::Run(format!("cannot start {count} threads: {cause}")))?;
        let options = Options { threads: Some(count), ..Options::into_folder(&measured.out) };
        let run = Run { recipe: &recipe, options };
        let once = || -> Result<_, Error> {
            let before = pool.install(pace);
            let report = run.execute(&Silent)?;
            // The better of two: what disturbs the loop itself says nothing of the run.
            let pace = before.max(pool.install(pace));
            Ok(records(measured, &report, (count, pace)))
        };
        let mut best = once()?;
        for _ in 1..measured.runs {
            for (best, again) in best.iter_mut().zip(once()?) {
                if again.effort() < best.effort() {
                    *best = again;
                }
            }
        }
        best.into_iter().for_each(&mut *report);
    }
    Ok(())
}

/// A line for each step and each output, and one for all outputs.
fn records(measured: &Measured<'_>, report: &Report, (threads, pace): (usize, f64)) -> Vec<Record> {
    let recipe = measured.recipe.file_stem().unwrap_or_default().to_string_lossy();
    let record = |name: String, seconds, amount, peak_memory| Record {
        name,
        threads,
        seconds,
        amount,
        of: "cells".to_owned(),
        pace,
        peak_memory,
    };
    let cells = report.steps.last().map_or(0, |step| step.cells);
    let steps = report.steps.iter().zip(1..).map(|(step, number)| {
        let iterations = if step.cell_updates_per_second > 0.0 { step.iterations.max(1) } else { 1 };
        let (of, amount) = match step.measures.get("plants") {
            Some(&plants) => ("plants", plants),
            None => ("cells", step.cells as f64 * iterations as f64),
        };
        let name = format!("{recipe} {} cells, step {number}: {}", step.cells, step.step);
        Record { of: of.to_owned(), ..record(name, step.seconds, amount, step.peak_memory) }
    });
    let outputs = report.outputs.iter().map(|output| {
        let name = format!("{recipe} {cells} cells, {}", output.file);
        record(name, output.seconds, cells as f64, output.peak_memory)
    });
    steps.chain(outputs).collect()
}

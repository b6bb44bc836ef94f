//! `weald-mpi run`: the first rank runs the recipe, the others take part; and the start of `weald-mpi bench`.

use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use mpi::traits::Communicator;
use weald::Error;
use weald::engine::Engine;
use weald::engine::ranks::Ranks;
use weald::recipe::{Options, OutputReport, REPORT_FILE, Recipe, Report, Run, free_memory, take_part};

use crate::arguments::{BenchArguments, RunArguments};
use crate::bench::bench;
use crate::interrupt;
use crate::messages::ranks_of_this_machine;
use crate::progress::Lines;

/// Runs it; gives the exit code of this rank.
pub(crate) fn run(arguments: &RunArguments, ranks: &Arc<dyn Ranks>) -> u8 {
    if ranks.leads() {
        match lead(arguments, ranks) {
            Ok(()) => 0,
            Err(error) => report_fault(&error, ""),
        }
    } else {
        match follow(arguments, ranks) {
            Ok(()) => 0,
            Err(error) => {
                let code = report_fault(&error, &format!("rank {}: ", ranks.rank()));
                // The others would wait for this one.
                mpi::topology::SimpleCommunicator::world().abort(i32::from(code))
            }
        }
    }
}

/// Prints an error, a line for each fault.
fn report_fault(error: &Error, who: &str) -> u8 {
    error.to_string().lines().for_each(|line| eprintln!("error: {who}{line}"));
    error.exit_code()
}

fn lead(arguments: &RunArguments, ranks: &Arc<dyn Ranks>) -> Result<(), Error> {
    let text = Recipe::text_of(&arguments.recipe);
    // All have the recipe as this rank finds it; without one there is nothing to take part in.
    ranks.tell(text.as_ref().map(|text| text.clone().into_bytes()).unwrap_or_default())?;
    // A recipe is read when the threads are there: names of files are found by writing small ones, which takes threads.
    begin(arguments.threads, ranks)?;
    let recipe = parsed(arguments, &text?)?;
    let options = options(arguments, ranks);
    let report = Run { recipe: &recipe, options }.execute(&Lines::new(arguments.quiet))?;
    if !arguments.quiet {
        list(&report, &arguments.folder());
    }
    Ok(())
}

fn follow(arguments: &RunArguments, ranks: &Arc<dyn Ranks>) -> Result<(), Error> {
    let text = ranks.tell(Vec::new())?;
    begin(arguments.threads, ranks)?;
    // What is wrong with the recipe is the same here, and the first rank says it.
    let Ok(recipe) = parsed(arguments, &String::from_utf8_lossy(&text)) else { return Ok(()) };
    if !arguments.is_distributed() {
        return take_part(&recipe, ranks);
    }
    // What ends it here has ended it on all ranks, and the first says it.
    let _ = Run { recipe: &recipe, options: options(arguments, ranks) }.execute(&Lines::new(true));
    Ok(())
}

fn options(arguments: &RunArguments, ranks: &Arc<dyn Ranks>) -> Options {
    let share = || free_memory().map(|free| free / ranks_of_this_machine() as u64);
    let distributed = arguments.is_distributed();
    let default = if distributed { Duration::MAX } else { Duration::from_mins(1) };
    Options {
        engine: Engine::Ranks(Arc::clone(ranks)),
        checkpoint_every: arguments.checkpoint_every.map_or(default, Duration::from_secs),
        resume: arguments.resume,
        memory: if distributed { arguments.memory.or_else(share) } else { None },
        out_of_core: arguments.out_of_core.clone(),
        distributed,
        ..Options::into_folder(arguments.folder())
    }
}

fn parsed(arguments: &RunArguments, text: &str) -> Result<Recipe, Error> {
    Recipe::parse(&arguments.recipe.display().to_string(), text, &arguments.overrides())
}

/// Measures; gives the exit code of this rank.
pub(crate) fn measure(arguments: &BenchArguments, ranks: &Arc<dyn Ranks>) -> u8 {
    let done = begin(arguments.threads, ranks).and_then(|()| bench(arguments, ranks));
    let Err(error) = done else { return 0 };
    let code = report_fault(&error, &format!("rank {}: ", ranks.rank()));
    // The others would wait for this one.
    mpi::topology::SimpleCommunicator::world().abort(i32::from(code))
}

/// Starts the threads of this rank, and listens for signals.
fn begin(threads: Option<NonZeroUsize>, ranks: &Arc<dyn Ranks>) -> Result<(), Error> {
    let here = ranks_of_this_machine();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = threads.map_or_else(|| (cores / here).max(1), usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    pool.map_err(|cause| Error::Run(format!("cannot start {threads} threads: {cause}")))?;
    interrupt::listen(ranks.leads())
}

/// Prints the files that were written.
fn list(report: &Report, folder: &Path) {
    let files = report.outputs.iter().flat_map(OutputReport::files);
    for file in files.chain([Path::new(REPORT_FILE).to_owned()]) {
        println!("{}", folder.join(file).display());
    }
}

//! The `weald-mpi` command: `weald run` over the processes that `mpirun` or `srun` starts.
//!
//! The first rank runs the recipe and has its files; all ranks compute its simulations, each on a band of rows. Of a distributed
//! run all ranks run the recipe, each on its own rows, and the first writes the files. Whatever their number, the files have the bits that `weald run --engine cpu` gives them. Exit codes are those of `weald`: 0
//! done, 1 run failed, 2 usage, 3 bad recipe, 4 bad input file, 5 over a stated limit, 130 interrupted.

mod arguments;
mod bench;
mod interrupt;
mod messages;
mod progress;
mod run;
mod scaling;

use std::process::ExitCode;
use std::sync::Arc;

use clap::Parser;
use mpi::Threading;
use mpi::traits::Communicator;
use weald::engine::ranks::Ranks;

use arguments::{Arguments, Command, Inside};
use messages::MpiRanks;

/// Exit code of a usage error.
const USAGE: u8 = 2;

/// Exit code where a rank panics.
const PANICKED: i32 = 101;

fn main() -> ExitCode {
    // One thread at a time speaks with the others, whichever it is.
    let Some((universe, _)) = mpi::initialize_with_threading(Threading::Serialized) else {
        eprintln!("error: MPI was initialised before this program began, or cannot be");
        return ExitCode::FAILURE;
    };
    end_all_on_panic();
    let ranks = |inside: Inside| -> Arc<dyn Ranks> { Arc::new(MpiRanks::new(inside.into())) };
    let code = match Arguments::try_parse() {
        Ok(Arguments { command: Command::Run(arguments) }) => {
            run::run(&arguments, &ranks(arguments.inside_first))
        }
        Ok(Arguments { command: Command::Bench(arguments) }) => {
            run::measure(&arguments, &ranks(arguments.inside_first))
        }
        Err(said) => say_usage(&said, &*ranks(Inside::Measured)),
    };
    drop(universe);
    ExitCode::from(code)
}

/// Every rank reads the same command line, of which one speaks.
fn say_usage(said: &clap::Error, ranks: &dyn Ranks) -> u8 {
    if ranks.leads() {
        // Where nobody listens, nobody needs to be told.
        let _ = said.print();
    }
    if said.use_stderr() { USAGE } else { 0 }
}

/// A rank that panics would be waited for by all others.
fn end_all_on_panic() {
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        report(panic);
        mpi::topology::SimpleCommunicator::world().abort(PANICKED)
    }));
}

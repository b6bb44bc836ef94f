//! The command line.

use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use weald::engine::ranks::Overlap;
use weald::recipe::Overrides;

/// Runs recipes over the processes of a cluster, with the bits of one processor.
#[derive(Debug, Parser)]
#[command(name = "weald-mpi", version)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Runs a recipe over all ranks: `mpirun -n 4 weald-mpi run RECIPE.toml`
    Run(RunArguments),
    /// Measures steps and messages of the ranks here beside a model of them, and prints what that says of a larger grid
    Bench(BenchArguments),
}

#[derive(Debug, Args)]
pub(crate) struct BenchArguments {
    /// Model of the simulation
    #[arg(long, value_name = "MODEL", default_value = "han", value_parser = ["han", "mei"])]
    pub(crate) model: String,
    /// Cells a side
    #[arg(long, value_name = "N", default_value_t = 2048, value_parser = clap::value_parser!(u64).range(64..=16384))]
    pub(crate) size: u64,
    /// Steps of the shorter of two runs, whose difference counts; more where a busy machine hides it
    #[arg(long, value_name = "N", default_value_t = 40, value_parser = clap::value_parser!(u32).range(4..=1_000_000))]
    pub(crate) steps: u32,
    /// Cells a side of the grid for which the model is printed
    #[arg(long, value_name = "N", default_value_t = 65_536, value_parser = clap::value_parser!(u64).range(64..=1 << 30))]
    pub(crate) larger: u64,
    /// Latency between nodes in microseconds, in place of what is measured
    #[arg(long, value_name = "MICROSECONDS")]
    pub(crate) latency: Option<f64>,
    /// Bandwidth between two nodes in gigabytes per second, in place of what is measured
    #[arg(long, value_name = "GIGABYTES")]
    pub(crate) bandwidth: Option<f64>,
    /// When ranks compute their inside while rows of their neighbours are on their way; `measured` takes what is faster
    #[arg(long, value_name = "WHEN", value_enum, default_value_t = Inside::Measured)]
    pub(crate) inside_first: Inside,
    /// Threads of each rank [default: the cores of its machine, shared among the ranks there]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
}

/// When ranks compute their inside first.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Inside {
    Always,
    Never,
    Measured,
}

impl From<Inside> for Overlap {
    fn from(inside: Inside) -> Self {
        match inside {
            Inside::Always => Self::Always,
            Inside::Never => Self::Never,
            Inside::Measured => Self::Measured,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct RunArguments {
    /// The recipe
    #[arg(value_name = "RECIPE.toml")]
    pub(crate) recipe: PathBuf,
    /// Folder of the files [default: out/ and the recipe's name]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Cells along the longer side, on the same ground
    #[arg(long, value_name = "N")]
    pub(crate) size: Option<u64>,
    /// Seed of the landscape
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Sets a key of the recipe, such as step.2.iterations=500; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub(crate) set: Vec<(String, String)>,
    /// Threads of each rank [default: the cores of its machine, shared among the ranks there]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
    /// Seconds between checkpoints [default: 60; of a distributed run none but where it is ended]
    #[arg(long, value_name = "SECONDS")]
    pub(crate) checkpoint_every: Option<u64>,
    /// Goes on from the checkpoint in the output folder, over any number of ranks
    #[arg(long)]
    pub(crate) resume: bool,
    /// Each rank holds its own rows of the landscape alone, and none the whole
    #[arg(long)]
    pub(crate) distributed: bool,
    /// The same, with the rows on disk, in a folder that each machine has
    #[arg(long, value_name = "DIR")]
    pub(crate) out_of_core: Option<PathBuf>,
    /// Most memory that a rank may take then, such as 2GiB [default: what is free on its machine, shared among the ranks there]
    #[arg(long, value_name = "SIZE", value_parser = weald::error::bytes_from_words)]
    pub(crate) memory: Option<u64>,
    /// When ranks compute their inside while rows of their neighbours are on their way; `measured` takes what is faster
    #[arg(long, value_name = "WHEN", value_enum, default_value_t = Inside::Measured)]
    pub(crate) inside_first: Inside,
    /// Shows no progress
    #[arg(long)]
    pub(crate) quiet: bool,
}

impl RunArguments {
    /// What of the recipe is to be otherwise.
    pub(crate) fn overrides(&self) -> Overrides {
        let larger_than_memory = self.is_distributed();
        let set = self.set.clone();
        Overrides { size: self.size, seed: self.seed, set, larger_than_memory, ..Overrides::default() }
    }

    /// Whether no rank holds the whole.
    pub(crate) fn is_distributed(&self) -> bool {
        self.distributed || self.out_of_core.is_some()
    }

    /// Where the files go.
    pub(crate) fn folder(&self) -> PathBuf {
        let default = || PathBuf::from("out").join(self.recipe.file_stem().unwrap_or_default());
        self.out.clone().unwrap_or_else(default)
    }
}

fn key_and_value(text: &str) -> Result<(String, String), String> {
    let parts = text.split_once('=').ok_or_else(|| format!("`{text}` has no `=`: write KEY=VALUE"))?;
    Ok((parts.0.trim().to_owned(), parts.1.trim().to_owned()))
}

//! How a recipe is run, and what is changed of it.

use std::path::PathBuf;
use std::sync::Arc;

use clap::{Args, value_parser};
use weald::recipe::{Cache, CacheLimits, Overrides};

use crate::values::{self, EngineChoice};

/// How a recipe is run.
#[derive(Debug, Args)]
pub(crate) struct Running {
    /// Where simulations run: auto, cpu or gpu
    #[arg(long, default_value = "auto", value_parser = values::choice)]
    pub(crate) engine: EngineChoice,
    /// Most memory of the graphics card, as in 512MiB; larger grids go tile by tile [default: 4GiB, 2GiB where
    /// the machine's own is used]
    #[arg(long, value_name = "BYTES", allow_negative_numbers = true, value_parser = values::memory)]
    pub(crate) gpu_memory: Option<u64>,
    /// Most memory that a run may take, as in 8GiB; one that would take more does not start [default: what is free]
    #[arg(long, value_name = "BYTES", allow_negative_numbers = true, value_parser = values::memory)]
    pub(crate) memory: Option<u64>,
    /// Folder of results of steps, of which a run takes what fits and into which it puts its own, 4 GiB at most
    /// [default: that of the system, or `WEALD_CACHE`]
    #[arg(long, value_name = "DIR", conflicts_with = "no_cache")]
    pub(crate) cache: Option<PathBuf>,
    /// Run every step, and keep no results for later runs; `WEALD_CACHE=off` does the same
    #[arg(long)]
    pub(crate) no_cache: bool,
    /// Threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Go on from the checkpoint of an interrupted run
    #[arg(long)]
    pub(crate) resume: bool,
    /// Seconds between checkpoints of a running simulation [default: 60; out of core none but where the run is ended]
    #[arg(long, value_name = "SECONDS")]
    pub(crate) checkpoint_every: Option<u64>,
    /// Draw pictures of kind `render` on the processor where there is no graphics device: view, which is ray-marched
    #[arg(long, value_name = "PICTURE", value_parser = ["view"])]
    pub(crate) fallback: Option<String>,
    /// Print errors only
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Variable with the folder of results of steps, or `off`.
const CACHE_VARIABLE: &str = "WEALD_CACHE";

impl Running {
    /// Results of steps that earlier runs have left.
    pub(crate) fn cache(&self) -> Option<Arc<Cache>> {
        // A run visits each step once, so that nothing needs to stay in memory.
        let limits = CacheLimits { memory: 0, ..CacheLimits::default() };
        self.kept_results().map(|folder| Arc::new(Cache::in_folder(folder, limits)))
    }

    /// Folder of what runs leave for later ones.
    pub(crate) fn kept_results(&self) -> Option<PathBuf> {
        if self.no_cache { None } else { kept_results(self.cache.clone()) }
    }
}

/// That folder of what runs leave for later ones, or the one that is used without word.
pub(crate) fn kept_results(folder: Option<PathBuf>) -> Option<PathBuf> {
    let said = std::env::var_os(CACHE_VARIABLE).filter(|folder| !folder.is_empty());
    if folder.is_none() && said.as_ref().is_some_and(|folder| folder == "off") {
        return None;
    }
    let of_the_system = || dirs::cache_dir().map(|folder| folder.join("weald"));
    folder.or_else(|| said.map(PathBuf::from)).or_else(of_the_system)
}

/// Greatest seed: whole numbers beyond it are not all exact where reports are read as JSON.
const SEEDS: u64 = (1 << 53) - 1;

/// Changes to a recipe.
#[derive(Debug, Args)]
pub(crate) struct Changes {
    /// Cells along the longer side; shape and extent stay
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u64).range(1..))]
    size: Option<u64>,
    /// Make the same landscape in seconds, on a quarter of the cells a side, at least 256
    #[arg(long, conflicts_with = "size")]
    preview: bool,
    #[command(flatten)]
    values: Values,
}

/// Changes to a recipe's values.
#[derive(Debug, Args)]
pub(crate) struct Values {
    /// Another seed
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = value_parser!(u64).range(0..=SEEDS))]
    seed: Option<u64>,
    /// Change a value: landscape.cell=10, step.2.iterations=500, or thermal.talus=0.7 for all such steps
    #[arg(long, value_name = "KEY=VALUE", value_parser = key_and_value)]
    set: Vec<(String, String)>,
}

impl Changes {
    /// Whether the landscape is made coarser to be looked at.
    pub(crate) fn is_preview(&self) -> bool {
        self.preview
    }

    pub(crate) fn overrides(&self) -> Overrides {
        Overrides { preview: self.preview, ..self.values.overrides(self.size) }
    }
}

impl Values {
    /// With so many cells along the longer side.
    pub(crate) fn overrides(&self, size: Option<u64>) -> Overrides {
        Overrides { size, seed: self.seed, set: self.set.clone(), ..Overrides::default() }
    }
}

fn key_and_value(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or("it is written KEY=VALUE, as in landscape.cell=10")?;
    Ok((key.trim().to_owned(), value.trim().to_owned()))
}

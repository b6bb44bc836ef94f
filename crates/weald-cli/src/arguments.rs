//! What the command line can say.

mod fractal;
mod render;
mod running;

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, value_parser};
use clap_complete::Shell;
use weald::recipe::template::TEMPLATES;
use weald_gallery::figures::{self as gallery, FIGURES};

pub(crate) use self::fractal::FractalArguments;
pub(crate) use self::render::{RenderArguments, RenderFiles};
pub(crate) use self::running::{Changes, Running, kept_results};
use crate::values;

/// Turns a recipe into a living landscape.
#[derive(Debug, Parser)]
#[command(name = "weald", version, after_help = EXIT_CODES)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const EXIT_CODES: &str = "\
Exit codes: 0 done, 1 run failed, 2 usage, 3 bad recipe, 4 bad input file, 5 over a stated limit, 130 interrupted.
Start with: weald new mine && weald run mine.toml";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a recipe and write its files and report.json
    Run(RunArguments),
    /// Run a recipe and write one HTML page about it, and nothing else
    Report(ReportArguments),
    /// Check a recipe and the files that it reads without running it, and list what a run would write
    Check(CheckArguments),
    /// List all steps, or show the parameters of one
    Steps {
        /// The step to show
        name: Option<String>,
    },
    /// Write a commented recipe to start from
    New {
        /// Name of the recipe; `.toml` is added
        name: PathBuf,
        /// What to start from
        #[arg(long, default_value = TEMPLATES[0].name, value_parser = template_names())]
        template: String,
    },
    /// Rewrite a recipe of an earlier version in the words of today; comments and layout stay
    Migrate {
        /// The recipe
        #[arg(value_name = "RECIPE.toml")]
        recipe: PathBuf,
        /// File to write [default: the recipe itself]
        #[arg(long, short, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// Say what is in a raster file
    Info {
        /// A raster file of any format that is read: docs/formats.md lists them
        file: PathBuf,
        /// For programs
        #[arg(long)]
        json: bool,
    },
    /// Convert between raster formats; the extension of OUT chooses
    Convert {
        /// The file to read
        #[arg(value_name = "IN")]
        input: PathBuf,
        /// The file to write
        #[arg(value_name = "OUT")]
        output: PathBuf,
        /// Write it the way one reader wants it: blender, terrain3d or hterrain (.exr), landlab (.nc, .zarr)
        #[arg(long, value_name = "READER")]
        preset: Option<String>,
    },
    /// Make the figures of the publications again
    Gallery {
        /// A figure, or all of a publication as in `ifs` [default: all]
        #[arg(long, value_name = "ID", value_parser = figure_ids())]
        only: Vec<String>,
        /// Folder of the pictures and their page
        #[arg(long, value_name = "DIR", default_value = "out/gallery")]
        out: PathBuf,
    },
    /// Serve the studio's page for browsers on this machine, to try it
    ///
    /// The page is a folder that any web server can serve: `web` in the archive of a release; `cargo run --release -p
    /// weald-dev -- web` makes it.
    Web {
        /// Folder of the page; by default `web` beside the program, or `target/page`
        #[arg(value_name = "DIR")]
        folder: Option<PathBuf>,
        /// Serve it on this port of this machine alone; 0 takes a free one
        #[arg(long, value_name = "PORT", num_args = 0..=1, default_missing_value = "8080")]
        serve: Option<u16>,
    },
    /// Open a window: run, paint and undo by hand
    #[cfg(feature = "studio")]
    Studio {
        /// A recipe, an elevation model, or the folder of a project [default: a template]
        #[arg(value_name = "RECIPE|DEM|PROJECT")]
        what: Option<PathBuf>,
        /// Record what takes time into this file, which ui.perfetto.dev shows
        #[arg(long, value_name = "FILE.json")]
        trace: Option<PathBuf>,
    },
    /// Draw a fractal plant or figure, still or in the wind
    Fractal(FractalArguments),
    /// Draw a landscape on the GPU: a still, a turntable, a flight, a walk
    Render(Box<RenderArguments>),
    /// Measure rates beside the bandwidth of memory and beside naive versions
    Bench(BenchArguments),
    /// Print the JSON Schema of recipes
    Schema,
    /// Print completions for a shell
    Completions {
        /// The shell
        shell: Shell,
    },
}

impl Command {
    /// Whether it may look for graphics cards.
    pub(crate) fn may_use_a_device(&self) -> bool {
        matches!(
            self,
            Self::Run(_)
                | Self::Report(_)
                | Self::Gallery { .. }
                | Self::Fractal(_)
                | Self::Render(_)
                | Self::Bench(_)
        )
    }
}

fn template_names() -> PossibleValuesParser {
    PossibleValuesParser::new(TEMPLATES.iter().map(|template| template.name))
}

fn figure_ids() -> PossibleValuesParser {
    PossibleValuesParser::new(gallery::selectable(FIGURES))
}

#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    /// The recipe
    #[arg(value_name = "RECIPE.toml")]
    pub(crate) recipe: PathBuf,
    #[command(flatten)]
    pub(crate) changes: Changes,
    /// Threads of the run whose time is estimated [default: all cores]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Look at a run out of core: whether it can be made, and the room that it takes in its folder
    #[arg(long)]
    pub(crate) out_of_core: bool,
}

#[derive(Debug, Args)]
pub(crate) struct RunArguments {
    /// The recipe
    #[arg(value_name = "RECIPE.toml")]
    pub(crate) recipe: PathBuf,
    #[command(flatten)]
    pub(crate) changes: Changes,
    /// Folder of the files [default: out/ and the recipe's name]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Run a landscape that is larger than memory: its layers lie in files without names in this folder, which are gone
    /// when the run ends; the processor takes as much memory as --memory says
    #[arg(long, value_name = "DIR", conflicts_with = "resume")]
    pub(crate) out_of_core: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) running: Running,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArguments {
    /// The recipe
    #[arg(value_name = "RECIPE.toml")]
    pub(crate) recipe: PathBuf,
    #[command(flatten)]
    pub(crate) changes: Changes,
    /// The page [default: report.html in out/ and the recipe's name]
    #[arg(long, value_name = "FILE.html")]
    pub(crate) out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) running: Running,
}

// Each flag is an option of the command by itself.
#[allow(clippy::struct_excessive_bools)]
#[derive(Debug, Args)]
pub(crate) struct BenchArguments {
    /// What is measured: cpu or gpu
    #[arg(long, default_value = "cpu", value_parser = ["cpu", "gpu"])]
    pub(crate) engine: String,
    /// Cells a side [default: 512 1024 2048; with a graphics card 4096 too]
    #[arg(long, value_name = "N", num_args = 1..)]
    pub(crate) size: Vec<usize>,
    /// Threads, with --engine cpu
    #[arg(long, value_name = "N", num_args = 1.., default_values_t = [1, 2])]
    pub(crate) threads: Vec<usize>,
    /// Run the templates at two small sizes and keep what their steps and outputs take: what `weald check` estimates times
    /// by, until recipes have runs of their own
    #[arg(long, conflicts_with_all = ["size", "gpu_memory", "save", "against", "fractals", "render", "recipe", "grass"])]
    pub(crate) calibrate: bool,
    /// Runs of each recipe of which the best counts, with --recipe
    #[arg(long, value_name = "N", default_value_t = 1, requires = "recipe", value_parser = value_parser!(u32).range(1..))]
    pub(crate) runs: u32,
    /// File for the results, with --engine cpu
    #[arg(long, value_name = "FILE", conflicts_with_all = ["render", "fractals", "grass"])]
    pub(crate) save: Option<PathBuf>,
    /// File of earlier results: what became slower since is told, beside the pace of the processor in both runs, and the
    /// exit code is 1
    #[arg(long, value_name = "FILE", conflicts_with_all = ["render", "fractals", "grass"])]
    pub(crate) against: Option<PathBuf>,
    /// Only points of fractals, with --engine cpu; beside flam3 where it is installed
    #[arg(long, conflicts_with_all = ["size", "gpu_memory"])]
    pub(crate) fractals: bool,
    /// Only the passes of a `render` picture, on the GPU
    #[arg(long, conflicts_with_all = ["size", "fractals", "grass"])]
    pub(crate) render: bool,
    /// Most sets of grass (tufts of six blades) in a picture, with --render [default: all; on software 50100]
    #[arg(long, value_name = "N", requires = "render", value_parser = value_parser!(u32).range(1..))]
    pub(crate) sets: Option<u32>,
    /// Recipes that are measured in place of all else: each step and each output; with --render their first view, of 640 ×
    /// 360 pixels with one sample, still and from a camera that moves
    #[arg(long, value_name = "RECIPE.toml", num_args = 1.., conflicts_with_all = ["sets", "fractals", "grass"])]
    pub(crate) recipe: Vec<PathBuf>,
    /// Where a person stands who looks at their middles from 1.7 m above the ground, with --recipe
    #[arg(long, value_name = "X,Y", requires = "recipe", value_parser = values::eye)]
    pub(crate) standing: Option<values::Point>,
    /// Only how soon the studio's window answers, in a window that drives itself, with a template
    #[cfg(feature = "studio")]
    #[arg(long, conflicts_with_all = ["size", "fractals", "grass", "render"])]
    pub(crate) studio: bool,
    /// Only sets (tufts) and blades of grass, with --engine cpu
    #[arg(long, conflicts_with_all = ["size", "gpu_memory", "fractals"])]
    pub(crate) grass: bool,
    /// Most memory of the graphics card, as in 512MiB; larger sizes are left out
    #[arg(long, value_name = "BYTES", allow_negative_numbers = true, value_parser = values::memory)]
    pub(crate) gpu_memory: Option<u64>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_declaration_of_the_command_line_is_sound() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn every_command_says_what_it_does() {
        let commands = Arguments::command();
        let silent = commands.get_subcommands().find(|command| command.get_about().is_none());
        assert_eq!(silent.map(clap::Command::get_name), None);
    }

    #[test]
    fn the_documents_name_every_command() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/commands.md");
        let text = std::fs::read_to_string(path).expect("the document of the commands");
        for command in Arguments::command().get_subcommands() {
            let row = format!("| `weald {}", command.get_name());
            assert!(text.contains(&format!("{row} ")) || text.contains(&format!("{row}`")), "{row}`");
        }
    }
}

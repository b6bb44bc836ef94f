//! `cargo run --release -p weald-dev -- gallery` renews docs/gallery; `-- picture FROM.png TO.webp`, one picture; `-- steps`
//! the pictures of what steps do; `-- web` builds the page for browsers.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use weald::Error;
use weald_dev::{GREATEST_EFFORT, PageFile, Renewed, keep, page, renew, step_pictures};

/// Renews committed pictures: those that look different, as WebP
#[derive(Debug, Parser)]
#[command(name = "weald-dev")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
    /// Write pictures anew that look as they did, too
    #[arg(long, global = true)]
    all: bool,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Renew the committed gallery from the one that `weald gallery` has made
    Gallery {
        /// Folder that `weald gallery` has written
        #[arg(long, value_name = "DIR", default_value = "out/gallery")]
        from: PathBuf,
        /// Folder of the committed gallery
        #[arg(long, value_name = "DIR", default_value = "docs/gallery")]
        into: PathBuf,
    },
    /// Renew one committed picture
    Picture {
        /// What Weald has drawn, a PNG
        #[arg(value_name = "FROM.png")]
        from: PathBuf,
        /// The committed picture
        #[arg(value_name = "TO.webp")]
        into: PathBuf,
    },
    /// Draw what each step does, for the studio's list of steps
    Steps {
        /// The sheet of pictures, a PNG
        #[arg(value_name = "INTO.png", default_value = "crates/weald-studio/src/panels/pictures/steps.png")]
        into: PathBuf,
    },
    /// Build Weald's page for browsers: a folder that any web server serves
    Web {
        /// Folder of the page
        #[arg(value_name = "DIR", default_value = "target/page")]
        into: PathBuf,
        /// How hard to try to make it small: the greatest effort takes a minute more than the least
        #[arg(long, default_value_t = GREATEST_EFFORT, value_parser = clap::value_parser!(u32).range(..=i64::from(GREATEST_EFFORT)))]
        effort: u32,
    },
}

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(Arguments { command, all }: &Arguments) -> Result<(), Error> {
    match command {
        Command::Gallery { from, into } => renew(from, into, *all, &|renewed| match renewed {
            Renewed::Figure(name, kept) => println!("{name} {kept}"),
            Renewed::Deleted(name) => println!("{name} deleted: no figure shows it"),
        }),
        Command::Picture { from, into } => {
            println!("{} {}", into.display(), keep(from, into, *all)?);
            Ok(())
        }
        Command::Steps { into } => {
            println!("{}: {} steps", into.display(), step_pictures(into)?);
            Ok(())
        }
        Command::Web { into, effort } => {
            let files = page(into, *effort)?;
            for file in &files {
                println!("{:>10} {:>10} {}", file.bytes, file.packed, file.name);
            }
            let sum = |of: fn(&PageFile) -> usize| files.iter().map(of).sum::<usize>();
            println!(
                "{:>10} {:>10} bytes as they are, and by Brotli",
                sum(|file| file.bytes),
                sum(|file| file.packed)
            );
            Ok(())
        }
    }
}

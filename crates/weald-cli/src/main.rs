//! The `weald` command: a thin shell around the library of the same name.
//!
//! Results go to stdout, progress and messages to stderr. Exit codes: 0 done, 1 run failed, 2 usage, 3 bad
//! recipe, 4 bad input file, 5 over a stated limit, 130 interrupted.

mod arguments;
mod commands;
mod declared;
mod engine;
mod failure;
mod interrupt;
mod layers_of_drivers;
mod progress;
mod stdout;
mod values;
mod viewpoint;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};

fn main() -> ExitCode {
    let command = Arguments::parse().command;
    if command.may_use_a_device() {
        layers_of_drivers::silence();
    }
    let done = match command {
        Command::Run(arguments) => commands::run::run(&arguments),
        Command::Report(arguments) => commands::report::report(&arguments),
        Command::Check(arguments) => commands::check::check(&arguments),
        Command::Steps { name } => commands::steps::steps(name.as_deref()),
        Command::New { name, template } => commands::new::new(&name, &template),
        Command::Migrate { recipe, out } => commands::migrate::migrate(&recipe, out.as_ref()),
        Command::Info { file, json } => commands::info::info(&file, json),
        Command::Convert { input, output, preset } => {
            commands::convert::convert(&input, &output, preset.as_deref())
        }
        Command::Gallery { only, out } => commands::gallery::gallery(&only, &out),
        Command::Fractal(arguments) => commands::fractal::fractal(&arguments),
        Command::Bench(arguments) => commands::bench::bench(&arguments),
        Command::Render(arguments) => commands::render::render(&arguments),
        #[cfg(feature = "studio")]
        Command::Studio { what, trace } => commands::studio::studio(what, trace.as_deref()),
        Command::Web { folder, serve } => commands::web::web(folder, serve),
        Command::Schema => commands::schema::schema(),
        Command::Completions { shell } => commands::completions::completions(shell),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

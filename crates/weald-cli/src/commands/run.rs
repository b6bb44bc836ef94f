//! `weald run`.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

use weald::Error;
use weald::layer_words::shown_unit;
use weald::recipe::{Options, OutputReport, Overrides, Progress, REPORT_FILE, Recipe, Report, Run};

use crate::arguments::{RunArguments, Running};
use crate::engine::drawing;
use crate::failure::Failure;
use crate::progress::ProgressPrinter;
use crate::values::EngineChoice;
use crate::{interrupt, stdout};

pub(crate) fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let larger_than_memory = arguments.out_of_core.is_some();
    let overrides = Overrides { larger_than_memory, ..arguments.changes.overrides() };
    let recipe = Recipe::load(&arguments.recipe, &overrides)?;
    let out = arguments.out.clone().unwrap_or_else(|| {
        let folder = default_folder(&arguments.recipe);
        // What was made at full size is not lost by a look at a change.
        if arguments.changes.is_preview() { folder.with_added_extension("preview") } else { folder }
    });
    let options = match &arguments.out_of_core {
        Some(scratch) => Options::from_disk(&out, scratch),
        None => Options::into_folder(&out),
    };
    let report = execute(&recipe, options, &arguments.running)?;
    if arguments.running.quiet { Ok(()) } else { stdout::print(&summary(&report, &out)) }
}

/// Runs a recipe as the command line says, with progress on stderr, and hands over its files' report.
pub(super) fn execute(recipe: &Recipe, options: Options, running: &Running) -> Result<Report, Failure> {
    watched(recipe, options, running, |run, shown| run.execute(shown))
}

/// The same, for what `work` makes of the run.
pub(super) fn watched<T>(
    recipe: &Recipe,
    options: Options,
    running: &Running,
    work: impl FnOnce(&Run<'_>, &ProgressPrinter) -> Result<T, Error>,
) -> Result<T, Failure> {
    let engine = match (&options.out_of_core, running.engine) {
        (Some(_), EngineChoice::Auto) => EngineChoice::Cpu,
        (_, engine) => engine,
    };
    let chosen = engine.open(running.gpu_memory)?;
    let draws = recipe.outputs.iter().any(|output| output.render().is_some());
    let render = if draws { Some(drawing(running)?) } else { None };
    let options = Options {
        engine: chosen.engine,
        threads: running.threads.map(usize::from),
        checkpoint_every: running.checkpoint_every.map_or(options.checkpoint_every, Duration::from_secs),
        resume: running.resume,
        memory: running.memory,
        cache: running.cache(),
        timings: running.kept_results(),
        render,
        ..options
    };
    interrupt::listen()?;
    let shown = ProgressPrinter::new(running.quiet);
    if let Some(note) = &chosen.note {
        shown.note(note);
    }
    let done = work(&Run { recipe, options }, &shown);
    shown.end();
    Ok(done?)
}

/// Where the files of a recipe go.
pub(super) fn default_folder(recipe: &Path) -> PathBuf {
    Path::new("out").join(recipe.file_stem().unwrap_or_default())
}

/// A line for each file that was written, the first of each output with what is in it.
fn summary(report: &Report, out: &Path) -> String {
    let mut text = String::new();
    for output in &report.outputs {
        let mut content = Some(format!("  {}", content(output)));
        for file in output.files() {
            let _ = writeln!(text, "{}{}", out.join(file).display(), content.take().unwrap_or_default());
        }
    }
    let _ = writeln!(text, "{}", out.join(REPORT_FILE).display());
    text
}

fn content(output: &OutputReport) -> String {
    match (&output.layer, &output.unit, output.range) {
        (Some(layer), Some(unit), Some((low, high))) => {
            let unit = shown_unit(unit);
            let is_code = unit.is_empty() && low.fract() == 0.0 && high.fract() == 0.0;
            let decimals = if is_code { 0 } else { 3 };
            format!("{layer}, {low:.decimals$} to {high:.decimals$} {unit}").trim_end().to_owned()
        }
        (Some(layer), ..) => layer.clone(),
        _ => match (&output.picture, output.frames, &output.export) {
            (Some(picture), Some(frames), _) => format!("film of {frames} frames, {picture}"),
            (Some(picture), None, _) => format!("picture, {picture}"),
            (None, _, export) => format!("export, {}", export.as_deref().unwrap_or_default()),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn output(file: &str) -> OutputReport {
        OutputReport { file: file.to_owned(), ..OutputReport::default() }
    }

    #[test]
    fn a_run_lists_the_files_that_it_wrote_and_no_others() {
        let film = OutputReport { picture: Some("relief".to_owned()), frames: Some(2), ..output("f.mp4") };
        let still = OutputReport { picture: Some("relief".to_owned()), ..output("s.png") };
        let tiles = ["u_0_0.r16", "u_0_1.r16"].map(str::to_owned).to_vec();
        let tiles = OutputReport {
            export: Some("unity".to_owned()),
            companions: tiles,
            name_only: true,
            ..output("u.r16")
        };
        let layer = OutputReport {
            layer: Some("height".to_owned()),
            unit: Some("m".to_owned()),
            range: Some((0.5, 1.25)),
            ..output("h.tif")
        };
        let without_video = OutputReport { name_only: true, ..film.clone() };
        let apng = OutputReport { file: "f.apng".to_owned(), ..film.clone() };
        let report = Report {
            engine: String::new(),
            adapter: None,
            seed: 1,
            recipe_blake3: String::new(),
            version: String::new(),
            steps: Vec::new(),
            outputs: vec![film, without_video, apng, still, tiles, layer],
            notes: Vec::new(),
        };
        let text = summary(&report, Path::new("o"));
        let lines: Vec<_> = text.lines().map(|line| line.replace('\\', "/")).collect();
        assert_eq!(
            lines,
            [
                "o/f.mp4  film of 2 frames, relief",
                "o/f-00000.png",
                "o/f-00001.png",
                "o/f-00000.png  film of 2 frames, relief",
                "o/f-00001.png",
                "o/f.apng  film of 2 frames, relief",
                "o/s.png  picture, relief",
                "o/u_0_0.r16  export, unity",
                "o/u_0_1.r16",
                "o/h.tif  height, 0.500 to 1.250 m",
                "o/report.json",
            ]
        );
    }
}

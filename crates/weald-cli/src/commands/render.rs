//! `weald render`.

use std::path::{Path, PathBuf};

use weald::Error;
use weald::picture::{Around, Camera, Cutout, LitScene, RenderRequest, Rendering, View};
use weald::recipe::{FILM_EXTENSIONS, Film, Frames, Options, Progress, ViewRequest};

use super::run::{default_folder, watched};
use crate::arguments::{RenderArguments, RenderFiles};
use crate::engine::drawing;
use crate::failure::Failure;
use crate::progress::ProgressPrinter;
use crate::{interrupt, stdout, viewpoint};

/// Frames of a film that are shown in a second.
const FRAMES_PER_SECOND: f64 = 24.0;

pub(crate) fn render(arguments: &RenderArguments) -> Result<(), Failure> {
    let files = &arguments.files;
    let output = output(files)?;
    viewpoint::check(files, &arguments.view)?;
    let request = ViewRequest {
        recipe: files.recipe.clone(),
        overrides: files.values.overrides(files.cells),
        keys: arguments.view.clone(),
    };
    let (recipe, view) = request.recipe()?;
    let [width, height] = files.size;
    let around = view.around.or(files.eye.map(|_| Around::Horizon));
    let view = View { width, height, around, ..view };
    // What cannot be drawn is reported before an hour of simulation.
    let device = drawing(&files.running)?;
    device.check(files.size, files.samples)?;
    let options = Options::into_folder(default_folder(&files.recipe));
    let landscape = watched(&recipe, options, &files.running, |run, shown| run.landscape(shown))?;
    let scene = LitScene::with_crags(&view, &landscape)?;
    let cameras = viewpoint::cameras(files, &view, &scene)?;
    let scene = scene.seen_from(cameras[0]);
    let (samples, is_film) = (files.samples, moves(files));
    let request = RenderRequest { view: &view, scene: &scene, landscape: &landscape, samples, is_film };
    write(files, &output, &cameras, device.set_up(&request)?.as_mut())
}

/// Whether there are several frames.
fn moves(files: &RenderFiles) -> bool {
    files.turntable.is_some() || !files.through.is_empty()
}

/// The file, whose kind must suit the number of frames.
fn output(files: &RenderFiles) -> Result<PathBuf, Failure> {
    let usual = || Path::new(files.recipe.file_stem().unwrap_or_default()).with_extension("png");
    let output = files.output.clone().unwrap_or_else(usual);
    let legal = if moves(files) { FILM_EXTENSIONS } else { &["png"] };
    let extension = output.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    if extension.is_some_and(|extension| legal.contains(&extension.as_str())) {
        return Ok(output);
    }
    Err(Failure::usage(format!(
        "-o is {}; {} is written as .{}",
        output.display(),
        if moves(files) { "an animation" } else { "a still" },
        legal.join(" or .")
    )))
}

fn write(
    files: &RenderFiles,
    output: &Path,
    cameras: &[Camera],
    rendering: &mut dyn Rendering,
) -> Result<(), Failure> {
    let count = cameras.len() as u64;
    let shown = ProgressPrinter::new(files.running.quiet);
    shown.output(1, 1, output);
    let mut next = |number: u64| {
        shown.progress(number, count, 0);
        if interrupt::asked() {
            return Err(Error::Interrupted("interrupted; every file that is there is whole".to_owned()));
        }
        rendering.draw(&cameras[number as usize], number as f64 / FRAMES_PER_SECOND).map(Cutout::from)
    };
    let note = if moves(files) {
        Frames { count, per_second: FRAMES_PER_SECOND, text: &[] }.write(output, &mut next)
    } else {
        next(0).and_then(|still| weald::io::write_whole(output, &still.to_png(&[]))).map(|()| None)
    };
    shown.end();
    let note = note?;
    if let Some(note) = note {
        shown.note(note);
    }
    let is_whole = !moves(files) || Film::is_apng(output) || (Film::is_video(output) && note.is_none());
    let frames = if moves(files) && !Film::is_apng(output) { count } else { 0 };
    let names = (0..frames).map(|number| Film::frame(output, number));
    let names = names.chain(is_whole.then(|| output.to_owned()));
    let names: Vec<_> = names.map(|file| file.display().to_string()).collect();
    if files.running.quiet { Ok(()) } else { stdout::print(&(names.join("\n") + "\n")) }
}

//! `weald render`.

use std::path::{Path, PathBuf};

use weald::Error;
use weald::picture::{Camera, Cutout, Image, Stage, View, write_apng};
use weald::recipe::{Film, Options, ViewRequest};
use weald_gpu::{Gpu, RenderOptions, Renderer};

use super::run::{default_folder, watched};
use crate::arguments::{RenderArguments, RenderFiles};
use crate::engine::with_memory;
use crate::failure::Failure;
use crate::{interrupt, shot, stdout};

/// Draws the picture of a frame and its camera.
type Draw<'a> = dyn FnMut(usize, &Camera) -> Result<Image, Error> + 'a;

/// Frames of an animated picture that are shown in a second.
const FRAMES_PER_SECOND: f64 = 24.0;

pub(crate) fn render(arguments: &RenderArguments) -> Result<(), Failure> {
    let files = &arguments.files;
    let output = output(files)?;
    let request = ViewRequest {
        recipe: files.recipe.clone(),
        overrides: files.values.overrides(files.cells),
        keys: arguments.view.clone(),
    };
    let (recipe, view) = request.recipe()?;
    let [width, height] = files.size;
    let view = View { width, height, ..view };
    // What cannot be drawn is told before an hour of simulation.
    let device = device(files)?;
    let options = Options::into_folder(default_folder(&files.recipe));
    let landscape = watched(&recipe, options, &files.running, |run, shown| run.landscape(shown))?;
    let stage = Stage::new(&view, &landscape)?;
    let cameras = shot::cameras(files, &view, &stage)?;
    let stage = stage.seen_from(cameras[0]);
    let mut draw: Box<Draw<'_>> = match device {
        Some((gpu, options)) => {
            let mut renderer = Renderer::new(&gpu, &stage, options)?;
            renderer.plant(&stage, &landscape)?;
            Box::new(move |number, camera| {
                renderer.set_moment(number as f32 / FRAMES_PER_SECOND as f32);
                renderer.render(camera)
            })
        }
        None => Box::new(move |_, &camera| view.seen_from(&landscape, camera)),
    };
    write(files, &output, &cameras, &mut *draw)
}

/// The device that draws; none where the processor is to and there is no device.
fn device(files: &RenderFiles) -> Result<Option<(Gpu, RenderOptions)>, Failure> {
    let options = RenderOptions { size: files.size, samples: files.samples };
    match Gpu::for_drawing() {
        Ok(gpu) => {
            let gpu = with_memory(gpu, files.running.gpu_memory)?;
            options.check(&gpu)?;
            Ok(Some((gpu, options)))
        }
        Err(_) if files.fallback.is_some() => Ok(None),
        Err(error) => Err(error.into()),
    }
}

/// The file, whose kind must suit the number of frames.
fn output(files: &RenderFiles) -> Result<PathBuf, Failure> {
    let usual = || Path::new(files.recipe.file_stem().unwrap_or_default()).with_extension("png");
    let output = files.output.clone().unwrap_or_else(usual);
    let moves = files.turntable.is_some() || !files.through.is_empty();
    let legal: &[&str] = if moves { &["png", "apng"] } else { &["png"] };
    let extension = output.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    if extension.is_some_and(|extension| legal.contains(&extension.as_str())) {
        return Ok(output);
    }
    Err(Failure::usage(format!(
        "-o is {}; {} is a .{} file",
        output.display(),
        if moves { "what moves" } else { "a still" },
        legal.join(" or an .")
    )))
}

fn write(files: &RenderFiles, output: &Path, cameras: &[Camera], draw: &mut Draw<'_>) -> Result<(), Failure> {
    let mut next = |number: usize| {
        if interrupt::asked() {
            return Err(Error::Interrupted("interrupted; every file that is there is whole".to_owned()));
        }
        draw(number, &cameras[number])
    };
    if Film::is_apng(output) {
        let frames = (cameras.len() as u64, FRAMES_PER_SECOND);
        write_apng(output, frames, |number| next(number as usize).map(Cutout::from))?;
        return told(files, output);
    }
    for number in 0..cameras.len() {
        let file = if cameras.len() == 1 { output.to_owned() } else { Film::frame(output, number as u64) };
        weald::io::write_whole(&file, &next(number)?.to_png(&[]))?;
        told(files, &file)?;
    }
    Ok(())
}

fn told(files: &RenderFiles, file: &Path) -> Result<(), Failure> {
    if files.running.quiet { Ok(()) } else { stdout::print(&format!("{}\n", file.display())) }
}

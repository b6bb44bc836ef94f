//! Films: numbered frames, and a video where the recipe asks for one and ffmpeg is there.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::error::Error;
use crate::io::{write_through, write_whole};
use crate::landscape::Landscape;
use crate::picture::{Cutout, Image, Picture};
use crate::recipe::plan::{Content, Film, Motion, Output, Recipe};

/// A time-lapse of a recipe.
pub(super) struct Lapse<'a> {
    file: &'a Path,
    picture: &'a dyn Picture,
    every: u64,
}

/// The time-lapses of a recipe during one of its steps.
pub(super) struct Lapses<'a> {
    films: Vec<Lapse<'a>>,
    folder: &'a Path,
    /// Iterations of each step that can be watched.
    watched: Vec<u64>,
    step: usize,
}

impl<'a> Lapses<'a> {
    /// Those of step `step` of the recipe, counted from 0.
    pub(super) fn during(recipe: &'a Recipe, step: usize, folder: &'a Path) -> Self {
        let films = recipe.outputs.iter().filter_map(Lapse::of).collect();
        let watched = recipe.steps.iter().map(|planned| planned.step.watched()).collect();
        Self { films, folder, watched, step }
    }

    /// The first number of iterations, from `done` on, that is a frame of one of them.
    pub(super) fn next(&self, done: u64) -> Option<u64> {
        self.films.iter().filter_map(|lapse| self.next_of(lapse, done)).min()
    }

    fn next_of(&self, lapse: &Lapse<'_>, done: u64) -> Option<u64> {
        let next = done.max(self.first(lapse)).div_ceil(lapse.every) * lapse.every;
        (next <= self.watched[self.step]).then_some(next)
    }

    /// The first simulation shows what it starts from; later ones start from what was shown last.
    fn first(&self, lapse: &Lapse<'_>) -> u64 {
        let is_first = self.watched[..self.step].iter().all(|&iterations| iterations == 0);
        if is_first { 0 } else { lapse.every }
    }

    /// Draws the frames that are due after `done` iterations.
    pub(super) fn draw(&self, done: u64, landscape: &Landscape) -> Result<(), Error> {
        let due = self.films.iter().filter(|lapse| self.next_of(lapse, done) == Some(done));
        for lapse in due {
            let earlier: u64 = self.watched[..self.step].iter().map(|all| all / lapse.every).sum();
            let path = self.folder.join(Film::frame(lapse.file, earlier + done / lapse.every));
            write_whole(&path, &lapse.picture.render(landscape)?.to_png(&[]))?;
        }
        Ok(())
    }
}

impl<'a> Lapse<'a> {
    fn of(output: &'a Output) -> Option<Self> {
        let Content::Film { picture, film, .. } = &output.content else { return None };
        let Motion::Lapse(every) = film.motion else { return None };
        Some(Self { file: &output.file, picture: picture.as_ref(), every })
    }
}

/// Frames of a time-lapse of the whole recipe.
pub(super) fn lapse_frames(recipe: &Recipe, every: u64) -> u64 {
    1 + recipe.steps.iter().map(|planned| planned.step.watched() / every).sum::<u64>()
}

/// A frame that was written, read again.
pub(super) fn drawn(path: &Path, number: u64) -> Result<Cutout, Error> {
    let frame = Film::frame(path, number);
    let unread =
        |cause: &dyn std::fmt::Display| Error::input(&frame, format!("cannot be read again: {cause}"));
    let file = std::fs::File::open(&frame).map_err(|cause| unread(&cause))?;
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(file)).read_info().map_err(|cause| unread(&cause))?;
    let [width, height] = [reader.info().width, reader.info().height].map(|side| side as usize);
    let mut rgb = vec![0; 3 * width * height];
    reader.next_frame(&mut rgb).map_err(|cause| unread(&cause))?;
    Ok(Image { width, height, rgb }.into())
}

/// Whether videos can be made.
pub(super) fn ffmpeg_is_there() -> bool {
    let version = Command::new("ffmpeg").arg("-version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    version.is_ok_and(|status| status.success())
}

/// What is told where a video cannot be made.
pub(super) const NO_FFMPEG: &str = "ffmpeg is not there, so the frames are written and no video; install it (Debian, Ubuntu: \
     sudo apt-get install ffmpeg) and run again";

/// Makes a video of numbered frames.
pub(super) fn video(path: &Path, film: &Film, frames: u64) -> Result<(), Error> {
    let is_webm = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("webm"));
    let codec: &[&str] = if is_webm {
        &["-f", "webm", "-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1"]
    } else {
        &["-f", "mp4", "-c:v", "libx264", "-crf", "17", "-preset", "slow", "-movflags", "+faststart"]
    };
    write_through(path, |temporary| {
        let mut ffmpeg = Command::new("ffmpeg");
        ffmpeg.args(["-nostdin", "-loglevel", "error", "-y", "-framerate"]);
        ffmpeg.arg(film.frames_per_second.to_string()).arg("-start_number").arg("0");
        ffmpeg.arg("-i").arg(pattern(path)).arg("-frames:v").arg(frames.to_string());
        // Both codecs halve the resolution of colour, which needs even sides.
        ffmpeg.args(["-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p"]).args(codec);
        let output = ffmpeg.arg(temporary).output().map_err(|cause| Error::write(path, &cause))?;
        if output.status.success() {
            return Ok(());
        }
        let said = String::from_utf8_lossy(&output.stderr);
        let (path, said) = (path.display(), said.trim());
        Err(Error::Run(format!("cannot write {path}: ffmpeg says: {said}; its frames are whole")))
    })
}

/// The name of all frames, as ffmpeg wants it.
fn pattern(path: &Path) -> std::path::PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().replace('%', "%%");
    path.with_file_name(format!("{stem}-%05d.png"))
}

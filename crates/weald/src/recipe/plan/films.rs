//! Outputs that move: a picture of every so many iterations of the simulations, or one that turns.

use std::path::{Path, PathBuf};

use super::steps::Planned;
use weald_core::parameter::{Diagnostics, Parameters, keys_of};
use weald_core::source::Table;
use weald_picture::Picture;

weald_core::parameters! {
    /// Keys that make a film of a picture.
    pub struct FilmKeys {
        /// Iterations of the simulations from one frame to the next; of `fluvial`, years.
        every: Option<u64> = None, range 1..=1_000_000_000;
        /// Number of frames: of one turn of the camera; with `wind`, of one loop; with `through`, of the flight.
        frames: Option<u32> = None, range 2..=9999;
        /// Frame rate. By default 24.
        frames_per_second: Option<f64> = None, range 1.0..=240.0, unit "1/s", with every | frames;
    }
}

/// Frames per second of a video, where the recipe says nothing.
const DEFAULT_RATE: f64 = 24.0;

/// Extensions of a film: numbered pictures alone, one file of all pictures, or pictures and a video.
pub const EXTENSIONS: &[&str] = &["png", "apng", "mp4", "webm"];

/// How a picture moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// A frame every so many iterations of the simulations, or years of those that tell them.
    TimeLapse(u64),
    /// So many frames once around.
    Turn(u32),
}

impl Motion {
    /// Frames of a film of a recipe with these steps.
    pub fn frames(self, steps: &[Planned]) -> u64 {
        match self {
            Self::TimeLapse(every) => {
                1 + steps.iter().map(|planned| planned.step.watched() / every).sum::<u64>()
            }
            Self::Turn(frames) => u64::from(frames),
        }
    }
}

/// Whether an output moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Moves {
    Still,
    Film(Film),
}

/// A film as a recipe asks for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// What changes from frame to frame.
    pub motion: Motion,
    /// Frames per second of the video.
    pub frames_per_second: f64,
}

impl Film {
    /// Name of a frame, counted from 0: `rise.mp4` has `rise-00000.png` and so on.
    pub fn frame(file: &Path, number: u64) -> PathBuf {
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        file.with_file_name(format!("{stem}-{number:05}.png"))
    }

    /// Whether a video is made of the frames.
    pub fn is_video(file: &Path) -> bool {
        !["png", "apng"].iter().any(|still| has_extension(file, still))
    }

    /// Whether one file of the PNG kind holds all frames.
    pub fn is_apng(file: &Path) -> bool {
        has_extension(file, "apng")
    }
}

fn has_extension(file: &Path, wanted: &str) -> bool {
    file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

/// Takes the keys of a film out of the table of a picture: what it is, unless its keys are in conflict, which is reported
/// here.
pub(super) fn take(table: &mut Table, diagnostics: &mut Diagnostics) -> Option<Moves> {
    let own = keys_of::<FilmKeys>(table);
    for (key, _) in &own.entries {
        table.take(key);
    }
    let keys = FilmKeys::read(&own, diagnostics);
    let motion = match (keys.every, keys.frames) {
        (Some(every), None) => Motion::TimeLapse(every),
        (None, Some(frames)) => Motion::Turn(frames),
        (Some(_), Some(_)) => {
            let message = "`every` and `frames` exclude each other: a film is a time-lapse or turns";
            diagnostics.add(own.line_of("frames"), message);
            return None;
        }
        // A key of a wrong kind or range is reported, and is no reason to ask for a still.
        (None, None) if own.get("every").or(own.get("frames")).is_some() => return None,
        (None, None) => return Some(Moves::Still),
    };
    Some(Moves::Film(Film { motion, frames_per_second: keys.frames_per_second.unwrap_or(DEFAULT_RATE) }))
}

/// What the `file` of a still should be, where it is one of a film.
pub(super) fn missing_keys(file: &Path, picture: &dyn Picture) -> Option<String> {
    if !EXTENSIONS.iter().any(|film| has_extension(file, film)) {
        return None;
    }
    // `frames` moves cameras and fractals, `every` shows what simulations do to a landscape.
    let turns = picture.turned(0.0, 1.0).is_some().then_some("`frames` (a turn of the camera, or the wind)");
    let lapses = picture.fractals().is_empty().then_some("`every` (a frame every so many iterations)");
    let keys: Vec<_> = turns.into_iter().chain(lapses).collect();
    let file = file.display();
    Some(format!("`file` is {file}, a film: add {}, or choose a .png", keys.join(" or ")))
}

/// What stands against the film of a picture, or against a still of it, with its line in the table of the output.
pub(super) fn fault(
    film: Option<&Film>,
    (name, table): (&str, &Table),
    picture: &dyn Picture,
) -> Option<(usize, String)> {
    let moves = film.is_some_and(|film| matches!(film.motion, Motion::Turn(_)));
    if moves && picture.turned(0.0, 1.0).is_none() {
        let fault = format!("a {name} has no camera that `frames` could turn; `every` shows it in time");
        return Some((table.line_of("frames"), fault));
    }
    let flies = picture.as_render().is_some_and(|render| render.keys.through.is_some());
    let fault = "`through` needs `frames`: how many pictures the flight has";
    (flies && !moves).then(|| (table.line_of("through"), fault.to_owned()))
}

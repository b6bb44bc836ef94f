//! Time-lapses, and pictures of one moment.

use std::path::{Path, PathBuf};

use super::options::Options;
use super::work::new_files;
use crate::recipe::checkpoint::State;
use crate::recipe::plan::{Content, Film, Motion, Output, Recipe};
use weald_core::error::Error;
use weald_core::files;
use weald_core::landscape::Landscape;
use weald_engine::step::Step;
use weald_io::{make_folders, write_whole};
use weald_picture::{Cutout, Frame, Image, Picture, RenderDevice, Watch};

/// A time-lapse of a recipe.
pub(super) struct TimeLapse<'a> {
    file: &'a Path,
    picture: &'a dyn Picture,
    every: u64,
}

/// The time-lapses of a recipe during one of its steps.
pub(super) struct TimeLapses<'a> {
    films: Vec<TimeLapse<'a>>,
    folder: PathBuf,
    device: Option<&'a dyn RenderDevice>,
    /// Iterations of each step that can be watched.
    watched: Vec<u64>,
    step: usize,
    /// The step, unless all are done.
    running: Option<&'a dyn Step>,
}

impl<'a> TimeLapses<'a> {
    /// Those of step `step` of the recipe, counted from 0.
    pub(super) fn during(recipe: &'a Recipe, step: usize, options: &'a Options) -> Self {
        let (folder, device) = (new_files(&options.out, recipe), options.render.as_deref());
        let films = recipe.outputs.iter().filter_map(TimeLapse::of).collect();
        let watched = recipe.steps.iter().map(|planned| planned.step.watched()).collect();
        let running = recipe.steps.get(step).map(|planned| &*planned.step);
        Self { films, folder, device, watched, step, running }
    }

    /// The first number of iterations, from `done` on, that is a frame of one of them.
    pub(super) fn next(&self, done: u64) -> Option<u64> {
        self.films.iter().filter_map(|lapse| self.next_of(lapse, done)).min()
    }

    fn next_of(&self, lapse: &TimeLapse<'_>, done: u64) -> Option<u64> {
        let next = done.max(self.first(lapse)).div_ceil(lapse.every) * lapse.every;
        (next <= self.watched[self.step]).then_some(next)
    }

    /// The first simulation shows what it starts from; later ones start from what was shown last.
    fn first(&self, lapse: &TimeLapse<'_>) -> u64 {
        let is_first = self.watched[..self.step].iter().all(|&iterations| iterations == 0);
        if is_first { 0 } else { lapse.every }
    }

    /// Refuses to go on from a checkpoint whose frames are gone.
    pub(super) fn ensure_drawn(&self, state: &State, checkpoint: &Path) -> Result<(), Error> {
        let iteration = state.simulation.as_ref().map_or(0, |simulation| simulation.iteration);
        // A step that does not tell what has passed finds its frames where they were.
        let own = self.running.map_or(Some(iteration), |step| step.watched_after(iteration)).unwrap_or(0);
        let has_begun = iteration > 0 || self.watched[..self.step].iter().any(|&iterations| iterations > 0);
        for lapse in self.films.iter().filter(|_| has_begun) {
            let earlier: u64 = self.watched[..self.step].iter().map(|all| all / lapse.every).sum();
            // The frame of the iteration itself is drawn again.
            let drawn = earlier + own.div_ceil(lapse.every);
            let frame = |number| self.folder.join(Film::frame(lapse.file, number));
            if let Some(missing) = (0..drawn).map(frame).find(|frame| !files::exists(frame)) {
                let missing = missing.display();
                let what = format!("its frame {missing} is gone; run without --resume, which draws it again");
                return Err(Error::input(checkpoint, what));
            }
        }
        Ok(())
    }

    /// Draws the frames that are due after `done` iterations.
    pub(super) fn draw(&self, done: u64, landscape: &Landscape) -> Result<(), Error> {
        let due = self.films.iter().filter(|lapse| self.next_of(lapse, done) == Some(done));
        for lapse in due {
            let earlier: u64 = self.watched[..self.step].iter().map(|all| all / lapse.every).sum();
            let path = self.folder.join(Film::frame(lapse.file, earlier + done / lapse.every));
            let image = still(lapse.picture, landscape, self.device, &mut |_, _| Ok(()))?.image;
            make_folder_of(&path)?;
            write_whole(&path, &image.to_png(&[]))?;
        }
        Ok(())
    }
}

/// Makes the folder in which a file is to lie.
pub(super) fn make_folder_of(path: &Path) -> Result<(), Error> {
    let folder = path.parent().unwrap_or(Path::new("."));
    make_folders(folder).map_err(|cause| Error::write(folder, &cause))
}

/// A picture of what is there now, by the processor or by a device.
pub(super) fn still(
    picture: &dyn Picture,
    landscape: &Landscape,
    device: Option<&dyn RenderDevice>,
    watch: &mut Watch<'_>,
) -> Result<Cutout, Error> {
    match (picture.as_render(), device) {
        (Some(render), Some(device)) => {
            let frame_sequence = render.frame_sequence(landscape, device)?;
            let image =
                frame_sequence.set_up()?.draw(&frame_sequence.camera(Frame::STILL), Frame::STILL.seconds)?;
            Ok(image.into())
        }
        _ => picture.cutout(landscape, watch),
    }
}

impl<'a> TimeLapse<'a> {
    fn of(output: &'a Output) -> Option<Self> {
        let Content::Film { picture, film, .. } = &output.content else { return None };
        let Motion::TimeLapse(every) = film.motion else { return None };
        Some(Self { file: &output.file, picture: picture.as_ref(), every })
    }
}

/// A frame that was written, read again.
pub(super) fn drawn(path: &Path, number: u64) -> Result<Cutout, Error> {
    let frame = Film::frame(path, number);
    let unread =
        |cause: &dyn std::fmt::Display| Error::input(&frame, format!("cannot be read again: {cause}"));
    let file = files::File::open(&frame).map_err(|cause| unread(&cause))?;
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(file)).read_info().map_err(|cause| unread(&cause))?;
    let [width, height] = [reader.info().width, reader.info().height].map(|side| side as usize);
    let mut rgb = vec![0; 3 * width * height];
    reader.next_frame(&mut rgb).map_err(|cause| unread(&cause))?;
    Ok(Image { width, height, rgb }.into())
}

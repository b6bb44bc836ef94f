//! Landscapes of several seeds, one after the other, whenever there is nothing else to do.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use weald::picture::{Image, Pen, Picture, Relief};
use weald::recipe::{Overrides, Recipe};
use weald::{Error, files};

use super::{Worker, nothing_ran};
use crate::work::shared::Told;
use crate::work::status::Seeds;

/// Pixels along a picture's longer side, and between two pictures of the sheet.
const SIDE: u32 = 192;
const GAP: usize = 8;

/// Name of the sheet.
const SHEET: &str = "contact-sheet.png";

/// Seeds that wait.
pub(super) struct Batch {
    folder: PathBuf,
    waiting: VecDeque<u64>,
    images: Vec<Image>,
}

impl Worker {
    pub(super) fn begin_seeds(&mut self, folder: PathBuf, first: u64, count: u64) -> Result<(), Error> {
        if self.opening.is_none() {
            return Err(nothing_ran());
        }
        files::create_dir_all(&folder).map_err(|cause| Error::write(&folder, &cause))?;
        let number = self.shared.asked.load(Ordering::Acquire);
        let seeds = Seeds { number, folder: folder.clone(), count, runs: true, ..Seeds::default() };
        self.shared.change(|status| status.seeds = Some(seeds));
        let waiting = (first..first.saturating_add(count)).collect();
        self.batch = Some(Batch { folder, waiting, images: Vec::new() });
        Ok(())
    }

    pub(super) fn end_seeds(&mut self) {
        self.batch = None;
        self.shared.change(|status| {
            if let Some(seeds) = &mut status.seeds {
                seeds.runs = false;
            }
        });
    }

    /// Makes the landscape of the next seed; where something else is asked meanwhile, it waits for another time.
    pub(super) fn next_seed(&mut self) -> Result<(), Error> {
        let Some(seed) = self.batch.as_ref().and_then(|batch| batch.waiting.front().copied()) else {
            return self.finish_seeds();
        };
        let image = match self.image_of(seed) {
            Err(Error::Interrupted(_)) => return Ok(()),
            image => image,
        };
        let Some(batch) = &mut self.batch else { return Ok(()) };
        batch.waiting.pop_front();
        let file = batch.folder.join(format!("seed-{seed}.png"));
        let done = image.and_then(|image| {
            weald::io::write_whole(&file, &image.to_png(&[]))?;
            batch.images.push(labelled(image, seed));
            Ok(file)
        });
        let done = (seed, done.map_err(|error| error.to_string()));
        self.shared.change(|status| {
            if let Some(seeds) = &mut status.seeds {
                seeds.done.push(done);
            }
        });
        Ok(())
    }

    /// A picture of the landscape of a seed, made coarse as a preview is.
    fn image_of(&self, seed: u64) -> Result<Image, Error> {
        let Some(opening) = &self.opening else { return Err(nothing_ran()) };
        let overrides = Overrides { seed: Some(seed), preview: true, ..Overrides::default() };
        let recipe = Recipe::parse(&opening.file, &opening.text, &overrides)?;
        let number = self.shared.asked.load(Ordering::Acquire);
        let progress = Told { shared: &self.shared, number, watched: &self.shared.asked };
        let steps = opening.steps.unwrap_or(usize::MAX);
        let landscape = recipe.landscape_after(steps, &opening.engine, Some(&self.cache), &progress)?;
        Relief { width: Some(SIDE), ..Relief::default() }.render(&landscape)
    }

    /// Writes all pictures on one sheet.
    fn finish_seeds(&mut self) -> Result<(), Error> {
        let Some(batch) = self.batch.take() else { return Ok(()) };
        let sheet = (!batch.images.is_empty()).then(|| write_sheet(&batch.images, &batch.folder)).transpose();
        self.end_seeds();
        let sheet = sheet?;
        self.shared.change(|status| {
            if let Some(seeds) = &mut status.seeds {
                seeds.sheet = sheet;
            }
        });
        Ok(())
    }
}

/// A picture with its seed written below.
fn labelled(image: Image, seed: u64) -> Image {
    let pen = Pen { unit: 1.5, ink: [0.0; 3] };
    let mut label = Image::paper(image.width, 3 * pen.height() as usize);
    pen.write(&mut label, &seed.to_string(), [2.0, pen.height()]);
    Image::below(&[image, label], 0)
}

/// The sheet is about as wide as it is high.
fn write_sheet(images: &[Image], folder: &Path) -> Result<PathBuf, Error> {
    let columns = (images.len() as f64).sqrt().ceil() as usize;
    let rows: Vec<_> = images.chunks(columns.max(1)).map(|row| Image::beside(row, GAP)).collect();
    let file = folder.join(SHEET);
    weald::io::write_whole(&file, &Image::below(&rows, GAP).to_png(&[]))?;
    Ok(file)
}

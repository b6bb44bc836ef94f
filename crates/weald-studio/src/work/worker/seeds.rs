//! Landscapes of several seeds, one after the other, whenever there is nothing else to do.

use std::path::PathBuf;
use std::sync::atomic::Ordering;

use weald::picture::{Image, Picture, Relief};
use weald::recipe::{Overrides, Recipe};
use weald::{Error, files};

use super::batch::{Batch, SIDE, labelled, write_sheet};
use super::{Worker, nothing_ran};
use crate::work::shared::Told;
use crate::work::status::Seeds;

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

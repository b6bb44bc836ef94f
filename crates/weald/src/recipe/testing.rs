//! A tiny vocabulary for tests of recipes: two steps, one picture, one format.

use std::path::Path;

use super::overrides::Overrides;
use super::parameter::LayerName;
use super::plan::{Recipe, Vocabulary};
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::parameters;
use weald_core::random::hash2;
use weald_engine::step::{Entry, Outcome, Stage, Step};
use weald_engine::{Job, SavedSimulation};
use weald_export::{Export, ExportEntry, Finished};
use weald_io::{Capabilities, Encode, Format, Metadata, Part, PartName, Preset, Raster};
use weald_picture::{Image, Picture, PictureEntry};

pub(super) const VOCABULARY: Vocabulary = Vocabulary {
    steps: &[
        Entry::of::<Rough>("rough", Stage::Generate, "Random heights.", "Weald"),
        Entry::of::<Wear>("wear", Stage::Erode, "A simulation in small.", "Weald"),
    ],
    pictures: &[PictureEntry::of::<Dot>("dot", "One pixel.", "Weald")],
    exports: &[ExportEntry::of::<Tally>("tally", &["txt"], "The number of cells.", "Weald")],
    format_of,
};

/// Parses with the tiny vocabulary.
pub(super) fn parse(text: &str) -> Result<Recipe, Error> {
    Recipe::parse_with(&VOCABULARY, "folder/r.toml", text, &Overrides::default())
}

/// The error of a recipe that must be refused.
pub(super) fn refusal(text: &str) -> String {
    parse(text).expect_err("the recipe is bad").to_string()
}

static BITS: Format = Format {
    name: "bits",
    extensions: &["bits"],
    decode: None,
    encode: Some(Encode::File(|raster| Ok(bits(raster)))),
    holds: Capabilities { omits: &[Metadata::Cell], ..Capabilities::ALL },
    presets: &[Preset {
        name: "twice",
        summary: "every value twice",
        encode: Encode::File(|raster| Ok(bits(raster).repeat(2))),
        holds: Capabilities::ALL,
    }],
};

fn format_of(path: &Path) -> Result<&'static Format, String> {
    let known = path.extension().is_some_and(|extension| extension == "bits");
    if known { Ok(&BITS) } else { Err(format!("`{}` is no .bits", path.display())) }
}

fn bits(raster: &Raster) -> Vec<u8> {
    raster.field.values().iter().flat_map(|value| value.to_bits().to_le_bytes()).collect()
}

parameters! {
    /// Random heights.
    pub struct Rough {
        /// Greatest height.
        relief: f64 = 10.0, range 0.0..=100.0, unit "m";
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

impl Step for Rough {
    fn reads(&self) -> Vec<String> {
        Vec::new()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.into.0.clone(), "m")]
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let height = |x: usize, y: usize| {
            let share = weald_core::random::unit(hash2(job.seed, x as i64, y as i64));
            (self.relief * share) as f32
        };
        landscape.insert(&self.into.0, "m", Field::from_function(landscape.domain.size, height));
        Ok(Outcome { iterations: 1, ..Outcome::default() })
    }
}

parameters! {
    /// Heights that wear down a little in every iteration.
    pub struct Wear {
        /// Iterations.
        iterations: u64 = 10, range 1..=1000;
        /// Iteration after which the heights become NaN, for a test.
        breaks_after: Option<u64> = None, range 0..=1000;
        /// Layer that is worn.
        on: LayerName = LayerName::of("height");
    }
}

impl Step for Wear {
    fn reads(&self) -> Vec<String> {
        vec![self.on.0.clone()]
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        vec![(self.on.0.clone(), "m"), ("debris".to_owned(), "m")]
    }

    fn watched(&self) -> u64 {
        self.iterations
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let size = landscape.domain.size;
        let (mut done, mut heights) = match &job.resume {
            Some(saved) => (saved.iteration, saved.planes[0].1.clone()),
            None => (0, landscape.field(&self.on.0)?.values().to_vec()),
        };
        let mut saved = SavedSimulation::default();
        while done < self.iterations {
            Self::look(done, &heights, landscape, job)?;
            saved.iteration = done;
            saved.planes = vec![("height".to_owned(), heights.clone())];
            if job.watcher.cancelled() {
                job.watcher.checkpoint(&saved)?;
                return Err(Error::Interrupted(String::new()));
            }
            if job.watcher.checkpoint_due() {
                job.watcher.checkpoint(&saved)?;
            }
            let factor = if self.breaks_after == Some(done) { f32::NAN } else { 0.9 };
            for height in &mut heights {
                *height = *height * factor + 0.01;
            }
            done += 1;
            job.watcher.progress(done, self.iterations, size.cells());
        }
        Self::look(done, &heights, landscape, job)?;
        let debris = heights.iter().map(|height| 1.0 - height).collect();
        landscape.insert("debris", "m", Field::from_values(size, debris));
        landscape.insert(&self.on.0, "m", Field::from_values(size, heights));
        Ok(Outcome { iterations: done, ..Outcome::default() })
    }
}

impl Wear {
    fn look(done: u64, heights: &[f32], landscape: &Landscape, job: &Job<'_>) -> Result<(), Error> {
        if job.watcher.next_look(done) != Some(done) {
            return Ok(());
        }
        let mut seen = landscape.clone();
        seen.insert("height", "m", Field::from_values(seen.domain.size, heights.to_vec()));
        job.watcher.look(done, &seen)
    }
}

parameters! {
    /// One pixel.
    pub struct Dot {
        /// Layer that is shown.
        of: LayerName = LayerName::of("height");
        /// Share of a turn that the camera has gone.
        share: f64 = 0.0, range 0.0..=1.0;
    }
}

impl Picture for Dot {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn turned(&self, share: f64, _: f64) -> Option<Box<dyn Picture>> {
        Some(Box::new(Self { share, ..self.clone() }))
    }

    fn render(&self, landscape: &Landscape) -> Result<Image, Error> {
        let height = landscape.field(&self.of.0)?.at(0, 0);
        Ok(Image { width: 1, height: 1, rgb: vec![1, height as u8, (self.share * 8.0) as u8] })
    }
}

parameters! {
    /// The number of cells, and beside it that of the steps.
    pub struct Tally {
        /// Layer that must be there.
        of: LayerName = LayerName::of("height");
    }
}

impl Export for Tally {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn notes(&self, _: &Finished<'_>) -> Vec<String> {
        vec!["counted".to_owned()]
    }

    fn names(&self, _: &Path) -> Vec<PartName> {
        vec![PartName::Own, PartName::Sibling("_steps.txt".to_owned())]
    }

    fn parts(&self, finished: &Finished<'_>, _: &Path) -> Result<Vec<Part>, Error> {
        let cells = finished.landscape.domain.size.cells().to_string();
        let steps = finished.steps.len().to_string();
        Ok(vec![Part::own(cells.into_bytes()), Part::sibling("_steps.txt", steps.into_bytes())])
    }
}

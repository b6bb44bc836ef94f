//! Layers, pictures and exports become files, each with its provenance.

use std::path::{Path, PathBuf};

use web_time::Instant;

use super::film;
use super::video::Frames;
use crate::layer_raster;
use crate::recipe::ground;
use crate::recipe::layer_output::Treatment;
use crate::recipe::memory;
use crate::recipe::plan::{Content, Film, Motion, Output, Recipe};
use crate::recipe::report::OutputReport;
use weald_core::error::Error;
use weald_export::{Export, Finished};
use weald_io::{Capabilities, Encode, Part, PartName, Provenance, Raster, write_parts, write_whole};
use weald_picture::{Cutout, Frame, Picture, RenderDevice};

/// Turns a finished landscape into files.
pub(super) struct Writer<'a> {
    pub(super) finished: Finished<'a>,
    pub(super) recipe: &'a Recipe,
    /// What draws pictures of kind `render`.
    pub(super) device: Option<&'a dyn RenderDevice>,
    /// Is called with how far a film is, and says whether to go on.
    pub(super) next_frame: &'a (dyn Fn(u64, u64) -> Result<(), Error> + Sync),
}

/// What an output is to become.
struct Target<'a> {
    folder: &'a Path,
    file: &'a Path,
}

impl Writer<'_> {
    pub(super) fn write(&self, output: &Output, folder: &Path) -> Result<OutputReport, Error> {
        let (target, started) = (Target { folder, file: &output.file }, Instant::now());
        film::make_folder_of(&folder.join(&output.file))?;
        let report = match &output.content {
            Content::Picture { name, picture } => self.picture(&target, name, picture.as_ref()),
            Content::Layer { name, encode, holds, treatment } => {
                self.layer(&target, name, (*encode, *holds, *treatment))
            }
            Content::Film { name, picture, film } => self.film(&target, name, (picture.as_ref(), film)),
            Content::Export { name, export } => self.export(&target, name, export.as_ref()),
        }?;
        Ok(OutputReport {
            file: output.file.display().to_string(),
            seconds: started.elapsed().as_secs_f64(),
            peak_memory: memory::taken(),
            ..report
        })
    }

    fn picture(&self, target: &Target<'_>, name: &str, picture: &dyn Picture) -> Result<OutputReport, Error> {
        let path = target.folder.join(target.file);
        if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg")) {
            write_whole(&path, picture.svg(self.finished.landscape)?.as_bytes())?;
        } else {
            let mut go_on = |done, all| (self.next_frame)(done, all);
            let cutout = film::still(picture, self.finished.landscape, self.device, &mut go_on)?;
            write_whole(&path, &cutout.to_png(&self.text()))?;
        }
        let adapter = self.drawn_by(picture);
        let notes = picture.notes(self.finished.landscape);
        Ok(OutputReport { picture: Some(name.to_owned()), adapter, notes, ..OutputReport::default() })
    }

    /// What a picture says of its origin.
    fn text(&self) -> [(String, String); 3] {
        [
            ("Software".to_owned(), format!("Weald {}", env!("CARGO_PKG_VERSION"))),
            ("WEALD_RECIPE_BLAKE3".to_owned(), self.finished.hash.to_owned()),
            ("WEALD_SEED".to_owned(), self.finished.seed.to_string()),
        ]
    }

    /// The frames of a time-lapse are there by now; those of a turn are drawn.
    fn film(
        &self,
        target: &Target<'_>,
        name: &str,
        (picture, film): (&dyn Picture, &Film),
    ) -> Result<OutputReport, Error> {
        let path = target.folder.join(target.file);
        let frames = film.motion.frames(&self.recipe.steps);
        let (per_second, text) = (film.frames_per_second, self.text());
        let kept = Frames { count: frames, per_second, text: &text };
        let note = match film.motion {
            Motion::Turn(_) => self.turn(&path, picture, &kept)?,
            Motion::TimeLapse(_) if Film::is_apng(target.file) => {
                kept.write(&path, &mut |frame| film::drawn(&path, frame))?
            }
            Motion::TimeLapse(_) => kept.video(&path)?,
        };
        // A note says that no video could be made.
        let has_own = Film::is_apng(target.file) || (Film::is_video(target.file) && note.is_none());
        let mut notes: Vec<_> = note.into_iter().map(str::to_owned).collect();
        notes.extend(picture.notes(self.finished.landscape));
        Ok(OutputReport {
            name_only: !has_own,
            picture: Some(name.to_owned()),
            adapter: self.drawn_by(picture),
            frames: Some(frames),
            notes,
            ..OutputReport::default()
        })
    }

    /// A picture that moves by itself.
    fn turn(
        &self,
        path: &Path,
        picture: &dyn Picture,
        kept: &Frames<'_>,
    ) -> Result<Option<&'static str>, Error> {
        let (landscape, count) = (self.finished.landscape, kept.count);
        if let (Some(render), Some(device)) = (picture.as_render(), self.device) {
            let frame_sequence = render.frame_sequence(landscape, device)?;
            let mut rendering = frame_sequence.set_up_film()?;
            return kept.write(path, &mut |number| {
                (self.next_frame)(number, count)?;
                let seconds = number as f64 / kept.per_second;
                let camera = frame_sequence.camera(Frame { number, count, seconds });
                rendering.draw(&camera, seconds).map(Cutout::from)
            });
        }
        let seconds = count as f64 / kept.per_second;
        kept.write(path, &mut |number| {
            (self.next_frame)(number, count)?;
            let turned = picture.turned(number as f64 / count as f64, seconds);
            let turned = turned.expect("the plan takes only pictures that turn");
            turned.cutout(landscape, &mut |_, _| (self.next_frame)(number, count))
        })
    }

    /// What drew a picture that is not the same on every device.
    fn drawn_by(&self, picture: &dyn Picture) -> Option<String> {
        Some(picture.as_render().and(self.device)?.adapter())
    }

    fn layer(
        &self,
        target: &Target<'_>,
        name: &str,
        (encode, holds, treatment): (Encode, Capabilities, Treatment),
    ) -> Result<OutputReport, Error> {
        let (raster, resampled) = treatment.of(self.raster(name)?, ground::source(self.recipe))?;
        let parts = encode.parts(&raster)?;
        write_parts(&target.folder.join(target.file), &parts)?;
        let mut notes = holds.losses(&raster);
        notes.extend(resampled);
        let unit = self.finished.landscape.layer(name)?.unit.clone();
        Ok(OutputReport {
            layer: Some(name.to_owned()),
            unit: Some(unit),
            range: self.range(name)?,
            companions: target.companions(&parts),
            notes,
            ..OutputReport::default()
        })
    }

    fn export(&self, target: &Target<'_>, name: &str, export: &dyn Export) -> Result<OutputReport, Error> {
        let parts = export.parts(&self.finished, target.file)?;
        write_parts(&target.folder.join(target.file), &parts)?;
        Ok(OutputReport {
            export: Some(name.to_owned()),
            name_only: parts
                .iter()
                .all(|part| matches!(part.name, PartName::Beside(_) | PartName::Sibling(_))),
            companions: target.companions(&parts),
            notes: export.notes(&self.finished),
            ..OutputReport::default()
        })
    }

    fn range(&self, name: &str) -> Result<Option<(f64, f64)>, Error> {
        let range = self.finished.landscape.field(name)?.range(self.finished.landscape.domain.valid.as_ref());
        Ok(range.map(|(low, high)| (low.into(), high.into())))
    }

    /// The layer with 0 in its no-data cells.
    pub(super) fn raster(&self, name: &str) -> Result<Raster, Error> {
        let provenance = Provenance {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            recipe_blake3: self.finished.hash.to_owned(),
            seed: self.finished.seed,
            layer: name.to_owned(),
            unit: self.finished.landscape.layer(name)?.unit.clone(),
            range: self.range(name)?.unwrap_or((0.0, 0.0)),
            resampled: None,
        };
        let raster = layer_raster::raster(self.finished.landscape, name)?;
        Ok(Raster { provenance: Some(provenance), ..raster })
    }
}

impl Target<'_> {
    /// Files beside the output itself; those inside it go without saying.
    fn companions(&self, parts: &[Part]) -> Vec<String> {
        let beside = |part: &&Part| matches!(part.name, PartName::Beside(_) | PartName::Sibling(_));
        parts.iter().filter(beside).map(|part| part.name.path(self.file).display().to_string()).collect()
    }
}

impl OutputReport {
    /// The files that were written, by their paths inside the output folder.
    pub fn files(&self) -> Vec<PathBuf> {
        let file = Path::new(&self.file);
        let own = (!self.name_only).then(|| file.to_owned());
        let frames = self.frames.filter(|_| !Film::is_apng(file)).unwrap_or(0);
        let frames = (0..frames).map(|number| Film::frame(file, number));
        own.into_iter().chain(frames).chain(self.companions.iter().map(PathBuf::from)).collect()
    }
}

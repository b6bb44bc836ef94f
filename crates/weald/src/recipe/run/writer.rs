//! Layers, pictures and exports become files, each with its provenance.

use std::path::Path;

use super::film;
use crate::error::Error;
use crate::export::{Export, Finished};
use crate::grid::Field;
use crate::io::{Encode, Holds, Part, PartName, Provenance, Raster, write_parts, write_whole};
use crate::picture::Picture;
use crate::recipe::plan::{Content, Film, Motion, Output, Recipe};
use crate::recipe::report::OutputReport;

/// Turns a finished landscape into files.
pub(super) struct Writer<'a> {
    pub(super) finished: Finished<'a>,
    pub(super) recipe: &'a Recipe,
    /// Hears how far a film is, and says whether to go on.
    pub(super) next_frame: &'a dyn Fn(u64, u64) -> Result<(), Error>,
}

/// What an output is to become.
struct Target<'a> {
    folder: &'a Path,
    file: &'a Path,
}

impl Writer<'_> {
    pub(super) fn write(&self, output: &Output, folder: &Path) -> Result<OutputReport, Error> {
        let target = Target { folder, file: &output.file };
        let report = match &output.content {
            Content::Picture { name, picture } => self.picture(&target, name, picture.as_ref()),
            Content::Layer { name, encode, holds } => self.layer(&target, name, (*encode, *holds)),
            Content::Film { name, picture, film } => self.film(&target, name, (picture.as_ref(), film)),
            Content::Export { name, export } => self.export(&target, name, export.as_ref()),
        }?;
        Ok(OutputReport { file: output.file.display().to_string(), ..report })
    }

    fn picture(&self, target: &Target<'_>, name: &str, picture: &dyn Picture) -> Result<OutputReport, Error> {
        self.draw(picture, &target.folder.join(target.file))?;
        Ok(OutputReport { picture: Some(name.to_owned()), ..OutputReport::default() })
    }

    fn draw(&self, picture: &dyn Picture, path: &Path) -> Result<(), Error> {
        let text = [
            ("Software".to_owned(), format!("Weald {}", env!("CARGO_PKG_VERSION"))),
            ("WEALD_RECIPE_BLAKE3".to_owned(), self.finished.hash.to_owned()),
            ("WEALD_SEED".to_owned(), self.finished.seed.to_string()),
        ];
        write_whole(path, &picture.render(self.finished.landscape)?.to_png(&text))
    }

    /// The frames of a time-lapse are there by now; those of a turn are drawn.
    fn film(
        &self,
        target: &Target<'_>,
        name: &str,
        (picture, film): (&dyn Picture, &Film),
    ) -> Result<OutputReport, Error> {
        let path = target.folder.join(target.file);
        let frames = match film.motion {
            Motion::Lapse(every) => film::lapse_frames(self.recipe, every),
            Motion::Turn(frames) => self.turn(picture, &path, u64::from(frames))?,
        };
        let wanted = Film::is_video(target.file);
        let possible = wanted && film::ffmpeg_is_there();
        if possible {
            film::video(&path, film, frames)?;
        }
        let notes = if wanted && !possible { vec![film::NO_FFMPEG.to_owned()] } else { Vec::new() };
        let picture = Some(name.to_owned());
        Ok(OutputReport { picture, frames: Some(frames), notes, ..OutputReport::default() })
    }

    fn turn(&self, picture: &dyn Picture, path: &Path, frames: u64) -> Result<u64, Error> {
        for frame in 0..frames {
            (self.next_frame)(frame, frames)?;
            let turned = picture.turned(frame as f64 / frames as f64);
            self.draw(
                turned.expect("the plan takes only pictures that turn").as_ref(),
                &Film::frame(path, frame),
            )?;
        }
        Ok(frames)
    }

    fn layer(
        &self,
        target: &Target<'_>,
        name: &str,
        (encode, holds): (Encode, Holds),
    ) -> Result<OutputReport, Error> {
        let raster = self.raster(name)?;
        let parts = encode.parts(&raster)?;
        write_parts(&target.folder.join(target.file), &parts)?;
        let notes = holds.losses(&raster);
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
            companions: target.companions(&parts),
            notes: export.notes(&self.finished),
            ..OutputReport::default()
        })
    }

    fn range(&self, name: &str) -> Result<Option<(f64, f64)>, Error> {
        let range = self.finished.landscape.field(name)?.range(self.finished.landscape.domain.land.as_ref());
        Ok(range.map(|(low, high)| (low.into(), high.into())))
    }

    /// The layer with 0 in its no-data cells.
    pub(super) fn raster(&self, name: &str) -> Result<Raster, Error> {
        let layer = self.finished.landscape.layer(name)?;
        let domain = &self.finished.landscape.domain;
        let provenance = Provenance {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            recipe_blake3: self.finished.hash.to_owned(),
            seed: self.finished.seed,
            layer: name.to_owned(),
            unit: layer.unit.clone(),
            range: self.range(name)?.unwrap_or((0.0, 0.0)),
        };
        let mut field: Field = layer.field.clone();
        if let Some(land) = &domain.land {
            for (value, &is_land) in field.values_mut().iter_mut().zip(land.flags()) {
                *value = if is_land { *value } else { 0.0 };
            }
        }
        Ok(Raster {
            land: domain.land.clone(),
            cell: Some(domain.cell),
            georeference: domain.georeference.clone(),
            provenance: Some(provenance),
            ..Raster::from(field)
        })
    }
}

impl Target<'_> {
    /// Files beside the output itself; those inside it go without saying.
    fn companions(&self, parts: &[Part]) -> Vec<String> {
        let beside = |part: &&Part| matches!(part.name, PartName::Beside(_) | PartName::Sibling(_));
        parts.iter().filter(beside).map(|part| part.name.path(self.file).display().to_string()).collect()
    }
}

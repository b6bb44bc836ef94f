//! Files of a landscape that no process holds as a whole: the first rank writes one window after another, or each rank the
//! files of a folder that hold its rows.

use std::path::Path;

use web_time::Instant;

use super::film::make_folder_of;
use super::in_parts::peak_memory;
use super::options::{Progress, Run};
use super::work::new_files;
use crate::recipe::plan::{Content, Output};
use crate::recipe::report::OutputReport;
use weald_core::error::Error;
use weald_core::files::{self, File};
use weald_core::grid::{Field, Mask, Size};
use weald_engine::ranks::agreed;
use weald_engine::served::served;
use weald_engine::stored::{StoredLandscape, StoredPlane};
use weald_engine::strips::Strips;
use weald_export::classes::{DIRECTIONS, directions};
use weald_export::shades::shades;
use weald_io::{
    ByStrips, Encode, Part, PartName, Provenance, Raster, StripPlace, WindowedRaster, WriteWindows,
    write_into, write_through,
};
use weald_land::flow::DirectionCodes;

/// A layer that becomes a file.
struct Written<'a> {
    output: &'a Output,
    plane: &'a StoredPlane,
    /// All that a file says of it but its values.
    head: Raster,
    range: (f32, f32),
}

impl Run<'_> {
    pub(super) fn outputs_in_parts(
        &self,
        landscape: &StoredLandscape<'_>,
        progress: &dyn Progress,
    ) -> Result<Vec<OutputReport>, Error> {
        let outputs = &self.recipe.outputs;
        let made = outputs.iter().enumerate().map(|(number, output)| {
            let stopped = || Error::Interrupted("interrupted; no file has changed".to_owned());
            agreed(&*landscape.ranks, if progress.cancelled() { Err(stopped()) } else { Ok(()) })?;
            progress.output(number + 1, outputs.len(), &output.file);
            self.output_in_parts(output, landscape)
        });
        made.collect()
    }

    fn output_in_parts(
        &self,
        output: &Output,
        landscape: &StoredLandscape<'_>,
    ) -> Result<OutputReport, Error> {
        let started = Instant::now();
        let Content::Layer { name, encode, holds, .. } = &output.content else {
            unreachable!("`scratch` refuses other outputs");
        };
        let (layer, range) = (landscape.layer(name)?, landscape.range(name)?);
        let head = self.head(landscape, name, (&layer.unit, range));
        let written = Written { output, plane: &layer.plane, head, range };
        let parts = match encode {
            Encode::Windows { write, .. } => self.by_windows(landscape, &written, *write)?,
            Encode::Strips { by_strips, .. } => self.by_strips(landscape, &written, *by_strips)?,
            Encode::File(_) | Encode::Parts(_) => unreachable!("`scratch` refuses other formats"),
        };
        let beside = |part: &&Part| matches!(part.name, PartName::Beside(_) | PartName::Sibling(_));
        let companions = parts.iter().filter(beside).map(|part| part.name.path(&output.file));
        Ok(OutputReport {
            file: output.file.display().to_string(),
            seconds: started.elapsed().as_secs_f64(),
            peak_memory: peak_memory(&*landscape.ranks)?,
            layer: Some(name.to_owned()),
            unit: Some(layer.unit.clone()),
            range: Some((range.0.into(), range.1.into())),
            companions: companions.map(|path| path.display().to_string()).collect(),
            notes: holds.losses(&written.head),
            ..OutputReport::default()
        })
    }

    /// Writes a file by windows on the first rank; gives there what lies beside it.
    fn by_windows(
        &self,
        landscape: &StoredLandscape<'_>,
        written: &Written<'_>,
        write: WriteWindows,
    ) -> Result<Vec<Part>, Error> {
        let planes: Vec<_> = std::iter::once(written.plane).chain(landscape.valid()).collect();
        let parts = served(landscape, &planes, |planes, scratch| {
            let (head, range) = (&written.head, written.range);
            let (values, valid) = (planes[0], planes.get(1).copied());
            let windowed = WindowedRaster { head, values, valid, range, scratch };
            self.write_windows(written.output, &windowed, write).map_err(|error| self.by_its_name(error))
        })?;
        Ok(parts.unwrap_or_default())
    }

    /// Writes a file window by window, and what lies beside it.
    fn write_windows(
        &self,
        output: &Output,
        windowed: &WindowedRaster<'_, '_>,
        write: WriteWindows,
    ) -> Result<Vec<Part>, Error> {
        let path = new_files(&self.options.out, self.recipe).join(&output.file);
        make_folder_of(&path)?;
        let mut parts = Vec::new();
        write_through(&path, |path| {
            let failed = |cause: std::io::Error| Error::write(path, &cause);
            let mut file = File::create(path).map_err(failed)?;
            parts = write(windowed, &mut file)?;
            file.sync_all().map_err(failed)
        })?;
        parts.iter().try_for_each(|part| weald_io::write_whole(&part.name.path(&path), &part.bytes))?;
        Ok(parts)
    }

    /// Writes a folder: the first rank what describes it, then each rank the files of its strips; gives the former.
    fn by_strips(
        &self,
        landscape: &StoredLandscape<'_>,
        written: &Written<'_>,
        format: ByStrips,
    ) -> Result<Vec<Part>, Error> {
        let ranks = &*landscape.ranks;
        let path = new_files(&self.options.out, self.recipe).join(&written.output.file);
        let described = (format.descriptions)(&written.head, landscape.domain.size).and_then(|parts| {
            if ranks.leads() { begin_folder(&path, &parts).map(|()| parts) } else { Ok(parts) }
        });
        let parts = agreed(ranks, described.map_err(|error| self.by_its_name(error)))?;
        let is_there = parts.iter().all(|part| files::exists(&part.name.path(&path)));
        let elsewhere = || {
            let what = "is not there, since the first rank wrote it elsewhere: the output folder must be the same on the \
                        machines of all ranks";
            Error::Run(format!("{} {what}", path.display()))
        };
        agreed(ranks, if is_there { Ok(()) } else { Err(elsewhere()) })?;
        let values = Strips::of(written.plane, format.rows, ranks)?;
        let valid = landscape.valid().map(|valid| Strips::of(valid, format.rows, ranks)).transpose()?;
        let filled = values.own().try_for_each(|rows| {
            let place = StripPlace { whole: landscape.domain.size, first: rows.start };
            let size = Size { columns: place.whole.columns, rows: rows.len() };
            let flags = valid.as_ref().map(|valid| valid.read(rows.clone())).transpose()?;
            let flags = flags.map(|flags| flags.into_iter().map(|flag| flag > 0.0).collect());
            let strip = Raster {
                valid: flags.and_then(|flags| Mask::new(size, flags)),
                field: Field::from_values(size, values.read(rows)?),
                ..written.head.clone()
            };
            write_into(&path, &(format.strip)(&strip, place)?)
        });
        agreed(ranks, filled.map_err(|error| self.by_its_name(error)))?;
        Ok(parts)
    }

    /// All that a file says of a layer but its values.
    fn head(&self, landscape: &StoredLandscape<'_>, name: &str, (unit, range): (&str, (f32, f32))) -> Raster {
        let provenance = Provenance {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            recipe_blake3: self.recipe.hash(),
            seed: self.recipe.seed,
            layer: name.to_owned(),
            unit: unit.to_owned(),
            range: (range.0.into(), range.1.into()),
            resampled: None,
        };
        Raster {
            provenance: Some(provenance),
            cell: Some(landscape.domain.cell),
            georeference: landscape.domain.georeference.clone(),
            classes: (name == DIRECTIONS).then(|| directions(DirectionCodes::Weald)),
            shades: shades(name),
            ..Raster::from(Field::filled(Size { columns: 1, rows: 1 }, range.0))
        }
    }
}

/// Begins a folder anew: what a run that was killed has left of it is not mixed with this.
fn begin_folder(path: &Path, parts: &[Part]) -> Result<(), Error> {
    if files::exists(path) {
        files::remove_dir_all(path).map_err(|cause| Error::write(path, &cause))?;
    }
    write_into(path, parts)
}

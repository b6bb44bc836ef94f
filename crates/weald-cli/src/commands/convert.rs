//! `weald convert`.

use std::path::Path;

use weald::io;

use crate::failure::Failure;

pub(crate) fn convert(input: &Path, output: &Path) -> Result<(), Failure> {
    let format = io::format_of(output).map_err(Failure::usage)?;
    if format.encode.is_none() {
        return Err(Failure::usage(format!(
            "{} is read, not written; choose another extension",
            format.name
        )));
    }
    let raster = io::read(input)?;
    for note in &raster.notes {
        eprintln!("note: {note}");
    }
    io::write(output, &raster)?;
    if raster.georeference.is_some() && !format.extensions.contains(&"tif") {
        eprintln!(
            "note: {} holds no place on Earth, so {} has none; .tif does",
            format.name,
            output.display()
        );
    }
    Ok(())
}

//! `weald convert`.

use std::path::Path;

use weald::io;

use crate::failure::Failure;

pub(crate) fn convert(input: &Path, output: &Path, preset: Option<&str>) -> Result<(), Failure> {
    let format = io::format_of(output).map_err(Failure::usage)?;
    let (encode, holds) = format.writing(preset).map_err(Failure::usage)?;
    let raster = io::read(input)?;
    let degrees = raster.likely_degrees().map(|_| {
        "its cells look like degrees, but it names no CRS: gdal_edit.py -a_srs EPSG:4326 gives it one"
            .to_owned()
    });
    for note in raster.notes.iter().chain(&degrees) {
        eprintln!("note: {note}");
    }
    io::write_parts(output, &encode.parts(&raster)?)?;
    for loss in holds.losses(&raster) {
        eprintln!("note: {}: {loss}", output.display());
    }
    Ok(())
}

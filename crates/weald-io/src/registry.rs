//! All raster formats, and a file's format by its extension.

use std::path::Path;

use super::beside::{self, BESIDE};
#[cfg(feature = "exr")]
use super::exr;
use super::parts::{OnDisk, PartName, Parts, read_at_most};
use super::{
    Decode, Fault, Format, Limits, Raster, RowsOfFile, asc, geotiff, netcdf, npy, png16, raw, write_parts,
    zarr,
};
use weald_core::error::{Error, left_out};

/// Longest `.aux.xml` that is read, in bytes.
const BESIDE_BYTES: u64 = 16 << 20;

/// All raster formats. Adding one is one file and one line here.
#[rustfmt::skip] // one entry a line, so that branches that add some do not meet
pub const FORMATS: &[Format] = &[
    geotiff::FORMAT,
    png16::FORMAT,
    #[cfg(feature = "exr")]
    exr::FORMAT,
    raw::FORMAT_16,
    raw::FORMAT_32,
    asc::FORMAT,
    npy::FORMAT,
    netcdf::FORMAT,
    zarr::FORMAT,
];

/// Formats that this build leaves out: their extension, name and feature.
const LEFT_OUT: &[[&str; 3]] = &[
    #[cfg(not(feature = "exr"))]
    ["exr", "OpenEXR", "exr"],
];

/// The format of a file name.
///
/// # Errors
/// A sentence that names the extensions there are, or the feature that a build needs for the format.
pub fn format_of(path: &Path) -> Result<&'static Format, String> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str())).ok_or_else(|| {
        if let Some([_, name, feature]) = LEFT_OUT.iter().find(|[known, ..]| *known == extension) {
            return format!("`{}`: {}", path.display(), left_out(name, feature));
        }
        let known: Vec<_> = FORMATS.iter().flat_map(|f| f.extensions).map(|e| format!(".{e}")).collect();
        format!("the extension of `{}` names no raster format; there are {}", path.display(), known.join(" "))
    })
}

/// Reads any raster file.
///
/// # Errors
/// [`Error::Input`] for a file that is missing, damaged or of a kind that is not read, [`Error::Limit`] for
/// one that is too large.
pub fn read(path: &Path) -> Result<Raster, Error> {
    let format = format_of(path).map_err(|what| Error::input(path, what))?;
    let limits = Limits::default();
    let raster = match format.decode {
        Some(Decode::File(decode) | Decode::Rows { whole: decode, .. }) => {
            read_at_most(path, limits.file_bytes()).and_then(|bytes| decode(&bytes, limits))
        }
        Some(Decode::Parts(decode)) => decode(&OnDisk(path.to_owned()), limits),
        None => Err(Fault::damaged(format!("{} is written, not read", format.name))),
    };
    let beside = || OnDisk(path.to_owned()).read(&PartName::Beside(BESIDE.to_owned()), BESIDE_BYTES);
    let whole = raster.and_then(|raster| match beside()? {
        Some(xml) => beside::with(raster, &String::from_utf8_lossy(&xml)),
        None => Ok(raster),
    });
    let whole = whole.and_then(|raster| with_world_file(raster, path));
    whole.map_err(|fault| fault.of(path))
}

/// Opens a file to read rows of it as they are needed.
///
/// # Errors
/// [`Error::Input`] for a file that is missing or damaged, of a format that is read as a whole alone, or that has a file
/// beside it which says more of it.
pub fn open_rows(path: &Path) -> Result<Box<dyn RowsOfFile>, Error> {
    let format = format_of(path).map_err(|what| Error::input(path, what))?;
    let Some(Decode::Rows { open, .. }) = format.decode else {
        let name = format.name;
        let what =
            format!("{name} is read as a whole, which needs it in memory; rows are read of GeoTIFF: .tif");
        return Err(Error::input(path, what));
    };
    let place = OnDisk(path.to_owned());
    let worlds = world_files(path).map(|suffix| PartName::Sibling(suffix.to_owned()));
    for name in worlds.chain([PartName::Beside(BESIDE.to_owned())]) {
        if place.read(&name, BESIDE_BYTES).map_err(|fault| fault.of(path))?.is_some() {
            let beside = name.path(path);
            return Err(Error::input(
                path,
                format!(
                    "{} says more of it, which goes with the whole in memory alone; put it into the file: gdal_translate \
                     in.tif out.tif",
                    beside.display()
                ),
            ));
        }
    }
    open(path).map_err(|fault| fault.of(path))
}

/// What follows the name of a world file, by the extension of the raster, as GDAL looks for it.
const WORLD_FILES: [(&str, [&str; 3]); 3] = [
    ("tif", [".tfw", ".tifw", ".wld"]),
    ("tiff", [".tfw", ".tiffw", ".wld"]),
    ("png", [".pgw", ".pngw", ".wld"]),
];

/// What may follow the name of its world file.
fn world_files(path: &Path) -> impl Iterator<Item = &'static str> + use<> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let known = WORLD_FILES.iter().find(|(raster, _)| *raster == extension);
    known.into_iter().flat_map(|(_, suffixes)| *suffixes)
}

fn with_world_file(raster: Raster, path: &Path) -> Result<Raster, Fault> {
    for suffix in world_files(path) {
        let name = PartName::Sibling(suffix.to_owned());
        if let Some(text) = OnDisk(path.to_owned()).read(&name, BESIDE_BYTES)? {
            return beside::with_world(raster, &String::from_utf8_lossy(&text));
        }
    }
    Ok(raster)
}

/// Writes a raster under its whole name only when all of it is on disk.
///
/// # Errors
/// [`Error::Run`] for an unknown extension, values that the format cannot hold, or a failed write.
pub fn write(path: &Path, raster: &Raster) -> Result<(), Error> {
    let format = format_of(path).map_err(Error::Run)?;
    let (encode, _) = format.writing(None).map_err(Error::Run)?;
    write_parts(path, &encode.parts(raster)?)
}

#[cfg(all(test, not(feature = "exr")))]
mod tests {
    use super::*;

    #[test]
    fn a_build_without_openexr_names_its_feature() {
        let expected = "`a/height.EXR`: OpenEXR is not part of this build: build with the feature `exr`";
        assert_eq!(format_of(Path::new("a/height.EXR")).expect_err("left out"), expected);
        let error = read(Path::new("height.exr")).expect_err("left out");
        assert!(matches!(&error, Error::Input { what, .. } if what.contains("feature `exr`")), "{error}");
        assert!(format_of(Path::new("height.tif")).is_ok());
    }
}

//! Raster files, one file a format. The extension chooses the format; [`FORMATS`] is the registry.
//!
//! Every reader works on bytes, so that it can be fuzzed without a file system, and checks the sizes in a
//! header against its [`Limits`] before it allocates; every writer writes under a temporary name and renames
//! the whole file.

pub mod asc;
mod atomic;
pub mod cf;
pub mod exr;
mod fault;
mod format;
pub mod geotiff;
mod info;
mod limits;
pub mod netcdf;
pub mod npy;
mod number;
mod parts;
pub mod png;
pub mod png16;
mod provenance;
mod raster;
pub mod raw;
mod square;
pub mod zarr;

pub use atomic::{write_parts, write_through, write_whole, write_whole_with};
pub use fault::Fault;
pub use format::{Decode, DecodeFile, Encode, Format, Holds, Knowledge, Preset, Values};
pub use info::{Info, describe};
pub use limits::Limits;
pub use parts::{InMemory, Part, PartName, Parts};
pub use provenance::Provenance;
pub use raster::Raster;
pub use square::square;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use self::parts::OnDisk;
use weald_core::error::Error;

/// All raster formats.
#[rustfmt::skip] // one entry a line, so that branches that add some do not meet
pub const FORMATS: &[Format] = &[
    geotiff::FORMAT,
    png16::FORMAT,
    exr::FORMAT,
    raw::FORMAT_16,
    raw::FORMAT_32,
    asc::FORMAT,
    npy::FORMAT,
    netcdf::FORMAT,
    zarr::FORMAT,
];

/// The format of a file name.
///
/// # Errors
/// A sentence that names the extensions there are.
pub fn format_of(path: &Path) -> Result<&'static Format, String> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    FORMATS.iter().find(|format| format.extensions.contains(&extension.as_str())).ok_or_else(|| {
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
        Some(Decode::File(decode)) => {
            read_at_most(path, limits.file_bytes()).and_then(|bytes| decode(&bytes, limits))
        }
        Some(Decode::Parts(decode)) => decode(&OnDisk(path.to_owned()), limits),
        None => Err(Fault::damaged(format!("{} is written, not read", format.name))),
    };
    raster.map_err(|fault| fault.of(path))
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

/// All bytes of a file, where they are at most `limit`. The length is counted while reading, because a
/// device or a pipe has none to ask for.
pub fn read_at_most(path: &Path, limit: u64) -> Result<Vec<u8>, Fault> {
    let mut bytes = Vec::new();
    let reading = File::open(path).and_then(|file| file.take(limit + 1).read_to_end(&mut bytes));
    reading.map_err(|cause| Fault::damaged(format!("cannot be read: {cause}")))?;
    if bytes.len() as u64 > limit {
        return Err(Fault::Limit(format!("the file is longer than the {limit} bytes that are read")));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit_and_no_further() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("ten.tif");
        std::fs::write(&path, [7; 10]).expect("written");
        assert_eq!(read_at_most(&path, 10).expect("within"), [7; 10]);
        let error = read_at_most(&path, 9).expect_err("over").of(&path);
        assert_eq!(error.exit_code(), 5, "{error}");
        let missing = folder.path().join("none.tif");
        let error = read_at_most(&missing, 9).expect_err("missing").of(&missing);
        assert_eq!(error.exit_code(), 4, "{error}");
    }
}

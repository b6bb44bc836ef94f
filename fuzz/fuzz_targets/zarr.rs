//! Any description with any chunk is a raster or a fault; what was read is written and read again the same.
//!
//! An input is a length of two bytes, a `zarr.json` of that length, and bytes that are every chunk.
#![no_main]

use std::path::PathBuf;

use libfuzzer_sys::fuzz_target;
use weald::error::{Limit, Quantity};
use weald::io::{Fault, InMemory, Limits, PartName, Parts, zarr};

const LIMITS: Limits = Limits { cells: 1 << 12 };

/// A folder in which every chunk is the same.
struct Folder<'a> {
    description: &'a [u8],
    chunk: &'a [u8],
}

impl Parts for Folder<'_> {
    fn read(&self, name: &PartName, most: u64) -> Result<Option<Vec<u8>>, Fault> {
        let bytes = match name {
            PartName::Inside(path) if path == "zarr.json" || path == "height/zarr.json" => self.description,
            PartName::Inside(path) if path.contains('c') || path.contains('.') => self.chunk,
            _ => return Ok(None),
        };
        if bytes.len() as u64 > most {
            return Err(Limit::new(Quantity::FileBytes, bytes.len() as u64, 0..=most).into());
        }
        Ok(Some(bytes.to_vec()))
    }

    fn folders(&self) -> Result<Vec<String>, Fault> {
        Ok(vec!["height".to_owned()])
    }
}

fuzz_target!(|bytes: &[u8]| {
    let Some((length, rest)) = bytes.split_first_chunk::<2>() else { return };
    let Some((description, chunk)) = rest.split_at_checked(u16::from_le_bytes(*length).into()) else { return };
    let Ok(raster) = zarr::decode(&Folder { description, chunk }, LIMITS) else { return };
    assert!(raster.field.size().cells() <= LIMITS.cells);
    // Packing costs a hundred times what reading a small chunk does.
    if raster.field.size().cells() <= 256 {
        let written = zarr::encode(&raster).expect("a raster that was read is finite");
        let again = zarr::decode(&InMemory::of(PathBuf::from("a.zarr"), written), LIMITS);
        let again = again.expect("what was written can be read");
        assert_eq!((again.field, again.valid), (raster.field, raster.valid));
    }
});

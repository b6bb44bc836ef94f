//! Any `.zarray` of version 2 with any chunk is a raster or a fault.
//!
//! An input is a length of two bytes, a `.zarray` of that length, and bytes that are every chunk.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::error::{Limit, Quantity};
use weald::io::{Fault, Limits, PartName, Parts, zarr};

const LIMITS: Limits = Limits { cells: 1 << 16 };

/// A folder in which every chunk is the same.
struct Folder<'a> {
    description: &'a [u8],
    chunk: &'a [u8],
}

impl Parts for Folder<'_> {
    fn read(&self, name: &PartName, most: u64) -> Result<Option<Vec<u8>>, Fault> {
        let bytes = match name {
            PartName::Inside(path) if path == ".zgroup" => b"{\"zarr_format\": 2}",
            PartName::Inside(path) if path == "height/.zarray" => self.description,
            PartName::Inside(path) if path.starts_with("height/") && path.contains(|c: char| c.is_ascii_digit()) => self.chunk,
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
});

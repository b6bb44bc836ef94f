//! Truncated and mutated files give an error or a raster, never a panic and never more memory than allowed.

use crate::rasters::{exr_file, fixture};
use weald_core::grid::{Field, Mask, Size};
use weald_core::random::hash2;
use weald_io::{
    DecodeFile, Fault, InMemory, Limits, Part, PartName, Raster, asc, exr, geotiff, npy, png16, raw, zarr,
};

const LIMITS: Limits = Limits { cells: 1 << 16 };

/// Mutants of each file.
const MUTANTS: u64 = 1000;

/// A grid in digits, without a CRS.
fn decode_asc(bytes: &[u8], limits: Limits) -> Result<Raster, Fault> {
    asc::decode(&InMemory::of("land.asc", vec![Part::own(bytes.to_vec())]), limits)
}

/// A description, a NUL, and the numbers that it describes.
fn decode_raw(bytes: &[u8], limits: Limits) -> Result<Raster, Fault> {
    let nul = bytes.iter().position(|&byte| byte == 0).ok_or_else(|| Fault::damaged("no NUL"))?;
    let parts = vec![Part::beside(".json", bytes[..nul].to_vec()), Part::own(bytes[nul + 1..].to_vec())];
    raw::decode_16(&InMemory::of("land.raw", parts), limits)
}

/// A CRS beside a grid of one cell.
fn decode_prj(bytes: &[u8], limits: Limits) -> Result<Raster, Fault> {
    let grid = b"ncols 1\nnrows 1\nxllcorner 5\nyllcorner 6\ncellsize 7\n8\n".to_vec();
    let parts =
        vec![Part::own(grid), Part { name: PartName::Sibling(".prj".to_owned()), bytes: bytes.to_vec() }];
    asc::decode(&InMemory::of("land.asc", parts), limits)
}

const WKT: &str = "COMPD_CS[\"c\",PROJCS[\"p\",GEOGCS[\"g\",DATUM[\"d\",SPHEROID[\"s\",6378137,298.25]],UNIT[\"degree\",\
                   0.0174532925199433]],UNIT[\"foot\",0.3048]],VERT_CS[\"v\",UNIT[\"foot\",0.3048]]]";

/// A description of version 2, a NUL, and the only chunk that it describes.
fn decode_zarr(bytes: &[u8], limits: Limits) -> Result<Raster, Fault> {
    let nul = bytes.iter().position(|&byte| byte == 0).ok_or_else(|| Fault::damaged("no NUL"))?;
    let inside =
        |name: &str, bytes: &[u8]| Part { name: PartName::Inside(name.to_owned()), bytes: bytes.to_vec() };
    let parts = vec![inside(".zarray", &bytes[..nul]), inside("0.0", &bytes[nul + 1..])];
    zarr::decode(&InMemory::of("land.zarr", parts), limits)
}

/// Numbers that Blosc stores as they are, and those that LZ4 packs into a stream, all of the same byte.
fn blosc_chunks() -> [Vec<u8>; 2] {
    let description = r#"{"zarr_format":2,"shape":[8,8],"chunks":[8,8],"dtype":"<i2","order":"C","fill_value":0,
        "filters":null,"compressor":{"id":"blosc"}}"#;
    let header = |flags: u8, sizes: [u32; 3]| {
        [vec![2, 1, flags, 2], sizes.iter().flat_map(|size| size.to_le_bytes()).collect()].concat()
    };
    let stored = [header(2, [128, 128, 144]), (0..128).collect()].concat();
    // A literal, a match of 122 bytes one back, and the five literals that end a block.
    let stream = [0x1f, 7, 1, 0, 103, 0x50, 7, 7, 7, 7, 7];
    let starts = [20_u32, stream.len() as u32].map(u32::to_le_bytes).concat();
    let packed = [header(0x10 | 1 << 5 | 1, [128, 128, 35]), starts, stream.to_vec()].concat();
    [stored, packed].map(|chunk| [description.as_bytes(), &[0], &chunk].concat())
}

fn described_numbers(parts: &[Part]) -> Vec<u8> {
    [parts[1].bytes.as_slice(), &[0], &parts[0].bytes].concat()
}

fn files() -> Vec<(DecodeFile, Vec<u8>)> {
    let size = Size { columns: 19, rows: 11 };
    let valid = Mask::new(size, (0..size.cells()).map(|index| index % 5 != 0).collect());
    let field = Field::from_function(size, |x, y| (x * y) as f32);
    let raster = Raster { valid, cell: Some(3.0), ..Raster::from(field) };
    let mut files: Vec<(DecodeFile, Vec<u8>)> = vec![
        (geotiff::decode, geotiff::encode(&raster).expect("finite")),
        (png16::decode, png16::encode(&raster).expect("finite")),
        (png16::decode, fixture("uint16.png")),
        (npy::decode, npy::encode(&raster).expect("finite")),
        (exr::decode, exr::encode(&raster).expect("finite")),
        (decode_raw, described_numbers(&raw::encode_16(&raster).expect("finite"))),
        (decode_raw, described_numbers(&raw::encode_32(&raster).expect("finite"))),
        (decode_asc, asc::encode(&raster).expect("finite").swap_remove(0).bytes),
    ];
    for name in
        ["none_half", "rle_float", "zips_uint", "piz_float", "piz_half", "piz_float_tiles", "zip_grey_rgb"]
    {
        files.push((exr::decode, exr_file(&format!("{name}.exr"))));
    }
    let tiffs = vec![
        "bigtiff_big_endian_tiles.tif",
        "float32_strips_lzw_predictor2.tif",
        "float64_tiles_predictor3.tif",
        "int16_strips_deflate_predictor2.tif",
        "int32_big_endian_lzw_predictor2.tif",
        "sparse.tif",
        #[cfg(feature = "zstd")]
        "zstd.tif",
    ];
    files.push((decode_prj, WKT.as_bytes().to_vec()));
    files.extend(blosc_chunks().map(|chunk| (decode_zarr as DecodeFile, chunk)));
    files.extend(tiffs.into_iter().map(|name| (geotiff::decode as DecodeFile, fixture(name))));
    files
}

#[test]
fn a_file_cut_off_anywhere_is_an_error_or_lost_nothing() {
    for (decode, bytes) in files() {
        let whole = decode(&bytes, LIMITS).expect("whole");
        let step = bytes.len().div_ceil(700);
        for length in (0..bytes.len()).step_by(step) {
            if let Ok(raster) = decode(&bytes[..length], LIMITS) {
                // A number in digits that lost its last ones is still a number.
                let is_told = raster.notes.iter().any(|note| note.contains("may have been cut off"));
                assert!(is_told || raster.field == whole.field, "{length} of {} bytes", bytes.len());
            }
        }
        assert!(decode(&bytes[..bytes.len() / 2], LIMITS).is_err());
    }
}

/// One to four bytes of a file changed, most often among the first 600, where the header and directory are.
fn mutant(bytes: &[u8], seed: u64) -> Vec<u8> {
    let mut mutant = bytes.to_vec();
    for change in 0..=hash2(seed, 0, 0) % 4 {
        let random = hash2(seed, 1, change as i64);
        let reach = if random.is_multiple_of(4) { mutant.len() } else { mutant.len().min(600) };
        let at = (random >> 16) as usize % reach;
        mutant[at] = match random >> 2 & 3 {
            0 => 0,
            1 => 0xff,
            2 => mutant[at] ^ (1 << (random >> 8 & 7)),
            _ => (random >> 8) as u8,
        };
    }
    mutant
}

#[test]
fn mutated_files_never_panic_and_stay_within_limits() {
    let mut refused = 0;
    let files = files();
    for (which, (decode, bytes)) in files.iter().enumerate() {
        for seed in 0..MUTANTS {
            match decode(&mutant(bytes, seed << 8 | which as u64), LIMITS) {
                Err(_) => refused += 1,
                Ok(raster) => assert!(raster.field.size().cells() <= LIMITS.cells),
            }
        }
    }
    let all = MUTANTS * files.len() as u64;
    assert!(
        refused > all / 10 && refused < all,
        "{refused} of {all} mutants refused: the mutations do too little"
    );
}

/// Puts `value` into the one entry of a little-endian TIFF directory that begins as `entry` does.
fn patched(mut tiff: Vec<u8>, entry: [u8; 8], value: u32) -> Vec<u8> {
    let at = tiff.windows(8).position(|bytes| bytes == entry).expect("the tag is there") + 8;
    tiff[at..at + 4].copy_from_slice(&value.to_le_bytes());
    tiff
}

#[test]
fn a_file_that_claims_more_than_it_can_hold_is_refused_before_memory_is_taken() {
    let raster = Raster::from(Field::filled(Size { columns: 19, rows: 200 }, 1.0));
    let tiff = geotiff::encode(&raster).expect("finite");
    // Tag 325, the length of the one tile; 16 bytes for 256 × 200 cells.
    let tiff = patched(tiff, [0x45, 0x01, 4, 0, 1, 0, 0, 0], 16);
    let fault = geotiff::decode(&tiff, LIMITS).expect_err("too short");
    assert!(fault.to_string().contains("chunk 0: 16 bytes cannot hold the 204800 bytes"), "{fault}");
    let mut png = Vec::new();
    let mut encoder = png::Encoder::new(&mut png, 16384, 16384);
    encoder.set_depth(png::BitDepth::Sixteen);
    drop(encoder.write_header().expect("a header"));
    // The encoder ends the file with an IEND chunk of 12 bytes; an empty IDAT chunk takes its place.
    png.truncate(png.len() - 12);
    let fault = png16::decode(&[png, b"\0\0\0\0IDAT\x35\xaf\x06\x1e".to_vec()].concat(), Limits::default());
    let fault = fault.expect_err("no image");
    assert!(fault.to_string().contains("bytes cannot hold the 536870912 bytes"), "{fault}");
}

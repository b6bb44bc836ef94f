//! Writing: blocks of sixteen rows, packed on all cores and put into the file in their order.

use rayon::prelude::*;

use super::super::Raster;
use super::attributes;
use super::compression::{ZIP, ZIP_ROWS, zipped};
use super::header::MAGIC;
use weald_core::error::Error;
use weald_core::grid::Size;

/// How samples are written.
#[derive(Clone, Copy)]
struct Style {
    /// Names in the order of the alphabet, as the format wants them.
    channels: &'static [&'static str],
    is_half: bool,
    /// Whether cells without data hold NaN; the lowest value otherwise.
    has_nan: bool,
}

const FLOAT: i32 = 2;
const HALF: i32 = 1;

/// The bytes of a file with one channel `Y` of floats.
///
/// # Errors
/// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
pub fn encode(raster: &Raster) -> Result<Vec<u8>, Error> {
    encode_as(raster, Style { channels: &["Y"], is_half: false, has_nan: true })
}

/// As [`encode`], with the same floats in `R`, `G` and `B`.
pub(super) fn encode_for_blender(raster: &Raster) -> Result<Vec<u8>, Error> {
    encode_as(raster, Style { channels: &["B", "G", "R"], is_half: false, has_nan: false })
}

/// As [`encode`], with one channel `R` of floats.
pub fn encode_for_godot(raster: &Raster) -> Result<Vec<u8>, Error> {
    encode_as(raster, Style { channels: &["R"], is_half: false, has_nan: false })
}

/// As [`encode`], with one channel `R` of half floats.
pub(super) fn encode_for_hterrain(raster: &Raster) -> Result<Vec<u8>, Error> {
    encode_as(raster, Style { channels: &["R"], is_half: true, has_nan: false })
}

fn encode_as(raster: &Raster, style: Style) -> Result<Vec<u8>, Error> {
    raster.ensure_finite()?;
    if style.is_half {
        ensure_fits_half(raster)?;
    }
    let size = raster.field.size();
    let blocks: Vec<Vec<u8>> = (0..size.rows.div_ceil(ZIP_ROWS))
        .into_par_iter()
        .map(|block| zipped(rows(raster, style, block * ZIP_ROWS)))
        .collect();
    Ok(assemble(header(raster, style), &blocks))
}

fn ensure_fits_half(raster: &Raster) -> Result<(), Error> {
    let greatest = half::f16::MAX.to_f32();
    let beyond = |(index, value): (usize, &f32)| raster.is_valid_at(index) && value.abs() > greatest;
    let Some(index) = raster.field.values().iter().enumerate().position(beyond) else { return Ok(()) };
    let columns = raster.field.size().columns;
    Err(Error::Run(format!(
        "column {}, row {} holds {}, but half floats end at {greatest}; the .exr without a preset has no such \
         bound",
        index % columns,
        index / columns,
        raster.field.values()[index]
    )))
}

/// The samples of sixteen rows from `first` on, in a row channel after channel.
fn rows(raster: &Raster, style: Style, first: usize) -> Vec<u8> {
    let Size { columns, rows } = raster.field.size();
    let none = if style.has_nan { f32::NAN } else { raster.range().0 };
    let mut bytes = Vec::new();
    for y in first..(first + ZIP_ROWS).min(rows) {
        let cells = raster.field.row(y).iter().enumerate();
        let value =
            |(x, value): (usize, &f32)| if raster.is_valid_at(y * columns + x) { *value } else { none };
        let samples: Vec<u8> = if style.is_half {
            cells.flat_map(|cell| half::f16::from_f32(value(cell)).to_le_bytes()).collect()
        } else {
            cells.flat_map(|cell| value(cell).to_le_bytes()).collect()
        };
        style.channels.iter().for_each(|_| bytes.extend(&samples));
    }
    bytes
}

fn header(raster: &Raster, style: Style) -> Vec<u8> {
    let size = raster.field.size();
    let window = [0, 0, size.columns as i32 - 1, size.rows as i32 - 1].map(i32::to_le_bytes).concat();
    let one = 1.0_f32.to_le_bytes().to_vec();
    let mut attributes = vec![
        ("channels", "chlist", channels(style)),
        ("compression", "compression", vec![ZIP]),
        ("dataWindow", "box2i", window.clone()),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", vec![0]),
        ("pixelAspectRatio", "float", one.clone()),
        ("screenWindowCenter", "v2f", vec![0; 8]),
        ("screenWindowWidth", "float", one),
    ];
    attributes.extend(attributes::of(raster));
    let mut bytes = [MAGIC, 2_u32.to_le_bytes()].concat();
    for (name, kind, value) in attributes {
        bytes.extend([name.as_bytes(), &[0], kind.as_bytes(), &[0]].concat());
        bytes.extend((value.len() as i32).to_le_bytes());
        bytes.extend(value);
    }
    bytes.push(0);
    bytes
}

fn channels(style: Style) -> Vec<u8> {
    let mut list = Vec::new();
    for name in style.channels {
        list.extend([name.as_bytes(), &[0]].concat());
        // Type, then whether values are perceived linearly and three bytes of nothing, then a sample a cell.
        let kind = if style.is_half { HALF } else { FLOAT };
        list.extend([kind, 0, 1, 1].map(i32::to_le_bytes).concat());
    }
    list.push(0);
    list
}

/// Header, table of offsets, blocks with their first row and length.
fn assemble(header: Vec<u8>, blocks: &[Vec<u8>]) -> Vec<u8> {
    let mut file = header;
    let mut next = (file.len() + 8 * blocks.len()) as u64;
    for block in blocks {
        file.extend(next.to_le_bytes());
        next += 8 + block.len() as u64;
    }
    for (index, block) in blocks.iter().enumerate() {
        file.extend([(index * ZIP_ROWS) as i32, block.len() as i32].map(i32::to_le_bytes).concat());
        file.extend(block);
    }
    file
}

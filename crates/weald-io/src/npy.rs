//! `NumPy`'s .npy, format version 1.0 (NEP 1): written as little-endian `float32` in C order, no-data as NaN.
//!
//! Read are two-dimensional arrays of floats and integers in either byte order and either array order; NaN is
//! no-data. The format has no room for provenance, cell size or place: the report has them.

use super::number::Number;
use super::{Capabilities, Decode, Encode, Fault, Format, Limits, Metadata, Raster};
use weald_core::error::Error;
use weald_core::grid::Size;

/// The entry in the registry of formats.
pub(super) const FORMAT: Format = Format {
    name: "NumPy array",
    extensions: &["npy"],
    decode: Some(Decode::File(decode)),
    encode: Some(Encode::File(encode)),
    holds: Capabilities {
        omits: &[Metadata::Cell, Metadata::Place, Metadata::Provenance],
        ..Capabilities::ALL
    },
    presets: &[],
};

const MAGIC: &[u8] = b"\x93NUMPY";

/// The bytes of a .npy file.
///
/// # Errors
/// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
pub fn encode(raster: &Raster) -> Result<Vec<u8>, Error> {
    raster.ensure_finite()?;
    let Size { columns, rows } = raster.field.size();
    let mut file = header("<f4", [rows, columns]);
    file.reserve(raster.field.size().cells() * 4);
    for (index, value) in raster.field.values().iter().enumerate() {
        let value = if raster.is_valid_at(index) { *value } else { f32::NAN };
        file.extend(value.to_le_bytes());
    }
    Ok(file)
}

/// What stands before the numbers of a two-dimensional array in C order.
pub fn header(kind: &str, [rows, columns]: [usize; 2]) -> Vec<u8> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    // Magic, version, length of the header, header and its newline fill whole lines of 64 bytes.
    let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
    let mut file = MAGIC.to_vec();
    file.extend([1, 0]);
    file.extend((length as u16).to_le_bytes());
    file.extend(format!("{header:<width$}\n", width = length - 1).bytes());
    file
}

/// Reads a two-dimensional array.
///
/// # Errors
/// [`Fault`] for a file that is damaged, of a kind that is not read, or over the limits.
pub fn decode(bytes: &[u8], limits: Limits) -> Result<Raster, Fault> {
    let (header, data) = split(bytes)?;
    let kind = Kind::of(entry(header, "descr")?.trim_matches(['\'', '"']))?;
    let (columns, rows) = shape(entry(header, "shape")?)?;
    let size = limits.size(columns, rows)?;
    let is_transposed = entry(header, "fortran_order")? == "True";
    if data.len() != size.cells() * kind.number.bytes {
        return Err(Fault::damaged(format!(
            "{size} values of {} bytes need {} bytes, but {} follow the header; the file is damaged",
            kind.number.bytes,
            size.cells() * kind.number.bytes,
            data.len()
        )));
    }
    let number = |x: usize, y: usize| {
        let index = if is_transposed { x * size.rows + y } else { y * size.columns + x };
        kind.number.value(&data[index * kind.number.bytes..][..kind.number.bytes], kind.is_big)
    };
    let numbers = || (0..size.cells()).map(|index| number(index % size.columns, index / size.columns));
    let valid = numbers().map(|number| !number.is_nan()).collect();
    let values = numbers().map(|number| if number.is_nan() { 0.0 } else { number as f32 }).collect();
    Raster::from_file(size, values, valid, kind.number.name)
}

/// The header's dictionary and the bytes of the values.
fn split(bytes: &[u8]) -> Result<(&str, &[u8]), Fault> {
    let damaged = || Fault::damaged("the file does not begin with a .npy header of version 1, 2 or 3");
    let rest = bytes.strip_prefix(MAGIC).ok_or_else(damaged)?;
    let (length, rest) = match rest {
        [1, _, a, b, rest @ ..] => (usize::from(u16::from_le_bytes([*a, *b])), rest),
        [2 | 3, _, a, b, c, d, rest @ ..] => (u32::from_le_bytes([*a, *b, *c, *d]) as usize, rest),
        _ => return Err(damaged()),
    };
    let (header, data) = rest.split_at_checked(length).ok_or_else(damaged)?;
    Ok((std::str::from_utf8(header).map_err(|_| damaged())?, data))
}

/// The text of a value of the header's dictionary, up to the comma that ends it.
fn entry<'a>(header: &'a str, key: &str) -> Result<&'a str, Fault> {
    let missing = || Fault::damaged(format!("the .npy header has no `{key}`: {header:?}"));
    let (_, after) = header.split_once(&format!("'{key}':")).ok_or_else(missing)?;
    let after = after.trim_start();
    let end = if after.starts_with('(') { after.find(')') } else { after.find([',', '}']) };
    Ok(after[..end.ok_or_else(missing)?].trim())
}

/// Columns and rows from `(rows, columns`.
fn shape(text: &str) -> Result<(usize, usize), Fault> {
    let sides: Option<Vec<usize>> = text
        .trim_start_matches('(')
        .split(',')
        .map(str::trim)
        .filter(|side| !side.is_empty())
        .map(|side| side.parse().ok())
        .collect();
    match sides.as_deref() {
        Some([rows, columns]) => Ok((*columns, *rows)),
        _ => Err(Fault::damaged(format!(
            "an array of shape {text}); two dimensions, rows and columns, are read"
        ))),
    }
}

/// Type of the values, and their order of bytes.
struct Kind {
    number: Number,
    is_big: bool,
}

impl Kind {
    /// The type behind `NumPy`'s name for it, such as `<f4`.
    fn of(description: &str) -> Result<Self, Fault> {
        let (order, kind) = description.split_at_checked(1).unwrap_or_default();
        let (family, bytes) = kind.split_at_checked(1).unwrap_or_default();
        let family = match family {
            "f" => "float",
            "i" => "int",
            "u" => "uint",
            _ => return Err(unread(description)),
        };
        let bits = bytes.parse().ok().filter(|bytes| (1..=8_u32).contains(bytes)).map(|bytes| bytes * 8);
        let number = bits.and_then(|bits| Number::of(&format!("{family}{bits}")));
        let number = number.ok_or_else(|| unread(description))?;
        match order {
            "<" | "|" | "=" => Ok(Self { number, is_big: false }),
            ">" => Ok(Self { number, is_big: true }),
            _ => Err(unread(description)),
        }
    }
}

fn unread(description: &str) -> Fault {
    Fault::damaged(format!(
        "values of type `{description}`; floats (f4, f8) and integers (i1 to i8, u1 to u8) are read: \
         array.astype('f4')"
    ))
}

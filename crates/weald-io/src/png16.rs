//! Grey PNG of 16 bits (ISO/IEC 15948). Values are scaled to the range of the layer; the range, the unit and
//! the side of a cell stand in `tEXt` chunks, so that Weald reads metres back to within half a step. A layer
//! with no-data cells keeps 0 for them and says so in a `tRNS` chunk, which GDAL takes for no-data as well.
//!
//! Other PNG files are read as the raw numbers 0 to 65535.

use std::io::Cursor;

use png::{BitDepth, ColorType, Decoder, Info, Reader};

use super::limits::{MAX_EXPANSION, ensure_can_hold};
use super::png::Pixels;
use super::provenance::{MAXIMUM, MINIMUM, finite};
use super::{Capabilities, Decode, Encode, Fault, Format, Limits, Metadata, Provenance, Raster, Values};
use weald_core::error::Error;
use weald_core::grid::Size;

/// The entry in the registry of formats.
pub(super) const FORMAT: Format = Format {
    name: "PNG",
    extensions: &["png"],
    decode: Some(Decode::File(decode)),
    encode: Some(Encode::File(encode)),
    holds: Capabilities { values: Values::Steps16, omits: &[Metadata::Place] },
    presets: &[],
};

/// Key of the side of a cell in metres.
const CELL: &str = "WEALD_CELL_METRES";

/// Room for the decoder beside the image: text chunks, palettes and its window. The image itself is
/// allocated here, after its size was checked.
const DECODER_BYTES: usize = 16 << 20;

const MAX_VALUE: f64 = 65535.0;

/// Reads a grey image.
///
/// # Errors
/// [`Fault`] for a file that is damaged, coloured, or over the limits.
pub fn decode(bytes: &[u8], limits: Limits) -> Result<Raster, Fault> {
    let own_limits = png::Limits { bytes: DECODER_BYTES };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), own_limits);
    let header = decoder.read_header_info().map_err(|cause| damaged(&cause))?;
    let size = limits.size(header.width as usize, header.height as usize)?;
    let depth = grey_depth(header)?;
    let mut reader = decoder.read_info().map_err(|cause| damaged(&cause))?;
    let pixel_bytes = size.cells() * if depth == BitDepth::Sixteen { 2 } else { 1 };
    ensure_can_hold(bytes.len(), pixel_bytes, MAX_EXPANSION)?;
    let mut pixels = vec![0; pixel_bytes];
    reader.next_frame(&mut pixels).map_err(|cause| damaged(&cause))?;
    reader.finish().map_err(|cause| damaged(&cause))?;
    raster(&reader, size, depth, &pixels)
}

fn damaged(cause: &png::DecodingError) -> Fault {
    Fault::damaged(format!("the PNG is damaged: {cause}"))
}

fn grey_depth(header: &Info<'_>) -> Result<BitDepth, Fault> {
    match (header.color_type, header.bit_depth) {
        (ColorType::Grayscale, depth @ (BitDepth::Eight | BitDepth::Sixteen)) => Ok(depth),
        (color, depth) => Err(Fault::damaged(format!(
            "the PNG is {color:?} with {} bits a channel; heights are read from grey PNG of 16 (or 8) bits",
            depth as u8
        ))),
    }
}

fn raster(
    reader: &Reader<Cursor<&[u8]>>,
    size: Size,
    depth: BitDepth,
    pixels: &[u8],
) -> Result<Raster, Fault> {
    let info = reader.info();
    let no_data = info.trns.as_deref().and_then(|transparent| match transparent {
        [grey] => Some(u16::from(*grey)),
        [high, low] => Some(u16::from_be_bytes([*high, *low])),
        _ => None,
    });
    let greys: Vec<u16> = match depth {
        BitDepth::Sixteen => pixels.chunks_exact(2).map(|two| u16::from_be_bytes([two[0], two[1]])).collect(),
        _ => pixels.iter().map(|&byte| u16::from(byte)).collect(),
    };
    let scale = Scale::read(info, no_data.is_some());
    let valid: Vec<bool> = greys.iter().map(|grey| Some(*grey) != no_data).collect();
    let value = |(grey, valid): (&u16, &bool)| if *valid { scale.value(*grey) } else { 0.0 };
    let values = greys.iter().zip(&valid).map(value).collect();
    let stored = if depth == BitDepth::Sixteen { "uint16" } else { "uint8" };
    let mut raster = Raster::from_file(size, values, valid, stored)?;
    raster.cell = text_of(info, CELL).and_then(|text| finite(&text)).filter(|cell| *cell > 0.0);
    raster.provenance = Provenance::from_items(|key| text_of(info, key));
    Ok(raster)
}

/// How greys stand for values.
struct Scale {
    low: f64,
    /// Value of one step of grey.
    step: f64,
    /// Grey of the lowest value.
    first: f64,
}

impl Scale {
    const RAW: Self = Self { low: 0.0, step: 1.0, first: 0.0 };

    /// Over the greys that are left beside no-data.
    fn new(low: f64, high: f64, has_no_data: bool) -> Self {
        let first = f64::from(u8::from(has_no_data));
        Self { low, step: (high - low) / (MAX_VALUE - first), first }
    }

    /// As the file says, or as they are.
    fn read(info: &Info<'_>, has_no_data: bool) -> Self {
        let bound = |key| text_of(info, key).and_then(|text| finite(&text));
        let within_f32 = |bound: &f64| bound.abs() <= f64::from(f32::MAX);
        match (bound(MINIMUM).filter(within_f32), bound(MAXIMUM).filter(within_f32)) {
            (Some(low), Some(high)) if low <= high && info.bit_depth == BitDepth::Sixteen => {
                Self::new(low, high, has_no_data)
            }
            _ => Self::RAW,
        }
    }

    fn value(&self, grey: u16) -> f32 {
        (self.low + (f64::from(grey) - self.first) * self.step) as f32
    }

    fn grey(&self, value: f32) -> u16 {
        if self.step == 0.0 {
            return self.first as u16;
        }
        (self.first + (f64::from(value) - self.low) / self.step).round() as u16
    }
}

fn text_of(info: &Info<'_>, key: &str) -> Option<String> {
    let plain = info.uncompressed_latin1_text.iter().find(|chunk| chunk.keyword == key);
    let unicode = || info.utf8_text.iter().find(|chunk| chunk.keyword == key);
    plain.map(|chunk| chunk.text.clone()).or_else(|| unicode()?.get_text().ok())
}

/// The bytes of a PNG file.
///
/// # Errors
/// [`Error::Run`] naming a cell with data that holds a NaN or an infinity.
pub fn encode(raster: &Raster) -> Result<Vec<u8>, Error> {
    raster.ensure_finite()?;
    let size = raster.field.size();
    let (low, high) = raster.range();
    let scale = Scale::new(f64::from(low), f64::from(high), raster.valid.is_some());
    let mut pixels = Vec::with_capacity(size.cells() * 2);
    for (index, value) in raster.field.values().iter().enumerate() {
        let grey = if raster.is_valid_at(index) { scale.grey(*value) } else { 0 };
        pixels.extend(grey.to_be_bytes());
    }
    pack(raster, &texts(raster, low, high), &pixels)
}

fn pack(raster: &Raster, texts: &[(&str, String)], pixels: &[u8]) -> Result<Vec<u8>, Error> {
    let Size { columns, rows } = raster.field.size();
    let (channels, depth) = (ColorType::Grayscale, BitDepth::Sixteen);
    Pixels { sides: [columns, rows], channels, depth, bytes: pixels }.marked(|encoder| {
        if raster.valid.is_some() {
            encoder.set_trns(vec![0, 0]);
        }
        for (key, text) in texts {
            let (key, text) = ((*key).to_owned(), text.clone());
            if text.is_ascii() {
                encoder.add_text_chunk(key, text)?;
            } else {
                encoder.add_itxt_chunk(key, text)?;
            }
        }
        Ok(())
    })
}

/// The range always, for without it the greys mean nothing; the rest where it is known.
fn texts(raster: &Raster, low: f32, high: f32) -> Vec<(&'static str, String)> {
    let range = [(MINIMUM, f64::from(low)), (MAXIMUM, f64::from(high))];
    let mut texts: Vec<_> = range.map(|(key, bound)| (key, format!("{bound:?}"))).to_vec();
    texts.push(("Software", concat!("Weald ", env!("CARGO_PKG_VERSION")).to_owned()));
    if let Some(cell) = raster.cell {
        texts.push((CELL, format!("{cell:?}")));
    }
    if raster.valid.is_some() {
        texts.push(("WEALD_NO_DATA", "cells of grey 0 hold no data".to_owned()));
    }
    if let Some(provenance) = &raster.provenance {
        let items = provenance.items().into_iter();
        texts.extend(items.filter(|(key, _)| ![MINIMUM, MAXIMUM].contains(key)));
    }
    texts
}

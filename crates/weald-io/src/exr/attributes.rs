//! Cell, place and provenance as attributes under names of our own.

use super::super::provenance::LAYER;
use super::super::{Fault, Provenance, Raster};
use super::header::Attributes;
use weald_core::domain::{GeoKeys, Georeference};

const CELL: &str = "WEALD_CELL_METRES";
const EPSG: &str = "WEALD_EPSG";
const ORIGIN: &str = "WEALD_ORIGIN";
const PIXEL: &str = "WEALD_PIXEL";
/// A CRS as GeoTIFF keys in JSON, for one without an EPSG code.
const KEYS: &str = "WEALD_GEOTIFF_KEYS";

/// An attribute to be written: name, type, value.
pub(super) type Written = (&'static str, &'static str, Vec<u8>);

/// What a raster knows beside its values.
pub(super) fn of(raster: &Raster) -> Vec<Written> {
    let text = |name, text: String| (name, "string", text.into_bytes());
    let mut attributes = vec![text("software", format!("Weald {}", env!("CARGO_PKG_VERSION")))];
    attributes.extend(raster.cell.map(|cell| (CELL, "double", cell.to_le_bytes().to_vec())));
    if let Some(place) = &raster.georeference {
        attributes.push((ORIGIN, "v2d", pair(place.origin)));
        attributes.push((PIXEL, "v2d", pair(place.pixel)));
        attributes.extend(place.epsg.map(|code| (EPSG, "int", code.to_le_bytes().to_vec())));
        let json = |keys| serde_json::to_string(keys).expect("keys are numbers and text");
        attributes.extend(place.keys.as_ref().map(|keys| text(KEYS, json(keys))));
    }
    if let Some(provenance) = &raster.provenance {
        attributes.extend(provenance.items().into_iter().map(|(key, value)| text(key, value)));
        attributes.push(text("comments", provenance.sentence()));
    }
    attributes
}

fn pair(numbers: [f64; 2]) -> Vec<u8> {
    numbers.map(f64::to_le_bytes).concat()
}

/// The raster with what the attributes say of it.
pub(super) fn described(raster: Raster, attributes: &Attributes<'_>) -> Result<Raster, Fault> {
    let text = |key: &str| {
        let value = attributes.value(key, "string").ok().flatten()?;
        String::from_utf8(value.to_vec()).ok()
    };
    let provenance =
        if attributes.value(LAYER, "string")?.is_some() { Provenance::from_items(text) } else { None };
    let cell = doubles::<1>(attributes, CELL, "double")?.map(|[cell]| cell);
    if let Some(cell) = cell.filter(|cell| *cell <= 0.0) {
        return Err(Fault::damaged(format!("attribute {CELL} is {cell}, but must be above 0")));
    }
    Ok(Raster { cell, georeference: place(attributes)?, provenance, ..raster })
}

fn place(attributes: &Attributes<'_>) -> Result<Option<Georeference>, Fault> {
    let (origin, pixel) = (doubles(attributes, ORIGIN, "v2d")?, doubles::<2>(attributes, PIXEL, "v2d")?);
    let (Some(origin), Some(pixel)) = (origin, pixel) else { return Ok(None) };
    if pixel.iter().any(|side| *side <= 0.0) {
        return Err(Fault::damaged(format!("attribute {PIXEL} is {pixel:?}; sides must be above 0")));
    }
    let epsg = attributes.value(EPSG, "int")?.map(|code| {
        let code = <[u8; 4]>::try_from(code).map(u32::from_le_bytes);
        code.map_err(|_| Fault::damaged(format!("attribute {EPSG} has not 4 bytes")))
    });
    let keys = attributes.value(KEYS, "string")?.map(|json| {
        let keys: Result<GeoKeys, _> = serde_json::from_slice(json);
        keys.map_err(|cause| Fault::damaged(format!("attribute {KEYS} is damaged: {cause}")))
    });
    Ok(Some(Georeference { epsg: epsg.transpose()?, origin, pixel, keys: keys.transpose()? }))
}

/// The finite numbers of an attribute.
fn doubles<const N: usize>(
    attributes: &Attributes<'_>,
    name: &str,
    kind: &str,
) -> Result<Option<[f64; N]>, Fault> {
    let Some(value) = attributes.value(name, kind)? else { return Ok(None) };
    let numbers: Vec<f64> = value
        .chunks_exact(8)
        .map(|eight| f64::from_le_bytes(eight.try_into().expect("eight bytes")))
        .collect();
    let numbers: Option<[f64; N]> = numbers.try_into().ok().filter(|_| value.len() == 8 * N);
    match numbers.filter(|numbers| numbers.iter().all(|number| number.is_finite())) {
        Some(numbers) => Ok(Some(numbers)),
        None => Err(Fault::damaged(format!("attribute {name} does not hold {N} finite numbers"))),
    }
}

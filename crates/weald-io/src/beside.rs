//! What GDAL keeps in `NAME.aux.xml` beside a file that cannot hold it: no-data, scale, offset and unit of the first band,
//! the place and the CRS (GDAL, "Persistent Auxiliary Metadata").
//!
//! What a file says of its unit, its place and its CRS counts before that.

use super::geokeys::{keys_of_definition, metres_per_unit, tell_a_crs};
use super::unit::Measure;
use super::wkt::Definition;
use super::{Fault, Raster, Said};
use weald_core::domain::Georeference;

/// What follows the name of the file.
pub(super) const BESIDE: &str = ".aux.xml";

/// A raster with what is said beside it.
///
/// # Errors
/// [`Fault::Damaged`] for numbers that are none, and coordinates that are neither lengths on a map nor degrees.
pub(super) fn with(raster: Raster, xml: &str) -> Result<Raster, Fault> {
    let band = xml
        .split_once("<PAMRasterBand band=\"1\"")
        .and_then(|(_, rest)| rest.split("</PAMRasterBand>").next());
    let raster = match band {
        Some(band) => with_band(raster, band)?,
        None => raster,
    };
    let whole = xml.split("<PAMRasterBand").next().unwrap_or_default();
    with_crs(with_place(raster, whole)?, whole)
}

/// A raster with the place that a world file beside it gives, where nothing else has said one: six lines, the width of a cell,
/// two turns, minus its height, and the centre of the north-western cell (Esri, "World files for raster datasets").
///
/// # Errors
/// [`Fault::Damaged`] for lines that are no numbers, and cells that are turned or from the south.
pub(super) fn with_world(raster: Raster, text: &str) -> Result<Raster, Fault> {
    if raster.georeference.is_some() {
        return Ok(raster);
    }
    let wrong = |what: &str| Fault::damaged(format!("the world file beside it {what}: gdalwarp it to .tif"));
    let numbers: Result<Vec<f64>, _> =
        text.split_whitespace().map(|line| line.replace(',', ".").parse()).collect();
    let numbers = numbers.map_err(|_| wrong("holds a line that is no number"))?;
    let &[width, down_turn, right_turn, down, east, north] = numbers.as_slice() else {
        return Err(wrong("has not six numbers"));
    };
    let is_straight = down_turn == 0.0 && right_turn == 0.0 && width > 0.0 && down < 0.0;
    if !is_straight || !numbers.iter().all(|number| number.is_finite()) {
        return Err(wrong("turns it or counts from the south"));
    }
    let origin = [east - 0.5 * width, north - 0.5 * down];
    let place = Georeference { epsg: None, origin, pixel: [width, -down], keys: None };
    let cell = raster.cell.or((width == -down).then_some(width));
    Ok(Raster { cell, georeference: Some(place), ..raster })
}

fn with_band(raster: Raster, band: &str) -> Result<Raster, Fault> {
    let number = |name: &str| text(band, name).map(|text| number(name, &text)).transpose();
    let said = Said { no_data: number("NoDataValue")?, ..Said::default() };
    let mut raster = said.of(raster).map_err(Fault::Damaged)?;
    let unit = text(band, "UnitType").filter(|_| raster.unit().is_none());
    let measure =
        Measure::new(number("Scale")?.unwrap_or(1.0), number("Offset")?.unwrap_or(0.0), unit.as_deref());
    let valid = raster.valid.clone();
    for (cell, value) in raster.field.values_mut().iter_mut().enumerate() {
        if valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell)) {
            *value = measure.value(f64::from(*value));
        }
    }
    raster.notes.extend(measure.notes());
    let unit = measure.unit().or(raster.unit);
    Ok(Raster { unit, ..raster })
}

/// The place, where the file has none: west, width, 0, north, 0, minus height.
fn with_place(raster: Raster, xml: &str) -> Result<Raster, Fault> {
    let Some(text) = text(xml, "GeoTransform").filter(|_| raster.georeference.is_none()) else {
        return Ok(raster);
    };
    let numbers: Vec<f64> =
        text.split(',').map(|text| number("GeoTransform", text)).collect::<Result<_, _>>()?;
    let &[west, width, 0.0, north, 0.0, down] = numbers.as_slice() else {
        return Err(refused(&text));
    };
    if !(width > 0.0 && down < 0.0) {
        return Err(refused(&text));
    }
    let place = Georeference { epsg: None, origin: [west, north], pixel: [width, -down], keys: None };
    let cell = raster.cell.or((width == -down).then_some(width));
    Ok(Raster { cell, georeference: Some(place), ..raster })
}

fn refused(transform: &str) -> Fault {
    Fault::damaged(format!(
        "{BESIDE} places it by {transform}, turned or from the south: gdalwarp it to .tif"
    ))
}

/// The CRS, where the file has a place and no CRS.
fn with_crs(raster: Raster, xml: &str) -> Result<Raster, Fault> {
    let untold = raster
        .georeference
        .as_ref()
        .filter(|place| place.epsg.is_none() && !place.keys.as_ref().is_some_and(tell_a_crs));
    let definition = text(xml, "SRS").and_then(|wkt| Definition::of(&wkt));
    let (Some(place), Some(definition)) = (untold, definition) else { return Ok(raster) };
    let keys = keys_of_definition(&definition)?;
    let metres = metres_per_unit(Some(&keys))?;
    let place = Georeference { epsg: definition.epsg, keys: Some(keys), ..place.clone() };
    let cell = if place.is_geographic() { None } else { raster.cell.map(|cell| cell * metres) };
    Ok(Raster { cell, georeference: Some(place), ..raster })
}

fn number(name: &str, text: &str) -> Result<f64, Fault> {
    text.trim()
        .parse()
        .map_err(|_| Fault::damaged(format!("{BESIDE}: {name} is {text:?}, which is no number")))
}

/// What stands in an element.
fn text(xml: &str, name: &str) -> Option<String> {
    let opening = format!("<{name}");
    let mut openings = xml.match_indices(&opening).map(|(at, opening)| &xml[at + opening.len()..]);
    let inside = openings.find(|rest| rest.starts_with(['>', ' ']))?.split_once('>')?.1;
    let text = inside.split_once(&format!("</{name}>"))?.0.trim();
    let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&");
    (!text.is_empty()).then_some(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::{Field, Size};

    fn raster() -> Raster {
        Raster::from(Field::from_function(Size { columns: 2, rows: 2 }, |x, y| (10 * y + x) as f32))
    }

    #[test]
    fn no_data_scale_unit_and_place_beside_a_file_count() {
        let xml = "<PAMDataset><SRS dataAxisToSRSAxisMapping=\"1,2\">PROJCS[&quot;p&quot;,UNIT[&quot;foot&quot;,0.3048]]</SRS>\
                   <GeoTransform> 5e5, 1e1, 0, 4e6, 0, -1e1</GeoTransform><PAMRasterBand band=\"1\"><NoDataValue \
                   le_hex_equiv=\"0\">1.0E1</NoDataValue><UnitType>ft</UnitType><Offset>100</Offset><Scale>0.5</Scale>\
                   </PAMRasterBand><PAMRasterBand band=\"2\"><Scale>7</Scale></PAMRasterBand></PAMDataset>";
        let read = with(raster(), xml).expect("reads");
        let metres = [100.0, 100.5, 105.5].map(|feet| (feet * 0.3048) as f32);
        assert_eq!(read.field.values(), [metres[0], metres[1], 0.0, metres[2]]);
        assert_eq!(
            read.valid.as_ref().map(|valid| valid.flags().to_vec()),
            Some(vec![true, true, false, true])
        );
        assert_eq!(read.unit(), Some("m"));
        assert_eq!(read.cell, Some(3.048));
        assert_eq!(read.georeference.expect("placed").origin, [5e5, 4e6]);
    }

    #[test]
    fn a_world_file_places_what_says_no_place_itself() {
        let read = with_world(raster(), "30\n0\n0\n-30.0\n500015\n3999985\n").expect("reads");
        let place = read.georeference.clone().expect("placed");
        assert_eq!((place.origin, place.pixel, read.cell), ([5e5, 4e6], [30.0; 2], Some(30.0)));
        assert_eq!(with_world(read.clone(), "nothing"), Ok(read), "its own place counts");
        for wrong in
            ["30\n0\n0\n-30\n5", "a\nb", "30\n1\n0\n-30\n5\n6", "30\n0\n0\n30\n5\n6", "30 0 0 -30 nan 6"]
        {
            assert!(with_world(raster(), wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn statistics_alone_change_nothing_and_turned_places_are_refused() {
        let statistics = "<PAMDataset><PAMRasterBand band=\"1\"><Metadata><MDI key=\"STATISTICS_MEAN\">5</MDI></Metadata>\
                          </PAMRasterBand></PAMDataset>";
        assert_eq!(with(raster(), statistics), Ok(raster()));
        assert_eq!(with(raster(), ""), Ok(raster()));
        let turned = "<GeoTransform>0, 1, 1, 0, 1, -1</GeoTransform>";
        assert!(with(raster(), turned).is_err_and(|fault| fault.to_string().contains("gdalwarp")));
        let wrong = "<PAMRasterBand band=\"1\"><Scale>many</Scale></PAMRasterBand>";
        assert!(with(raster(), wrong).is_err_and(|fault| fault.to_string().contains("no number")));
    }
}

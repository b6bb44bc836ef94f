//! GDAL's two private tags: 42113 names the no-data number as text, 42112 carries items of text as XML, among them
//! scale, offset and unit of the values.

use super::super::unit::Measure;
use super::super::{Fault, Provenance};
use super::directory::Directory;
use super::directory::tag;

/// The number that marks no-data cells, where the file declares one.
pub(super) fn no_data(directory: &Directory<'_>) -> Result<Option<f64>, Fault> {
    let Some(text) = directory.text(tag::GDAL_NO_DATA)? else { return Ok(None) };
    let text = String::from_utf8_lossy(text);
    let number = text.trim().parse().map_err(|_| {
        Fault::damaged(format!(
            "the no-data value {text:?} of tag 42113 is no number; set one with gdal_translate -a_nodata -9999"
        ))
    })?;
    Ok(Some(number))
}

/// Refuses a file whose no-data cells stand in a mask of its own, which would count as data without it.
pub(super) fn ensure_no_mask(directory: &Directory<'_>) -> Result<(), Fault> {
    let is_mask = |other: &Directory<'_>| matches!(other.number(tag::NEW_SUBFILE_TYPE), Ok(Some(kind)) if kind & 4 != 0);
    if !directory.others().any(|other| is_mask(&other)) {
        return Ok(());
    }
    Err(Fault::damaged(
        "the cells without data stand in a mask of their own; turn it into a no-data value with gdalwarp \
         -dstnodata -9999 in.tif out.tif",
    ))
}

/// Where the file came from, if Weald wrote it.
pub(super) fn provenance(directory: &Directory<'_>) -> Result<Option<Provenance>, Fault> {
    let Some(xml) = directory.text(tag::GDAL_METADATA)? else { return Ok(None) };
    let xml = String::from_utf8_lossy(xml);
    Ok(Provenance::from_items(|key| item(&xml, key)))
}

/// How the numbers of the file become values; `vertical` is the unit of the heights by the CRS.
///
/// Where the CRS has heights, GDAL keeps scale and offset in the third dimension of the pixel scale and of the tie point.
pub(super) fn measure(directory: &Directory<'_>, vertical: Option<String>) -> Result<Measure, Fault> {
    let xml = String::from_utf8_lossy(directory.text(tag::GDAL_METADATA)?.unwrap_or_default());
    let third = if vertical.is_some() { third_dimension(directory)? } else { (1.0, 0.0) };
    let number = |role: &str, usual: f64| match band_item(&xml, role) {
        None => Ok(usual),
        Some(text) => text.trim().parse::<f64>().ok().filter(|it| it.is_finite()).ok_or_else(|| {
            Fault::damaged(format!(
                "the {role} {text:?} of tag 42112 is no number; set one with gdal_edit.py -{role} 1"
            ))
        }),
    };
    let unit = band_item(&xml, "unittype").filter(|unit| !unit.is_empty()).or(vertical);
    Ok(Measure::new(number("scale", third.0)?, number("offset", third.1)?, unit.as_deref()))
}

/// Scale and offset of heights by the pixel scale and the tie point, where these have a third dimension.
fn third_dimension(directory: &Directory<'_>) -> Result<(f64, f64), Fault> {
    let scale = directory.doubles(tag::MODEL_PIXEL_SCALE)?.unwrap_or_default();
    let tie = directory.doubles(tag::MODEL_TIE_POINT)?.unwrap_or_default();
    match (scale.as_slice(), tie.as_slice()) {
        ([_, _, scale, ..], [_, _, level, _, _, height, ..]) if *scale != 0.0 && scale.is_finite() => {
            Ok((*scale, height - level * scale))
        }
        _ => Ok((1.0, 0.0)),
    }
}

/// The text of the item that has a role for the first band, as `<Item name="SCALE" sample="0" role="scale">0.1</Item>`.
fn band_item(xml: &str, role: &str) -> Option<String> {
    let role = format!("role=\"{role}\"");
    let mut items = xml.split("<Item ").skip(1).filter_map(|item| item.split_once('>'));
    let is_first = |attributes: &str| !attributes.contains("sample=") || attributes.contains("sample=\"0\"");
    let (_, text) = items.find(|(attributes, _)| attributes.contains(&role) && is_first(attributes))?;
    Some(unescaped(text.split_once("</Item>")?.0))
}

/// The items of a provenance as GDAL writes metadata, with the unit once more where GDAL looks for it.
pub(super) fn xml(provenance: &Provenance) -> String {
    let items = provenance.items();
    let items = items.iter().map(|(key, text)| format!("  <Item name=\"{key}\">{}</Item>\n", escaped(text)));
    format!(
        "<GDALMetadata>\n{}  <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">{}</Item>\n  \
         <Item name=\"DESCRIPTION\" sample=\"0\" role=\"description\">{}</Item>\n</GDALMetadata>\n",
        items.collect::<String>(),
        escaped(&provenance.unit),
        escaped(&provenance.layer),
    )
}

/// The unit alone, which counts before that of the heights of the CRS.
pub(super) fn xml_of_unit(unit: &str) -> String {
    let unit = escaped(unit);
    format!(
        "<GDALMetadata>\n  <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">{unit}</Item>\n</GDALMetadata>\n"
    )
}

/// The text of the item of that name.
fn item(xml: &str, key: &str) -> Option<String> {
    let (_, item) = xml.split_once(&format!("<Item name=\"{key}\""))?;
    let (_, text) = item.split_once('>')?;
    let (text, _) = text.split_once("</Item>")?;
    Some(unescaped(text))
}

pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The ampersand comes last, so that `&amp;lt;` becomes `&lt;` and no more.
fn unescaped(text: &str) -> String {
    text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
}

#[cfg(test)]
mod tests {
    use super::super::super::provenance::tests::example;
    use super::*;

    #[test]
    fn markup_in_a_provenance_is_escaped_and_survives() {
        let written = xml(&example());
        let layer = "<Item name=\"WEALD_LAYER\">water&lt;&quot;&amp;&quot;&gt;</Item>";
        assert!(written.contains(layer), "{written}");
        assert_eq!(Provenance::from_items(|key| item(&written, key)), Some(example()));
    }

    #[test]
    fn scale_and_offset_are_those_of_the_first_band() {
        let xml = "<GDALMetadata>\n  <Item name=\"SCALE\" sample=\"1\" role=\"scale\">7</Item>\n\
                   <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.1</Item>\n\
                   <Item name=\"UNITTYPE\" sample=\"0\" role=\"unittype\">ft</Item></GDALMetadata>";
        assert_eq!(band_item(xml, "scale").as_deref(), Some("0.1"));
        assert_eq!(band_item(xml, "unittype").as_deref(), Some("ft"));
        assert_eq!(band_item(xml, "offset"), None);
    }

    #[test]
    fn damaged_metadata_is_no_provenance() {
        let written = xml(&example());
        let lengths = 0..written.find("WEALD_MAXIMUM").expect("written");
        for length in lengths.filter(|&length| written.is_char_boundary(length)) {
            assert_eq!(Provenance::from_items(|key| item(&written[..length], key)), None);
        }
    }
}

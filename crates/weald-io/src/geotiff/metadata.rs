//! GDAL's two private tags: 42113 names the no-data number as text, 42112 carries items of text as XML.

use super::super::{Fault, Provenance};
use super::directory::Directory;
use super::tag;

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

/// The text of the item of that name.
fn item(xml: &str, key: &str) -> Option<String> {
    let (_, item) = xml.split_once(&format!("<Item name=\"{key}\""))?;
    let (_, text) = item.split_once('>')?;
    let (text, _) = text.split_once("</Item>")?;
    Some(unescaped(text))
}

fn escaped(text: &str) -> String {
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
    fn damaged_metadata_is_no_provenance() {
        let written = xml(&example());
        let lengths = 0..written.find("WEALD_MAXIMUM").expect("written");
        for length in lengths.filter(|&length| written.is_char_boundary(length)) {
            assert_eq!(Provenance::from_items(|key| item(&written[..length], key)), None);
        }
    }
}

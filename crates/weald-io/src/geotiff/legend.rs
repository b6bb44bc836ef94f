//! What classes mean, in files beside a GeoTIFF, which has no place for it: names as GDAL keeps them (`.aux.xml`) and a style
//! by which QGIS draws the file when it opens it (`.qml`).

use super::super::classes::Classes;
use super::super::{Part, Raster};
use super::metadata::escaped;

/// Most classes that have a colour and a name of their own.
const MAX_CLASSES: usize = 4096;

/// The files beside a raster of classes; none beside another one.
pub(super) fn parts(raster: &Raster) -> Vec<Part> {
    let Some(classes) = raster.classes.as_ref().filter(|classes| classes.named.len() <= MAX_CLASSES) else {
        return Vec::new();
    };
    let mut parts = vec![Part::sibling(".qml", style(classes).into_bytes())];
    // GDAL counts names from 0, so that numbers far apart would need as many lines between them.
    if classes.greatest < MAX_CLASSES as u32 {
        parts.push(Part::beside(".aux.xml", names(classes).into_bytes()));
    }
    parts
}

/// Names of the numbers from 0 on, as GDAL's persistent auxiliary metadata have them.
fn names(classes: &Classes) -> String {
    let name = |number: u32| classes.named.iter().find(|class| class.number == number);
    let lines = (0..=classes.greatest).map(|number| {
        let name = name(number).map_or_else(String::new, |class| escaped(&class.name));
        format!("      <Category>{name}</Category>\n")
    });
    format!(
        "<PAMDataset>\n  <PAMRasterBand band=\"1\">\n    <CategoryNames>\n{}    </CategoryNames>\n  </PAMRasterBand>\n\
         </PAMDataset>\n",
        lines.collect::<String>()
    )
}

/// A style of QGIS: a colour and a label a number.
fn style(classes: &Classes) -> String {
    let entries = classes.named.iter().map(|class| {
        let [red, green, blue] = class.colour;
        format!(
            "        <paletteEntry value=\"{}\" color=\"#{red:02x}{green:02x}{blue:02x}\" alpha=\"255\" label=\"{}\"/>\n",
            class.number,
            escaped(&class.name)
        )
    });
    format!(
        "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n\
         <qgis version=\"3.22\" styleCategories=\"Symbology\">\n  <pipe>\n    \
         <rasterrenderer type=\"paletted\" band=\"1\" opacity=\"1\" alphaBand=\"-1\" nodataColor=\"\">\n      \
         <rasterTransparency/>\n      <colorPalette>\n{}      </colorPalette>\n    </rasterrenderer>\n  </pipe>\n  \
         <blendMode>0</blendMode>\n</qgis>\n",
        entries.collect::<String>()
    )
}

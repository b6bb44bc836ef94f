//! What classes mean and how measures are drawn, in files beside a GeoTIFF, which has no place for it: names as GDAL keeps
//! them (`.aux.xml`) and a style by which QGIS draws the file when it opens it (`.qml`).

use super::super::classes::Classes;
use super::super::{Part, Raster, Shades};
use super::metadata::escaped;
use weald_core::layer_words::shown_unit;

/// Most classes that have a colour and a name of their own.
const MAX_CLASSES: usize = 4096;

/// That a legend has a line a colour, with its value and unit: a band of colours would have the least and the greatest value alone,
/// and that between them evenly, which areas are not.
const LINES: &str = "          <rampLegendSettings useContinuousLegend=\"0\"/>\n";

/// The files beside a raster of classes or of measures with colours; none beside another one.
pub(super) fn parts(raster: &Raster) -> Vec<Part> {
    match (&raster.classes, &raster.shades) {
        (Some(classes), _) if classes.named.len() <= MAX_CLASSES => parts_of_classes(classes),
        (None, Some(shades)) => vec![Part::sibling(".qml", style_of_shades(shades, raster).into_bytes())],
        _ => Vec::new(),
    }
}

fn parts_of_classes(classes: &Classes) -> Vec<Part> {
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
    renderer(
        "paletted",
        "",
        &format!("      <colorPalette>\n{}      </colorPalette>\n", entries.collect::<String>()),
    )
}

/// A style of QGIS: colours between values.
fn style_of_shades(shades: &Shades, raster: &Raster) -> String {
    let (unit, range) = unit_and_range(raster);
    let stops = shades.stops(range);
    let [first, last] = [stops.first(), stops.last()].map(|stop| stop.map_or(0.0, |stop| stop.0));
    let items = stops.iter().map(|&(value, [red, green, blue])| {
        format!(
            "          <item value=\"{value}\" color=\"#{red:02x}{green:02x}{blue:02x}\" alpha=\"255\" label=\"{}\"/>\n",
            escaped(&label(value, unit))
        )
    });
    let bounds = format!(" classificationMin=\"{first}\" classificationMax=\"{last}\"");
    let shader = format!(
        "      <rastershader>\n        <colorrampshader colorRampType=\"INTERPOLATED\" classificationMode=\"1\" clip=\"0\" \
         minimumValue=\"{first}\" maximumValue=\"{last}\">\n{}{LINES}        </colorrampshader>\n      </rastershader>\n",
        items.collect::<String>()
    );
    renderer("singlebandpseudocolor", &bounds, &shader)
}

/// As a file says them, or as the values are.
fn unit_and_range(raster: &Raster) -> (&str, (f64, f64)) {
    if let Some(provenance) = &raster.provenance {
        return (&provenance.unit, provenance.range);
    }
    let (low, high) = raster.field.range(raster.valid.as_ref()).unwrap_or_default();
    (raster.unit.as_deref().unwrap_or_default(), (low.into(), high.into()))
}

/// A value of three digits with its unit.
fn label(value: f64, unit: &str) -> String {
    let magnitude = value.abs();
    let number = if value == 0.0 || (0.01..1e6).contains(&magnitude) {
        let digits = if magnitude >= 100.0 || value == 0.0 {
            0
        } else if magnitude >= 10.0 {
            1
        } else {
            3
        };
        format!("{value:.digits$}")
    } else {
        format!("{value:.2e}")
    };
    let unit = shown_unit(unit);
    if unit.is_empty() { number } else { format!("{number} {unit}") }
}

/// A style of one renderer.
fn renderer(kind: &str, attributes: &str, inside: &str) -> String {
    format!(
        "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n\
         <qgis version=\"3.22\" styleCategories=\"Symbology\">\n  <pipe>\n    \
         <rasterrenderer type=\"{kind}\" band=\"1\" opacity=\"1\" alphaBand=\"-1\" nodataColor=\"\"{attributes}>\n      \
         <rasterTransparency/>\n{inside}    </rasterrenderer>\n  </pipe>\n  \
         <blendMode>0</blendMode>\n</qgis>\n"
    )
}

//! Styles by which QGIS draws vectors when it opens them: a `.qml` file beside them, of the same name.

use std::ops::RangeInclusive;

use weald_io::{Part, PartName};

/// What the name of a style has in place of the extension of the file that it is for.
const STYLE: &str = ".qml";

/// Red, green, blue and opacity, as QGIS writes them.
const RIVER: &str = "40,110,200,255";
const LAKE: &str = "150,196,232,255";
const PLANT: &str = "58,122,60,255";
const PLANT_EDGE: &str = "24,62,28,255";

/// Millimetres that the line of a river of the first order is wide, and what each order adds.
const LINE: [f64; 2] = [0.3, 0.3];

/// The name of a style beside a file.
pub(crate) fn name() -> PartName {
    PartName::Sibling(STYLE.to_owned())
}

/// Rivers, the wider the higher their Strahler order is.
pub(super) fn of_rivers(orders: RangeInclusive<u32>) -> Part {
    let categories = orders.clone().enumerate().map(|(at, order)| {
        format!(
            "      <category value=\"{order}\" symbol=\"{at}\" label=\"order {order}\" render=\"true\"/>\n"
        )
    });
    let categories = format!("    <categories>\n{}    </categories>\n", categories.collect::<String>());
    let symbols: String = orders.enumerate().map(|(at, order)| river(at, order)).collect();
    style(("categorizedSymbol", " attr=\"order\""), &categories, &symbols)
}

/// The line of rivers of an order.
fn river(name: usize, order: u32) -> String {
    let width = format!("{:.1}", LINE[0] + LINE[1] * f64::from(order.saturating_sub(1)));
    let line = [
        ("line_color", RIVER),
        ("line_width", &width),
        ("line_width_unit", "MM"),
        ("capstyle", "round"),
        ("joinstyle", "round"),
    ];
    symbol(name, ("line", "SimpleLine"), &line)
}

/// Lakes as blue areas with a shore.
pub(super) fn of_lakes() -> Part {
    let area = [
        ("color", LAKE),
        ("style", "solid"),
        ("outline_color", RIVER),
        ("outline_style", "solid"),
        ("outline_width", "0.3"),
        ("outline_width_unit", "MM"),
        ("joinstyle", "round"),
    ];
    style(("singleSymbol", ""), "", &symbol(0, ("fill", "SimpleFill"), &area))
}

/// Plants as green points.
pub(crate) fn of_plants() -> Part {
    let point = [
        ("name", "circle"),
        ("color", PLANT),
        ("size", "1.2"),
        ("size_unit", "MM"),
        ("outline_color", PLANT_EDGE),
        ("outline_style", "solid"),
        ("outline_width", "0.1"),
        ("outline_width_unit", "MM"),
    ];
    style(("singleSymbol", ""), "", &symbol(0, ("marker", "SimpleMarker"), &point))
}

/// A symbol of one layer with its options.
fn symbol(name: usize, (kind, class): (&str, &str), options: &[(&str, &str)]) -> String {
    let options = options.iter().map(|(name, value)| {
        format!("            <Option name=\"{name}\" value=\"{value}\" type=\"QString\"/>\n")
    });
    format!(
        "      <symbol name=\"{name}\" type=\"{kind}\" alpha=\"1\" clip_to_extent=\"1\" force_rhr=\"0\">\n        \
         <layer class=\"{class}\" enabled=\"1\" locked=\"0\" pass=\"0\">\n          <Option type=\"Map\">\n{}          \
         </Option>\n        </layer>\n      </symbol>\n",
        options.collect::<String>()
    )
}

/// A style of one renderer.
fn style((kind, attributes): (&str, &str), inside: &str, symbols: &str) -> Part {
    let text = format!(
        "<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>\n\
         <qgis version=\"3.22\" styleCategories=\"Symbology\">\n  \
         <renderer-v2 type=\"{kind}\"{attributes} symbollevels=\"0\" enableorderby=\"0\" forceraster=\"0\">\n{inside}    \
         <symbols>\n{symbols}    </symbols>\n  </renderer-v2>\n  <blendMode>0</blendMode>\n</qgis>\n"
    );
    Part::sibling(STYLE, text.into_bytes())
}

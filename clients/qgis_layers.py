"""Opens every file of a folder in QGIS, as one who drags it into an empty project, and says what is wrong with it.

    QT_QPA_PLATFORM=offscreen python3 clients/qgis_layers.py FOLDER WANTED [PICTURES]

WANTED is JSON: the EPSG code (`epsg`, null without a CRS), the extent of the rasters (`extent`: west, south, east, north) and
a cell without data (`hole`: coordinates, or null). PICTURES is a folder for a picture of each layer. Every file has to be a
layer at that place, in the colours of the style beside it and in no default ones, each with a line of a legend; where there is no
data nothing is drawn. Prints a line a file; faults go to stderr, and the program ends with 1.
"""

import json
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from qgis.core import (
    QgsApplication,
    QgsLayerTreeLayer,
    QgsMapRendererSequentialJob,
    QgsMapSettings,
    QgsPointXY,
    QgsRasterLayer,
    QgsRectangle,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QSize, Qt
from qgis.PyQt.QtGui import QColor

# Points of a picture along its longer side.
SIDE = 600


class Fault(Exception):
    """What a user would complain of."""


def need(holds, complaint):
    if not holds:
        raise Fault(complaint)


def drawn(layer, extent):
    """The layer alone on a transparent ground."""
    settings = QgsMapSettings()
    settings.setLayers([layer])
    settings.setExtent(extent)
    settings.setDestinationCrs(layer.crs())
    longer = max(extent.width(), extent.height())
    settings.setOutputSize(QSize(*(max(1, round(SIDE * side / longer)) for side in (extent.width(), extent.height()))))
    settings.setBackgroundColor(QColor(Qt.transparent))
    job = QgsMapRendererSequentialJob(settings)
    job.start()
    job.waitForFinished()
    need(not job.errors(), f"is not drawn: {[error.message for error in job.errors()]}")
    return job.renderedImage(), settings.mapToPixel()


def colours(image):
    """All colours that are drawn opaque, and how many points each has."""
    found = {}
    for y in range(image.height()):
        for x in range(image.width()):
            colour = image.pixelColor(x, y)
            if colour.alpha() == 255:
                found[colour.name()] = found.get(colour.name(), 0) + 1
    return found


def legend(layer):
    """The lines of the legend below the name of the band, as the panel of layers shows them."""
    nodes = layer.legend().createLayerTreeModelLegendNodes(QgsLayerTreeLayer(layer))
    texts = [str(node.data(Qt.DisplayRole)) for node in nodes]
    return [text for text in texts if not text.startswith("Band ")]


def same_place(layer, extent, wanted, of_raster):
    code = "" if wanted["epsg"] is None else f"EPSG:{wanted['epsg']}"
    need(layer.crs().authid() == code, f"is in the CRS {layer.crs().authid()!r}, not in {code!r}")
    west, south, east, north = wanted["extent"]
    cell = 1e-9 * max(map(abs, wanted["extent"]))
    found = [extent.xMinimum(), extent.yMinimum(), extent.xMaximum(), extent.yMaximum()]
    if of_raster:
        off = max(abs(a - b) for a, b in zip(found, wanted["extent"]))
        need(off <= cell, f"reaches over {found}, not {wanted['extent']}")
    else:
        inside = west - cell <= found[0] and south - cell <= found[1] and found[2] <= east + cell and found[3] <= north + cell
        need(inside, f"reaches over {found}, beyond the rasters")
        spread = (found[2] - found[0]) / (east - west), (found[3] - found[1]) / (north - south)
        need(min(spread) > 0.2, f"reaches over {found}, a small part of the rasters")


def style_beside(path):
    style = path.with_suffix(".qml")
    need(style.exists(), "has no style beside it")
    return ElementTree.parse(style).getroot()


def raster(path, wanted, pictures):
    layer = QgsRasterLayer(str(path), path.stem)
    need(layer.isValid(), f"is no layer: {layer.error().message()}")
    same_place(layer, layer.extent(), wanted, True)
    style = style_beside(path)
    entries = style.findall(".//paletteEntry") or style.findall(".//item")
    ours = [(float(entry.get("value")), entry.get("color"), entry.get("label")) for entry in entries]
    renderer = layer.renderer()
    if renderer.type() == "paletted":
        theirs = [(entry.value, entry.color.name(), entry.label) for entry in renderer.classes()]
    elif renderer.type() == "singlebandpseudocolor":
        items = renderer.shader().rasterShaderFunction().colorRampItemList()
        theirs = [(item.value, item.color.name(), item.label) for item in items]
    else:
        raise Fault(f"is drawn by {renderer.type()}, as a file without a style is")
    need(ours and theirs == ours, f"is drawn in {theirs}, not in those of its style: {ours}")
    texts = legend(layer)
    need(texts == [label for _, _, label in ours], f"has the legend {texts}")
    image, at = drawn(layer, layer.extent())
    if pictures:
        image.save(str(pictures / f"{path.stem}.png"))
    found = colours(image)
    no_data = layer.dataProvider().sourceHasNoDataValue(1)
    if wanted["hole"] is not None:
        need(no_data, "has no value for cells without data")
        point = at.transform(QgsPointXY(*wanted["hole"]))
        alpha = image.pixelColor(round(point.x()), round(point.y())).alpha()
        need(alpha == 0, f"has opacity {alpha} where it has no data")
    if renderer.type() == "paletted":
        strange = set(found) - {colour for _, colour, _ in ours}
        need(not strange, f"has the colours {strange}, which no class has")
    else:
        need(len(found) > 1, f"has but the colours {found}")
    return f"{renderer.type()}, {len(found)} colours, legend {texts[0]!r} to {texts[-1]!r}"


def vector(path, wanted, pictures):
    layer = QgsVectorLayer(str(path), path.stem, "ogr")
    need(layer.isValid(), f"is no layer: {layer.error().message()}")
    need(layer.featureCount() > 0, "has no features")
    same_place(layer, layer.extent(), wanted, False)
    style = style_beside(path)
    renderer = layer.renderer()
    need(renderer.type() == style.find("renderer-v2").get("type"), f"is drawn by {renderer.type()}")
    lines = style.findall(".//symbols/symbol/layer")
    if renderer.type() == "categorizedSymbol":
        # They own the symbols, so that they have to last as long.
        categories = renderer.categories()
        symbols = [category.symbol() for category in categories]
        orders = {feature["order"] for feature in layer.getFeatures()}
        named = {int(category.value()) for category in categories}
        need(orders <= named, f"has the orders {orders}, and its style {named}")
        need(legend(layer) == [f"order {order}" for order in sorted(named)], f"has the legend {legend(layer)}")
        widths = [symbol.width() for symbol in symbols]
        need(widths == sorted(set(widths)), f"has lines of {widths} mm")
    else:
        symbols = [renderer.symbol()]
    for symbol, line in zip(symbols, lines, strict=True):
        ours = {option.get("name"): option.get("value") for option in line.findall(".//Option[@name]")}
        theirs = symbol.symbolLayer(0).properties()
        others = {name: theirs.get(name) for name, value in ours.items() if theirs.get(name) != value}
        need(not others, f"is drawn with {others}, not as its style says: {ours}")
    extent = QgsRectangle(*wanted["extent"])
    image, _ = drawn(layer, extent)
    if pictures:
        image.save(str(pictures / f"{path.stem}.png"))
    need(colours(image), "is drawn without a point")
    return f"{renderer.type()}, {layer.featureCount()} features"


def table(path):
    """What has columns and no place of its own: QGIS asks which of them are coordinates, and suggests these."""
    layer = QgsVectorLayer(f"file://{path}?type=csv&xField=x&yField=y&zField=z", path.stem, "delimitedtext")
    need(layer.isValid() and layer.featureCount() > 0, "is no table of points")
    return f"a table of {layer.featureCount()} points"


def main(folder, wanted, pictures=None):
    application = QgsApplication([], False)
    application.initQgis()
    faults = 0
    pictures = Path(pictures) if pictures else None
    for path in sorted(Path(folder).iterdir()):
        openers = {
            ".tif": lambda path: raster(path, wanted, pictures),
            ".geojson": lambda path: vector(path, wanted, pictures),
            ".csv": table,
        }
        if path.suffix not in openers:
            continue
        try:
            print(f"{path.name}: {openers[path.suffix](path)}")
        except Fault as fault:
            print(f"{path.name} {fault}", file=sys.stderr)
            faults += 1
    return 1 if faults else 0


if __name__ == "__main__":
    # Without leaving QGIS in order, which some of its versions do not survive.
    import os

    code = main(sys.argv[1], json.loads(sys.argv[2]), *sys.argv[3:])
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)

"""Landscapes: layers of one grid, as NumPy arrays."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import ItemsView, Iterator, KeysView, Mapping, Sequence, ValuesView
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _weald
from ._errors import UsageError
from ._pictures import Film, Picture
from ._place import affine, epsg_of, place
from ._progress import shown, warn
from ._steps import StepReport, Steps

if TYPE_CHECKING:
    from types import ModuleType

    import xarray

Array = NDArray[np.float32]


class Landscape(Steps, _weald.Landscape):
    """A grid of square cells, its layers by name, and what grows on it. Row 0 is north.

    `land["height"]` is an array that shares the memory of the layer and cannot be written to; it stays as it is when a step
    puts another layer in its place. `land["rain"] = array` copies the array, once.

    >>> import numpy as np
    >>> heights = np.add.outer(np.arange(4.0), np.arange(5.0))
    >>> land = Landscape(heights, cell=10.0)
    >>> list(land), land.shape, land.cell
    (['height'], (4, 5), 10.0)
    >>> land["height"].flags.writeable
    False
    >>> float(land.slope().max()) > 0.1
    True
    """

    def __new__(
        cls,
        height: ArrayLike | _weald.Landscape,
        cell: float | None = None,
        *,
        crs: Any = None,
        transform: Any = None,
        mask: ArrayLike | None = None,
        nodata: float | None = None,
    ) -> Self:
        """Heights in metres, of rows and columns, become the layer `height`, with one copy.

        cell: width of a cell in metres, where `transform` does not say it.
        crs: EPSG code, "EPSG:32633", or an object of pyproj or rasterio.
        transform: affine transform of the array, of rasterio or as six numbers: without rotation, rows to the south.
        mask: flags that are true where there is data. Cells that are not finite hold none anyway.
        nodata: a value that stands for no data.
        """
        if isinstance(height, _weald.Landscape):
            return super().__new__(cls, height)
        values = np.asanyarray(height)
        flags = [] if mask is None else [np.asarray(mask, dtype=bool)]
        if isinstance(values, np.ma.MaskedArray):
            flags.append(~np.ma.getmaskarray(values))
            values = values.data
        if nodata is not None and not np.isnan(nodata):
            flags.append(values != nodata)
        valid = np.logical_and.reduce(flags) if flags else None
        return super().__new__(cls, _native(values), place(cell, crs, transform), valid)

    @classmethod
    def empty(cls, columns: int, rows: int, cell: float) -> Self:
        """A landscape without layers; `cell` is the width of a cell in metres."""
        return cls(_weald.Landscape.make_empty(columns, rows, cell))

    @classmethod
    def open(cls, path: str | os.PathLike[str], cell: float | None = None) -> Self:
        """A raster file of any format that Weald reads, with its CRS and its cells without data. One in degrees, or of
        oblong cells, comes out in square cells of metres."""
        land, notes = _weald.Landscape.open_file(os.fspath(path), cell)
        for note in notes:
            warn(note)
        return cls(land)

    @classmethod
    def from_xarray(cls, data: xarray.DataArray, cell: float | None = None) -> Self:
        """An array of xarray, with the CRS and transform that rioxarray or its coordinates give it."""
        from ._xarray import landscape

        return landscape(cls, data, cell)

    @classmethod
    def from_rasterio(cls, source: Any, band: int = 1) -> Self:
        """An open dataset of rasterio."""
        return cls(source.read(band, masked=True), crs=source.crs, transform=source.transform)

    def copy(self) -> Self:
        """The same landscape; both share their layers until one of them replaces some."""
        return type(self)(self)

    # What a mapping has.

    def __getitem__(self, name: str) -> Array:
        return self.lent(name)

    def __setitem__(self, name: str, values: ArrayLike) -> None:
        unit = self.unit(name) if name in self else _usual_unit(name)
        self.set(name, values, unit)

    def __delitem__(self, name: str) -> None:
        self.remove(name)

    def __contains__(self, name: object) -> bool:
        return name in self.names()

    def __iter__(self) -> Iterator[str]:
        return iter(self.names())

    def __len__(self) -> int:
        return len(self.names())

    def keys(self) -> KeysView[str]:
        """Names of all layers, in order."""
        return KeysView(cast("Mapping[str, Array]", self))

    def values(self) -> ValuesView[Array]:
        """All layers in the order of their names."""
        return ValuesView(cast("Mapping[str, Array]", self))

    def items(self) -> ItemsView[str, Array]:
        """Names and layers."""
        return ItemsView(cast("Mapping[str, Array]", self))

    def get(self, name: str, default: Array | None = None) -> Array | None:
        """The layer of that name, where there is one."""
        return self[name] if name in self else default

    def set(self, name: str, values: ArrayLike, unit: str) -> None:
        """Adds or replaces a layer, with its unit: "m", "m³/s", "1" …"""
        self.put(name, unit, _native(np.asanyarray(values)))

    def array(self, name: str, nodata: float | None = None) -> Array:
        """A layer; with `nodata`, usually NaN, a copy that has it in the cells without data."""
        layer = self.lent(name)
        if nodata is None or not self.masked:
            return layer
        return np.where(self.valid(), layer, np.float32(nodata))

    # Where it lies.

    @property
    def crs(self) -> str | None:
        """The CRS as "EPSG:32633"; `None` where it has none, or one without a code."""
        return None if self.place is None or self.place[0] is None else f"EPSG:{self.place[0]}"

    def crs_for_others(self) -> str | None:
        """The CRS as other programs are told of it; warns of one that they are not told of."""
        if self.has_crs_without_code:
            warn("the CRS of the file has no EPSG code, so that it is left out here; what `save` writes keeps it")
        return self.crs

    @property
    def transform(self) -> Any:
        """The affine transform from columns and rows to the CRS, or to metres east and south of the corner: an `Affine`
        where that package is there, else its six numbers."""
        return affine(self.place, self.cell)

    @property
    def extent(self) -> tuple[float, float]:
        """Metres from west to east and from north to south."""
        return self.shape[1] * self.cell, self.shape[0] * self.cell

    @property
    def mask(self) -> NDArray[np.bool_]:
        """Flags that are true where there is data."""
        return self.valid()

    # What is done to it.

    def _run_step(self, name: str, keys: dict[str, Any], call: dict[str, Any]) -> Any:
        from ._catalogue import ANALYSES, steps

        with shown(call["callback"], call["progress"], name) as hears:
            how = (call["engine"], call["threads"], hears)
            text, written = super().run_step(name, keys, call["seed"], how)
        step = next(step for step in steps() if step["name"] == name)
        if step["stage"] in ANALYSES and step["writes"]:
            found = {layer: self[layer] for layer in written}
            return found if len(step["writes"]) > 1 else next(iter(found.values()))
        return StepReport(step=name, layers=written, **json.loads(text))

    def paint(self, do: str, path: Sequence[float] | Sequence[Sequence[float]], **keys: Any) -> dict[str, float]:
        """Paints a stroke: `do` is "add", "remove", "add-water", "remove-water", "smooth", "flatten", "source", "drain",
        "rain", "freeze", "thaw", "mask" or "unmask" (strokes leave out what is masked), `path` a place in metres east and south of the north-western corner, or a list of places.
        Gives cubic metres.

        >>> land = Landscape(np.zeros((40, 40)), cell=5.0)
        >>> moved = land.paint("add", [[20, 100], [180, 100]], material="soil", thickness=3.0, radius=20.0)
        >>> moved["solid_added"] > 1000.0
        True
        """
        volumes = self.paint_stroke({"do": do, "path": path, **keys})
        return dict(zip(("solid_added", "solid_removed", "water_added", "water_removed"), volumes))

    # What it becomes.

    def picture(self, kind: str = "relief", *, svg: bool = False, threads: int | None = None, **keys: Any) -> Picture:
        """A picture: "relief", "map", "view", "section", "materials", "render", with its keys as keywords. A notebook shows
        it."""
        return Picture(self.draw(kind, keys, svg, threads), "svg" if svg else "png")

    plot = picture

    def film(
        self, kind: str = "view", *, frames: int = 24, frames_per_second: float = 12.0, **keys: Any
    ) -> Film:
        """A film of a picture that turns around the landscape, or moves in the wind, as an animated PNG."""
        return Film(self.draw_film(kind, keys, frames, frames_per_second))

    def save(self, path: str | os.PathLike[str], layer: str = "height") -> None:
        """Writes a layer into a raster file, whose extension chooses the format."""
        self.save_layer(layer, os.fspath(path))

    def export(self, kind: str, path: str | os.PathLike[str], threads: int | None = None, **keys: Any) -> list[Path]:
        """Writes files for other programs: "mesh", "layers", "rivers", "lakes", "plants", "grass", "unreal", "unity",
        "terrain3d", with their keys as keywords. Gives the files."""
        files, _ = self.export_files(kind, os.fspath(path), keys, threads)
        return [Path(file) for file in files]

    def to_xarray(self, layers: Sequence[str] | None = None) -> xarray.Dataset:
        """All layers, or those that are named, as a dataset with coordinates and CRS. Cells without data are NaN; where all
        have data, the arrays share the memory of the layers."""
        from ._xarray import dataset

        return dataset(self, list(self) if layers is None else list(layers))

    def profile(self, layer: str = "height") -> dict[str, Any]:
        """What `rasterio.open(path, "w", **profile)` needs for `array(layer, nodata)`."""
        rows, columns = self.shape
        self.unit(layer)  # an error where there is no such layer
        nodata = float("nan") if self.masked else None
        return {
            "driver": "GTiff", "dtype": "float32", "count": 1, "width": columns, "height": rows,
            "crs": self.crs_for_others(), "transform": self.transform, "nodata": nodata,
        }  # fmt: skip

    def river_lines(self, frame: bool | None = None, **keys: Any) -> Any:
        """The rivers as lines with width, depth, discharge and order, after the steps `flow` and `rivers`: a GeoDataFrame
        where geopandas is there, else the dictionary of GeoJSON."""
        return self._features("rivers", frame, keys)

    def lake_areas(self, frame: bool | None = None, **keys: Any) -> Any:
        """The lakes as areas with level, depth and volume, after the steps `flow` and `lakes`: as `river_lines`."""
        return self._features("lakes", frame, keys)

    def _features(self, kind: str, frame: bool | None, keys: dict[str, Any]) -> Any:
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "features.geojson"
            self.export(kind, file, **keys)
            collection = json.loads(file.read_text(encoding="utf-8"))
        geopandas = _module("geopandas", frame)
        if geopandas is None:
            return collection
        crs = self.crs_for_others()
        if not collection["features"]:
            return geopandas.GeoDataFrame(geometry=[], crs=crs)
        return geopandas.GeoDataFrame.from_features(collection["features"], crs=crs)

    def plants(self, name: str | None = None, frame: bool | None = None) -> Any:
        """The plants of that name, or of the only one, as a table: a DataFrame where pandas is there, else a dictionary of
        arrays. `x` and `y` are metres east and south of the north-western corner, `z` the height of the ground, `turn` is in
        radians."""
        names = [known for known, _, _ in self.plant_names()]
        if name is None:
            if len(names) != 1:
                raise UsageError(f"the landscape has the plants {names}; name one")
            name = names[0]
        columns = self.plant_columns(name)
        pandas = _module("pandas", frame)
        return columns if pandas is None else pandas.DataFrame(columns)

    # How it is kept and shown.

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self.state())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _weald.Landscape) and self.equals(other)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        rows, columns = self.shape
        where = f", {self.crs}" if self.crs else ""
        return f"<weald.Landscape of {columns} × {rows} cells of {self.cell:g} m{where}: {', '.join(self) or 'no layers'}>"

    def _repr_html_(self) -> str:
        rows = []
        for name in self:
            values = self[name][self.valid()] if self.masked else self[name]
            low, high = float(values.min()), float(values.max())
            rows.append(f"<tr><td>{name}</td><td>{self.unit(name)}</td><td>{low:.6g}</td><td>{high:.6g}</td></tr>")
        head = "<tr><th>layer</th><th>unit</th><th>least</th><th>greatest</th></tr>"
        image = self.picture(width=320)._repr_html_() if "height" in self and rows else ""
        return f"<div>{_escaped(repr(self))}</div>{image}<table>{head}{''.join(rows)}</table>"


Mapping.register(Landscape)


def _again(cls: type[Landscape], state: Any) -> Landscape:
    return cls(_weald.Landscape.of_state(state))


def _native(values: NDArray[Any]) -> NDArray[Any]:
    """Numbers in the order of this machine's bytes; all others as they are, for the one copy to come."""
    if values.dtype.kind in "fiub" and values.dtype.isnative and values.dtype.itemsize <= 8 and values.dtype != np.float16:
        return values
    return values.astype(np.float32)


def _usual_unit(name: str) -> str:
    from ._catalogue import steps

    units = {layer: unit for step in steps() for layer, unit in step["writes"]}
    return str(units.get(name, "1"))


def _module(name: str, wanted: bool | None) -> ModuleType | None:
    import importlib

    if wanted is False:
        return None
    try:
        return importlib.import_module(name)
    except ImportError:
        if wanted:
            raise
        return None


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


__all__ = ["Array", "Landscape", "epsg_of"]

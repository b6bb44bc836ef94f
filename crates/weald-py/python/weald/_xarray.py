"""xarray: landscapes from arrays and to datasets, and the accessor `da.weald`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
import xarray

from ._errors import UsageError
from ._steps import AccessorSteps, StepReport

if TYPE_CHECKING:
    from ._landscape import Landscape

    Land = TypeVar("Land", bound=Landscape)

#: Steps of a coordinate that differ by no more than this share are even.
_EVEN = 1e-3


def landscape(cls: type[Land], data: xarray.DataArray, cell: float | None = None) -> Land:
    """The landscape of an array of two dimensions, rows first."""
    data = data.squeeze(drop=True)
    if data.ndim != 2:
        raise UsageError(f"an array of dimensions {data.dims}; a landscape has rows and columns")
    transform = _transform(data)
    if transform is not None and transform[4] > 0.0:
        data = data.isel({data.dims[0]: slice(None, None, -1)})
        transform = _transform(data)
    crs = _crs(data) if transform is not None else None
    nodata = data.attrs.get("_FillValue", data.encoding.get("_FillValue"))
    return cls(data.values, cell, crs=crs, transform=transform, nodata=nodata)


def _transform(data: xarray.DataArray) -> tuple[float, ...] | None:
    """From the coordinates, which tell the truth after a cut as well."""
    (y, x) = data.dims
    if x not in data.coords or y not in data.coords:
        return None
    (dx, x0), (dy, y0) = _axis(data[x]), _axis(data[y])
    return (dx, 0.0, x0 - dx / 2, 0.0, dy, y0 - dy / 2)


def _axis(coordinate: xarray.DataArray) -> tuple[float, float]:
    values = np.asarray(coordinate.values, dtype=np.float64)
    if len(values) < 2:
        raise UsageError(f"`{coordinate.name}` has one value, which says nothing of the width of a cell")
    step = (values[-1] - values[0]) / (len(values) - 1)
    if step == 0.0 or np.abs(np.diff(values) - step).max() > _EVEN * abs(step):
        raise UsageError(f"`{coordinate.name}` is not evenly spaced; bring the array to a regular grid (`da.interp`)")
    return float(step), float(values[0])


def _crs(data: xarray.DataArray) -> Any:
    name = data.encoding.get("grid_mapping", data.attrs.get("grid_mapping", "spatial_ref"))
    if name not in data.coords:
        return None
    wkt = data.coords[name].attrs.get("crs_wkt", data.coords[name].attrs.get("spatial_ref"))
    return wkt or None


def dataset(land: Landscape, layers: list[str]) -> xarray.Dataset:
    """Layers with the centres of the cells as coordinates."""
    rows, columns = land.shape
    a, _, c, _, e, f = tuple(land.transform)[:6]
    x, y = c + (np.arange(columns) + 0.5) * a, f + (np.arange(rows) + 0.5) * e
    coordinates: dict[str, Any] = {
        "y": ("y", y, {"units": "m", "standard_name": "projection_y_coordinate", "axis": "Y"}),
        "x": ("x", x, {"units": "m", "standard_name": "projection_x_coordinate", "axis": "X"}),
    }
    made = xarray.Dataset(
        {name: (("y", "x"), land.array(name, np.nan), {"units": land.unit(name)}) for name in layers},
        coords=coordinates,
        attrs={"cell": land.cell, "Conventions": "CF-1.11"},
    )
    return _with_crs(made, land.crs_for_others(), (a, 0.0, c, 0.0, e, f))


def _with_crs(made: xarray.Dataset, crs: str | None, transform: tuple[float, ...]) -> xarray.Dataset:
    if crs is None:
        return made
    a, b, c, d, e, f = transform
    attributes = {"GeoTransform": f"{c} {a} {b} {f} {d} {e}", **_words_of(crs)}
    made = made.assign_coords(spatial_ref=xarray.DataArray(np.int64(0), attrs=attributes))
    for name in made.data_vars:
        made[name].encoding["grid_mapping"] = "spatial_ref"
    return made


def _words_of(crs: str) -> dict[str, Any]:
    try:
        from pyproj import CRS
    except ImportError:
        return {"crs_wkt": crs, "spatial_ref": crs}
    words = dict(CRS.from_user_input(crs).to_cf())
    return {**words, "spatial_ref": words["crs_wkt"]}


@xarray.register_dataarray_accessor("weald")  # type: ignore[no-untyped-call]
class Accessor(AccessorSteps):
    """Every step of the catalogue on an array of heights: `da.weald.flow()`, `da.weald.hydraulic(iterations=500)`.

    Analyses give what they write, as an array or a dataset with the coordinates of this one; all other steps give the
    changed heights. What a step reports is in the attributes.
    """

    def __init__(self, data: xarray.DataArray) -> None:
        self._data = data

    def landscape(self, cell: float | None = None) -> Landscape:
        """The array as a landscape, for several steps in a row."""
        from ._landscape import Landscape

        return Landscape.from_xarray(self._data, cell)

    def _run_step(self, name: str, keys: dict[str, Any], call: dict[str, Any]) -> Any:
        land = self.landscape()
        found = land._run_step(name, keys, call)
        if isinstance(found, StepReport):
            heights = self._like(land.to_xarray(["height"]))["height"]
            return heights.rename(self._data.name).assign_attrs(iterations=found.iterations, **found.measures)
        if isinstance(found, dict):
            return self._like(land.to_xarray(list(found)))
        layer = next(name for name in land if np.shares_memory(land[name], found))
        return self._like(land.to_xarray([layer]))[layer]

    def _like(self, made: xarray.Dataset) -> xarray.Dataset:
        """With the dimensions and coordinates of this array, where the step left the grid as it was."""
        data = self._data.squeeze(drop=True)
        rows, columns = data.dims
        made = made.rename({"y": rows, "x": columns} if (rows, columns) != ("y", "x") else {})
        transform = _transform(data)
        if transform is not None and transform[4] > 0.0:
            made = made.isel({rows: slice(None, None, -1)})
        if (made.sizes[rows], made.sizes[columns]) == data.shape:
            made = made.drop_vars([axis for axis in (rows, columns) if axis not in data.coords])
            made = made.assign_coords({axis: data[axis] for axis in (rows, columns) if axis in data.coords})
        return made

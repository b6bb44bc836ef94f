"""Where a landscape lies, in the words of other programs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ._errors import UsageError

Place = tuple[int | None, Sequence[float], Sequence[float]]


def epsg_of(crs: Any) -> int | None:
    """The EPSG code of a CRS: a number, a text, or an object of pyproj or rasterio."""
    if crs is None:
        return None
    if isinstance(crs, int):
        return crs
    if isinstance(crs, str):
        kind, _, code = crs.partition(":")
        if kind.upper() == "EPSG" and code.isdigit():
            return int(code)
        crs = _parsed(crs)
    code = crs.to_epsg()
    if code is None:
        raise UsageError(f"the CRS has no EPSG code: {crs}; give one that has, or crs=None and add it to the result")
    return int(code)


def _parsed(text: str) -> Any:
    try:
        from pyproj import CRS
    except ImportError:
        raise UsageError(f'the CRS is {text!r}; write it as "EPSG:32633", or install pyproj') from None
    return CRS.from_user_input(text)


def place(cell: float | None, crs: Any, transform: Any) -> dict[str, Any]:
    """What the native half needs to know."""
    if transform is None:
        if crs is not None:
            raise UsageError("a CRS says nothing without a place: give `transform` beside `crs`")
        return {"cell": cell, "epsg": None, "origin": None, "pixel": None}
    a, b, c, d, e, f = (float(number) for number in tuple(transform)[:6])
    if b != 0.0 or d != 0.0 or a <= 0.0 or e >= 0.0:
        raise UsageError(
            f"the transform {(a, b, c, d, e, f)} is turned or mirrored; rows of a landscape go south and columns east: "
            "reproject the raster, or flip the array"
        )
    return {"cell": cell, "epsg": epsg_of(crs), "origin": [c, f], "pixel": [a, -e]}


def affine(where: Place | None, cell: float) -> Any:
    """The transform of a landscape; one without a place has its corner at 0, 0."""
    origin, pixel = ((0.0, 0.0), (cell, cell)) if where is None else (where[1], where[2])
    numbers = (pixel[0], 0.0, origin[0], 0.0, -pixel[1], origin[1])
    try:
        from affine import Affine
    except ImportError:
        return numbers
    return Affine(*numbers)

"""Pictures and films that a notebook shows, and fractals."""

from __future__ import annotations

import os
import tempfile
from base64 import b64encode
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _weald
from ._toml import value_of


class Picture:
    """A picture as the bytes of a file, which a notebook shows."""

    def __init__(self, data: bytes, kind: str = "png") -> None:
        self.data = data
        """The bytes of the file."""
        self.kind = kind
        """Its extension: "png", "svg" or "apng"."""

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the file."""
        Path(path).write_bytes(self.data)

    @property
    def size(self) -> tuple[int, int]:
        """Columns and rows of pixels of a PNG."""
        return int.from_bytes(self.data[16:20]), int.from_bytes(self.data[20:24])

    def _repr_png_(self) -> bytes | None:
        return self.data if self.kind == "png" else None

    def _repr_svg_(self) -> str | None:
        return self.data.decode() if self.kind == "svg" else None

    def _repr_html_(self) -> str:
        mime = {"png": "image/png", "svg": "image/svg+xml", "apng": "image/apng"}[self.kind]
        return f'<img src="data:{mime};base64,{b64encode(self.data).decode()}">'

    def __repr__(self) -> str:
        return f"<weald.{type(self).__name__}: {self.kind}, {len(self.data)} bytes>"


class Film(Picture):
    """A film as an animated PNG, which every browser plays."""

    def __init__(self, data: bytes) -> None:
        super().__init__(data, "apng")


def fractal(of: str, *, deform: Sequence[Mapping[str, Any]] = (), svg: bool = False, **keys: Any) -> Picture:
    """A picture of a built-in fractal, as `fractal("fern", size=300)`, or of a `.flame` file or a recipe with one.

    >>> fractal("fern", size=64).size
    (64, 64)
    """
    kind = "svg" if svg else "png"
    return Picture(_made(of, deform, {"picture": "fractal", **keys}, kind), kind)


def fractal_points(of: str, *, deform: Sequence[Mapping[str, Any]] = (), **keys: Any) -> NDArray[Any]:
    """Points of a fractal, with `count` and the other keys of the export `points`.

    >>> fractal_points("fern", count=1000).shape[0]
    1000
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "points.npy"
        file.write_bytes(_made(of, deform, {"export": "points", **keys}, "npy"))
        points: NDArray[Any] = np.load(file)
    return points


def _made(of: str, deform: Sequence[Mapping[str, Any]], keys: Mapping[str, Any], extension: str) -> bytes:
    named = {**keys, "file": f"fractal.{extension}"}
    output = [(key, value_of(value)) for key, value in named.items() if value is not None]
    if len(deform) > 1:
        raise ValueError("one deformation can be given here; a recipe takes several")
    bent = [(key, value_of(value)) for one in deform for key, value in one.items()]
    recipe = _weald.fractal_recipe(of, bent, [output])
    with tempfile.TemporaryDirectory() as folder:
        how = {"out": folder, "write": True, "resume": False, "memory": None}
        recipe.execute(how, ("cpu", None, None))
        return (Path(folder) / f"fractal.{extension}").read_bytes()

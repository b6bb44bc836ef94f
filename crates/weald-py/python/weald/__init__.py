"""Landscapes with rivers and mountains: fractal or real ground, shaped by water and gravity.

A `Landscape` holds layers of one grid, as NumPy arrays that share its memory. Every step of the catalogue is a method of it,
and `run` runs a recipe, a page of TOML:

>>> import weald
>>> land = weald.Landscape.empty(64, 48, cell=20.0)
>>> _ = land.diamond_square(relief=300.0, seed=7)
>>> report = land.hydraulic(model="han", iterations=100)
>>> report.iterations
100
>>> area = land.flow()["accumulation"]
>>> area.shape, area.dtype.name
((48, 64), 'float32')
"""

from __future__ import annotations

from . import _errors, _progress
from ._errors import (
    Cancelled,
    DeviceError,
    Error,
    InputError,
    Interrupted,
    LimitError,
    NotFiniteError,
    RecipeError,
    RunError,
    UsageError,
)
from ._landscape import Landscape
from ._pictures import Film, Picture, fractal, fractal_points
from ._progress import Note, Progress
from ._recipe import Recipe, Result, run
from ._session import Session
from ._steps import StepReport
from ._weald import __version__

__all__ = [
    "Cancelled",
    "DeviceError",
    "Error",
    "Film",
    "InputError",
    "Interrupted",
    "Landscape",
    "LimitError",
    "Note",
    "NotFiniteError",
    "Picture",
    "Progress",
    "Recipe",
    "RecipeError",
    "Result",
    "RunError",
    "Session",
    "StepReport",
    "UsageError",
    "__version__",
    "fractal",
    "fractal_points",
    "run",
]

try:
    from . import _xarray as _accessor  # `da.weald`
except ImportError:
    pass  # without xarray there is nothing to extend

"""A step of a recipe under a person's hands."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from typing import Any, Self

from . import _weald
from ._landscape import Array, Landscape
from ._progress import Callback, shown
from ._recipe import Recipe
from ._steps import StepReport


class Session(_weald.Session):
    """Holds a simulation of a recipe: advance it, read its layers, paint on it, take back what was not meant.

    >>> session = Session({
    ...     "landscape": {"size": 48, "cell": 20.0, "seed": 7},
    ...     "step": [{"do": "fbm"}, {"do": "hydraulic", "iterations": 100}],
    ... })
    >>> session.advance(20)
    >>> session.paint("add-water", [480.0, 480.0], depth=20.0, radius=100.0)
    >>> float(session.patch()["water"].max()) > 10.0
    True
    >>> session.undo(), session.steps
    (True, 20)
    >>> session["height"].shape
    (48, 48)
    """

    def __new__(
        cls,
        recipe: str | os.PathLike[str] | Mapping[str, Any] | Recipe,
        *,
        step: int | None = None,
        engine: str = "auto",
        threads: int | None = None,
        memory: int = 1 << 30,
        callback: Callback | None = None,
        progress: bool | None = None,
        **changes: Any,
    ) -> Self:
        """`step` is the number of the step to hold, counted from 1; by default the last that can be held. `memory` is how
        many bytes are kept to go back with."""
        if not isinstance(recipe, Recipe):
            recipe = Recipe(recipe, in_memory=True, **changes)
        with shown(callback, progress) as hears:
            return super().__new__(cls, recipe.file, recipe.text, step, memory, (engine, threads, hears))

    def advance(self, steps: int = 1, callback: Callback | None = None, progress: bool | None = None) -> None:
        """Simulates so many steps. Ctrl-C leaves it after those that are done."""
        with shown(callback, progress, "advance") as hears:
            self.advance_by(steps, hears)

    def run(self, callback: Callback | None = None, progress: bool | None = None) -> None:
        """Simulates what is left of the steps that the recipe asks for."""
        self.advance(max(self.written_steps - self.steps, 0), callback, progress)

    def paint(self, do: str, path: Sequence[float] | Sequence[Sequence[float]], **keys: Any) -> None:
        """Paints a stroke, as `Landscape.paint`."""
        self.change({"do": do, "path": path, **keys})

    def set(self, key: str, value: float | bool | str) -> None:
        """Gives a key of the step another value from here on; one within a table has its name behind a point."""
        self.change({"do": "set", "key": key, "value": value})

    def landscape(self) -> Landscape:
        """The landscape as it is now, as if the step had ended here."""
        return Landscape(self.now()[0])

    def report(self) -> StepReport:
        """What the step would report if it ended here."""
        return StepReport(step="", **json.loads(self.now()[1]))

    def finish(self, callback: Callback | None = None, progress: bool | None = None) -> Landscape:
        """The landscape after the steps that come after this one."""
        with shown(callback, progress) as hears:
            return Landscape(self.finish_steps(hears))

    def patch(self, area: tuple[int, int, int, int] | None = None) -> dict[str, Array]:
        """The state over a rectangle of cells (column, row, columns, rows), or of all: arrays of their own, in metres. No
        more is read from a device."""
        return self.read_patch(area)

    def __getitem__(self, name: str) -> Array:
        return self.landscape()[name]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the session as a recipe, and beside it the script of what was done, which `run` replays to the same bits."""
        self.save_recipe(os.fspath(path))

    def __repr__(self) -> str:
        return f"<weald.Session after {self.steps} of {self.written_steps} steps>"

"""Recipes and their runs."""

from __future__ import annotations

import json
import os
import tempfile
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

from . import _weald
from ._errors import RecipeError
from ._landscape import Landscape
from ._progress import Callback, shown
from ._toml import text_of, value_of

Source = "str | os.PathLike[str] | Mapping[str, Any] | Recipe"


class Recipe(_weald.Recipe):
    """A recipe that was checked whole: a path, a text of several lines, or a dictionary.

    >>> recipe = Recipe({
    ...     "landscape": {"size": 32, "cell": 20.0},
    ...     "step": [{"do": "fbm"}, {"do": "slope"}],
    ...     "output": [{"layer": "slope", "file": "slope.tif"}],
    ... })
    >>> recipe.steps, recipe.files
    (['fbm', 'slope'], ['slope.tif', 'slope.qml'])
    """

    def __new__(
        cls,
        source: str | os.PathLike[str] | Mapping[str, Any],
        *,
        size: int | None = None,
        preview: bool = False,
        seed: int | None = None,
        set: Mapping[str, Any] | None = None,
        file: str | os.PathLike[str] | None = None,
        in_memory: bool = False,
    ) -> Self:
        """`size`, `preview`, `seed` and `set` change it as the options of the command do. Paths in it start at the folder of
        `file`, which is its own path, or for texts and dictionaries the working folder. `in_memory` allows one that writes
        no file."""
        name, text = _read(source)
        if in_memory and _has_no_output(text):
            text += '\n[[output]]\nlayer = "height"\nfile = "height.tif"\n'
        changes = {
            "size": size,
            "preview": preview,
            "seed": seed,
            "set": [(path, value_of(value)) for path, value in (set or {}).items()],
        }
        return super().__new__(cls, os.fspath(file) if file is not None else name, text, changes)

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (type(self), self.file, self.text)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _weald.Recipe) and (self.file, self.text) == (other.file, other.text)

    def __hash__(self) -> int:
        return hash((self.file, self.text))

    def __repr__(self) -> str:
        return f"<weald.Recipe {self.file}: {', '.join(self.steps)}>"


def _again(cls: type[Recipe], file: str, text: str) -> Recipe:
    return cls(text if "\n" in text else text + "\n", file=file)


def _read(source: str | os.PathLike[str] | Mapping[str, Any]) -> tuple[str, str]:
    if isinstance(source, Mapping):
        return "recipe", text_of(source)
    if isinstance(source, str) and "\n" in source:
        return "recipe", source
    path = Path(source)
    try:
        return str(path), path.read_text(encoding="utf-8")
    except (OSError, UnicodeError) as error:
        message = f"{path}: the recipe cannot be read: {error}"
        raise RecipeError(message, file=str(path), faults=[(None, message)]) from None


def _has_no_output(text: str) -> bool:
    try:
        return "output" not in tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return False  # the native half tells the fault


@dataclass
class Result:
    """What a run left."""

    recipe: Recipe
    landscape: Landscape | None
    """The landscape after the last step; `None` where a finished run was only looked up, with `resume`."""
    report: dict[str, Any] = field(repr=False)
    """What is in `report.json`."""
    out: Path | None = None
    """The folder of the files."""

    @property
    def files(self) -> list[Path]:
        """The files that were written."""
        outputs = self.report["outputs"]
        names = [name for one in outputs for name in ([] if one.get("name_only") else [one["file"]]) + one.get("companions", [])]
        return [] if self.out is None else [self.out / name for name in names]


def run(
    recipe: str | os.PathLike[str] | Mapping[str, Any] | Recipe,
    out: str | os.PathLike[str] | None = None,
    callback: Callback | None = None,
    *,
    engine: str = "auto",
    threads: int | None = None,
    size: int | None = None,
    preview: bool = False,
    seed: int | None = None,
    set: Mapping[str, Any] | None = None,
    resume: bool = False,
    memory: int | None = None,
    progress: bool | None = None,
) -> Result:
    """Runs a recipe: a path, a text, a dictionary or a `Recipe`. With `out` it writes its files there, as `weald run` does;
    without, it stays in memory, and needs no `[[output]]`.

    The other keywords are the options of the command. `callback` hears of a `Progress` and ends the run with `False`. Ctrl-C
    raises `Interrupted`; with `out` and `resume=True` the run goes on from its checkpoint.

    >>> result = run({"landscape": {"size": 32, "cell": 20.0}, "step": [{"do": "fbm"}, {"do": "slope"}]}, seed=3)
    >>> list(result.landscape), result.report["seed"]
    (['height', 'slope'], 3)
    """
    if not isinstance(recipe, Recipe):
        recipe = Recipe(recipe, size=size, preview=preview, seed=seed, set=set, in_memory=out is None)
    elif size is not None or preview or seed is not None or set:
        recipe = Recipe(recipe.text, size=size, preview=preview, seed=seed, set=set, file=recipe.file)
    with tempfile.TemporaryDirectory() as elsewhere, shown(callback, progress) as hears:
        folder = os.fspath(out) if out is not None else elsewhere
        how = {"out": folder, "write": out is not None, "resume": resume, "memory": memory}
        native, report = recipe.execute(how, (engine, threads, hears))
    landscape = None if native is None else Landscape(native)
    return Result(recipe, landscape, json.loads(report), None if out is None else Path(out))

"""Writes what follows from the catalogue: the stub of the steps, and their reference.

    python -m weald._stubs            says what is stale, and exits with 1 if something is
    python -m weald._stubs write      writes it, into the checkout that the working folder is in
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from . import _catalogue as catalogue

_HEAD = '''"""Every step of the catalogue as a method; written by `python -m weald._stubs write`."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from typing import Any, Literal

import numpy as np
import xarray
from numpy.typing import NDArray

from ._progress import Callback

Array = NDArray[np.float32]

@dataclass(frozen=True)
class StepReport:
    step: str
    iterations: int = ...
    budget: dict[str, dict[str, float]] | None = ...
    measures: dict[str, float] = ...
    notes: list[str] = ...
    layers: list[str] = ...
'''

_CALL = {
    "seed": "seed: int = 0",
    "engine": 'engine: str = "auto"',
    "threads": "threads: int | None = None",
    "callback": "callback: Callback | None = None",
    "progress": "progress: bool | None = None",
}

_RUN_STEP = "    def _run_step(self, name: str, keys: dict[str, Any], call: dict[str, Any]) -> Any: ...\n"


def stub() -> str:
    """The text of `_steps.pyi`."""
    text = _HEAD
    text += '\nclass Steps:\n    """A method for each step of the catalogue."""\n\n' + _RUN_STEP
    text += "".join(_method(step, catalogue.result(step)) for step in catalogue.steps())
    text += '\nclass AccessorSteps:\n    """The same of an array of xarray."""\n\n' + _RUN_STEP
    text += "".join(_method(step, _of_xarray(step), documented=False) for step in catalogue.steps())
    return text


def _of_xarray(step: dict[str, Any]) -> str:
    return {"dict[str, Array]": "xarray.Dataset"}.get(catalogue.result(step), "xarray.DataArray")


def _method(step: dict[str, Any], result: str, documented: bool = True) -> str:
    arguments = [_argument(parameter) for parameter in catalogue.keywords(step["parameters"])]
    arguments += [_CALL[word] for word in catalogue.call_of(step)]
    lines = ",\n".join(f"        {argument}" for argument in ["self", "*", *arguments])
    head = f"    def {catalogue.method(step['name'])}(\n{lines},\n    ) -> {result}:"
    if not documented:
        return head + " ...\n"
    document = catalogue.document(step).replace("\\", "\\\\").replace('"""', "'''")
    body = "\n".join(f"        {line}".rstrip() for line in document.splitlines())
    return f'{head}\n        """{body.strip()}\n        """\n'


def _argument(parameter: dict[str, Any]) -> str:
    text = f"{catalogue.method(parameter['name'])}: {catalogue.annotation(parameter)}"
    return text if parameter["required"] else f"{text} = {_shown(catalogue.default(parameter))}"


def _shown(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str) else repr(value)


_REFERENCE = """# Steps in Python

Written by `python -m weald._stubs write` from the same declarations as [the steps of a recipe](steps.md), which say more of what
each does. All are methods of `weald.Landscape`, and of the accessor `da.weald` of xarray. Beside its own keywords each takes
`seed`, `engine`, `threads`, `callback` and `progress` ([From Python](python.md)). Analyses give arrays, all others a
`StepReport`. A keyword that stands for a word of Python has a `_` behind it.
"""


def reference() -> str:
    """The text of `docs/python-steps.md`."""
    text = _REFERENCE
    stage = None
    for step in catalogue.steps():
        if step["stage"] != stage:
            stage = step["stage"]
            text += f"\n## {stage}\n"
        text += _entry(step)
    return text


def _entry(step: dict[str, Any]) -> str:
    arguments = [_argument(parameter) for parameter in catalogue.keywords(step["parameters"])]
    inside = "".join(f"    {argument},\n" for argument in arguments)
    signature = f"land.{catalogue.method(step['name'])}(\n{inside})" if arguments else f"land.{catalogue.method(step['name'])}()"
    summary = step["summary"][0].upper() + step["summary"][1:]
    return (
        f"\n### {catalogue.method(step['name'])}\n\n{summary}. Gives `{catalogue.result(step)}`.\n\n"
        f"```text\n{signature} -> {catalogue.result(step)}\n```\n"
    )


def files(root: Path) -> dict[Path, str]:
    """All that is written, by its place in a checkout."""
    return {
        root / "crates/weald-py/python/weald/_steps.pyi": stub(),
        root / "docs/python-steps.md": reference(),
    }


def stale(root: Path) -> list[Path]:
    """What is no longer as the catalogue has it."""
    return [file for file, text in files(root).items() if not file.exists() or file.read_text(encoding="utf-8") != text]


def checkout(folder: Path) -> Path:
    """The checkout that a folder is in."""
    for root in (folder, *folder.parents):
        if (root / "crates/weald-py").is_dir():
            return root
    raise SystemExit(f"{folder} is in no checkout of Weald")


def _main(arguments: list[str]) -> int:
    root = checkout(Path.cwd())
    if arguments == ["write"]:
        for file, text in files(root).items():
            file.write_text(text, encoding="utf-8")
        return 0
    found = stale(root)
    for file in found:
        print(f"{file} is stale: python -m weald._stubs write")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(_main(sys.argv[1:]))

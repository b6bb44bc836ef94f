"""Every snippet of the documents runs, and says what it prints."""

from __future__ import annotations

import doctest
import importlib
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import weald

MODULES = ["weald", "weald._landscape", "weald._recipe", "weald._session", "weald._pictures"]


@pytest.mark.parametrize("name", MODULES)
def test_examples_in_docstrings_print_what_they_say(name: str) -> None:
    failed, tried = doctest.testmod(importlib.import_module(name))
    assert tried > 0 and failed == 0


def snippets(file: Path) -> list[str]:
    """The fenced blocks of Python, of which each goes on from those before it."""
    return re.findall(r"^```python\n(.*?)^```$", file.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("name", ["docs/python.md", "crates/weald-py/README.md"])
def test_every_snippet_of_a_document_runs(name: str, root: Path, tmp_path: Path) -> None:
    blocks = snippets(root / name)
    assert blocks, f"{name} has no snippets"
    program = tmp_path / "snippets.py"
    os.symlink(root / "recipes", tmp_path / "recipes")
    os.symlink(root / "data", tmp_path / "data")
    # Dask starts processes that import the program again.
    body = "\n".join(blocks)
    program.write_text(f"if __name__ == '__main__':\n" + "".join(f"    {line}\n" if line else "\n" for line in body.split("\n")))
    done = subprocess.run([sys.executable, program], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_the_notebook_runs_beside_landlab_and_pysheds(root: Path, tmp_path: Path) -> None:
    pytest.importorskip("landlab")
    pytest.importorskip("pysheds")
    book = json.loads((root / "docs/beside.ipynb").read_text(encoding="utf-8"))
    cells = ["".join(cell["source"]) for cell in book["cells"] if cell["cell_type"] == "code"]
    program = tmp_path / "beside.py"
    program.write_text("\n\n".join(cells), encoding="utf-8")
    done = subprocess.run([sys.executable, program], cwd=root, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    print(done.stdout)
    assert all(cell["outputs"] for cell in book["cells"] if "print(" in "".join(cell["source"]) and "outputs" in cell)


def test_the_ten_lines_of_the_readme_run_where_nothing_else_is(root: Path, tmp_path: Path) -> None:
    (block,) = snippets(root / "README.md")
    assert len([line for line in block.splitlines() if line.strip()]) <= 10
    # `./check` names an environment that has the wheel and xarray alone.
    clean = os.environ.get("WEALD_README_PYTHON", sys.executable)
    (tmp_path / "recipes").symlink_to(root / "recipes")
    (tmp_path / "data").symlink_to(root / "data")
    done = subprocess.run([clean, "-c", block], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    written = ["relief.png", "land.nc", "out/quick/report.json"]
    assert all((tmp_path / name).stat().st_size > 1000 for name in written)


def test_stubs_are_strictly_typed(root: Path) -> None:
    pytest.importorskip("mypy")
    folder = root / "crates/weald-py"
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--config-file", "pyproject.toml", "python/weald"],
        cwd=folder, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout


def test_the_version_is_that_of_the_crates(root: Path) -> None:
    assert f'version = "{weald.__version__}"' in (root / "Cargo.toml").read_text()

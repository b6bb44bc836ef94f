"""What several tests use."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import weald

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def root() -> Path:
    return ROOT


@pytest.fixture
def command() -> Callable[..., None]:
    """The command, built in debug mode beside the tests of Rust."""
    folder = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    binary = Path(os.environ.get("WEALD_COMMAND", folder / "debug/weald"))
    if not binary.exists():
        pytest.fail(f"{binary} is not there: cargo build --workspace")

    def run(*arguments: str | Path, cwd: Path) -> None:
        subprocess.run([binary, *map(str, arguments)], cwd=cwd, check=True, capture_output=True, text=True)

    return run


@pytest.fixture
def hills() -> weald.Landscape:
    """Rough ground of 64 × 48 cells of 20 m."""
    land = weald.Landscape.empty(64, 48, 20.0)
    land.diamond_square(relief=400.0, seed=5)
    return land


@pytest.fixture
def holed() -> weald.Landscape:
    """The same at a place, with some cells without data."""
    rng = np.random.default_rng(3)
    heights = np.cumsum(np.cumsum(rng.normal(size=(40, 30)), axis=0), axis=1).astype(np.float32)
    heights[3:6, 7:9] = np.nan
    return weald.Landscape(heights, crs="EPSG:32633", transform=(10.0, 0.0, 500_000.0, 0.0, -10.0, 4_600_000.0))

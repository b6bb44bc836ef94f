"""Landscapes over seeds and parameters in one Zarr: what the example for Dask and that for Slurm share."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import weald
import zarr

RECIPE: dict[str, Any] = {
    "landscape": {"size": [128, 96], "cell": 20.0},
    "step": [
        {"do": "diamond-square", "relief": 500.0},
        {"do": "hydraulic", "iterations": 400},
        {"do": "flow"},
    ],
}
LAYERS = ["height", "accumulation"]

#: Twelve landscapes: each a seed, and changes as `--set` of the command makes them.
CASES = [(seed, {"hydraulic.rain": rain}) for seed, rain in product(range(1, 5), [0.1, 0.2, 0.3])]


def create(path: str) -> None:
    """The Zarr of all landscapes, in chunks of one landscape, so that whoever writes one writes no part of another."""
    columns, rows = RECIPE["landscape"]["size"]
    group = zarr.open_group(path, mode="w")
    for layer in LAYERS:
        shape = (len(CASES), rows, columns)
        group.create_array(layer, shape=shape, chunks=(1, rows, columns), dtype="f4", fill_value=np.nan)
    group.attrs["cases"] = [[seed, changes] for seed, changes in CASES]


def run_case(path: str, number: int) -> int:
    """Runs one landscape and writes its place in the Zarr; whoever runs it again writes the same bytes."""
    seed, changes = CASES[number]
    land = weald.run(RECIPE, seed=seed, set=changes, threads=1, engine="cpu", progress=False).landscape
    assert land is not None
    group = zarr.open_group(path, mode="r+")
    for layer in LAYERS:
        group[layer][number] = land[layer]
    return number

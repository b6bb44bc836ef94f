"""Many landscapes at once: on workers of Dask, as jobs of an array, and components of landlab."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import weald

zarr = pytest.importorskip("zarr")


@pytest.fixture
def examples(root: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = root / "crates/weald-py/examples"
    monkeypatch.syspath_prepend(folder)
    return folder


def single(number: int) -> weald.Landscape:
    import sweep

    seed, changes = sweep.CASES[number]
    land = weald.run(sweep.RECIPE, seed=seed, set=changes).landscape
    assert land is not None
    return land


def test_a_killed_worker_of_dask_costs_nothing_but_time(examples: Path, tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    path = tmp_path / "sweep.zarr"
    done = subprocess.run(
        [sys.executable, examples / "dask_sweep.py", path], cwd=tmp_path, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0 and "12 of 12" in done.stdout, done.stderr
    group = zarr.open_group(path, mode="r")
    assert group["height"].shape == (12, 96, 128)
    for number in range(12):
        land = single(number)
        for layer in ["height", "accumulation"]:
            assert np.array_equal(group[layer][number], land[layer]), (number, layer)
    assert not np.array_equal(group["height"][0], group["height"][1]), "they differ"


def test_jobs_of_an_array_write_each_its_own(examples: Path, tmp_path: Path) -> None:
    script, path = examples / "slurm_array.py", tmp_path / "sweep.zarr"
    subprocess.run([sys.executable, script, "create", path], check=True)
    for number in [0, 7]:
        environment = {**os.environ, "SLURM_ARRAY_TASK_ID": str(number)}
        subprocess.run([sys.executable, script, path], check=True, env=environment)
    heights = zarr.open_group(path, mode="r")["height"]
    assert np.array_equal(heights[7], single(7)["height"]) and np.array_equal(heights[0], single(0)["height"])
    assert np.isnan(heights[1]).all()


def test_components_of_landlab_give_the_layers_of_weald() -> None:
    landlab = pytest.importorskip("landlab")
    from weald.landlab import FlowAnalyzer, HydraulicEroder, landscape

    made = weald.Landscape.empty(40, 30, 10.0)
    made.diamond_square(relief=100.0, seed=3)
    grid = landlab.RasterModelGrid((30, 40), xy_spacing=10.0, xy_of_lower_left=(1000.0, 2000.0))
    grid.add_field("topographic__elevation", made["height"][::-1].ravel().astype(float), at="node")
    grid.status_at_node[5] = grid.BC_NODE_IS_CLOSED
    land = landscape(grid)
    assert land.shape == (30, 40) and not land.mask[29, 5] and int(land.mask.sum()) == 1199
    assert tuple(land.transform)[:6] == (10.0, 0.0, 995.0, 0.0, -10.0, 2295.0)
    before = grid.at_node["topographic__elevation"].copy()
    eroder = HydraulicEroder(grid, iterations=40)
    eroder.run_one_step()
    land.hydraulic(iterations=40)
    after = grid.at_node["topographic__elevation"]
    assert np.array_equal(after.reshape(30, 40)[::-1][land.mask], land["height"][land.mask].astype(float))
    assert after[5] == before[5] and not np.array_equal(after, before)
    assert eroder.report is not None and eroder.report.iterations == 40
    FlowAnalyzer(grid).run_one_step()
    assert np.array_equal(grid.at_node["drainage_area"].reshape(30, 40)[::-1][land.mask], land.flow()["accumulation"][land.mask])

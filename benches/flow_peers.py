#!/usr/bin/env python3
"""Times flow accumulation of other programs on one grid: depressions filled, directions, D8 upslope areas.

    weald run GROUND.toml          # writes ground.npy, 4096 × 4096, by diamond-square with relief 800 and seed 7
    python benches/flow_peers.py ground.npy [pysheds] [richdem]

Prints seconds of wall time and of processor time, for each stage. `weald bench --size 4096` has ours.
pysheds 0.5 compiles its loops when they first run; a run on a corner of the grid goes before the measurement.
"""

import sys
import tempfile
import time
from pathlib import Path

import numpy


class Stages:
    """Measures one stage after the other."""

    def __init__(self, name):
        self.name, self.total = name, [0.0, 0.0]

    def __call__(self, stage, work):
        wall, processor = time.perf_counter(), time.process_time()
        result = work()
        spent = [time.perf_counter() - wall, time.process_time() - processor]
        self.total = [sum(pair) for pair in zip(self.total, spent)]
        print(f"{self.name:<8} {stage:<12} {spent[0]:7.2f} s  processor {spent[1]:7.2f} s", flush=True)
        return result

    def sum(self):
        print(f"{self.name:<8} {'all':<12} {self.total[0]:7.2f} s  processor {self.total[1]:7.2f} s", flush=True)


def pysheds(height, measure):
    import rasterio
    from pysheds.grid import Grid

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "height.tif"
        shape = {"height": height.shape[0], "width": height.shape[1], "count": 1, "dtype": "float32"}
        place = rasterio.transform.from_origin(0, 10 * height.shape[0], 10, 10)
        with rasterio.open(path, "w", "GTiff", crs="EPSG:32633", nodata=-1e9, transform=place, **shape) as file:
            file.write(height, 1)
        grid = Grid.from_raster(str(path))
        ground = grid.read_raster(str(path))
    pits = measure("pits", lambda: grid.fill_pits(ground))
    filled = measure("depressions", lambda: grid.fill_depressions(pits))
    resolved = measure("flats", lambda: grid.resolve_flats(filled))
    directions = measure("directions", lambda: grid.flowdir(resolved))
    return measure("areas", lambda: grid.accumulation(directions))


def richdem(height, measure):
    import richdem

    ground = richdem.rdarray(height, no_data=-1e9)
    filled = measure("depressions", lambda: richdem.FillDepressions(ground, epsilon=False))
    resolved = measure("flats", lambda: richdem.ResolveFlats(filled))
    return measure("areas", lambda: richdem.FlowAccumulation(resolved, method="D8"))


PEERS = {"pysheds": pysheds, "richdem": richdem}


def main():
    height = numpy.load(sys.argv[1]).astype(numpy.float32)
    for name in sys.argv[2:] or PEERS:
        PEERS[name](height[:256, :256].copy(), lambda _, work: work())
        measure = Stages(name)
        areas = PEERS[name](height, measure)
        measure.sum()
        print(f"{name:<8} greatest area {float(numpy.nanmax(areas)):.0f} cells")


if __name__ == "__main__":
    main()

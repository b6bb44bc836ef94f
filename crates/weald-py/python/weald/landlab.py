"""Components of landlab: erosion and flow on a `RasterModelGrid`. Rows of landlab go north, those of Weald south."""

from __future__ import annotations

from typing import Any

import numpy as np
from landlab import Component, RasterModelGrid
from numpy.typing import NDArray

from ._errors import UsageError
from ._landscape import Landscape
from ._steps import StepReport

_NODE = {"dtype": float, "optional": False, "mapping": "node"}
_ELEVATION = "topographic__elevation"


def landscape(grid: RasterModelGrid) -> Landscape:
    """The elevation of a grid as a landscape; closed nodes hold no data."""
    if grid.dx != grid.dy:
        raise UsageError(f"nodes are {grid.dx} and {grid.dy} m apart; a landscape has square cells")
    x, y = (float(value) for value in grid.xy_of_lower_left)
    north = y + (grid.shape[0] - 0.5) * grid.dy
    transform = (grid.dx, 0.0, x - 0.5 * grid.dx, 0.0, -grid.dy, north)
    closed = _rows(grid, grid.status_at_node) == grid.BC_NODE_IS_CLOSED
    return Landscape(_rows(grid, grid.at_node[_ELEVATION]), transform=transform, mask=~closed)


def _rows(grid: RasterModelGrid, values: NDArray[Any]) -> NDArray[Any]:
    return values.reshape(grid.shape)[::-1]


def _put(grid: RasterModelGrid, field: str, values: NDArray[Any], where: NDArray[np.bool_]) -> None:
    """Only where there is data: the other nodes keep what they have."""
    nodes = grid.at_node[field].reshape(grid.shape)[::-1]
    nodes[where] = values[where]


class HydraulicEroder(Component):  # type: ignore[misc]
    """Carves the ground by rain, rivers and sediment: the step `hydraulic`, with its keywords."""

    _name = "HydraulicEroder"
    _unit_agnostic = False
    _cite_as = ""
    _info = {
        _ELEVATION: {**_NODE, "intent": "inout", "units": "m", "doc": "Land surface topographic elevation"},
        "surface_water__depth": {**_NODE, "intent": "out", "units": "m", "doc": "Depth of water on the surface"},
    }

    def __init__(self, grid: RasterModelGrid, **keys: Any) -> None:
        super().__init__(grid)
        self.initialize_output_fields()
        self._keys = keys
        self.report: StepReport | None = None
        """What the last step reported."""

    def run_one_step(self, dt: float | None = None) -> None:
        """Runs all `iterations`; they have no length in time, so `dt` is not used."""
        land = landscape(self.grid)
        self.report = land.hydraulic(**self._keys)
        for field, layer in [(_ELEVATION, "height"), ("surface_water__depth", "water")]:
            _put(self.grid, field, land[layer], land.mask)


class FlowAnalyzer(Component):  # type: ignore[misc]
    """Drainage areas over filled or breached ground: the step `flow`, with its keywords."""

    _name = "FlowAnalyzer"
    _unit_agnostic = False
    _cite_as = ""
    _info = {
        _ELEVATION: {**_NODE, "intent": "in", "units": "m", "doc": "Land surface topographic elevation"},
        "drainage_area": {**_NODE, "intent": "out", "units": "m**2", "doc": "Upstream contributing area"},
    }

    def __init__(self, grid: RasterModelGrid, **keys: Any) -> None:
        super().__init__(grid)
        self.initialize_output_fields()
        self._keys = keys

    def run_one_step(self, dt: float | None = None) -> None:
        """Analyses the ground as it is; `dt` is not used."""
        land = landscape(self.grid)
        _put(self.grid, "drainage_area", land.flow(**self._keys)["accumulation"], land.mask)

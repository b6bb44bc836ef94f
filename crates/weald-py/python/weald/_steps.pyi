"""Every step of the catalogue as a method; written by `python -m weald._stubs write`."""

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

class Steps:
    """A method for each step of the catalogue."""

    def _run_step(self, name: str, keys: dict[str, Any], call: dict[str, Any]) -> Any: ...
    def fault(
        self,
        *,
        iterations: int = 200,
        scale: float = 10.0,
        relief: float | None = None,
        seed: int | None = None,
        into: str = "height",
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Random lines lift one side and lower the other, by heights that shrink. Source: Fault formation, common in games (OGLDEV tutorial).

        Writes, by default: `height` (m).

        iterations: whole number, 1 to 65536; default 200
            Number of faults. The last one has size 0, so 1 gives a flat map.
        scale: number, 0 to 1000000 m; default 10.0
            Height by which the first fault would move its sides if there were endlessly many; later ones shrink evenly to 0.
        relief: number, 0 to 1000000 m
            Height between the lowest and the highest point. Without it heights lie on both sides of 0, at most `scale * (iterations - 1) / 2` from it.
        seed: whole number, 0 to 9007199254740991
            A seed of its own. Without it the landscape's is used, varied for each step.
        into: layer name; default "height"
            Layer that is written.
        """
    def diamond_square(
        self,
        *,
        relief: float = 1000.0,
        roughness: float = 0.9,
        seed: int | None = None,
        into: str = "height",
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Mountains by midpoint displacement on a lattice that doubles at every level. Source: Fournier, Fussell, Carpenter 1982; Miller 1986.

        Writes, by default: `height` (m).

        relief: number, 0 to 1000000 m; default 1000.0
            Height between the lowest and the highest point.
        roughness: number, 0 to 2; default 0.9
            Amplitude is multiplied by 2^-roughness at every level: 1 is smooth, 0.5 rugged.
        seed: whole number, 0 to 9007199254740991
            A seed of its own. Without it the landscape's is used, varied for each step.
        into: layer name; default "height"
            Layer that is written.
        """
    def fbm(
        self,
        *,
        relief: float = 1000.0,
        wavelength: float = 5000.0,
        octaves: int = 8,
        gain: float = 0.5,
        lacunarity: float = 2.0,
        seed: int | None = None,
        into: str = "height",
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Rolling ground: noise at shrinking wavelengths, added. Source: Musgrave, Kolb, Mace 1989.

        Writes, by default: `height` (m).

        relief: number, 0 to 1000000 m; default 1000.0
            Height that a landscape of some wavelengths spans: six standard deviations, around a mean of half.
        wavelength: number, 0.001 to 1000000000 m; default 5000.0
            Length of the largest hills and valleys.
        octaves: whole number, 1 to 16; default 8
            Number of wavelengths added.
        gain: number, 0 to 1; default 0.5
            Height of each octave relative to the one before: 0.5 is rolling, 0.7 rugged.
        lacunarity: number, 1 to 8; default 2.0
            How many times shorter each octave's wavelength is than the one before.
        seed: whole number, 0 to 9007199254740991
            A seed of its own. Without it the landscape's is used, varied for each step.
        into: layer name; default "height"
            Layer that is written.
        """
    def ridged(
        self,
        *,
        relief: float = 1000.0,
        wavelength: float = 8000.0,
        octaves: int = 8,
        gain: float = 0.5,
        lacunarity: float = 2.0,
        sharpness: float = 2.0,
        seed: int | None = None,
        into: str = "height",
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Mountain crests: noise folded at zero, rough on top and smooth below. Source: Musgrave, in Ebert et al. 2003, chapter 16.

        Writes, by default: `height` (m).

        relief: number, 0 to 1000000 m; default 1000.0
            Height between the lowest and the highest point that can be; a landscape spans most of it.
        wavelength: number, 0.001 to 1000000000 m; default 8000.0
            Length of the largest forms; crests lie about half as far apart.
        octaves: whole number, 1 to 16; default 8
            Number of wavelengths added.
        gain: number, 0 to 1; default 0.5
            Height of each octave relative to the one before.
        lacunarity: number, 1 to 8; default 2.0
            How many times shorter each octave's wavelength is than the one before.
        sharpness: number, 0 to 8; default 2.0
            How far down from the crests the finer octaves show.
        seed: whole number, 0 to 9007199254740991
            A seed of its own. Without it the landscape's is used, varied for each step.
        into: layer name; default "height"
            Layer that is written.
        """
    def warp(
        self,
        *,
        relief: float = 1000.0,
        wavelength: float = 5000.0,
        octaves: int = 8,
        gain: float = 0.5,
        lacunarity: float = 2.0,
        strength: float = 0.1,
        seed: int | None = None,
        into: str = "height",
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Folded ground: noise at places displaced by noise. Source: Quilez 2002; Ebert et al. 2003.

        Writes, by default: `height` (m).

        relief: number, 0 to 1000000 m; default 1000.0
            Height that a landscape of some wavelengths spans: six standard deviations, around a mean of half.
        wavelength: number, 0.001 to 1000000000 m; default 5000.0
            Length of the largest hills and valleys before they are bent.
        octaves: whole number, 1 to 16; default 8
            Number of wavelengths added.
        gain: number, 0 to 1; default 0.5
            Height of each octave relative to the one before.
        lacunarity: number, 1 to 8; default 2.0
            How many times shorter each octave's wavelength is than the one before.
        strength: number, 0 to 4; default 0.1
            Standard deviation of the displacement in wavelengths: 0 is plain fBm, 0.05 bends, 0.2 folds.
        seed: whole number, 0 to 9007199254740991
            A seed of its own. Without it the landscape's is used, varied for each step.
        into: layer name; default "height"
            Layer that is written.
        """
    def plane(
        self,
        *,
        slope: float = 0.1,
        azimuth_deg: float = 180.0,
        height: float = 0.0,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """An inclined plane through the middle of the landscape. Source: Weald.

        Writes, by default: `height` (m).

        slope: number, 0 to 1000; default 0.1
            Rise over run.
        azimuth_deg: number, -360 to 360 deg; default 180.0
            Direction in which the ground falls, clockwise from north: 180 falls to the south.
        height: number, -1000000 to 1000000 m; default 0.0
            Height at the middle of the landscape.
        into: layer name; default "height"
            Layer that is written.
        """
    def cone(
        self,
        *,
        peak: float = 100.0,
        base: float = 0.0,
        slope: float = 1.0,
        center_x: float | None = None,
        center_y: float | None = None,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """A cone on flat ground. Source: Weald.

        Writes, by default: `height` (m).

        peak: number, -1000000 to 1000000 m; default 100.0
            Height of the tip. A cell holds it only where its centre lies on the axis.
        base: number, -1000000 to 1000000 m; default 0.0
            Height of the ground around.
        slope: number, 0 to 1000; default 1.0
            Rise over run of the flank.
        center_x: number, -1000000000 to 1000000000 m
            The axis, from the western edge. Without it, the middle.
        center_y: number, -1000000000 to 1000000000 m
            The axis, from the northern edge. Without it, the middle.
        into: layer name; default "height"
            Layer that is written.
        """
    def dome(
        self,
        *,
        rise: float = 1.0,
        base: float = 0.0,
        radius: float = 5000.0,
        radius_across: float | None = None,
        azimuth_deg: float = 90.0,
        center_x: float | None = None,
        center_y: float | None = None,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """A smooth dome, round or long, on flat ground. Source: Weald.

        Writes, by default: `height` (m).

        rise: number, -1000000 to 1000000 m; default 1.0
            Height of its middle above the ground around; below 0, a hollow.
        base: number, -1000000 to 1000000 m; default 0.0
            Height of the ground around.
        radius: number, 0.001 to 1000000000 m; default 5000.0
            Distance from the middle to the edge along its axis.
        radius_across: number, 0.001 to 1000000000 m
            The same across its axis. Without it, as long: the dome is round.
        azimuth_deg: number, -360 to 360 deg; default 90.0
            Direction of its axis, clockwise from north.
        center_x: number, -1000000000 to 1000000000 m
            Its middle, from the western edge. Without it, that of the landscape.
        center_y: number, -1000000000 to 1000000000 m
            Its middle, from the northern edge. Without it, that of the landscape.
        into: layer name; default "height"
            Layer that is written.
        """
    def volcano(
        self,
        *,
        rise: float = 1500.0,
        base: float = 0.0,
        radius: float = 8000.0,
        concavity: float = 3.0,
        crater_radius: float = 300.0,
        crater_depth: float = 150.0,
        center_x: float | None = None,
        center_y: float | None = None,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """A cone with a crater, steeper towards its rim, on flat ground. Source: Milne 1878, On the form of volcanoes, Geological Magazine 5.

        Writes, by default: `height` (m).

        rise: number, 0 to 1000000 m; default 1500.0
            Height of the rim of the crater above the ground around.
        base: number, -1000000 to 1000000 m; default 0.0
            Height of the ground around.
        radius: number, 0.001 to 1000000000 m; default 8000.0
            Distance from the axis to the foot.
        concavity: number, 0 to 20; default 3.0
            How hollow the flanks are (c): 0 for a straight cone; at 3 they are 20 times as steep at the axis as at the foot.
        crater_radius: number, 0 to 1000000000 m; default 300.0
            Distance from the axis to the rim of the crater; 0 for a tip.
        crater_depth: number, 0 to 1000000 m; default 150.0
            Depth of the crater below its rim.
        center_x: number, -1000000000 to 1000000000 m
            The axis, from the western edge. Without it, the middle.
        center_y: number, -1000000000 to 1000000000 m
            The axis, from the northern edge. Without it, the middle.
        into: layer name; default "height"
            Layer that is written.
        """
    def basin(
        self,
        *,
        depth: float = 50.0,
        rim: float = 100.0,
        radius: float | None = None,
        center_x: float | None = None,
        center_y: float | None = None,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """A round bowl in flat ground. Source: Weald.

        Writes, by default: `height` (m).

        depth: number, 0 to 1000000 m; default 50.0
            Depth of the deepest point below the rim.
        rim: number, -1000000 to 1000000 m; default 100.0
            Height of the rim and of the ground around.
        radius: number, 0.001 to 1000000000 m
            Radius of the rim. Without it, half the shorter side of the landscape.
        center_x: number, -1000000000 to 1000000000 m
            The deepest point, from the western edge. Without it, the middle.
        center_y: number, -1000000000 to 1000000000 m
            The deepest point, from the northern edge. Without it, the middle.
        into: layer name; default "height"
            Layer that is written.
        """
    def constant(
        self,
        *,
        height: float = 0.0,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Flat ground: the same height everywhere. Source: Weald.

        Writes, by default: `height` (m).

        height: number, -1000000 to 1000000 m; default 0.0
            Height everywhere.
        into: layer name; default "height"
            Layer that is written.
        """
    def load(
        self,
        *,
        file: str | PathLike[str],
        into: str,
        scale: float = 1.0,
        offset: float = 0.0,
        resample: bool = False,
        no_data: float | None = None,
        unit: Literal["m", "ft", "us-ft", "km", "dm", "cm", "mm", "1"] | None = None,
        crs: str | None = None,
        nodata: float | None = None,
        elsewhere: bool = False,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Loads a layer from a raster file. Source: Weald.

        Writes, by default: `` (m).

        file: raster file; must be given
            Raster file of any format that is read, as many cells as the landscape; its path starts at the folder of the recipe.
        into: layer name; must be given
            Layer that is written, in metres: heights, or the thickness of the material of that name.
        scale: number, -1000000000 to 1000000000; default 1.0
            Metres that a 1 in the file stands for. A 16-bit PNG holds 0 to 65535 where it says nothing else.
        offset: number, -1000000000 to 1000000000 m; default 0.0
            Metres that are added.
        resample: true or false; default false
            Whether a file of another number of cells is brought to that of the landscape, as by a `resample` step.
        no_data: number, -1000000000 to 1000000000 m
            Value, in metres, of cells without data. Without it, they are an error where the landscape has ground.
        unit: "m" | "ft" | "us-ft" | "km" | "dm" | "cm" | "mm" | "1"
            Unit of the values of a file that names none; without it they are metres.
        crs: CRS "EPSG:…"
            Coordinate reference system of a file that names none.
        nodata: number, any finite
            Number of the cells without data, as `weald info` shows it, in a file that does not say it.
        elsewhere: true or false; default false
            Whether a file that lies elsewhere on Earth than the landscape is laid on it all the same, cell by cell.
        """
    def add(
        self,
        *,
        layer: str = "height",
        with_: str,
        factor: float = 1.0,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Adds a layer, times a factor, to another. Source: Weald.

        Writes, by default: `height` (unit of `layer`).

        layer: layer name; default "height"
            Layer that is added to.
        with_: layer name; must be given
            Layer that is added.
        factor: number, -1000000 to 1000000; default 1.0
            What `with` is multiplied by first.
        into: layer name
            Layer that is written. Without it, `layer`.
        """
    def max(
        self,
        *,
        layer: str = "height",
        with_: str,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """The higher of two layers in every cell. Source: Weald.

        Writes, by default: `height` (unit of `layer`).

        layer: layer name; default "height"
            One layer.
        with_: layer name; must be given
            The other.
        into: layer name
            Layer that is written. Without it, `layer`.
        """
    def min(
        self,
        *,
        layer: str = "height",
        with_: str,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """The lower of two layers in every cell. Source: Weald.

        Writes, by default: `height` (unit of `layer`).

        layer: layer name; default "height"
            One layer.
        with_: layer name; must be given
            The other.
        into: layer name
            Layer that is written. Without it, `layer`.
        """
    def blend(
        self,
        *,
        layer: str = "height",
        with_: str,
        mask: str,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Blends two layers by a mask. Source: Weald.

        Writes, by default: `height` (unit of `layer`).

        layer: layer name; default "height"
            Layer that shows where the mask is 0.
        with_: layer name; must be given
            Layer that shows where the mask is 1.
        mask: layer name; must be given
            The mask, 0 to 1.
        into: layer name
            Layer that is written. Without it, `layer`.
        """
    def remap(
        self,
        *,
        layer: str = "height",
        from_: Sequence[float] = [],
        to: Sequence[float] = [0.0, 1.0],
        clamp: bool = True,
        gamma: float = 1.0,
        curve: Sequence[float] = [],
        unit: str | None = None,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Brings a layer from one range to another. Source: Weald.

        Writes, by default: `height` (unit of `layer`).

        layer: layer name; default "height"
            Layer that is read.
        from_: list of numbers, -1000000000 to 1000000000; default []
            `[low, high]` of the values before. Empty: the layer's own range over cells with data.
        to: list of numbers, -1000000000 to 1000000000; default [0.0, 1.0]
            `[low, high]` of the values after; high first turns them over.
        clamp: true or false; default true
            Whether values outside `from` become the ends of `to`; otherwise the line goes on beyond them.
        gamma: number, 0.01 to 100; default 1.0
            Exponent of the way from low to high: above 1 lowers the middle, below 1 lifts it.
        curve: list of numbers, 0 to 1; default []
            Heights of a curve at even steps from 0 to 1, joined by lines: `[0, 0, 1]` cuts off the lower half.
        unit: text
            Unit of the result, for files and the report: `"1"` for a mask. Without it, the unit of `layer`.
        into: layer name
            Layer that is written. Without it, `layer`.
        """
    def terrace(
        self,
        *,
        layer: str = "height",
        spacing: float = 50.0,
        softness: float = 0.3,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Cuts slopes into steps. Source: Weald.

        Writes, by default: `height` (unit of `layer`).

        layer: layer name; default "height"
            Layer that is read.
        spacing: number, 0.001 to 1000000 m; default 50.0
            Height from one level to the next; levels are whole multiples of it.
        softness: number, 0 to 1; default 0.3
            Share of each step that rises: 0 is a cliff, 1 a soft wave.
        into: layer name
            Layer that is written. Without it, `layer`.
        """
    def smooth(
        self,
        *,
        layer: str = "height",
        radius: float = 50.0,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Blurs a layer by a Gaussian. Source: Knutsson and Westin 1993.

        Writes, by default: `height` (unit of `layer`).

        layer: layer name; default "height"
            Layer that is read.
        radius: number, 0 to 1000000 m; default 50.0
            Standard deviation of the Gaussian. Forms much shorter than six of it vanish.
        into: layer name
            Layer that is written. Without it, `layer`.
        """
    def displace(
        self,
        *,
        layer: str = "height",
        east: str | None = None,
        south: str | None = None,
        factor: float = 1.0,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Bends a layer: each cell takes the value from a place that other layers say. Source: Weald.

        Writes, by default: `height` (unit of `layer`).

        layer: layer name; default "height"
            Layer that is read.
        east: layer name
            Layer with the way eastward to the place that a cell takes its value from, in metres. Without it, 0.
        south: layer name
            The same southward.
        factor: number, -1000000 to 1000000; default 1.0
            Factor on both.
        into: layer name
            Layer that is written. Without it, `layer`.
        """
    def resample(
        self,
        *,
        size: int | Sequence[int],
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Brings all layers to another number of cells over the same ground. Source: Catmull and Rom 1974; Keys 1981.

        size: whole number from 1, or [columns, rows]; must be given
            Cells a side, or `[columns, rows]`, in the proportion of the landscape.
        """
    def layers(
        self,
        *,
        of: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Writes the height of the bedrock and the thickness of each material on it. Source: Weald.

        of: layer name; default "height"
            Layer of the height of the ground, under which the materials lie.
        """
    def top_material(
        self,
        *,
        of: str = "height",
        thinnest: float = 0.01,
        into: str = "material",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Maps the material at the surface, counted from the bedrock as 0. Source: Weald.

        Writes, by default: `material`.

        of: layer name; default "height"
            Layer of the height of the ground, under which the materials lie.
        thinnest: number, 0 to 1000 m; default 0.01
            A material that is thinner than this does not count as lying at the surface.
        into: layer name; default "material"
            Layer that is written: 0 for the bedrock, 1 for the material on it, and so on.
        """
    def paint_layer(
        self,
        *,
        into: str,
        of: str | None = None,
        value: float = 1.0,
        strokes: Sequence[Mapping[str, Any]] = [],
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Paints a layer by hand, such as how densely plants stand. Source: Weald.

        Writes, by default: ``.

        into: layer name; must be given
            Layer that is written.
        of: layer name
            Layer that is painted on; it stays as it is. Without it, the same value everywhere.
        value: number, -1000000 to 1000000; default 1.0
            That value.
        strokes: list of tables; default []
            Strokes, the first one lowest: `[{ path = [[400, 300], [900, 320]], radius = 40, value = 0 }, …]`.
        """
    def hydraulic(
        self,
        *,
        model: Literal["han", "mei", "stava"] = "han",
        flow_rate: float | None = None,
        rain: float | None = None,
        evaporation: float | None = None,
        dry_period: int | None = None,
        law: Literal["velocity", "dissolution"] = "velocity",
        capacity: float | None = None,
        erosion: float | None = None,
        deposit_ratio: float = 1.0,
        limiter: bool = True,
        transport: Literal["upwind", "semi-lagrangian", "maccormack"] | None = None,
        conserve: bool = True,
        velocity_epsilon: float | None = None,
        thermal: Mapping[str, Any] | None = None,
        deposition: float = 0.1,
        slope: Literal["mean-sine", "central"] = "mean-sine",
        rain_layer: str | None = None,
        evaporation_layer: str | None = None,
        source_layer: str | None = None,
        sources: Sequence[Mapping[str, Any]] = [],
        drains: Sequence[Mapping[str, Any]] = [],
        viscosity: float = 0.0,
        deposit: str | None = None,
        dissolution: Mapping[str, Any] | None = None,
        slippage: Mapping[str, Any] | None = None,
        iterations: int = 1000,
        rain_period: int = 60,
        epsilon: float | None = None,
        boundary: Literal["closed", "open"] = "closed",
        layer: str = "height",
        initial_water: str | None = None,
        region: str | None = None,
        mean_over: int | None = None,
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Carves ground by rain, rivers and sediment. Source: Han 2015, doi 10.7583/JKGS.2015.15.6.171; Mei, Decaudin, Hu 2007, doi 10.1109/PG.2007.15; Šťava et al. 2008, doi 10.2312/SCA/SCA08/201-210.

        Writes, by default: `height` (m), `water` (m), `sediment` (m), `flux_x` (m³/step), `flux_y` (m³/step), `erosion` (m), `deposition` (m).

        model: "han" | "mei" | "stava"; default "han"
            Whose scheme.
        flow_rate: number, 0.0001 to 0.5; default 0.4 (han), 0.1 (mei), 0.0981 (stava); for han, mei, stava
            Pipe constant k, which is no discharge: how fast differences in level turn into flow. It stands for dt² g A / l with lengths in cells and has no unit. Unstable above 0.5.
        rain: number, 0 to 100 m/iteration; default 0.01 × cell size (han), 0.002 × cell size (mei), 0.002 × cell size (stava); for han, mei, stava
            Rain in an iteration of a rain period. It is no rainfall intensity, for an iteration has no duration.
        evaporation: number, 0 to 100 m/iteration; default 0.03 × cell size (han), 0.015 (mei), 0.006 × cell size (stava); for han, mei, stava
            Evaporation in an iteration of a dry period.
        dry_period: whole number, 0 to 10000000 iterations; default 60 (han), 0 (mei), 60 (stava); for han, mei, stava
            Iterations without rain that follow; 0 means that it always rains.
        law: "velocity" | "dissolution"; default "velocity"; for han
            What sediment is taken up by.
        capacity: number, 0 to 10000; default 0.05 (mei), 0.5 (stava); for han, mei, stava
            Transport capacity (K_c): depth of sediment by depth of water at a speed of 1 cell/iteration on a slope with the sine 1. Default 10, with law = "dissolution" 1.
        erosion: number, 0 to 1; default 0.1 (mei), 20.0 (stava); for han, mei, stava
            With law = "velocity" the depth in cells that an iteration takes up at a speed of 1 cell/iteration (K_v), default 0.005; with law = "dissolution" the share of the unused transport capacity that an iteration takes up (K_s), default 0.01.
        deposit_ratio: number, 0 to 1; default 1.0; for han, mei
            Share of the deposited sediment that is added to the ground (r). The rest leaves the model and counts as solid out, so that below 1 lakes do not silt up.
        limiter: true or false; default true; for han, mei
            Whether a cell gives no more water than it has. `false` is the scheme as printed, which lets depths go negative.
        transport: "upwind" | "semi-lagrangian" | "maccormack"; default "upwind" (han), "upwind" (mei), "maccormack" (stava); for han, mei, stava
            How sediment travels.
        conserve: true or false; default true; for han, mei, stava
            Whether it takes the form that conserves sediment.
        velocity_epsilon: number, 0.0000001 to 100 m; default 0.1 × cell size (han), 0.0001 × cell size (mei), 0.02 × cell size (stava); for han, mei, stava
            Depth added to the depth of the water where velocity = flux / depth.
        thermal: table; for han, mei
            Thermal weathering (dry sliding to the talus) in every iteration, with the keys of the `thermal` step. Default: none.
        deposition: number, 0 to 1; default 0.1; for mei, stava
            Share of the sediment above the transport capacity that settles in an iteration (K_d).
        slope: "mean-sine" | "central"; default "mean-sine"; for mei
            The slope that counts for the transport capacity. The publication has the tilt of the ground and does not say how it is found.
        rain_layer: layer name; for stava
            Layer with a factor of the rain, cell by cell.
        evaporation_layer: layer name; for stava
            Layer with a factor of the evaporation, cell by cell.
        source_layer: layer name; for stava
            Layer with the depth of water that springs in an iteration, in metres; drains where it is negative, with the sediment that the water carries.
        sources: list of tables; default []; for stava
            Places where water springs.
        drains: list of tables; default []; for stava
            Places where water drains, as far as there is any, with the sediment that it carries.
        viscosity: number, 0 to 1000000 m²/iteration; default 0.0; for stava
            Viscosity of the water, which evens out its velocity; 0 is none.
        deposit: layer name; for stava
            Material that settles. Default: the last of the landscape.
        dissolution: table; for stava
            Dissolution: ground under standing water loses its strength (nothing chemical is meant) and creeps as regolith. Default: it does not.
        slippage: table; for stava
            Slippage: materials slide off slopes steeper than their talus. Default: they do not.
        iterations: whole number, 0 to 10000000; default 1000
            Iterations to run. An iteration has no fixed physical duration.
        rain_period: whole number, 1 to 10000000 iterations; default 60
            Iterations of rain before a dry period.
        epsilon: number, 0.0000001 to 100 m; default 0.001 × cell size
            Depth added to the divisor where sediment is divided by depth.
        boundary: "closed" | "open"; default "closed"
            What happens at the edge and at no-data cells.
        layer: layer name; default "height"
            Layer to erode.
        initial_water: layer name
            Layer with the depth of water that stands at the start. Default: none stands.
        region: layer name
            Layer that says where to simulate: cells where it is below 0.5 stand still, and nothing passes their edge. Default: everywhere.
        mean_over: whole number, 1 to 10000000 iterations
            Iterations at the end over which `flux_x` and `flux_y` are averaged. Default: the last whole cycle of rain and sun.
        edits: script of edits
            Script of edits, in JSON lines (.jsonl) or TOML: strokes of a brush, and keys that change, between iterations. Its path starts at the folder of the recipe.
        """
    def thermal(
        self,
        *,
        scheme: Literal["axis", "isotropic", "isotropic-symmetric"] = "isotropic",
        talus: float = 0.8,
        strength: float = 0.05,
        iterations: int = 100,
        layer: str = "height",
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Lets ground steeper than its talus slide until it rests (dry mass wasting). Source: Han 2015, eq. 17–21, doi 10.7583/JKGS.2015.15.6.171.

        Writes, by default: `height` (m).

        scheme: "axis" | "isotropic" | "isotropic-symmetric"; default "isotropic"
            How slopes are compared with the talus.
        talus: number, 0 to 10 (a tangent: 35° is 0.7); default 0.8
            Steepest slope that rests, as a tangent (rise over run); 0.8 is 39°.
        strength: number, 0 to 0.25; default 0.05
            Share of the excess that slides in an iteration. Unstable above 0.25.
        iterations: whole number, 0 to 10000000; default 100
            Iterations to run.
        layer: layer name; default "height"
            Layer to weather.
        edits: script of edits
            Script of edits, in JSON lines (.jsonl) or TOML: strokes of a brush, and keys that change, between iterations. Its path starts at the folder of the recipe.
        """
    def transport(
        self,
        *,
        layer: str,
        iterations: int = 100,
        scheme: Literal["semi-lagrangian", "maccormack"] = "maccormack",
        conserve: bool = True,
        water: str = "water",
        flux_x: str = "flux_x",
        flux_y: str = "flux_y",
        epsilon: float | None = None,
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Carries a layer along with water that flows steadily. Source: Zalesak 1979, doi 10.1016/0021-9991(79)90051-2; Selle et al. 2008, doi 10.1007/s10915-007-9166-4.

        Writes, by default: `` (m).

        layer: layer name; must be given
            Layer to carry, as an amount in each cell: what leaves a cell enters its neighbours.
        iterations: whole number, 0 to 10000000; default 100
            Iterations to run.
        scheme: "semi-lagrangian" | "maccormack"; default "maccormack"
            How it travels.
        conserve: true or false; default true
            Whether it takes the form that conserves the layer's sum.
        water: layer name; default "water"
            Layer with the depth of water.
        flux_x: layer name; default "flux_x"
            Layer with the flow through the eastern edge of each cell, in m³ per iteration.
        flux_y: layer name; default "flux_y"
            Layer with the flow through the southern edge of each cell, in m³ per iteration.
        epsilon: number, 0.0000001 to 100 m; default 0.001 × cell size
            Depth added where amounts and flows are divided by depth.
        edits: script of edits
            Script of edits, in JSON lines (.jsonl) or TOML: keys that change between iterations. Its path starts at the folder of the recipe.
        """
    def fluvial(
        self,
        *,
        duration: float = 10000.0,
        flow_time: float = 3.0,
        rain: float = 40.0,
        rain_map: str | None = None,
        evaporation: float = 0.0,
        sources: Sequence[Mapping[str, Any]] = [],
        erodibility: float = 3.0,
        erodibility_map: str | None = None,
        materials: bool = False,
        cover: float = 0.5,
        threshold: float = 0.002,
        settling: float = 0.0005,
        channel_width: float = 4.0,
        lateral_wear: float = 0.05,
        gathering: float = 40.0,
        friction: float = 0.01,
        deepest: float = 2.0,
        creep: float = 0.01,
        talus: float = 0.7,
        slide: float = 1.0,
        levels: int = 1,
        coarsest: float = 40.0,
        steps: int | None = None,
        mean_over: int | None = None,
        boundary: Literal["closed", "open"] = "open",
        layer: str = "height",
        initial_water: str | None = None,
        region: str | None = None,
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Carves ground by the floods of years, in metres and time. Source: Bates, Horritt, Fewtrell 2010, doi 10.1016/j.jhydrol.2010.03.027; Davy and Lague 2009, doi 10.1029/2008JF001146.

        Writes, by default: `height` (m), `water` (m), `sediment` (m), `flux_x` (m³/s), `flux_y` (m³/s), `erosion` (m), `deposition` (m).

        duration: number, 0 to 100000000 a; default 10000.0
            Years that pass for the ground.
        flow_time: number, 0.001 to 100000 h; default 3.0
            Time of flow that stands for them: all of these years' floods as one. Water needs some hours to come down from a mountain range; the longer it flows, the less the ground changes under it at a time.
        rain: number, 0 to 10000 mm/h; default 40.0
            Rain that runs off in a flood, over all of the ground.
        rain_map: layer name
            Layer with the share of the rain that falls on each cell; 1 is `rain`. Default: 1 everywhere.
        evaporation: number, 0 to 10000 mm/h; default 0.0
            Water that evaporates in a flood, from wherever it stands or runs, while there is any.
        sources: list of tables; default []
            Rivers and springs that flow in: `{ x, y, radius, discharge }`.
        erodibility: number, 0 to 100000 m/a per m²/s; default 3.0
            Ground that a unit of stream power takes up in a year (K). Hard rock has less than 1, loose soil 10 and more.
        erodibility_map: layer name
            Layer that multiplies the erodibility: 0.1 for hard, 10 for soft ground. Default: 1 everywhere.
        materials: true or false; default false
            Whether each material wears and rests in its own way: `erodibility` is then that of the bedrock, those of the others stand to it as theirs do, and each has its own talus. What has settled or slid counts as the last material.
        cover: number, 0.001 to 1000 m; default 0.5
            Thickness of loose material that protects by half the rock it lies on, with `materials`.
        threshold: number, 0 to 1000 m²/s; default 0.002
            Unit stream power below which nothing is taken up: discharge by width, times slope.
        settling: number, 0 to 10 m/s; default 0.0005
            Speed at which sediment falls to the bed (v_s): the faster, the sooner it settles again. Fine sand and silt leave mountains with 0.0005; gravel, with 0.005, fills their valleys.
        channel_width: number, 0.01 to 1000 m; default 4.0
            Width of a channel in which 1 m³/s flows; others are wider with the root of their discharge.
        lateral_wear: number, 0 to 10; default 0.05
            How fast a river that is wider than a cell wears its banks (β). By 0.05 it comes to be about as wide as `channel_width` says, whatever the cells; with 0 it only cuts down, and stays as narrow as a cell; more than 0.2 bends rivers back on fans. Banks wear as the bed beside them does, whatever they are of.
        gathering: number, 0.01 to 10000 m; default 40.0
            Distance of the channels in which water gathers that runs down a slope as a sheet. Where cells are longer than that, what has gathered in a cell wears more than it would on finer ones: `coarsest` should be no longer.
        friction: number, 0.0001 to 10; default 0.01
            Friction of the bed (c_f, an eighth of the factor of Darcy and Weisbach): 0.003 for smooth, 0.1 for rough beds.
        deepest: number, 0.01 to 1000 m; default 2.0
            Depth from which on water flows as if it were that deep. It bounds the speed of waves, and so the number of steps.
        creep: number, 0 to 1000 m²/a; default 0.01
            Creep of the ground (D), which rounds what rivers do not reach.
        talus: number, 0 to 10 (a tangent: 35° is 0.7); default 0.7
            Steepest slope that rests, as a tangent.
        slide: number, 0 to 10000 m²/a; default 1.0
            How fast steeper ground slides.
        levels: whole number, 1 to 8; default 1
            Grids that it runs on at most, each with cells twice as long as those of the next, up to `coarsest`: a tenth of the time passes on the finest, three hundredths on each between, and the rest on the coarsest. They hand ground, water and sediment down; three are some seven times as fast as one. The numbers of cells must divide, and none may be without data.
        coarsest: number, 0.001 to 100000 m; default 40.0
            Longest cells of these grids. On the coarsest it is decided where valleys lie: a landscape of any size that begins on the same one has the same valleys.
        steps: whole number, 0 to 100000000
            Number of steps, of the length that follows from the cells, in place of all that fill the time. Default: all.
        mean_over: whole number, 1 to 100000000 steps
            Steps at the end over which `flux_x` and `flux_y` are averaged. Default: a tenth of all.
        boundary: "closed" | "open"; default "open"
            What happens at the edge and at no-data cells.
        layer: layer name; default "height"
            Layer to erode.
        initial_water: layer name
            Layer with the depth of water that stands at the start. Default: none stands.
        region: layer name
            Layer that says where to simulate: cells where it is below 0.5 stand still, and nothing passes their edge. Default: everywhere.
        edits: script of edits
            Script of edits, in JSON lines (.jsonl) or TOML: strokes of a brush, and keys that change, between the steps on the finest grid. Its path starts at the folder of the recipe.
        """
    def stream_power(
        self,
        *,
        duration: float = 5000000.0,
        uplift: float = 0.5,
        uplift_map: str | None = None,
        erodibility: float = 5e-06,
        erodibility_map: str | None = None,
        materials: bool = False,
        area_exponent: float = 0.5,
        hillslope_area: float = 50000.0,
        slope_exponent: float = 1.0,
        deposition: float = 0.0,
        creep: float = 0.01,
        critical_slope_deg: float = 40.0,
        time_step: float | None = None,
        outlets: Literal["border", "sea", "north", "east", "south", "west"] = "border",
        lakes: Literal["kept", "filled"] = "filled",
        settling_length: float = 1000.0,
        irregularity: float = 0.7,
        levels: int = 1,
        coarsest: float = 100.0,
        settled: float | None = None,
        layer: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Lets ground rise and rivers cut it into ranges, over millions of years. Source: Braun and Willett 2013, doi 10.1016/j.geomorph.2012.10.008; Yuan et al. 2019, doi 10.1029/2018JF004867.

        Writes, by default: `height` (m), `erosion` (m), `deposition` (m), `lake_depth` (m).

        duration: number, 0 to 10000000000 a; default 5000000.0
            Years that pass.
        uplift: number, 0 to 100 mm/a; default 0.5
            How fast ground rises (U), but at the border.
        uplift_map: layer name
            Layer that multiplies the uplift: 0 where ground stays, below 0 where it sinks. Default: 1 everywhere.
        erodibility: number, 0 to 1000 m^(1-2m)/a; default 5e-6
            How fast rivers cut down where the upslope area is 1 m² and the slope 1 (K).
        erodibility_map: layer name
            Layer that multiplies the erodibility: 0.1 for hard, 10 for soft ground. Default: 1 everywhere.
        materials: true or false; default false
            Whether each material wears in its own way: `erodibility` is then that of the bedrock, and those of the others stand to it as theirs do, and slopes of each stand at its talus at most: hard beds as cliffs above soft ones. What rivers lay down counts as the last material.
        area_exponent: number, 0 to 2; default 0.5
            Exponent of the upslope area (m). Over that of the slope it is how much flatter rivers become downstream.
        hillslope_area: number, 0 to 1000000000 m²; default 50000.0
            Upslope area from which on there is a river. With less, slopes stand as steep as with so much, as those of mountains do (Stock and Dietrich 2003, doi 10.1029/2001WR001057), and what creeps stays on them; a river carries it off.
        slope_exponent: number, 0.1 to 5; default 1.0
            Exponent of the slope (n).
        deposition: number, 0 to 10; default 0.0
            Of what rivers carry, the share that they lay down (G): 0 for bare rock, 1 and more for rivers in their gravel.
        creep: number, 0 to 1000 m²/a; default 0.01
            Creep of soil (D), which rounds ridges.
        critical_slope_deg: number, 1 to 89 deg; default 40.0
            Steepest slope that stands, of whatever material; what is steeper slides down to it.
        time_step: number, 0.001 to 10000000000 a
            Years of one step of time. Default: a two-hundredth of the duration.
        outlets: "border" | "sea" | "north" | "east" | "south" | "west"; default "border"
            Where rivers leave the grid or the data: ground keeps its height there, and rises and wears at other borders as it does inside.
        lakes: "kept" | "filled"; default "filled"
            What becomes of lakes.
        settling_length: number, 0 to 1000000 m; default 1000.0
            Distance under water in which 63 % of what a river carries settles, in the sea and in lakes that are filled.
        irregularity: number, 0 to 1; default 0.7
            How far the points between which rivers run lie off the middles of their cells: 0 for a regular grid, whose eight directions show, up to 1 for all over the cell.
        levels: whole number, 1 to 8; default 1
            Grids that it runs on at most, each with cells twice as long as those of the next, up to `coarsest`: an eighth of the time passes on each but the coarsest, which has the rest. The numbers of cells must divide, and none may be without data.
        coarsest: number, 0.001 to 100000 m; default 100.0
            Longest cells of these grids. On the coarsest it is decided where rivers run: a landscape of any size that begins on the same one has the same rivers.
        settled: number, 0.001 to 100000 m
            Length of the cells on which the landscape takes its form, so that it is the same at every size: grids of such and of longer cells share the time as if there were no finer ones, and each finer one adds detail in a hundredth of the time. Default: the shares that `levels` names.
        layer: layer name; default "height"
            Layer to erode.
        """
    def coast(
        self,
        *,
        duration: float = 3000.0,
        wind_from_deg: float = 270.0,
        wind_spread_deg: float = 40.0,
        fetch: float = 20000.0,
        retreat: float = 0.1,
        high: float = 50.0,
        erodibility_map: str | None = None,
        cliff_deg: float = 55.0,
        platform_slope: float = 0.02,
        sand: float = 0.3,
        sheltered: float = 0.35,
        beach_slope: float = 0.03,
        beach_top: float = 2.0,
        widest_beach: float = 300.0,
        layer: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Lets waves cut cliffs where a coast lies open, and lay beaches where it is sheltered. Source: Sunamura 1992; Ashton and Murray 2006, doi 10.1029/2005JF000422; Trenhaile 2000, doi 10.1016/S0025-3227(00)00013-X.

        Writes, by default: `height` (m), `exposure`, `erosion` (m), `deposition` (m).

        duration: number, 0 to 10000000 a; default 3000.0
            Years for which waves work.
        wind_from_deg: number, -360 to 360 deg; default 270.0
            Direction from which wind and waves mostly come, clockwise from north; 270 is west.
        wind_spread_deg: number, 1 to 10000 deg; default 40.0
            How far the direction varies (standard deviation); 180 and more is from everywhere alike.
        fetch: number, 1 to 10000000 m; default 20000.0
            Way over water after which waves grow no more. Beyond the border lies open sea.
        retreat: number, 0 to 1000 m/a; default 0.1
            How fast a low coast of bedrock retreats that lies wholly open.
        high: number, 0.01 to 10000 m; default 50.0
            Height of a cliff that retreats half as fast.
        erodibility_map: layer name
            Layer that multiplies the retreat: 0.1 for hard, 10 for soft ground. Default: 1 everywhere.
        cliff_deg: number, 5 to 85 deg; default 55.0
            Steepest cliff that stands.
        platform_slope: number, 0.0001 to 1; default 0.02
            Fall of the platform that waves leave under the sea, rise over run.
        sand: number, 0 to 1; default 0.3
            Share of what waves cut that is sand and stays.
        sheltered: number, 0 to 1; default 0.35
            Exposure, from 0 to 1, below which sand stays.
        beach_slope: number, 0.001 to 1; default 0.03
            Fall of beaches, rise over run.
        beach_top: number, 0 to 100 m; default 2.0
            Height of the top of a beach above the sea.
        widest_beach: number, 0 to 1000000 m; default 300.0
            Widest beach, from the old coast out; sand beyond that is carried off.
        layer: layer name; default "height"
            Layer to erode.
        """
    def slippage(
        self,
        *,
        strength: float = 0.03,
        softening: bool = False,
        iterations: int = 100,
        layer: str = "height",
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Lets every material slide off slopes steeper than its talus. Source: Šťava et al. 2008, doi 10.2312/SCA/SCA08/201-210.

        Writes, by default: `height` (m).

        strength: number, 0 to 0.25; default 0.03
            Share of the excess that slides in an iteration. Times the number of materials at most 0.25.
        softening: true or false; default false
            Whether rough ground loses its hold and slides off gentler slopes too.
        iterations: whole number, 0 to 10000000; default 100
            Iterations to run.
        layer: layer name; default "height"
            Layer with the height of the ground.
        edits: script of edits
            Script of edits, in JSON lines (.jsonl) or TOML: strokes of a brush, and keys that change, between iterations. Its path starts at the folder of the recipe.
        """
    def dissolution(
        self,
        *,
        depth: float = 0.2,
        damping: float = 0.85,
        flow_rate: float = 0.0981,
        deposit: str | None = None,
        iterations: int = 100,
        water: str = "water",
        layer: str = "height",
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Softens ground under standing water to regolith, which creeps downhill. Source: Šťava et al. 2008, doi 10.2312/SCA/SCA08/201-210.

        Writes, by default: `height` (m), `regolith` (m).

        depth: number, 0 to 1000 m; default 0.2
            Depth to which standing water soaks the ground (`r_max`).
        damping: number, 0 to 1; default 0.85
            Share of the flow of the regolith that friction takes in an iteration.
        flow_rate: number, 0.0001 to 0.5; default 0.0981
            Pipe constant k of the regolith, which is no discharge: how fast differences in level turn into flow. Unstable above 0.5.
        deposit: layer name
            Material that settles. Default: the last of the landscape.
        iterations: whole number, 0 to 10000000; default 100
            Iterations to run.
        water: layer name; default "water"
            Layer with the depth of the water.
        layer: layer name; default "height"
            Layer with the height of the ground.
        edits: script of edits
            Script of edits, in JSON lines (.jsonl) or TOML: strokes of a brush, and keys that change, between iterations. Its path starts at the folder of the recipe.
        """
    def slope(
        self,
        *,
        of: str = "height",
        unit: Literal["degree", "tangent"] = "degree",
        scale: float = 0.0,
        into: str = "slope",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> Array:
        """How steep the ground is, as an angle or as a ratio. Source: Evans 1972, doi 10.4324/9780429273346-2; Wood 1996.

        Writes, by default: `slope` (deg).

        of: layer name; default "height"
            Layer of heights in metres.
        unit: "degree" | "tangent"; default "degree"
            Angle or ratio.
        scale: number, 0 to 1000000 m; default 0.0
            Metres from a cell to the edge of the window in which the surface is fitted: forms smaller than that do not count. The least is one cell.
        into: layer name; default "slope"
            Layer that is written.
        """
    def aspect(
        self,
        *,
        of: str = "height",
        scale: float = 0.0,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> dict[str, Array]:
        """Where the ground faces: as an angle, and as shares of north and east. Source: Evans 1972, doi 10.4324/9780429273346-2.

        Writes, by default: `aspect` (deg), `northness`, `eastness`.

        of: layer name; default "height"
            Layer of heights in metres.
        scale: number, 0 to 1000000 m; default 0.0
            Metres from a cell to the edge of the window in which the surface is fitted: forms smaller than that do not count. The least is one cell.
        """
    def curvature(
        self,
        *,
        of: str = "height",
        scale: float = 0.0,
        min_slope_deg: float = 0.01,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> dict[str, Array]:
        """How the ground bends along and across the slope, convex positive. Source: Evans 1972, doi 10.4324/9780429273346-2; Zevenbergen and Thorne 1987, doi 10.1002/esp.3290120107.

        Writes, by default: `curvature_profile` (1/m), `curvature_plan` (1/m), `curvature_tangential` (1/m), `curvature_mean` (1/m).

        of: layer name; default "height"
            Layer of heights in metres.
        scale: number, 0 to 1000000 m; default 0.0
            Metres from a cell to the edge of the window in which the surface is fitted: forms smaller than that do not count. The least is one cell.
        min_slope_deg: number, 0.000001 to 10 deg; default 0.01
            Ground that is gentler than this has no line of fall: profile, plan and tangential curvature are 0 there.
        """
    def sunlight(
        self,
        *,
        of: str = "height",
        day: int | None = None,
        latitude_deg: float | None = None,
        transmissivity: float = 0.7,
        albedo: float = 0.2,
        directions: int = 64,
        positions: int = 48,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> dict[str, Array]:
        """The light of a clear day on the ground, with the shadows of the land. Source: Dozier and Frew 1990, doi 10.1109/36.58986; Timonen and Westerholm 2010, doi 10.1111/j.1467-8659.2009.01642.x; Spencer 1971; Kasten and Young 1989, doi 10.1364/AO.28.004735; Liu and Jordan 1960, doi 10.1016/0038-092X(60)90062-1.

        Writes, by default: `sunlight` (kWh/m²), `light`.

        of: layer name; default "height"
            Layer of heights in metres.
        day: whole number, 1 to 365
            Day of the year, 172 being midsummer in the north. Without it, the mean day of the whole year.
        latitude_deg: number, -90 to 90 deg
            Latitude, south negative. Without it, that of the middle of the ground where its coordinate reference system is known, else 45.
        transmissivity: number, 0.1 to 1; default 0.7
            Share of sunlight from the zenith that comes through the air: 0.7 on a clear day; 1 is no air.
        albedo: number, 0 to 1; default 0.2
            Share of the light that ground reflects: 0.2 for grass and rock, 0.8 for snow.
        directions: whole number, 4 to 720; default 64
            Directions in which the horizon is looked for.
        positions: whole number, 4 to 1000; default 48
            Places of the sun between its rise and its setting.
        """
    def occlusion(
        self,
        *,
        of: str = "height",
        directions: int = 32,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> dict[str, Array]:
        """How open the ground is to light from all around, and how much sky it sees. Source: Dozier and Frew 1990, doi 10.1109/36.58986; Timonen and Westerholm 2010, doi 10.1111/j.1467-8659.2009.01642.x.

        Writes, by default: `occlusion`, `sky_view`.

        of: layer name; default "height"
            Layer of heights in metres.
        directions: whole number, 4 to 720; default 32
            Directions in which the horizon is looked for.
        """
    def soil(
        self,
        *,
        of: str = "height",
        erosion: str | None = None,
        recent_erosion: float = 0.01,
        deposition: str | None = None,
        moisture: str | None = None,
        loose: str | None = None,
        age: float = 10000.0,
        weathering: float = 7.7e-05,
        weathering_depth: float = 0.42,
        creep: float = 0.003,
        critical_slope_deg: float = 50.0,
        scale: float = 0.0,
        deepest: float = 20.0,
        rooting: float = 0.4,
        best_moisture: float = 0.6,
        dry: float = 0.2,
        wet: float = 0.5,
        old: float = 0.6,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> dict[str, Array]:
        """How deep the soil is by weathering, creep, erosion and deposits, and how fertile. Source: Heimsath et al. 1997, doi 10.1038/41056; Roering, Kirchner and Dietrich 1999, doi 10.1029/1998WR900090.

        Writes, by default: `soil_depth` (m), `fertility`.

        of: layer name; default "height"
            Layer of heights in metres.
        erosion: layer name
            Layer of what water took away, in metres, such as `erosion`. Without it, nothing.
        recent_erosion: number, 0 to 1; default 0.01
            Share of it that fell in the time in which the soil formed: a simulation soon wears what takes land a hundred times as long.
        deposition: layer name
            Layer of what water laid down and left, in metres, such as `deposition`. Without it, nothing.
        moisture: layer name
            Layer of moisture from 0 to 1. Without it, moisture limits nothing.
        loose: layer name
            Layer of loose ground that lay there before, in metres, such as `regolith` or a material. Without it, the soil begins on bare rock.
        age: number, 1 to 10000000 yr; default 10000.0
            Time for which the soil has formed. The default is that since the last ice age.
        weathering: number, 0 to 0.1 m/yr; default 7.7e-5
            Soil production rate on bare rock (P). The default is that of Heimsath et al.
        weathering_depth: number, 0.01 to 10 m; default 0.42
            e-folding depth of soil production: under that depth of soil it is 1/e, or 37 %, of that on bare rock (h₀). The default is that of Heimsath et al.
        creep: number, 0 to 10 m²/yr; default 0.003
            Soil transport coefficient of creep downhill (K). The default is that of Roering et al.
        critical_slope_deg: number, 5 to 85 deg; default 50.0
            Slope at which all soil slides off (S).
        scale: number, 0 to 1000000 m; default 0.0
            Metres from a cell to the edge of the window in which slope and curvature are measured: soil does not follow forms smaller than that. The least is one cell.
        deepest: number, 0.1 to 1000 m; default 20.0
            Greatest depth that is reported; more than roots reach makes no difference.
        rooting: number, 0.01 to 10 m; default 0.4
            Depth that holds about two thirds of the roots.
        best_moisture: number, 0.05 to 0.95; default 0.6
            Moisture at which plants grow best.
        dry: number, 0 to 1; default 0.2
            Factor of fertility where moisture is 0.
        wet: number, 0 to 1; default 0.5
            Factor of fertility where moisture is 1, and roots lack air.
        old: number, 0 to 1; default 0.6
            Factor of fertility where there are no fresh deposits; with half a metre of them it is most of the way to 1.
        """
    def select(
        self,
        *,
        where: Sequence[Mapping[str, Any]] = [],
        combine: Literal["all", "any"] = "all",
        not_: bool = False,
        into: str = "mask",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> Array:
        """A mask from ranges of any layers, with soft edges. Source: Zadeh 1965, doi 10.1016/S0019-9958(65)90241-X.

        Writes, by default: `mask`.

        where: list of tables; default []
            Conditions, each a layer and a range: `[{ layer = "slope", above = 20, below = 45, soft = 5 }, …]`. A mask is a layer too, so that a selection can go into another one.
        combine: "all" | "any"; default "all"
            Whether all conditions must be fulfilled or any of them.
        not_: true or false; default false
            Whether the mask is turned over.
        into: layer name; default "mask"
            Layer that is written.
        """
    def network(
        self,
        *,
        of: str = "height",
        water: str = "water",
        flux_x: str = "flux_x",
        flux_y: str = "flux_y",
        erosion: str = "erosion",
        deposition: str = "deposition",
        rain: float | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Measures the network of rivers that a simulation formed, for the report. Source: Weald, after the claims of Han 2015, doi 10.7583/JKGS.2015.15.6.171.

        of: layer name; default "height"
            Layer of heights in metres.
        water: layer name; default "water"
            Layer of the depth of water in metres.
        flux_x: layer name; default "flux_x"
            Layer of the mean flow of water to the east, in m³ per iteration.
        flux_y: layer name; default "flux_y"
            The same to the south.
        erosion: layer name; default "erosion"
            Layer of what the ground lost on balance, in metres.
        deposition: layer name; default "deposition"
            Layer of what the ground gained on balance, in metres.
        rain: number, 0.000000001 to 100 m/iteration
            Mean rain per iteration over a whole cycle: `rain` of `hydraulic` times the share of the iterations with rain. Without it 0.005 × cell size, the mean of model = "han" with its defaults; give it for every other model. With fluxes in m³/s it is metres per second, 40 mm/h without it.
        """
    def flow(
        self,
        *,
        of: str = "height",
        directions: Literal["d8", "d8-ltd"] = "d8-ltd",
        method: Literal["d8", "mfd"] = "d8",
        exponent: float = 1.1,
        depressions: Literal["fill", "breach"] = "fill",
        deepest_breach: float | None = None,
        sea_level: float | None = None,
        weight: str | None = None,
        filled: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> dict[str, Array]:
        """Leads water over the ground: directions of flow and upslope (drainage) areas. Source: O'Callaghan and Mark 1984; Orlandini et al. 2003; Freeman 1991; Barnes et al. 2014; Lindsay 2016.

        Writes, by default: `flow_direction`, `accumulation` (m²).

        of: layer name; default "height"
            Layer of heights.
        directions: "d8" | "d8-ltd"; default "d8-ltd"
            Which neighbour a cell drains to: the steepest, by which paths favour multiples of 45°, or the one that keeps the whole path nearest to the fall line.
        method: "d8" | "mfd"; default "d8"
            How upslope areas add up: along the directions, or shared among all lower neighbours.
        exponent: number, 0 to 20; default 1.1
            Shares are in proportion to slope to this power. 1.1 spreads water over a cone evenly, 4 and more come near `d8`.
        depressions: "fill" | "breach"; default "fill"
            What becomes of depressions: they fill to their lowest rims, or a channel drains them.
        deepest_breach: number, 0 to 1000000 m
            Deepest cut of a breach; depressions that need a deeper one are filled. Without it, all are breached.
        sea_level: number, -1000000 to 1000000 m
            Height of the sea. Ground no higher that is connected to the border by such ground is sea, in which flow ends. Default: that of the landscape.
        weight: layer name
            Layer of the runoff of each cell in mm/year, whatever unit it says. With it, the layer `discharge` is written.
        filled: layer name
            Layer for the heights of the ground after filling or breaching. Without it they are not kept.
        """
    def rivers(
        self,
        *,
        of: str = "height",
        area: float | None = None,
        runoff: float = 500.0,
        discharge: str | None = None,
        lakes: str | None = None,
        width: float = 7.2,
        width_exponent: float = 0.5,
        depth: float = 0.27,
        depth_exponent: float = 0.4,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> dict[str, Array]:
        """Finds rivers by their upslope area, with discharge, width, depth and order. Source: Leopold and Maddock 1953; Moody and Troutman 2002; Strahler 1957.

        Writes, by default: `river`, `river_width` (m), `river_depth` (m), `river_level` (m), `discharge` (m³/s), `strahler`.

        of: layer name; default "height"
            Heights from which the level of the water is taken: `height`, or the layer that `flow` writes with `filled`.
        area: number, 0 to 1000000000000000 m²
            Least upslope area of a river. Without it, a five-hundredth of the land.
        runoff: number, 0 to 100000 mm/year; default 500.0
            Runoff of the land: mean annual discharge = upslope area × runoff. Water of a simulation does not enter it.
        discharge: layer name
            Layer of mean annual discharge in m³/s, such as `flow` writes with `weight`, which is taken instead of `runoff`.
        lakes: layer name
            Layer of lakes, such as `lakes` writes. Rivers end at their shores and begin at their outlets.
        width: number, 0 to 10000 m; default 7.2
            Width of a river of 1 m³/s, by its mean annual discharge.
        width_exponent: number, 0 to 2; default 0.5
            Width grows with discharge to this power.
        depth: number, 0 to 10000 m; default 0.27
            Depth of a river of 1 m³/s, by its mean annual discharge.
        depth_exponent: number, 0 to 2; default 0.4
            Depth grows with discharge to this power.
        """
    def lakes(
        self,
        *,
        of: str = "height",
        from_: Literal["depressions", "water"] = "depressions",
        water: str = "water",
        shallowest: float = 0.1,
        depth: float = 1.0,
        area: float | None = None,
        sea_level: float | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> dict[str, Array]:
        """Finds lakes, their levels and depths. Source: Barnes, Lehman and Mulla 2014.

        Writes, by default: `lake`, `lake_level` (m), `lake_depth` (m).

        of: layer name; default "height"
            Layer of the height of the ground.
        from_: "depressions" | "water"; default "depressions"
            Whether depressions are full to their rims, or hold the water that a simulation left.
        water: layer name; default "water"
            Layer of the depth of water.
        shallowest: number, 0 to 1000 m; default 0.1
            Shallower water counts as overland flow, not as a lake.
        depth: number, 0 to 1000000 m; default 1.0
            Least greatest depth: shallower lakes are left out.
        area: number, 0 to 1000000000000000 m²
            Least area: smaller lakes are left out. Without it, those of fewer than 12 cells.
        sea_level: number, -1000000 to 1000000 m
            Height of the sea, which is no lake. Default: that of the landscape.
        """
    def watersheds(
        self,
        *,
        area: float | None = None,
        small: Literal["merge", "drop"] = "merge",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> Array:
        """Labels watersheds: the cells that drain to the same outlet. Source: common practice.

        Writes, by default: `watershed`.

        area: number, 0 to 1000000000000000 m²
            Least area of a watershed. Without it, a hundredth of the land.
        small: "merge" | "drop"; default "merge"
            What becomes of smaller ones: they merge with a neighbour, or have no number, so that the watersheds of the main rivers are left.
        """
    def wetness(
        self,
        *,
        of: str = "height",
        exponent: float = 1.1,
        min_slope: float = 0.001,
        sea_level: float | None = None,
        into: str = "wetness",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> Array:
        """The topographic wetness index ln(a / tan β). Source: Beven and Kirkby 1979; Quinn et al. 1991.

        Writes, by default: `wetness`.

        of: layer name; default "height"
            Layer of heights.
        exponent: number, 0 to 20; default 1.1
            Shares of lower neighbours are in proportion to slope to this power.
        min_slope: number, 0.000001 to 1; default 0.001
            Gentler slopes count as this one, so that flat ground has an index: a metre in a kilometre.
        sea_level: number, -1000000 to 1000000 m
            Height of the sea, in which flow ends. Default: that of the landscape.
        into: layer name; default "wetness"
            Layer that is written.
        """
    def moisture(
        self,
        *,
        of: str = "height",
        wetness: str = "wetness",
        water: str | None = None,
        shallowest: float = 0.05,
        rivers: str | None = None,
        lakes: str | None = None,
        half_height: float = 5.0,
        dry: float = 6.0,
        wet: float = 14.0,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> dict[str, Array]:
        """Moisture of the soil from nearby water and gathered flow. Source: Rennó et al. 2008; Beven and Kirkby 1979.

        Writes, by default: `moisture`, `height_above_water` (m).

        of: layer name; default "height"
            Layer of the height of the ground.
        wetness: layer name; default "wetness"
            Layer of the topographic wetness index.
        water: layer name
            Layer of the depth of water that a simulation left.
        shallowest: number, 0 to 1000 m; default 0.05
            Shallower water of a simulation counts as overland flow and wets nothing.
        rivers: layer name
            Layer of rivers.
        lakes: layer name
            Layer of lakes.
        half_height: number, 0.001 to 100000 m; default 5.0
            Height above water at which nearness has fallen to a half.
        dry: number, -50 to 50; default 6.0
            Wetness index of ground that gathers nothing.
        wet: number, -50 to 50; default 14.0
            Wetness index of ground that is soaked by what gathers.
        """
    def scatter(
        self,
        *,
        into: str = "plants",
        plant: str = "fern",
        of: str = "height",
        spacing: float = 5.0,
        count: int | None = None,
        where: Sequence[Mapping[str, Any]] = [],
        water: float = 0.1,
        size: Sequence[float] = [0.6, 1.2],
        vigour: float = 0.0,
        upright: float = 0.8,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Sets plants where the ground suits them, at a distance from each other. Source: Wei 2008, doi 10.1145/1360612.1360619; Ebeida et al. 2012, doi 10.1111/j.1467-8659.2012.03059.x; Luby 1986, doi 10.1137/0215074.

        Writes, by default: `plants` (1/m²).

        into: layer name; default "plants"
            Name of the plants, and of the layer that counts them.
        plant: text; default "fern"
            What is planted: a fractal, of the recipe or built in.
        of: layer name; default "height"
            Layer of heights in metres.
        spacing: number, 0.01 to 100000 m; default 5.0
            Least distance between two plants. On ground of suitability s they stand 1/√s times as far apart, so that s is the density beside the densest; below 1/64 some are left out at random instead.
        count: whole number, 1 to 10000000
            So many plants, as far apart as that lets them be but no closer than `spacing`. Without it, as many as find room.
        where: list of tables; default []
            Conditions of the ground, as those of `select`: `[{ layer = "slope", below = 30, soft = 10 }, …]`. Their product is the suitability. Layers are taken between the centres of cells.
        water: number, 0 to 10000 m; default 0.1
            Depth of the layer `water`, where there is one, up to which plants stand in it.
        size: list of numbers, 0.001 to 1000 m; default [0.6, 1.2]
            Least and greatest height of a plant, in metres.
        vigour: number, 0 to 1; default 0.0
            Share by which suitability, and not chance, sets the size.
        upright: number, 0 to 1; default 0.8
            1 where stems stand upright on any slope, 0 where they stand at right angles to the ground.
        """
    def grass(
        self,
        *,
        into: str = "grass",
        soil: str = "fertility",
        light: str = "light",
        density: str = "moisture",
        sets: float = 40.0,
        species: Sequence[Mapping[str, Any]] = [],
        tussocks: float = 0.6,
        water: float = 0.05,
        age: float = 1.0,
        mown: str | None = None,
        mown_height: float = 0.05,
        trodden: str | None = None,
        bend: Literal["total", "printed"] = "total",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> StepReport:
        """Grows grass by the soil and the light of the ground, in tufts of six blades. Source: Kim and Cho 2009, Modeling and rendering of growing grass.

        Writes, by default: `grass` (1/m²), `grass_ryegrass` (1/m²).

        into: layer name; default "grass"
            Name of the grass, and of the layer that counts its sets; those of the species begin with it.
        soil: layer name; default "fertility"
            Layer of how good the soil is, 0 to 1: of `soil`, or of an image by `load`.
        light: layer name; default "light"
            Layer of how much light there is, 0 to 1: of `sunlight`, or of an image.
        density: layer name; default "moisture"
            Layer of how densely grass stands, 0 to 1: the wetness of `moisture`, or an image.
        sets: number, 0.000001 to 10000 1/m²; default 40.0
            Sets (tufts of six blades) per square metre where the density is 1: 40 are 240 blades.
        species: list of tables; default []
            What grows: `[{ name = "reed", share = 2, where = [{ layer = "moisture", above = 0.9 }] }, …]`. Without any, ryegrass.
        tussocks: number, 0 to 1; default 0.6
            How alike the sets of a tussock, 0.7 m wide, are: this share of them is of one species, and the soil of tussocks is up to half of it better or worse than the layer's. 0, as in the publication: each set stands alone.
        water: number, 0 to 10000 m; default 0.05
            Depth of the layer `water`, where there is one, up to which grass stands in it.
        age: number, 0 to 1; default 1.0
            How far it has grown: 0 is bare ground, 1 full-grown; a blade has four segments, one for each quarter.
        mown: layer name
            Layer of where it is mown, 0 to 1.
        mown_height: number, 0.001 to 10 m; default 0.05
            Height of what is mown.
        trodden: layer name
            Layer of where it is trodden down, 0 to 1.
        bend: "total" | "printed"; default "total"
            How far a blade bends. `total`: the bend is that of the whole blade. `printed`: it is that of each of its segments, as in the publication, so that tall blades dip into the ground.
        """

class AccessorSteps:
    """The same of an array of xarray."""

    def _run_step(self, name: str, keys: dict[str, Any], call: dict[str, Any]) -> Any: ...
    def fault(
        self,
        *,
        iterations: int = 200,
        scale: float = 10.0,
        relief: float | None = None,
        seed: int | None = None,
        into: str = "height",
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def diamond_square(
        self,
        *,
        relief: float = 1000.0,
        roughness: float = 0.9,
        seed: int | None = None,
        into: str = "height",
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def fbm(
        self,
        *,
        relief: float = 1000.0,
        wavelength: float = 5000.0,
        octaves: int = 8,
        gain: float = 0.5,
        lacunarity: float = 2.0,
        seed: int | None = None,
        into: str = "height",
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def ridged(
        self,
        *,
        relief: float = 1000.0,
        wavelength: float = 8000.0,
        octaves: int = 8,
        gain: float = 0.5,
        lacunarity: float = 2.0,
        sharpness: float = 2.0,
        seed: int | None = None,
        into: str = "height",
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def warp(
        self,
        *,
        relief: float = 1000.0,
        wavelength: float = 5000.0,
        octaves: int = 8,
        gain: float = 0.5,
        lacunarity: float = 2.0,
        strength: float = 0.1,
        seed: int | None = None,
        into: str = "height",
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def plane(
        self,
        *,
        slope: float = 0.1,
        azimuth_deg: float = 180.0,
        height: float = 0.0,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def cone(
        self,
        *,
        peak: float = 100.0,
        base: float = 0.0,
        slope: float = 1.0,
        center_x: float | None = None,
        center_y: float | None = None,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def dome(
        self,
        *,
        rise: float = 1.0,
        base: float = 0.0,
        radius: float = 5000.0,
        radius_across: float | None = None,
        azimuth_deg: float = 90.0,
        center_x: float | None = None,
        center_y: float | None = None,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def volcano(
        self,
        *,
        rise: float = 1500.0,
        base: float = 0.0,
        radius: float = 8000.0,
        concavity: float = 3.0,
        crater_radius: float = 300.0,
        crater_depth: float = 150.0,
        center_x: float | None = None,
        center_y: float | None = None,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def basin(
        self,
        *,
        depth: float = 50.0,
        rim: float = 100.0,
        radius: float | None = None,
        center_x: float | None = None,
        center_y: float | None = None,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def constant(
        self,
        *,
        height: float = 0.0,
        into: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def load(
        self,
        *,
        file: str | PathLike[str],
        into: str,
        scale: float = 1.0,
        offset: float = 0.0,
        resample: bool = False,
        no_data: float | None = None,
        unit: Literal["m", "ft", "us-ft", "km", "dm", "cm", "mm", "1"] | None = None,
        crs: str | None = None,
        nodata: float | None = None,
        elsewhere: bool = False,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def add(
        self,
        *,
        layer: str = "height",
        with_: str,
        factor: float = 1.0,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def max(
        self,
        *,
        layer: str = "height",
        with_: str,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def min(
        self,
        *,
        layer: str = "height",
        with_: str,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def blend(
        self,
        *,
        layer: str = "height",
        with_: str,
        mask: str,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def remap(
        self,
        *,
        layer: str = "height",
        from_: Sequence[float] = [],
        to: Sequence[float] = [0.0, 1.0],
        clamp: bool = True,
        gamma: float = 1.0,
        curve: Sequence[float] = [],
        unit: str | None = None,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def terrace(
        self,
        *,
        layer: str = "height",
        spacing: float = 50.0,
        softness: float = 0.3,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def smooth(
        self,
        *,
        layer: str = "height",
        radius: float = 50.0,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def displace(
        self,
        *,
        layer: str = "height",
        east: str | None = None,
        south: str | None = None,
        factor: float = 1.0,
        into: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def resample(
        self,
        *,
        size: int | Sequence[int],
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def layers(
        self,
        *,
        of: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def top_material(
        self,
        *,
        of: str = "height",
        thinnest: float = 0.01,
        into: str = "material",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def paint_layer(
        self,
        *,
        into: str,
        of: str | None = None,
        value: float = 1.0,
        strokes: Sequence[Mapping[str, Any]] = [],
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def hydraulic(
        self,
        *,
        model: Literal["han", "mei", "stava"] = "han",
        flow_rate: float | None = None,
        rain: float | None = None,
        evaporation: float | None = None,
        dry_period: int | None = None,
        law: Literal["velocity", "dissolution"] = "velocity",
        capacity: float | None = None,
        erosion: float | None = None,
        deposit_ratio: float = 1.0,
        limiter: bool = True,
        transport: Literal["upwind", "semi-lagrangian", "maccormack"] | None = None,
        conserve: bool = True,
        velocity_epsilon: float | None = None,
        thermal: Mapping[str, Any] | None = None,
        deposition: float = 0.1,
        slope: Literal["mean-sine", "central"] = "mean-sine",
        rain_layer: str | None = None,
        evaporation_layer: str | None = None,
        source_layer: str | None = None,
        sources: Sequence[Mapping[str, Any]] = [],
        drains: Sequence[Mapping[str, Any]] = [],
        viscosity: float = 0.0,
        deposit: str | None = None,
        dissolution: Mapping[str, Any] | None = None,
        slippage: Mapping[str, Any] | None = None,
        iterations: int = 1000,
        rain_period: int = 60,
        epsilon: float | None = None,
        boundary: Literal["closed", "open"] = "closed",
        layer: str = "height",
        initial_water: str | None = None,
        region: str | None = None,
        mean_over: int | None = None,
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def thermal(
        self,
        *,
        scheme: Literal["axis", "isotropic", "isotropic-symmetric"] = "isotropic",
        talus: float = 0.8,
        strength: float = 0.05,
        iterations: int = 100,
        layer: str = "height",
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def transport(
        self,
        *,
        layer: str,
        iterations: int = 100,
        scheme: Literal["semi-lagrangian", "maccormack"] = "maccormack",
        conserve: bool = True,
        water: str = "water",
        flux_x: str = "flux_x",
        flux_y: str = "flux_y",
        epsilon: float | None = None,
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def fluvial(
        self,
        *,
        duration: float = 10000.0,
        flow_time: float = 3.0,
        rain: float = 40.0,
        rain_map: str | None = None,
        evaporation: float = 0.0,
        sources: Sequence[Mapping[str, Any]] = [],
        erodibility: float = 3.0,
        erodibility_map: str | None = None,
        materials: bool = False,
        cover: float = 0.5,
        threshold: float = 0.002,
        settling: float = 0.0005,
        channel_width: float = 4.0,
        lateral_wear: float = 0.05,
        gathering: float = 40.0,
        friction: float = 0.01,
        deepest: float = 2.0,
        creep: float = 0.01,
        talus: float = 0.7,
        slide: float = 1.0,
        levels: int = 1,
        coarsest: float = 40.0,
        steps: int | None = None,
        mean_over: int | None = None,
        boundary: Literal["closed", "open"] = "open",
        layer: str = "height",
        initial_water: str | None = None,
        region: str | None = None,
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def stream_power(
        self,
        *,
        duration: float = 5000000.0,
        uplift: float = 0.5,
        uplift_map: str | None = None,
        erodibility: float = 5e-06,
        erodibility_map: str | None = None,
        materials: bool = False,
        area_exponent: float = 0.5,
        hillslope_area: float = 50000.0,
        slope_exponent: float = 1.0,
        deposition: float = 0.0,
        creep: float = 0.01,
        critical_slope_deg: float = 40.0,
        time_step: float | None = None,
        outlets: Literal["border", "sea", "north", "east", "south", "west"] = "border",
        lakes: Literal["kept", "filled"] = "filled",
        settling_length: float = 1000.0,
        irregularity: float = 0.7,
        levels: int = 1,
        coarsest: float = 100.0,
        settled: float | None = None,
        layer: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def coast(
        self,
        *,
        duration: float = 3000.0,
        wind_from_deg: float = 270.0,
        wind_spread_deg: float = 40.0,
        fetch: float = 20000.0,
        retreat: float = 0.1,
        high: float = 50.0,
        erodibility_map: str | None = None,
        cliff_deg: float = 55.0,
        platform_slope: float = 0.02,
        sand: float = 0.3,
        sheltered: float = 0.35,
        beach_slope: float = 0.03,
        beach_top: float = 2.0,
        widest_beach: float = 300.0,
        layer: str = "height",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def slippage(
        self,
        *,
        strength: float = 0.03,
        softening: bool = False,
        iterations: int = 100,
        layer: str = "height",
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def dissolution(
        self,
        *,
        depth: float = 0.2,
        damping: float = 0.85,
        flow_rate: float = 0.0981,
        deposit: str | None = None,
        iterations: int = 100,
        water: str = "water",
        layer: str = "height",
        edits: str | PathLike[str] | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def slope(
        self,
        *,
        of: str = "height",
        unit: Literal["degree", "tangent"] = "degree",
        scale: float = 0.0,
        into: str = "slope",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def aspect(
        self,
        *,
        of: str = "height",
        scale: float = 0.0,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.Dataset: ...
    def curvature(
        self,
        *,
        of: str = "height",
        scale: float = 0.0,
        min_slope_deg: float = 0.01,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.Dataset: ...
    def sunlight(
        self,
        *,
        of: str = "height",
        day: int | None = None,
        latitude_deg: float | None = None,
        transmissivity: float = 0.7,
        albedo: float = 0.2,
        directions: int = 64,
        positions: int = 48,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.Dataset: ...
    def occlusion(
        self,
        *,
        of: str = "height",
        directions: int = 32,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.Dataset: ...
    def soil(
        self,
        *,
        of: str = "height",
        erosion: str | None = None,
        recent_erosion: float = 0.01,
        deposition: str | None = None,
        moisture: str | None = None,
        loose: str | None = None,
        age: float = 10000.0,
        weathering: float = 7.7e-05,
        weathering_depth: float = 0.42,
        creep: float = 0.003,
        critical_slope_deg: float = 50.0,
        scale: float = 0.0,
        deepest: float = 20.0,
        rooting: float = 0.4,
        best_moisture: float = 0.6,
        dry: float = 0.2,
        wet: float = 0.5,
        old: float = 0.6,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.Dataset: ...
    def select(
        self,
        *,
        where: Sequence[Mapping[str, Any]] = [],
        combine: Literal["all", "any"] = "all",
        not_: bool = False,
        into: str = "mask",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def network(
        self,
        *,
        of: str = "height",
        water: str = "water",
        flux_x: str = "flux_x",
        flux_y: str = "flux_y",
        erosion: str = "erosion",
        deposition: str = "deposition",
        rain: float | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def flow(
        self,
        *,
        of: str = "height",
        directions: Literal["d8", "d8-ltd"] = "d8-ltd",
        method: Literal["d8", "mfd"] = "d8",
        exponent: float = 1.1,
        depressions: Literal["fill", "breach"] = "fill",
        deepest_breach: float | None = None,
        sea_level: float | None = None,
        weight: str | None = None,
        filled: str | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.Dataset: ...
    def rivers(
        self,
        *,
        of: str = "height",
        area: float | None = None,
        runoff: float = 500.0,
        discharge: str | None = None,
        lakes: str | None = None,
        width: float = 7.2,
        width_exponent: float = 0.5,
        depth: float = 0.27,
        depth_exponent: float = 0.4,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.Dataset: ...
    def lakes(
        self,
        *,
        of: str = "height",
        from_: Literal["depressions", "water"] = "depressions",
        water: str = "water",
        shallowest: float = 0.1,
        depth: float = 1.0,
        area: float | None = None,
        sea_level: float | None = None,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.Dataset: ...
    def watersheds(
        self,
        *,
        area: float | None = None,
        small: Literal["merge", "drop"] = "merge",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def wetness(
        self,
        *,
        of: str = "height",
        exponent: float = 1.1,
        min_slope: float = 0.001,
        sea_level: float | None = None,
        into: str = "wetness",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def moisture(
        self,
        *,
        of: str = "height",
        wetness: str = "wetness",
        water: str | None = None,
        shallowest: float = 0.05,
        rivers: str | None = None,
        lakes: str | None = None,
        half_height: float = 5.0,
        dry: float = 6.0,
        wet: float = 14.0,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.Dataset: ...
    def scatter(
        self,
        *,
        into: str = "plants",
        plant: str = "fern",
        of: str = "height",
        spacing: float = 5.0,
        count: int | None = None,
        where: Sequence[Mapping[str, Any]] = [],
        water: float = 0.1,
        size: Sequence[float] = [0.6, 1.2],
        vigour: float = 0.0,
        upright: float = 0.8,
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...
    def grass(
        self,
        *,
        into: str = "grass",
        soil: str = "fertility",
        light: str = "light",
        density: str = "moisture",
        sets: float = 40.0,
        species: Sequence[Mapping[str, Any]] = [],
        tussocks: float = 0.6,
        water: float = 0.05,
        age: float = 1.0,
        mown: str | None = None,
        mown_height: float = 0.05,
        trodden: str | None = None,
        bend: Literal["total", "printed"] = "total",
        seed: int = 0,
        engine: str = "auto",
        threads: int | None = None,
        callback: Callback | None = None,
        progress: bool | None = None,
    ) -> xarray.DataArray: ...

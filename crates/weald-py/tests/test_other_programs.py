"""xarray, rasterio, rioxarray, geopandas, pandas: in and out with their places."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import weald

xarray = pytest.importorskip("xarray")


def test_a_dataset_has_coordinates_crs_units_and_nan(holed: weald.Landscape) -> None:
    holed.slope()
    made = holed.to_xarray()
    assert set(made.data_vars) == {"height", "slope"} and made.height.attrs["units"] == "m"
    assert np.isnan(made.height.values[3, 7]) and int(np.isnan(made.slope).sum()) == 6
    assert float(made.x[0]) == 500_005.0 and float(made.y[0]) == 4_599_995.0
    again = weald.Landscape.from_xarray(made.height)
    del holed["slope"]
    assert again == holed


def test_without_holes_a_dataset_shares_the_memory(hills: weald.Landscape) -> None:
    assert np.shares_memory(hills.to_xarray().height.values, hills["height"])


def test_the_accessor_gives_new_arrays_and_leaves_the_old(holed: weald.Landscape) -> None:
    heights = holed.to_xarray()["height"].rename("dem")
    before = heights.copy(deep=True)
    slope = heights.weald.slope()
    assert slope.name == "slope" and slope.dims == heights.dims and np.array_equal(slope.x, heights.x)
    holed.slope()
    assert np.array_equal(slope.values, holed.array("slope", np.nan), equal_nan=True)
    flow = heights.weald.flow()
    assert set(flow.data_vars) == set(holed.flow())
    carved = heights.weald.hydraulic(iterations=20)
    assert carved.name == "dem" and carved.attrs["iterations"] == 20 and not carved.equals(heights)
    assert heights.identical(before)
    with pytest.raises(weald.RecipeError):
        heights.weald.hydraulic(iteratons=20)


def test_rows_from_the_south_are_turned_and_turned_back(holed: weald.Landscape) -> None:
    north = holed.to_xarray()["height"]
    south = north.isel(y=slice(None, None, -1)).rename(y="lat", x="lon")
    assert np.array_equal(south.weald.slope().values, north.weald.slope().values[::-1], equal_nan=True)
    assert south.weald.slope().dims == ("lat", "lon")


def test_arrays_without_an_even_grid_are_refused(holed: weald.Landscape) -> None:
    heights = holed.to_xarray()["height"]
    uneven = heights.isel(x=[0, 1, 2, 4, 5])
    with pytest.raises(weald.UsageError, match="not evenly spaced"):
        uneven.weald.slope()
    with pytest.raises(weald.UsageError, match="rows and columns"):
        heights.expand_dims(time=2).weald.slope()
    bare = xarray.DataArray(np.ones((3, 3)))
    with pytest.raises(weald.RunError, match="give `cell`"):
        bare.weald.slope()
    assert bare.weald.landscape(cell=2.0).cell == 2.0


def test_rasterio_reads_and_writes_with_crs(holed: weald.Landscape, tmp_path: Path) -> None:
    rasterio = pytest.importorskip("rasterio")
    with rasterio.open(tmp_path / "a.tif", "w", **holed.profile()) as file:
        file.write(holed.array("height", np.nan), 1)
    with rasterio.open(tmp_path / "a.tif") as file:
        again = weald.Landscape.from_rasterio(file)
        assert file.crs.to_epsg() == 32633
    assert again == holed
    opened = weald.Landscape.open(tmp_path / "a.tif")
    assert np.array_equal(opened.array("height", np.nan), holed.array("height", np.nan), equal_nan=True)
    assert opened.crs == holed.crs and tuple(opened.transform) == tuple(holed.transform)


def test_a_crs_without_a_code_is_kept_in_files_and_told_where_it_is_lost(tmp_path: Path) -> None:
    rasterio = pytest.importorskip("rasterio")
    albers = "+proj=aea +lat_1=29.5 +lat_2=45.5 +lat_0=23 +lon_0=-90 +datum=WGS84 +units=m"
    profile = dict(driver="GTiff", dtype="float32", count=1, width=5, height=4, crs=albers)
    transform = rasterio.Affine(30.0, 0.0, 1000.0, 0.0, -30.0, 2000.0)
    with rasterio.open(tmp_path / "albers.tif", "w", transform=transform, **profile) as file:
        file.write(np.arange(20, dtype=np.float32).reshape(4, 5), 1)
        with pytest.raises(weald.UsageError, match="no EPSG code"):
            weald.Landscape(np.ones((4, 5)), crs=file.crs, transform=transform)
    land = weald.Landscape.open(tmp_path / "albers.tif")
    assert land.crs is None
    with pytest.warns(weald.Note, match="no EPSG code"):
        land.to_xarray()
    land.save(tmp_path / "again.tif")
    with rasterio.open(tmp_path / "again.tif") as again, rasterio.open(tmp_path / "albers.tif") as first:
        assert again.crs == first.crs


def test_rioxarray_knows_where_it_lies(holed: weald.Landscape, tmp_path: Path) -> None:
    rioxarray = pytest.importorskip("rioxarray")
    made = holed.to_xarray()
    assert made.rio.crs.to_epsg() == 32633
    assert tuple(made.rio.transform())[:6] == tuple(holed.transform)[:6]
    made["height"].rio.to_raster(tmp_path / "b.tif")
    assert weald.Landscape.from_xarray(rioxarray.open_rasterio(tmp_path / "b.tif", masked=True)) == holed
    degrees = made["height"].rio.reproject("EPSG:4326")
    with pytest.raises(weald.RunError, match="rio.reproject"):
        weald.Landscape.from_xarray(degrees)
    assert weald.Landscape.from_xarray(degrees.rio.reproject("EPSG:32633", resolution=10.0)).crs == "EPSG:32633"


@pytest.fixture
def watered(root: Path) -> weald.Landscape:
    land = weald.Landscape.open(root / "data/jacksboro_fault_utm16_80m.tif")
    land.flow()
    land.rivers()
    land.lakes()
    return land


def test_rivers_and_lakes_are_frames_of_geopandas(watered: weald.Landscape) -> None:
    geopandas = pytest.importorskip("geopandas")
    rivers = watered.river_lines()
    assert isinstance(rivers, geopandas.GeoDataFrame) and rivers.crs.to_epsg() == 32616
    assert set(rivers.geom_type) == {"LineString"} and rivers.length.sum() > 10_000.0
    west, south, east, north = rivers.total_bounds
    a, _, c, _, e, f = tuple(watered.transform)[:6]
    rows, columns = watered.shape
    assert c <= west and east <= c + columns * a and f + rows * e <= south and north <= f
    plain = watered.river_lines(frame=False)
    assert plain["type"] == "FeatureCollection" and len(plain["features"]) == len(rivers)
    assert watered.lake_areas().crs == rivers.crs


def test_plants_are_a_table(hills: weald.Landscape) -> None:
    hills.scatter(into="ferns", plant="fern", spacing=20.0)
    columns = hills.plants("ferns", frame=False)
    assert len(columns["x"]) > 100 and columns["x"].max() <= 64 * 20.0
    pandas = pytest.importorskip("pandas")
    table = hills.plants()
    assert isinstance(table, pandas.DataFrame) and list(table.columns) == list(columns)
    with pytest.raises(weald.RunError, match="no plants `moss`"):
        hills.plants("moss")


def test_pictures_show_themselves(hills: weald.Landscape, tmp_path: Path) -> None:
    picture = hills.picture("relief", width=200)
    assert picture._repr_png_() == picture.data and picture.data.startswith(b"\x89PNG") and picture.size[0] == 200
    assert picture._repr_html_().startswith('<img src="data:image/png;base64,')
    picture.save(tmp_path / "relief.png")
    assert (tmp_path / "relief.png").read_bytes() == picture.data
    page = hills._repr_html_()
    assert "<td>height</td><td>m</td>" in page and "image/png" in page
    with pytest.raises(weald.UsageError, match="there are: relief"):
        hills.picture("photo")
    with pytest.raises(weald.RecipeError, match="did you mean `width`"):
        hills.picture("relief", widht=200)
    film = hills.film("view", frames=3, width=96, height=64)
    assert b"acTL" in film.data and "image/apng" in film._repr_html_()
    with pytest.raises(weald.RunError, match="does not move"):
        hills.film("relief", frames=3)


def test_fractals_are_drawn_and_counted() -> None:
    assert weald.fractal("fern", size=80).size[0] == 80
    points = weald.fractal_points("fern", count=500)
    assert points.shape[0] == 500
    with pytest.raises(weald.RecipeError, match="did you mean `fern`"):
        weald.fractal("fren")


def test_exports_are_files(hills: weald.Landscape, tmp_path: Path) -> None:
    assert hills.export("mesh", tmp_path / "ground.glb")[0].read_bytes().startswith(b"glTF")
    files = hills.export("layers", tmp_path / "all.zarr", layers=["height"])
    assert files
    opened = xarray.open_zarr(tmp_path / "all.zarr", consolidated=False)
    name = next(name for name in opened.data_vars if opened[name].ndim == 2)
    assert np.array_equal(opened[name].values, hills["height"])

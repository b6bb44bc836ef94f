"""Layers are arrays of NumPy: lent without a copy, taken over with one."""

from __future__ import annotations

import gc

import numpy as np
import pytest
import weald


def test_a_layer_is_lent_and_not_copied(hills: weald.Landscape) -> None:
    one, other = hills["height"], hills["height"]
    assert one.ctypes.data == other.ctypes.data, "both show the memory of the layer"
    assert hills.copy()["height"].ctypes.data == one.ctypes.data, "copies share layers"
    assert one.shape == (48, 64) and one.dtype == np.float32 and one.flags.c_contiguous
    with pytest.raises(ValueError):
        one[0, 0] = 0.0
    with pytest.raises(ValueError):
        one.flags.writeable = True


def test_an_array_outlives_its_landscape_and_does_not_follow_it(hills: weald.Landscape) -> None:
    before = hills["height"]
    kept = before.copy()
    hills.hydraulic(iterations=20)
    assert not np.array_equal(hills["height"], kept), "something has moved"
    assert np.array_equal(before, kept)
    del hills
    gc.collect()
    assert np.array_equal(before, kept)


def test_every_type_and_order_of_numbers_is_taken(hills: weald.Landscape) -> None:
    whole = np.arange(12).reshape(3, 4)
    types = ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8", ">f4", ">i2", "?"]
    for kind in types:
        given = whole.astype(kind)
        assert np.array_equal(weald.Landscape(given, cell=1.0)["height"], given.astype("f4")), kind
    assert np.array_equal(weald.Landscape(whole.T, cell=1.0)["height"], whole.T), "strided"
    assert np.array_equal(weald.Landscape(whole[::-1, ::2], cell=1.0)["height"], whole[::-1, ::2])
    assert weald.Landscape([[1, 2], [3, 4]], cell=1.0).shape == (2, 2)


def test_what_was_given_can_be_changed_without_effect() -> None:
    heights = np.ones((3, 4), np.float32)
    land = weald.Landscape(heights, cell=1.0)
    heights[:] = 7.0
    assert float(land["height"].max()) == 1.0


def test_masks_come_from_nan_values_flags_and_masked_arrays() -> None:
    heights = np.arange(12, dtype=np.float32).reshape(3, 4)
    flags = heights != 5.0
    with_nan = np.where(flags, heights, np.nan)
    for land in [
        weald.Landscape(with_nan, cell=1.0),
        weald.Landscape(heights, cell=1.0, nodata=5.0),
        weald.Landscape(heights, cell=1.0, mask=flags),
        weald.Landscape(np.ma.masked_equal(heights, 5.0), cell=1.0),
    ]:
        assert land.masked and np.array_equal(land.mask, flags)
        assert np.isfinite(land["height"]).all()
        assert np.array_equal(land.array("height", np.nan), with_nan, equal_nan=True)
    assert not weald.Landscape(heights, cell=1.0).masked
    with pytest.raises(weald.UsageError, match="no ground"):
        weald.Landscape(np.full((3, 3), np.nan), cell=1.0)


def test_a_place_is_kept_and_what_is_no_place_refused(holed: weald.Landscape) -> None:
    assert holed.crs == "EPSG:32633" and holed.cell == 10.0
    assert tuple(holed.transform)[:6] == (10.0, 0.0, 500_000.0, 0.0, -10.0, 4_600_000.0)
    heights = np.ones((3, 3))
    for wrong, part in [
        (dict(), "give `cell`"),
        (dict(cell=-1.0), "give `cell`"),
        (dict(cell=float("nan")), "give `cell`"),
        (dict(cell=1.0, crs="EPSG:32633"), "give `transform`"),
        (dict(transform=(10.0, 1.0, 0.0, 0.0, -10.0, 0.0)), "turned or mirrored"),
        (dict(transform=(10.0, 0.0, 0.0, 0.0, 10.0, 0.0)), "turned or mirrored"),
        (dict(transform=(10.0, 0.0, 0.0, 0.0, -20.0, 0.0)), "no squares"),
        (dict(transform=(0.1, 0.0, 8.0, 0.0, -0.1, 47.0), crs=4326), "degrees"),
    ]:
        with pytest.raises(weald.Error, match=part):
            weald.Landscape(heights, **wrong)
    for shape in [(3,), (2, 2, 2)]:
        with pytest.raises(ValueError, match="rows and columns"):
            weald.Landscape(np.ones(shape), cell=1.0)
    with pytest.raises(weald.LimitError) as caught:
        weald.Landscape(np.ones((0, 3)), cell=1.0)
    assert caught.value.asked == 0


def test_layers_are_set_and_removed_as_in_a_mapping(hills: weald.Landscape) -> None:
    hills["water"] = np.zeros(hills.shape)
    assert hills.unit("water") == "m" and "water" in hills and len(hills) == 2
    hills.set("rainfall", np.ones(hills.shape, np.int16), "mm/h")
    assert hills.unit("rainfall") == "mm/h" and float(hills["rainfall"].sum()) == 64 * 48
    del hills["water"]
    assert list(hills) == ["height", "rainfall"] == list(hills.keys()) and len(hills.values()) == 2
    with pytest.raises(KeyError, match="no layer `water`"):
        hills["water"]
    with pytest.raises(KeyError):
        del hills["water"]
    with pytest.raises(weald.UsageError, match="3 × 2 cells"):
        hills["water"] = np.ones((2, 3))
    with pytest.raises(weald.UsageError, match="column 4, row 2"):
        wrong = np.ones(hills.shape)
        wrong[2, 4] = np.inf
        hills["water"] = wrong


def test_a_layer_may_lack_values_where_the_landscape_has_no_data(holed: weald.Landscape) -> None:
    holed["rain"] = np.where(holed.mask, 2.0, np.nan)
    assert float(holed.array("rain", np.nan)[3, 7]) != float(holed.array("rain", np.nan)[3, 7])


def test_materials_are_said_and_told(hills: weald.Landscape) -> None:
    assert [one["name"] for one in hills.materials] == ["rock", "soil"]
    hills.materials = [{"name": "rock"}, {"name": "shale", "talus_deg": 40.0}, {"name": "sand", "thickness": 2.0}]
    assert [one["thickness"] for one in hills.materials] == [0.0, 0.0, 2.0]
    hills.hydraulic(model="stava", iterations=5)
    assert "sand" in hills and "shale" in hills
    for wrong in [[], [{"name": "rock"}] * 9, [{"name": "rock", "talus_deg": 91.0}]]:
        with pytest.raises(weald.UsageError):
            hills.materials = wrong

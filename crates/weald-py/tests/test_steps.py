"""Every step of the catalogue is a method, whose signature is that of its declaration."""

from __future__ import annotations

import inspect
import typing

import numpy as np
import pytest
import weald
from weald import _catalogue as catalogue
from weald import _stubs

STEPS = {step["name"]: step for step in catalogue.steps()}


def test_what_is_written_from_the_catalogue_is_not_stale(root: typing.Any) -> None:
    assert _stubs.stale(root) == [], "python -m weald._stubs write"


@pytest.mark.parametrize("name", STEPS)
def test_a_step_is_a_method_with_all_keys_documented(name: str) -> None:
    step = STEPS[name]
    found = getattr(weald.Landscape, catalogue.method(name))
    signature, keys = inspect.signature(found), catalogue.keywords(step["parameters"])
    assert list(signature.parameters)[1:] == [catalogue.method(key["name"]) for key in keys] + catalogue.call_of(step)
    for key in keys:
        assert f"\n{catalogue.method(key['name'])}: " in found.__doc__, key["name"]
        usual = signature.parameters[catalogue.method(key["name"])].default
        assert (usual is inspect.Parameter.empty) == key["required"]
    assert not {"engine", "threads", "callback", "progress"} & {key["name"] for key in keys}
    own = {name for name in vars(weald.Landscape)} | {name for name in dir(weald._weald.Landscape) if name[0] != "_"}
    assert catalogue.method(name) not in own, "a step is hidden by what a landscape has"


def run(land: weald.Landscape, name: str, **keys: typing.Any) -> typing.Any:
    return getattr(land, catalogue.method(name))(**keys)


@pytest.mark.parametrize("name", [name for name, step in STEPS.items() if step["stage"] not in ("load",)])
def test_every_key_can_be_given_and_is_checked(name: str, hills: weald.Landscape) -> None:
    for key in catalogue.keywords(STEPS[name]["parameters"]):
        kind = key["kind"]
        if key["only"] or kind["type"] not in ("number", "integer"):
            continue
        low, high = kind["range"]
        beyond = high * 2 + 1 if high is not None else (low - abs(low) - 1 if low is not None else None)
        if beyond is None:
            continue
        with pytest.raises(weald.RecipeError) as caught:
            run(hills, name, **{catalogue.method(key["name"]): beyond})
        assert f"`{key['name']}`" in str(caught.value), key["name"]
        assert caught.value.file == name and caught.value.faults[0][0] is None
    with pytest.raises(weald.RecipeError, match="unknown key `nonsense`"):
        run(hills, name, nonsense=1)
    assert list(hills) == ["height"], "nothing ran"


def test_the_example_of_every_stage_runs(hills: weald.Landscape) -> None:
    ground = hills["height"].copy()
    report = hills.hydraulic(model="han", iterations=40)
    assert isinstance(report, weald.StepReport) and report.iterations == 40
    assert report.budget is not None and abs(report.budget["water"]["error"]) < 1e-5
    assert "erosion" in report.layers and not np.array_equal(ground, hills["height"])
    slope = hills.slope()
    assert isinstance(slope, np.ndarray) and slope.ctypes.data == hills["slope"].ctypes.data
    flow = hills.flow()
    assert set(flow) == {name for name, _ in STEPS["flow"]["writes"]}
    assert hills.rivers(area=20_000.0) is not None
    assert hills.thermal(talus=0.4, iterations=5).iterations == 5


def test_a_landscape_with_a_sea_has_its_coast_and_one_without_says_so() -> None:
    east = np.linspace(-40.0, 80.0, 60, dtype=np.float32)
    land = weald.Landscape(np.tile(east, (40, 1)), cell=20.0)
    with pytest.raises(weald.RunError, match="sea_level"):
        land.coast()
    assert land.sea_level is None and list(land) == ["height"]
    land.sea_level = 0.0
    assert np.array_equal(land["sea_depth"][0] > 0, east < 0) and np.array_equal(land["water"], land["sea_depth"])
    before = (land["sea_depth"] > 0).sum()
    report = land.coast(duration=2000.0)
    assert report.budget is not None and abs(report.budget["solid"]["error"]) < 1e-6
    assert (land["sea_depth"] > 0).sum() > before, "the coast has retreated"
    assert land.flow()["flow_direction"][20, 3] == 9, "rivers end in the sea"
    with pytest.raises((weald.RunError, ValueError, TypeError)):
        land.sea_level = float("nan")


def test_a_step_that_cannot_run_leaves_the_landscape_as_it_was(hills: weald.Landscape) -> None:
    before = hills.copy()
    with pytest.raises(weald.RunError, match="no layer `flow_direction`"):
        hills.rivers()
    with pytest.raises(weald.RecipeError, match="did you mean `iterations`"):
        hills.thermal(iteratoins=3)
    with pytest.raises(weald.RecipeError, match="has no effect with model = \"han\""):
        hills.hydraulic(model="han", deposition=0.5)
    with pytest.raises(TypeError, match="`talus` is a object"):
        hills.thermal(talus=object())
    assert hills == before


@pytest.mark.parametrize("name", [name for name, step in STEPS.items() if step["stage"] == "analyse"])
def test_an_analysis_gives_arrays_of_the_layers_that_it_declares(name: str, hills: weald.Landscape) -> None:
    hills.flow()
    hills.rivers(area=20_000.0)
    hills.lakes()
    hills.wetness()
    hills.hydraulic(iterations=20)
    before = set(hills)
    given = {"select": {"where": [{"layer": "height", "above": 0.0}]}}.get(name, {})
    try:
        found = run(hills, name, **given)
    except weald.RecipeError as error:
        pytest.skip(f"needs keys of its own: {error}")
    wanted = catalogue.result(STEPS[name])
    if wanted == "Array":
        assert found.shape == hills.shape
    elif wanted == "StepReport":
        assert found.measures
    else:
        assert all(values.shape == hills.shape for values in found.values()) and set(found) <= set(hills)
    assert before <= set(hills)


def test_threads_and_engines_give_the_same_bits(hills: weald.Landscape) -> None:
    results = []
    for how in [dict(threads=1), dict(threads=3), dict(engine="bands:3"), dict(engine="tiles:24"), dict(engine="cpu")]:
        land = hills.copy()
        land.hydraulic(iterations=60, **how)
        results.append(land)
    assert not np.array_equal(results[0]["height"], hills["height"]), "something moved"
    assert all(land == results[0] for land in results[1:])
    with pytest.raises(weald.RunError, match='the engines are "auto", "cpu" and "gpu"'):
        hills.hydraulic(iterations=1, engine="quantum")


def test_two_threads_do_not_change_one_landscape(hills: weald.Landscape) -> None:
    problems: list[Exception] = []

    def again(progress: weald.Progress) -> None:
        try:
            hills.slope()
        except weald.UsageError as error:
            problems.append(error)

    hills.hydraulic(iterations=300, callback=again)
    assert problems and "copy()" in str(problems[0])


def test_a_device_gives_what_the_processor_gives(hills: weald.Landscape) -> None:
    here, there = hills.copy(), hills.copy()
    try:
        there.hydraulic(iterations=60, engine="gpu")
    except weald.DeviceError as error:
        assert error.kind == "no adapter", error
        pytest.skip(str(error))
    here.hydraulic(iterations=60, engine="cpu")
    moved = np.abs(here["height"] - hills["height"]).max()
    assert moved > 0.1 and np.abs(here["height"] - there["height"]).max() < 1e-3 * moved

"""Recipes give what the command gives, to the bit."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import weald

RECIPE = """
weald = 1
[landscape]
size = [64, 48]
cell = 20.0
seed = 9
[[step]]
do = "diamond-square"
relief = 500.0
[[step]]
do = "hydraulic"
iterations = 80
[[step]]
do = "flow"
[[output]]
layer = "height"
file = "height.npy"
[[output]]
layer = "accumulation"
file = "accumulation.tif"
[[output]]
picture = "relief"
file = "relief.png"
"""


@pytest.mark.parametrize("options", [[], ["--seed", "4"], ["--set", "hydraulic.iterations=20"], ["--size", "32"]])
def test_a_run_has_the_bits_of_the_command(
    tmp_path: Path, command: Callable[..., None], options: list[str]
) -> None:
    (tmp_path / "land.toml").write_text(RECIPE)
    command("run", "land.toml", "--out", "theirs", "--engine", "cpu", "--quiet", *options, cwd=tmp_path)
    keywords: dict[str, object] = {}
    for option, value in zip(options[::2], options[1::2]):
        match option:
            case "--set":
                key, number = value.split("=")
                keywords["set"] = {key: int(number)}
            case _:
                keywords[option[2:]] = int(value)
    result = weald.run(tmp_path / "land.toml", tmp_path / "ours", engine="cpu", **keywords)
    names = ["accumulation.qml", "accumulation.tif", "height.npy", "relief.png"]
    for name in names:
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes(), name
    assert result.landscape is not None
    assert np.array_equal(np.load(tmp_path / "theirs/height.npy").astype("f4"), result.landscape["height"])
    assert sorted(file.name for file in result.files) == names
    assert all(file.exists() for file in result.files)


def test_a_path_a_text_a_dictionary_and_memory_give_the_same(tmp_path: Path) -> None:
    path = tmp_path / "land.toml"
    path.write_text(RECIPE)
    table = {
        "weald": 1,
        "landscape": {"size": (64, 48), "cell": 20.0, "seed": np.int64(9)},
        "step": [
            {"do": "diamond-square", "relief": np.float32(500.0)},
            {"do": "hydraulic", "iterations": 80},
            {"do": "flow"},
        ],
        "output": [{"layer": "height", "file": "height.npy"}],
    }
    lands = [weald.run(source).landscape for source in [str(path), path, RECIPE, table, weald.Recipe(RECIPE)]]
    lands.append(weald.run({key: value for key, value in table.items() if key != "output"}).landscape)
    lands.append(weald.run(path, tmp_path / "out").landscape)
    assert lands[0] is not None and all(land == lands[0] for land in lands)
    assert not list(tmp_path.glob("*.npy")), "nothing is written without `out`"


def test_methods_have_the_bits_of_a_recipe() -> None:
    land = weald.Landscape.empty(64, 48, 20.0)
    land.diamond_square(relief=500.0, seed=9)
    land.hydraulic(iterations=80, seed=9)
    land.flow(seed=9)
    land.scatter(into="ferns", plant="fern", spacing=15.0, seed=9)
    scatter = '[[step]]\ndo = "scatter"\ninto = "ferns"\nplant = "fern"\nspacing = 15.0\n[[output]]'
    other = weald.run(RECIPE.replace("[[output]]", scatter, 1)).landscape
    assert land == other and len(land.plants(frame=False)["x"]) > 100
    again = land.copy()
    again.scatter(into="ferns", plant="fern", spacing=15.0, seed=8)
    assert again != land, "another seed, other places"


def test_the_report_says_what_was_done(tmp_path: Path) -> None:
    heard: list[weald.Progress] = []
    result = weald.run(RECIPE, callback=lambda progress: heard.append(progress))
    steps = [step["step"] for step in result.report["steps"]]
    assert steps == ["diamond-square", "hydraulic", "flow"] == [one.name for one in heard if one.kind == "step"]
    assert any(one.kind == "progress" and one.done == one.total == 80 for one in heard)
    assert result.report["recipe_blake3"] == result.recipe.hash and result.report["steps"][1]["budget"]


def test_faults_of_a_recipe_come_at_once_with_their_lines() -> None:
    wrong = RECIPE.replace("relief = 500.0", "releif = 500.0").replace("iterations = 80", "iterations = -3")
    with pytest.raises(weald.RecipeError) as caught:
        weald.run(wrong)
    assert [line for line, _ in caught.value.faults] == [9, 12]
    assert "did you mean `relief`" in str(caught.value)
    with pytest.raises(weald.RecipeError, match="cannot be read"):
        weald.run("nowhere.toml")
    with pytest.raises(weald.RecipeError, match="needs an"):
        weald.run(RECIPE[: RECIPE.index("[[output]]")], "out")
    with pytest.raises(TypeError, match="no place in a recipe"):
        weald.run({"landscape": {"size": object()}})


def test_input_and_limits_are_exceptions_with_fields(tmp_path: Path) -> None:
    with pytest.raises(weald.InputError) as caught:
        weald.Landscape.open(tmp_path / "none.tif")
    assert Path(caught.value.path).name == "none.tif"
    assert isinstance(caught.value, OSError)
    with pytest.raises(weald.LimitError) as limit:
        weald.Landscape.empty(100_000, 100_000, 1.0)
    assert limit.value.what == "Cells" and limit.value.asked == 10**10 and limit.value.allowed == (0, 2**28)
    again = pickle.loads(pickle.dumps(limit.value))
    assert type(again) is weald.LimitError and again.allowed == limit.value.allowed and str(again) == str(limit.value)


def test_a_value_that_is_no_number_is_told_with_its_place() -> None:
    heights = np.zeros((16, 24), np.float32)
    heights[5, 7] = 3e38
    land = weald.Landscape(heights, cell=1.0)
    with pytest.raises(weald.NotFiniteError) as caught:
        land.add(with_="height")
    assert caught.value.layer == "height" and caught.value.cell == (7, 5)
    assert isinstance(caught.value, weald.RunError) and float(land["height"][5, 7]) == np.float32(3e38)


def test_a_callback_that_raises_or_says_false_ends_a_run(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError):
        weald.run(RECIPE, callback=lambda progress: 1 / 0)
    with pytest.raises(weald.Cancelled):
        weald.run(RECIPE, callback=lambda progress: False)


def test_recipes_and_results_pickle(tmp_path: Path) -> None:
    recipe = weald.Recipe(RECIPE, seed=3)
    again = pickle.loads(pickle.dumps(recipe))
    assert again == recipe and again.hash == recipe.hash and type(again) is weald.Recipe
    result = weald.run(recipe, tmp_path / "out")
    other = pickle.loads(pickle.dumps(result))
    assert other.landscape == result.landscape and other.report == result.report and other.files == result.files


def test_landscapes_pickle_to_the_bit(holed: weald.Landscape) -> None:
    holed.materials = [{"name": "rock", "talus_deg": 61.0}, {"name": "sand", "thickness": 2.0}]
    holed.hydraulic(iterations=10, model="stava")
    holed.scatter(into="ferns", plant="fern", spacing=8.0)
    for name in ("light", "fertility", "moisture"):
        holed.set(name, np.full(holed.shape, 0.7), "1")
    holed.grass(sets=2.0)
    again = pickle.loads(pickle.dumps(holed))
    assert again == holed and type(again) is weald.Landscape
    assert again.crs == holed.crs and np.array_equal(again.mask, holed.mask) and again.materials == holed.materials


def test_a_file_comes_in_with_its_crs_and_goes_out(root: Path, tmp_path: Path) -> None:
    land = weald.Landscape.open(root / "data/jacksboro_fault_utm16_80m.tif")
    assert land.crs == "EPSG:32616" and land.cell == 80.0
    land.save(tmp_path / "out.tif")
    again = weald.Landscape.open(tmp_path / "out.tif")
    assert again.crs == land.crs and tuple(again.transform) == tuple(land.transform)
    assert np.array_equal(again["height"], land["height"])


def test_a_landscape_remembers_the_fractals_of_its_recipe() -> None:
    recipe = {
        "landscape": {"size": 32, "cell": 5.0},
        "fractal": [{"name": "bent", "of": "fern", "deform": [{"by": "permutation", "from": 5, "to": 7}]}],
        "step": [{"do": "fbm", "relief": 5.0}, {"do": "scatter", "plant": "fern", "into": "ferns", "spacing": 6.0}],
    }
    land = weald.run(recipe).landscape
    again = pickle.loads(pickle.dumps(land))
    assert land is not None and again == land and len(again.plants("ferns", frame=False)["x"]) > 10
    small = {"kind": "fractal", "fractal": "bent", "size": 48, "supersample": 1, "samples": 20}
    assert again.picture(**small).data == land.picture(**small).data


def test_a_bar_of_tqdm_shows_the_steps(capfd: pytest.CaptureFixture[str]) -> None:
    tqdm = pytest.importorskip("tqdm")
    assert tqdm
    from weald._progress import Bar, shown

    bar = Bar()
    bar(weald.Progress("step", number=1, count=2, name="hydraulic"))
    for done in (1, 2, 3):
        bar(weald.Progress("progress", done=done, total=3, cells=9))
    assert bar._bar.n == 3 and bar._bar.desc.startswith("hydraulic (1/2)")
    bar.close()
    with shown(None, True, "slope") as hears:
        assert hears is not None
        hears(weald.Progress("progress", done=1, total=2))
    assert weald.run(RECIPE, progress=True).landscape is not None


def test_notes_are_warnings_where_nobody_hears_them(tmp_path: Path) -> None:
    with pytest.warns(weald.Note, match="are left out") as caught:
        weald.run(RECIPE, tmp_path)
    assert caught[0].filename == __file__

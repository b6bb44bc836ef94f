"""A simulation in hand: what is done, painted and taken back."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import weald

RECIPE = {
    "landscape": {"size": [48, 32], "cell": 20.0, "seed": 7},
    "step": [{"do": "fbm"}, {"do": "hydraulic", "model": "stava", "iterations": 60}, {"do": "slope"}],
    "output": [{"layer": "slope", "file": "slope.tif"}],
}


@pytest.fixture
def session() -> weald.Session:
    return weald.Session(RECIPE)


def test_advancing_to_the_end_has_the_bits_of_a_run(session: weald.Session) -> None:
    assert (session.steps, session.written_steps) == (0, 60)
    session.advance(13)
    session.run()
    assert session.steps == 60
    ours, theirs = session.finish(), weald.run(RECIPE).landscape
    assert theirs is not None and list(ours) == list(theirs)
    # The mean flux of a run is that of its last iterations; nobody knows which are the last of a session.
    for name in set(ours) - {"flux_x", "flux_y"}:
        assert np.array_equal(ours[name], theirs[name]), name
    assert session.report().budget is not None


def test_strokes_settings_and_steps_are_taken_back_and_done_again(session: weald.Session) -> None:
    session.advance(20)
    before = session.landscape()
    session.paint("add-water", [480.0, 320.0], depth=30.0, radius=100.0)
    flooded = session.patch()["water"]
    assert float(flooded.max()) > 15.0
    session.set("rain", 0.2)
    session.advance(40)
    carved = session.landscape()
    assert [session.undo() for _ in range(3)] == [True] * 3
    assert session.steps == 20 and session.landscape() == before
    assert [session.redo() for _ in range(3)] == [True] * 3 and not session.redo()
    assert session.landscape() == carved and carved != before
    while session.undo():
        pass
    assert session.steps == 0 and not session.undo()


def test_a_patch_is_a_rectangle_of_arrays_of_its_own(session: weald.Session) -> None:
    session.advance(5)
    whole, part = session.patch(), session.patch((10, 4, 8, 6))
    assert part["bedrock"].shape == (6, 8) and part["bedrock"].flags.writeable
    assert np.array_equal(whole["bedrock"][4:10, 10:18], part["bedrock"])
    assert session["height"].shape == (32, 48)
    with pytest.raises(weald.Error):
        session.patch((40, 30, 20, 20))


def test_what_was_done_is_saved_and_runs_to_the_same_bits(session: weald.Session, tmp_path: Path) -> None:
    session.advance(10)
    session.paint("add", [[200.0, 100.0], [700.0, 500.0]], material="soil", thickness=4.0, radius=60.0)
    session.advance(15)
    session.save(tmp_path / "held.toml")
    assert weald.run(tmp_path / "held.toml").landscape == session.finish()
    again = weald.Session(weald.Recipe(tmp_path / "held.toml"))
    assert again.steps == 25 and again.landscape() == session.landscape()


def test_wrong_strokes_and_keys_are_told_and_change_nothing(session: weald.Session) -> None:
    session.advance(3)
    before = session.landscape()
    for wrong, part in [
        (lambda: session.paint("ad", [1.0, 2.0]), "did you mean `add`"),
        (lambda: session.paint("add", [1.0, 2.0], material="sandd", thickness=1.0), "there is none"),
        (lambda: session.paint("add", [1.0, 2.0], depth=1.0), "needed"),
        (lambda: session.set("ran", 0.2), "ran"),
    ]:
        with pytest.raises(weald.Error, match=part):
            wrong()
    assert session.landscape() == before and session.undo() and not session.undo()
    with pytest.raises(weald.RunError, match="no step that can be held"):
        weald.Session({"landscape": {"size": 8, "cell": 1.0}, "step": [{"do": "fbm"}]})

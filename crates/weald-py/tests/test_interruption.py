"""Ctrl-C ends what runs within a moment, and other threads of Python run meanwhile."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import weald

LONG = {
    "landscape": {"size": 512, "cell": 20.0},
    "step": [{"do": "fbm"}, {"do": "hydraulic", "iterations": 1_000_000}],
    "output": [{"layer": "height", "file": "height.tif"}],
}


@pytest.fixture(autouse=True)
def ctrl_c() -> Iterator[None]:
    """Who starts the tests in the background has Ctrl-C ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def interrupt_after(seconds: float) -> list[float]:
    """Sends the signal of Ctrl-C from another thread; the list gets the time at which it does."""
    sent: list[float] = []

    def send() -> None:
        time.sleep(seconds)
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=send, daemon=True).start()
    return sent


def delay(sent: list[float]) -> float:
    return time.perf_counter() - sent[0]


def test_ctrl_c_ends_a_step_and_leaves_the_landscape(hills: weald.Landscape) -> None:
    before = hills.copy()
    sent = interrupt_after(0.3)
    with pytest.raises(KeyboardInterrupt) as caught:
        hills.hydraulic(iterations=10_000_000)
    print(f"a step ends {delay(sent):.3f} s after Ctrl-C")
    assert isinstance(caught.value, weald.Interrupted)
    assert hills == before


def test_ctrl_c_ends_a_run_which_goes_on_from_its_checkpoint(tmp_path: Path) -> None:
    small = {**LONG, "landscape": {"size": 96, "cell": 20.0}, "step": [{"do": "fbm"}, {"do": "hydraulic", "iterations": 3000}]}
    whole = weald.run(small).landscape
    told = threading.Event()

    def stop_in_the_middle(progress: weald.Progress) -> None:
        if progress.kind == "progress" and 100 < progress.done < 2500 and not told.is_set():
            told.set()
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(weald.Interrupted) as caught:
        weald.run(small, tmp_path, callback=stop_in_the_middle)
    assert "goes on from" in str(caught.value) or "ends by itself" in str(caught.value)
    until = time.monotonic() + 60.0
    while not (tmp_path / "checkpoint.weald").exists() and time.monotonic() < until:
        time.sleep(0.05)
    time.sleep(0.5)
    assert weald.run(small, tmp_path, resume=True).landscape == whole


def test_ctrl_c_is_no_exception_that_a_careless_loop_swallows() -> None:
    sent = interrupt_after(0.3)
    with pytest.raises(KeyboardInterrupt):
        try:
            weald.run(LONG)
        except Exception:
            pytest.fail("`except Exception` caught it")
    print(f"a run ends {delay(sent):.3f} s after Ctrl-C")


def forked(land: weald.Landscape) -> weald.Landscape:
    land = land.copy()
    land.hydraulic(iterations=20)
    land.paint("add", [300.0, 200.0], material="soil", thickness=3.0, radius=100.0)
    land.picture(width=100)
    session = weald.Session({**LONG, "landscape": {"size": 32, "cell": 20.0}})
    session.advance(5)
    session.paint("add-water", [200.0, 200.0], depth=3.0, radius=50.0)
    return land


@pytest.mark.skipif("fork" not in multiprocessing.get_all_start_methods(), reason="this system has no fork")
def test_processes_that_were_forked_have_threads_of_their_own(hills: weald.Landscape) -> None:
    here = forked(hills)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        there = pool.map_async(forked, [hills, hills]).get(timeout=120)
    assert there == [here, here] and here != hills


def test_python_runs_while_a_step_does(hills: weald.Landscape) -> None:
    counted = 0
    stop = threading.Event()

    def count() -> None:
        nonlocal counted
        while not stop.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    try:
        hills.hydraulic(iterations=3000)
    finally:
        stop.set()
        thread.join()
    assert counted > 10, "the lock of the interpreter was held"


def test_steps_run_in_threads_that_are_not_the_main_one(hills: weald.Landscape) -> None:
    lands = [hills.copy() for _ in range(4)]
    threads = [threading.Thread(target=land.hydraulic, kwargs={"iterations": 50}) for land in lands]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not np.array_equal(lands[0]["height"], hills["height"])
    assert all(land == lands[0] for land in lands)

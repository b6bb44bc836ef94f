"""How long after Ctrl-C each of several calls ends.

    python crates/weald-py/benches/interruption.py [cells a side]
"""

from __future__ import annotations

import os
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import weald


def after_signal(work: Callable[[], Any], seconds: float) -> float | None:
    """Seconds from the signal to the exception; `None` where the work was done before."""
    sent = 0.0

    def send() -> None:
        nonlocal sent
        sent = time.perf_counter()
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(seconds, send)
    timer.start()
    try:
        work()
    except weald.Interrupted:
        return time.perf_counter() - sent
    timer.cancel()
    return None


def main(side: int) -> None:
    signal.signal(signal.SIGINT, signal.default_int_handler)
    land = weald.Landscape.empty(side, side, 20.0)
    land.diamond_square(relief=800.0, seed=3)
    recipe = {
        "landscape": {"size": side, "cell": 20.0},
        "step": [{"do": "fbm"}, {"do": "hydraulic", "iterations": 1_000_000}],
        "output": [{"layer": "height", "file": "height.tif"}],
    }
    session = weald.Session(recipe)
    with tempfile.TemporaryDirectory() as folder:
        calls: list[tuple[str, Callable[[], Any]]] = [
            ("hydraulic", lambda: land.copy().hydraulic(iterations=1_000_000)),
            ("hydraulic, stava", lambda: land.copy().hydraulic(model="stava", iterations=1_000_000)),
            ("fluvial", lambda: land.copy().fluvial(duration=1e6)),
            ("occlusion", lambda: land.copy().occlusion()),
            ("sunlight", lambda: land.copy().sunlight()),
            ("picture view", lambda: land.picture("view", width=3840, height=2160)),
            ("run with files", lambda: weald.run(recipe, Path(folder) / "out")),
            ("session.advance", lambda: session.advance(1_000_000)),
        ]
        for name, call in calls:
            taken = after_signal(call, 0.3)
            print(f"{name:18} " + ("was done before" if taken is None else f"{taken:.3f} s"), flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1024)

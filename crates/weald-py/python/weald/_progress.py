"""What a run tells of itself, and a bar that shows it where tqdm is there."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Iterator


@dataclass(frozen=True, slots=True)
class Progress:
    """Something that a run tells. Which fields have a meaning depends on `kind`."""

    kind: str
    """`step` (a step begins), `progress` (it has done `done` of `total`), `output` (a file is made), `note`."""
    number: int = 0
    """Of a step or a file, counted from 1."""
    count: int = 0
    """How many steps or files there are."""
    name: str = ""
    """Of the step or the file."""
    done: int = 0
    """Iterations that are done."""
    total: int = 0
    """Iterations in all."""
    cells: int = 0
    """Cells of the grid."""
    text: str = ""
    """Of a note."""


Callback = Callable[[Progress], "bool | None"]
"""Is called on the thread that called; `False` ends the run."""


class Bar:
    """A bar of tqdm for each step, which appears when a step takes longer than half a second."""

    def __init__(self, title: str = "") -> None:
        from tqdm.auto import tqdm

        self._tqdm = tqdm
        self._title = title
        self._bar: Any = None

    def __call__(self, progress: Progress) -> None:
        if progress.kind in ("step", "output"):
            self.close()
            self._title = f"{progress.name} ({progress.number}/{progress.count})"
        elif progress.kind == "progress" and progress.total > 0:
            if self._bar is None or self._bar.total != progress.total:
                self.close()
                self._bar = self._tqdm(total=progress.total, desc=self._title, delay=0.5, leave=False)
            self._bar.update(progress.done - self._bar.n)

    def close(self) -> None:
        """Takes the bar away."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None


@contextmanager
def shown(callback: Callback | None, progress: bool | None, title: str = "") -> Iterator[Callback | None]:
    """The callback, or a bar where there is none and somebody looks; notes become warnings where nobody hears them."""
    if callback is not None:
        yield callback
        return
    bar = _bar(title) if progress or (progress is None and _somebody_looks()) else None

    def hear(news: Progress) -> None:
        if news.kind == "note":
            warn(news.text)
        elif bar is not None:
            bar(news)

    try:
        yield hear
    finally:
        if bar is not None:
            bar.close()


class Note(UserWarning):
    """Something that the user should know of a run that goes on."""


def warn(text: str) -> None:
    """Warns where the package was called."""
    frame, level = sys._getframe(), 1
    while frame.f_back is not None and frame.f_globals.get("__package__") in ("weald", None):
        frame, level = frame.f_back, level + 1
    warnings.warn(text, Note, stacklevel=level)


def _bar(title: str) -> Bar | None:
    try:
        return Bar(title)
    except ImportError:
        return None


def _somebody_looks() -> bool:
    return sys.stderr is not None and (sys.stderr.isatty() or "ipykernel" in sys.modules)

"""Exceptions, one class for each who must act; their fields are for a program that goes on with less."""

from __future__ import annotations


class Error(Exception):
    """What Weald raises. The text says what is wrong, where, what is legal, and what to do."""

    def __init__(self, message: str, **fields: object) -> None:
        super().__init__(message)
        self.fields = fields
        self.__dict__.update(fields)

    def __reduce__(self) -> tuple[object, ...]:
        return _again, (type(self), self.args[0], self.fields)


def _again(kind: type[Error], message: str, fields: dict[str, object]) -> Error:
    return kind(message, **fields)


class UsageError(Error, ValueError):
    """A call asks for what there is not, or gives what does not fit."""


class RecipeError(Error, ValueError):
    """A recipe, or the keywords of a step, are faulty. All faults come at once."""

    file: str
    """Name of the recipe, or of the step."""
    faults: list[tuple[int | None, str]]
    """Line in the recipe, where there is one, and what is wrong there."""


class InputError(Error, OSError):
    """An input file is missing, damaged, or of a kind that is not read."""

    path: str
    what: str

    def __str__(self) -> str:
        return str(self.args[0])


class LimitError(Error, ValueError):
    """More than a stated limit allows; nothing was allocated."""

    what: str
    """What is counted: `Cells`, `MemoryBytes` …"""
    asked: int | None
    allowed: tuple[int, int]
    subject: str
    remedy: str


class RunError(Error, RuntimeError):
    """A run failed: a layer that is missing, a folder that cannot be written."""


class NotFiniteError(RunError):
    """A step gave a value that is infinite or no number; gentler parameters may help."""

    step: str | None
    iteration: int | None
    layer: str
    cell: tuple[int, int]
    """Column and row."""


class DeviceError(RunError):
    """A graphics device failed, or there is none."""

    kind: str
    """`no adapter`, `not opened`, `out of memory`, `over limit`, `lost`, `unresponsive`, `unsupported`, `misused`, `failed`."""


class Cancelled(Error):
    """The callback of a run said `False`. Where a checkpoint was kept, `resume=True` goes on from it."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C, with where the run was. It is a `KeyboardInterrupt`, so that `except Exception` lets it pass."""

    def __init__(self, message: str, **_: object) -> None:
        super().__init__(message)

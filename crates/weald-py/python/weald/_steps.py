"""Every step of the catalogue as a method. The stub beside this file has their signatures; `_stubs` writes it."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from ._catalogue import call_of, default, document, key, keywords, method, steps


@dataclass(frozen=True)
class StepReport:
    """What a step reports, as in `report.json`."""

    step: str
    """Its name."""
    iterations: int = 0
    """What it counts: iterations, faults, octaves."""
    budget: dict[str, dict[str, float]] | None = None
    """Where water and solid went, in cubic metres, for simulations."""
    measures: dict[str, float] = field(default_factory=dict)
    """What it measured, by name."""
    notes: list[str] = field(default_factory=list)
    """What the user should know."""
    layers: list[str] = field(default_factory=list)
    """The layers that it wrote."""


class Steps:
    """A method for each step of the catalogue."""

    def _run_step(self, name: str, keys: dict[str, Any], call: dict[str, Any]) -> Any:
        raise NotImplementedError


class AccessorSteps(Steps):
    """The same of an array of xarray, which stays as it is: a method gives new arrays."""


_USUAL = {"seed": 0, "engine": "auto", "threads": None, "callback": None, "progress": None}


def _of(step: dict[str, Any]) -> Callable[..., Any]:
    name, others = step["name"], call_of(step)

    # Only what is given goes to the step: a key at its default may be without effect beside others.
    def run(self: Steps, **given: Any) -> Any:
        call = {**_USUAL, **{word: given.pop(word) for word in others if word in given}}
        return self._run_step(name, {key(word): value for word, value in given.items()}, call)

    run.__name__ = method(name)
    run.__qualname__ = f"Steps.{run.__name__}"
    run.__doc__ = document(step, (_SEED_DOCUMENT if "seed" in others else "") + _CALL_DOCUMENT)
    run.__signature__ = _signature(step)  # type: ignore[attr-defined]
    return run


_SEED_DOCUMENT = """
seed: whole number from 0; default 0
    Of what the step draws at random, as `seed` of a recipe."""

_CALL_DOCUMENT = """
engine: "auto" | "cpu" | "gpu"; default "auto"
    Where it runs.
threads: whole number; default all cores
    Threads of the processor. The result does not depend on it.
callback: function of a `Progress`
    Hears of progress; `False` ends the step, and the landscape stays as it was.
progress: flag; default where somebody looks
    Whether a bar of tqdm is shown."""


def _signature(step: dict[str, Any]) -> inspect.Signature:
    kind = inspect.Parameter.KEYWORD_ONLY
    found = [inspect.Parameter("self", inspect.Parameter.POSITIONAL_OR_KEYWORD)]
    for parameter in keywords(step["parameters"]):
        usual = inspect.Parameter.empty if parameter["required"] else default(parameter)
        found.append(inspect.Parameter(method(parameter["name"]), kind, default=usual))
    found += [inspect.Parameter(word, kind, default=_USUAL[word]) for word in call_of(step)]
    return inspect.Signature(found)


for _step in steps():
    setattr(Steps, method(_step["name"]), _of(_step))

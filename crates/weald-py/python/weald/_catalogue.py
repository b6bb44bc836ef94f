"""The catalogue of steps, pictures and exports, and what follows from it: signatures, documents, stubs."""

from __future__ import annotations

import json
import keyword
import tomllib
from functools import cache
from typing import Any

from . import _weald

#: Keywords that every step has beside its own; what draws at random by a key `seed` has that in place of the first.
CALL = ("seed", "engine", "threads", "callback", "progress")

#: What the stages give: analyses their layers, the others what they report.
ANALYSES = ("analyse",)


@cache
def catalogue() -> dict[str, list[dict[str, Any]]]:
    """All steps, pictures and exports with their parameters."""
    read: dict[str, list[dict[str, Any]]] = json.loads(_weald.catalogue())
    return read


def steps() -> list[dict[str, Any]]:
    """All steps."""
    return catalogue()["steps"]


def method(name: str) -> str:
    """The name of a step or a key in Python."""
    name = name.replace("-", "_")
    return name + "_" if keyword.iskeyword(name) else name


def key(name: str) -> str:
    """The key of a recipe that a keyword stands for."""
    return name[:-1] if name.endswith("_") and keyword.iskeyword(name[:-1]) else name


def keywords(parameters: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Every key once: those of the words of a choice stand behind it, joined where several words have them."""
    found: dict[str, dict[str, Any]] = {}
    for parameter in parameters:
        found.setdefault(parameter["name"], dict(parameter, only=[]))
        if parameter["kind"]["type"] == "variants":
            for variant in parameter["kind"]["variants"]:
                for inner in keywords(variant["parameters"]):
                    _join(found, inner, variant["word"])
    return list(found.values())


def _join(found: dict[str, dict[str, Any]], inner: dict[str, Any], word: str) -> None:
    known = found.setdefault(inner["name"], dict(inner, only=[], each=[]))
    known["only"].append(word)
    known.setdefault("each", []).append((word, inner))


def call_of(step: dict[str, Any]) -> list[str]:
    """The keywords of a step beside its own."""
    own = {parameter["name"] for parameter in keywords(step["parameters"])}
    return [word for word in CALL if word not in own]


def default(parameter: dict[str, Any]) -> Any:
    """The default as a value of Python; `None` where it depends on other keys, or means something that no value says."""
    shown = parameter["default"]
    each = parameter.get("each", [])
    if shown is None or len({inner["default"] for _, inner in each}) > 1:
        return None
    return tomllib.loads(f"value = {shown}")["value"]


_TYPES = {
    "number": "float",
    "integer": "int",
    "flag": "bool",
    "text": "str",
    "file": "str | PathLike[str]",
    "colour": "str",
    "crs": "str",
    "sides": "int | Sequence[int]",
    "layer": "str",
    "layers": "Sequence[str]",
    "places": "Sequence[float] | Sequence[Sequence[float]]",
    "numbers": "Sequence[float]",
    "rows": "Sequence[Sequence[float]]",
    "table": "Mapping[str, Any]",
    "tables": "Sequence[Mapping[str, Any]]",
}


def annotation(parameter: dict[str, Any]) -> str:
    """The type of a keyword."""
    kinds = [parameter["kind"]] + [inner["kind"] for _, inner in parameter.get("each", [])]
    types = list(dict.fromkeys(_type(kind) for kind in kinds))
    is_optional = default(parameter) is None and not parameter["required"]
    return " | ".join(types) + (" | None" if is_optional else "")


def _type(kind: dict[str, Any]) -> str:
    match kind["type"]:
        case "choice":
            return _literal(kind["words"])
        case "choices":
            return f"Sequence[{_literal(kind['words'])}]"
        case "variants":
            return _literal([variant["word"] for variant in kind["variants"]])
        case name:
            return _TYPES[name]


def _literal(words: list[str]) -> str:
    return "Literal[" + ", ".join(json.dumps(word) for word in words) + "]"


def result(step: dict[str, Any]) -> str:
    """What the method of a step gives."""
    if step["stage"] not in ANALYSES or not step["writes"]:
        return "StepReport"
    return "Array" if len(step["writes"]) == 1 else "dict[str, Array]"


def document(step: dict[str, Any], extra: str = "") -> str:
    """The documentation of a step's method."""
    summary = step["summary"][0].upper() + step["summary"][1:]
    lines = [f"{summary}. Source: {step['source']}.", ""]
    if step.get("writes"):
        written = ", ".join(f"`{name}`" + (f" ({unit})" if unit != "1" else "") for name, unit in step["writes"])
        lines += [f"Writes, by default: {written}.", ""]
    lines += [line for parameter in keywords(step["parameters"]) for line in _lines(parameter)]
    return "\n".join(lines).rstrip() + extra


def _lines(parameter: dict[str, Any]) -> list[str]:
    unit = "" if parameter["unit"] == "1" else f" {parameter['unit']}"
    head = f"{method(parameter['name'])}: {parameter['kind_in_words']}{unit}"
    shown = parameter["default_in_words"]
    values = {inner["default_in_words"] for _, inner in parameter.get("each", [])}
    if parameter["required"]:
        head += "; must be given"
    elif len(values) > 1:
        told = [(inner["default_in_words"], word) for word, inner in parameter["each"]]
        head += "; default " + ", ".join(f"{value} ({word})" for value, word in told if value is not None)
    elif shown is not None:
        head += f"; default {shown}"
    if parameter["only"]:
        head += "; for " + ", ".join(parameter["only"])
    return [head, "    " + " ".join(parameter["doc"].split())]

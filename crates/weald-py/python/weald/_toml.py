"""A recipe that is a dictionary, as TOML."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from typing import Any


def text_of(recipe: Mapping[str, Any]) -> str:
    """The recipe as text: keys of its own, `[tables]`, and `[[lists of tables]]`."""
    plain, tables = [], []
    for key, value in recipe.items():
        if isinstance(value, Mapping):
            tables.append(f"[{_key(key)}]\n{_lines(value)}")
        elif _is_tables(value):
            tables.extend(f"[[{_key(key)}]]\n{_lines(table)}" for table in value)
        elif value is not None:
            plain.append(f"{_key(key)} = {value_of(value)}\n")
    return "".join(plain) + "\n".join(tables)


def _is_tables(value: Any) -> bool:
    is_list = isinstance(value, Sequence) and not isinstance(value, (str, bytes))
    return is_list and len(value) > 0 and all(isinstance(item, Mapping) for item in value)


def _lines(table: Mapping[str, Any]) -> str:
    return "".join(f"{_key(key)} = {value_of(value)}\n" for key, value in table.items() if value is not None)


def _key(key: str) -> str:
    is_bare = key != "" and all(letter.isascii() and (letter.isalnum() or letter in "_-") for letter in key)
    return key if is_bare else json.dumps(key)


def value_of(value: Any) -> str:
    """A value in TOML."""
    if hasattr(value, "tolist"):
        value = value.tolist()  # of NumPy
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return repr(value) if math.isfinite(value) else ("nan" if math.isnan(value) else f"{value:+}")
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        # JSON escapes what TOML escapes, and leaves one letter that TOML wants escaped.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        inner = ", ".join(f"{_key(key)} = {value_of(item)}" for key, item in value.items() if item is not None)
        return f"{{ {inner} }}" if inner else "{}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(value_of(item) for item in value) + "]"
    raise TypeError(f"a {type(value).__name__} has no place in a recipe")

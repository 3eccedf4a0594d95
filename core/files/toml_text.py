"""Values as TOML has them, to be read back as they were."""

from __future__ import annotations

import re
from collections.abc import Mapping
from datetime import date, time
from typing import Any

from ..errors import InputError

BARE = re.compile(r"[A-Za-z0-9_-]+")
"""Keys that need no quotes."""
LINE = 100
"""Characters on a line, if they can be divided."""


def key_text(key: str) -> str:
    """One key, dots and all."""
    return key if BARE.fullmatch(key) else string_text(key)


def string_text(text: str) -> str:
    """A string in quotes."""
    return f'"{_escaped(text)}"'


def command_text(text: str) -> str:
    """A command line in quotes, each of its options on a line of its own; it is read back whole."""
    options = _escaped(text).split(" --")
    if len(options) == 1:
        return string_text(text)
    return '"""' + " \\\n    --".join(options) + '"""'


def value_text(value: Any) -> str:
    """Any value on one line.

    Raises:
        InputError: TOML has none like it.
    """
    if isinstance(value, str):
        return string_text(value)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int):
        return repr(value)
    if isinstance(value, float):
        return repr(float(value))  # numpy's own tell their type.
    if isinstance(value, date | time):
        return value.isoformat()
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(value_text, value))}]"
    if isinstance(value, Mapping):
        pairs = (f"{key_text(key)} = {value_text(entry)}" for key, entry in value.items())
        return "{ " + ", ".join(pairs) + " }"
    raise InputError(f"TOML has no value like {value!r}")


def pair_text(key: str, value: Mapping[str, Any]) -> str:
    """``key = { … }``; on a long line, entries of long lists stand below each other."""
    line = f"{key_text(key)} = {value_text(value)}"
    if len(line) <= LINE:
        return line
    pairs = (f"{key_text(name)} = {_spread(entry)}" for name, entry in value.items())
    return f"{key_text(key)} = {{ " + ", ".join(pairs) + " }"


def _spread(value: Any) -> str:
    text = value_text(value)
    if not isinstance(value, list | tuple) or len(value) < 2 or len(text) < LINE // 2:
        return text
    return "[\n" + "".join(f"    {value_text(entry)},\n" for entry in value) + "]"


def _escaped(text: str) -> str:
    marked = text.replace("\\", "\\\\").replace('"', '\\"')
    return "".join(c if c.isprintable() else f"\\U{ord(c):08x}" for c in marked)

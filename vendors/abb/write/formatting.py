"""RAPID's spelling of strings and records, and what it takes for a name.

"RAPID Reference Manual", basic elements.
"""

from __future__ import annotations

from ....core.source.text.names import NameRules
from ..syntax.lexer import KEYWORDS
from ..values.predefined import NAMES
from ..values.records import UNUSED_AXIS, Record
from ..values.types import BUILT_IN
from .numbers import number

MAX_NAME = 32
"""Longest identifier. No text of ABB's that says so was at hand; public generators keep to it."""
NAME_RULES = NameRules(KEYWORDS | NAMES | frozenset(BUILT_IN), MAX_NAME)


def string(value: str) -> str:
    """A ``string``: quotes and backslashes are doubled."""
    return '"' + value.replace("\\", "\\\\").replace('"', '""') + '"'


def literal(value: Record | float | bool | str) -> str:
    """A value of any type: ``[a,b,[c,TRUE]]``."""
    if isinstance(value, tuple):
        return "[" + ",".join(literal(part) for part in value) + "]"
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    if isinstance(value, str):
        return string(value)
    return "9E+09" if value == UNUSED_AXIS else number(value)

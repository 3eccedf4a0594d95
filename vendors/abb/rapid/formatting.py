"""RAPID's spelling of strings, records and names ("RAPID Reference Manual", basic elements)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import count

from .lexer import KEYWORDS
from .literals import UNUSED_AXIS, Record
from .numbers import number
from .predefined import NAMES
from .types import BUILT_IN

MAX_NAME = 32
"""Longest identifier. No text of ABB's that says so was at hand; public generators keep to it."""

_LEGAL = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_OTHER = re.compile(r"[^A-Za-z0-9_]+")


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


class Names:
    """The names that a module has given out; upper and lower case are the same."""

    def __init__(self, *taken: str) -> None:
        self._taken = {name.casefold() for name in taken} | KEYWORDS | NAMES | set(BUILT_IN)

    def claim(self, wanted: str, fallback: str) -> str:
        """``wanted`` if it is legal and free, else a legal and free name near to it.

        Args:
            wanted: any text; what may not stand in a name becomes ``_``.
            fallback: a legal name, taken if nothing of ``wanted`` can stand in a name.
        """
        stem = _OTHER.sub("_", wanted).strip("_") or fallback
        if not _LEGAL.fullmatch(stem):
            stem = f"{fallback}_{stem}"
        return self.first_free(stem[:MAX_NAME], _numbered(stem))

    def first_free(self, *candidates: str | Iterator[str]) -> str:
        """The first of the candidates that is free; it is taken from now on."""
        for candidate in candidates:
            for name in [candidate] if isinstance(candidate, str) else candidate:
                if name.casefold() not in self._taken:
                    self._taken.add(name.casefold())
                    return name
        raise ValueError("no candidate is free")


def _numbered(stem: str) -> Iterator[str]:
    for k in count(2):
        suffix = f"_{k}"
        yield stem[: MAX_NAME - len(suffix)] + suffix

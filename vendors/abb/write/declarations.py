"""The data that a module declares, each value once and under one name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count

from ....core.source.write import declarations
from ....core.source.write.declarations import NewDatum
from ..values.records import Record
from .formatting import literal
from .numbers import number

STORAGE = {
    "tooldata": "PERS",
    "wobjdata": "PERS",
    "loaddata": "PERS",
    "speeddata": "CONST",
    "zonedata": "CONST",
    "jointtarget": "CONST",
    "robtarget": "CONST",
    "triggdata": "VAR",
}
"""data type → how it is declared, in the order in which a module lists them.

"RAPID Reference Manual", tooldata, wobjdata, loaddata: declared as persistent variables.
"""

UNDEFINED = frozenset({"triggdata"})
"""Types without literals."""

FALLBACK = {
    "tooldata": "tool",
    "wobjdata": "wobj",
    "loaddata": "load",
    "speeddata": "v",
    "zonedata": "z",
    "jointtarget": "jp",
    "robtarget": "p",
    "triggdata": "trigg",
}
COUNTED = {"jointtarget": "jp", "robtarget": "p", "triggdata": "trigg"}
"""Targets without a name are numbered in tens, as RobotStudio does it."""


class Declarations(declarations.Declarations):
    """The data of a module."""

    types = tuple(STORAGE)

    def add(self, type_: str, record: Record, wanted: str | None, stem: str = "") -> NewDatum:
        """The datum of this value and name, declared from now on."""
        return self.declare(datum(type_, record, wanted, stem), wanted)

    def add_undefined(self, type_: str, definition: str) -> NewDatum:
        """A datum without an initial value; data of one definition are one."""
        return self.declare(NewDatum(type_, definition, None, "", FALLBACK[type_]), None)

    def numbered(self) -> Mapping[str, Iterator[str]]:
        """``p10``, ``p20``, …"""
        return {type_: _tens(stem) for type_, stem in COUNTED.items()}

    def line(self, datum: NewDatum, name: str) -> str:
        """``CONST robtarget p10 := […];``"""
        initial = "" if datum.type in UNDEFINED else f" := {datum.text}"
        return f"{STORAGE[datum.type]} {datum.type} {name}{initial};"


def datum(type_: str, record: Record, wanted: str | None, stem: str = "") -> NewDatum:
    """A datum; names that differ in upper and lower case only are the same."""
    folded = wanted.casefold() if wanted else None
    return NewDatum(type_, literal(record), folded, stem, FALLBACK[type_])


def _tens(stem: str) -> Iterator[str]:
    return (f"{stem}{10 * k}" for k in count(1))


def sized(letter: str, size: float) -> str:
    """``v`` and 123.4 give ``v123_4``: the way in which predefined data are called."""
    return letter + number(size).replace(".", "_").replace("-", "m").replace("+", "")

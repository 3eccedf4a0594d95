"""The data that a module declares, each value once and under one name."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

from ....core.source.text.names import Names
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


@dataclass(frozen=True, slots=True)
class Datum:
    """A value to be declared.

    Args:
        type: RAPID's data type.
        text: the value's literal; of a triggdata, which has none, what defines it.
        wanted: the name it had, None if it had none.
        stem: what a name is made of if it had none.
    """

    type: str
    text: str
    wanted: str | None
    stem: str

    @classmethod
    def of(cls, type_: str, record: Record, wanted: str | None, stem: str = "") -> Datum:
        """A datum; names that differ in upper and lower case only are the same."""
        return cls(type_, literal(record), wanted.casefold() if wanted else None, stem)


class Declarations:
    """Data in the order of their first use; names are given once all are known.

    Names from the source go first, so that a made-up name never takes one away; a value without a
    name takes that of an equal one.
    """

    def __init__(self) -> None:
        self._spelling: dict[Datum, str | None] = {}

    def add(self, type_: str, record: Record, wanted: str | None, stem: str = "") -> Datum:
        """The datum of this value and name, declared from now on."""
        datum = Datum.of(type_, record, wanted, stem)
        self._spelling.setdefault(datum, wanted)
        return datum

    def add_undefined(self, type_: str, definition: str) -> Datum:
        """A datum without an initial value; data of one definition are one."""
        datum = Datum(type_, definition, None, "")
        self._spelling.setdefault(datum, None)
        return datum

    def names(self, names: Names) -> dict[Datum, str]:
        """A name for every datum."""
        given: dict[Datum, str] = {}
        equal: dict[tuple[str, str], str] = {}
        for datum, wanted in self._spelling.items():
            if wanted:
                given[datum] = names.claim(wanted, FALLBACK[datum.type])
                equal.setdefault((datum.type, datum.text), given[datum])
        counters = {type_: _tens(stem) for type_, stem in COUNTED.items()}
        for datum in self._spelling:
            if datum in given:
                continue
            if (datum.type, datum.text) in equal:
                given[datum] = equal[datum.type, datum.text]
            elif datum.type in counters:
                given[datum] = names.first_free(counters[datum.type])
            else:
                given[datum] = names.claim(datum.stem, FALLBACK[datum.type])
        return given

    def lines(self, names: dict[Datum, str]) -> list[str]:
        """The declarations, by type and then by first use."""
        texts = {names[datum]: datum for datum in self._spelling}
        return [
            f"{storage} {type_} {name}{_initial(datum)};"
            for type_, storage in STORAGE.items()
            for name, datum in texts.items()
            if datum.type == type_
        ]


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


def _initial(datum: Datum) -> str:
    return "" if datum.type in UNDEFINED else f" := {datum.text}"


def _tens(stem: str) -> Iterator[str]:
    return (f"{stem}{10 * k}" for k in count(1))


def sized(letter: str, size: float) -> str:
    """``v`` and 123.4 give ``v123_4``: the way in which predefined data are called."""
    return letter + number(size).replace(".", "_").replace("-", "m").replace("+", "")

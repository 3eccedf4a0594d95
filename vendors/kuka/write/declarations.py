"""The data that a program's ``.dat`` declares, each value once and under one name."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import count

from ....core.source.text.names import Names

TYPES = {"FRAME": "FRAME1", "LOAD": "LOAD1", "E6AXIS": "XP", "E6POS": "XP"}
"""data type → beginning of the names of data that have none, in the order of the data list."""
_COUNTED = ("E6AXIS", "E6POS")


@dataclass(frozen=True, slots=True)
class Datum:
    """A value to be declared.

    Args:
        type: KRL's data type.
        text: the value's aggregate.
        wanted: the name it had, in lower case; None if it had none.
        stem: what a name is made of if it had none.
    """

    type: str
    text: str
    wanted: str | None
    stem: str


class DataList:
    """Collects data in the order of their first use."""

    def __init__(self) -> None:
        self._spelling: dict[Datum, str | None] = {}

    def add(self, type_: str, text: str, wanted: str | None, stem: str = "") -> Datum:
        """The datum of this value and name, declared from now on."""
        folded = None if wanted is None else wanted.casefold()
        datum = Datum(type_, text, folded, stem or TYPES[type_])
        self._spelling.setdefault(datum, wanted)
        return datum

    def names(self, names: Names) -> dict[Datum, str]:
        """A name for every datum; data without one share that of a datum with the same value."""
        given: dict[Datum, str] = {}
        equal: dict[tuple[str, str], str] = {}
        for datum, wanted in self._spelling.items():
            if wanted:
                given[datum] = names.claim(wanted, datum.stem)
                equal.setdefault((datum.type, datum.text), given[datum])
        points = _points()
        for datum in self._spelling:
            if datum in given:
                continue
            if (datum.type, datum.text) in equal:
                given[datum] = equal[datum.type, datum.text]
            elif datum.type in _COUNTED:
                given[datum] = names.first_free(points)
            else:
                given[datum] = names.claim(datum.stem, datum.stem)
        return given

    def lines(self, names: dict[Datum, str]) -> list[str]:
        """The declarations, by type and then by first use."""
        texts = {names[datum]: datum for datum in self._spelling}
        return [
            f"DECL {type_} {name}={datum.text}"
            for type_ in TYPES
            for name, datum in texts.items()
            if datum.type == type_
        ]


def _points() -> Iterator[str]:
    """``XP1``, ``XP2``, …: what inline forms call their points."""
    return (f"XP{k}" for k in count(1))

"""The data that a program's ``.dat`` declares, each value once and under one name."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import count

from ....core.source.write import declarations
from ....core.source.write.declarations import NewDatum

TYPES = {"FRAME": "FRAME1", "LOAD": "LOAD1", "E6AXIS": "XP", "E6POS": "XP"}
"""data type → beginning of the names of data that have none, in the order of the data list."""


class DataList(declarations.Declarations):
    """Collects data in the order of their first use."""

    types = tuple(TYPES)

    def add(self, type_: str, text: str, wanted: str | None, stem: str = "") -> NewDatum:
        """The datum of this value and name, declared from now on."""
        folded = None if wanted is None else wanted.casefold()
        stem = stem or TYPES[type_]
        return self.declare(NewDatum(type_, text, folded, stem, stem), wanted)

    def numbered(self) -> Mapping[str, Iterator[str]]:
        """``XP1``, ``XP2``, …: what inline forms call their points."""
        return dict.fromkeys(("E6AXIS", "E6POS"), (f"XP{k}" for k in count(1)))

    def line(self, datum: NewDatum, name: str) -> str:
        """``DECL E6POS XP1={…}``"""
        return f"DECL {datum.type} {name}={datum.text}"

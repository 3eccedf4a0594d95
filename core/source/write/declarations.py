"""Data that a written program declares: each value once and under one name."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import ClassVar

from ..text.names import Names


@dataclass(frozen=True, slots=True)
class NewDatum:
    """A value to be declared.

    Args:
        type: the language's data type.
        text: the value's literal; of a type without literals what defines the datum.
        wanted: the name it had, folded; None if it had none.
        stem: what a name is made of if it had none.
        fallback: a legal name, for names of which nothing can be kept.
    """

    type: str
    text: str
    wanted: str | None
    stem: str
    fallback: str


class Declarations(ABC):
    """Data in the order of their first use; names are given once all are known.

    Names from the source go first, so that a made-up name never takes one away; a value without a
    name takes that of an equal one.
    """

    types: ClassVar[tuple[str, ...]]
    """Data types in the order in which they are declared."""

    def __init__(self) -> None:
        self._spelling: dict[NewDatum, str | None] = {}

    @abstractmethod
    def numbered(self) -> Mapping[str, Iterator[str]]:
        """Data type → names for the data that have none, for types that are numbered."""

    @abstractmethod
    def line(self, datum: NewDatum, name: str) -> str:
        """A declaration."""

    def declare(self, datum: NewDatum, wanted: str | None) -> NewDatum:
        """Declare a datum from now on.

        Args:
            wanted: its name as it was spelled.
        """
        self._spelling.setdefault(datum, wanted)
        return datum

    def names(self, names: Names) -> dict[NewDatum, str]:
        """A name for every datum."""
        given: dict[NewDatum, str] = {}
        equal: dict[tuple[str, str], str] = {}
        for datum, wanted in self._spelling.items():
            if wanted:
                given[datum] = names.claim(wanted, datum.fallback)
                equal.setdefault((datum.type, datum.text), given[datum])
        numbered = self.numbered()
        for datum in self._spelling:
            if datum in given:
                continue
            if (datum.type, datum.text) in equal:
                given[datum] = equal[datum.type, datum.text]
            elif datum.type in numbered:
                given[datum] = names.first_free(numbered[datum.type])
            else:
                given[datum] = names.claim(datum.stem, datum.fallback)
        return given

    def lines(self, names: dict[NewDatum, str]) -> list[str]:
        """The declarations, by type and then by first use."""
        texts = {names[datum]: datum for datum in self._spelling}
        return [
            self.line(datum, name)
            for type_ in self.types
            for name, datum in texts.items()
            if datum.type == type_
        ]

"""Loops and routines of KRL: ``FOR``, ``LOOP``, ``DEF`` without parameters in the same file."""

from __future__ import annotations

from ....core.source.text.names import Names
from ....core.source.write import structure
from ..syntax.names import NAME_RULES
from .instructions import Line


class Structure(structure.Structure[Line]):
    """Writes them.

    Args:
        taken: names that routines may not have.
    """

    held: dict[str, Line]
    """Settings by the variable that they set."""

    def __init__(self, *taken: str) -> None:
        super().__init__(Names(NAME_RULES, taken), {})

    def nothing_known(self) -> dict[str, Line]:
        """See `core.source.write.structure.Structure`."""
        return {}

    def counted(self, body: list[Line], count: int, counter: str) -> list[Line]:
        """``FOR I=1 TO 3 … ENDFOR``"""
        return [(f"FOR {counter}=1 TO {count}",), *_indented(body), ("ENDFOR",)]

    def endless(self, body: list[Line]) -> list[Line]:
        """``LOOP … ENDLOOP``"""
        return [("LOOP",), *_indented(body), ("ENDLOOP",)]

    def call(self, name: str) -> Line:
        """``PICK( )``"""
        return (f"{name}( )",)

    def declared(self, routine: str = "") -> list[str]:
        """``DECL INT I``, where a routine begins."""
        return [f"DECL INT {counter}" for counter in self.counters[routine]]


def _indented(lines: list[Line]) -> list[Line]:
    return [("  ", *line) for line in lines]

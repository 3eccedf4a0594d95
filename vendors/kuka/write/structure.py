"""Loops and routines of KRL: ``FOR``, ``LOOP``, ``DEF`` whose parameters are targets."""

from __future__ import annotations

from collections.abc import Sequence

from ....core.program.places import Argument, Destination
from ....core.program.target import PoseTarget
from ....core.program.tool import WorkObject
from ....core.source.text.names import Names
from ....core.source.write import structure
from ....core.source.write.declarations import NewDatum
from ....core.source.write.structure import argument, summed
from ..syntax.names import NAME_RULES
from .formatting import MM
from .instructions import Line, Phrases
from .numbers import number

Operand = str | NewDatum
_COMPUTED = "flyby_x{}"
"""What positions are called that are put together."""


class Structure(structure.Structure[Line]):
    """Writes them.

    Args:
        phrases: of the program.
        taken: names that routines may not have.
    """

    held: dict[str, Line]
    """Settings by the variable that they set."""

    def __init__(self, phrases: Phrases, *taken: str) -> None:
        super().__init__(Names(NAME_RULES, taken), {})
        self._phrases = phrases
        self._computed: dict[str, list[str]] = {}

    def nothing_known(self) -> dict[str, Line]:
        """See `core.source.write.structure.Structure`."""
        return {}

    def counted(self, body: list[Line], count: int, counter: str) -> list[Line]:
        """``FOR I=1 TO 3 … ENDFOR``"""
        return [(f"FOR {counter}=1 TO {count}",), *_indented(body), ("ENDFOR",)]

    def endless(self, body: list[Line]) -> list[Line]:
        """``LOOP … ENDLOOP``"""
        return [("LOOP",), *_indented(body), ("ENDLOOP",)]

    def call(
        self, name: str, arguments: Sequence[Destination], frames: Sequence[WorkObject]
    ) -> list[Line]:
        """``PICK( )``, ``PICK(XP1)``; a position that is computed is put together before."""
        ahead: list[Line] = []
        given: list[Operand] = []
        for number_, place in enumerate(arguments):
            lines, operand = self.placed(place, number_)
            ahead += lines
            given += [",", operand]
        return [*ahead, (f"{name}(", *(given[1:] or [" "]), ")")]

    def placed(
        self, place: Destination, number_: int, passed: bool = False
    ) -> tuple[list[Line], Operand]:
        """A position or axis values, and the lines that put it together.

        Args:
            number_: of the place among those of its statement.
            passed: whether its S and T do not count.
        """
        base = self._base(place, passed)
        if place.plain:
            return [], base
        name = _COMPUTED.format(number_ + 1)
        known = self._computed.setdefault(self._inside, [])
        if name not in known:
            known.append(name)
        lines: list[Line] = [(f"{name}=", base)]
        for axis, terms in zip("XYZ", self.stretches(place, 1), strict=True):
            if terms:
                by = f"{name}.{axis}+{summed(terms, _millimetres)}".replace("+-", "-")
                lines.append((f"{name}.{axis}={by}",))
        return lines, name

    def _base(self, place: Destination, passed: bool) -> Operand:
        if isinstance(place.base, Argument):
            return argument(place.base.number)
        base = place.base
        if isinstance(base, PoseTarget) and (passed or base.configuration is None):
            return self._phrases.passed(base)
        return self._phrases.point(base)

    def head(self, name: str) -> list[str]:
        """``DEF PICK(FLYBY_P1:IN)`` and what it declares."""
        kinds = self.arguments[name]
        given = ",".join(f"{argument(k)}:IN" for k in range(len(kinds)))
        declared = [
            f"DECL {'E6AXIS' if joints else 'E6POS'} {argument(k)}"
            for k, joints in enumerate(kinds)
        ]
        return [f"DEF {name}({given or ' '})", *declared, *self.declared(name)]

    def declared(self, routine: str = "") -> list[str]:
        """``DECL INT I``, where a routine begins."""
        counters = [f"DECL INT {counter}" for counter in self.counters[routine]]
        return [*counters, *(f"DECL E6POS {name}" for name in self._computed.get(routine, ()))]

    @property
    def taken(self) -> list[str]:
        """See `core.source.write.structure.Structure`."""
        return [*super().taken, *(name for names in self._computed.values() for name in names)]


def _millimetres(metres: float) -> str:
    return number(metres / MM)


def _indented(lines: list[Line]) -> list[Line]:
    return [("  ", *line) for line in lines]

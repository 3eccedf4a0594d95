"""The targets of a routine: which are its own, and which it is given."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from .move import Move, MoveJ, Statement
from .places import (
    Argument,
    Destination,
    Slot,
    between,
    constant,
    near,
    rounded,
    stated,
    turned_alike,
)
from .target import JointTarget, PoseTarget


@dataclass
class RoutinePlaces:
    """What the targets of a routine are made of.

    Args:
        rows: of each call, its targets in the order of the routine's text.
        rests: of the first call, the statement that each belongs to, without its targets.

    Attributes:
        chosen: numbers of the targets that become arguments, in their order.
        places: of each target: its own, an argument, or at a stretch from an argument.
    """

    rows: Sequence[Sequence[Slot]]
    rests: Sequence[Statement]
    chosen: list[int] = field(init=False)
    places: list[Destination] = field(init=False)

    def __post_init__(self) -> None:
        columns = list(zip(*self.rows, strict=True))
        varying = [k for k, column in enumerate(columns) if not constant(column)]

        def rank(k: int) -> tuple[bool, int]:
            # A target that states its configuration does for lines, which need none. Who wrote
            # the program gave a name to what the routine is about.
            first = columns[k][0].target
            bare = isinstance(first, PoseTarget) and stated(first) is None
            return bare, -sum(slot.target.name is not None for slot in columns[k])

        order = sorted(varying, key=rank)
        chosen: list[int] = []
        shifts: dict[int, tuple[int, Destination]] = {}
        for k in order:
            base = next((q for q in chosen if self._stretch(columns, q, k) is not None), None)
            if base is None:
                chosen.append(k)
            else:
                stretch = self._stretch(columns, base, k)
                assert stretch is not None
                shifts[k] = base, Destination(Argument(0), stretch)
        self.chosen = sorted(chosen)
        self.places = [self._place(k, columns[k][0], shifts) for k in range(len(columns))]

    def _place(self, k: int, slot: Slot, shifts: dict[int, tuple[int, Destination]]) -> Destination:
        if k in shifts:
            base, shift = shifts[k]
            return Destination(Argument(self.chosen.index(base)), shift.offset)
        if k in self.chosen:
            joints = isinstance(slot.target, JointTarget)
            return Destination(Argument(self.chosen.index(k), joints))
        return slot.own

    def _stretch(
        self, columns: Sequence[Sequence[Slot]], base: int, k: int
    ) -> tuple[float, float, float] | None:
        """From one target to another, if it is the same in all calls; None if it is not."""
        one, other = self.rests[base], self.rests[k]
        if not isinstance(one, Move) or not isinstance(other, Move):
            return None
        pairs = [(a.target, b.target) for a, b in zip(columns[base], columns[k], strict=True)]
        line = not isinstance(other, MoveJ)
        alike = all(turned_alike(*pair, unstated=line) for pair in pairs)
        if one.work_object != other.work_object or not alike:
            return None
        first = between(*pairs[0])
        return rounded(first) if all(near(first, between(*pair)) for pair in pairs) else None

"""What the moves of a program read from its text: as it is, and as it shall become."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from enum import StrEnum

from ...errors import MotionError, Span
from ...program.move import Move
from ...program.origin import Origin
from ...program.program import Program
from ...program.speed import Speed
from ...program.target import Target
from ...program.zone import Zone
from .edits import alike, changed_moves

MovePart = Target | Speed | Zone

OtherChange = Callable[[Move, Move], str | None]
"""What of an old and a new move of one kind differs that the literals of their parts do not say."""


class UseKind(StrEnum):
    """The parts of a move that have a place in the text."""

    TARGET = "target"
    VIA = "via"
    SPEED = "speed"
    ZONE = "zone"


@dataclass(frozen=True, slots=True)
class Use:
    """A part of a move.

    Args:
        old: its value in the text.
        new: the value that it shall have.
    """

    index: int
    kind: UseKind
    statement: Span
    origin: Origin
    old: MovePart
    new: MovePart
    move: Move

    @property
    def changes(self) -> bool:
        """Whether the value is to become another one."""
        return self.old != self.new and not alike(self.old, self.new)

    def error(self, message: str) -> MotionError:
        """An error that names move, part and place."""
        return MotionError(f"{self.kind}: {message}", self.index, self.origin.span)


def uses(before: Program, after: Program, other_change: OtherChange) -> list[Use]:
    """All parts of all moves.

    Args:
        before: as its reader made it.
        after: the same, changed.
        other_change: what the language cannot change at the move, beside what none can.

    Raises:
        InputError: statements were added, removed or put in another order.
        MotionError: something else than targets, speeds and zones has changed.
    """
    for index, old, new in changed_moves(before, after):
        what = _rest(old, new) or other_change(old, new)
        if what is not None:
            raise MotionError(
                f"its {what} has changed, but a patch changes targets, speeds and zones only: "
                "write the program as new files",
                index,
                None if old.origin is None else old.origin.statement,
            )
    pairs = zip(before.moves, after.moves, strict=True)
    return [use for i, (old, new) in enumerate(pairs) for use in _uses_of(i, old, new)]


def _uses_of(index: int, old: Move, new: Move) -> Iterator[Use]:
    origin = old.origin
    assert origin is not None  # the reader gives every move one
    for kind in UseKind:
        at: Origin | None = getattr(origin, kind)
        if at is not None:
            parts = getattr(old, kind), getattr(new, kind)
            yield Use(index, kind, origin.statement, at, *parts, new)


def _rest(old: Move, new: Move) -> str | None:
    """What differs beside the parts that have a place in the text."""
    for field in fields(old):
        if field.name in {"origin", *UseKind}:
            continue
        if not alike(getattr(old, field.name), getattr(new, field.name)):
            return field.name.replace("_", " ")
    return None

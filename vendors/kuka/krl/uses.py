"""What the moves of a program read from its text: as it is, and as it shall become."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields
from enum import StrEnum

from ....core.errors import MotionError, Span
from ....core.program.move import Move
from ....core.program.origin import MoveOrigin, Origin
from ....core.program.program import Program
from ....core.program.speed import Speed
from ....core.program.target import Target
from ....core.program.zone import Zone
from ....core.source.patching import alike, changed_moves

Part = Target | Speed | Zone


class Kind(StrEnum):
    """The parts of a move that have a place in the text."""

    TARGET = "target"
    VIA = "via"
    SPEED = "speed"
    ZONE = "zone"


@dataclass(frozen=True, slots=True)
class Use:
    """A part of a move.

    Args:
        index: of the move.
        kind: which part.
        statement: span of the motion instruction.
        origin: of the part.
        old: its value in the text.
        new: the value that it shall have.
        move: as it shall become.
    """

    index: int
    kind: Kind
    statement: Span
    origin: Origin
    old: Part
    new: Part
    move: Move

    @property
    def changes(self) -> bool:
        """Whether the value is to become another one."""
        return self.old != self.new and not alike(self.old, self.new)

    def error(self, message: str) -> MotionError:
        """An error that names move, part and place."""
        return MotionError(f"{self.kind}: {message}", self.index, self.origin.span)


def uses(before: Program, after: Program) -> list[Use]:
    """All parts of all moves.

    Raises:
        FlybyError: something else than targets, speeds and zones has changed.
    """
    for index, old, new in changed_moves(before, after):
        _check_rest(index, old, new)
    pairs = zip(before.moves, after.moves, strict=True)
    return [use for i, (old, new) in enumerate(pairs) for use in _uses_of(i, old, new)]


def _uses_of(index: int, old: Move, new: Move) -> Iterator[Use]:
    origin = old.origin
    assert origin is not None  # the reader gives every move one
    for kind in Kind:
        at: Origin | None = getattr(origin, kind)
        if at is not None:
            parts = getattr(old, kind), getattr(new, kind)
            yield Use(index, kind, origin.statement, at, *parts, new)


def _check_rest(index: int, old: Move, new: Move) -> None:
    if type(old) is not type(new):
        raise _elsewhere(index, old.origin, f"{type(old).__name__} → {type(new).__name__}")
    for field in fields(old):
        if field.name in {"origin", *Kind}:
            continue
        if not alike(getattr(old, field.name), getattr(new, field.name)):
            raise _elsewhere(index, old.origin, field.name.replace("_", " "))
    if type(old.target) is not type(new.target):
        raise _elsewhere(index, old.origin, "kind of target")


def _elsewhere(index: int, origin: MoveOrigin | None, what: str) -> MotionError:
    return MotionError(
        f"its {what} has changed, but a patch changes targets, speeds and zones only: write the "
        "program as new files",
        index,
        None if origin is None else origin.statement,
    )

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
from ....core.source.patching import alike, changed_moves
from .leaves import Part


class Kind(StrEnum):
    """The parts of a move that have a place in the text."""

    TARGET = "target"
    VIA = "via"
    SPEED = "speed"
    ZONE = "zone"


_LABELS = ("name", "origin")
_SETTINGS = ("tcp_acceleration", "joint_acceleration_fraction", "jerk_fraction")
"""Parts of a speed that instructions of their own set (AccSet, PathAccLim)."""


@dataclass(frozen=True, slots=True)
class Use:
    """A part of a move.

    Args:
        move: index.
        kind: which part.
        statement: span of the move instruction.
        origin: of the part.
        old: its value in the text.
        new: the value that it shall have.
    """

    move: int
    kind: Kind
    statement: Span
    origin: Origin
    old: Part
    new: Part

    @property
    def changes(self) -> bool:
        """Whether the value is to become another one."""
        return self.old != self.new and not alike(self.old, self.new)

    def error(self, message: str) -> MotionError:
        """An error that names move, part and place."""
        return MotionError(f"{self.kind}: {message}", self.move, self.origin.span)


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
            yield Use(index, kind, origin.statement, at, getattr(old, kind), getattr(new, kind))


def _check_rest(index: int, old: Move, new: Move) -> None:
    if type(old) is not type(new):
        raise _elsewhere(index, old.origin, f"{type(old).__name__} → {type(new).__name__}")
    parts = {*_LABELS, *Kind}
    for field in fields(old):
        if field.name in parts:
            continue
        if not alike(getattr(old, field.name), getattr(new, field.name)):
            raise _elsewhere(index, old.origin, field.name.replace("_", " "))
    for name in _SETTINGS:
        if not alike(_setting(old.speed, name), _setting(new.speed, name)):
            raise _elsewhere(index, old.origin, f"speed ({name.replace('_', ' ')})")


def _setting(speed: Speed, name: str) -> object:
    return getattr(speed, name)


def _elsewhere(index: int, origin: MoveOrigin | None, what: str) -> MotionError:
    return MotionError(
        f"its {what} has changed, but a patch changes targets, speeds and zones only: write the "
        "program as a new module",
        index,
        origin.statement if origin is not None else None,
    )

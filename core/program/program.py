"""A program: statements in order."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

from ..errors import Note
from .move import Move, MoveC, MoveJ, MoveL, Statement
from .target import JointTarget

if TYPE_CHECKING:
    from ..robot.model import Robot


class ReadFrom(Protocol):
    """How a program was read: `flyby.core.source.reading.Reading` says all of it."""

    @property
    def main(self) -> str:
        """Name of the source file with the entry."""
        ...


class DrivenBy(Protocol):
    """What drives a program: `flyby.tasks.setup.Setup` says all of it."""

    @property
    def robot(self) -> Robot:
        """Where it stands."""
        ...


@dataclass(frozen=True, repr=False)
class Program:
    """An immutable sequence of statements.

    Args:
        statements: moves, waits and opaque statements in the order of execution.
        name: of the program or module.
        start: joint values before the first move, if the source states them.
        notes: what the reader has to say about the source; not part of the value.
        reading: the source files, for the patcher; None if it was not read; not part of the value.
        setup: the robot that it was read for, for tasks that name no other; not part
            of the value.
    """

    statements: tuple[Statement, ...]
    name: str = "main"
    start: JointTarget | None = None
    notes: tuple[Note, ...] = field(default=(), compare=False)
    reading: ReadFrom | None = field(default=None, compare=False, repr=False)
    setup: DrivenBy | None = field(default=None, compare=False, repr=False)

    def __repr__(self) -> str:
        robot = "" if self.setup is None else f" for {self.setup.robot.name}"
        return f"<Program {self.name}{robot}: {len(self.moves)} moves, {len(self.notes)} notes>"

    @cached_property
    def moves(self) -> tuple[Move, ...]:
        """The moves alone; a move's index in messages and results is its place here."""
        return tuple(s for s in self.statements if isinstance(s, MoveJ | MoveL | MoveC))

    def with_moves(self, moves: tuple[Move, ...]) -> Program:
        """The same program with each move replaced by the one at its index in ``moves``.

        Raises:
            ValueError: ``moves`` has another length than the program's own moves.
        """
        if len(moves) != len(self.moves):
            raise ValueError(f"{len(self.moves)} moves to replace, {len(moves)} given")
        queue = iter(moves)
        statements = tuple(
            next(queue) if isinstance(s, MoveJ | MoveL | MoveC) else s for s in self.statements
        )
        return replace(self, statements=statements)

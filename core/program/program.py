"""A program: statements in order."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

from ..display import counted, in_line
from ..errors import Note
from ..notebook import PictureCurve, page, picture, table
from .call import Call
from .cycle import Cycle
from .entry_point import EntryPoint
from .move import Move, MoveC, MoveJ, MoveL, Statement
from .question import Question
from .section import Section
from .target import JointTarget
from .zone import zone_shown

if TYPE_CHECKING:
    from ..arrays import FloatArray
    from ..robot.model import Robot

COLUMNS = (
    ("#", "right"),
    ("move", "left"),
    ("target", "left"),
    ("speed", "left"),
    ("zone", "left"),
    ("tool", "left"),
    ("line", "right"),
)
"""Of a program's moves."""


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
        questions: what the source asks that no file says; not part of the value.
        entries: routines that it may begin with, where that was asked or it drives nothing; not
            part of the value.
        calls: of its own routines, in their order; not part of the value.
        cycle: the last pass of the loop that production runs in, if there is one; not part of the
            value.
        sections: which statements come from which routine or loop of the source, in the order in
            which these begin; not part of the value.
        reading: the source files, for the patcher; None if it was not read; not part of the value.
        setup: the robot that it was read for, for tasks that name no other; not part
            of the value.
        placed: names of tools and work objects that nobody knows, and that were put to where the
            robot drives the program.
    """

    statements: tuple[Statement, ...]
    name: str = "main"
    start: JointTarget | None = None
    notes: tuple[Note, ...] = field(default=(), compare=False)
    questions: tuple[Question, ...] = field(default=(), compare=False, repr=False)
    entries: tuple[EntryPoint, ...] = field(default=(), compare=False, repr=False)
    calls: tuple[Call, ...] = field(default=(), compare=False, repr=False)
    cycle: Cycle | None = field(default=None, compare=False, repr=False)
    sections: tuple[Section, ...] = field(default=(), compare=False, repr=False)
    reading: ReadFrom | None = field(default=None, compare=False, repr=False)
    setup: DrivenBy | None = field(default=None, compare=False, repr=False)
    placed: tuple[str, ...] = field(default=(), repr=False)

    def __repr__(self) -> str:
        robot = "" if self.setup is None else f" for {self.setup.robot.name}"
        told = f"{counted(self.moves, 'move')}, {counted(self.notes, 'note')}"
        return in_line(f"Program {self.name}{robot}: {told}")

    def _repr_html_(self) -> str:
        points = self.waypoints()
        drawn = "" if points is None else picture([PictureCurve("waypoints", points, points)])
        rows = [(str(k), *_cells(move)) for k, move in enumerate(self.moves, 1)]
        return page(repr(self)[1:-1], table(COLUMNS, rows), drawn, notes=self.notes)

    def waypoints(self) -> FloatArray | None:
        """(M, 3) m in the world, where moves end; None where the robot or a frame is not known."""
        import numpy as np

        if self.setup is None or len(self.moves) < 2:
            return None
        robot, found = self.setup.robot, []
        for move in self.moves:
            target = move.target
            if isinstance(target, JointTarget):
                flange = robot.flange_pose(np.array([*target.joints, *target.external]))
                pose = flange @ move.tool.tcp if move.tool.robot_held else flange
            elif move.work_object.moved_by is not None or move.work_object.robot_held:
                return None
            else:
                pose = move.work_object.pose @ target.pose
            found.append(pose.position)
        return np.array(found)

    @cached_property
    def moves(self) -> tuple[Move, ...]:
        """The moves alone; a move's index in messages and results is its place here."""
        return tuple(s for s in self.statements if isinstance(s, MoveJ | MoveL | MoveC))

    def between(self, first: int, stop: int) -> Program:
        """The program of the moves from index ``first`` to before ``stop``, with what is between.

        What stands before the first of them belongs to it, what stands behind the last as well.
        Where it does not begin as the whole it has neither its start, its notes nor its calls.
        It has no sections.
        """
        kept: list[Statement] = []
        count = 0
        for statement in self.statements:
            moves = isinstance(statement, MoveJ | MoveL | MoveC)
            if moves and count == stop:
                break
            count += moves
            if count > first or (count == first and not moves):
                kept.append(statement)
        if first == 0:
            return replace(self, statements=tuple(kept), sections=())
        return replace(self, statements=tuple(kept), start=None, notes=(), calls=(), sections=())

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


def _cells(move: Move) -> tuple[str, ...]:
    """A move in the units of the shop floor."""
    target, speed = move.target, move.speed
    if target.name is not None or isinstance(target, JointTarget):
        at = target.name or "joint values"
    else:
        at = ", ".join(f"{1e3 * value:.1f}" for value in target.pose.position) + " mm"
    fast = speed.name or ("" if speed.tcp is None else f"{1e3 * speed.tcp:.4g} mm/s")
    line = "" if move.origin is None else str(move.origin.statement.line)
    return move.kind, at, fast, zone_shown(move.zone), move.tool.name, line

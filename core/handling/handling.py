"""Which parts a program carries on each move, and where all others lie.

The program's targets say where parts are taken and released, so that nothing has to be driven:
what is carried belongs to the dynamics and to the shape of what is driven.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

from ..cell.cell import Cell
from ..cell.workpiece import Workpiece
from ..errors import Note
from ..program.move import Move
from ..program.program import Program
from ..program.target import JointTarget
from ..spatial.pose import Pose, Vector3
from .arrangement import Arrangement, PlacedPart, at_first, distance_to_box
from .cues import Cue, in_order
from .flange import FlangeFollower

_SAME = 1e-6
"""m, and of quaternions, within which the flange has not moved."""


class ChangeOfHands(NamedTuple):
    """A part that is taken or released.

    Args:
        name: of the part.
        taken: whether it is taken.
        move: index of the move before; -1 before the first.
        statement: index of the statement of the program that does it.
    """

    name: str
    taken: bool
    move: int
    statement: int


@dataclass(frozen=True)
class Handling:
    """What a program does to the parts of its cell.

    Args:
        arrangements: where all parts are, one entry for each move of the program.
        before, behind: names of the parts that are taken or released where the move begins, and
            where it ends, likewise.
        notes: what the user should know.
        start: where the robot stands before the first move; None if nobody knows.
        changes: what is taken and released, in turn.
        last: where all parts are behind the last move.
    """

    arrangements: tuple[Arrangement, ...]
    before: tuple[frozenset[str], ...]
    behind: tuple[frozenset[str], ...]
    notes: tuple[Note, ...]
    start: JointTarget | None = None
    changes: tuple[ChangeOfHands, ...] = ()
    last: Arrangement = ()

    @property
    def targets(self) -> tuple[int, ...]:
        """Indices of the moves at whose targets parts are taken or released."""
        return tuple(i for i, names in enumerate(self.behind) if names)

    def held(self, move: int) -> Arrangement:
        """What the flange carries along a move."""
        return tuple(placed for placed in self.arrangements[move] if placed.held)


def handling_of(program: Program, cell: Cell, start: JointTarget | None = None) -> Handling:
    """Follow the parts of a cell through a program.

    Args:
        program: as it was read.
        cell: with the robot where it stands.
        start: where the robot stands before the first move; None for the program's own start.

    Raises:
        InputError: a statement both takes a part and lets go of it, or a mesh cannot be used.
    """
    return _Trace(cell, len(program.moves), start or program.start).through(program)


class _Trace:
    """One pass through a program."""

    def __init__(self, cell: Cell, moves: int, start: JointTarget | None) -> None:
        self._cell = cell
        self._start = start
        self._flange = FlangeFollower(cell.robot, start)
        self._now: Arrangement = at_first(cell.parts)
        self._boxes: dict[str, tuple[Vector3, Vector3]] = {}
        self._taken_at: dict[str, Vector3] = {}
        self._before: list[set[str]] = [set() for _ in range(moves)]
        self._behind: list[set[str]] = [set() for _ in range(moves)]
        self._stays: list[bool] = []
        self._fresh: set[str] = set()
        self._notes: list[Note] = []
        self._met: set[tuple[str, str]] = set()
        self._changes: list[ChangeOfHands] = []

    def through(self, program: Program) -> Handling:
        arrangements = []
        for step in in_order(program, self._cell.parts):
            if isinstance(step, Cue):
                for part in step.release:
                    self._release(part, step)
                for part in step.attach:
                    self._attach(part, step)
            else:
                arrangements.append(self._now)
                self._drive(step)
        for part in self._cell.parts:
            self._check_met(part)
        before, behind = (tuple(map(frozenset, sets)) for sets in (self._before, self._behind))
        notes = tuple(dict.fromkeys(self._notes))
        return Handling(
            tuple(arrangements),
            before,
            behind,
            notes,
            self._start,
            tuple(self._changes),
            self._now,
        )

    def _drive(self, move: Move) -> None:
        """Follow a move; what was handled before one that goes nowhere is so before the next."""
        came_from = self._flange.flange
        self._flange.moved(move)
        self._before[len(self._stays)] |= self._fresh
        self._stays.append(_alike(came_from, self._flange.flange))
        if not self._stays[-1]:
            self._fresh.clear()

    def _attach(self, part: Workpiece, cue: Cue) -> None:
        self._met.add(("attach", part.name))
        flange, tcp = self._flange.flange, self._flange.tcp
        if flange is None or tcp is None:
            self._note(cue, f"attaches {part.name!r}, but nobody knows where the robot stands")
            return
        if self._taken_at.get(part.name) == tcp:
            return  # said once more where it was taken
        lying = [
            placed
            for placed in self._now
            if placed.part is part and not placed.held and not placed.gone
        ]
        if not lying:
            self._note(cue, f"attaches {part.name!r}, but none is left to take")
            return
        far, _, nearest = min((self._distance(p, tcp), k, p) for k, p in enumerate(lying))
        if far > part.near:
            self._note(
                cue,
                f"attaches {part.name!r}, but none is near: the TCP is {1e3 * far:.0f} mm "
                f"away from {nearest.name}, {1e3 * part.near:g} mm are allowed (near_mm)",
            )
            return
        pose = flange.inverse() @ self._flange.frame(nearest.carrier) @ nearest.pose
        self._put(nearest, replace(nearest, pose=pose, held=True, carrier=None), cue)
        self._taken_at[part.name] = tcp

    def _release(self, part: Workpiece, cue: Cue) -> None:
        self._met.add(("release", part.name))
        held = [placed for placed in self._now if placed.part is part and placed.held]
        if not held:
            # Before anything is taken programs open their grippers to begin with.
            if ("attach", part.name) in self._met:
                self._note(cue, f"releases {part.name!r}, but none is held")
            return
        self._taken_at.pop(part.name, None)
        flange = self._flange.flange
        if flange is None:
            self._note(
                cue,
                f"releases {part.name!r}, but nobody knows where the robot stands: it stays on the "
                "tool",
            )
            return
        for placed in held:
            pose = self._flange.frame(part.released_on).inverse() @ flange @ placed.pose
            there = replace(
                placed, pose=pose, held=False, carrier=part.released_on, gone=part.leaves
            )
            self._put(placed, there, cue)

    def _distance(self, placed: PlacedPart, tcp: Vector3) -> float:
        if placed.part.name not in self._boxes:
            self._boxes[placed.part.name] = placed.part.geometry.box
        place = self._flange.frame(placed.carrier) @ placed.pose
        return distance_to_box(tcp, place, self._boxes[placed.part.name])

    def _put(self, before: PlacedPart, after: PlacedPart, cue: Cue) -> None:
        move = len(self._stays) - 1
        self._changes.append(ChangeOfHands(after.name, after.held, move, cue.statement))
        self._now = tuple(after if placed is before else placed for placed in self._now)
        self._fresh.add(after.name)
        for move in reversed(range(len(self._stays))):
            self._behind[move].add(after.name)
            if not self._stays[move]:
                break

    def _note(self, cue: Cue, message: str) -> None:
        self._notes.append(Note(f"{cue.text!r} {message}", span=cue.span))

    def _check_met(self, part: Workpiece) -> None:
        """Say which of a part's statements did not come up."""
        where = "" if self._cell.file is None else f"{self._cell.file}: "
        for word, names, left in (
            ("attach", part.attach, "it lies where it is"),
            ("release", part.release, "it stays on the tool"),
        ):
            taken = word == "attach" or ("attach", part.name) in self._met
            if (word, part.name) not in self._met and taken:
                shown = " or ".join(map(repr, names))
                self._notes.append(
                    Note(
                        f"{where}part {part.name!r}: the program, as far as it ran, has no "
                        f"statement with {shown} ({word}), so {left}; name a signal, a routine, a "
                        "statement or file:line as they stand in the program"
                    )
                )


def _alike(first: Pose | None, second: Pose | None) -> bool:
    """Whether the flange stands at both; nobody knows of a place that is not known."""
    if first is None or second is None:
        return False
    turned = abs(sum(a * b for a, b in zip(first.quaternion, second.quaternion, strict=True)))
    return math.dist(first.position, second.position) < _SAME and turned > 1.0 - _SAME**2

"""Programs with targets in a work object that another robot's program moves.

What moves it, a table with the axes that it stands on, is put under the follower as external axes
of its own: on moves that both make together they run from where the other's move begins to where it
ends, along the same share of the move, as the one path parameter of such moves has it. So paths,
limits and bounds are those of a robot that turns its table itself. Beside such moves the table has
to stand: meetings of both tell where.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..arrays import FloatArray
from ..errors import InputError
from ..motion.emulator.run import Run
from ..program.move import Move
from ..program.program import Program
from ..program.target import JointTarget
from ..robot.joint import ExternalAxis, ExternalRole, Joint
from ..robot.model import Robot
from ..spatial.pose import IDENTITY
from .actions import MeetingPoint
from .station import CarriedMoves
from .synchronised import Together

_SAME = 1e-9
"""rad or m within which a table stands where it stood."""


@dataclass(frozen=True)
class CarriedProgram:
    """A program whose work objects are moved by axes of its own robot.

    Args:
        program: with values of these axes in all targets.
        robot: that has them.
        start: where it stands at first; None if nobody knows.
        moves: what carries its work objects, and when it turns.
    """

    program: Program
    robot: Robot
    start: JointTarget | None
    moves: tuple[CarriedMoves, ...] = ()


@dataclass(frozen=True)
class Carrier:
    """A robot whose program moves a work object of others.

    Args:
        name: of the robot.
        robot: with the axis.
        run: its program as driven.
        meetings: of its program.
    """

    name: str
    robot: Robot
    run: Run
    meetings: Sequence[MeetingPoint]


@dataclass
class _Copy:
    """Axes of the follower that stand for a table and what it stands on.

    Args:
        first: their values at the beginning.
        now: behind the moves that were looked at.
        blocks: as `CarriedMoves` has them, by the number of the block.
    """

    first: FloatArray
    now: FloatArray
    blocks: dict[int, dict[int, int]] = field(default_factory=dict)


@dataclass(frozen=True)
class _Need:
    """Where a table is on a move.

    Args:
        begin, end: values of its axes.
        turns: number of the block and index of the carrier's move that turns it; None where it
            stands.
    """

    begin: FloatArray
    end: FloatArray
    turns: tuple[int, int] | None


def carried_by(
    name: str,
    made: CarriedProgram,
    unit: str,
    carrier: Carrier,
    meetings: Sequence[MeetingPoint],
    together: Sequence[Together],
) -> CarriedProgram:
    """Put what another robot turns under a program whose targets lie on it.

    Args:
        name: of the robot that follows.
        made: its program.
        unit: that moves work objects of it, as the program calls it.
        carrier: whose axis that is.
        meetings: of the program.
        together: moves that robots of the station make together.

    Raises:
        InputError: the unit turns where nobody knows when, or it carries no work object.
    """
    axes = _chain(carrier, unit)
    needs = dict(_Needs(name, made.program, unit, carrier, axes, meetings, together).all())
    copies: list[_Copy] = []
    used: dict[int, _Copy] = {}
    values: list[FloatArray] = []
    for i in range(len(made.program.moves)):
        need = needs.get(i)
        if need is not None:
            used[i] = copy = _standing_at(copies, need.begin)
            copy.now = need.end
            if need.turns is not None:
                copy.blocks.setdefault(need.turns[0], {})[i] = need.turns[1]
        values.append(np.concatenate([copy.now for copy in copies] or [np.empty(0)]))
    first = np.concatenate([copy.first for copy in copies])
    # Before they are needed they stand where they will be.
    values = [np.append(row, first[len(row) :]) for row in values]
    names = [{axis.name: _called(axis.name, k) for axis in axes} for k in range(len(copies))]
    size = len(made.robot.external_axes)
    robot = made.robot.with_external_axes(
        (*made.robot.external_axes, *(_axis(axis, own) for own in names for axis in axes))
    )
    table = axes[-1].name
    moved = {i: names[copies.index(copy)][table] for i, copy in used.items()}
    start = made.start or made.program.start
    known = _own_values(made, start, size)
    moves = tuple(
        _placed(move, (*known[i + 1], *values[i]), moved.get(i), unit)
        for i, move in enumerate(made.program.moves)
    )
    if start is not None:
        start = replace(start, external=(*known[0], *map(float, first)))
    program = replace(made.program.with_moves(moves), start=start)
    blocks = tuple(
        CarriedMoves(carrier.name, own, tuple(copy.blocks.values()))
        for own, copy in zip(names, copies, strict=True)
    )
    return CarriedProgram(program, robot, start, (*made.moves, *blocks))


def _chain(carrier: Carrier, unit: str) -> list[ExternalAxis]:
    """The axes from the floor to a table.

    Raises:
        InputError: it carries the robot.
    """
    (found,) = (a.name for a in carrier.robot.external_axes if a.name.casefold() == unit.casefold())
    stages = carrier.robot.frame_stages(found)
    axes = [carrier.robot.external_axis(stage[0].name) for stage in stages]  # type: ignore[index, union-attr]
    for axis in axes:
        if axis.role is not ExternalRole.TABLE:
            raise InputError(
                f"{axis.name} of {carrier.name} carries the robot itself: work objects on it are "
                "not followed"
            )
    return axes


def _called(axis: str, copy: int) -> str:
    return axis if copy == 0 else f"{axis} ({copy + 1})"


def _axis(axis: ExternalAxis, names: Mapping[str, str]) -> ExternalAxis:
    joint: Joint = replace(axis.joint, name=names[axis.name])
    below = None if axis.carried_by is None else names[axis.carried_by]
    return replace(axis, joint=joint, carried_by=below, number=None)


def _standing_at(copies: list[_Copy], values: FloatArray) -> _Copy:
    """The axes that stand where a move begins; new ones where none do."""
    for copy in reversed(copies):
        if np.abs(copy.now - values).max() < _SAME:
            return copy
    copies.append(_Copy(values, values))
    return copies[-1]


def _own_values(
    made: CarriedProgram, start: JointTarget | None, size: int
) -> list[tuple[float, ...]]:
    """Values of the external axes that the robot has already, at the start and behind each move."""
    limits = made.robot.limits
    now = np.clip(np.zeros(made.robot.size), limits.lower, limits.upper)[made.robot.arm_size :]
    given = [() if start is None else start.external]
    given += [move.target.external for move in made.program.moves]
    if start is None and len(given) > 1:
        given[0] = given[1]
    found = []
    for external in given:
        now = np.concatenate([external, now[len(external) :]])
        found.append(tuple(map(float, now[:size])))
    return found


def _placed(move: Move, external: Sequence[float], moved_by: str | None, unit: str) -> Move:
    values = tuple(map(float, external))
    work_object = move.work_object
    if moved_by is not None and work_object.not_followed == unit:
        # The controller knows where the unit carries its user frame, whatever the data say.
        work_object = replace(work_object, user=IDENTITY, moved_by=moved_by, not_followed=None)
    return replace(move, target=replace(move.target, external=values), work_object=work_object)


class _Needs:
    """Where a table is on the moves of a program.

    Args:
        name, program, unit, carrier, meetings, together: see `carried_by`.
        axes: of the table.
    """

    def __init__(
        self,
        name: str,
        program: Program,
        unit: str,
        carrier: Carrier,
        axes: Sequence[ExternalAxis],
        meetings: Sequence[MeetingPoint],
        together: Sequence[Together],
    ) -> None:
        self._name, self._moves, self._unit, self._carrier = name, program.moves, unit, carrier
        self._values = _values(carrier, axes)
        shared = [
            {meeting.does.label for meeting in doings} for doings in (meetings, carrier.meetings)
        ]
        labels = shared[0] & shared[1]
        own, others = (
            [meeting for meeting in doings if meeting.does.label in labels]
            for doings in (meetings, carrier.meetings)
        )
        for one, other in zip(own, others, strict=False):
            if one.does.label != other.does.label:
                raise InputError(
                    f"{one.said} of {name} and {other.said} of {carrier.name} are other meetings: "
                    f"where {unit} stands for {name}'s targets is only known if both come to the "
                    "same in one order"
                )
        self._meetings = own, others
        self._others = [_section(others, j) for j in range(len(self._values) - 1)]
        blocks = ((each.of(name), each.of(carrier.name)) for each in together)
        self._blocks = [
            (block, its) for block, its in blocks if block is not None and its is not None
        ]

    def all(self) -> Iterator[tuple[int, _Need]]:
        """Where it is on moves on which it counts."""
        turning = {
            move.index: (number, counterpart.index)
            for number, (block, other) in enumerate(self._blocks)
            for move, counterpart in zip(block.moves, other.moves, strict=True)
        }
        for i, move in enumerate(self._moves):
            if i in turning:
                if i == 0:
                    raise InputError(
                        f"{self._said(i)} is the first of the program, and made together with "
                        f"{self._carrier.name}: drive to a stop before"
                    )
                j = turning[i][1]
                yield i, _Need(self._values[j], self._values[j + 1], turning[i])
            elif move.work_object.not_followed == self._unit:
                at = self._standing(i)
                yield i, _Need(at, at, None)

    def _standing(self, move: int) -> FloatArray:
        """The table's axes between the meetings before and behind a move.

        Raises:
            InputError: they turn between them.
        """
        section = _section(self._meetings[0], move)
        first, behind = (bisect_left(self._others, section + more) for more in (0, 1))
        for j in range(first, behind):
            if np.abs(self._values[j + 1] - self._values[j]).max() > _SAME:
                span = self._carrier.run.program.moves[j].statement
                where = "" if span is None else f" ({span})"
                raise InputError(
                    f"{self._said(move)}: its target is on {self._unit}, which "
                    f"{self._carrier.name}'s move {j + 1}{where} may turn at the same time: make "
                    "both together, with one ID, or let both meet between them (WaitSyncTask)"
                )
        return np.asarray(self._values[first])

    def _said(self, move: int) -> str:
        span = self._moves[move].statement
        return f"{self._name}'s move {move + 1}" + ("" if span is None else f" ({span})")


def _section(meetings: Sequence[MeetingPoint], move: int) -> int:
    """How many meetings are over before a move."""
    return sum(meeting.move < move for meeting in meetings)


def _values(carrier: Carrier, axes: Sequence[ExternalAxis]) -> FloatArray:
    """(M + 1, A), values of a table's axes at the start and behind each move."""
    names = [axis.name for axis in carrier.robot.external_axes]
    which = [names.index(axis.name) for axis in axes]
    now = carrier.run.path.q[0, carrier.robot.arm_size :].copy()
    found = [now[which]]
    for move in carrier.run.program.moves:
        external = move.target.external
        now[: len(external)] = external
        found.append(now[which])
    return np.array(found)

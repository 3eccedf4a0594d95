"""Moves and what must be set before them as KRL statements: one rule of syntax a function.

KRL keeps most of what a move needs in system variables that hold until they are set again
("Quickguide KRL-Syntax"). They are set before the first move that reads them and where they change.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ....core.errors import InputError, MotionError
from ....core.program.arc_orientation import ArcOrientation
from ....core.program.event import Event, EventAnchor
from ....core.program.move import Move, MoveC, MoveJ, MoveL
from ....core.program.program import Program
from ....core.program.target import JointTarget, PoseTarget, Target
from ....core.program.tool import Load
from ....core.robot.model import Robot
from ....core.source.write.declarations import NewDatum
from ....core.spatial.pose import IDENTITY, Pose
from .declarations import DataList
from .formatting import MM, e6axis, e6pos, frame, load
from .numbers import number
from .payload import flange_load
from .speeds import approximation, speed_settings, zone_settings

Line = tuple[str | NewDatum, ...]
"""Text, and data whose names are not given yet."""

NULL_FRAME = "$NULLFRAME"


@dataclass(frozen=True, slots=True)
class Phrases:
    """The statements of one program.

    Args:
        stated: positions that name S and T somewhere, see `stated_positions`.
    """

    robot: Robot
    data: DataList
    stated: Mapping[tuple[str | None, str], str]

    def motion(self, move: Move, places: Sequence[str | NewDatum] = ()) -> Line:
        """``PTP``, ``LIN`` or ``CIRC`` with its approximation.

        Args:
            places: where it goes to and through, where that is not the move's own target.

        Raises:
            InputError: KRL cannot say it.
        """
        zone = approximation(move)
        if isinstance(move, MoveJ):
            return ("PTP ", places[0] if places else self.point(move.target), zone)
        via = self.passed(move.via) if isinstance(move, MoveC) else ""
        goal = places[0] if places else self._position(move)
        if isinstance(move, MoveL):
            return ("LIN ", goal, zone)
        return ("CIRC ", places[1] if places else via, ",", goal, zone)

    def _position(self, move: Move) -> NewDatum:
        if isinstance(move.target, JointTarget):
            raise InputError(
                "KRL's LIN and CIRC take a position, not axis values: give the move the pose, or "
                "make it a joint move"
            )
        return self.passed(move.target)

    def passed(self, target: PoseTarget) -> NewDatum:
        """A position whose S and T do not count."""
        text = e6pos(replace(target, configuration=None), self.robot)
        return self.data.add("E6POS", self.stated.get(_key(target, text), text), target.name)

    def point(self, target: Target) -> NewDatum:
        """A position with its S and T, or axis values."""
        if isinstance(target, PoseTarget):
            return self.data.add("E6POS", e6pos(target, self.robot), target.name)
        return self.data.add("E6AXIS", e6axis(target, self.robot), target.name)

    def settings(self, move: Move) -> Iterator[tuple[str, Line]]:
        """What must hold at a move: each variable, and the statement that sets it.

        Raises:
            InputError: KRL cannot say it.
        """
        yield from self._frames(move)
        for variable, statement in speed_settings(move):
            yield variable, (statement,)
        if isinstance(move, MoveC):
            follows = move.orientation is ArcOrientation.FOLLOWS_ARC
            yield "$CIRC_TYPE", (f"$CIRC_TYPE=#{'PATH' if follows else 'BASE'}",)
        for variable, statement in zone_settings(move.zone):
            yield variable, (statement,)

    def _frames(self, move: Move) -> Iterator[tuple[str, Line]]:
        """``$BASE``, ``$TOOL``, ``$IPO_MODE`` and ``$LOAD``.

        With a tool that stands still, ``$TOOL`` is the work object that the robot carries and
        ``$BASE`` the tool's centre point.
        """
        tool, base = move.tool, move.work_object
        if tool.robot_held == base.robot_held:
            raise InputError(
                f"one of tool {tool.name} and work object {base.name} is held by the robot and the "
                "other stands still; here both are alike"
            )
        if base.moved_by is not None:
            raise InputError(
                f"work object {base.name} is moved by {base.moved_by}: the coupled base of KRL, "
                "$BASE=EK(…), needs the controller's machine data and is not written; set the "
                "coupling up by hand, or use a base that stands still"
            )
        held = (tool.tcp, tool.name) if tool.robot_held else (base.pose, base.name)
        standing = (base.pose, base.name) if tool.robot_held else (tool.tcp, tool.name)
        mode = "BASE" if tool.robot_held else "TCP"
        yield "$IPO_MODE", (f"$IPO_MODE=#{mode}",)
        yield "$BASE", ("$BASE=", self._frame(*standing))
        yield "$TOOL", ("$TOOL=", self._frame(*held))
        yield "$LOAD", ("$LOAD=", self._load(flange_load(move)))

    def _frame(self, pose: Pose, name: str) -> str | NewDatum:
        return NULL_FRAME if pose == IDENTITY else self.data.add("FRAME", frame(pose), name)

    def _load(self, value: Load | None) -> NewDatum:
        name = "NOLOAD" if value is None else value.name
        return self.data.add("LOAD", load(value), name)


def stated_positions(program: Program, robot: Robot) -> dict[tuple[str | None, str], str]:
    """Positions that a joint move gives S and T, by name and by their text without S and T.

    Raises:
        MotionError: a target is no position of KRL.
    """
    found: dict[tuple[str | None, str], str] = {}
    for index, move in enumerate(program.moves):
        target = move.target
        if not isinstance(move, MoveJ) or not isinstance(target, PoseTarget):
            continue
        if target.configuration is None:
            continue
        try:
            text = e6pos(replace(target, configuration=None), robot)
            found.setdefault(_key(target, text), e6pos(target, robot))
        except InputError as error:
            raise MotionError(str(error), index, move.statement) from None
    return found


def _key(target: PoseTarget, text: str) -> tuple[str | None, str]:
    return (None if target.name is None else target.name.casefold(), text)


def trigger(event: Event, move: Move) -> str:
    """``TRIGGER WHEN DISTANCE|PATH DELAY DO``: what happens on the way of the next motion.

    ``DISTANCE`` is 0 for its start and 1 for its target, ``PATH`` in mm from its target, below
    zero before it; ``DELAY`` is in ms, below zero before the place.

    Raises:
        InputError: the place is none that a trigger takes.
    """
    action = " ".join(event.text.split())
    delay = number(-1000 * event.time)
    if event.distance == 0:
        place = f"DISTANCE={0 if event.anchor is EventAnchor.START else 1}"
    elif event.anchor is EventAnchor.START:
        raise InputError(
            f"KRL's TRIGGER counts distances from a motion's target, not from its start: "
            f"{action!r}, {event.distance / MM:g} mm from the start, has no place"
        )
    elif isinstance(move, MoveJ):
        raise InputError(
            f"along a PTP KRL's TRIGGER takes the start or the target, not a distance: {action!r}, "
            f"{event.distance / MM:g} mm before the target, has no place"
        )
    else:
        place = f"PATH={number(-event.distance / MM)}"
    return f"TRIGGER WHEN {place} DELAY={delay} DO {action}"

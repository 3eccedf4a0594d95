"""The motion instructions: PTP, LIN, CIRC, their relative forms, SPTP, SLIN, SCIRC alone, and the
segments of spline blocks.

LIN and CIRC keep the Status that the robot has: S and T of their targets do not count. ``WITH``
sets system variables for one motion. A motion to ``$POS_ACT`` or ``$AXIS_ACT`` goes nowhere.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from typing import NamedTuple

from ....core.errors import InputError, LeftOpenError, LostError, SourceError, Span
from ....core.program.arc_orientation import ArcOrientation
from ....core.program.move import Move, MoveC, MoveJ, MoveL, Opaque
from ....core.program.speed import Speed
from ....core.program.target import JointTarget, PoseTarget
from ....core.program.tool import Load, Tool, WorkObject
from ....core.program.zone import FINE, ROOM, Radius, Zone
from ....core.source.execution.limits import Meter
from ....core.source.execution.provenance import ELSEWHERE, MovePart
from ....core.source.execution.transcript import MoveParts, Transcript
from ..syntax.tree import Assign, Expression, MotionInstruction, Name
from ..values.data import Data
from ..values.evaluator import Evaluator
from ..values.frames import frame_of, pose_of
from ..values.predefined import MOTION, POSITION
from ..values.provenance import KrlSource, LeafSource, Sources
from ..values.scope import Scope, Variable
from ..values.values import (
    Pending,
    Placement,
    Struct,
    Unknown,
    Value,
    copied,
)
from .arcs import beyond
from .frames import Placements
from .position import Position
from .settings import Set, Settings
from .target_expressions import TargetExpressions
from .targets import ReadTarget
from .triggers import Triggers

Common = tuple[Speed, Zone, Tool, WorkObject, Load | None]
"""What every move has beside its target."""


class Manner(NamedTuple):
    """How a move is driven.

    Args:
        sources: what its speed and its zone are made of.
        unsettled: why nobody knows it; empty if that is known.
        supposed: what its zone depends on that the text does not say.
    """

    common: Common
    sources: tuple[Sources, Sources]
    unsettled: str
    supposed: str


@dataclass(frozen=True, slots=True)
class MotionReader:
    """Reads motion instructions.

    Args:
        changed: called when system variables have other values.
    """

    data: Data
    evaluator: Evaluator
    placements: Placements
    settings: Settings
    targets: TargetExpressions
    position: Position
    triggers: Triggers
    meter: Meter
    transcript: Transcript
    changed: Callable[[], None]

    def read(self, motion: MotionInstruction, scope: Scope) -> None:
        """Carry out one instruction, with what follows ``WITH`` set for it alone.

        Raises:
            SourceError: it cannot be emulated, or a value is not known.
        """
        if not motion.settings:  # as most have none
            self._read(motion, scope)
            return
        with self.settings_of(motion.settings, scope):
            self._read(motion, scope)

    def _read(self, motion: MotionInstruction, scope: Scope) -> None:
        try:
            self._drive(motion, scope)
        except LeftOpenError as error:
            self.evaluator.reader = ELSEWHERE
            for target in motion.targets[1:]:  # an arc asks for both of its points at once
                with suppress(SourceError):
                    value = self.evaluator.evaluate(target, scope)
                    self.evaluator.used_as(value, "e6pos")
            self.triggers.end()
            self.transcript.leave_out(motion.span, error)
            self.position.left_out(motion.span)

    @contextmanager
    def settings_of(self, settings: Sequence[Assign], scope: Scope) -> Iterator[None]:
        """What follows ``WITH`` holds inside.

        Raises:
            SourceError: as `read`.
        """
        if not settings:
            yield
            return
        system = self.data.system
        saved = {name: copied(_held(system[name])) for name in MOTION}
        try:
            for setting in settings:
                value = self.evaluator.evaluate(setting.value, scope)
                self.evaluator.assign(setting.target, value, scope, setting.span)
            self.changed()
            yield
        finally:
            for name, value in saved.items():
                system[name].value = value
            self.changed()

    def _drive(self, motion: MotionInstruction, scope: Scope) -> None:
        word = motion.word.removesuffix("_rel")
        joint, arc = word.endswith("ptp"), word.endswith("circ")
        if not arc and self._goes_nowhere(motion, scope):
            self._stay(motion, joint)
            return
        placement = self.placements.current(motion.span)
        start = None if joint else self._start(placement, motion)
        if arc:
            self._arc(motion, scope, placement, start)
            return
        found = self.targets.read(motion, motion.targets[0], scope, placement, joint)
        if not joint:
            if isinstance(found.target, JointTarget):
                raise SourceError(
                    f"{motion.word.upper()} takes a position, not axis values", motion.span
                )
            found = self._constant_orientation(found, start, placement, motion)
        how = self._common(motion, joint, placement)
        kind = MoveJ if joint else MoveL
        events = self.triggers.taken()
        move: Move = kind(found.target, *how.common, events=events, unsettled=how.unsettled)
        self._emit(motion, _supposed(move, found, placement, how), found, how.sources)

    # --------------------------------------------------------------------- one kind each

    def _goes_nowhere(self, motion: MotionInstruction, scope: Scope) -> bool:
        """Whether the target is where the robot is, known or not."""
        target = motion.targets[-1]
        if not isinstance(target, Name) or target.path or motion.word.endswith("_rel"):
            return False
        if target.name in POSITION:
            return True
        cell = self.data.find(target.name, scope)
        value = None if cell is None else cell.value
        if not isinstance(value, Unknown) or value.here is None:
            return False
        moves, asked_in = value.here
        return moves == self.transcript.move_index and (
            asked_in is None or asked_in == self.placements.current(motion.span)
        )

    def _stay(self, motion: MotionInstruction, joint: bool) -> None:
        """``PTP $AXIS_ACT``: no way, but an exact stop.

        It is kept so that it goes nowhere wherever it is written, whatever the datum holds there.
        """
        at = motion.targets[-1].span
        text, target = self.transcript.text_of(motion.span), self.transcript.text_of(at)
        if target.lower() not in POSITION:
            place = "$AXIS_ACT" if joint else "$POS_ACT"
            begin = at.start - motion.span.start
            text = text[:begin] + place + text[begin + len(target) :]
        self.transcript.emit(Opaque(text, not motion.approximation, motion.span))
        self.transcript.notes.once(
            "stays",
            f"{motion.word.upper()} {target} goes to where the robot is: kept, no move",
            motion.span,
        )

    def _arc(
        self,
        motion: MotionInstruction,
        scope: Scope,
        placement: Placement,
        start: Struct | Unknown | None,
    ) -> None:
        auxiliary = self.targets.read(motion, motion.targets[0], scope, placement, False, via=True)
        found = self.targets.read(motion, motion.targets[1], scope, placement, False)
        via, target = auxiliary.target, found.target
        if isinstance(via, JointTarget) or isinstance(target, JointTarget):
            raise SourceError(
                f"{motion.word.upper()} takes positions, not axis values", motion.span
            )
        via_part = self._part(motion.targets[0].span, auxiliary.sources)
        arcs, between = [(via, target)], ROOM
        if motion.angle is not None:
            arcs, between = self._by_angle(motion, motion.angle, scope, start, via, target)
            via_part = MovePart(motion.targets[0].span)
            for read in (auxiliary.sources, found.sources):
                self.targets.read_by_expression(read.entries)
            found = replace(found, sources=Sources(()))
        events = self.triggers.taken()
        for number, (middle, end) in enumerate(arcs, 1):
            complete = Struct("e6pos", {**found.complete.fields, **frame_of(end.pose).fields})
            found = replace(found, target=end, complete=complete)
            found = self._constant_orientation(found, start, placement, motion)
            part = motion if number == len(arcs) else replace(motion, passed=True)
            how = self._common(part, False, placement, between)
            assert isinstance(found.target, PoseTarget)
            move = MoveC(
                found.target,
                *how.common,
                via=middle,
                orientation=self._arc_orientation(motion),
                events=events,
                unsettled=how.unsettled,
            )
            made = _supposed(move, auxiliary, found, placement, how)
            self._emit(motion, made, found, how.sources, via_part)
            events = ()

    def _by_angle(
        self,
        motion: MotionInstruction,
        angle: Expression,
        scope: Scope,
        start: Struct | Unknown | None,
        via: PoseTarget,
        target: PoseTarget,
    ) -> tuple[list[tuple[PoseTarget, PoseTarget]], Radius]:
        """``CA``: the auxiliary and the end points of the arcs that are really driven, and the zone
        in which one goes over into the next."""
        degrees = self.evaluator.number(angle, scope, "CA")
        begin = _known_start(start, "an arc of angle CA", motion.span)
        follows = self._arc_orientation(motion) is ArcOrientation.FOLLOWS_ARC
        try:
            parts, radius = beyond(pose_of(begin.fields), via.pose, target.pose, degrees, follows)
        except InputError as error:
            raise SourceError(str(error), motion.span) from None
        # A blend as wide as this stays on the circle, to 0.1 % of its radius.
        zone = ROOM.resized(radius / 3)
        return [(replace(via, pose=half), replace(target, pose=end)) for half, end in parts], zone

    def _arc_orientation(self, motion: MotionInstruction) -> ArcOrientation:
        kind = self.settings.choice("$circ_type", motion.span)
        return ArcOrientation.FOLLOWS_ARC if kind == "path" else ArcOrientation.FIXED_FRAME

    def _constant_orientation(
        self,
        found: ReadTarget,
        start: Struct | Unknown | None,
        placement: Placement,
        motion: MotionInstruction,
    ) -> ReadTarget:
        """``$ORI_TYPE``: ``#CONSTANT`` keeps the orientation of the start point."""
        kind = self.settings.choice("$ori_type", motion.span)
        if kind == "joint":
            self.transcript.notes.once(
                "#JOINT",
                "$ORI_TYPE=#JOINT turns the wrist's axes evenly, which is not emulated: the "
                "orientation goes the shortest way (#VAR)",
                motion.span,
            )
        if kind != "constant":
            return found
        what = "$ORI_TYPE=#CONSTANT keeps the orientation of the start point, which"
        begin = _known_start(start, what, motion.span)
        kept = {name: begin.fields[name] for name in "abc"}
        complete = Struct("e6pos", {**found.complete.fields, **kept})
        assert isinstance(found.target, PoseTarget)
        target = replace(found.target, pose=pose_of(complete.fields))
        return replace(found, target=target, complete=complete, sources=_only_position(found))

    def _start(self, placement: Placement, motion: MotionInstruction) -> Struct | Unknown | None:
        """Where the motion begins, if that is needed to know where it goes."""
        constant = self.settings.choice("$ori_type", motion.span) == "constant"
        if constant or motion.angle is not None:
            return self.position.pose(placement, motion.span)
        return None

    # -------------------------------------------------------------------------- parts

    def _common(
        self, motion: MotionInstruction, joint: bool, placement: Placement, room: Radius = ROOM
    ) -> Manner:
        """How a move is driven; where another segment follows, it is passed in ``room``."""
        settings, span, lost = self.settings, motion.span, ""
        try:
            speed = settings.joint_speed(span) if joint else settings.path_speed(span)
        except LostError as error:
            speed, lost = Set(Speed(joint_fraction=1.0), Sources(())), error.message
        spline = motion.word.startswith("s")
        try:
            if motion.passed:
                zone = settings.passing(joint, room)
            else:
                zone = settings.zone(motion.approximation, joint, spline, motion.approximated)
        except LostError as error:
            zone, lost = Set(FINE, Sources(())), lost or error.message
        assert isinstance(speed.value, Speed) and not isinstance(zone.value, Speed)
        at = placement.tool, placement.work_object, placement.load
        sources = speed.sources, zone.sources
        return Manner((speed.value, zone.value, *at), sources, lost, zone.supposed)

    def _part(self, span: Span, sources: Sources, predefined: str | None = None) -> MovePart:
        reads, index = self.evaluator.reads, self.transcript.move_index
        for source in sources.distinct():
            reads.by_move(source, index)
            # A number may be read alone here and with its aggregate by another move.
            reads.by_expression(source, index)
        return MovePart(span, sources.entries, predefined)

    def _emit(
        self,
        motion: MotionInstruction,
        move: Move,
        found: ReadTarget,
        sources: Sequence[Sources],
        via: MovePart | None = None,
    ) -> None:
        parts = MoveParts(
            motion.span,
            self._part(motion.targets[-1].span, found.sources, found.predefined),
            self._part(motion.span, sources[0]),
            self._part(motion.approximated, sources[1]),
            via,
        )
        if isinstance(found.target, PoseTarget):
            self.placements.remark_unset(motion.span)
        self.meter.move(motion.span)
        self.transcript.emit_move(move, parts)
        self.position.moved(move, motion.span, found.complete)


def _supposed(move: Move, *parts: ReadTarget | Placement | Manner) -> Move:
    """A move that says what its path depends on that the text does not say."""
    reason = next((part.supposed for part in parts if part.supposed), "")
    return replace(move, supposed=reason) if reason else move


def _known_start(start: Struct | Unknown | None, what: str, span: Span) -> Struct:
    if isinstance(start, Struct):
        return start
    reason = start.reason if isinstance(start, Unknown) else "where the robot stands"
    raise LeftOpenError(f"{what} depends on {reason}", span)


def _held(cell: Variable) -> Value:
    value = cell.value
    assert value is not None and not isinstance(value, Pending)
    return value


def _only_position(found: ReadTarget) -> Sources:
    """The sources of a target whose orientation does not count: its numbers one by one."""
    entries: list[KrlSource | None] = []
    for source in found.sources.entries:
        if isinstance(source, LeafSource) or source is None:
            entries.append(source)
        else:
            entries += source.parts()
    turning = range(3, 6)
    return Sources(tuple(None if k in turning else e for k, e in enumerate(entries)))

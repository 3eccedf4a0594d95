"""The statements of a program: moves, waits, and what is kept as it stands."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from ..display import in_line
from ..errors import InputError, Span
from .arc_orientation import ArcOrientation
from .event import Event
from .origin import MoveOrigin
from .speed import Speed, speed_shown
from .target import PoseTarget, Target, target_shown
from .tool import FLANGE, WORLD, Load, Tool, WorkObject
from .zone import FINE, Zone, zone_shown


@dataclass(frozen=True, slots=True, repr=False)
class _Motion:
    """What every move has.

    Args:
        target: where it goes.
        speed: how fast.
        zone: how near it must come to the target before the next move may begin.
        tool: the tool whose centre point is programmed.
        work_object: the frame of the target.
        load: payload carried during the move, in the tool's frame.
        events: what happens on the way; it does not change the motion.
        open: why nobody knows where it goes; empty if that is known. Its target then only has a
            name, and it cannot be driven.
        stops: whether ``open`` says that the program makes an error there, at which the controller
            stops it. Where that is in what a move is made of, the moves behind it are driven.
        unsettled: why nobody knows how it is driven, though its target is known; empty if that is
            known. It cannot be driven either, but the robot stands at its target afterwards.
        supposed: why nobody knows where it goes, or how near it passes, though it is driven by
            what is taken for that; empty if it is known; not part of the value.
        origin: where in the source the numbers stand; not part of the value.
    """

    target: Target
    speed: Speed
    zone: Zone = FINE
    tool: Tool = FLANGE
    work_object: WorkObject = WORLD
    load: Load | None = None
    events: tuple[Event, ...] = field(default=(), kw_only=True)
    open: str = field(default="", kw_only=True)
    stops: bool = field(default=False, kw_only=True)
    unsettled: str = field(default="", kw_only=True)
    supposed: str = field(default="", compare=False, kw_only=True)
    origin: MoveOrigin | None = field(default=None, compare=False, kw_only=True)

    def __repr__(self) -> str:
        span = None if self.origin is None else self.origin.statement
        line = "" if span is None else f", line {span.line}"
        told = (speed_shown(self.speed), zone_shown(self.zone), self.tool.name)
        return in_line(f"{self.kind} {self._way}, {', '.join(told)}, {self.work_object.name}{line}")

    @property
    def kind(self) -> str:
        """``MoveJ``, ``MoveL`` or ``MoveC``; ``move`` where nobody knows where it goes, ``stop``
        where the controller stops the program."""
        if self.open:
            return "stop" if self.stops else "move"
        return type(self).__name__

    @property
    def _way(self) -> str:
        return "to where nobody knows" if self.open else f"to {target_shown(self.target)}"

    @property
    def statement(self) -> Span | None:
        """Where in the source it stands; None where it was not read from one."""
        return None if self.origin is None else self.origin.statement


@dataclass(frozen=True, slots=True, repr=False)
class MoveJ(_Motion):
    """All joints linear in one parameter (``MoveJ``, ``MoveAbsJ``, ``PTP``, ``movej``)."""


@dataclass(frozen=True, slots=True, repr=False)
class MoveL(_Motion):
    """The TCP on a line, orientation on the shortest great arc (``MoveL``, ``LIN``, ``movel``)."""


@dataclass(frozen=True, slots=True, repr=False)
class MoveC(_Motion):
    """The TCP on the arc from the point before through ``via`` to the target.

    Args:
        via: the auxiliary point; its orientation only tells which way round the tool turns where
            that is in doubt.
        orientation: how the tool turns along the arc.
    """

    via: PoseTarget = field(kw_only=True)
    orientation: ArcOrientation = field(default=ArcOrientation.FOLLOWS_ARC, kw_only=True)

    @property
    def _way(self) -> str:
        return f"through {target_shown(self.via)} to {target_shown(self.target)}"


@dataclass(frozen=True, slots=True)
class Wait:
    """The robot stands still for ``duration`` s; in a chain of moves it makes the point a stop.

    Args:
        duration: s.
        span: where in the source.
        device: whether it is no wait of the program, but the time that a device takes which the
            program waits for.
    """

    duration: float
    span: Span | None = field(default=None, compare=False)
    device: bool = False

    def __post_init__(self) -> None:
        if not (math.isfinite(self.duration) and self.duration >= 0):
            raise InputError(f"a wait lasts zero seconds or more, not {self.duration}")


@dataclass(frozen=True, slots=True)
class Opaque:
    """A statement that is kept in place and not interpreted (I/O, messages, process calls).

    Args:
        text: the statement as it stands in the source.
        stops: whether the controller must come to rest before it (it ends the look-ahead).
        span: where in the source.
    """

    text: str
    stops: bool = False
    span: Span | None = field(default=None, compare=False)


Move = MoveJ | MoveL | MoveC
Statement = Move | Wait | Opaque

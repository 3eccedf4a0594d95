"""The figures of a run, move by move, as plain data in SI units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ...core.arrays import FloatArray
from ...core.display import counted, in_line, shown
from ...core.driving.driven_program import DrivenProgram, Fault
from ...core.errors import Note, Span
from ...core.motion.emulator.binding_limits import LimitShare, limit_shares
from ...core.motion.emulator.move_figures import lengths_and_speeds, zone_reaches
from ...core.motion.emulator.run import Run
from ...core.notebook import table
from ...core.program.assumed_places import assumed_places
from ...core.program.move import Move
from ...core.program.origin import Ownership
from ...core.program.program import Program
from ...core.program.target import JointTarget
from ...core.program.zone import Fine, Radius, VendorZone
from ...core.robot.model import Robot
from ...core.source.reading import Reading
from ..options.texts import fixed
from .shares import shares

if TYPE_CHECKING:
    from ...core.collision.clearance import Approach, MoveClearance

COLUMNS = (
    ("#", "right"),
    ("move", "left"),
    ("target", "left"),
    ("line", "right"),
    ("length\nmm", "right"),
    ("time\ns", "right"),
    ("wait\ns", "right"),
    ("settling\ns", "right"),
    ("top speed\nmm/s", "right"),
    ("programmed\nmm/s", "right"),
    ("zone", "left"),
    ("limited by", "left"),
)
KINDS = {
    "contourfraction": "share of contour",
    "angle": "angle",
    "speedfraction": "share of speed",
}
"""Zones that are no radius, by the class of the programmed zone."""
CUT = 1e-6
"""m by which a zone is smaller than programmed before it is shown as cut."""

_WIDEST = 40
"""Characters of a computed target that are shown."""
_PICOSECONDS = 12
"""Decimals of a second beyond which a difference of times is rounding."""


@dataclass(frozen=True, slots=True)
class ZoneReport:
    """The end of a move.

    Args:
        kind: class of the programmed zone, lower case (``fine``, ``radius``, …).
        name: its name in the source; None if it has none.
        radius: programmed TCP radius in m; None for other kinds of zone.
        entry, exit: m, how far from the waypoint the TCP leaves and regains the programmed
            path; 0 where it stops.
    """

    kind: str
    name: str | None
    radius: float | None
    entry: float
    exit: float

    @property
    def stops(self) -> bool:
        """Whether the robot comes to rest."""
        return self.entry == 0.0 or self.exit == 0.0


@dataclass(frozen=True, slots=True)
class MoveReport:
    """One move.

    Args:
        number: from 1.
        kind: ``MoveJ``, ``MoveL`` or ``MoveC``.
        target: name of the target; None if it has none.
        position: the target in its work object, m; None for joint targets.
        span: where the move stands in its source.
        fault: why it cannot be driven; None where it can.
        driven: False for moves at fault, moves to where the robot goes on behind one, and moves
            that go nowhere or are left out; all below is then empty, but for what the robot waits
            where it is taken to stand behind a fault.
        length: of the TCP's path in its work object, m.
        begin: s, when the commanded motion enters the move's share of the path: at the waypoint
            before, or in the middle of its zone.
        time: s of motion along it.
        wait: s of programmed standing still at its end.
        settling: s until the next move begins beyond both: what the joints, averaged over time,
            take to catch up at a stop, and half their window in the first and in the last move.
        top_speed: greatest TCP speed in the work object, m/s.
        programmed_speed: of the TCP, m/s.
        zone: its end.
        limits: what holds the speed down, the longest first.
        expression: how the program computes the target, as it is written; None where it does not.
    """

    number: int
    kind: str
    target: str | None
    position: tuple[float, float, float] | None
    span: Span | None
    fault: Fault | None
    driven: bool
    length: float
    begin: float
    time: float
    wait: float
    settling: float
    top_speed: float
    programmed_speed: float | None
    zone: ZoneReport
    limits: tuple[LimitShare, ...]
    expression: str | None = None

    def __repr__(self) -> str:
        told = (
            (_not_driven(self),)
            if not self.driven
            else (
                f"{1e3 * self.length:.1f} mm in {self.time:.3f} s",
                f"at most {1e3 * self.top_speed:.0f} mm/s",
                zone_text(self.zone),
                f"limited by {self.limited_by}",
            )
        )
        return in_line(f"Move {self.number}: {self.kind} to {target_text(self)}, {', '.join(told)}")

    @property
    def limited_by(self) -> str | None:
        """What holds the speed down for most of the move; None where it is not driven."""
        return self.limits[0].name if self.limits else None


class MoveTable(tuple[MoveReport, ...]):
    """The moves of a program in their order."""

    __slots__ = ()

    def __repr__(self) -> str:
        driven = sum(move.driven for move in self)
        spent = sum(move.time for move in self)
        return in_line(f"{counted(self, 'move')}, {driven} driven, {spent:.3f} s")

    def _repr_html_(self) -> str:
        return table(COLUMNS, [move_row(move) for move in self])


@dataclass(frozen=True, slots=True)
class Report:
    """A run. The first wait and what all moves take are its time.

    Args:
        program: its name.
        robot: name of the robot.
        driven_time: s, from the start to rest after the last motion, waits included; of all parts
            that can be driven.
        time_range: s, least and greatest such time by the spread of the robot's assumed figures;
            None where none has one.
        assumed: which figures these are.
        unknown: names of tools and work objects that nobody says what they are.
        first_wait: s of it in which the robot waits before the first move that is driven.
        waiting: s of it spent in programmed waits, the first included.
        settling: s of it that settling takes.
        length: of the TCP's path, m.
        top_speed: of the TCP, m/s.
        moves: one entry for each move of the program.
        parts: that are driven without a gap: the first and the last move of each, from 1.
        faults: moves that cannot be driven.
        notes: what the user should know.
        to_cell: where arm, tool and what is carried come nearest to the cell; None without a cell.
        own: where the arm's links, the tool and what is carried come nearest to each other.
        cycle_time: s of one cycle of the loop that production runs in, else of the whole program;
            None where a move cannot be driven, as nobody knows what it would take.
    """

    program: str
    robot: str
    driven_time: float
    time_range: tuple[float, float] | None
    assumed: tuple[str, ...]
    unknown: tuple[str, ...]
    first_wait: float
    waiting: float
    settling: float
    length: float
    top_speed: float
    moves: MoveTable
    parts: tuple[tuple[int, int], ...]
    faults: tuple[Fault, ...]
    notes: tuple[Note, ...]
    to_cell: Approach | None = None
    own: Approach | None = None
    cycle_time: float | None = None

    def __repr__(self) -> str:
        told = [f"{1e3 * self.length:.1f} mm", counted(self.moves, "move")]
        if self.faults:
            told.append(counted(self.faults, "fault"))
        return in_line(
            f"Report of {self.program} on {self.robot}: {self.driven_time:.3f} s, "
            f"{', '.join(told)}, {counted(self.notes, 'note')}"
        )

    @property
    def moving(self) -> float:
        """s of the cycle time in which the robot follows its path."""
        return sum(move.time for move in self.moves)


def make_report(
    driven: DrivenProgram,
    robot: Robot,
    clearances: Sequence[MoveClearance] = (),
    time_range: tuple[float, float] | None = None,
) -> Report:
    """The report of a driven program, and of how near its moves come.

    ``time_range`` is that of the `Report`.
    """
    faults = {fault.move: fault for fault in driven.faults}
    moves = [_empty(i, move, faults.get(i)) for i, move in enumerate(driven.program.moves)]
    program, waiting, first_wait = driven.program, 0.0, 0.0
    for part, clock in zip(driven.parts, driven.begins, strict=True):
        for i, row in _rows(part.run, robot).items():
            number = part.first + i + 1
            moves[number - 1] = replace(row, number=number, begin=row.begin + clock)
        dwell = part.run.path.route.dwell
        waiting += float(dwell.sum())
        if part.first:  # behind a gap the robot waits where it is taken to stand
            there = moves[part.first - 1]
            moves[part.first - 1] = replace(there, begin=clock, wait=float(dwell[0]))
        else:
            first_wait = float(dwell[0])
    if not driven.parts:
        waiting = driven.duration
    moves = [
        replace(row, expression=_expression(program, move))
        for row, move in zip(moves, program.moves, strict=True)
    ]
    to_cell = own = None
    if clearances:
        from ...core.collision.clearance import nearest_of

        to_cell, own = nearest_of(clearances)
    report = Report(
        program=driven.program.name,
        robot=robot.name,
        driven_time=driven.duration,
        time_range=time_range,
        assumed=tuple(robot.spread),
        unknown=tuple(dict.fromkeys(chain.from_iterable(assumed_places(program).values()))),
        first_wait=first_wait,
        waiting=waiting,
        settling=sum(move.settling for move in moves),
        length=sum(move.length for move in moves),
        top_speed=max((move.top_speed for move in moves), default=0.0),
        moves=MoveTable(moves),
        parts=tuple((p.first + 1, p.first + len(p.run.program.moves)) for p in driven.parts),
        faults=driven.faults,
        notes=driven.notes,
        to_cell=to_cell,
        own=own,
        cycle_time=None if driven.faults else driven.duration,
    )
    if program.cycle is None or driven.faults:
        return report
    return replace(report, cycle_time=shares(program, report).total)


def _rows(run: Run, robot: Robot) -> dict[int, MoveReport]:
    """The moves of a run that are driven, by their indices."""
    lengths, tops = lengths_and_speeds(run)
    zones = zone_reaches(run.path)
    spans = _spans(run)
    limits = limit_shares(run, robot.axis_names)
    dwell = run.path.route.dwell
    return {
        i: replace(
            _empty(i, run.program.moves[i]),
            driven=True,
            length=float(lengths[k]),
            begin=float(spans.begin[k]),
            time=float(spans.duration[k]),
            wait=float(dwell[k + 1]),
            settling=float(spans.settling[k]),
            top_speed=float(tops[k]),
            zone=_zone(run.program.moves[i], zones[k]),
            limits=limits[k],
        )
        for k, i in enumerate(run.path.route.moves)
    }


def _empty(index: int, move: Move, fault: Fault | None = None) -> MoveReport:
    """A move that is not driven."""
    return MoveReport(
        number=index + 1,
        kind=move.kind,
        target=move.target.name,
        position=_position(move),
        span=move.statement,
        fault=fault,
        driven=False,
        length=0.0,
        begin=0.0,
        time=0.0,
        wait=0.0,
        settling=0.0,
        top_speed=0.0,
        programmed_speed=move.speed.tcp,
        zone=_zone(move, (0.0, 0.0)),
        limits=(),
    )


def _not_driven(move: MoveReport) -> str:
    """Why a move has no figures."""
    return "not driven" if move.fault is None else f"FAULT: {move.fault.cause}"


class _Spans(NamedTuple):
    """(M,) s, of each segment: when it is entered, and how long it takes, waits left out."""

    begin: FloatArray
    duration: FloatArray
    settling: FloatArray


def _spans(run: Run) -> _Spans:
    """Segments on the clock of the commanded motion, as its samples belong to them."""
    timing = run.timing
    segments = np.arange(len(run.path.route.moves))
    first = np.searchsorted(timing.interval_segments, segments)
    last = np.searchsorted(timing.interval_segments, segments, side="right") - 1
    entered, left = (timing.start.driven(t) for t in (timing.begin[first], timing.end[last]))
    duration = left - entered
    settling = timing.settled_durations() - duration
    return _Spans(timing.begins(), duration, np.round(settling, _PICOSECONDS) + 0.0)


def _zone(move: Move, reach: tuple[float, float]) -> ZoneReport:
    zone = move.zone
    return ZoneReport(
        kind=type(zone).__name__.lower() if not isinstance(zone, VendorZone) else str(zone),
        name=getattr(zone, "name", "fine" if isinstance(zone, Fine) else None),
        radius=zone.tcp if isinstance(zone, Radius) else None,
        entry=reach[0],
        exit=reach[1],
    )


def _position(move: Move) -> tuple[float, float, float] | None:
    if move.open or isinstance(move.target, JointTarget):
        return None
    return move.target.pose.position


def _expression(program: Program, move: Move) -> str | None:
    """How a program computes the target of a move, in a line."""
    origin, reading = move.origin, program.reading
    if origin is None or origin.target.ownership is not Ownership.DERIVED:
        return None
    span = origin.target.span
    if span is None or not isinstance(reading, Reading) or span.file not in reading.files:
        return None
    return " ".join(reading.files[span.file].text[span.start : span.end].split()) or None


def seconds(rest: float) -> str:
    """A time of rest, empty for none."""
    return f"{rest:.3f}" if rest else ""


def move_row(move: MoveReport) -> tuple[str, ...]:
    """The cells of a move, in the units of the shop floor."""
    line = "" if move.span is None else str(move.span.line)
    head = (str(move.number), move.kind, target_text(move), line)
    if not move.driven:
        return (*head, "", "", seconds(move.wait), *[""] * 4, _not_driven(move))
    return (
        *head,
        f"{1e3 * move.length:.1f}",
        f"{move.time:.3f}",
        seconds(move.wait),
        seconds(move.settling),
        f"{1e3 * move.top_speed:.0f}",
        "" if move.programmed_speed is None else f"{1e3 * move.programmed_speed:.0f}",
        zone_text(move.zone),
        f"{move.limits[0].name} ({100 * move.limits[0].share:.0f} %)" if move.limits else "",
    )


def target_text(move: MoveReport) -> str:
    """Where a move goes: the name of its target, how it is computed, or its place in mm."""
    if move.target is not None:
        return move.target
    if move.expression is not None:
        text = shown(move.expression)
        return text if len(text) <= _WIDEST else f"{text[: _WIDEST - 1]}…"
    if move.position is None:
        return "joint values"
    return ", ".join(fixed(1e3 * value, 1) for value in move.position)


def zone_text(zone: ZoneReport) -> str:
    """A zone and what became of it, in mm."""
    if zone.kind == "fine":
        return "fine"
    kind = KINDS.get(zone.kind, zone.kind)
    name = zone.name or (kind if zone.radius is None else f"{1e3 * zone.radius:g} mm")
    if zone.stops:
        return f"{name}, stops"
    reach = min(zone.entry, zone.exit)
    if zone.radius is None:
        return f"{name}, {1e3 * reach:.1f} mm"
    return name if reach > zone.radius - CUT else f"{name}, cut to {1e3 * reach:.1f} mm"

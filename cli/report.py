"""What there is to tell about a run, move by move, as plain data in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..core.arrays import FloatArray
from ..core.errors import Note, Span
from ..core.motion.emulator.binding_limits import LimitShare, limit_shares
from ..core.motion.emulator.move_figures import lengths_and_speeds, zone_reaches
from ..core.motion.emulator.run import Run
from ..core.program.move import Move
from ..core.program.target import JointTarget
from ..core.program.zone import Fine, Radius
from ..core.robot.model import Robot

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
        driven: False for moves that go nowhere or are left out; all below is then empty.
        length: of the TCP's path in its work object, m.
        begin: s, when the commanded motion enters the move's share of the path: at the waypoint
            before, or in the middle of its zone.
        duration: s of motion along it.
        wait: s of programmed standing still at its end.
        settling: s until the next move begins beyond both: what the joints, averaged over time,
            take to catch up at a stop, and half their window in the first and in the last move.
        top_speed: greatest TCP speed in the work object, m/s.
        programmed_speed: of the TCP, m/s.
        zone: its end.
        limits: what holds the speed down, the longest first.
    """

    number: int
    kind: str
    target: str | None
    position: tuple[float, float, float] | None
    span: Span | None
    driven: bool
    length: float
    begin: float
    duration: float
    wait: float
    settling: float
    top_speed: float
    programmed_speed: float | None
    zone: ZoneReport
    limits: tuple[LimitShare, ...]


@dataclass(frozen=True, slots=True)
class Report:
    """A run. The first wait and what all moves take are its cycle time.

    Args:
        program: its name.
        robot: name of the robot.
        cycle_time: s, from the start to rest after the last motion, waits included.
        first_wait: s of it in which the robot waits before the first move that is driven.
        waiting: s of it spent in programmed waits, the first included.
        settling: s of it that settling takes.
        length: of the TCP's path, m.
        top_speed: of the TCP, m/s.
        moves: one entry for each move of the program.
        notes: what the user should know.
    """

    program: str
    robot: str
    cycle_time: float
    first_wait: float
    waiting: float
    settling: float
    length: float
    top_speed: float
    moves: tuple[MoveReport, ...]
    notes: tuple[Note, ...]

    @property
    def moving(self) -> float:
        """s of the cycle time in which the robot follows its path."""
        return sum(move.duration for move in self.moves)


def make_report(run: Run, robot: Robot) -> Report:
    """The report of a run."""
    lengths, tops = lengths_and_speeds(run)
    zones = zone_reaches(run.path)
    spans = _spans(run)
    limits = limit_shares(run, robot.axis_names)
    dwell = run.path.route.dwell
    segment_of = {move: k for k, move in enumerate(run.path.route.moves)}
    rows = []
    for i, move in enumerate(run.program.moves):
        k = segment_of.get(i)
        driven = k is not None
        rows.append(
            MoveReport(
                number=i + 1,
                kind=type(move).__name__,
                target=move.target.name,
                position=_position(move),
                span=None if move.origin is None else move.origin.statement,
                driven=driven,
                length=0.0 if k is None else float(lengths[k]),
                begin=0.0 if k is None else float(spans.begin[k]),
                duration=0.0 if k is None else float(spans.duration[k]),
                wait=0.0 if k is None else float(dwell[k + 1]),
                settling=0.0 if k is None else float(spans.settling[k]),
                top_speed=0.0 if k is None else float(tops[k]),
                programmed_speed=move.speed.tcp,
                zone=_zone(move, (0.0, 0.0) if k is None else zones[k]),
                limits=() if k is None else limits[k],
            )
        )
    return Report(
        program=run.program.name,
        robot=robot.name,
        cycle_time=run.duration,
        first_wait=float(dwell[0]),
        waiting=float(dwell.sum()),
        settling=float(spans.settling.sum()),
        length=float(lengths.sum()),
        top_speed=float(tops.max()),
        moves=tuple(rows),
        notes=_located(run),
    )


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
        kind=type(zone).__name__.lower(),
        name=getattr(zone, "name", "fine" if isinstance(zone, Fine) else None),
        radius=zone.tcp if isinstance(zone, Radius) else None,
        entry=reach[0],
        exit=reach[1],
    )


def _position(move: Move) -> tuple[float, float, float] | None:
    return None if isinstance(move.target, JointTarget) else move.target.pose.position


def _located(run: Run) -> tuple[Note, ...]:
    """The notes, each with its place in the source where the program knows it."""
    found = []
    for note in run.notes:
        span = note.span
        if span is None and note.move is not None:
            origin = run.program.moves[note.move].origin
            span = None if origin is None else origin.statement
        found.append(Note(note.message, note.move, span))
    return tuple(dict.fromkeys(found))

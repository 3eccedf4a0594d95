"""What happens along a driven program: waits, outputs and other statements, events on the way."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...core.arrays import FloatArray
from ...core.motion.command.trajectory import Trajectory
from ...core.program.event import Event, EventAnchor
from ...core.program.move import Opaque, Wait
from ...core.program.program import Program
from ...drawing.page.track_content import (
    PageFlag,
)
from ..results.report import MoveReport, Report
from .sources import SourceList

_MOST = 2000
"""Flags of a page."""
_LONGEST = 200
"""Characters of a flag."""


def page_flags(
    program: Program, report: Report, trajectory: Trajectory, sources: SourceList, track: int
) -> list[PageFlag]:
    """The flags of a driven program, in the order of time."""
    found = sorted(_flags(program, report, trajectory, sources, track), key=lambda flag: flag.t)
    return found[:_MOST]


def _flags(
    program: Program, report: Report, trajectory: Trajectory, sources: SourceList, track: int
) -> Iterator[PageFlag]:
    now, done = 0.0, 0
    for statement in program.statements:
        if isinstance(statement, Wait):
            source, line = sources.place(track, statement.span)
            kind = "device" if statement.device else "wait"
            text = f"{'device' if statement.device else 'wait'} {statement.duration:.3g} s"
            if statement.duration > 0.0:
                yield PageFlag(kind, text, now, statement.duration, source, line)
            now += statement.duration
        elif isinstance(statement, Opaque):
            source, line = sources.place(track, statement.span)
            text = " ".join(statement.text.split())[:_LONGEST]
            yield PageFlag("statement", text, now, 0.0, source, line)
        else:
            move = report.moves[done]
            done += 1
            if move.driven:
                now = move.begin + move.time + move.settling
                for event in statement.events:
                    t = _passed(event, move, trajectory)
                    source, line = sources.place(track, event.span or statement.statement)
                    yield PageFlag("event", event.text[:_LONGEST], t, 0.0, source, line)


def _passed(event: Event, move: MoveReport, trajectory: Trajectory) -> float:
    """s, when the place of an event is passed."""
    begin, end = move.begin, move.begin + move.time
    clock = trajectory.t - trajectory.t[0]
    rows = np.flatnonzero((clock >= begin) & (clock <= end))
    if len(rows) < 2:
        return begin if event.anchor is EventAnchor.START else end
    steps = np.linalg.norm(np.diff(trajectory.position[rows], axis=0), axis=1)
    way: FloatArray = np.concatenate([[0.0], np.cumsum(steps)])
    forward = event.anchor is EventAnchor.START
    at = event.distance if forward else way[-1] - event.distance
    passed = float(np.interp(at, way, clock[rows]))
    return float(np.clip(passed - event.time, 0.0, clock[-1]))

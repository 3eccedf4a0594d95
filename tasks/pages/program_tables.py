"""Tables of a driven program on its page: moves, faults, notes, where the time goes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ...core.display import alike
from ...core.errors import FlybyError, Note
from ...core.program.program import Program
from ...drawing.page.content import (
    PageCell,
    PageColumn,
    PageRow,
    PageShare,
    PageTable,
)
from ...drawing.page.track_content import (
    PageMove,
)
from ..results.report import MoveReport, Report, target_text, zone_text
from ..results.shares import shares
from .sources import SourceList

if TYPE_CHECKING:
    from ..results.runs import Run

MOVES = (
    PageColumn("#"),
    PageColumn("move"),
    PageColumn("target"),
    PageColumn("line"),
    PageColumn("from", "s", 3),
    PageColumn("time", "s", 3, bar=True),
    PageColumn("wait", "s", 3),
    PageColumn("length", "mm", 1),
    PageColumn("top speed", "mm/s"),
    PageColumn("programmed", "mm/s"),
    PageColumn("zone"),
    PageColumn("limited by"),
)
_NOTES = (PageColumn("line"), PageColumn("move"), PageColumn("what"))
_FAULTS = (PageColumn("line"), PageColumn("move"), PageColumn("cause"), PageColumn("what"))
_CAUSES = (
    PageColumn("cause"),
    PageColumn("gives back", "s", 3, bar=True),
    PageColumn("time", "s", 3),
    PageColumn("share", "%", 0),
    PageColumn("moves"),
    PageColumn("line"),
)
_LINES = (
    PageColumn("line"),
    PageColumn("move"),
    PageColumn("together", "s", 3, bar=True),
    PageColumn("times"),
    PageColumn("share", "%", 0),
    PageColumn("motion", "s", 3),
    PageColumn("waits", "s", 3),
    PageColumn("settling", "s", 3),
    PageColumn("limited by"),
)


def page_shares(program: Program, report: Report, track: int = -1) -> list[PageShare]:
    """What the whole time goes into; of a track among several, beside which it is shown."""
    cycle = shares(program, report)
    if cycle.passes:
        parts = {"motion": cycle.motion, "waits": cycle.waiting, "devices": cycle.devices}
    else:
        parts = {
            "motion": report.moving,
            "settling": report.settling,
            "waits": cycle.waiting,
            "devices": cycle.devices,
        }
    return [PageShare(name, spent, track) for name, spent in parts.items() if spent > 0.0]


def page_moves(
    program: Program, report: Report, sources: SourceList, track: int, tools: Sequence[str]
) -> list[PageMove]:
    """The moves as the page names them."""
    made = []
    for move, own in zip(report.moves, program.moves, strict=True):
        source, line = sources.place(track, move.span)
        begin, end = span_of(move)
        tool = tools.index(own.tool.name) if own.tool.name in tools else 0
        label = f"{move.kind} {target_text(move)}"
        made.append(
            PageMove(move.number, label, source, line, tool, 0, begin, end, move.fault is not None)
        )
    return made


def span_of(move: MoveReport) -> tuple[float | None, float | None]:
    """When a move begins and ends, settled; Nones where it is not driven."""
    if not move.driven:
        return None, None
    return move.begin, move.begin + move.time + move.settling


def moves_table(report: Report, sources: SourceList, track: int) -> PageTable:
    """A row a move; shown beside its track."""
    rows = []
    for move in report.moves:
        source, line = sources.place(track, move.span)
        head = (float(move.number), move.kind, target_text(move), float(line) if line else None)
        level = "error" if move.fault is not None else ""
        cells: tuple[PageCell, ...]
        if move.driven:
            limit = move.limits[0] if move.limits else None
            cells = (
                *head,
                move.begin,
                move.time + move.settling,
                move.wait or None,
                1e3 * move.length,
                1e3 * move.top_speed,
                None if move.programmed_speed is None else 1e3 * move.programmed_speed,
                zone_text(move.zone),
                "" if limit is None else f"{limit.name} ({100 * limit.share:.0f} %)",
            )
        else:
            why = "not driven" if move.fault is None else f"fault: {move.fault.cause}"
            cells = (*head, None, None, move.wait or None, None, None, None, "", why)
        t = move.begin if move.driven else None
        rows.append(PageRow(cells, level, track, t, move.number - 1, source, line))
    return PageTable("Moves", MOVES, rows, track=track)


def time_tables(run: Run, sources: SourceList, track: int) -> list[PageTable]:
    """What the time is lost to, and what each line takes; shown beside their track.

    Args:
        run: the run.
        sources: files of the page.
        track: of the run.
    """
    return [*_causes(run, sources, track), _lines(run, sources, track)]


def _causes(run: Run, sources: SourceList, track: int) -> list[PageTable]:
    """A row a cause; nothing where nobody knows who drives the program."""
    try:
        causes = run.causes
    except FlybyError:
        return []
    whole = run.report.driven_time or 1.0
    rows = []
    for cause in causes:
        source, line = sources.place(track, cause.span)
        first = run.report.moves[cause.moves[0] - 1]
        cells = (
            cause.name,
            cause.gain,
            cause.time,
            None if cause.time is None else 100.0 * cause.time / whole,
            float(len(cause.moves)),
            float(line) if line else None,
        )
        t = first.begin if first.driven and not line else None
        rows.append(PageRow(cells, "", track, t, None, source, line))
    note = run.first_to_change() or "Nothing holds the program back by itself."
    return [PageTable("Causes", _CAUSES, rows, note, track)]


def _lines(run: Run, sources: SourceList, track: int) -> PageTable:
    """A row a line, what takes longest first."""
    lines = sorted(run.lines, key=lambda line: -line.total)
    whole = sum(line.total for line in lines) or 1.0
    rows = []
    for one in lines:
        source, line = sources.place(track, one.span)
        limit = one.limits[0] if one.limits else None
        cells = (
            float(line) if line else None,
            f"{one.kind} {one.target}",
            one.total,
            float(one.times),
            100.0 * one.total / whole,
            one.time or None,
            one.wait or None,
            one.settling or None,
            "" if limit is None else f"{limit.name} ({100 * limit.share:.0f} %)",
        )
        t = run.report.moves[one.moves[0] - 1].begin if one.moves and not line else None
        rows.append(PageRow(cells, "", track, t, None, source, line))
    return PageTable("Lines", _LINES, rows, track=track)


def faults_table(report: Report, sources: SourceList, track: int) -> PageTable | None:
    """A row a fault; None without any."""
    rows = []
    for fault in report.faults:
        source, line = sources.place(track, fault.span)
        cells = (
            float(line) if line else None,
            float(fault.move + 1),
            str(fault.cause),
            fault.message,
        )
        rows.append(PageRow(cells, "error", track, None, fault.move, source, line))
    return PageTable("Faults", _FAULTS, rows) if rows else None


def notes_rows(
    notes: Sequence[Note], report: Report, sources: SourceList, track: int
) -> list[PageTable]:
    """A table with a row a kind of note, the first of it; nothing without any.

    Args:
        notes: of the result.
        report: of the run that they are about.
        sources: files of the page.
        track: of the run.
    """
    rows = []
    for same in alike(notes, lambda note: note.message):
        note = same[0]
        more = f" (and {len(same) - 1} like it)" if len(same) > 1 else ""
        source, line = sources.place(track, note.span)
        number = None if note.move is None else float(note.move + 1)
        t = None
        if note.move is not None and note.move < len(report.moves):
            move = report.moves[note.move]
            t = move.begin if move.driven else None
        cells = (float(line) if line else None, number, note.message + more)
        rows.append(PageRow(cells, "warning", track, t, note.move, source, line))
    return [PageTable("Notes", _NOTES, rows)] if rows else []

"""The page of a changed program: before and after on one clock, what changed, the proof."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import degrees
from typing import TYPE_CHECKING

from ...core.program.move import Move
from ...core.program.zone import Radius, Zone, zone_shown
from ...drawing.page.content import (
    Page,
    PageCell,
    PageColumn,
    PageRow,
    PageTable,
)
from ...drawing.page.curves import CHARTS
from ...problems.improve.solution import Solution
from ..emulate import EmulateOptions, emulate_with
from ..results.lines import in_lines
from ..results.report import target_text
from ..setup import setup_of_program
from .meetings import meeting_times
from .program_tables import moves_table, notes_rows, page_shares, time_tables
from .run_page import PageDraft, made_by

if TYPE_CHECKING:
    from ...core.cell.cell import Cell
    from ...core.errors import Span
    from ...problems.improve.zones.changes import ZoneChange
    from ..results.runs import Run

BEFORE, AFTER = "before", "after"
_TURNED = 0.005
"""Degrees from which on a turn is said: rounding of joints turns a tool by less."""
_FIGURES = (
    PageColumn("figure"),
    PageColumn("unit"),
    PageColumn(BEFORE, "", 4),
    PageColumn(AFTER, "", 4),
    PageColumn("change", "%", 1),
)
_CHANGES = (
    PageColumn("#"),
    PageColumn("line"),
    PageColumn("target"),
    PageColumn("times"),
    PageColumn("saved", "s", 3, bar=True),
    PageColumn("zone"),
    PageColumn("moved", "mm", 1),
    PageColumn("turned", "°", 2),
    PageColumn("no larger because of"),
)


def solution_page(made: Solution, cell: Cell | None = None) -> Page:
    """The page of what an optimisation made of a program.

    Args:
        made: the optimisation's.
        cell: that it was made in; None for what the program's setup says.

    Raises:
        FlybyError: one of the programs cannot be driven.
    """
    setup = setup_of_program(made.original)
    cell = cell or setup.surroundings(made.original)
    runs = [emulate_with(made.original, EmulateOptions())]
    if made.changed:
        runs.append(emulate_with(made.program, EmulateOptions()))
    draft = PageDraft()
    draft.drive(runs, cell, [BEFORE, AFTER] if made.changed else [""])
    draft.meet(0, meeting_times(runs))
    if made.certificate is not None:
        draft.prove(len(runs) - 1, made.certificate, runs[-1], cell)
    last = runs[-1]
    tables = [
        *([changes_table(made, runs, draft)] if made.changed else []),
        _figures(made),
        *(table for k, run in enumerate(runs) for table in _of_run(run, k, draft)),
        *notes_rows(made.notes, last.report, draft.sources, len(runs) - 1),
    ]
    return Page(
        f"{made.program.name} on {last.robot.name}",
        kind_of(made),
        _facts(made),
        [s for k, run in enumerate(runs) for s in page_shares(run.program, run.report, k)],
        draft.arms,
        draft.tracks,
        draft.files(),
        tables,
        CHARTS,
        made_by=made_by(),
    )


def kind_of(made: Solution) -> str:
    """What was done."""
    return "zones" if type(made).__name__ == "ZoneSolution" else "optimize"


def _facts(made: Solution) -> dict[str, str]:
    before, after = made.before.time, made.after.time
    if not made.changed:
        return {made.timed: f"{before:.3f} s", "change": "nothing better was found"}
    facts = {
        made.timed: f"{before:.3f} → {after:.3f} s",
        "change": f"{100 * (after / before - 1):+.1f} %",
    }
    if made.after.clearance is not None:
        facts["proven clearance"] = f"{1e3 * made.after.clearance:.1f} mm"
    return facts


def _figures(made: Solution) -> PageTable:
    names = setup_of_program(made.original).robot.axis_names
    rows = [
        PageRow((row.what, row.unit, row.before, row.after, row.change))
        for row in made.table(names)
    ]
    return PageTable("Figures", _FIGURES, rows)


def _of_run(run: Run, track: int, draft: PageDraft) -> Iterator[PageTable]:
    yield from time_tables(run, draft.sources, track)
    yield moves_table(run.report, draft.sources, track)


def changes_table(
    made: Solution, runs: Sequence[Run], draft: PageDraft, track: int = 1
) -> PageTable:
    """A row a line that is otherwise, with the seconds that it saves in all its passes, those that
    save most first.

    Args:
        made: the solution.
        runs: of the program before and after.
        draft: of the page.
        track: of the program after.
    """
    _, after = runs
    old, new = made.original.moves, made.program.moves
    alike = len(old) == len(new)
    moved = {point.move: point for point in made.moved}
    zones: dict[int, ZoneChange] = {change.move: change for change in getattr(made, "zones", ())}
    changed: list[tuple[int, Span | None, tuple[PageCell, ...]]] = []
    for index, move in enumerate(new):
        was = old[index] if alike else None
        point = moved.get(index)
        change = zones.get(index)
        saved = made.gained.get(index)
        same = was is not None and was.zone == move.zone and point is None
        if same and change is None and (saved is None or abs(saved) < 5e-4):
            continue
        turned = 0.0 if point is None else degrees(point.turn)
        said: tuple[PageCell, ...] = (
            target_text(after.report.moves[index]),
            _zones(was, move),
            None if point is None else 1e3 * point.distance,
            turned if turned >= _TURNED else None,
            "" if change is None else change.limit,
        )
        changed.append((index, move.statement, said))
    rows: list[tuple[float, PageRow]] = []
    for passes in in_lines(changed, lambda one: one[1:]):
        index, span, (target, *zone, limit) = passes[0]
        gains = [made.gained[k] for k, *_ in passes if k in made.gained]
        saved = sum(gains) if gains else None
        source, line = draft.sources.place(track, span)
        times = float(len(passes)) if len(passes) > 1 else None
        at = float(line) if line else None
        cells = (float(index + 1), at, target, times, saved, *zone, limit)
        report = after.report.moves[index]
        t = report.begin if report.driven else None
        rows.append((saved or 0.0, PageRow(cells, "", track, t, index, source, line)))
    rows.sort(key=lambda row: -row[0])
    return PageTable("Changes", _CHANGES, [row for _, row in rows])


def _zones(was: Move | None, move: Move) -> str:
    """The zone of a move, and what it was where it is another."""
    now = _zone(move.zone)
    if was is None or was.zone == move.zone:
        return now
    # One unit is enough: the column is narrow.
    unit = " mm" if isinstance(move.zone, Radius) else ""
    return f"{_zone(was.zone).removesuffix(unit)} → {now}"


def _zone(zone: Zone) -> str:
    return f"{1e3 * zone.tcp:.5g} mm" if isinstance(zone, Radius) else zone_shown(zone)

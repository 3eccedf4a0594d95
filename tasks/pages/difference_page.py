"""The page of two states of a program: each routine before and after, and what differs."""

from __future__ import annotations

from collections.abc import Iterator
from math import degrees
from typing import TYPE_CHECKING

from ...drawing.page.content import (
    Page,
    PageCell,
    PageColumn,
    PageRow,
    PageTable,
)
from ...drawing.page.curves import CHARTS
from ..diff.comparing import StateDifference
from .meetings import differing_times
from .program_tables import moves_table, page_shares, time_tables
from .run_page import PageDraft, cell_of, made_by

if TYPE_CHECKING:
    from ..results.runs import Run

MOST = 8
"""Routines that a page drives, those that differ first."""
_ROUTINES = (
    PageColumn("routine"),
    PageColumn("before", "s", 3),
    PageColumn("after", "s", 3),
    PageColumn("change", "%", 1),
    PageColumn("paths apart", "mm", 2),
    PageColumn("clearance before", "mm", 1),
    PageColumn("after", "mm", 1),
)
_DIFFERENCES = (
    PageColumn("what"),
    PageColumn("name"),
    PageColumn("before"),
    PageColumn("after"),
    PageColumn("apart", "mm", 3),
    PageColumn("turned", "°", 3),
    PageColumn("line"),
)
_FILES = (
    PageColumn("file"),
    PageColumn(""),
    PageColumn("lines +"),
    PageColumn("lines −"),
    PageColumn("moved"),
)
_FAULTS = (PageColumn("routine"), PageColumn(""), PageColumn("fault"))


def difference_page(found: StateDifference) -> Page:
    """The page of two states that were compared."""
    draft = PageDraft()
    tracks: dict[str, int] = {}
    shown: list[Run] = []
    for name, runs in _driven(found):
        tracks[name] = len(draft.tracks)
        sides = ["before", "after"] if len(runs) == 2 else [""]
        draft.drive(runs, cell_of(runs[-1]), sides, name)
        if len(runs) == 2:
            draft.meet(tracks[name], differing_times(*runs))
        shown += runs
    tables = [
        *([] if found.undriven else [_routines(found, tracks)]),
        _differences(found, draft),
        _faults(found),
        _files(found),
        *(
            table
            for k, run in enumerate(shown)
            for table in (
                *time_tables(run, draft.sources, k),
                moves_table(run.report, draft.sources, k),
            )
        ),
    ]
    return Page(
        f"{found.before.name} → {found.after.name}",
        "diff",
        _facts(found),
        [s for k, run in enumerate(shown) for s in page_shares(run.program, run.report, k)],
        draft.arms,
        draft.tracks,
        draft.files(),
        [table for table in tables if table.rows],
        CHARTS,
        notes=_notes(found),
        chosen=_after(draft, next(iter(tracks), "")),
        made_by=made_by(),
    )


def _facts(found: StateDifference) -> dict[str, str]:
    """Figures at the top: times of the first routine where both sides drive it to its end."""
    facts = {}
    before, after = found.routines[0].times if found.routines else (None, None)
    if before is not None and after is not None:
        facts["cycle time"] = f"{before:.3f} → {after:.3f} s"
        if before > 0.0:
            facts["change"] = f"{100 * (after / before - 1):+.1f} %"
    return {**facts, "differences": str(len(found.differences))}


def _after(draft: PageDraft, routine: str) -> int:
    """The last track of a routine."""
    return max((k for k, one in enumerate(draft.tracks) if one.group == routine), default=-1)


def _notes(found: StateDifference) -> tuple[str, ...]:
    same = () if found.differs else ("The two do not differ.",)
    return (*same, f"Nothing is driven: {found.undriven}.") if found.undriven else same


def _driven(found: StateDifference) -> Iterator[tuple[str, list[Run]]]:
    """Routines with what could be driven of them, those that differ first."""
    order = sorted(found.routines, key=lambda routine: not routine.differs)
    for routine in order[:MOST]:
        runs = [run for run in found.runs.get(routine.name, ()) if run is not None]
        if len(runs) == 2 and runs[0].robot.size != runs[1].robot.size:
            runs = runs[1:]
        if runs:
            yield routine.name, runs


def _routines(found: StateDifference, tracks: dict[str, int]) -> PageTable:
    rows = []
    for one in found.routines:
        before, after = one.times
        change = 100 * (after / before - 1) if before and after is not None else None
        near = [None if value is None else 1e3 * value for value in one.clearances]
        apart = None if one.distance is None else 1e3 * one.distance
        track = tracks.get(one.name)
        rows.append(
            PageRow(
                (one.name, *map(_seconds, one.times), change, apart, *near),
                "warning" if one.differs else "",
                0 if track is None else track + 1,
                None if track is None else 0.0,
            )
        )
    return PageTable("Routines", _ROUTINES, rows)


def _seconds(time: float | None) -> PageCell:
    return "not driven" if time is None else time


def _differences(found: StateDifference, draft: PageDraft) -> PageTable:
    rows = []
    for one in found.differences:
        places = [draft.sources.place(track, one.span) for track in range(len(draft.tracks))]
        track, (source, line) = next(
            ((k, place) for k, place in enumerate(places) if place[1]), (0, (-1, 0))
        )
        rows.append(
            PageRow(
                (
                    one.subject.value,
                    one.name,
                    one.before,
                    one.after,
                    None if one.distance is None else 1e3 * one.distance,
                    None if one.angle is None else degrees(one.angle),
                    None if one.span is None else float(one.span.line),
                ),
                "",
                track,
                None,
                None,
                source,
                line,
            )
        )
    return PageTable("Differences", _DIFFERENCES, rows)


def _faults(found: StateDifference) -> PageTable:
    rows = [
        PageRow((routine.name, said, fault), level)
        for routine in found.routines
        for said, level, faults in (
            ("new", "error", routine.faults),
            ("mended", "note", routine.mended),
            ("on both sides", "warning", routine.lasting),
        )
        for fault in faults
    ]
    return PageTable("Faults", _FAULTS, rows)


def _files(found: StateDifference) -> PageTable:
    return PageTable(
        "Files",
        _FILES,
        [
            PageRow((f.name, f.kind, float(f.added), float(f.removed), float(f.moved or 0)))
            for f in found.files
        ],
    )

"""The page of a station with better programs: robots on one clock, what changed, what it saves."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ...core.driving.driven_program import DrivenProgram
from ...drawing.page.content import Page, PageBars, PageColumn, PageRow, PageTable
from ...problems.improve.station.feasibility import StationSnapshot
from ..results.runs import Run
from ..results.stations import DrivenStation
from ..station.changed import ChangedStation
from .solution_page import changes_table, kind_of
from .station_page import StationPage

_ROBOTS = (
    PageColumn("robot"),
    PageColumn("drives, before", "s", 3),
    PageColumn("after", "s", 3, bar=True),
    PageColumn("ends, before", "s", 3),
    PageColumn("after", "s", 3, bar=True),
    PageColumn("proven"),
)


def changed_station_page(made: ChangedStation) -> Page:
    """The page of a station with better programs."""
    shown = StationPage(_driven(made, made.after), distances=True)
    page = shown.page()
    kinds = [kind_of(solution) for solution in made.solutions.values()]
    facts = {
        "station time": f"{made.before.duration:.3f} → {made.after.duration:.3f} s",
        "change": f"{-made.gain:+.1f} %" if made.changed else "nothing better was found",
        "ends last": page.facts["ends last"],
    }
    rows = [
        PageRow((name, *map(float, times), said), "", track)
        for track, (name, *times, said) in enumerate(made.robot_rows())
    ]
    tables = [
        PageTable("Robots", _ROBOTS, rows),
        *_changes(made, shown),
        *(table for table in page.tables if table.title != "Robots"),
    ]
    gantt, tracks = [*page.gantt], list(page.tracks)
    if made.changed:
        robots = len(made.station.members)
        gantt[robots:robots] = _before(made)
        # The clock runs until the slower of both has ended.
        last = max(made.before.duration, made.after.duration)
        tracks = [replace(track, duration=last, takes=track.duration) for track in tracks]
    kind = kinds[0] if kinds else "station"
    return replace(page, kind=kind, facts=facts, tables=tables, gantt=gantt, tracks=tracks)


def _driven(made: ChangedStation, state: StationSnapshot) -> DrivenStation:
    """A state of the station; what is proven of its robots is said with the changes."""
    notes = made.notes if state is made.after else ()
    return DrivenStation(
        state.station, state.actions, state.run, None, state.orders, (), 0.0, (), notes
    )


def _changes(made: ChangedStation, shown: StationPage) -> Iterator[PageTable]:
    """What changed, beside each robot whose program did."""
    for track, name in enumerate(made.station.members):
        solution = made.solutions.get(name)
        if solution is None or not solution.changed:
            continue
        member, clock = made.station.members[name], shown.clocks[track]
        before = Run.of(DrivenProgram.faultless(member.run), member.run.path.route.robot)
        table = changes_table(solution, [before, shown.runs[track]], shown.draft, track)
        rows = [
            row if row.t is None else replace(row, t=clock.last_at(row.t)) for row in table.rows
        ]
        yield replace(table, rows=rows, track=track)


def _before(made: ChangedStation) -> Iterator[PageBars]:
    """Rows over time of the robots as they drove before."""
    names = set(made.station.members)
    for row in StationPage(_driven(made, made.before)).page().gantt:
        if row.name in names:
            bars = [replace(bar, source=-1, line=0) for bar in row.bars]
            yield PageBars(f"{row.name}, before", bars)

"""The page of programs between time and energy: points to pick, each driven."""

from __future__ import annotations

from ...core.errors import FlybyError
from ...drawing.page.content import (
    Page,
    PageColumn,
    PageFront,
    PagePoint,
    PageRow,
    PageTable,
)
from ...drawing.page.curves import CHARTS
from ..emulate import EmulateOptions, emulate_with
from ..results.fronts import ProgramFront
from ..results.runs import Run
from ..setup import setup_of_program
from .meetings import meeting_times
from .program_tables import moves_table, time_tables
from .run_page import PageDraft, made_by

GIVEN = "given"


def front_page(made: ProgramFront) -> Page:
    """The page of a front.

    Raises:
        FlybyError: the given program cannot be driven.
    """
    programs = [made.given.program, *(point.program for point in made.points)]
    names = [GIVEN, *(f"point {k}" for k in range(1, len(programs)))]
    setup = setup_of_program(programs[0])
    runs: list[Run] = []
    tracks: list[int] = []
    for program in programs:
        try:
            runs.append(emulate_with(program, EmulateOptions()))
            tracks.append(len(runs) - 1)
        except FlybyError:
            if not runs:
                raise
            tracks.append(-1)
    draft = PageDraft()
    shown = [name for name, track in zip(names, tracks, strict=True) if track >= 0]
    draft.drive(runs, setup.surroundings(programs[0]), shown, ghosts=1)
    draft.meet(0, meeting_times(runs))
    points = [made.given, *made.points]
    for point, track, run in zip(points, tracks, _spread(runs, tracks), strict=True):
        if point.certificate is not None and run is not None:
            draft.prove(track, point.certificate, run, setup.surroundings(programs[0]))
    tables = [
        _table(made, tracks),
        *(table for k, run in enumerate(runs) for table in time_tables(run, draft.sources, k)),
        *(moves_table(run.report, draft.sources, k) for k, run in enumerate(runs)),
    ]
    return Page(
        f"{programs[0].name} on {setup.robot.name}",
        "pareto",
        _facts(made),
        (),
        draft.arms,
        draft.tracks,
        draft.files(),
        tables,
        CHARTS,
        front=PageFront(
            "cycle time, s",
            "energy, % of the given program's",
            [
                PagePoint(
                    point.duration, 100.0 * point.energy / abs(made.given.energy), name, track
                )
                for point, name, track in zip(points, names, tracks, strict=True)
            ],
        ),
        notes=[str(note) for note in made.notes[:3]],
        made_by=made_by(),
    )


def _spread(runs: list[Run], tracks: list[int]) -> list[Run | None]:
    return [runs[track] if track >= 0 else None for track in tracks]


def _facts(made: ProgramFront) -> dict[str, str]:
    facts = {"given": f"{made.given.duration:.3f} s", "programs": str(len(made.points))}
    if made.points:
        first, last = made.points[0], made.points[-1]
        saved = 100.0 * (last.energy / abs(made.given.energy) - 1.0)
        told = f"{last.duration:.3f} s with {saved:+.0f} % energy"
        if len(made.points) == 1:
            return {**facts, "found": told}
        facts["from"] = f"{first.duration:.3f} s"
        facts["to"] = told
    return facts


def _table(made: ProgramFront, tracks: list[int]) -> PageTable:
    columns = [PageColumn(title) for title, _ in made.columns()]
    rows = [
        PageRow(row, "", max(track, 0), 0.0 if track >= 0 else None)
        for row, track in zip(made.rows(), tracks, strict=True)
    ]
    return PageTable("Points", columns, rows)

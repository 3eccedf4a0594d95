"""The page of a fit: parameters, what is left run by run, each run as emulated and as measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...core.driving.driven_program import DrivenProgram
from ...drawing.page.content import (
    Page,
    PageColumn,
    PageRow,
    PageSource,
    PageTable,
)
from ...identification.fit import Outcome
from ...identification.report.corners import cut_corners
from ...identification.residuals import Figures
from ..results.identified import IdentifiedModel
from ..results.runs import Run
from .comparison_page import CHARTS_OF_LOGS, measured_track, meetings
from .meetings import meeting_times
from .run_page import PageDraft, made_by

MOST = 24
"""Runs that a page drives, those that deviate most first; tables have all of them."""
_PARAMETERS = (
    PageColumn("parameter"),
    PageColumn("start"),
    PageColumn("fitted"),
    PageColumn("deviation"),
    PageColumn("95 %"),
)
_LEFT = (
    PageColumn("run"),
    PageColumn("path before", "mm", 3),
    PageColumn("after", "mm", 3, bar=True),
    PageColumn("99 % before", "mm", 3),
    PageColumn("after", "mm", 3),
    PageColumn("joints' path before", "°", 3),
    PageColumn("after", "°", 3),
    PageColumn("at their time, 99 %, before", "°", 3),
    PageColumn("after", "°", 3),
)
_TIMES = (
    PageColumn("run"),
    PageColumn("logged", "s", 3),
    PageColumn("emulated before", "s", 3),
    PageColumn("after", "s", 3),
    PageColumn("emulated / logged", "", 4),
    PageColumn("drift", "ms", 1),
    PageColumn("clock", "", 5),
    PageColumn("zones"),
)
_CORNERS = (
    PageColumn("run"),
    PageColumn("corner of move"),
    PageColumn("zone", "mm", 1),
    PageColumn("from the waypoint, logged", "mm", 3),
    PageColumn("emulated", "mm", 3),
    PageColumn("path off nearby", "mm", 3, bar=True),
)


def identified_page(made: IdentifiedModel) -> Page:
    """The page of a fit."""
    fitted, judged = made.fit, made.judgement
    worst = sorted(made.outcomes, key=lambda one: -one.after.figures.path_max)
    draft = PageDraft()
    tracks: dict[str, int] = {}
    for one in worst[:MOST]:
        tracks[one.run.name] = len(draft.tracks) + 1
        _drive(draft, one)
    notes = [] if judged is None else [f"To judge the fit: {judged.told}."]
    if judged is not None and not judged.better:
        notes.insert(0, f"What was fitted {judged.verdict} the model before it.")
    tables = [
        PageTable("Runs", _LEFT, [_left(one, tracks) for one in worst], _SAID),
        PageTable("Parameters", _PARAMETERS, _parameters(made)),
        PageTable("Cycle times", _TIMES, [_times(one, tracks) for one in worst]),
        _corners(worst, tracks, draft),
        PageTable(
            "Notes", (PageColumn("what"),), [PageRow((note,), "warning") for note in _notes(made)]
        ),
    ]
    return Page(
        f"How {fitted.runs[0].robot.name} is driven",
        "identify",
        _facts(made),
        (),
        draft.arms,
        draft.tracks,
        # Behind the programs, whose lines moves name.
        [
            *draft.files(),
            *(PageSource("motion file", made.text, track) for track in range(len(draft.tracks))),
        ],
        [table for table in tables if table.rows],
        CHARTS_OF_LOGS,
        notes=notes,
        chosen=tracks.get(worst[0].run.name, -1),
        made_by=made_by(),
    )


_SAID = "Log less emulation, greatest. Path: time aside; at their time: after one constant offset."


def _facts(made: IdentifiedModel) -> dict[str, str]:
    """Figures at the top: the greatest of all runs, before the fit and after it."""
    path, off = [], []
    for found in ([one.before for one in made.outcomes], [one.after for one in made.outcomes]):
        path.append(1e3 * max(one.figures.path_max for one in found))
        off.append(100.0 * max(abs(one.figures.cycle_time_ratio - 1.0) for one in found))
    return {
        "path off by, at most": f"{path[0]:.3f} → {path[1]:.3f} mm",
        "cycle times off by": f"{off[0]:.1f} → {off[1]:.1f} %",
        "runs": str(len(made.outcomes)),
        "parameters": str(made.fit.parameters.size),
        "loss": f"{made.fit.before:.4g} → {made.fit.after:.4g}",
    }


def _drive(draft: PageDraft, one: Outcome) -> None:
    """A run as emulated before and after the fit, and as measured."""
    name = one.run.name
    runs = [
        Run.of(DrivenProgram.faultless(found.driven), found.robot)
        for found in (one.before, one.after)
    ]
    draft.drive(runs, None, ["before the fit", "after it"], name)
    for k, found in enumerate((one.before, one.after), len(draft.tracks) - len(runs)):
        draft.tracks[k] = replace(draft.tracks[k], takes=found.alignment.moving)
    draft.tracks.append(measured_track(one.after, draft, name))
    before, after = meeting_times(runs).T
    emulated, logged = meetings(one.after).T
    met = np.column_stack([np.interp(emulated, after, before), emulated, logged])
    draft.meet(len(draft.tracks) - 3, met)


def _parameters(made: IdentifiedModel) -> list[PageRow]:
    starts = {p.name: p.start for p in made.fit.parameters.parameters}
    return [
        PageRow(
            (
                one.name,
                f"{starts[one.name]:.5g}",
                f"{one.value:.5g}",
                f"{one.deviation:.2g}",
                f"{one.lower:.4g} … {one.upper:.4g}",
            )
        )
        for one in made.fit.intervals
    ]


def _row(one: Outcome, tracks: dict[str, int], cells: Sequence[str | float | None]) -> PageRow:
    """A row that leads to its run."""
    track = tracks.get(one.run.name)
    return PageRow(cells, "", track or 0, None if track is None else 0.0)


def _left(one: Outcome, tracks: dict[str, int]) -> PageRow:
    both = [_numbers(found.figures) for found in (one.before, one.after)]
    return _row(one, tracks, (one.run.name, *(v for pair in zip(*both, strict=True) for v in pair)))


def _numbers(f: Figures) -> tuple[float, ...]:
    degrees = map(float, np.degrees([f.joint_path_max, f.joint_time_p99]))
    return 1e3 * f.path_max, 1e3 * f.path_p99, *degrees


def _times(one: Outcome, tracks: dict[str, int]) -> PageRow:
    before, after = one.before.alignment, one.after.alignment
    zones = f"× {one.nuisance.size:.4g}" if not one.run.run.zones_known else "as programmed"
    cells = (
        one.run.name,
        after.logged_moving,
        before.moving,
        after.moving,
        after.cycle_time_ratio,
        1e3 * one.after.figures.drift,
        one.nuisance.clock,
        zones,
    )
    return _row(one, tracks, cells)


def _corners(runs: Sequence[Outcome], tracks: dict[str, int], draft: PageDraft) -> PageTable:
    """A row a corner; a click leads to where it is driven."""
    rows = [
        PageRow(
            (
                one.run.name,
                float(corner.move + 1),
                1e3 * corner.radius,
                1e3 * corner.logged,
                1e3 * corner.emulated,
                1e3 * corner.off,
            ),
            track=tracks.get(one.run.name, 0),
            t=_passed(draft, tracks.get(one.run.name), corner.move),
        )
        for one in runs
        for corner in cut_corners(one.after)
    ]
    return PageTable("Corners", _CORNERS, rows)


def _passed(draft: PageDraft, track: int | None, move: int) -> float | None:
    """s, when the end of a move is passed; None for a run that the page does not drive."""
    return None if track is None else draft.tracks[track].moves[move].end


def _notes(made: IdentifiedModel) -> list[str]:
    """What the user should know, and what logs would be off by as they were read."""
    told = list(made.notes)
    for one in made.outcomes:
        read = one.after.read
        if read is not None:
            told.append(
                f"{one.run.name}: as read, the TCP is off its path by up to "
                f"{1e3 * read.path_max:.3f} mm, the joints off theirs by up to "
                f"{np.degrees(read.joint_path_max):.3f}°"
            )
    return told

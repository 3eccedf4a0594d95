"""The page of a log beside its emulation: both arms together, and how far they are apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...core.driving.driven_program import DrivenProgram
from ...core.motion.command.trajectory import Trajectory
from ...drawing.page.content import (
    Page,
    PageColumn,
    PageRow,
    PageTable,
)
from ...drawing.page.curves import CHARTS, Curve
from ...drawing.page.packing import Quantised
from ...drawing.page.track_content import (
    PageChart,
    PageTrack,
)
from ...drawing.page.tracks import page_motion
from ..results.comparison import COLUMNS, Comparison
from ..results.runs import Run
from .program_tables import moves_table, page_shares, time_tables
from .run_page import PageDraft, cell_of, made_by

if TYPE_CHECKING:
    from ...identification.prediction import Prediction

APART, LATE = "apart", "late"
CHARTS_OF_LOGS = (
    PageChart(APART, "TCP off the emulated path", "mm"),
    PageChart(LATE, "Log behind the emulation", "ms"),
    *CHARTS,
)
_MOST = 20_000
"""Samples of a log that a page shows."""
_MEETINGS = 400
"""Places at which both are held together."""


def comparison_page(found: Comparison) -> Page:
    """The page of a log beside its emulation."""
    compared = found.prediction
    run = Run.of(DrivenProgram.faultless(compared.driven), compared.robot)
    draft = PageDraft()
    draft.drive([run], cell_of(run), ["emulated"])
    draft.tracks.append(measured_track(compared, draft))
    tables = [
        _figures(found),
        *time_tables(run, draft.sources, 0),
        moves_table(run.report, draft.sources, 0),
        *_notes(found),
    ]
    aligned = compared.alignment
    return Page(
        f"{found.run.name} on {compared.robot.name}",
        "compare",
        {
            "emulated": f"{aligned.moving:.3f} s",
            "logged": f"{aligned.logged_moving:.3f} s",
            "the robot took": f"{found.longer} emulated",
            "path off by": f"{1e3 * found.figures.path_max:.2f} mm at most",
        },
        page_shares(run.program, run.report),
        draft.arms,
        draft.tracks,
        draft.files(),
        tables,
        CHARTS_OF_LOGS,
        together=_meetings(compared),
        made_by=made_by(),
    )


def measured_track(compared: Prediction, draft: PageDraft, group: str = "") -> PageTrack:
    """What was logged, as a ghost on the clock of the emulation, with how far it is off.

    Args:
        compared: the log beside its emulation.
        draft: whose last arm it is of.
        group: of the track.
    """
    found, aligned = compared.residuals, compared.alignment
    rows = slice(None, None, max(1, len(found.t) // _MOST))
    q = compared.log.q[aligned.rows][rows]
    t = found.t[rows] - aligned.offset
    begin = float(t[0])
    late = 1e3 * (t - aligned.time[rows])
    dq = np.gradient(q, t, axis=0) if len(t) > 1 else np.zeros_like(q)
    count = len(t)
    motion = Trajectory(
        t,
        q,
        dq,
        np.zeros_like(q),
        found.tcp[rows],
        np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)),
        np.zeros(count),
        np.zeros(count, dtype=np.int64),
    )
    path = 1e3 * found.path[rows]
    curves = [
        Curve("TCP", APART, path, max(0.01 * float(path.max()), 0.002)),
        Curve("log", LATE, late, max(0.01 * float(np.abs(late).max()), 0.1)),
    ]
    made, channels = page_motion(motion, compared.robot, curves)
    tool = compared.driven.program.moves[0].tool.name
    return PageTrack(
        "measured",
        len(draft.arms) - 1,
        float(t[-1]) - begin,
        made,
        channels=channels,
        ghost=True,
        group=group,
        tool=[one.name for one in draft.arms[-1].tools].index(tool),
    )


def _meetings(compared: Prediction) -> Quantised:
    """When the emulation is where the log was: rows of both tracks' times."""
    found, aligned = compared.residuals, compared.alignment
    rows = np.unique(np.linspace(0, len(found.t) - 1, _MEETINGS).round().astype(np.int64))
    emulated = np.maximum.accumulate(aligned.time[rows])
    logged = found.t[rows] - found.t[0]
    return Quantised(np.column_stack([emulated, logged]), 1e-4)


def _figures(found: Comparison) -> PageTable:
    columns = [PageColumn(title) for title, _ in COLUMNS]
    return PageTable("Log less emulation", columns, [PageRow(row) for row in found.rows()])


def _notes(found: Comparison) -> list[PageTable]:
    rows = [PageRow((note,), "warning") for note in found.notes]
    return [PageTable("Notes", [PageColumn("what")], rows)] if rows else []

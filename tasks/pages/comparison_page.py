"""The page of a log beside its emulation: both arms together, and how far they are apart."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...core.arrays import FloatArray
from ...core.driving.driven_program import DrivenProgram
from ...core.motion.command.trajectory import Trajectory
from ...drawing.page.content import (
    Page,
    PageColumn,
    PageRow,
    PageTable,
)
from ...drawing.page.curves import CHARTS, SPEED, Curve
from ...drawing.page.track_content import (
    PageChart,
    PageTrack,
)
from ...drawing.page.tracks import page_motion
from ...identification.alignment import STILL
from ..results.comparison import COLUMNS, Comparison
from ..results.report import target_text
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
_TOLD = 0.01
"""s by which a sample may be late or early, for all that its place and the log's noise tell, and
still says how late the robot is."""
_WINDOW = 0.02
"""s over which the speed of a logged TCP is taken at least: its places are noisy."""
_MOVES = (
    PageColumn("#"),
    PageColumn("move"),
    PageColumn("target"),
    PageColumn("line"),
    PageColumn("logged", "s", 3),
    PageColumn("emulated", "s", 3),
    PageColumn("longer", "s", 3, bar=True),
    PageColumn("path off", "mm", 3, bar=True),
)


def comparison_page(found: Comparison) -> Page:
    """The page of a log beside its emulation."""
    compared = found.prediction
    run = Run.of(DrivenProgram.faultless(compared.driven), compared.robot)
    draft = PageDraft()
    draft.drive([run], cell_of(run), ["emulated"])
    draft.tracks[-1] = replace(draft.tracks[-1], takes=compared.alignment.moving)
    draft.tracks.append(measured_track(compared, draft))
    draft.meet(0, meetings(compared))
    tables = [
        _moves(found, run, draft),
        _figures(found),
        *time_tables(run, draft.sources, 0),
        moves_table(run.report, draft.sources, 0),
        *_notes(found),
    ]
    return Page(
        f"{found.run.name} on {compared.robot.name}",
        "compare",
        _facts(found),
        page_shares(run.program, run.report),
        draft.arms,
        draft.tracks,
        draft.files(),
        tables,
        CHARTS_OF_LOGS,
        made_by=made_by(),
    )


def _facts(found: Comparison) -> dict[str, str]:
    """Figures at the top: times of the motion, what the robot rests before and behind left out."""
    aligned = found.prediction.alignment
    facts = {
        "in motion, emulated": f"{aligned.moving:.3f} s",
        "logged": f"{aligned.logged_moving:.3f} s",
        "path off by": f"{1e3 * found.figures.path_max:.2f} mm at most",
    }
    if found.run.timed:
        facts["the robot took"] = f"{found.longer} emulated"
    return facts


def measured_track(compared: Prediction, draft: PageDraft, group: str = "") -> PageTrack:
    """What was logged, as a ghost on the clock of the emulation, with how far it is off.

    Args:
        compared: the log beside its emulation.
        draft: whose last arm it is of.
        group: of the track.
    """
    found, aligned = compared.residuals, compared.alignment
    rows = slice(None, None, max(1, len(found.t) // _MOST))
    t = found.t[rows] - aligned.offset
    late = 1e3 * _late(compared, t, aligned.time[rows])
    path = np.round(1e3 * found.path[rows], 3)
    speed = 1e3 * _speed(found.t, found.tcp)[rows]
    values = np.column_stack(
        [compared.log.q[aligned.rows][rows], found.tcp[rows], path, late, speed]
    )
    t, values = _from_zero(t, values)
    q, tcp = values[:, : compared.robot.size], values[:, -6:-3]
    path, late, speed = values[:, -3:].T
    dq = np.gradient(q, t, axis=0) if len(t) > 1 else np.zeros_like(q)
    count = len(t)
    motion = Trajectory(
        t,
        q,
        dq,
        np.zeros_like(q),
        tcp,
        np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)),
        np.zeros(count),
        np.zeros(count, dtype=np.int64),
    )
    curves = [
        Curve("TCP", APART, path, max(0.01 * float(path.max()), 0.002)),
        Curve("log", LATE, late, max(0.01 * float(np.abs(late).max()), 0.1)),
        Curve("TCP", SPEED, speed, max(0.003 * float(speed.max()), 0.1)),
    ]
    made, channels = page_motion(motion, compared.robot, curves)
    tool = compared.driven.program.moves[0].tool.name
    return PageTrack(
        "measured",
        len(draft.arms) - 1,
        float(t[-1]),
        made,
        channels=channels,
        ghost=True,
        group=group,
        tool=[one.name for one in draft.arms[-1].tools].index(tool),
        takes=aligned.logged_moving,
    )


def _late(compared: Prediction, t: FloatArray, time: FloatArray) -> FloatArray:
    """(K,) s that samples are behind the emulation: between those whose places tell their time,
    where the robot stands."""
    driven = compared.driven.trajectory
    speed = np.interp(time, driven.t, np.linalg.norm(driven.dq_motor, axis=1))
    told = speed * _TOLD > max(STILL, 3.0 * float(np.linalg.norm(compared.log.noise)))
    return np.interp(t, t[told], (t - time)[told]) if told.any() else t - time


def _from_zero(t: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Samples (K,), (K, C) from the emulation's zero on: until the log begins it stands still."""
    kept = t > 0.0
    first = np.array([np.interp(0.0, t, column) for column in values.T])
    return np.append(0.0, t[kept]), np.vstack([first, values[kept]])


def _speed(t: FloatArray, tcp: FloatArray) -> FloatArray:
    """(K,) m/s of logged places (K, 3), each over `_WINDOW` and two samples about it at least."""
    index = np.arange(len(t))
    before = np.minimum(np.searchsorted(t, t - 0.5 * _WINDOW), np.maximum(index - 1, 0))
    behind = np.searchsorted(t, t + 0.5 * _WINDOW, "right") - 1
    behind = np.maximum(behind, np.minimum(index + 1, len(t) - 1))
    spans = np.maximum(t[behind] - t[before], 1e-9)
    return np.asarray(np.linalg.norm(tcp[behind] - tcp[before], axis=1) / spans)


def meetings(compared: Prediction) -> FloatArray:
    """When the emulation is where the log was: (W, 2) s, of both tracks."""
    found, aligned = compared.residuals, compared.alignment
    rows = np.unique(np.linspace(0, len(found.t) - 1, _MEETINGS).round().astype(np.int64))
    emulated = np.maximum.accumulate(aligned.time[rows])
    logged = np.maximum(found.t[rows] - aligned.offset, 0.0)
    return np.column_stack([emulated, logged])


def _moves(found: Comparison, run: Run, draft: PageDraft) -> PageTable:
    """A row a move: what it took, and how far the log is off its path."""
    rows = []
    for one in found.moves:
        move = run.report.moves[one.move]
        source, line = draft.sources.place(0, move.span)
        cells = (
            float(move.number),
            move.kind,
            target_text(move),
            float(line) if line else None,
            one.logged,
            one.emulated,
            one.longer,
            None if one.off is None else 1e3 * one.off,
        )
        t = move.begin if move.driven else None
        rows.append(PageRow(cells, "", 0, t, one.move, source, line))
    told = found.times_said
    return PageTable("By move", _MOVES, rows, f"{told[0].upper()}{told[1:]}.")


def _figures(found: Comparison) -> PageTable:
    columns = [PageColumn(title) for title, _ in COLUMNS]
    return PageTable("Log less emulation", columns, [PageRow(row) for row in found.rows()])


def _notes(found: Comparison) -> list[PageTable]:
    rows = [PageRow((note,), "warning") for note in found.notes]
    return [PageTable("Notes", [PageColumn("what")], rows)] if rows else []

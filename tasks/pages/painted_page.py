"""The page of a painted part: the coat on it, and the robot that leaves it there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ...core.driving.driven_program import DrivenProgram
from ...core.motion.command.trajectory import Trajectory
from ...core.robot.joint import Joint, JointKind
from ...core.robot.model import Robot
from ...core.spatial.pose import Pose
from ...drawing.page.arm_content import (
    PageArm,
    PageBody,
    PageRole,
    PageSolid,
)
from ...drawing.page.arms import page_arm
from ...drawing.page.content import (
    Page,
    PageColumn,
    PageRow,
    PageShare,
    PageSource,
    PageTable,
)
from ...drawing.page.curves import CHARTS, SPEED, Curve
from ...drawing.page.track_content import (
    PageTrack,
)
from ...drawing.page.tracks import page_motion
from ..results.painted import COLUMNS, MICRON, PaintedPart
from ..results.runs import Run
from .coat_content import page_coat
from .program_tables import moves_table, notes_rows, page_shares, time_tables
from .run_page import PageDraft, made_by

if TYPE_CHECKING:
    from ...problems.paint.spray.trajectory import PaintTrajectory

_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def painted_page(found: PaintedPart) -> Page:
    """The page of a painted part."""
    station = found.station
    cell = None if station is None else station.cell
    place = Pose() if station is None else station.place
    draft = PageDraft()
    made = found.made
    tables = [_coats(found)]
    shares: Sequence[PageShare] = ()
    if made is not None:
        run = Run.of(DrivenProgram.faultless(made.driven.run), made.driven.run.path.route.robot)
        draft.drive([run], cell)
        if made.certificate is not None and cell is not None:
            draft.prove(0, made.certificate, run, cell)
        report = run.report
        tables += time_tables(run, draft.sources, 0)
        tables.append(moves_table(report, draft.sources, 0))
        tables += notes_rows(found.notes, report, draft.sources, 0)
        shares = page_shares(run.program, report)
    else:
        arm, track = _gun_alone(found.painting.best)
        draft.arms.append(arm)
        draft.tracks.append(track)
        rows = [PageRow((str(note),), "warning") for note in found.notes]
        tables += [PageTable("Notes", [PageColumn("what")], rows)] if rows else []
    files = draft.files() or [PageSource(name, text) for name, text in found.texts.items()]
    return Page(
        found.painting.judge.part.name,
        "paint",
        _facts(found),
        shares,
        draft.arms,
        draft.tracks,
        files,
        tables,
        CHARTS if made is not None else [chart for chart in CHARTS if chart.key == SPEED],
        page_coat(found, place),
        made_by=made_by(),
    )


def _facts(found: PaintedPart) -> dict[str, str]:
    stage, coat = list(found.coats.items())[-1]
    spread = coat.by_area
    return {
        "target": f"{coat.target / MICRON:.1f} µm",
        stage: f"{spread.mean / MICRON:.2f} ± {spread.std / MICRON:.2f} µm",
        "from to": f"{spread.least / MICRON:.1f} to {spread.most / MICRON:.1f} µm",
        "within ±10 %": f"{100.0 * spread.within_10_percent:.1f} %",
        "time": f"{coat.duration:.1f} s",
    }


def _coats(found: PaintedPart) -> PageTable:
    columns = [PageColumn(title) for title, _ in COLUMNS]
    return PageTable("By stage", columns, [PageRow(row) for row in found.rows()])


def _gun_alone(motion: PaintTrajectory) -> tuple[PageArm, PageTrack]:
    """The gun's tip by itself, on three slides, as no robot is there."""
    at = motion.position
    low, high = at.min(axis=0) - 1.0, at.max(axis=0) + 1.0
    robot = Robot(
        "gun",
        tuple(
            Joint(name, Pose(), axis, float(a), float(b), 10.0, 100.0, kind=JointKind.PRISMATIC)
            for name, axis, a, b in zip("xyz", _AXES, low, high, strict=True)
        ),
    )
    speeds = 1e3 * motion.speeds
    steps = np.diff(motion.times)
    knots = np.concatenate([motion.times[:-1], motion.times[1:] - 1e-3 * steps.min()])
    order = np.argsort(knots, kind="stable")
    t = knots[order]
    q = np.column_stack([np.interp(t, motion.times, column) for column in at.T])
    v = np.diff(at, axis=0) / steps[:, None]
    dq = np.concatenate([v, v])[order]
    count = len(t)
    moved = Trajectory(
        t,
        q,
        dq,
        np.zeros_like(q),
        q,
        np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)),
        np.zeros(count),
        np.zeros(count, dtype=np.int64),
    )
    speed = np.concatenate([speeds, speeds])[order]
    made, channels = page_motion(moved, robot, [Curve("gun", SPEED, speed, 1.0)])
    arm = page_arm(robot)
    gun = PageBody("gun", PageRole.TOOL, arm.flange, np.eye(4), PageSolid("sphere", (0.01,)))
    still = replace(arm, bodies=[gun])
    return still, PageTrack("", 0, float(t[-1]), made, channels=channels)

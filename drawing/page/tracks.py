"""A driven program as a track of a page: joints over time, curves, what limits it, its path."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

import numpy as np

from ...core.arrays import FloatArray, IntArray
from ...core.driving.driven_program import DrivenPart, DrivenProgram
from ...core.motion.command.trajectory import Trajectory
from ...core.motion.emulator.binding_limits import interval_limits
from ...core.motion.emulator.move_figures import zone_reaches
from ...core.motion.emulator.run import Run
from ...core.motion.geometry.segments import ARC_SEGMENT, JOINT_SEGMENT
from ...core.program.tool import Tool, WorkObject
from ...core.robot.kinematics.chain_kernels import poses
from ...core.robot.model import Robot
from .arms import Nodes
from .curves import Curve, curves_of
from .knots import DrawnCurves, knots
from .packing import Quantised, whole
from .track_content import (
    PageChannel,
    PageLimits,
    PageLine,
    PageMotion,
    PageWaypoints,
)

ERROR = 4e-5
"""m by which a body may be elsewhere on the page, beside rounding."""
TIME_STEP = 1e-6
"""s."""
_SPEED_STEP = 2e-5
"""rad/s or m/s, of joints: over `knots.LONGEST` less than a tenth of what they may be off."""
_POINT = 2e-5
"""m, of lines in space."""
_ARC, _JOINT_LINE = 32, 24
"""Pieces that the programmed arc, and a joint move, are drawn in."""
_SPARE = 0.3
"""m that bodies reach beyond the flange, with which joints' levers are reckoned."""


def page_motion(
    trajectory: Trajectory, robot: Robot, curves: Sequence[Curve] = ()
) -> tuple[PageMotion, list[PageChannel]]:
    """Joints over time within `ERROR`, and curves over the same knots.

    Args:
        trajectory: T samples.
        robot: whose.
        curves: with values (T,).
    """
    levers = _levers(trajectory, robot)
    tolerance = ERROR / levers.sum() * np.ones(len(levers))
    drawn = DrawnCurves(
        [curve.values for curve in curves if not curve.stepped],
        [curve.tolerance for curve in curves if not curve.stepped],
    )
    kept = knots(trajectory, tolerance, drawn)
    kept = _with_steps(kept, [curve.values for curve in curves if curve.stepped])
    step = ERROR / levers.sum()
    motion = PageMotion(
        Quantised(trajectory.t[kept] - trajectory.t[0], TIME_STEP),
        [Quantised(column, step) for column in trajectory.q[kept].T],
        [Quantised(column, _SPEED_STEP) for column in trajectory.dq[kept].T],
    )
    channels = [
        PageChannel(
            curve.name,
            curve.chart,
            Quantised(curve.values[kept], 0.25 * curve.tolerance),
            curve.stepped,
            curve.axis,
        )
        for curve in curves
    ]
    return motion, channels


def _with_steps(kept: IntArray, stepped: Sequence[FloatArray]) -> IntArray:
    """Knots, with those at which a curve steps."""
    every = [kept]
    for values in stepped:
        known = np.nan_to_num(values, nan=-1.0)
        every.append(np.flatnonzero(np.diff(known) != 0.0) + 1)
    return np.unique(np.concatenate(every))


def _levers(trajectory: Trajectory, robot: Robot) -> FloatArray:
    """(N,), how far (m per rad, or m per m) each axis moves what it carries at most, about."""
    rows = trajectory.q[:: max(1, len(trajectory.t) // 200)]
    J = np.linalg.norm(np.asarray(robot.jacobian(rows))[:, :3], axis=1).max(axis=0)
    turns = np.linalg.norm(np.asarray(robot.jacobian(rows))[:, 3:], axis=1).max(axis=0)
    # What carries a work object moves no flange.
    still = (J + turns) < 1e-9
    return np.asarray(np.where(still, 1.5, J + _SPARE * turns))


def page_limits(driven: DrivenProgram, robot: Robot) -> PageLimits:
    """What limits the speed when, over all parts."""
    names: dict[str, int] = {}
    rows: list[tuple[float, float, int]] = []
    for part, clock in zip(driven.parts, driven.begins, strict=True):
        for begin, end, name in _limit_spans(part.run, robot):
            rows.append((begin + clock, end + clock, names.setdefault(name, len(names))))
    table = np.array(rows).reshape(-1, 3)
    times = [Quantised(table[:, k], 1e-4) for k in (0, 1)]
    return PageLimits(list(names), times[0], times[1], whole(table[:, 2]))


def _limit_spans(run: Run, robot: Robot) -> Iterator[tuple[float, float, str]]:
    timing = run.timing
    names = interval_limits(run, robot.axis_names)
    begin, end = (timing.start.driven(t) + timing.lag for t in (timing.begin, timing.end))
    at = 0
    for name, group in groupby(names):
        stop = at + len(list(group))
        # A wait in between parts the same limit in two.
        rests = np.flatnonzero(begin[at + 1 : stop] - end[at : stop - 1] > 1e-6) + at + 1
        for first, last in zip([at, *rests], [*rests, stop], strict=True):
            yield float(begin[first]), float(end[last - 1]), name
        at = stop


def page_lines(driven: DrivenProgram, nodes: Nodes) -> list[PageLine]:
    """The programmed path, in the work objects of its moves."""
    return [
        line
        for part in _with_arm(driven)
        for segment in range(len(part.run.path.route.moves))
        for line in [_line(part, segment, nodes)]
    ]


def _with_arm(driven: DrivenProgram) -> list[DrivenPart]:
    """Parts that drive a tool somewhere; a positioner by itself has none."""
    return [part for part in driven.parts if part.run.path.route.robot.has_arm]


def _line(part: DrivenPart, segment: int, nodes: Nodes) -> PageLine:
    path = part.run.path
    move = path.route.moves[segment]
    kind = path.route.ends.kind[segment]
    control = path.segments.position[segment]
    if kind == JOINT_SEGMENT:
        q = path.route.ends.q[segment]
        share = np.linspace(0.0, 1.0, _JOINT_LINE + 1)[:, None]
        rows = np.ascontiguousarray((1 - share) * q[0] + share * q[1])
        points = poses(path.route.chains[segment], rows)[1]
    elif kind == ARC_SEGMENT:
        angle = np.linspace(0.0, 1.0, _ARC + 1)[:, None] * path.segments.angle[segment]
        points = control[0] + np.cos(angle) * control[1] + np.sin(angle) * control[2]
    else:
        points = np.stack([control[0], control[0] + control[1]])
    frame = part.run.program.moves[move].work_object
    placed = placed_in(frame, points)
    return PageLine(frame_node(nodes, frame), Quantised(placed, _POINT), part.first + move)


def frame_node(nodes: Nodes, frame: WorkObject) -> int:
    """The node that carries a work object."""
    return nodes.flange if frame.robot_held else nodes.carrier(frame.moved_by)


def placed_in(frame: WorkObject, points: FloatArray) -> FloatArray:
    """Points (P, 3) of a work object in the frame that carries it."""
    place = frame.pose.matrix()
    return np.asarray(points @ place[:3, :3].T + place[:3, 3])


def page_waypoints(driven: DrivenProgram, nodes: Nodes) -> PageWaypoints:
    """Where moves end, with their zones as driven."""
    at: list[FloatArray] = []
    radius: list[float] = []
    carriers: list[int] = []
    moves: list[int] = []
    for part in _with_arm(driven):
        run = part.run
        route = run.path.route
        reaches = [min(reach) for reach in zone_reaches(run.path)]
        for segment, move in enumerate(route.moves):
            frame = run.program.moves[move].work_object
            ends = np.ascontiguousarray(route.ends.q[segment])
            points = placed_in(frame, poses(route.chains[segment], ends)[1])
            for end in (0, 1) if segment == 0 else (1,):
                at.append(points[end])
                carriers.append(frame_node(nodes, frame))
                radius.append(reaches[segment] if end else 0.0)
                moves.append(part.first + move if end else -1)
    return PageWaypoints(
        whole(carriers),
        Quantised(np.array(at).reshape(-1, 3), _POINT),
        Quantised(np.array(radius), _POINT),
        whole(moves),
    )


def driven_curves(driven: DrivenProgram, robot: Robot) -> list[Curve]:
    """Curves over the samples of the whole trajectory."""
    found: dict[tuple[str, str, int | None], list[Curve]] = {}
    parts = [curves_of(part.run, robot) for part in driven.parts]
    for curves in parts:
        for curve in curves:
            found.setdefault((curve.chart, curve.name, curve.axis), []).append(curve)
    whole_curves = []
    for curves in found.values():
        if len(curves) == len(driven.parts):
            whole_curves.append(curves[0].joined(curves))
    return whole_curves


def tools_and_frames(driven: DrivenProgram) -> tuple[list[Tool], list[WorkObject]]:
    """What the moves of a program use, each once, in their order."""
    moves = driven.program.moves
    return (
        list(dict.fromkeys(move.tool for move in moves)),
        list(dict.fromkeys(move.work_object for move in moves)),
    )

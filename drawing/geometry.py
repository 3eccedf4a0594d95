"""What a plot of a path shows beside the driven one: programmed paths, waypoints, zones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..core.arrays import FloatArray
from ..core.motion.emulator.move_figures import zone_reaches
from ..core.motion.emulator.run import Run
from ..core.motion.geometry.segments import ARC_SEGMENT, JOINT_SEGMENT
from ..core.program.tool import WORLD
from ..core.robot.kinematics.chain_kernels import poses
from ..core.robot.model import Robot
from ..core.robot.work_chain import work_chain

STEPS = 40
"""Points of a curved segment."""
STILL = 1e-6
"""m by which a work object may move before it counts as moved."""


@dataclass(frozen=True)
class PathGeometry:
    """All in m, in the frame of the trajectory's TCP, or in that of the part.

    Args:
        nominal: for each segment that can be drawn the programmed path (P, 3).
        waypoints: (M + 1, 3).
        radius: (M + 1,), TCP radius of the zone round each waypoint; 0 at stops.
        driven: (T, 3), the TCP at the trajectory's samples.
    """

    nominal: tuple[FloatArray, ...]
    waypoints: FloatArray
    radius: FloatArray
    driven: FloatArray


def path_geometry(run: Run, robot: Robot) -> PathGeometry:
    """The programmed path of a run; segments in work objects that move are left out."""
    q = run.path.route.ends.q
    reaches = zone_reaches(run.path)
    starts = [_tcp(run, robot, k, q[k, :1])[0] for k in range(len(q))]
    last = _tcp(run, robot, len(q) - 1, q[-1, 1:])
    drawn = (_nominal(run, robot, k) for k in range(len(q)))
    return PathGeometry(
        tuple(points for points in drawn if points is not None),
        np.array([*starts, last[0]]),
        np.array([0.0, *(min(reach) for reach in reaches)]),
        run.trajectory.position,
    )


def turning_part(runs: Sequence[Run]) -> str | None:
    """Name of the work object that an external axis carries under all moves of runs; None where
    there are others, or it stands still."""
    moves = [run.program.moves[i] for run in runs for i in run.path.route.moves]
    carried = {(m.work_object.name, m.work_object.moved_by, m.tool.robot_held) for m in moves}
    name, axis, held = carried.pop()
    if carried or axis is None or not held:
        return None
    turned = [np.ptp(run.trajectory.q, axis=0) for run in runs]
    column = runs[0].path.route.robot.axis_names.index(axis)
    return name if max(span[column] for span in turned) > STILL else None


def part_geometry(run: Run) -> PathGeometry:
    """The path of a run in its moves' work object, however that is carried about."""
    route, trajectory = run.path.route, run.trajectory
    ends, chains = route.ends.q, route.chains
    placed = [
        poses(chain, np.ascontiguousarray(q))[1] for chain, q in zip(chains, ends, strict=True)
    ]
    segment = np.searchsorted(np.array(route.moves), trajectory.move).clip(max=len(chains) - 1)
    driven = np.empty_like(trajectory.position)
    for k in range(len(chains)):
        rows = np.flatnonzero(segment == k)
        if len(rows):
            driven[rows] = poses(chains[k], np.ascontiguousarray(trajectory.q[rows]))[1]
    share = np.linspace(0.0, 1.0, STEPS + 1)[:, None]
    nominal = [
        _in_work_object(run, k, share)
        if route.ends.kind[k] != JOINT_SEGMENT
        else poses(chains[k], (1 - share) * ends[k, 0] + share * ends[k, 1])[1]
        for k in range(len(chains))
    ]
    return PathGeometry(
        tuple(nominal),
        np.array([*(ends_of[0] for ends_of in placed), placed[-1][1]]),
        np.array([0.0, *(min(reach) for reach in zone_reaches(run.path))]),
        driven,
    )


def _in_work_object(run: Run, segment: int, share: FloatArray) -> FloatArray:
    """The programmed line or arc (P, 3) m of a segment of the TCP."""
    segments = run.path.segments
    control = segments.position[segment]
    if run.path.route.ends.kind[segment] == ARC_SEGMENT:
        angle = share * segments.angle[segment]
        return np.asarray(control[0] + np.cos(angle) * control[1] + np.sin(angle) * control[2])
    return np.asarray(control[0] + share[[0, -1]] * control[1])


def _tcp(run: Run, robot: Robot, segment: int, q: FloatArray) -> FloatArray:
    """TCP (P, 3) m at configurations (P, N), with the tool of a segment."""
    move = run.program.moves[run.path.route.moves[segment]]
    frame = WORLD if move.tool.robot_held else move.work_object
    _, position = poses(work_chain(robot, move.tool, frame), np.ascontiguousarray(q))
    return np.asarray(position)


def _nominal(run: Run, robot: Robot, segment: int) -> FloatArray | None:
    """The programmed path (P, 3) of a segment; None if its work object moves."""
    route = run.path.route
    q = route.ends.q[segment]
    share = np.linspace(0.0, 1.0, STEPS + 1)[:, None]
    if route.ends.kind[segment] == JOINT_SEGMENT:
        return _tcp(run, robot, segment, (1 - share) * q[0] + share * q[1])
    points = _in_work_object(run, segment, share)
    placed = [_placed(run, robot, segment, row, points) for row in q]
    return placed[0] if np.abs(placed[0] - placed[1]).max() < STILL else None


def _placed(run: Run, robot: Robot, segment: int, q: FloatArray, points: FloatArray) -> FloatArray:
    """Points of the work object in the trajectory's frame, with the robot at q (N,)."""
    move = run.program.moves[run.path.route.moves[segment]]
    frame = WORLD if move.tool.robot_held else move.work_object
    row = np.ascontiguousarray(q[None])
    R_there, p_there = poses(work_chain(robot, move.tool, frame), row)
    R_here, p_here = poses(run.path.route.chains[segment], row)
    turn = R_there[0] @ R_here[0].T
    return np.asarray((points - p_here[0]) @ turn.T + p_there[0])


def tcp_speed(run: Run, position: FloatArray | None = None) -> FloatArray:
    """Speed (T,) m/s of the TCP at the trajectory's samples.

    It is zero at both ends. Where the tool changes without a motion, the TCP jumps; such steps
    are no speed. ``position`` (T, 3) m is the TCP in another frame than the trajectory's.
    """
    trajectory = run.trajectory
    if len(trajectory.t) < 3:
        return np.zeros(len(trajectory.t))
    at = trajectory.position if position is None else position
    step = np.linalg.norm(np.diff(at, axis=0), axis=1)
    tools = [run.program.moves[i].tool for i in trajectory.move]
    kept = np.array([a == b for a, b in pairwise(tools)])
    rate = np.where(kept, step, 0.0) / np.diff(trajectory.t)
    middle = 0.5 * (trajectory.t[1:] + trajectory.t[:-1])
    times = np.concatenate([trajectory.t[:1], middle, trajectory.t[-1:]])
    return np.asarray(np.interp(trajectory.t, times, np.concatenate([[0.0], rate, [0.0]])))

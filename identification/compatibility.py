"""Whether a log is one of the program that it is held against, and if not, why not."""

from __future__ import annotations

from itertools import combinations

import numpy as np
from scipy.spatial import cKDTree

from ..core.arrays import FloatArray
from ..core.errors import InputError
from ..core.motion.command.trajectory import Trajectory
from ..core.robot.model import Robot
from .logs.cleaning import CleanLog
from .matching import Match

NEAR = 0.03
"""rad (m) of the path of joints within which half of a log must lie, and …"""
FAR = 0.1
"""… nine tenths. Logs are off by up to a half and a third of that before their zones are fitted."""
COVERED = 0.02
"""rad (m), or …"""
COVERED_SHARE = 0.01
"""… share of the path that a log may lack at either end."""
SKIPPED = 0.1
"""Share of the path that no two samples may leave out between them."""
SLOWEST, FASTEST = 0.02, 50.0
"""Emulated over logged time beyond which no override explains it."""
_BETTER = 5.0
_FEW = 500
"""Samples that a reason is looked for with, about."""
_RADIANS = (
    "it fits if its joints are in radians and were taken for degrees: say unit = "
    '"rad" in a file of columns'
)
_BEYOND = 0.1
"""rad (m) by which logs pass limits that are known roughly."""


def check_axes(robot: Robot, trajectory: Trajectory, log: CleanLog) -> None:
    """Refuse a log of another number of axes, or of a robot that stands.

    Raises:
        InputError: with the reason.
    """
    count = log.q.shape[1]
    if count != trajectory.q_motor.shape[1] or count != robot.size:
        raise InputError(
            f"the log has {count} joints, {robot.name} has {robot.size} axes: wrong robot, or "
            "columns are missing"
        )
    if np.ptp(log.q[log.valid], axis=0).max() <= 1e-4:
        raise InputError("the log shows no motion: all its samples are the same")


def check_limits(robot: Robot, q: FloatArray) -> None:
    """Refuse samples (T, N) of which many lie beyond the robot's limits.

    Raises:
        InputError: with the reason.
    """
    beyond = np.maximum(robot.limits.lower - q, q - robot.limits.upper) > _BEYOND
    if beyond.any(axis=1).mean() < 0.1:
        return
    axis = int(np.argmax(beyond.mean(axis=0)))
    worst = q[np.argmax(np.abs(q[:, axis])), axis]
    radians = np.radians(q)
    fits = (radians >= robot.limits.lower - _BEYOND) & (radians <= robot.limits.upper + _BEYOND)
    what = (
        'its joints seem to be in degrees: say unit = "deg" in a file of columns'
        if fits.all()
        else "wrong robot, or the columns are in another order"
    )
    raise InputError(
        f"{robot.axis_names[axis]} reaches {worst:.4g} (rad or m) in the log, far beyond the "
        f"limits of {robot.name}: {what}"
    )


def check_path(
    robot: Robot, trajectory: Trajectory, q: FloatArray, found: Match, inside: slice
) -> None:
    """Refuse a log that does not follow the program's path of joints.

    Args:
        robot: names the axes.
        trajectory: the emulated motion.
        q: (T, N) samples.
        found: their match.
        inside: those between start and end of the motion.

    Raises:
        InputError: with the reason.
    """
    rows = inside if inside.stop - inside.start > 10 else slice(None)
    distance = found.distance[rows]
    if np.median(distance) <= NEAR and np.percentile(distance, 90) <= FAR:
        return
    raise InputError(
        "the log does not follow this program: half of its samples are more than "
        f"{np.degrees(np.median(distance)):.3g}° from the path of joints; "
        + _reason(robot, trajectory, q)
    )


def _reason(robot: Robot, trajectory: Trajectory, q: FloatArray) -> str:
    """What would make the log fit, or where it is worst."""
    path = trajectory.q_motor
    tree = cKDTree(path)
    # Far from a path the nearest place is searched for long, and medians ask for few samples.
    ranges = np.stack([q.min(axis=0), q.max(axis=0)])
    q = q[:: max(len(q) // _FEW, 1)]
    near = _typical(tree, q)
    # A log that is scaled down hardly moves, and may do so near the path.
    moves = _reach(np.radians(q)) > 0.5 * _reach(path)
    if moves and _typical(tree, np.radians(q)) < min(near / _BETTER, NEAR):
        return 'it fits if its joints are in degrees: say unit = "deg" in a file of columns'
    if _typical(tree, np.degrees(q)) < min(near / _BETTER, NEAR):
        return _RADIANS
    for axis, name in enumerate(robot.axis_names):
        shift = _shift(path, q, axis)
        moved, flipped = q.copy(), q.copy()
        moved[:, axis] += shift
        flipped[:, axis] *= -1
        if _typical(tree, moved) < min(near / _BETTER, NEAR):
            return f"it fits if {name} counts from {np.degrees(shift):.3g}° instead of 0"
        if _typical(tree, flipped) < min(near / _BETTER, NEAR):
            return f"it fits if {name} counts the other way round"
    for one, other in combinations(range(q.shape[1]), 2):
        swapped = q.copy()
        swapped[:, [one, other]] = q[:, [other, one]]
        if _typical(tree, swapped) < min(near / _BETTER, NEAR):
            return f"it fits if the columns of {robot.axis_names[one]} and " + (
                f"{robot.axis_names[other]} are exchanged"
            )
    below = np.maximum(path.min(axis=0) - ranges[1], ranges[0] - path.max(axis=0))
    worst = int(np.argmax(below))
    if below[worst] > 0:
        return (
            f"{robot.axis_names[worst]} runs from {_span(ranges[:, worst])} in the log and from "
            f"{_span(path[:, worst])} in the program: another robot, program, start or tool"
        )
    return "another robot, program, start or tool, or a log of several runs"


def _shift(path: FloatArray, q: FloatArray, axis: int) -> float:
    """What an axis (T,) of a log lacks, where all others agree best with a path (P, N)."""
    if path.shape[1] == 1:
        return float(np.median(path) - np.median(q))
    nearest = cKDTree(np.delete(path, axis, axis=1)).query(np.delete(q, axis, axis=1))[1]
    return float(np.median(path[nearest, axis] - q[:, axis]))


def _reach(q: FloatArray) -> float:
    """How far joints (T, N) move, all together, rad (m)."""
    return float(np.linalg.norm(np.ptp(q, axis=0)))


def _typical(tree: cKDTree, q: FloatArray) -> float:
    """Median distance from the path's samples."""
    return float(np.median(tree.query(q)[0]))


def _span(values: FloatArray) -> str:
    return f"{np.degrees(values.min()):.1f}° to {np.degrees(values.max()):.1f}°"


def check_coverage(
    trajectory: Trajectory, q: FloatArray, found: Match, begin: int, end: int
) -> None:
    """Refuse a log that begins late, ends early or leaves out part of the path.

    Args:
        trajectory: the emulated motion.
        q: (T, N) samples.
        found: their match.
        begin, end: first and last sample of the motion.

    Raises:
        InputError: with the share that is missing.
    """
    slack = max(COVERED, COVERED_SHARE * found.length)
    first, last = float(found.arc[begin]), float(found.arc[end])
    if first > slack:
        raise InputError(
            f"the log begins when {100 * first / found.length:.0f} % of the program's path lie "
            "behind: it is shorter than the program, or began late"
        )
    if last < found.length - slack and _typical(cKDTree(trajectory.q_motor), np.degrees(q)) < NEAR:
        # Where the emulation begins as the log does, all of the log is near its beginning.
        raise InputError(f"the log hardly moves; {_RADIANS}")
    if last < found.length - slack:
        raise InputError(
            f"the log ends at {100 * last / found.length:.0f} % of the program's path: it is "
            "shorter than the program"
        )
    inside = slice(begin, end + 1)
    moved = np.linalg.norm(np.diff(q[inside], axis=0), axis=1)
    skipped = np.diff(found.arc[inside]) - 2.0 * moved
    if skipped.max(initial=0.0) > max(COVERED, SKIPPED * found.length):
        at = int(np.argmax(skipped))
        first, last = (100 * found.arc[inside][k] / found.length for k in (at, at + 1))
        raise InputError(
            f"the log goes from {first:.0f} to {last:.0f} % of the program's path within one "
            "sample, without moving that far: it began late, or the program starts elsewhere"
        )


def check_time(moving: float, logged: float) -> None:
    """Refuse a log whose time is in another unit.

    Raises:
        InputError: with the factor.
    """
    ratio = moving / logged
    if SLOWEST < ratio < FASTEST:
        return
    unit = "ms" if ratio < 1 else "s"
    raise InputError(
        f"the motion takes {logged:.4g} s in the log and {moving:.4g} s in the emulation: is the "
        f"log's time in {unit}? Say time's unit in a file of columns"
    )

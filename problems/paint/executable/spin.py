"""How the gun is turned about its nozzle: free to choose, where the footprint is round.

Over a grid of turns the cheapest series is found by dynamic programming, for each branch of inverse
kinematics by itself, then refined. What costs is the square of each joint's speed by its limit,
and nearness to singularities. The cheapest branch in which nothing collides at the waypoints is
taken.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray, IntArray
from ....core.errors import InputError
from ....core.program.tool import WORLD
from ....core.robot.inverse.solution import UnreachableError
from ....core.robot.kinematics.tracking import track
from ....core.robot.model import Robot
from ....core.robot.work_chain import work_chain
from ..spray.trajectory import PaintTrajectory
from .frames import gun_frames, turned
from .station import Station
from .stretch import Stretch, unreachable

COARSE = math.radians(15.0)
"""rad between the turns that are tried first."""
FINER = (math.radians(4.0), math.radians(1.0))
"""rad between those that are tried round the best ones then."""
ASIDE = 4
"""So many to each side."""
STIFF = 0.1
"""Least singular value of the Jacobian (lengths in m) from which on nearness to a singularity
counts little."""
_FULL = 2.0 * math.pi
_QUARTER = 0.5 * math.pi
"""rad that the gun may be turned about its nozzle within a segment; half a turn of a fan would lay
paint across, and which way round it goes would be left to rounding."""

Clear = Callable[[FloatArray], bool]
"""Whether nothing collides with the joints (W, N) at the waypoints."""


@dataclass(frozen=True, eq=False)
class GunPosture:
    """How the robot holds the gun along a trajectory.

    Args:
        rotation: (W, 3, 3) of the TCP in the world; its z axis is the nozzle's direction.
        joints: (W, N) rad, one after the other without jumps.
    """

    rotation: FloatArray
    joints: FloatArray


@dataclass(frozen=True, eq=False)
class _Candidates:
    """Ways to stand at each waypoint, in one branch.

    Args:
        turn: (W, K) rad about the nozzle.
        joints: (W, K, N); NaN where the robot cannot stand so.
    """

    turn: FloatArray
    joints: FloatArray


def choose_posture(
    trajectory: PaintTrajectory, station: Station, clear: Clear = lambda joints: True
) -> GunPosture:
    """The turns about the nozzle, and the joints, with which the whole trajectory is driven best.

    Of the postures that collide with nothing it is the cheapest; where all collide, the cheapest of
    them, so that a proof can say what is in the way.

    Args:
        trajectory: in the part's frame.
        station: robot, gun and place.
        clear: see `Clear`.

    Raises:
        MotionError: there is no branch of inverse kinematics that reaches all of it; the message
            says which stretch cannot be reached.
    """
    robot = station.cell.robot
    if robot.external_axes:
        raise InputError(
            f"{robot.name} has external axes, which painting does not move: name a robot without"
        )
    world = trajectory.moved(station.place)
    frames = gun_frames(world)
    grids = _coarse(world, frames, station)
    whole = [grid for grid in grids if np.isfinite(grid.joints[..., 0]).any(axis=1).all()]
    first: GunPosture | None = None
    for posture in _postures(whole, world, frames, station):
        if clear(posture.joints):
            return posture
        first = posture if first is None else first
    if first is not None:
        return first
    raise unreachable(world, trajectory, None if whole else _stretch(grids), robot, frames, station)


def _postures(
    grids: list[_Candidates], world: PaintTrajectory, frames: FloatArray, station: Station
) -> Iterator[GunPosture]:
    """The best posture of each branch that is driven without winding a joint up, cheapest first."""
    robot = station.cell.robot
    ways = [(*_cheapest(grid, world, robot), grid) for grid in grids]
    ways.sort(key=lambda way: way[1])
    for picked, cost, grid in ways:
        turns, joints = _picked(grid, picked)
        unwound = _unwound(joints, robot) if math.isfinite(cost) else None
        if unwound is None:
            continue
        if world.fan is None:
            turns, unwound = _refined(turns, unwound, world, frames, station)
        yield GunPosture(turned(frames, turns), unwound)


def _coarse(world: PaintTrajectory, frames: FloatArray, station: Station) -> list[_Candidates]:
    """Every turn of the grid at every waypoint, by branch."""
    robot, back = station.cell.robot, np.linalg.inv(station.gun.tcp.matrix())
    step = math.pi if world.fan is not None else COARSE
    turn = np.asarray(np.arange(round(_FULL / step)) * step, dtype=np.float64)
    shape = (len(frames), len(turn))
    by_branch: dict[object, FloatArray] = {}
    for w in range(shape[0]):
        for k, rotation in enumerate(turned(np.repeat(frames[w][None], len(turn), 0), turn)):
            pose = np.eye(4)
            pose[:3, :3], pose[:3, 3] = rotation, world.position[w]
            try:
                solutions = robot.inverse(pose @ back)
            except UnreachableError:
                continue
            for solution in solutions:
                if solution.branch not in by_branch:
                    by_branch[solution.branch] = np.full((*shape, robot.size), np.nan)
                by_branch[solution.branch][w, k] = solution.q
    return [_Candidates(np.tile(turn, (shape[0], 1)), q) for q in by_branch.values()]


def _cheapest(
    candidates: _Candidates, world: PaintTrajectory, robot: Robot
) -> tuple[IntArray, float]:
    """Index (W,) of the cheapest way through the candidates, and what it costs."""
    limits = robot.limits.velocity
    stand = _nearness(candidates.joints, robot)
    total = stand[0]
    back = np.zeros(stand.shape, dtype=np.int64)
    for w in range(1, len(stand)):
        change = candidates.joints[w][:, None] - candidates.joints[w - 1][None]
        change -= _FULL * np.round(change / _FULL)
        twist = candidates.turn[w][:, None] - candidates.turn[w - 1][None]
        twist -= _FULL * np.round(twist / _FULL)
        seconds = world.duration[w - 1]
        move = ((change / limits) ** 2).sum(axis=2) / seconds**2 * seconds
        move += np.where(np.abs(twist) <= _QUARTER + 1e-9, (twist / math.pi) ** 2, np.inf)
        ways = np.where(np.isfinite(move), move, np.inf) + total[None]
        back[w] = np.argmin(ways, axis=1)
        total = np.take_along_axis(ways, back[w][:, None], 1)[:, 0] + stand[w] * seconds
    picked = np.empty(len(stand), dtype=np.int64)
    picked[-1] = int(np.argmin(total))
    for w in range(len(stand) - 1, 0, -1):
        picked[w - 1] = back[w, picked[w]]
    return picked, float(total.min())


def _nearness(joints: FloatArray, robot: Robot) -> FloatArray:
    """(W, K) what it costs a second to stand near singularities and limits; inf where it cannot."""
    known = np.isfinite(joints[..., 0])
    cost = np.full(known.shape, np.inf)
    q = np.ascontiguousarray(joints[known])
    if len(q) == 0:
        return cost
    stiffness = np.linalg.svd(robot.jacobian(q)[..., : robot.arm_size], compute_uv=False)[:, -1]
    lower, upper = robot.limits.lower, robot.limits.upper
    off = np.abs(2.0 * (q - 0.5 * (lower + upper)) / np.maximum(upper - lower, 1e-9))
    cost[known] = 0.1 * (STIFF / np.maximum(stiffness, 1e-6)) ** 2 + 0.1 * (off**12).sum(axis=1)
    return cost


def _picked(candidates: _Candidates, picked: IntArray) -> tuple[FloatArray, FloatArray]:
    rows = np.arange(len(picked))
    return candidates.turn[rows, picked], candidates.joints[rows, picked]


def _unwound(joints: FloatArray, robot: Robot) -> FloatArray | None:
    """The same joints (W, N) without whole turns between neighbours; None beyond the limits."""
    lower, upper = robot.limits.lower - 1e-9, robot.limits.upper + 1e-9
    best = None
    for first in robot.turns(joints[0]):
        wound = np.concatenate(([first], joints[1:]))
        steps = np.diff(wound, axis=0)
        steps -= _FULL * np.round(steps / _FULL)
        series = np.concatenate(([first], first + np.cumsum(steps, axis=0)))
        room = float(np.minimum(series - lower, upper - series).min())
        if room >= 0.0 and (best is None or room > best[0] + 1e-6):
            best = room, series
    return None if best is None else best[1]


def _refined(
    turns: FloatArray,
    joints: FloatArray,
    world: PaintTrajectory,
    frames: FloatArray,
    station: Station,
) -> tuple[FloatArray, FloatArray]:
    """The turns again, on finer grids round those that were found."""
    robot = station.cell.robot
    chain = work_chain(robot, station.gun, WORLD)
    arm = np.arange(robot.arm_size)
    lower, upper = robot.limits.lower, robot.limits.upper
    for step in FINER:
        offset = step * np.arange(-ASIDE, ASIDE + 1)
        grid = turns[:, None] + offset
        q = np.full((*grid.shape, robot.size), np.nan)
        for k in range(len(offset)):
            rotation = turned(frames, grid[:, k])
            for w in range(len(grid)):
                out = joints[w].copy()
                there, _, _ = track(chain, joints[w], rotation[w], world.position[w], arm, out)
                near = np.abs(out - joints[w]).max() < 1.0
                if there and near and (lower <= out).all() and (out <= upper).all():
                    q[w, k] = out
        candidates = _Candidates(grid, q)
        turns, joints = _picked(candidates, _cheapest(candidates, world, robot)[0])
    return turns, joints


def _stretch(grids: list[_Candidates]) -> Stretch:
    """The waypoints that the branch which reaches most does not reach."""
    missed = [
        np.flatnonzero(~np.isfinite(candidates.joints[..., 0]).any(axis=1)) for candidates in grids
    ]
    if not missed:
        return Stretch(0, -1)
    return Stretch.first_of(min(missed, key=len))

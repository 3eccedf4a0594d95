"""What a driven program looks like from outside: sampled between the emulator's own samples."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import FloatArray, IntArray
from ..core.motion.emulator.run import Run
from ..core.motion.geometry.swivel import swivel
from ..core.motion.model.motion_model import MotionModel
from ..core.motion.model.rules import LineTurn, Overlap
from ..core.program.move import Move, MoveC, MoveJ
from ..core.program.program import Program
from ..core.program.speed import Speed
from ..core.program.zone import ContourFraction, Fine, Radius
from ..core.robot.model import Robot
from ..core.spatial.rotation import matrix_from_rotation_vector, rotation_vector

_SHARES = np.array([0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0])
"""Where each interval of the stamp is looked at."""


@dataclass(frozen=True)
class Observed:
    """S samples of a stamped motion, before any smoothing in time; flange and world frame.

    Args:
        robot: who moved.
        run: what came of the program.
        t: (S,) s.
        interval: (S,), of the stamp.
        segment: (S,), index of the leg that the interval belongs to.
        q, dq, ddq: (S, N).
        rotation: (S, 3, 3).
        position: (S, 3) m.
    """

    robot: Robot
    run: Run
    t: FloatArray
    interval: IntArray
    segment: IntArray
    q: FloatArray
    dq: FloatArray
    ddq: FloatArray
    rotation: FloatArray
    position: FloatArray

    @classmethod
    def of(cls, robot: Robot, run: Run) -> Observed:
        """Look at a run at the knots of its stamp and between them."""
        timing = run.timing
        step = timing.end - timing.begin
        # The last instant of an interval would count as the first of the next.
        inner = np.nextafter(timing.end, -np.inf)
        t = np.minimum(timing.begin[:, None] + _SHARES * step[:, None], inner[:, None]).ravel()
        interval = np.repeat(np.arange(len(step)), len(_SHARES))
        q, dq, ddq = timing.states_at(t)
        rotation, position = robot.forward(q)
        segment = timing.interval_segments[interval]
        return cls(robot, run, t, interval, segment, q, dq, ddq, rotation, position)

    @property
    def moves(self) -> list[Move]:
        """The move of each leg; waypoints that the controller leaves out have none."""
        return [self.run.program.moves[i] for i in self.run.path.route.moves]

    @property
    def corners(self) -> FloatArray:
        """(M + 1, N), configurations at the waypoints."""
        q = self.run.path.route.ends.q
        return np.concatenate([q[:1, 0], q[:, 1]])

    def twist(self) -> FloatArray:
        """(S, 6), velocity of the flange in m/s and its rate of turn in rad/s."""
        return np.asarray(np.einsum("sij,sj->si", self.robot.jacobian(self.q), self.dq))


def away_from_legs(seen: Observed) -> FloatArray:
    """(S,), how far each sample is from its own leg as programmed.

    m for legs of the TCP; for joint moves, the largest distance of a joint in rad.
    """
    away = np.empty(len(seen.t))
    corners = seen.corners
    _, at = seen.robot.forward(corners)
    for k, move in enumerate(seen.moves):
        rows = seen.segment == k
        if isinstance(move, MoveJ):
            gap = seen.q[rows] - _nearest_on_line(seen.q[rows], corners[k], corners[k + 1])
            away[rows] = np.abs(gap).max(axis=1, initial=0.0)
        elif isinstance(move, MoveC):
            via = np.array(move.via.pose.position)
            away[rows] = _away_from_circle(seen.position[rows], at[k], via, at[k + 1])
        else:
            gap = seen.position[rows] - _nearest_on_line(seen.position[rows], at[k], at[k + 1])
            away[rows] = np.linalg.norm(gap, axis=1)
    return away


def turned_away(seen: Observed, model: MotionModel) -> FloatArray:
    """(S,) rad, how far the tool is from the even turn of its leg; 0 on other than lines."""
    away = np.zeros(len(seen.t))
    rotation, _ = seen.robot.forward(seen.corners)
    for k, move in enumerate(seen.moves):
        if isinstance(move, MoveJ | MoveC):
            continue
        rows = seen.segment == k
        (whole,) = _even(rotation[k].T @ rotation[k + 1 : k + 2], model)
        done = _even(rotation[k].T @ seen.rotation[rows], model)
        away[rows] = np.linalg.norm(done - _nearest_on_line(done, 0 * whole, whole), axis=1)
    return away


def _even(turns: FloatArray, model: MotionModel) -> FloatArray:
    """(S, d) rad, what grows in proportion along a line that turns the tool by turns (S, 3, 3)."""
    if model.line_turn is LineTurn.AXIS:
        return rotation_vector(turns)
    swivelled = swivel(turns[:, :, 0])
    rest = rotation_vector(matrix_from_rotation_vector(-swivelled) @ turns)
    return np.concatenate([swivelled, rest], axis=1)


def outside_zones(seen: Observed, model: MotionModel, turning: bool) -> NDArray[np.bool_]:
    """(S,), samples outside the zones at both ends of their leg.

    Args:
        seen: what was driven.
        model: whose rule on neighbouring zones makes them smaller.
        turning: whether the zones of the orientation are meant, not those of the TCP.
    """
    outside = np.ones(len(seen.t), dtype=bool)
    corners = seen.corners
    _, at = seen.robot.forward(corners)
    for i, move in enumerate(seen.moves[:-1]):
        radius = effective_radius(seen, model, i, turning)
        if radius == 0.0:
            continue
        for k in (i, i + 1):
            rows = seen.segment == k
            if isinstance(move.zone, ContourFraction):
                reach = move.zone.fraction * model.neighbour_fraction
                inside = _within_share(seen, k, i + 1, reach)
            else:
                inside = np.linalg.norm(seen.position[rows] - at[i + 1], axis=1) <= radius + 1e-7
            outside[rows] &= ~inside
    return outside


def _within_share(seen: Observed, k: int, corner: int, share: float) -> NDArray[np.bool_]:
    """Samples of leg k that are within a share of the leg from one of its corners.

    Along legs of the TCP a share is one of the way that the TCP takes: joints do not keep to it.
    """
    rows, corners = seen.segment == k, seen.corners
    joints = np.abs(seen.q[rows] - corners[corner]).max(axis=1)
    whole = np.abs(corners[k + 1] - corners[k]).max()
    inside: NDArray[np.bool_] = joints <= share * whole + 1e-9
    move = seen.moves[k]
    if isinstance(move, MoveJ):
        return inside
    _, at = seen.robot.forward(corners)
    way = float(np.linalg.norm(at[k + 1] - at[k]))
    if isinstance(move, MoveC):
        via = np.array(move.via.pose.position)
        chords = np.linalg.norm(via - at[k]) + np.linalg.norm(at[k + 1] - via)
        way = 1.2 * float(chords)  # an arc of two radians is so much longer than its chord
    away = np.linalg.norm(seen.position[rows] - at[corner], axis=1)
    return np.asarray(inside | (away <= share * way + 1e-7))


def effective_radius(seen: Observed, model: MotionModel, i: int, turning: bool) -> float:
    """Radius in m of the zone at the end of leg i, cut as the vendor's rule says.

    Infinite where a zone is no sphere.
    """
    zone = seen.moves[i].zone
    if isinstance(zone, Fine):
        return 0.0
    if not isinstance(zone, Radius):
        return np.inf
    radius = max(zone.tcp, zone.reorientation, zone.external) if turning else zone.tcp
    if model.overlap is Overlap.HALF:
        _, at = seen.robot.forward(seen.corners)
        for k in (i, i + 1):
            if not isinstance(seen.moves[k], MoveJ | MoveC):
                length = float(np.linalg.norm(at[k + 1] - at[k]))
                radius = min(radius, model.neighbour_fraction * length)
    return radius


def at_speed(program: Program, factor: float) -> Program:
    """The program at ``factor`` ≤ 1 times its speeds, with accelerations to match.

    The same motion in 1 / factor times the time, if no model adds limits of its own.
    """

    def slower(speed: Speed) -> Speed:
        changes = {name: getattr(speed, name) for name in (*_SPEEDS, *_ACCELERATIONS)}
        for name, value in changes.items():
            if value is not None:
                changes[name] = value * (factor if name in _SPEEDS else factor**2)
        return replace(speed, **changes, name=None)

    return program.with_moves(
        tuple(replace(move, speed=slower(move.speed)) for move in program.moves)
    )


_SPEEDS = (
    "tcp",
    "reorientation",
    "external_linear",
    "external_angular",
    "joint",
    "joint_fraction",
)
_ACCELERATIONS = (
    "tcp_acceleration",
    "reorientation_acceleration",
    "joint_acceleration",
    "joint_acceleration_fraction",
)


def _nearest_on_line(x: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """The points of a line's stretch that are nearest to x (S, d)."""
    step = end - start
    square = float(step @ step)
    share = np.clip((x - start) @ step / square, 0.0, 1.0) if square > 0 else np.zeros(len(x))
    return np.asarray(start + share[:, None] * step)


def _away_from_circle(
    x: FloatArray, start: FloatArray, via: FloatArray, end: FloatArray
) -> FloatArray:
    """Distances of points x (S, 3) from the circle through three points."""
    a, b = via - start, end - start
    normal = np.cross(a, b)
    square = float(normal @ normal)
    centre = start + np.cross((a @ a) * b - (b @ b) * a, normal) / (2.0 * square)
    radius = float(np.linalg.norm(start - centre))
    unit = normal / np.sqrt(square)
    height = (x - centre) @ unit
    flat = np.linalg.norm(x - centre - height[:, None] * unit, axis=1)
    return np.asarray(np.hypot(height, flat - radius))

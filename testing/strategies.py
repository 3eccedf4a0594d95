"""Hypothesis strategies: configurations, targets, speeds, zones and programs of a robot."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st
from numpy.typing import NDArray

from ..core.program.move import Move, MoveC, MoveJ, MoveL, Statement, Wait
from ..core.program.program import Program
from ..core.program.speed import Speed
from ..core.program.target import Configuration, JointTarget, PoseTarget
from ..core.program.tool import FLANGE, Tool
from ..core.program.zone import FINE, Radius, Zone
from ..core.robot.model import Robot
from ..core.spatial.pose import Pose

if TYPE_CHECKING:
    from ..core.vendor import Vendor

FloatArray = NDArray[np.float64]
Label = Callable[[Robot, FloatArray], Configuration | None]

LEAST_SINGULAR_VALUE = 0.03
"""Of the Jacobian with lengths as shares of the arm's own; below, a posture counts as singular."""
STEP = 0.2
"""rad; largest change of a joint over one linear or circular move."""


def robots(vendor: Vendor) -> st.SearchStrategy[Robot]:
    """Robots of the vendor's catalogue."""
    return st.sampled_from(sorted(vendor.robots)).map(vendor.robot)


def configurations(robot: Robot, margin: float = 0.05) -> st.SearchStrategy[FloatArray]:
    """Values (N,) of all axes, ``margin`` of each range away from its limits."""
    limits = robot.limits
    gap = margin * (limits.upper - limits.lower)
    ranges = zip(limits.lower + gap, limits.upper - gap, strict=True)
    axes = [st.floats(low, high, allow_subnormal=False) for low, high in ranges]
    return st.tuples(*axes).map(np.array)


def regular_configurations(robot: Robot, margin: float = 0.05) -> st.SearchStrategy[FloatArray]:
    """The same, not singular either."""
    return configurations(robot, margin).filter(lambda q: is_regular(robot, q))


def is_regular(robot: Robot, q: FloatArray) -> bool:
    """Whether the arm's Jacobian at ``q`` (N,) keeps all six degrees of freedom by a margin."""
    jacobian = robot.jacobian(q)[:, : robot.arm_size]
    length = sum(float(np.linalg.norm(step)) for step in robot.arm_chain.translation[1:])
    scaled = jacobian / np.array([length] * 3 + [1.0] * 3)[:, None]
    return bool(np.linalg.svd(scaled, compute_uv=False)[-1] > LEAST_SINGULAR_VALUE)


def reachable_poses(robot: Robot) -> st.SearchStrategy[Pose]:
    """Poses of the flange in the world that the robot can take."""
    return configurations(robot).map(robot.flange_pose)


def joint_targets(robot: Robot) -> st.SearchStrategy[JointTarget]:
    """Targets in joint values."""
    return configurations(robot).map(lambda q: joint_target(robot, q))


def pose_targets(
    robot: Robot, label: Label | None = None, tool: Tool = FLANGE
) -> st.SearchStrategy[PoseTarget]:
    """Targets in poses of the tool in the world, with a configuration label if there is one."""
    return regular_configurations(robot).map(lambda q: pose_target(robot, q, label, tool))


def speeds() -> st.SearchStrategy[Speed]:
    """Speeds by the TCP, rounded to mm/s and degrees/s as people write them."""
    return st.builds(
        Speed,
        tcp=st.integers(5, 3000).map(lambda mm: mm / 1000),
        reorientation=st.integers(5, 500).map(lambda deg: float(np.radians(deg))),
    )


def radii(largest: float = 0.05) -> st.SearchStrategy[Radius]:
    """Zones up to ``largest`` m, to 0.1 mm, with an orientation zone half as large again."""

    def zone(tenths: int) -> Radius:
        tcp = tenths * 1e-4
        return Radius(tcp, 1.5 * tcp, 1.5 * tcp, angle=0.15e3 * tcp * float(np.radians(1)))

    return st.integers(1, max(1, round(largest * 1e4))).map(zone)


def zones(largest: float = 0.05) -> st.SearchStrategy[Zone]:
    """Stop points and radii."""
    return st.one_of(st.just(FINE), radii(largest))


def fly_by_zones(zone: st.SearchStrategy[Zone] | None = None) -> st.SearchStrategy[Zone]:
    """Those of ``zone`` that let the robot pass without stopping."""
    return (zones() if zone is None else zone).filter(lambda found: found != FINE)


@st.composite
def programs(
    draw: st.DrawFn,
    robot: Robot,
    label: Label | None = None,
    zone: st.SearchStrategy[Zone] | None = None,
    speed: st.SearchStrategy[Speed] | None = None,
    max_moves: int = 6,
    kinds: Sequence[type[Move]] = (MoveJ, MoveL, MoveC),
) -> Program:
    """Programs of joint, linear and circular moves and waits that the robot can drive.

    They begin with a joint move to a stop; linear and circular moves are short and keep away
    from singular postures, so that the configuration can be held.
    """
    zone = zones() if zone is None else zone
    speed = speeds() if speed is None else speed
    start = draw(joint_targets(robot))
    q = draw(regular_configurations(robot, margin=0.15))
    statements: list[Statement] = [MoveJ(joint_target(robot, q), draw(speed), FINE)]
    for _ in range(draw(st.integers(1, max_moves))):
        kind = draw(st.sampled_from(kinds))
        move, q = _move(draw, kind, robot, q, label, draw(speed), draw(zone))
        statements.append(move)
        if draw(st.booleans()) and move.zone == FINE:
            statements.append(Wait(draw(st.integers(0, 20)) / 10))
    return Program(tuple(statements), start=start)


def _move(
    draw: st.DrawFn,
    kind: type[Move],
    robot: Robot,
    q: FloatArray,
    label: Label | None,
    speed: Speed,
    zone: Zone,
) -> tuple[Move, FloatArray]:
    """A move from ``q``, and where it ends."""
    if kind is MoveJ:
        end = draw(regular_configurations(robot, margin=0.15))
        return MoveJ(joint_target(robot, end), speed, zone), end
    end = draw(_near(robot, q))
    target = pose_target(robot, end, label)
    if kind is MoveL:
        return MoveL(target, speed, zone), end
    via = pose_target(robot, draw(_near(robot, q)), label)
    assume(_make_an_arc(robot.flange_pose(q), via.pose, target.pose))
    return MoveC(target, speed, zone, via=via), end


@st.composite
def _near(draw: st.DrawFn, robot: Robot, q: FloatArray) -> FloatArray:
    """Regular configurations at most `STEP` away that move the flange noticeably."""
    steps = st.floats(-STEP, STEP, allow_subnormal=False)
    change = np.array(draw(st.lists(steps, min_size=robot.size, max_size=robot.size)))
    end: FloatArray = np.clip(q + change, robot.limits.lower, robot.limits.upper)
    assume(is_regular(robot, end) and is_regular(robot, 0.5 * (q + end)))
    start, stop = (np.array(robot.flange_pose(x).position) for x in (q, end))
    assume(np.linalg.norm(stop - start) > 1e-2)
    return end


def _make_an_arc(start: Pose, via: Pose, end: Pose) -> bool:
    """Whether three points lie apart and off a line, the second one between the others."""
    a, b, c = (np.array(pose.position) for pose in (start, via, end))
    first, second = b - a, c - b
    lengths = float(np.linalg.norm(first)), float(np.linalg.norm(second))
    if min(lengths) < 5e-3:
        return False
    turn = np.arccos(np.clip(first @ second / (lengths[0] * lengths[1]), -1, 1))
    return bool(0.1 < turn < 2.0)


def joint_target(robot: Robot, q: FloatArray) -> JointTarget:
    """The configuration (N,) as a target."""
    values = tuple(float(value) for value in q)
    return JointTarget(values[: robot.arm_size], values[robot.arm_size :])


def pose_target(
    robot: Robot, q: FloatArray, label: Label | None = None, tool: Tool = FLANGE
) -> PoseTarget:
    """Where the tool stands in the world at the configuration (N,)."""
    configuration = label(robot, q) if label is not None else None
    external = tuple(float(value) for value in q[robot.arm_size :])
    return PoseTarget(robot.flange_pose(q) @ tool.tcp, configuration, external)

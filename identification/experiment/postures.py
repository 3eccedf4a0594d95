"""Postures to measure at: natural for an arm, away from limits and singularities, clear, and
far from each other."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...core.arrays import FloatArray
from ...core.errors import InputError
from ...core.program.tool import WORLD, Tool
from ...core.robot.inverse.solution import UnreachableError
from ...core.robot.kinematics.chain_kernels import jacobians, poses
from ...core.robot.model import Robot
from ...core.robot.work_chain import work_chain
from ...core.spatial.pose import Pose
from ...core.spatial.rotation import matrix_from_rotation_vector

Clear = Callable[[FloatArray], bool]
"""Whether configurations (M, N) are free of collisions."""

REGULAR = 0.04
"""Least singular value of the Jacobian, lengths as shares of the reach; below, a posture or a path
counts as too near to a singularity."""
ROOM = 0.12
"""Share of the reach that the legs need round a posture."""
AZIMUTH = math.radians(60)
DISTANCE, HEIGHT = (0.4, 0.75), (0.05, 0.55)
"""Of the TCP from the base's axis and floor, as shares of the reach."""
TILTED, SPUN = math.radians(100), math.radians(60)
"""How far the tool points away from straight down, and turns about its axis, at most."""
ASIDE = math.radians(50)
"""How far to the side it points, beside outward."""
_TRIES, _POOL, _SIDES = 1000, 40, 8


@dataclass(frozen=True)
class Site:
    """A posture and the plane that its corners lie in.

    Args:
        q: (N,).
        plane: (3, 3), columns are two directions of the plane and its normal, in the world.
    """

    q: FloatArray
    plane: FloatArray


def reach_of(robot: Robot, tool: Tool) -> float:
    """m, the farthest that the TCP gets from the base's axis among drawn configurations."""
    random = np.random.default_rng(0)
    limits = robot.limits
    q = random.uniform(limits.lower, limits.upper, (2000, robot.size))
    _, p = poses(work_chain(robot, tool, WORLD), q)
    apart = (p - np.array(robot.base.position)) @ robot.base.matrix()[:3, :2]
    return float(np.linalg.norm(apart, axis=1).max())


def regularity(robot: Robot, tool: Tool, reach: float, q: FloatArray) -> FloatArray:
    """(M,), least singular values of the Jacobian at (M, N), lengths as shares of the reach."""
    J = jacobians(work_chain(robot, tool, WORLD), np.ascontiguousarray(q))
    scaled = J / np.array([reach] * 3 + [1.0] * 3)[:, None]
    return np.asarray(np.linalg.svd(scaled, compute_uv=False)[:, -1])


def find_sites(
    robot: Robot, tool: Tool, count: int, margin: float, clear: Clear, random: np.random.Generator
) -> list[Site]:
    """As many postures as there are, up to ``count``: in front of the base, the tool downward or
    forward, chosen far from each other.

    Args:
        robot: without external axes.
        tool: whose TCP is to be moved.
        count: wanted.
        margin: rad or m that joints keep from their limits.
        clear: of collisions.
        random: what is drawn from.

    Raises:
        InputError: there is none.
    """
    search = _Search(robot, tool, margin, clear, reach_of(robot, tool))
    pool: list[Site] = []
    for _ in range(_TRIES):
        site = search.draw(random)
        if site is not None:
            pool.append(site)
        if len(pool) >= _POOL:
            break
    if not pool:
        raise InputError(
            f"no posture of {robot.name} was found with {1e3 * ROOM * search.reach:.0f} mm of room "
            "around it: give postures of your own, a smaller margin, or clear the cell"
        )
    return _apart(pool, count, robot)


def given_site(
    robot: Robot, tool: Tool, q: FloatArray, margin: float, random: np.random.Generator
) -> Site:
    """A posture that the user names, with a plane.

    Raises:
        InputError: it is outside the limits less the margin, or singular.
    """
    limits = robot.limits
    short = np.minimum(q - limits.lower, limits.upper - q) < margin
    if short.any():
        joint = robot.axis_names[int(np.argmax(short))]
        raise InputError(f"posture {_shown(q)}: joint {joint} is too near to its limit")
    reach = reach_of(robot, tool)
    if regularity(robot, tool, reach, q[None])[0] < REGULAR:
        raise InputError(f"posture {_shown(q)} is too near to a singular one; move a joint of it")
    return Site(q, _plane(random))


def _shown(q: FloatArray) -> str:
    return ",".join(f"{math.degrees(value):.4g}" for value in q)


@dataclass(frozen=True)
class _Search:
    robot: Robot
    tool: Tool
    margin: float
    clear: Clear
    reach: float

    def draw(self, random: np.random.Generator) -> Site | None:
        """A posture; None if the one that was drawn is of no use."""
        pose = self._pose(random)
        plane = _plane(random)
        best = self._best(self._solutions(pose))
        if best is None or not self.clear(best[None]):
            return None
        disc = self._disc(pose, plane, best)
        if disc is None or not self._usable(disc) or not self.clear(disc):
            return None
        return Site(np.round(best, 5), plane)

    def _pose(self, random: np.random.Generator) -> Pose:
        """Of the TCP in the world."""
        azimuth = random.uniform(-AZIMUTH, AZIMUTH)
        distance, height = (self.reach * random.uniform(*span) for span in (DISTANCE, HEIGHT))
        # z of the tool: straight down, then tilted outward; then spun.
        down = np.array([[1.0, 0, 0], [0, -1, 0], [0, 0, -1]])
        aside = random.uniform(-ASIDE, ASIDE)
        axis = np.array([math.sin(aside), -math.cos(aside), 0.0])
        tilt = matrix_from_rotation_vector(random.uniform(0, TILTED) * axis)
        spin = matrix_from_rotation_vector(np.array([0.0, 0.0, random.uniform(-SPUN, SPUN)]))
        heading = matrix_from_rotation_vector(np.array([0.0, 0.0, azimuth]))
        matrix = np.eye(4)
        matrix[:3, :3] = heading @ tilt @ down @ spin
        matrix[:3, 3] = heading @ [distance, 0.0, height]
        return Pose.from_matrix(self.robot.base.matrix() @ matrix)

    def _solutions(self, pose: Pose) -> list[FloatArray]:
        try:
            return [s.q for s in self.robot.inverse(pose @ self.tool.tcp.inverse())]
        except UnreachableError:
            return []

    def _best(self, solutions: list[FloatArray]) -> FloatArray | None:
        """Of those that are regular and inside the limits, the nearest to the ranges' middle."""
        inside = [q for q in solutions if self._room(q[None]) > self.margin]
        if not inside:
            return None
        rows = np.array(inside)
        rows = rows[regularity(self.robot, self.tool, self.reach, rows) > REGULAR]
        if not len(rows):
            return None
        limits = self.robot.limits
        middle, half = 0.5 * (limits.upper + limits.lower), 0.5 * (limits.upper - limits.lower)
        return np.asarray(rows[np.argmin(np.abs((rows - middle) / half).max(axis=1))])

    def _disc(self, pose: Pose, plane: FloatArray, q: FloatArray) -> FloatArray | None:
        """Configurations (M, N) at the centre and round it; None where there is none."""
        rows = [q]
        for angle in np.linspace(0.0, 2 * math.pi, _SIDES, endpoint=False):
            step = plane[:, 0] * math.cos(angle) + plane[:, 1] * math.sin(angle)
            matrix = pose.matrix()
            matrix[:3, 3] += ROOM * self.reach * step
            found = self._solutions(Pose.from_matrix(matrix))
            if not found:
                return None
            rows.append(min(found, key=lambda other: float(np.abs(other - q).max())))
        return np.array(rows)

    def _usable(self, q: FloatArray) -> bool:
        if self._room(q) < self.margin or np.abs(q - q[0]).max() > 1.0:
            return False
        return bool(regularity(self.robot, self.tool, self.reach, q).min() > REGULAR)

    def _room(self, q: FloatArray) -> float:
        """rad or m, least distance from a limit."""
        limits = self.robot.limits
        return float(np.minimum(q - limits.lower, limits.upper - q).min())


def _plane(random: np.random.Generator) -> FloatArray:
    """Two directions and the normal of a plane that lies anyhow."""
    Q, R = np.linalg.qr(random.normal(size=(3, 3)))
    Q = Q * np.sign(np.diag(R))
    Q[:, 2] *= np.sign(np.linalg.det(Q))
    return np.asarray(Q)


def _apart(pool: list[Site], count: int, robot: Robot) -> list[Site]:
    """The sites that are farthest from those before, in shares of the joints' ranges."""
    limits = robot.limits
    share = np.array([site.q for site in pool]) / (limits.upper - limits.lower)
    chosen = [0]
    while len(chosen) < min(count, len(pool)):
        gap = np.linalg.norm(share[:, None] - share[chosen], axis=2).min(axis=1)
        chosen.append(int(np.argmax(gap)))
    return [pool[k] for k in chosen]

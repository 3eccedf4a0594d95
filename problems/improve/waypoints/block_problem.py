"""A block as an optimisation problem: objective, constraints and their derivatives.

Constraints, all wanted to be zero or more: the distance of every pair of bodies at every place of
the path less what it is to be (m); the room between neighbouring zones (m, or shares); how far
joints stay within their limits at those places (rad or m); and the user's limits on via points.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray, IntArray
from ....core.collision.distance.answers import Distances
from ....core.collision.proof.certificate import SceneOf
from ....core.errors import MotionError
from ....core.motion.emulator.controller import Controller
from ....core.motion.gradients.derivatives import Derivatives
from ....core.motion.gradients.sensitivity import PathPlaces
from ....core.motion.timing.timing import Timing
from ....core.program.program import Program
from ..nonsmooth_sqp import SearchStand
from .block_emulation import DrivenBlock, Driver
from .blocks import MoveBlock
from .options import WaypointTask
from .point_limit_rows import PointRow, point_rows
from .watched import watch

_WITHIN = 0.3
"""m beyond which distances are of no concern to a step."""
_COSTLY_WITHIN = 0.04
"""The same of distances to meshes: those would be most of the work, and a step that meets one
from further away is corrected by the true value there."""
_FASTEST = 4.0
"""m by which a robot's body moves at most, about, where the variables change by a length of 1."""
_MOST_STANDS = 32
"""Remembered at once."""


@dataclass(frozen=True)
class EvaluatedBlock:
    """The problem at a point; see `nonsmooth_sqp.SearchPoint`.

    Args:
        x: (n,).
        objective: f.
        constraints: (m,).
        drive: the driven program.
        distances: of each scene.
    """

    x: FloatArray
    objective: float
    constraints: FloatArray
    drive: DrivenBlock
    distances: tuple[Distances, ...]


@dataclass(frozen=True)
class BlockCost:
    """The objective of a block: of time and energy the shares of what it takes as it was given.

    Args:
        controller: that drives it.
        weight: of time.
        given: s, and energy where it counts, as it was given.
    """

    controller: Controller
    weight: float
    given: tuple[float, float]

    @classmethod
    def beside(
        cls, controller: Controller, weight: float, program: Program, timing: Timing
    ) -> BlockCost:
        """The objective beside a driven program."""
        return cls(controller, weight, cls(controller, weight, (1.0, 1.0)).amounts(program, timing))

    def of(self, program: Program, timing: Timing) -> float:
        """The objective of a driven program."""
        time, energy = self.amounts(program, timing)
        return self.weight * time / self.given[0] + (1.0 - self.weight) * energy / self.given[1]

    def amounts(self, program: Program, timing: Timing) -> tuple[float, float]:
        """Time, and energy where it counts."""
        if self.weight == 1.0:
            return timing.duration, 1.0
        return timing.duration, self.controller.energy(program, timing).value


class BlockProblem:
    """A block as a `nonsmooth_sqp.SearchModel`.

    Args:
        controller: that drives it.
        block: the block.
        scenes: of the block's moves.
        task: the user's wishes.
        clearance: m to aim at.
        least: m that is required; pairs that are nearer than aimed at where the robot stops
            need keep no more than they have there.
        density, more: of the places; see `Driver`.

    Attributes:
        stands: where searches ended that may go on, by the bytes of x.

    Raises:
        MotionError: the block cannot be driven as it was given.
    """

    def __init__(
        self,
        controller: Controller,
        block: MoveBlock,
        scenes: SceneOf,
        task: WaypointTask,
        clearance: float,
        least: float,
        density: int = 1,
        more: PathPlaces | None = None,
    ) -> None:
        self.block = block
        self._driver = Driver(controller, block, density, more)
        variables = block.variables
        self.lower, self.upper, self.scale = variables.lower, variables.upper, variables.scale
        first = self._driver.drive(variables.start)
        if first is None:
            raise MotionError("the program cannot be driven as it is", block.first)
        weight = task.time_weight
        self._cost = BlockCost.beside(controller, weight, first.program, first.timing)
        self._watched = watch(first, self._driver, scenes, clearance, least)
        self._points: tuple[PointRow, ...] = point_rows(block, first.path, task)
        limits = controller.robot.limits
        self._joint_limits = limits.lower, limits.upper
        self.stands: dict[bytes, SearchStand[EvaluatedBlock]] = {}

    def remember(self, stand: SearchStand[EvaluatedBlock]) -> None:
        """Keep where a search ended: one that goes on from there need not evaluate it again."""
        if len(self.stands) == _MOST_STANDS:
            del self.stands[next(iter(self.stands))]
        self.stands[stand.point.x.tobytes()] = stand

    # -------------------------------------------------------------------------- values

    def point(self, x: FloatArray) -> EvaluatedBlock | None:
        """The problem at x; None where the program cannot be driven."""
        drive = self._driver.drive(np.clip(x, self.lower, self.upper))
        if drive is None:
            return None
        objective = self._cost.of(drive.program, drive.timing)
        found = tuple(
            watched.scene.distances(
                drive.q[watched.places],
                watched.most + _WITHIN,
                watched.most + _COSTLY_WITHIN,
            )
            for watched in self._watched
        )
        return EvaluatedBlock(drive.x, objective, self._constraints(drive, found), drive, found)

    def _constraints(self, drive: DrivenBlock, found: tuple[Distances, ...]) -> FloatArray:
        parts = [
            (
                distances.distance - watched.wanted(drive.q[watched.places], distances.distance)
            ).ravel()
            for watched, distances in zip(self._watched, found, strict=True)
        ]
        parts.append(np.array([room.left.value for room in drive.rooms]))
        parts.append(self._joint_rooms(drive).ravel())
        parts.append(np.array([row.value(drive.path) for row in self._points]))
        return np.concatenate(parts)

    def _joint_rooms(self, drive: DrivenBlock) -> FloatArray:
        """(2, N), least distance of each axis from its lower and upper limit, over all places."""
        lower, upper = self._joint_limits
        return np.stack([drive.q.min(axis=0) - lower, upper - drive.q.max(axis=0)])

    # --------------------------------------------------------------------- derivatives

    def gradient(self, point: EvaluatedBlock) -> FloatArray:
        """∇f (n,).

        Raises:
            MotionError: a pose target is singular.
        """
        drive, variables = point.drive, self.block.variables
        made = Derivatives(drive.program, drive.timing)
        total = np.zeros(variables.size)
        weight, (time, energy) = self._cost.weight, self._cost.given
        if weight > 0.0:
            total += weight / time * variables.gradient(made.duration(), point.x)
        if weight < 1.0:
            share = (1.0 - weight) / energy
            total += share * variables.gradient(made.energy(), point.x)
        return total

    def candidates(self, point: EvaluatedBlock, box: FloatArray) -> IntArray:
        """Constraints that a step within ``box`` may violate, and a few more."""
        drive = point.drive
        near = point.constraints < min(_FASTEST * float(np.linalg.norm(box)), 0.999 * _WITHIN)
        told = [found.normal.any(axis=-1).ravel() for found in point.distances]
        near[: sum(map(len, told))] &= np.concatenate(told)
        first = len(point.constraints) - len(self._points) - 2 * drive.q.shape[1]
        near[first - len(drive.rooms) : first] = True
        return np.flatnonzero(near)

    def jacobian(self, point: EvaluatedBlock, rows: IntArray) -> FloatArray:
        """∂c/∂x of some constraints (len(rows), n).

        Raises:
            MotionError: a pose target is singular.
        """
        drive, free = point.drive, self.block.variables.free
        extreme = np.concatenate([drive.q.argmin(axis=0), drive.q.argmax(axis=0)])
        entries = list(self._entries(rows))
        wanted = [self._watched[k].places[sample] for k, (_, sample, _) in enumerate(entries)]
        which, back = np.unique(np.concatenate([*wanted, extreme]), return_inverse=True)
        change = self._driver.change(drive, which)
        out = np.zeros((len(rows), len(free)))
        done = 0
        for k, (at, sample, pair) in enumerate(entries):
            watched, distances = self._watched[k], point.distances[k]
            q = drive.q[watched.places]
            slopes = watched.scene.gradients(q, distances, (sample, pair))
            out[at] = np.einsum("kj,kjn->kn", slopes, change.q[back[done : done + len(at)]])
            done += len(at)
        self._rest(point, rows, change.q[back[done:]], change.rooms, change.waypoints, out)
        whole = np.zeros((len(rows), self.block.variables.size))
        whole[:, free] = out
        return whole

    def _entries(self, rows: IntArray) -> Iterator[tuple[IntArray, IntArray, IntArray]]:
        """Places in ``rows`` of each scene's distances, and their samples and pairs.

        Constraints run over scenes, then places, then pairs.
        """
        first = 0
        for watched in self._watched:
            pairs = len(watched.scene.pairs)
            size = len(watched.places) * pairs
            at = np.flatnonzero((rows >= first) & (rows < first + size))
            sample, pair = np.divmod(rows[at] - first, max(pairs, 1))
            yield at, sample, pair
            first += size

    def _rest(
        self,
        point: EvaluatedBlock,
        rows: IntArray,
        extreme: FloatArray,
        rooms: FloatArray,
        waypoints: FloatArray,
        out: FloatArray,
    ) -> None:
        """Derivatives of the constraints that are no distances."""
        drive = point.drive
        axes = drive.q.shape[1]
        own = np.arange(axes)
        limits = np.concatenate([extreme[own, own], -extreme[axes + own, own]])
        points = [row.slope(drive.path, waypoints) for row in self._points]
        table = np.concatenate([rooms, limits, *(slope[None] for slope in points)])
        first = len(point.constraints) - len(table)
        at = np.flatnonzero(rows >= first)
        out[at] = table[rows[at] - first]

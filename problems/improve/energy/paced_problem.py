"""Time and energy of a program in all its numbers, as a `nonsmooth_sqp.SearchModel`.

Variables are those of its points and zones, then the logarithms of its speeds and accelerations.
Points and zones bring their own constraints (`waypoints.evaluation`). Speeds change no geometry, so
that distances are measured once for both.

The time is piecewise smooth, and good programs sit on its kinks. As the search keeps gradients of
the objective at points seen nearby, this model keeps those of the time: each is a row of its own
beside the true one, never tighter than that where it stands.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ....core.arrays import FloatArray, IntArray
from ....core.errors import MotionError
from ....core.motion.emulator.controller import Controller
from ....core.motion.gradients.derivatives import Derivatives, ProgramGradient
from ....core.motion.model.consumption import Consumption
from ....core.motion.path.path import Path
from ....core.motion.timing.timing import Timing
from ....core.program.program import Program
from ..nonsmooth_sqp import violation
from ..waypoints.block_problem import BlockProblem
from ..waypoints.block_problem import EvaluatedBlock as Shape
from .options import Goal
from .pacing import Pacing

_FEASIBLE = 1e-5
_PLANES = 16
"""Gradients of the time that are remembered."""


@dataclass(frozen=True)
class FixedShape:
    """Points and zones that stay.

    Args:
        program: whose they are.
        path: through them.
    """

    program: Program
    path: Path


@dataclass(frozen=True, eq=False)
class EvaluatedProgram:
    """The problem at a point.

    Args:
        x: (n,).
        objective: of the goal.
        problem: whose point it is.
        program, timing: as driven.
        duration: s.
        energy: of the consumption.
        shape: points and zones; None where they stay.
    """

    x: FloatArray
    objective: float
    problem: PacedProblem
    program: Program
    timing: Timing
    duration: float
    energy: float
    shape: Shape | None

    @property
    def constraints(self) -> FloatArray:
        """(m,), wanted to be zero or more: those of the shape, then the room until the latest end
        as a share of it, by the true time and by the planes remembered now."""
        return self.problem.constraints(self)

    @property
    def rank(self) -> tuple[float, float]:
        """Smaller is better: feasible ones first."""
        worst = violation(self)
        return (0.0 if worst < _FEASIBLE else worst), self.objective

    @cached_property
    def duration_slope(self) -> FloatArray:
        """(n,), of the time."""
        return self.problem.slope(self, self.derivatives.duration())

    @cached_property
    def derivatives(self) -> Derivatives:
        """Of the driven program."""
        return Derivatives(self.program, self.timing)


Watch = Callable[[EvaluatedProgram], object]


@dataclass(frozen=True, eq=False)
class _Plane:
    """The time near a point: duration + slope · (x − at)."""

    at: FloatArray
    duration: float
    slope: FloatArray


class PacedProblem:
    """A program with its speeds as variables.

    Args:
        controller: that drives it.
        geometry: points and zones as a problem, or what stays.
        pacing: the speeds.
        goal: what is to be small.
        consumption: whose integral is the energy.
        watch: called with every point that can be driven.

    Attributes:
        lower, upper, scale: (n,), see `nonsmooth_sqp.SearchModel`.
    """

    def __init__(
        self,
        controller: Controller,
        geometry: BlockProblem | FixedShape,
        pacing: Pacing,
        goal: Goal,
        consumption: Consumption,
        watch: Watch | None = None,
    ) -> None:
        self.controller = controller
        self._geometry = geometry
        self._pacing = pacing
        self._goal = goal
        self._consumption = consumption
        self._watch = watch
        self._planes: list[_Plane] = []
        bounds = [(pacing.lower, pacing.upper, pacing.scale)]
        self._split = 0
        if isinstance(geometry, BlockProblem):
            bounds.insert(0, (geometry.lower, geometry.upper, geometry.scale))
            self._split = geometry.block.variables.size
        self.lower, self.upper, self.scale = (
            np.concatenate(parts) for parts in zip(*bounds, strict=True)
        )

    # -------------------------------------------------------------------------- values

    def point(self, x: FloatArray) -> EvaluatedProgram | None:
        """The problem at x; None where the program cannot be driven."""
        x = np.clip(x, self.lower, self.upper)
        shape: Shape | None = None
        if isinstance(self._geometry, BlockProblem):
            shape = self._geometry.point(x[: self._split])
            if shape is None:
                return None
            program, path = shape.drive.program, shape.drive.path
        else:
            program, path = self._geometry.program, self._geometry.path
        program = self._pacing.applied(program, x[self._split :])
        try:
            timing = self.controller.stamp(program, path)
        except MotionError:
            return None
        energy = self.controller.energy(program, timing, self._consumption).value
        objective = self._goal.time * timing.duration + self._goal.energy * energy
        made = EvaluatedProgram(x, objective, self, program, timing, timing.duration, energy, shape)
        if self._watch is not None:
            self._watch(made)
        return made

    def constraints(self, point: EvaluatedProgram) -> FloatArray:
        """(m,), see `EvaluatedProgram.constraints`."""
        own = np.zeros(0) if point.shape is None else point.shape.constraints
        latest = self._goal.latest
        if latest is None:
            return own
        times = np.full(1 + _PLANES, point.duration)
        for k, plane in enumerate(self._planes):
            foreseen = plane.duration + plane.slope @ (point.x - plane.at)
            times[1 + k] = min(float(foreseen), point.duration)
        return np.concatenate([own, 1.0 - times / latest])

    # --------------------------------------------------------------------- derivatives

    def gradient(self, point: EvaluatedProgram) -> FloatArray:
        """∇f (n,).

        Raises:
            MotionError: a pose target is singular.
        """
        goal, total = self._goal, np.zeros(len(point.x))
        if goal.latest is not None:
            self._planes.append(_Plane(point.x, point.duration, point.duration_slope))
            del self._planes[:-_PLANES]
        if goal.time > 0.0:
            total += goal.time * point.duration_slope
        if goal.energy > 0.0:
            made = point.derivatives.energy(self._consumption)
            total += goal.energy * self.slope(point, made)
        return total

    def candidates(self, point: EvaluatedProgram, box: FloatArray) -> IntArray:
        """Constraints that a step within ``box`` may violate; those of the time always."""
        found = np.zeros(0, dtype=np.int64)
        if point.shape is not None:
            assert isinstance(self._geometry, BlockProblem)
            found = self._geometry.candidates(point.shape, box[: self._split])
        if self._goal.latest is None:
            return found
        first = self._first(point)
        return np.concatenate([found, np.arange(first, first + 1 + len(self._planes))])

    def jacobian(self, point: EvaluatedProgram, rows: IntArray) -> FloatArray:
        """∂c/∂x of some constraints (len(rows), n)."""
        out = np.zeros((len(rows), len(point.x)))
        first = self._first(point)
        ours = rows >= first
        for row in np.flatnonzero(ours):
            k = int(rows[row]) - first - 1
            slope = point.duration_slope if k < 0 else self._planes[k].slope
            out[row] = -slope / (self._goal.latest or 1.0)
        if point.shape is not None:
            assert isinstance(self._geometry, BlockProblem)
            out[~ours, : self._split] = self._geometry.jacobian(point.shape, rows[~ours])
        return out

    def _first(self, point: EvaluatedProgram) -> int:
        """Index of the first constraint of the time."""
        return 0 if point.shape is None else len(point.shape.constraints)

    def slope(self, point: EvaluatedProgram, made: ProgramGradient) -> FloatArray:
        """(n,), from the program's numbers to the variables."""
        paces = self._pacing.gradient(made, point.x[self._split :])
        if not isinstance(self._geometry, BlockProblem):
            return paces
        x = point.x[: self._split]
        return np.concatenate([self._geometry.block.variables.gradient(made, x), paces])

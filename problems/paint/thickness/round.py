"""One outer iteration: the SQP solver in a box round a trajectory, each of its iterates judged."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ....core.arrays import FloatArray
from ....core.sqp import NLP, BackendKind, Result, solve
from ....core.sqp.result import Iteration
from ..spray.trajectory import PaintTrajectory
from .constraints import PaintConstraints
from .objective import PaintObjective
from .options import OuterLoop
from .variables import ThicknessVariables

Progress = Callable[[int, Iteration], bool | None]

TOLERANCE = 1e-3
"""Of the KKT residual, and of rows in their units; differences that it leaves are model noise."""
_PRICE = 100.0


@dataclass(frozen=True, eq=False)
class JudgedTrajectory:
    """A trajectory that was judged.

    Args:
        trajectory: with tilt, deviation and speed within their limits.
        cost: J.
        violation: the largest of the other limits, in units of the rows.
    """

    trajectory: PaintTrajectory
    cost: float
    violation: float

    @property
    def merit(self) -> float:
        """By which a point is chosen to go on from."""
        return self.cost + _PRICE * self.violation

    def beats(self, other: JudgedTrajectory) -> bool:
        """Whether it is the better result: limits first, then cost."""
        own, others = max(self.violation, TOLERANCE), max(other.violation, TOLERANCE)
        return (own, self.cost) < (others, other.cost)


@dataclass(frozen=True, eq=False)
class Round:
    """One outer iteration.

    Args:
        number: from 0.
        variables: round the trajectory that it begins at.
        objective, constraints: over them.
        loop: its box and iterations.
    """

    number: int
    variables: ThicknessVariables
    objective: PaintObjective
    constraints: PaintConstraints
    loop: OuterLoop

    def judged(self, z: FloatArray) -> JudgedTrajectory:
        """The trajectory at z (n,), with limits kept exactly that the solver keeps to first order:
        tilt, deviation and speed."""
        point = self.constraints.repaired(z)
        return JudgedTrajectory(
            self.variables.trajectory(point),
            self.objective.value(point),
            self.constraints.violation(point),
        )

    def solved(
        self, qp: BackendKind | str, progress: Progress | None, before: Result | None
    ) -> tuple[Result, list[JudgedTrajectory]]:
        """What the solver says, and its iterates, the start first.

        Args:
            qp: back end.
            progress: called with this round's number and the solver's iteration; True ends it.
            before: result of the round before.
        """
        seen: list[JudgedTrajectory] = []

        def told(iteration: Iteration) -> bool:
            seen.append(self.judged(iteration.x))
            return bool(progress is not None and progress(self.number, iteration))

        result = solve(
            self.program,
            np.zeros(self.variables.size),
            tolerance=TOLERANCE,
            method="sqp",  # its iterates are judged, and the box is small
            max_iterations=self.loop.iterations,
            qp=qp,
            callback=told,
            warm_start=before,
        )
        seen.append(self.judged(result.x))
        return result, seen

    @property
    def program(self) -> NLP:
        """What the solver is given: the cost over its variables within the box and the limits."""
        box = self._box()
        constraints = self.constraints
        return NLP(
            n=self.variables.size,
            m=constraints.size,
            objective=self.objective.value,
            gradient=self.objective.gradient,
            constraints=constraints.values,
            jacobian=constraints.jacobian,
            hessian=self._curvature,
            x_lower=-box,
            x_upper=box,
            c_lower=constraints.lower,
            c_upper=constraints.upper,
        )

    def _curvature(self, z: FloatArray, factor: float, multipliers: FloatArray) -> FloatArray:
        found = factor * self.objective.curvature(z) if factor else np.zeros((len(z), len(z)))
        self.constraints.add_curvature(multipliers, found)
        return found

    def _box(self) -> FloatArray:
        """Half widths (n,) of the box in the units of z."""
        loop, variables = self.loop, self.variables
        waypoint = np.repeat((loop.position, loop.angle), (3, 2))
        sizes = np.concatenate(
            (np.tile(waypoint, variables.waypoints), loop.duration * variables.start.duration)
        )
        return np.asarray(sizes / variables.units)

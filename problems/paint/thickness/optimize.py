"""Optimisation of a painting trajectory: positions, directions and durations at once.

Outer iterations linearise what the solver takes as given (the surface below the waypoints) and set
a box round the waypoints; in each, `flyby.core.sqp` minimises the cost with Gauss and Newton's
matrix in the place of the Hessian.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ....core.arrays import BoolArray
from ....core.sqp import BackendKind, Result, Status
from ..coating.coat import Coat, coat
from ..coating.deposition import Deposition
from ..spray.trajectory import PaintTrajectory
from .constraints import PaintConstraints
from .objective import PaintObjective
from .options import OuterLoop, PaintLimits, PaintWeights
from .reference import ReferencePlanes
from .robust import NO_ERRORS, PaintErrors, scenarios
from .round import TOLERANCE, JudgedTrajectory, Progress, Round
from .variables import ThicknessVariables

Surroundings = Callable[[PaintTrajectory], ReferencePlanes]
Sight = Callable[[PaintTrajectory], BoolArray]


@dataclass(frozen=True, eq=False)
class PaintSolution:
    """An optimised trajectory.

    Args:
        trajectory: the best one found.
        before, after: the coats.
        objective: of the cost, at the start and after each outer iteration.
        violation: of the limits that is left, in their units of the solver.
        iterations: of the SQP solver, all together.
        status: of its last run.
        interrupted: whether the user ended it.
    """

    trajectory: PaintTrajectory
    before: Coat
    after: Coat
    objective: tuple[float, ...]
    violation: float
    iterations: int
    status: Status
    interrupted: bool


def optimize(
    deposition: Deposition,
    trajectory: PaintTrajectory,
    target: float,
    reference: ReferencePlanes | Surroundings,
    *,
    limits: PaintLimits | None = None,
    weights: PaintWeights | None = None,
    loop: OuterLoop | None = None,
    errors: PaintErrors = NO_ERRORS,
    sight: Sight | None = None,
    progress: Progress | None = None,
    qp: BackendKind | str = BackendKind.DENSE_INTERIOR_POINT,
) -> PaintSolution:
    """The trajectory with the most even coat near to a given one.

    Args:
        deposition: the surface under the gun.
        trajectory: where to begin; its flow stays.
        target: wanted thickness, m.
        reference: the surface below the waypoints, or what gives it for a trajectory; it is asked
            before each outer iteration.
        limits, weights, loop: see their classes.
        errors: that the coat shall stand.
        sight: which points each segment of a trajectory sees, (V, S); asked before each outer
            iteration, in which it stays. None where nothing stands in the way.
        progress: called with the numbers of the outer and the solver's iteration; True ends it.
        qp: back end of the SQP solver.

    Raises:
        InputError: a nozzle that does not point at the surface below it.
    """
    limits, weights, loop = limits or PaintLimits(), weights or PaintWeights(), loop or OuterLoop()
    around = reference if callable(reference) else lambda _: reference
    best: JudgedTrajectory | None = None
    costs: list[float] = []
    iterations, now = 0, trajectory
    result: Result | None = None
    for number in range(loop.rounds):
        variables = ThicknessVariables.of(now, around(now))
        seen_by = deposition if sight is None else deposition.with_visible(sight(now))
        cases = scenarios(seen_by, errors)
        step = Round(
            number,
            variables,
            PaintObjective(cases, target, weights, variables),
            PaintConstraints(limits, variables, trajectory.position),
            loop,
        )
        result, seen = step.solved(qp, progress, result)
        iterations += result.iterations
        if best is None:
            best = seen[0]
            costs.append(best.cost)
        for candidate in seen:
            best = candidate if candidate.beats(best) else best
        costs.append(best.cost)
        next_start = min(seen, key=lambda candidate: candidate.merit)
        if result.status is Status.INTERRUPTED or next_start is seen[0]:
            break
        now = next_start.trajectory
        if best.violation <= TOLERANCE and costs[-2] - costs[-1] < loop.enough * costs[-2]:
            break
    assert best is not None and result is not None
    return PaintSolution(
        best.trajectory,
        _judged(deposition, trajectory, target, sight),
        _judged(deposition, best.trajectory, target, sight),
        tuple(costs),
        best.violation,
        iterations,
        result.status,
        result.status is Status.INTERRUPTED,
    )


def _judged(
    deposition: Deposition, trajectory: PaintTrajectory, target: float, sight: Sight | None
) -> Coat:
    if sight is not None:
        deposition = deposition.with_visible(sight(trajectory))
    return coat(deposition, trajectory, target)
